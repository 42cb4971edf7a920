//! Cohen–Sutherland line clipping.
//!
//! Danny Cohen and Ivan Sutherland, about 1967; in print in Newman & Sproull, *Principles of
//! Interactive Computer Graphics* (1973). Object space; O(1), at most one cut per border.
//! Two outcodes accept (OR = 0) or reject (AND ≠ 0) most segments; for the rest, the end that is
//! outside moves to a border whose bit is set, until one of the two tests decides.
//!
//! We deviate in one point: every cut is computed from the original ends, and its outcode exactly,
//! so rounding does not pile up over several cuts and a corner touch is never judged wrong.

use super::border::{Canonical, bit, doubt, is_greater, lowest_border};
use super::{ClipBox, End, Segment};
use crate::Result;
use crate::clip::outcode::Outcode;
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, DVec3, Rect};
use crate::trace::{PseudocodeLine, Tracer};

/// The facts of Cohen–Sutherland clipping.
pub const INFO: Info = Info {
    name: "cohen-sutherland",
    title: "Cohen–Sutherland",
    authors: "Danny Cohen, Ivan Sutherland",
    year: 1967,
    source: "Newman & Sproull, Principles of Interactive Computer Graphics, 1973",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(1) per segment; at most one cut per border",
    limits: "axis-parallel windows: rectangle and box",
    pseudocode: &[
        "code1 := outcode(A); code2 := outcode(B)",
        "loop",
        "    if code1 OR code2 = 0000: accept AB, stop",
        "    if code1 AND code2 ≠ 0000: reject, stop",
        "    take an end P whose code c is not 0000",
        "    take a border whose bit is set in c",
        "    P := crossing of AB with the border",
        "    c := outcode(P)",
    ],
};

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step<P> {
    /// The codes of both ends, in the caller's order.
    Codes {
        /// Outcode of the start.
        start: Outcode,
        /// Outcode of the end.
        end: Outcode,
    },
    /// OR of the codes is empty: the rest is inside.
    Accepted,
    /// AND of the codes is not empty: all of the rest is beyond one border.
    Rejected,
    /// One end moved to a border.
    Cut {
        /// End that moves.
        end: End,
        /// The border; one bit.
        border: Outcode,
        /// New position of the end.
        point: P,
        /// The code of the new end.
        code: Outcode,
    },
}

impl<P> PseudocodeLine for Step<P> {
    fn line(&self) -> usize {
        match self {
            Self::Codes { .. } => 1,
            Self::Accepted => 3,
            Self::Rejected => 4,
            Self::Cut { .. } => 7,
        }
    }
}

/// Returns the result that a list of steps leads to.
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

/// Returns the part of a segment in the closed rectangle.
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

/// Returns the part of a segment in the closed box; six-bit outcodes.
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

// A call would pass both ends through memory.
#[inline(always)]
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
    let line = Line::new(start, end);
    if !(code_start & code_end).is_inside() {
        Canonical::new(start, end)?;
        t.step(|| Step::Rejected);
        return Ok(None);
    }
    let mut codes = [code_start, code_end];
    // Axis by axis: reading one point just after writing two numbers would stall.
    let mut ends: [[f64; 2]; N] = std::array::from_fn(|k| [start[k], end[k]]);
    let point =
        |ends: &[[f64; 2]; N], which: usize| P::from(std::array::from_fn(|k| ends[k][which]));
    // Each turn clears at least one bit permanently, so there are at most 2·N·2 turns.
    while !(codes[0] | codes[1]).is_inside() {
        if !(codes[0] & codes[1]).is_inside() {
            t.step(|| Step::Rejected);
            return Ok(None);
        }
        let which = usize::from(codes[0].is_inside());
        let (axis, upper) = lowest_border(codes[which]);
        let code = line.cut(window, axis, upper, |k, v| ends[k][which] = v)?;
        codes[which] = code;
        t.step(|| Step::Cut {
            end: [End::Start, End::End][which],
            border: bit(axis, upper),
            point: point(&ends, which),
            code,
        });
    }
    t.step(|| Step::Accepted);
    Ok(Some(Segment { start: point(&ends, 0), end: point(&ends, 1) }))
}

/// A segment that is cut without being turned round: [`Canonical::cut`] with the same bits.
///
/// For a point from p to q, (q − p)·((border − p) / (q − p)) does not depend on the sign of q − p, because rounding is
/// symmetric. So only the first end in the canonical direction is needed.
#[derive(Debug, Clone, Copy)]
struct Line<const N: usize> {
    ends: [[f64; N]; 2],
    /// Vector from the first end to the second.
    way: [f64; N],
}

impl<const N: usize> Line<N> {
    #[inline(always)]
    fn new(start: [f64; N], end: [f64; N]) -> Self {
        Self { ends: [start, end], way: std::array::from_fn(|k| end[k] - start[k]) }
    }

    /// Cuts that only an exact test decides.
    ///
    /// # Errors
    /// [`crate::Error::NonFinite`], with index 0 for the start and 1 for the end.
    // Kept out of the loop, where the compiler would evaluate it for every segment.
    #[cold]
    #[inline(never)]
    fn settle(
        &self,
        window: &ClipBox<N>,
        border: (usize, f64),
        k: usize,
    ) -> Result<(Outcode, f64)> {
        let line = Canonical::new(self.ends[0], self.ends[1])?;
        let mut point = [border.1; N];
        let code = line.settle_cut(window, border, k, &mut point);
        Ok((code, point[k]))
    }

    /// Returns the crossing with a border, which the segment must span, coordinate by coordinate, and its code.
    /// Segments parallel to the axis take a short path without arithmetic.
    ///
    /// Coordinates that are not finite fail all quick tests, so that only the cases that these leave open must be
    /// checked for them.
    // A call would pass the cut through memory, which costs as much as computing it.
    #[inline(always)]
    fn cut(
        &self,
        window: &ClipBox<N>,
        axis: usize,
        upper: usize,
        mut put: impl FnMut(usize, f64),
    ) -> Result<Outcode> {
        if N == 2 && self.way[1 - axis] == 0.0 {
            put(axis, window.borders[axis][upper]);
            put(1 - axis, self.short_way(1 - axis)?);
            return Ok(Outcode::INSIDE);
        }
        let p = &self.ends[usize::from(self.is_turned())];
        let border = window.borders[axis][upper];
        let length = self.way[axis];
        let t = (border - p[axis]) / length;
        put(axis, border);
        let mut code = Outcode::INSIDE;
        // The other axes, without a branch that depends on which axis it is.
        for k in (1..N).map(|step| (axis + step) % N) {
            let [min, max] = window.borders[k];
            let near = p[k] + self.way[k] * t;
            let margin = doubt(self.ends[0][k], self.ends[1][k]);
            put(k, near);
            // Huge coordinates make one of these infinite or NaN, and then the test fails.
            let sure = length.abs() < f64::MAX;
            if sure && near - min > margin && max - near > margin {
                continue;
            }
            // Beyond a border by more than any rounding, it needs no exact test either.
            if sure && min - near > margin && near > -f64::MAX {
                code |= bit(k, 0);
            } else if sure && near - max > margin && near < f64::MAX {
                code |= bit(k, 1);
            } else {
                let (settled, near) = self.settle(window, (axis, border), k)?;
                put(k, near);
                code |= settled;
            }
        }
        Ok(code)
    }

    /// Returns whether the second end is lexicographically smaller. For a segment in the plane that is not parallel to
    /// an axis, x decides.
    #[inline(always)]
    fn is_turned(&self) -> bool {
        let [start, end] = &self.ends;
        if N == 2 { start[0] > end[0] } else { is_greater(start, end) }
    }

    /// Returns the other coordinate of a crossing with a border at a right angle: it is inside, or the AND
    /// test would have rejected the segment. Adding zero turns −0 into 0, as the long path does.
    #[cold]
    #[inline(never)]
    fn short_way(&self, k: usize) -> Result<f64> {
        Canonical::new(self.ends[0], self.ends[1])?;
        Ok(self.ends[0][k] + 0.0)
    }
}
