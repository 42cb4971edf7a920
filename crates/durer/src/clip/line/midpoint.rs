//! Midpoint subdivision.
//!
//! Robert Sproull and Ivan Sutherland, "A clipping divider", Fall Joint Computer Conference 1968. Image space: integer
//! pixels, shifts and additions only; at most ⌈log2 n⌉ halvings for each end, n the larger extent of the segment in
//! pixels. Halving continues until a visible and an invisible pixel are neighbours.
//!
//! Middles are kept with 31 bits below the pixel, because rounding each to a pixel would add up to half
//! a pixel per halving. A middle is visible if its nearest pixel is in the window. A cut point is within
//! half a pixel of the segment on each axis and within a pixel and a half of the border; a segment that
//! passes within a pixel of a corner may be judged either way. Middles do not depend on the direction,
//! so neither does the result.

use super::{End, Segment};
use crate::clip::outcode::Outcode;
use crate::info::{Class, Info, Occluder};
use crate::math::IVec2;
use crate::trace::{PseudocodeLine, Tracer};
use crate::{Error, Result};

/// The facts of midpoint subdivision.
pub const INFO: Info = Info {
    name: "midpoint",
    title: "Midpoint subdivision",
    authors: "Robert F. Sproull, Ivan E. Sutherland",
    year: 1968,
    source: "A clipping divider, Fall Joint Computer Conference",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(log n) per segment, n its length in pixels",
    limits: "integer coordinates; cut points within half a pixel of the segment",
    pseudocode: &[
        "halve(P, Q): M := the pixel nearest to the middle of P and Q; c := outcode(M)",
        "while neither A nor B is inside:",
        "    if code(A) AND code(B) ≠ 0000, or they are neighbours: reject, stop",
        "    halve(A, B); if M is inside: V := M, leave the loop",
        "    the end that is beyond a border together with M becomes M",
        "for each end P that is outside, with V visible:",
        "    while P and V are not neighbours:",
        "        halve(P, V); if M is inside: V := M, else P := M",
        "    the end moves to V",
        "accept AB",
    ],
};

/// A rectangle of pixels, both corners included.
///
/// # Guarantees
/// min ≤ max on both axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PixelWindow {
    min: IVec2,
    max: IVec2,
}

impl PixelWindow {
    /// Creates the rectangle between two pixels.
    ///
    /// # Errors
    /// [`Error::Parameter`] if `min > max` on an axis.
    pub fn new(min: IVec2, max: IVec2) -> Result<Self> {
        if min.cmple(max).all() {
            Ok(Self { min, max })
        } else {
            let value = format!("{min} … {max}");
            Err(Error::parameter("pixel window", value, "min ≤ max on both axes"))
        }
    }

    /// Returns the pixel with the smallest coordinates.
    pub fn min(&self) -> IVec2 {
        self.min
    }

    /// Returns the pixel with the largest coordinates.
    pub fn max(&self) -> IVec2 {
        self.max
    }

    fn code(&self, p: IVec2) -> Outcode {
        let inside = [p.x >= self.min.x, p.x <= self.max.x, p.y >= self.min.y, p.y <= self.max.y];
        Outcode::from_inside(inside)
    }
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// The middle between two pixels was examined.
    Halved {
        /// The pixel nearest to the middle.
        middle: IVec2,
        /// Its outcode.
        code: Outcode,
    },
    /// One end moves to a visible pixel whose neighbour on the segment is not.
    Cut {
        /// End that moves.
        end: End,
        /// New position of the end.
        point: IVec2,
    },
    /// The rest is inside.
    Accepted,
    /// Nothing remains.
    Rejected,
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Halved { .. } => 1,
            Self::Rejected => 3,
            Self::Cut { .. } => 9,
            Self::Accepted => 10,
        }
    }
}

/// Returns the result that a list of steps leads to.
pub fn replay(mut segment: Segment<IVec2>, steps: &[Step]) -> Option<Segment<IVec2>> {
    for step in steps {
        match *step {
            Step::Halved { .. } => {}
            Step::Cut { end, point } => segment = segment.moved(end, point),
            Step::Accepted => return Some(segment),
            Step::Rejected => return None,
        }
    }
    None
}

/// Returns the part of a segment in the window.
///
/// ```
/// use durer::clip::line::{Segment, midpoint};
/// use durer::math::IVec2;
/// use durer::trace::NoTrace;
///
/// let window = midpoint::PixelWindow::new(IVec2::ZERO, IVec2::new(99, 99))?;
/// let segment = Segment::new(IVec2::new(-100, 50), IVec2::new(50, 50));
/// let clipped = midpoint::clip(&window, segment, &mut NoTrace);
/// assert_eq!(clipped, Some(Segment::new(IVec2::new(0, 50), IVec2::new(50, 50))));
/// # Ok::<(), durer::Error>(())
/// ```
pub fn clip(
    window: &PixelWindow,
    segment: Segment<IVec2>,
    t: &mut impl Tracer<Step>,
) -> Option<Segment<IVec2>> {
    let ends = [segment.start, segment.end].map(Fine::from);
    let Some(gaps) = gaps(window, ends, t) else {
        t.step(|| Step::Rejected);
        return None;
    };
    let mut result = segment;
    for (gap, end) in gaps.into_iter().zip([End::Start, End::End]) {
        if !window.code(gap.outside.pixel()).is_inside() {
            let point = last_visible(window, gap, t).pixel();
            t.step(|| Step::Cut { end, point });
            result = result.moved(end, point);
        }
    }
    t.step(|| Step::Accepted);
    Some(result)
}

/// Bits below the pixel, the largest number that leaves room for the sum of two i32 in i64.
const FRACTION: u32 = 31;

/// A point in units of 2⁻³¹ pixel.
#[derive(Clone, Copy)]
struct Fine {
    x: i64,
    y: i64,
}

impl From<IVec2> for Fine {
    fn from(p: IVec2) -> Self {
        Self { x: i64::from(p.x) << FRACTION, y: i64::from(p.y) << FRACTION }
    }
}

impl Fine {
    /// Returns the nearest pixel, halves up.
    fn pixel(self) -> IVec2 {
        let nearest = |v: i64| ((v >> (FRACTION - 1)) + 1) >> 1;
        IVec2::new(nearest(self.x) as i32, nearest(self.y) as i32)
    }

    fn middle(self, other: Self) -> Self {
        Self { x: (self.x + other.x) >> 1, y: (self.y + other.y) >> 1 }
    }

    /// Returns whether the two are a pixel apart or less on both axes.
    fn adjacent(self, other: Self) -> bool {
        self.x.abs_diff(other.x) <= 1 << FRACTION && self.y.abs_diff(other.y) <= 1 << FRACTION
    }
}

/// An invisible and a visible point with the border between them; for a visible end, both are visible.
struct Gap {
    outside: Fine,
    visible: Fine,
}

/// Returns a gap for each end, found by halving while both ends are outside; `None` if nothing is
/// visible.
fn gaps(
    window: &PixelWindow,
    [mut p, mut q]: [Fine; 2],
    t: &mut impl Tracer<Step>,
) -> Option<[Gap; 2]> {
    loop {
        let (code_p, code_q) = (window.code(p.pixel()), window.code(q.pixel()));
        let around = |visible| [Gap { outside: p, visible }, Gap { outside: q, visible }];
        if code_p.is_inside() {
            return Some(around(p));
        }
        if code_q.is_inside() {
            return Some(around(q));
        }
        if !(code_p & code_q).is_inside() || p.adjacent(q) {
            return None;
        }
        let (middle, code) = halve(window, p, q, t);
        if code.is_inside() {
            return Some(around(middle));
        }
        // The middle is beyond a border that p or q is beyond too, so that half is invisible.
        if (code & code_p).is_inside() {
            q = middle;
        } else {
            p = middle;
        }
    }
}

/// Halves a gap until its two points are a pixel apart; the visible one.
fn last_visible(window: &PixelWindow, mut gap: Gap, t: &mut impl Tracer<Step>) -> Fine {
    while !gap.outside.adjacent(gap.visible) {
        let (middle, code) = halve(window, gap.outside, gap.visible, t);
        if code.is_inside() {
            gap.visible = middle;
        } else {
            gap.outside = middle;
        }
    }
    gap.visible
}

fn halve(window: &PixelWindow, p: Fine, q: Fine, t: &mut impl Tracer<Step>) -> (Fine, Outcode) {
    let middle = p.middle(q);
    let code = window.code(middle.pixel());
    t.step(|| Step::Halved { middle: middle.pixel(), code });
    (middle, code)
}
