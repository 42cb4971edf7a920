//! Principal views in columns and rows around the front view.

use super::Angle;
use crate::math::DVec2;
use crate::sorting::CompactSort;
use crate::view::projection::NamedView;

/// Extent of a view around the origin of its plane, y down.
#[derive(Debug, Clone, Copy)]
pub struct Extent {
    pub min: DVec2,
    pub max: DVec2,
}

impl Extent {
    pub fn size(&self) -> DVec2 {
        self.max - self.min
    }
}

/// A view in its cell: column and row are 0 where the front view is, and grow to the right and downwards.
struct Cell {
    /// Index among the given views.
    index: usize,
    at: [i32; 2],
    extent: Extent,
    aligned: bool,
}

/// A column or a row.
struct Track {
    at: i32,
    /// Start of its extent; around the common origin of its views if they are aligned, else 0.
    from: f64,
    to: f64,
}

/// Principal views in their places.
pub struct Grid {
    cells: Vec<Cell>,
    /// Columns and rows, the leftmost and the uppermost first.
    tracks: [Vec<Track>; 2],
}

/// Returns the column and the row of a view in third-angle projection.
fn cell(view: Option<NamedView>) -> [i32; 2] {
    match view.unwrap_or(NamedView::Iso) {
        NamedView::Front => [0, 0],
        NamedView::Right => [1, 0],
        NamedView::Left => [-1, 0],
        NamedView::Back => [2, 0],
        NamedView::Top => [0, -1],
        NamedView::Bottom => [0, 1],
        NamedView::Iso => [1, -1],
    }
}

impl Grid {
    /// Places views, each given by its index, its side if it is a usual one, and its extent.
    pub fn new(views: &[(usize, Option<NamedView>, Extent)], angle: Angle) -> Self {
        let cells: Vec<Cell> = views
            .iter()
            .map(|&(index, view, extent)| {
                let at = cell(view).map(|c| if angle == Angle::Third { c } else { -c });
                Cell { index, at, extent, aligned: view.is_some_and(|v| v != NamedView::Iso) }
            })
            .collect();
        let tracks = [0, 1].map(|axis| tracks(&cells, axis));
        Self { cells, tracks }
    }

    /// Returns the number of gaps from border to border: one more than there are columns, and rows.
    pub fn gaps(&self) -> DVec2 {
        let [columns, rows] = self.tracks.each_ref().map(|t| t.len() as f64 + 1.0);
        DVec2::new(columns, rows)
    }

    /// Returns the size of the columns and rows without gaps.
    pub fn size(&self) -> DVec2 {
        let [width, height] =
            self.tracks.each_ref().map(|t| t.iter().map(|t| t.to - t.from).sum::<f64>());
        DVec2::new(width, height)
    }

    /// Returns the origins of the views, with each view's index, in a room with its corner at `corner`: the rest
    /// of the room is distributed around the columns and rows.
    pub fn place(&self, corner: DVec2, room: DVec2) -> Vec<(usize, DVec2)> {
        let gap = (room - self.size()) / self.gaps();
        let along = |axis: usize, cell: &Cell| {
            let (corner, gap) = (corner[axis], gap[axis]);
            self.origin(axis, cell, corner, gap)
        };
        self.cells.iter().map(|c| (c.index, DVec2::new(along(0, c), along(1, c)))).collect()
    }

    /// Returns the place of a cell's origin along an axis.
    fn origin(&self, axis: usize, cell: &Cell, corner: f64, gap: f64) -> f64 {
        let mut start = corner + gap;
        let mut extent = 0.0;
        for track in &self.tracks[axis] {
            extent = track.to - track.from;
            if track.at == cell.at[axis] {
                if track.at == 0 && cell.aligned {
                    return start - track.from;
                }
                break;
            }
            start += extent + gap;
        }
        let (min, max) = (cell.extent.min[axis], cell.extent.max[axis]);
        match cell.at[axis] {
            _ if !cell.aligned => start + (extent - min - max) * 0.5,
            // As near to the front view as possible.
            at if at < 0 => start + extent - max,
            _ => start - min,
        }
    }
}

/// Returns the columns (axis 0) or rows (axis 1) of the cells, in order.
fn tracks(cells: &[Cell], axis: usize) -> Vec<Track> {
    let mut tracks: Vec<Track> = Vec::new();
    for cell in cells {
        let at = cell.at[axis];
        let (min, max) = (cell.extent.min[axis], cell.extent.max[axis]);
        let (from, to) = if at == 0 { (min, max) } else { (0.0, max - min) };
        match tracks.iter_mut().find(|t| t.at == at) {
            Some(track) => (track.from, track.to) = (track.from.min(from), track.to.max(to)),
            None => tracks.push(Track { at, from, to }),
        }
    }
    tracks.compact_sort_by_key(|t| t.at);
    tracks
}
