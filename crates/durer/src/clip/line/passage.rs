//! What the parametric methods share: a segment enters and leaves a convex window at two parameters,
//! those of the last border crossed inwards and of the first crossed outwards.

use super::border::Canonical;
use super::convex::{self, HalfSpace};
use super::{End, Segment};
use crate::clip::exact::EPSILON;
use crate::trace::Tracer;
use std::cmp::Ordering;

/// What an algorithm did; borders are looked at from the lexicographically smaller end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step<P> {
    /// A border was looked at: all of them by Cyrus and Beck and in homogeneous coordinates; by Liang
    /// and Barsky those that now bound the parameter.
    Border {
        /// Its index in the window; of a rectangle or box 2·axis, plus 1 for the larger coordinate.
        border: usize,
        /// How the segment lies to it; [`Relation::Entering`] raises the lower bound of the parameter,
        /// [`Relation::Leaving`] lowers the upper.
        relation: Relation,
    },
    /// One end moves to the border that bounds it.
    Cut {
        /// Which end.
        end: End,
        /// The border's index.
        border: usize,
        /// Where the end is now.
        point: P,
    },
    /// What is left is inside.
    Accepted,
    /// The lower bound passed the upper, or a border has both ends beyond it.
    Rejected,
}

/// The result that a list of steps leads to.
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

/// The part of a segment in the intersection of half spaces; `at(b)` is its point on border b.
pub(super) fn clip<const N: usize, P: From<[f64; N]>, H: HalfSpace<N>>(
    spaces: &[H],
    segment: Segment<P>,
    line: &Canonical<N>,
    at: impl Fn(usize) -> [f64; N],
    t: &mut impl Tracer<Step<P>>,
) -> Option<Segment<P>> {
    let report = |border, relation| t.step(|| Step::Border { border, relation });
    let Some(passage) = passage(spaces, line, report) else {
        t.step(|| Step::Rejected);
        return None;
    };
    let cut = |border: Option<usize>| border.map(|b| (b, at(b)));
    Some(finish(segment, line, cut(passage.entering), cut(passage.leaving), t))
}

/// The same with the cut points of [`convex::crossing`].
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
    for (cut, end) in [(lower, End::Start), (upper, End::End)] {
        if let Some((border, point)) = cut {
            let end = end.swapped_if(line.swapped);
            t.step(|| Step::Cut { end, border, point: point.into() });
        }
    }
    t.step(|| Step::Accepted);
    match (lower, upper) {
        (None, None) => segment,
        (p, q) => line.in_order(p.map_or(line.p, |p| p.1), q.map_or(line.q, |q| q.1)),
    }
}

/// How a canonical segment lies to one half space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Relation {
    /// Both ends inside: nothing to do.
    Inside,
    /// Both ends outside: the segment is rejected.
    Outside,
    /// The start is outside, the end inside.
    Entering,
    /// The start is inside, the end outside.
    Leaving,
}

/// The borders through which a segment enters and leaves; `None` for an end that is inside.
#[derive(Debug, Clone, Copy, Default)]
struct Passage {
    entering: Option<usize>,
    leaving: Option<usize>,
}

/// Finds the last border entered and the first one left; `None` where the segment misses the
/// intersection of the half spaces. `report` hears of every half space looked at.
fn passage<const N: usize, H: HalfSpace<N>>(
    spaces: &[H],
    line: &Canonical<N>,
    mut report: impl FnMut(usize, Relation),
) -> Option<Passage> {
    let mut passage = Passage::default();
    for (i, space) in spaces.iter().enumerate() {
        let relation = relate(space, line);
        report(i, relation);
        // Of several borders crossed at the same point, the first listed is named.
        match relation {
            Relation::Inside => {}
            Relation::Outside => return None,
            Relation::Entering => {
                let later = |&e: &usize| crossing_order(&spaces[e], space, line) == Ordering::Less;
                if passage.entering.is_none_or(|e| later(&e)) {
                    passage.entering = Some(i);
                }
            }
            Relation::Leaving => {
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

fn relate<const N: usize, H: HalfSpace<N>>(space: &H, line: &Canonical<N>) -> Relation {
    let inside = [line.p, line.q].map(|p| space.sign(p) != Ordering::Less);
    match inside {
        [true, true] => Relation::Inside,
        [false, false] => Relation::Outside,
        [false, true] => Relation::Entering,
        [true, false] => Relation::Leaving,
    }
}

/// The exact order along the segment of its crossings with two borders, both of which it spans.
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
