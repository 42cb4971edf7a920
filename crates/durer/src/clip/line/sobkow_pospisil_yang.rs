//! Sobkow–Pospisil–Yang line clipping by the code of a whole segment.
//!
//! Mark S. Sobkow, Paul Pospisil and Yee-Hong Yang, "A fast two-dimensional line clipping algorithm via line encoding",
//! Computers & Graphics 11(4), 1987. Object space; O(1). The outcodes of both ends, side by side, are one number of eight
//! bits; a table has a case for each of the 81 pairs of regions, which names the borders to cut and those beyond which
//! a cut shows that the window is missed. No code is compared or computed again, as Cohen and Sutherland do after each cut.
//!
//! The paper writes its cases out one by one; here [`CASES`] is made from the two codes when the library is compiled.
//! On which side of a border a crossing is, is decided exactly.

use super::border::{Canonical, bit, lowest_border};
use super::{ClipBox, End, Segment};
use crate::Result;
use crate::clip::outcode::Outcode;
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, Rect};
use crate::trace::{PseudocodeLine, Tracer};
use std::cmp::Ordering;

/// The facts of Sobkow–Pospisil–Yang clipping.
pub const INFO: Info = Info {
    name: "sobkow-pospisil-yang",
    title: "Sobkow–Pospisil–Yang",
    authors: "Mark S. Sobkow, Paul Pospisil, Yee-Hong Yang",
    year: 1987,
    source: "A fast two-dimensional line clipping algorithm via line encoding, Computers & Graphics 11(4)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(1) per segment; at most two cuts for each end",
    limits: "rectangles in two dimensions",
    pseudocode: &[
        "c ← outcode of A, outcode of B: eight bits, the line code",
        "choose the case of c, one of 81:",
        "    0000 0000: accept AB, stop",
        "    a bit in both halves: reject, stop",
        "    A outside: A ← crossing with its border; at a corner first left or right, then, if still outside, bottom or top",
        "        this crossing is beyond a border of B's half: reject, stop",
        "    B outside: B ← crossing likewise",
        "    accept AB",
    ],
};

/// Program for the segments of one line code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Case {
    /// Both ends are inside.
    Accept,
    /// Both ends are beyond one border.
    Reject,
    /// The ends move into the window, the start first.
    Cut {
        /// Way of the start.
        start: EndWay,
        /// Way of the end.
        end: EndWay,
    },
}

/// Way of one end into the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EndWay {
    /// Borders to cut at: none for an end that stays, two for one at a corner. The left or right one is cut first, the
    /// other one only if that cut is beyond it.
    pub borders: Outcode,
    /// Borders beyond which a cut shows that the segment misses the window.
    pub misses: Outcode,
}

/// The cases by line code, 16 times the start's outcode plus the end's. Codes with both bits of an axis do not occur.
///
/// ```
/// use durer::clip::line::sobkow_pospisil_yang::{CASES, Case, EndWay};
/// use durer::clip::outcode::Outcode;
///
/// // From the left over the top: the cut at the left border must not be above the window.
/// let start = EndWay { borders: Outcode::LEFT, misses: Outcode::TOP };
/// let end = EndWay { borders: Outcode::TOP, misses: Outcode::INSIDE };
/// assert_eq!(CASES[0b0001_1000], Case::Cut { start, end });
/// ```
pub const CASES: [Case; 256] = cases();

const fn cases() -> [Case; 256] {
    let mut cases = [Case::Reject; 256];
    let mut code = 0;
    while code < cases.len() {
        cases[code] = case((code >> 4) as u8, (code & 15) as u8);
        code += 1;
    }
    cases
}

/// Returns the program for two outcodes.
const fn case(start: u8, end: u8) -> Case {
    if start | end == 0 {
        return Case::Accept;
    }
    if start & end != 0 {
        return Case::Reject;
    }
    // Along the segment a coordinate leaves the window only towards the end's borders. Once the start is inside,
    // nothing can be missed.
    let misses = if start == 0 { 0 } else { end };
    Case::Cut {
        start: EndWay { borders: Outcode(start), misses: Outcode(misses) },
        end: EndWay { borders: Outcode(end), misses: Outcode::INSIDE },
    }
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The line code was computed.
    Code {
        /// Outcode of the start, the upper half.
        start: Outcode,
        /// Outcode of the end, the lower half.
        end: Outcode,
    },
    /// One end moves to a border.
    Cut {
        /// End that moves.
        end: End,
        /// The border; one bit.
        border: Outcode,
        /// New position of the end.
        point: DVec2,
        /// Borders of the case that the exact crossing is beyond.
        code: Outcode,
    },
    /// The rest is inside.
    Accepted {
        /// True if both ends were inside.
        at_once: bool,
    },
    /// Nothing remains.
    Rejected {
        /// True if both ends were beyond one border.
        at_once: bool,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Code { .. } => 1,
            Self::Accepted { at_once: true } => 3,
            Self::Rejected { at_once: true } => 4,
            Self::Cut { end: End::Start, .. } => 5,
            Self::Rejected { at_once: false } => 6,
            Self::Cut { end: End::End, .. } => 7,
            Self::Accepted { at_once: false } => 8,
        }
    }
}

/// Returns the result that a list of steps leads to.
pub fn replay(mut segment: Segment<DVec2>, steps: &[Step]) -> Option<Segment<DVec2>> {
    for step in steps {
        match *step {
            Step::Code { .. } => {}
            Step::Cut { end, point, .. } => segment = segment.moved(end, point),
            Step::Accepted { .. } => return Some(segment),
            Step::Rejected { .. } => return None,
        }
    }
    None
}

/// Returns the part of a segment in the closed rectangle.
///
/// ```
/// use durer::clip::line::{Segment, sobkow_pospisil_yang};
/// use durer::math::{DVec2, Rect};
/// use durer::trace::NoTrace;
///
/// let window = Rect::new(DVec2::ZERO, DVec2::new(10.0, 6.0))?;
/// let segment = Segment::new(DVec2::new(-4.0, 1.0), DVec2::new(10.0, 8.0));
/// let clipped = sobkow_pospisil_yang::clip(&window, segment, &mut NoTrace)?;
/// assert_eq!(clipped, Some(Segment::new(DVec2::new(0.0, 3.0), DVec2::new(6.0, 6.0))));
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`crate::Error::NonFinite`] for a NaN or infinite coordinate.
pub fn clip(
    window: &Rect,
    segment: Segment<DVec2>,
    t: &mut impl Tracer<Step>,
) -> Result<Option<Segment<DVec2>>> {
    let line = Canonical::new(segment.start.to_array(), segment.end.to_array())?;
    let moves = Moves { window: window.into(), line };
    let [start, end] = [segment.start, segment.end].map(|p| moves.window.code(p.to_array()));
    t.step(|| Step::Code { start, end });
    let clipped = match CASES[usize::from(start.0 << 4 | end.0)] {
        Case::Accept => {
            t.step(|| Step::Accepted { at_once: true });
            return Ok(Some(segment));
        }
        Case::Reject => {
            t.step(|| Step::Rejected { at_once: true });
            return Ok(None);
        }
        Case::Cut { start, end } => {
            let start = moves.along(End::Start, segment.start, start, t);
            start.and_then(|a| Some(Segment::new(a, moves.along(End::End, segment.end, end, t)?)))
        }
    };
    t.step(|| match clipped {
        Some(_) => Step::Accepted { at_once: false },
        None => Step::Rejected { at_once: false },
    });
    Ok(clipped)
}

/// A segment before a window.
struct Moves {
    window: ClipBox<2>,
    line: Canonical<2>,
}

impl Moves {
    /// Moves an end along its way; `None` if a cut shows that the window is missed.
    fn along(
        &self,
        end: End,
        from: DVec2,
        way: EndWay,
        t: &mut impl Tracer<Step>,
    ) -> Option<DVec2> {
        let mut point = from;
        let (mut todo, mut beyond) = (way.borders, way.borders);
        while !beyond.is_inside() {
            let (axis, upper) = lowest_border(beyond);
            let border = bit(axis, upper);
            point = self.line.cut(&self.window, axis, upper).into();
            todo = Outcode(todo.0 & !border.0);
            let code = self.beyond(axis, upper, todo | way.misses);
            t.step(|| Step::Cut { end, border, point, code });
            if !(code & way.misses).is_inside() {
                return None;
            }
            beyond = code & todo;
        }
        Some(point)
    }

    /// Returns those of some borders that the exact crossing with a border of another axis is beyond.
    fn beyond(&self, axis: usize, upper: usize, borders: Outcode) -> Outcode {
        let other = 1 - axis;
        let is_beyond = |side: &usize| {
            let at = |axis: usize, upper: usize| (axis, self.window.borders[axis][upper]);
            let passes = self.line.compare_cut_exactly(at(axis, upper), at(other, *side));
            passes == if *side == 0 { Ordering::Less } else { Ordering::Greater }
        };
        let requested = (0..2).filter(|side| borders.contains(bit(other, *side)));
        requested.filter(is_beyond).fold(Outcode::INSIDE, |code, side| code | bit(other, side))
    }
}
