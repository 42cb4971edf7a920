//! Cohen–Sutherland line clipping.
//!
//! Danny Cohen and Ivan Sutherland, about 1967; in print in Newman & Sproull, *Principles of
//! Interactive Computer Graphics* (1973). Object space; O(1), at most one cut per border.
//! Two outcodes accept (OR = 0) or reject (AND ≠ 0) most segments; for the rest, the end that is
//! outside moves to a border whose bit is set, until one of the two tests decides.
//!
//! We deviate in one point: every cut is computed from the original ends, and its outcode exactly,
//! so rounding does not pile up over several cuts and a corner touch is never judged wrong.

use super::border::{Canonical, Cut, lowest_border};
use super::{ClipBox, End, Segment};
use crate::Result;
use crate::clip::outcode::Outcode;
use crate::info::{Class, Info};
use crate::math::{DVec2, DVec3, Rect};
use crate::trace::Tracer;

/// The facts of Cohen–Sutherland clipping.
pub const INFO: Info = Info {
    name: "cohen-sutherland",
    title: "Cohen–Sutherland",
    authors: "Danny Cohen, Ivan Sutherland",
    year: 1967,
    source: "Newman & Sproull, Principles of Interactive Computer Graphics, 1973",
    class: Class::ObjectSpace,
    cost: "O(1) per segment; at most one cut per border",
    limits: "axis-parallel windows: rectangle and box",
};

/// There is nothing to choose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options;

/// What the algorithm did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step<P> {
    /// The codes of both ends, in the caller's order.
    Codes {
        /// Of the start.
        start: Outcode,
        /// Of the end.
        end: Outcode,
    },
    /// OR of the codes is empty: what is left lies inside.
    Accepted,
    /// AND of the codes is not empty: everything left lies beyond one border.
    Rejected,
    /// One end moved to a border.
    Cut {
        /// Which end.
        end: End,
        /// The border; one bit.
        border: Outcode,
        /// Where the end is now.
        point: P,
        /// The code of the new end.
        code: Outcode,
    },
}

/// The result that a list of steps leads to.
pub fn replay<P: Copy>(mut segment: Segment<P>, steps: &[Step<P>]) -> Option<Segment<P>> {
    for step in steps {
        match *step {
            Step::Codes { .. } => {}
            Step::Accepted => return Some(segment),
            Step::Rejected => return None,
            Step::Cut { end, point, .. } => segment = segment.moved(end, point),
        }
    }
    None
}

/// The part of a segment in the closed rectangle.
///
/// ```
/// use durer::clip::line::{Segment, cohen_sutherland};
/// use durer::math::{DVec2, Rect};
/// use durer::trace::NoTrace;
///
/// let window = Rect::new(DVec2::ZERO, DVec2::ONE)?;
/// let touching = Segment::new(DVec2::new(0.5, 1.5), DVec2::new(1.5, 0.5));
/// let clipped = cohen_sutherland::clip(&window, touching, &mut NoTrace)?;
/// assert_eq!(clipped, Some(Segment::new(DVec2::ONE, DVec2::ONE)));
/// # Ok::<(), durer::Error>(())
/// ```
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

/// The part of a segment in the closed box; six-bit outcodes.
///
/// # Errors
/// [`crate::Error::NonFinite`] for a NaN or infinite coordinate.
#[inline]
pub fn clip_box(
    window: &ClipBox<3>,
    segment: Segment<DVec3>,
    t: &mut impl Tracer<Step<DVec3>>,
) -> Result<Option<Segment<DVec3>>> {
    run(window, segment, segment.start.to_array(), segment.end.to_array(), t)
}

#[inline]
fn run<const N: usize, P: From<[f64; N]>>(
    window: &ClipBox<N>,
    segment: Segment<P>,
    start: [f64; N],
    end: [f64; N],
    t: &mut impl Tracer<Step<P>>,
) -> Result<Option<Segment<P>>> {
    let (code_start, code_end) = (window.code(start), window.code(end));
    t.step(|| Step::Codes { start: code_start, end: code_end });
    if (code_start | code_end).is_inside() {
        t.step(|| Step::Accepted);
        return Ok(Some(segment));
    }
    let line = Canonical::new(start, end)?;
    if !(code_start & code_end).is_inside() {
        t.step(|| Step::Rejected);
        return Ok(None);
    }
    let mut codes = if line.swapped { [code_end, code_start] } else { [code_start, code_end] };
    let mut ends = [line.p, line.q];
    // Each turn clears at least one bit for good, so 2·N·2 turns would be the end in any case.
    while !(codes[0] | codes[1]).is_inside() {
        if !(codes[0] & codes[1]).is_inside() {
            t.step(|| Step::Rejected);
            return Ok(None);
        }
        let which = usize::from(codes[0].is_inside());
        let (axis, upper) = lowest_border(codes[which]);
        let cut = short_cut(&line, window, axis, upper);
        (ends[which], codes[which]) = (cut.point, cut.code);
        t.step(|| Step::Cut {
            end: [End::Start, End::End][which].swapped_if(line.swapped),
            border: super::border::bit(axis, upper),
            point: cut.point.into(),
            code: cut.code,
        });
    }
    t.step(|| Step::Accepted);
    Ok(Some(line.in_order(ends[0], ends[1])))
}

/// The cut with a border; segments parallel to the axis take the short way without arithmetic.
#[inline]
fn short_cut<const N: usize>(
    line: &Canonical<N>,
    window: &ClipBox<N>,
    axis: usize,
    upper: usize,
) -> Cut<N> {
    if N == 2 && line.p[1 - axis] == line.q[1 - axis] {
        let mut point = line.p;
        point[axis] = window.borders[axis][upper];
        // Its other coordinate is inside, or the AND test would have rejected the segment; adding
        // zero turns −0 into 0, as the long way does.
        point[1 - axis] += 0.0;
        return Cut { point, code: Outcode::INSIDE };
    }
    line.cut(window, axis, upper)
}
