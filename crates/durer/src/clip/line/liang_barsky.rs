//! Liang–Barsky line clipping.
//!
//! You-Dong Liang and Brian Barsky, "A new concept and method for line clipping", ACM Transactions
//! on Graphics 3(1), 1984. Object space; O(1) for rectangle and box, O(n) for n half-planes. The
//! segment is p + t·(q − p); each border bounds t from below where it is crossed inwards and from
//! above where it is crossed outwards; the part between the bounds is visible.
//!
//! The bounds are compared as numbers where rounding cannot matter and exactly where it could.

use super::border::{Canonical, bit};
use super::passage::{Bounds, clip_convex, finish};
use super::{ClipBox, HalfPlane, HalfSpaceRelation, Segment};
use crate::clip::outcode::Outcode;
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, DVec3, Rect};
use crate::trace::Tracer;
use crate::{Error, Result};
use std::cmp::Ordering;

pub use super::passage::{Numbers, Step, replay};

/// The facts of Liang–Barsky clipping.
pub const INFO: Info = Info {
    name: "liang-barsky",
    title: "Liang–Barsky",
    authors: "You-Dong Liang, Brian A. Barsky",
    year: 1984,
    source: "A new concept and method for line clipping, ACM Transactions on Graphics 3(1)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(1) per segment; at most two cut points are computed",
    limits: "rectangle, box, and intersections of half-planes",
    pseudocode: &[
        "u1 := 0; u2 := 1",
        "for each border k = left, right, bottom, top:",
        "    p := −, + Δx, −, + Δy; q := distance of A inwards; r := q/p, unless p = 0",
        "    p < 0, entered from outside: u1 := max(u1, r)",
        "    p > 0, left to outside: u2 := min(u2, r)",
        "    A and B outside (p = 0 and q < 0, too): nothing is visible",
        "if u1 > u2, or all is outside a border: reject, stop",
        "if u1 > 0: the start is A + u1·(B − A)",
        "if u2 < 1: the end is A + u2·(B − A)",
        "accept the part between",
    ],
};

/// Returns the part of a segment in the closed rectangle.
///
/// # Errors
/// [`crate::Error::NonFinite`] for a NaN or infinite coordinate.
#[inline]
pub fn clip(
    window: &Rect,
    segment: Segment<DVec2>,
    t: &mut impl Tracer<Step<DVec2>>,
) -> Result<Option<Segment<DVec2>>> {
    run(&window.into(), segment, segment.start.to_array(), segment.end.to_array(), t)
}

/// Returns the part of a segment in the closed box.
///
/// # Errors
/// [`crate::Error::NonFinite`] for a NaN or infinite coordinate.
pub fn clip_box(
    window: &ClipBox<3>,
    segment: Segment<DVec3>,
    t: &mut impl Tracer<Step<DVec3>>,
) -> Result<Option<Segment<DVec3>>> {
    run(window, segment, segment.start.to_array(), segment.end.to_array(), t)
}

/// Returns the part of a segment in the intersection of closed half-planes, which may be unbounded:
/// with E(P) = n · (P − Q), the border is crossed at t = E(p) / (E(p) − E(q)).
///
/// ```
/// use durer::clip::line::{HalfPlane, Segment, liang_barsky};
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// let above = HalfPlane { normal: DVec2::Y, point: DVec2::ZERO };
/// let segment = Segment::new(DVec2::new(0.0, -1.0), DVec2::new(2.0, 1.0));
/// let clipped = liang_barsky::clip_half_planes(&[above], segment, &mut NoTrace)?;
/// assert_eq!(clipped, Some(Segment::new(DVec2::new(1.0, 0.0), DVec2::new(2.0, 1.0))));
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`crate::Error::NonFinite`] for a NaN or infinite coordinate, of the segment or a half-plane.
pub fn clip_half_planes(
    window: &[HalfPlane],
    segment: Segment<DVec2>,
    t: &mut impl Tracer<Step<DVec2>>,
) -> Result<Option<Segment<DVec2>>> {
    for (index, plane) in window.iter().enumerate() {
        if !(plane.normal.is_finite() && plane.point.is_finite()) {
            return Err(Error::NonFinite { what: "half-plane", index });
        }
    }
    let line = Canonical::new(segment.start.to_array(), segment.end.to_array())?;
    Ok(clip_convex(window, segment, &line, t))
}

#[inline]
fn run<const N: usize, P: From<[f64; N]>>(
    window: &ClipBox<N>,
    segment: Segment<P>,
    start: [f64; N],
    end: [f64; N],
    t: &mut impl Tracer<Step<P>>,
) -> Result<Option<Segment<P>>> {
    let line = Canonical::new(start, end)?;
    // A border that neither end lies beyond bounds t outside 0 … 1; one that both lie beyond
    // rejects, segments parallel to it included.
    let (outside_p, outside_q) = (window.code(line.p), window.code(line.q));
    report(window, &line, [outside_p, outside_q], t);
    if !(outside_p & outside_q).is_inside() {
        t.step(|| Step::Rejected);
        return Ok(None);
    }
    let lower = tightest(window, &line, outside_p, Ordering::Greater);
    let upper = tightest(window, &line, outside_q, Ordering::Less);
    let at = |b: usize| (b >> 1, window.borders[b >> 1][b & 1]);
    if let Some((l, u)) = lower.zip(upper)
        && line.compare_parameters(at(l), at(u)) == Ordering::Greater
    {
        t.step(|| Step::Rejected);
        return Ok(None);
    }
    let cut = |border: Option<usize>| border.map(|b| (b, line.cut(window, b >> 1, b & 1)));
    Ok(Some(finish(segment, &line, cut(lower), cut(upper), t)))
}

/// Reports every border to a tracer, in order, crossed or not.
fn report<const N: usize, P>(
    window: &ClipBox<N>,
    line: &Canonical<N>,
    outside: [Outcode; 2],
    t: &mut impl Tracer<Step<P>>,
) {
    let mut bounds = Bounds::WHOLE;
    for border in 0..2 * N {
        t.step(|| {
            let (axis, upper) = (border >> 1, border & 1);
            let at = window.borders[axis][upper];
            let inwards = if upper == 0 { 1.0 } else { -1.0 };
            let values = [line.p, line.q].map(|p| inwards * (p[axis] - at));
            let relation =
                HalfSpaceRelation::of(outside.map(|code| !code.contains(bit(axis, upper))));
            bounds.step(line, border, relation, values)
        });
    }
}

/// Returns the border in `code` with the largest (`Greater`) or smallest (`Less`) parameter.
#[inline]
fn tightest<const N: usize>(
    window: &ClipBox<N>,
    line: &Canonical<N>,
    code: Outcode,
    wanted: Ordering,
) -> Option<usize> {
    let mut best: Option<usize> = None;
    let at = |b: usize| (b >> 1, window.borders[b >> 1][b & 1]);
    for border in (0..2 * N).filter(|&b| code.contains(bit(b >> 1, b & 1))) {
        if best.is_none_or(|b| line.compare_parameters(at(border), at(b)) == wanted) {
            best = Some(border);
        }
    }
    best
}
