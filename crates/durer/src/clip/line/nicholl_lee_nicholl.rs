//! Nicholl–Lee–Nicholl line clipping.
//!
//! Tina Nicholl, D. T. Lee and Robin Nicholl, "An efficient new algorithm for 2-D line clipping: its
//! development and analysis", SIGGRAPH 1987. Object space; O(1), and no crossing is computed that is
//! not an end of the result. The rays from the first end through the window's corners divide the
//! plane into regions; the region of the other end determines the borders that are crossed.
//!
//! The paper reflects every case to one of three; here the reflection is in the outcodes, and the side of a ray that
//! the other end is on is decided exactly.

use super::border::{Canonical, bit};
use super::{ClipBox, End, Segment};
use crate::Result;
use crate::clip::outcode::Outcode;
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, Rect};
use crate::trace::{PseudocodeLine, Tracer};
use std::cmp::Ordering;

/// The facts of Nicholl–Lee–Nicholl clipping.
pub const INFO: Info = Info {
    name: "nicholl-lee-nicholl",
    title: "Nicholl–Lee–Nicholl",
    authors: "Tina M. Nicholl, D. T. Lee, Robin A. Nicholl",
    year: 1987,
    source: "An efficient new algorithm for 2-D line clipping, SIGGRAPH 1987",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(1) per segment; only crossings that are in the result are computed",
    limits: "rectangles in two dimensions",
    pseudocode: &[
        "c := region of A: inside, beside a border, or at a corner",
        "both ends inside: accept; both beyond one border: reject",
        "for the corners of the window that the region needs:",
        "    on which side of the ray from A through the corner is B?",
        "if B is outside the rays that enclose the window: reject, stop",
        "if A is outside: A := crossing with the border between the rays around B",
        "if B is outside: B := crossing with the border between the rays around B",
        "accept AB",
    ],
};

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The region the first end lies in: inside, beside a border, or at a corner (two bits).
    Region {
        /// Its outcode.
        code: Outcode,
    },
    /// The segment was compared with the ray through a corner.
    Corner {
        /// The two borders that meet there.
        corner: Outcode,
        /// Side of the corner on which the segment crosses the corner's vertical border: below
        /// (`Less`) or above (`Greater`).
        passes: Ordering,
    },
    /// One end moves to a border.
    Cut {
        /// End that moves.
        end: End,
        /// The border; one bit.
        border: Outcode,
        /// New position of the end.
        point: DVec2,
    },
    /// The rest is inside.
    Accepted,
    /// Nothing remains.
    Rejected,
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Region { .. } => 1,
            Self::Corner { .. } => 4,
            Self::Rejected => 5,
            Self::Cut { end: End::Start, .. } => 6,
            Self::Cut { end: End::End, .. } => 7,
            Self::Accepted => 8,
        }
    }
}

/// Returns the result that a list of steps leads to.
pub fn replay(mut segment: Segment<DVec2>, steps: &[Step]) -> Option<Segment<DVec2>> {
    for step in steps {
        match *step {
            Step::Region { .. } | Step::Corner { .. } => {}
            Step::Cut { end, point, .. } => segment = segment.moved(end, point),
            Step::Accepted => return Some(segment),
            Step::Rejected => return None,
        }
    }
    None
}

/// Returns the part of a segment in the closed rectangle.
///
/// # Errors
/// [`crate::Error::NonFinite`] for a NaN or infinite coordinate.
pub fn clip(
    window: &Rect,
    segment: Segment<DVec2>,
    t: &mut impl Tracer<Step>,
) -> Result<Option<Segment<DVec2>>> {
    let line = Canonical::new(segment.start.to_array(), segment.end.to_array())?;
    let search = Search { window: window.into(), line };
    let (p, q) = (search.window.code(line.p), search.window.code(line.q));
    t.step(|| Step::Region { code: p });
    if (p | q).is_inside() {
        t.step(|| Step::Accepted);
        return Ok(Some(segment));
    }
    let misses = !(p & q).is_inside() || (!p.is_inside() && !search.enters(p, t));
    if misses {
        t.step(|| Step::Rejected);
        return Ok(None);
    }
    let start = search.end(p, End::Start, t).unwrap_or(line.p);
    let end = search.end(q, End::End, t).unwrap_or(line.q);
    t.step(|| Step::Accepted);
    Ok(Some(line.in_order(start, end)))
}

struct Search {
    window: ClipBox<2>,
    line: Canonical<2>,
}

/// Returns the border of an axis that a code names, if any: 0 the smaller, 1 the larger coordinate.
fn beyond(code: Outcode, axis: usize) -> Option<usize> {
    (0..2).find(|&upper| code.contains(bit(axis, upper)))
}

impl Search {
    /// Returns whether  where the line crosses border (axis, a), it is beyond border b of the other
    /// axis.
    fn passes_beyond(&self, axis: usize, a: usize, b: usize, t: &mut impl Tracer<Step>) -> bool {
        let other = 1 - axis;
        let borders = &self.window.borders;
        let passes =
            self.line.compare_cut_exactly((axis, borders[axis][a]), (other, borders[other][b]));
        t.step(|| Step::Corner { corner: bit(axis, a) | bit(other, b), passes });
        passes == if b == 0 { Ordering::Less } else { Ordering::Greater }
    }

    /// Returns whether a line whose first end is outside, in the region `code`, meets the window.
    fn enters(&self, code: Outcode, t: &mut impl Tracer<Step>) -> bool {
        match (beyond(code, 0), beyond(code, 1)) {
            (Some(x), Some(y)) if self.passes_beyond(0, x, y, t) => {
                !self.passes_beyond(1, y, 1 - x, t)
            }
            (Some(x), Some(y)) => !self.passes_beyond(0, x, 1 - y, t),
            (Some(x), None) => !(0..2).any(|y| self.passes_beyond(0, x, y, t)),
            (None, Some(y)) => !(0..2).any(|x| self.passes_beyond(1, y, x, t)),
            (None, None) => true,
        }
    }

    /// Returns the crossing with the border on the side of an end in the region `code`; `None` for
    /// inside.
    fn end(&self, code: Outcode, end: End, t: &mut impl Tracer<Step>) -> Option<[f64; 2]> {
        let (axis, upper) = match (beyond(code, 0), beyond(code, 1)) {
            (Some(x), Some(y)) if self.passes_beyond(0, x, y, t) => (1, y),
            (Some(x), _) => (0, x),
            (None, Some(y)) => (1, y),
            (None, None) => return None,
        };
        let point = self.line.cut(&self.window, axis, upper);
        let end = end.swapped_if(self.line.swapped);
        t.step(|| Step::Cut { end, border: bit(axis, upper), point: point.into() });
        Some(point)
    }
}
