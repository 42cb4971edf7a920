//! From pieces to the lines of a drawing: each drawn once, chained, simplified, ordered.

use super::chain::chains;
use super::overlap::{Piece, drawn_once};
use super::page::Page;
use super::{pen_order, simplify::simplify};
use crate::target::drawing::Line;

/// Parts of lines shorter than this many steps come from rounding: 2⁻²² of the page.
pub(super) const SLIVER: f64 = 64.0;

/// Lines within this part of the tolerance lie on each other.
const CLOSE: f64 = 0.4;

/// The finished lines. `tolerance` is a part of the drawing's extent.
pub(super) fn arrange(page: &Page, pieces: Vec<Piece>, tolerance: f64, pen: bool) -> Vec<Line> {
    let steps = tolerance * page.extent;
    let pieces = drawn_once(pieces, (steps * CLOSE).max(2.0), SLIVER);
    let mut chains = chains(&pieces);
    for chain in &mut chains {
        // Snapping alone moves points by a step.
        chain.points = simplify(&chain.points, chain.closed, steps.max(1.5));
        chain.closed &= chain.points.len() > 2;
    }
    chains.retain(|c| c.points.len() > 1 && c.length() >= steps);
    if pen {
        chains = pen_order::order(chains);
    } else {
        // Hidden lines first: what is visible is drawn over them.
        chains.sort_by_key(|c| std::cmp::Reverse((c.invisibility, c.class)));
    }
    let line = |c: super::chain::Chain| Line {
        class: c.class,
        invisibility: c.invisibility,
        points: c.points.iter().map(|p| page.plane_from_grid(*p)).collect(),
        closed: c.closed,
    };
    chains.into_iter().map(line).collect()
}
