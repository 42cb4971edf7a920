//! Cuts polygons with a mask so that borders which neighbours share stay shared.
//!
//! [`overlay`](mod@super::overlay) decides what belongs to the result, on a grid that depends on the extent of the
//! operands, but the result's vertices do not stay on the grid. Vertices of the input keep their coordinates bit for
//! bit, and a cut is where the edges *of the input* cross, correctly rounded. Both depend only on those vertices and
//! edges, so that two neighbours, and the inside and the outside part, have the same points on a common border.
//!
//! Before the overlay, vertices that are within rounding of an edge of the other operand are inserted into it: a
//! clipped polygon has such vertices all along the mask, and clipping it again must change nothing. Where exact points
//! would make rings cross, the points around the fault stay on the grid.

mod conform;
mod matched;
mod place;

pub use matched::{Matched, matched};

use super::overlay::{self, overlay};
use super::rectangle::{Near, Prepared};
use super::{BooleanOp, Shapes, WindingRule};
use crate::Result;
use crate::clip::attribute::VertexSource;
use crate::math::Rect;
use crate::trace::NoTrace;
use crate::work::Work;
use conform::{Mask, Subject};

/// Options for cutting with a mask.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Options {
    /// Winding rule of the subject.
    pub rule: WindingRule,
    /// True if the subject's own vertices are searched on its edges too. Invalid polygons have vertices on their own
    /// edges up to rounding, which would leave slivers.
    pub mend: bool,
    /// True if vertices of the mask also stay where it runs along an edge of the subject on both sides of them: for
    /// cutting the mask with the subject.
    pub keep: bool,
    /// Budget of memory, and whether to go on.
    pub work: Work,
}

/// Polygons that the mask leaves.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CoverageCut {
    /// Valid polygons, in the order of [`overlay::Output`].
    pub shapes: Shapes,
    /// Source of each point in the subject. Points of the mask are [`VertexSource::Corner`] if they do not lie on
    /// the subject's border.
    pub sources: Vec<VertexSource>,
    /// Number of points that stay on the grid, because rings would cross at the exact places.
    pub snapped: usize,
    /// True if the subject is unchanged except for the order of its rings and their first points.
    pub whole: bool,
    /// True if a polygon of the mask is smaller than a cell of the grid, so that it may be lost.
    pub lost: bool,
}

/// Returns the subject's part inside the mask (intersection) or outside of it (difference). The mask
/// is valid polygons.
///
/// ```
/// use durer::clip::polygon::{BooleanOp, Shapes, coverage, rectangle::Prepared};
/// use durer::math::DVec2;
///
/// // Two neighbours of different size, cut through the edge that they share.
/// let p = DVec2::new;
/// let wide = Shapes::from_rings([[p(1., 2.), p(2., 5.), p(-300., 5.), p(-300., 2.)]]);
/// let narrow = Shapes::from_rings([[p(2., 5.), p(1., 2.), p(4., 2.), p(4., 5.)]]);
/// let mask = Prepared::new(Shapes::from_rings([[p(-1., 3.), p(5., 3.1), p(5., 4.2), p(-1., 4.)]]))?;
/// let cut = |shapes| coverage::cut(shapes, &mask, BooleanOp::Intersection, &Default::default());
/// let (left, right) = (cut(&wide)?.shapes, cut(&narrow)?.shapes);
/// let shared: Vec<_> = left.points().iter().filter(|p| right.points().contains(p)).collect();
/// assert_eq!(shared.len(), 2);
/// assert_eq!(shared[0].x, 1.3463687150837989);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// As [`overlay()`](fn@super::overlay) for the subject's points.
pub fn cut(
    subject: &Shapes,
    mask: &Prepared,
    op: BooleanOp,
    options: &Options,
) -> Result<CoverageCut> {
    let near = subject.bounds().map(|bounds| Near::around(mask, &bounds)).unwrap_or_default();
    let (subject, mask) = conform::conform(subject, Mask::new(near), options.mend);
    solve(&subject, &mask, op, options)
}

/// Combines all of one set of polygons with all of another, which are valid.
///
/// # Errors
/// As [`overlay()`](fn@super::overlay).
pub fn join(
    first: &Shapes,
    second: &Shapes,
    op: BooleanOp,
    options: &Options,
) -> Result<CoverageCut> {
    let mask = Mask::new(Near::all(second.clone()));
    if !options.mend {
        return solve(&Subject::plain(first), &mask, op, options);
    }
    let (first, mask) = conform::conform(first, mask, true);
    solve(&first, &mask, op, options)
}

/// Returns the grid that [`cut`] and [`join`] decide on: the finest that the overlay takes.
///
/// A power of two that leaves 2³⁹ to 2⁴⁰ cells across, and 53 bits for a coordinate; `None` if there is no
/// extent.
pub(crate) fn finest_grid(bounds: [Option<Rect>; 2]) -> Option<f64> {
    let all = Rect::around(bounds.into_iter().flatten().flat_map(|b| [b.min(), b.max()]))?;
    let farthest = all.min().abs().max(all.max().abs()).max_element();
    let cell = (all.size().max_element() / 2f64.powi(40)).max(farthest / 2f64.powi(53));
    // The power of two at or below, without logarithms: the exponent's bits alone.
    let floor = f64::from_bits(cell.to_bits() & (0x7ff << 52));
    let cell = if floor < cell { floor * 2.0 } else { floor };
    (cell.is_normal() && cell.is_finite()).then_some(cell)
}

fn solve(subject: &Subject, mask: &Mask, op: BooleanOp, chosen: &Options) -> Result<CoverageCut> {
    let bounds = [subject.shapes().bounds(), mask.near.shapes.bounds()];
    let options = overlay::Options {
        subject_rule: chosen.rule,
        clip_rule: WindingRule::EvenOdd,
        grid: finest_grid(bounds),
        origins: true,
        drop_collinear: false,
        work: chosen.work.clone(),
    };
    let output = overlay(subject.shapes(), &mask.near.shapes, op, &options, &mut NoTrace)?;
    Ok(place::place(subject, mask, chosen.keep, output))
}

#[cfg(test)]
mod tests;
