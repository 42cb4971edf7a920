//! The code that parametric methods share: a segment enters and leaves a convex window at two
//! parameters, those of the last border crossed inwards and of the first crossed outwards.

use super::border::Canonical;
use super::convex::{self, HalfSpace};
use super::{End, Segment};
use crate::clip::exact::EPSILON;
use crate::trace::{PseudocodeLine, Tracer};
use std::cmp::Ordering;

/// Step of an algorithm, in the direction of the caller's segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step<P> {
    /// A border was examined. Liang and Barsky examine every border of a rectangle or box; otherwise the search ends at
    /// the first border that both ends are beyond.
    Border {
        /// Its index in the window; of a rectangle or box 2·axis, plus 1 for the larger coordinate.
        border: usize,
        /// Relation of the segment to it; [`HalfSpaceRelation::Entering`] raises the lower bound of the
        /// parameter, [`HalfSpaceRelation::Leaving`] lowers the upper.
        relation: HalfSpaceRelation,
        /// Numbers computed for the border.
        numbers: Numbers,
    },
    /// One end moves to the border that bounds it.
    Cut {
        /// End that moves.
        end: End,
        /// The border's index.
        border: usize,
        /// New position of the end.
        point: P,
    },
    /// The rest is inside.
    Accepted,
    /// The lower bound passed the upper, or a border has both ends beyond it.
    Rejected,
}

impl<P> PseudocodeLine for Step<P> {
    /// Returns the line of the pseudocode that runs, counted from 1; it is the same for all methods of this kind.
    fn line(&self) -> usize {
        match self {
            Self::Border { relation: HalfSpaceRelation::Inside, .. } => 3,
            Self::Border { relation: HalfSpaceRelation::Entering, .. } => 4,
            Self::Border { relation: HalfSpaceRelation::Leaving, .. } => 5,
            Self::Border { relation: HalfSpaceRelation::Outside, .. } => 6,
            Self::Rejected => 7,
            Self::Cut { end: End::Start, .. } => 8,
            Self::Cut { end: End::End, .. } => 9,
            Self::Accepted => 10,
        }
    }
}

/// The numbers of a border as the methods are taught; rounded, while the decisions are exact.
///
/// E(P) = n · (P − Q) has a normal n that points inwards, and Q on the border: E ≥ 0 inside. It is q of Liang and
/// Barsky, the boundary coordinate d of Blinn and Newell; with Cyrus and Beck's outer normal it has the other sign.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Numbers {
    /// E of the segment's start: q.
    pub start: f64,
    /// E of its end.
    pub end: f64,
    /// The lower bound of the parameter after this border: u₁, or t_e.
    pub lower: f64,
    /// The upper bound: u₂, or t_l.
    pub upper: f64,
}

impl Numbers {
    /// Returns p of Liang and Barsky, the product of the outer normal and the segment's direction: if it is negative,
    /// the segment enters; if it is positive, it leaves; if it is zero, it runs along the border.
    pub fn p(&self) -> f64 {
        self.start - self.end
    }

    /// Returns the parameter at which the segment's line crosses the border, r = q / p: 0 at the start, 1 at
    /// the end; none along the border.
    pub fn t(&self) -> Option<f64> {
        // A quarter of each, because the difference of two huge values overflows.
        let p = self.start * 0.25 - self.end * 0.25;
        (p != 0.0).then(|| self.start * 0.25 / p)
    }
}

/// The bounds of the parameter in the steps: from 0 to 1 before the first border.
#[derive(Clone, Copy)]
pub(super) struct Bounds {
    lower: f64,
    upper: f64,
}

impl Bounds {
    pub const WHOLE: Self = Self { lower: 0.0, upper: 1.0 };

    /// Updates the bounds by the next border, and returns the step.
    pub fn step<const N: usize, P>(
        &mut self,
        line: &Canonical<N>,
        border: usize,
        relation: HalfSpaceRelation,
        values: [f64; 2],
    ) -> Step<P> {
        let [start, end] = if line.swapped { [values[1], values[0]] } else { values };
        let mut numbers = Numbers { start, end, lower: self.lower, upper: self.upper };
        if let Some(t) = numbers.t() {
            if numbers.p() < 0.0 {
                self.lower = self.lower.max(t);
            } else {
                self.upper = self.upper.min(t);
            }
        }
        (numbers.lower, numbers.upper) = (self.lower, self.upper);
        Step::Border { border, relation: relation.reversed_if(line.swapped), numbers }
    }
}

/// Returns the result that a list of steps leads to.
pub fn replay<P: Copy>(mut segment: Segment<P>, steps: &[Step<P>]) -> Option<Segment<P>> {
    for step in steps {
        match *step {
            Step::Border { .. } => {}
            Step::Cut { end, point, .. } => segment = segment.moved(end, point),
            Step::Accepted => return Some(segment),
            Step::Rejected => return None,
        }
    }
    None
}

/// Returns the part of a segment in the intersection of half spaces; `at(b)` is its point on border
/// b.
pub(super) fn clip<const N: usize, P: From<[f64; N]>, H: HalfSpace<N>>(
    spaces: &[H],
    segment: Segment<P>,
    line: &Canonical<N>,
    at: impl Fn(usize) -> [f64; N],
    t: &mut impl Tracer<Step<P>>,
) -> Option<Segment<P>> {
    let mut bounds = Bounds::WHOLE;
    let report = |border: usize, relation| {
        t.step(|| {
            let values = [line.p, line.q].map(|p| spaces[border].value(p).0);
            bounds.step(line, border, relation, values)
        });
    };
    let Some(passage) = passage(spaces, line, report) else {
        t.step(|| Step::Rejected);
        return None;
    };
    let cut = |border: Option<usize>| border.map(|b| (b, at(b)));
    Some(finish(segment, line, cut(passage.entering), cut(passage.leaving), t))
}

/// Clips a segment as [`clip`], with the cut points of [`convex::crossing`].
pub(super) fn clip_convex<const N: usize, P: From<[f64; N]>, H: HalfSpace<N>>(
    spaces: &[H],
    segment: Segment<P>,
    line: &Canonical<N>,
    t: &mut impl Tracer<Step<P>>,
) -> Option<Segment<P>> {
    clip(spaces, segment, line, |b| convex::crossing(spaces, b, line), t)
}

/// Puts the cut points in place of the ends, in the caller's direction.
#[inline]
pub(super) fn finish<const N: usize, P: From<[f64; N]>>(
    segment: Segment<P>,
    line: &Canonical<N>,
    lower: Option<(usize, [f64; N])>,
    upper: Option<(usize, [f64; N])>,
    t: &mut impl Tracer<Step<P>>,
) -> Segment<P> {
    let [first, last] = if line.swapped { [upper, lower] } else { [lower, upper] };
    for (cut, end) in [(first, End::Start), (last, End::End)] {
        if let Some((border, point)) = cut {
            t.step(|| Step::Cut { end, border, point: point.into() });
        }
    }
    t.step(|| Step::Accepted);
    match (lower, upper) {
        (None, None) => segment,
        (p, q) => line.in_order(p.map_or(line.p, |p| p.1), q.map_or(line.q, |q| q.1)),
    }
}

/// Relation of a segment to one half space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HalfSpaceRelation {
    /// Both ends inside: nothing to do.
    Inside,
    /// Both ends outside: the segment is rejected.
    Outside,
    /// The start is outside, the end inside.
    Entering,
    /// The start is inside, the end outside.
    Leaving,
}

impl HalfSpaceRelation {
    /// Returns the relation of the segment in the other direction if `swapped`.
    fn reversed_if(self, swapped: bool) -> Self {
        match self {
            Self::Entering if swapped => Self::Leaving,
            Self::Leaving if swapped => Self::Entering,
            same => same,
        }
    }

    /// Returns the relation by whether the start and the end are inside.
    pub(super) fn of(inside: [bool; 2]) -> Self {
        match inside {
            [true, true] => Self::Inside,
            [false, false] => Self::Outside,
            [false, true] => Self::Entering,
            [true, false] => Self::Leaving,
        }
    }
}

/// The borders through which a segment enters and leaves; `None` for an end that is inside.
#[derive(Debug, Clone, Copy, Default)]
struct Passage {
    entering: Option<usize>,
    leaving: Option<usize>,
}

/// Finds the last border entered and the first one left; `None` if the segment misses the intersection of the half
/// spaces. `report` is called for every half space examined.
fn passage<const N: usize, H: HalfSpace<N>>(
    spaces: &[H],
    line: &Canonical<N>,
    mut report: impl FnMut(usize, HalfSpaceRelation),
) -> Option<Passage> {
    let mut passage = Passage::default();
    for (i, space) in spaces.iter().enumerate() {
        let relation = relate(space, line);
        report(i, relation);
        // If several borders are crossed at the same point, the first in the list is reported.
        match relation {
            HalfSpaceRelation::Inside => {}
            HalfSpaceRelation::Outside => return None,
            HalfSpaceRelation::Entering => {
                let later = |&e: &usize| crossing_order(&spaces[e], space, line) == Ordering::Less;
                if passage.entering.is_none_or(|e| later(&e)) {
                    passage.entering = Some(i);
                }
            }
            HalfSpaceRelation::Leaving => {
                let sooner =
                    |&l: &usize| crossing_order(&spaces[l], space, line) == Ordering::Greater;
                if passage.leaving.is_none_or(|l| sooner(&l)) {
                    passage.leaving = Some(i);
                }
            }
        }
    }
    let missed = passage
        .entering
        .zip(passage.leaving)
        .is_some_and(|(e, l)| crossing_order(&spaces[e], &spaces[l], line) == Ordering::Greater);
    (!missed).then_some(passage)
}

fn relate<const N: usize, H: HalfSpace<N>>(space: &H, line: &Canonical<N>) -> HalfSpaceRelation {
    HalfSpaceRelation::of([line.p, line.q].map(|p| space.sign(p) != Ordering::Less))
}

/// Returns the exact order along the segment of its crossings with two borders, both of which it
/// spans.
fn crossing_order<const N: usize, H: HalfSpace<N>>(a: &H, b: &H, line: &Canonical<N>) -> Ordering {
    let ((ap, ap_off), (aq, aq_off)) = (a.value(line.p), a.value(line.q));
    let ((bp, bp_off), (bq, bq_off)) = (b.value(line.p), b.value(line.q));
    // t = E(p) / (E(p) − E(q)), so the sign of a's t minus b's is that of this determinant, seen
    // from the direction in which each border is crossed.
    let (left, right) = (bp * aq, ap * bq);
    let bound = bp_off * aq.abs()
        + (bp.abs() + bp_off) * aq_off
        + ap_off * bq.abs()
        + (ap.abs() + ap_off) * bq_off
        + (left.abs() + right.abs()) * (4.0 * EPSILON);
    let det = left - right;
    let order = if det.abs() > bound && bound > 1e-280 {
        det.total_cmp(&0.0)
    } else {
        let left = b.exact(line.p) * a.exact(line.q);
        (left - a.exact(line.p) * b.exact(line.q)).sign()
    };
    let entering = |h: &H| h.sign(line.p) == Ordering::Less;
    if entering(a) == entering(b) { order } else { order.reverse() }
}
