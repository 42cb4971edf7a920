//! From pieces to the lines of a drawing: each drawn once, chained, simplified, ordered.

use super::chain::chains;
use super::overlap::{Near, drawn_once};
use super::page::{GridPoint, Page, Projected};
use super::piece::Piece;
use super::simplify::simplify;
use super::stubs::without_stubs;
use super::zigzag::without_zigzags;
use crate::sorting::CompactSort;
use crate::target::drawing::{Line, LineClass};
use crate::view::picture_plane::PicturePlane;
use crate::visibility::object::Faces;
use crate::{Error, Result};

/// Parts of lines shorter than this many steps come from rounding: 2⁻²² of the page.
pub(super) const SLIVER: f64 = 64.0;

/// Lines within this part of the tolerance lie on each other.
const CLOSE: f64 = 0.4;

/// Lines closer than this part of a stub run into each other on paper.
const BESIDE: f64 = 0.15;

/// Options for making lines of pieces; lengths are parts of the drawing's extent.
#[derive(Debug, Clone, Copy)]
pub(super) struct How {
    pub tolerance: f64,
    /// 0 leaves stubs alone.
    pub stubs: f64,
    /// Distance beside a visible line within which a hidden one is under it.
    pub beneath: f64,
    /// True if silhouettes that are not sharp are those of smooth surfaces, which do not run to and fro.
    pub smooth: bool,
}

impl How {
    pub fn check(&self) -> Result<()> {
        let part = |name, value: f64| {
            let inside = (0.0..0.5).contains(&value);
            if inside {
                Ok(())
            } else {
                Err(Error::parameter(name, value, "at least 0 and below 0.5"))
            }
        };
        part("tolerance", self.tolerance)?;
        part("stubs", self.stubs)?;
        part("beneath", self.beneath)
    }
}

/// The straight pieces that lines are made of.
#[derive(Debug, Default)]
pub(super) struct Pieces {
    pub all: Vec<Piece>,
    /// Points at which three sharp edges or more meet, sorted: lines that continue through keep
    /// that point.
    pub corners: Vec<GridPoint>,
}

/// Returns the corners among the ends of lines, which are given with their class and whether they are
/// smooth.
pub(super) fn corners(
    lines: impl Iterator<Item = (LineClass, bool, [GridPoint; 2])>,
) -> Vec<GridPoint> {
    let sharp = lines.filter(|(class, smooth, _)| *class != LineClass::Wire && !smooth);
    let mut ends: Vec<GridPoint> = sharp.flat_map(|(_, _, ends)| ends).collect();
    ends.sort_unstable();
    ends.chunk_by(|a, b| a == b).filter(|same| same.len() > 2).map(|same| same[0]).collect()
}

/// Returns the finished lines.
pub(super) fn arrange(page: &Page, pieces: Pieces, how: How) -> Vec<Line> {
    let Pieces { mut all, corners } = pieces;
    if how.smooth {
        without_zigzags(&mut all);
    }
    let steps = how.tolerance * page.extent;
    let close = (steps * CLOSE).max(2.0);
    let near = Near {
        close,
        beside: how.stubs * BESIDE * page.extent,
        beneath: how.beneath * page.extent,
        sliver: SLIVER,
        corners: &corners,
    };
    let mut pieces = drawn_once(all, near);
    if how.stubs > 0.0 {
        pieces = without_stubs(pieces, how.stubs * page.extent, close);
    }
    let mut chains = chains(&pieces);
    for chain in &mut chains {
        // Snapping alone moves points by a step.
        chain.points = simplify(&chain.points, chain.closed, steps.max(1.5), &corners);
        chain.closed &= chain.points.len() > 2;
    }
    chains.retain(|c| c.points.len() > 1 && c.length() >= steps);
    // Hidden lines first: visible ones are drawn over them.
    chains.compact_sort_by_key(|c| std::cmp::Reverse((c.invisibility, c.class)));
    let line = |c: super::chain::Chain| Line {
        class: c.class,
        invisibility: c.invisibility,
        points: c.points.iter().map(|p| page.plane_from_grid(*p)).collect(),
        closed: c.closed,
    };
    chains.into_iter().map(line).collect()
}

/// Returns the result of `pieces` for the faces on their page; everything else is freed before lines are
/// made of it.
pub(super) fn on_page(
    faces: &Faces,
    plane: PicturePlane,
    pieces: impl FnOnce(&Projected) -> Pieces,
) -> Option<(Page, Pieces)> {
    let projected = Projected::new(faces, plane)?;
    Some((projected.page, pieces(&projected)))
}

/// Returns the lines of what [`on_page`] gives.
pub(super) fn arranged(found: Option<(Page, Pieces)>, how: How) -> Vec<Line> {
    found.map(|(page, pieces)| arrange(&page, pieces, how)).unwrap_or_default()
}
