//! Filled cells, from back to front.
//!
//! Each cell reaches half-way under those neighbours that are painted after it, so no seams are visible between them.

use super::{Options, part};
use crate::math::{DVec2, DVec3};
use crate::scene::height_field::cut;
use crate::scene::{Camera, HeightField};
use crate::target::drawing::{Region, RegionKind};
use crate::view::picture_plane::PicturePlane;
use crate::visibility::line::floating_horizon::front_to_back;
use crate::{Error, Result};

/// More cells are not filled one by one: files would be of no use.
const MOST: u64 = 4_000_000;

/// Returns all cells in the order of painting.
pub fn regions(
    field: &HeightField,
    camera: &Camera,
    plane: &PicturePlane,
    options: &Options,
) -> Result<Vec<Region>> {
    let count = (field.columns() * field.rows()) as u64;
    if count > MOST {
        return Err(Error::Limit { what: "number of cells to fill", value: count, limit: MOST });
    }
    let [columns, rows] = front_to_back(field, camera);
    let [low, high] = field.range().unwrap_or_default();
    let mut regions = Vec::with_capacity(count as usize);
    for (j, &row) in rows.iter().enumerate().rev() {
        for (i, &column) in columns.iter().enumerate().rev() {
            if field.cell(column, row).is_none() {
                continue;
            }
            let cell = Cell { field, column, row, near: [before(&columns, i), before(&rows, j)] };
            let mut ring = cell.ring();
            cut(&mut ring, field.levels());
            if ring.len() < 3 {
                continue;
            }
            let ring: Option<Vec<DVec2>> = ring.into_iter().map(|p| plane.project(p)).collect();
            let Some(ring) = ring else { continue };
            if ring.iter().any(|p| !p.is_finite()) {
                return Err(Error::NonFinite {
                    what: "cell",
                    index: row * field.columns() + column,
                });
            }
            let mean = (0..4).filter_map(|k| field.height(column + (k & 1), row + (k >> 1)));
            let mean = mean.sum::<f64>() * 0.25;
            let color = options.color_at(part(mean, low, high));
            let color = color.or(options.background).unwrap_or([255; 4]);
            let kind = RegionKind::Surface;
            regions.push(Region { kind, rings: vec![ring], color, item: None, part: None });
        }
    }
    Ok(regions)
}

/// Returns the order of depth with the neighbour before (−1) or after (1) in the grid, whichever is
/// nearer to the eye; 0 for none.
fn before(order: &[usize], i: usize) -> i64 {
    let at = order[i] as i64;
    let nearer = |step: i64| order[..i].iter().rev().take(2).any(|&o| o as i64 == at + step);
    // The columns of one side follow each other; the first of the other side follows the eye's own.
    if nearer(-1) || (i > 0 && order[0] as i64 == at - 1) {
        -1
    } else if nearer(1) || (i > 0 && order[0] as i64 == at + 1) {
        1
    } else {
        0
    }
}

struct Cell<'a> {
    field: &'a HeightField,
    column: usize,
    row: usize,
    near: [i64; 2],
}

impl Cell<'_> {
    /// Returns the corner of the cell itself: bit 0 the column, bit 1 the row.
    fn corner(&self, k: usize) -> DVec3 {
        // A cell has all its corners.
        self.field.point(self.column + (k & 1), self.row + (k >> 1)).unwrap_or_default()
    }

    fn has_cell(&self, step: [i64; 2]) -> bool {
        let to = |at: usize, step: i64| usize::try_from(at as i64 + step).ok();
        match (to(self.column, step[0]), to(self.row, step[1])) {
            (Some(column), Some(row)) => self.field.cell(column, row).is_some(),
            _ => false,
        }
    }

    /// Returns the point half-way from a corner to the point of the grid beyond it, or the corner if there is none.
    fn beyond(&self, k: usize, step: [i64; 2]) -> DVec3 {
        let corner = self.corner(k);
        let to = |at: usize, step: i64| usize::try_from(at as i64 + step).ok();
        let column = to(self.column + (k & 1), step[0]);
        let row = to(self.row + (k >> 1), step[1]);
        let point = column.zip(row).and_then(|(c, r)| self.field.point(c, r));
        point.map_or(corner, |p| corner.lerp(p, 0.5))
    }

    /// Returns the outline: the cell's corners, and points half-way into nearer neighbours.
    fn ring(&self) -> Vec<DVec3> {
        let [dc, dr] = self.near;
        let (aside, ahead) = ([dc, 0], [0, dr]);
        let (has_aside, has_ahead) =
            (dc != 0 && self.has_cell(aside), dr != 0 && self.has_cell(ahead));
        let has_both = has_aside && has_ahead && self.has_cell([dc, dr]);
        let mut ring = Vec::with_capacity(if has_both { 6 } else { 8 });
        // Corners in order around the cell, each with the side that follows it.
        for k in [0usize, 1, 3, 2] {
            let on_aside = has_aside && (k & 1 == 1) == (dc > 0);
            let on_ahead = has_ahead && (k >> 1 == 1) == (dr > 0);
            match (on_aside, on_ahead) {
                (false, false) => ring.push(self.corner(k)),
                (true, false) => {
                    // The bend at the corner stays, before or after it along the ring.
                    let (p, q) = (self.corner(k), self.beyond(k, aside));
                    let leaves = matches!(k, 1 | 2);
                    ring.extend(if leaves { [p, q] } else { [q, p] });
                }
                (false, true) => {
                    let (p, q) = (self.corner(k), self.beyond(k, ahead));
                    let leaves = matches!(k, 3 | 0);
                    ring.extend(if leaves { [p, q] } else { [q, p] });
                }
                (true, true) => {
                    if has_both {
                        // Under three neighbours no bend is visible.
                        ring.push(self.beyond(k, [dc, dr]));
                    } else {
                        let (a, b) = (self.beyond(k, aside), self.beyond(k, ahead));
                        let (corner, aside_first) = (self.corner(k), matches!(k, 0 | 3));
                        ring.extend(if aside_first { [a, corner, b] } else { [b, corner, a] });
                    }
                }
            }
        }
        ring
    }
}
