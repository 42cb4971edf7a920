//! The floating horizon as published: curve by curve, with two arrays.
//!
//! T. J. Wright, *A Two-space Solution to the Hidden Line Problem for Plotting Functions of Two Variables*, IEEE
//! Transactions on Computers C-22(1), 1973; ends of curves after D. F. Rogers, *Procedural Elements for Computer
//! Graphics*, 1985, section 4-2. Image space. Curves come from near to far. Two arrays have, for each column, the
//! highest and the lowest y so far. A point is seen if it lies above the upper horizon or below the lower one, and then
//! raises or lowers it; where a curve passes a horizon between two columns, the crossing is interpolated. Coherence
//! used: scan lines, from curve to curve. Cost: O(curves · columns) time, O(columns) memory.
//!
//! Limits: between columns horizons are straight, so features narrower than a column may be lost, and crossings are
//! only as exact as the column width. [`super::floating_horizon`] has neither of these limits.

use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec2;
use crate::trace::{PseudocodeLine, Tracer};
use crate::work::Work;
use crate::{Error, Result};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "horizon-curves",
    title: "Floating horizon, curve by curve",
    authors: "T. J. Wright",
    year: 1973,
    source: "A Two-space Solution to the Hidden Line Problem for Plotting Functions of Two Variables, IEEE TC",
    class: Class::ImageSpace,
    occluder: Occluder::Line,
    coherence: &[Coherence::Edge],
    cost: "O(curves · columns) time, O(columns) memory",
    limits: "curves in columns, near ones first; exact to a column's width",
    pseudocode: &[
        "upper[x] ← −∞, lower[x] ← ∞ for each column x",
        "for each curve, from near to far:",
        "    for each of its points (x, y):",
        "        visible if y ≥ upper[x] or y ≤ lower[x], else hidden",
        "    for each two neighbouring points:",
        "        both visible on the same side: draw the line between them",
        "        else: interpolate where it passes the horizon,",
        "              and draw its visible part",
        "    for each point: upper[x] ← max(upper[x], y), lower[x] ← min(lower[x], y)",
        "    raise the horizons along the line to the ends of the curve before",
    ],
};

/// Options for drawing curves.
#[derive(Debug, Clone)]
pub struct Options {
    /// Columns of the picture.
    pub columns: usize,
    /// True if the horizons extend along the line from the end of a curve to the end of the next
    /// one, on both sides; otherwise curves that begin further out show through the gap.
    pub fill_ends: bool,
    /// Budget of memory.
    pub work: Work,
}

impl Options {
    /// Creates a picture of this many columns, with gaps at the ends filled.
    pub fn columns(columns: usize) -> Self {
        Self { columns, fill_ends: true, work: Work::default() }
    }
}

/// A curve by its heights in columns that follow each other, y up.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ColumnCurve {
    /// The first column.
    pub first: usize,
    /// y there and in the columns that follow.
    pub heights: Vec<f64>,
}

/// Position of a point relative to the horizons.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum HorizonSide {
    /// On the upper horizon or above it: visible.
    Above,
    /// Between the horizons: hidden.
    Hidden,
    /// On the lower horizon or below it: visible.
    Below,
}

/// A piece of a curve that is seen, within two neighbouring columns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisiblePiece {
    /// The curve's index.
    pub curve: usize,
    /// Its ends, x in columns, from left to right.
    pub ends: [DVec2; 2],
    /// Horizon beyond which it is.
    pub seen: HorizonSide,
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A point of a curve was compared with both horizons.
    Point {
        /// The curve.
        curve: usize,
        /// The column.
        column: usize,
        /// Its y.
        y: f64,
        /// The lower and the upper horizon there.
        horizons: [f64; 2],
        /// Position relative to both.
        seen: HorizonSide,
    },
    /// A curve passes a horizon between two columns.
    Crossing {
        /// The curve.
        curve: usize,
        /// x in columns, and y.
        at: DVec2,
    },
    /// A piece is drawn.
    Draw(VisiblePiece),
    /// A horizon has a new height.
    Horizon {
        /// The column.
        column: usize,
        /// The lower and the upper horizon.
        horizons: [f64; 2],
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Point { .. } => 4,
            Self::Crossing { .. } => 7,
            Self::Draw(_) => 8,
            Self::Horizon { .. } => 9,
        }
    }
}

/// Returns the result that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<VisiblePiece> {
    let piece = |step: &Step| if let Step::Draw(piece) = *step { Some(piece) } else { None };
    steps.iter().filter_map(piece).collect()
}

/// Returns the seen pieces of curves, the nearest curve first; columns beyond the picture's are
/// left out.
///
/// ```
/// use durer::trace::NoTrace;
/// use durer::visibility::line::horizon_curves::{ColumnCurve, Options, draw};
///
/// let curve = |heights: [f64; 3]| ColumnCurve { first: 0, heights: heights.to_vec() };
/// // A hill before a lower ridge, which comes out on both sides of it and below its top.
/// let curves = [curve([0.0, 2.0, 0.0]), curve([1.0, 1.0, 1.0])];
/// let pieces = draw(&curves, &Options::columns(3), &mut NoTrace)?;
/// let ridge: Vec<_> = pieces.iter().filter(|p| p.curve == 1).map(|p| p.ends.map(|e| e.x)).collect();
/// assert_eq!(ridge, [[0.0, 0.5], [0.5, 1.0], [1.0, 1.5], [1.5, 2.0]]);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::NonFinite`] for a height that is NaN or infinite, with the curve's index; [`Error::Memory`] where the
/// budget does not suffice.
pub fn draw(
    curves: &[ColumnCurve],
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Vec<VisiblePiece>> {
    let finite = |curve: &ColumnCurve| curve.heights.iter().all(|y| y.is_finite());
    if let Some(index) = curves.iter().position(|curve| !finite(curve)) {
        return Err(Error::NonFinite { what: "curve", index });
    }
    let count = options.columns as u64;
    let _held = options.work.charge_for::<[f64; 2]>("horizons", count)?;
    options.work.room_for::<[f64; 2]>("horizons", count)?;
    let mut horizons = Horizons(vec![[f64::INFINITY, f64::NEG_INFINITY]; options.columns]);
    let (mut pieces, mut before): (Vec<VisiblePiece>, Option<[DVec2; 2]>) = (Vec::new(), None);
    for (number, curve) in curves.iter().enumerate() {
        let shown = options.columns.saturating_sub(curve.first).min(curve.heights.len());
        let heights = &curve.heights[..shown];
        let Some(ends) = ends(curve.first, heights) else { continue };
        let states = horizons.compare(number, curve.first, heights, t);
        for (k, pair) in states.windows(2).enumerate() {
            horizons.pieces(
                number,
                [curve.first + k, k],
                heights,
                [pair[0], pair[1]],
                &mut pieces,
                t,
            );
        }
        horizons.float(curve.first, heights, t);
        if let Some(before) = before.filter(|_| options.fill_ends) {
            (0..2).for_each(|end| horizons.fill(before[end], ends[end], t));
        }
        before = Some(ends);
    }
    Ok(pieces)
}

/// Returns the first and the last point of a curve.
fn ends(first: usize, heights: &[f64]) -> Option<[DVec2; 2]> {
    let (start, end) = (heights.first()?, heights.last()?);
    let last = first + heights.len() - 1;
    Some([DVec2::new(first as f64, *start), DVec2::new(last as f64, *end)])
}

/// For each column the lower and the upper horizon; apart the wrong way round if there is none yet.
struct Horizons(Vec<[f64; 2]>);

impl Horizons {
    fn compare(
        &self,
        curve: usize,
        first: usize,
        heights: &[f64],
        t: &mut impl Tracer<Step>,
    ) -> Vec<HorizonSide> {
        let of = |(column, &y): (usize, &f64)| {
            let horizons @ [lower, upper] = self.0[column];
            let seen = if y >= upper {
                HorizonSide::Above
            } else if y <= lower {
                HorizonSide::Below
            } else {
                HorizonSide::Hidden
            };
            t.step(|| Step::Point { curve, column, y, horizons, seen });
            seen
        };
        (first..).zip(heights).map(of).collect()
    }

    /// Draws the visible pieces of a curve between a column and the next one; `k` is the first
    /// one's place in the curve.
    fn pieces<T: Tracer<Step>>(
        &self,
        curve: usize,
        [column, k]: [usize; 2],
        heights: &[f64],
        states: [HorizonSide; 2],
        pieces: &mut Vec<VisiblePiece>,
        t: &mut T,
    ) {
        let ys = [heights[k], heights[k + 1]];
        let at = |s: f64| DVec2::new(column as f64 + s, ys[0] + (ys[1] - ys[0]) * s);
        let mut draw = |from: f64, to: f64, seen: HorizonSide, t: &mut T| {
            if from < to {
                let piece = VisiblePiece { curve, ends: [at(from), at(to)], seen };
                t.step(|| Step::Draw(piece));
                pieces.push(piece);
            }
        };
        if states[0] == states[1] {
            if states[0] != HorizonSide::Hidden {
                draw(0.0, 1.0, states[0], t);
            }
            return;
        }
        let cut = |seen: HorizonSide| self.crossing(column, ys, seen);
        let [start, end] =
            states.map(|seen| if seen == HorizonSide::Hidden { None } else { cut(seen) });
        // Once where a curve goes behind a horizon, twice where it comes out beyond the other.
        let mut last = None;
        for s in [start, end].into_iter().flatten().filter(|s| last.replace(*s) != Some(*s)) {
            t.step(|| Step::Crossing { curve, at: at(s) });
        }
        if let Some(s) = start {
            draw(0.0, s, states[0], t);
        }
        if let Some(s) = end {
            draw(s, 1.0, states[1], t);
        }
    }

    /// Returns the place at which a curve passes a horizon, from 0 at a column to 1 at the next.
    fn crossing(&self, column: usize, ys: [f64; 2], seen: HorizonSide) -> Option<f64> {
        let which = usize::from(seen == HorizonSide::Above);
        let [a, b] = [self.0[column][which] - ys[0], self.0[column + 1][which] - ys[1]];
        // One column may have no horizon yet: there all is seen, up to the other.
        if !a.is_finite() || !b.is_finite() {
            return Some(if a.is_finite() { 0.0 } else { 1.0 });
        }
        Some(if a == b { 0.0 } else { (a / (a - b)).clamp(0.0, 1.0) })
    }

    /// Raises the upper horizon and lowers the lower one to a curve.
    fn float(&mut self, first: usize, heights: &[f64], t: &mut impl Tracer<Step>) {
        for (column, &y) in (first..).zip(heights) {
            let [lower, upper] = self.0[column];
            let horizons = [lower.min(y), upper.max(y)];
            if horizons != self.0[column] {
                self.0[column] = horizons;
                t.step(|| Step::Horizon { column, horizons });
            }
        }
    }

    /// Raises the upper horizon and lowers the lower one to the line between the ends of two curves.
    fn fill(&mut self, from: DVec2, to: DVec2, t: &mut impl Tracer<Step>) {
        let (from, to) = if from.x <= to.x { (from, to) } else { (to, from) };
        let columns = from.x as usize..=to.x as usize;
        let slope = if to.x > from.x { (to.y - from.y) / (to.x - from.x) } else { 0.0 };
        let first = *columns.start();
        let heights: Vec<f64> = columns.map(|x| from.y + slope * (x as f64 - from.x)).collect();
        self.float(first, &heights, t);
    }
}
