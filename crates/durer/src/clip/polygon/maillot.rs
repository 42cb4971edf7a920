//! Maillot's polygon clipping: Cohen and Sutherland's outcodes, extended by a bit, with turning points.
//!
//! Patrick-Gilles Maillot, *A new, fast method for 2D polygon clipping: analysis and software implementation*, ACM
//! Transactions on Graphics 11(3), 1992. Object space. Cost: O(n) for n vertices, one pass. Edges are clipped one by one;
//! what turns around a corner of the window outside shows in the codes. The extra bit marks the four regions at corners:
//! an edge that ends in one emits this corner, and an edge that is not seen emits one more if no border is common to its
//! ends.
//!
//! **Bridging edges**, as with [`super::sutherland_hodgman`]: the result is one ring, which may run to and fro along
//! the window's border. The paper clips by integers; here what is visible is decided exactly, and so is the side on which
//! an edge from corner to corner passes. A result without area is left out.

use super::signed_area;
use crate::clip::exact;
use crate::clip::line::{Segment, cohen_sutherland};
use crate::clip::outcode::Outcode;
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, Rect};
use crate::trace::{NoTrace, PseudocodeLine, Tracer};
use crate::{Error, Result};
use std::cmp::Ordering;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "maillot",
    title: "Maillot polygon clipping",
    authors: "Patrick-Gilles Maillot",
    year: 1992,
    source: "A new, fast method for 2D polygon clipping, ACM Transactions on Graphics 11(3)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n) for n vertices",
    limits: "rectangles; one ring, with bridging edges along the border",
    pseudocode: &[
        "code of a vertex: its outcode, and a bit that is set at corners, beyond two borders",
        "for each edge PQ of the ring, with its codes:",
        "    clip PQ by Cohen and Sutherland",
        "    visible: emit the point of entry if P is outside; emit the point of exit, or Q if it is inside",
        "    else, if the codes share no border:",
        "        P and Q beside a border each: emit the corner of these two",
        "        only one at a corner: emit the corner of the other's border and of the one across it",
        "        both at corners: emit the one of the two other corners around which PQ goes",
        "    Q at a corner: emit this corner",
        "the points emitted are the ring",
    ],
};

/// The extended code of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Code {
    /// Borders that the point is beyond.
    pub borders: Outcode,
    /// The added bit: true in the four regions at corners, beyond two borders.
    pub is_corner: bool,
}

impl Code {
    /// Returns the extended code of a point.
    pub fn of(window: &Rect, p: DVec2) -> Self {
        let borders = Outcode::of_point_2d(window, p);
        Self { borders, is_corner: borders.0.count_ones() == 2 }
    }
}

/// The added bit, then the outcode: 10101 left below.
impl std::fmt::Display for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}{}", u8::from(self.is_corner), self.borders)
    }
}

/// Reason for which a corner of the window is emitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CornerReason {
    /// The edge ends in the corner's region.
    Basic,
    /// The edge goes from beside a border to beside another one.
    BorderToBorder,
    /// One end is beside a border, the other one in the region of a corner that is not at this border.
    BorderToCorner,
    /// The edge goes from a corner's region to that of the opposite corner.
    CornerToCorner,
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The codes of an edge.
    Edge {
        /// Its index.
        edge: usize,
        /// Code of its start P.
        start: Code,
        /// Code of its end Q.
        end: Code,
    },
    /// A point where the edge comes in, goes out, or ends.
    Point(DVec2),
    /// A corner of the window.
    Turn {
        /// The corner.
        corner: DVec2,
        /// Reason for it.
        turn: CornerReason,
    },
}

impl Step {
    /// Returns the point that the step adds to the ring.
    fn point(self) -> Option<DVec2> {
        match self {
            Self::Point(p) | Self::Turn { corner: p, .. } => Some(p),
            Self::Edge { .. } => None,
        }
    }
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Edge { .. } => 2,
            Self::Point(_) => 4,
            Self::Turn { turn: CornerReason::BorderToBorder, .. } => 6,
            Self::Turn { turn: CornerReason::BorderToCorner, .. } => 7,
            Self::Turn { turn: CornerReason::CornerToCorner, .. } => 8,
            Self::Turn { turn: CornerReason::Basic, .. } => 9,
        }
    }
}

/// Returns the result that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<DVec2> {
    with_area(steps.iter().filter_map(|step| step.point()).collect())
}

/// Returns the ring, or an empty one for a ring without area.
fn with_area(ring: Vec<DVec2>) -> Vec<DVec2> {
    if signed_area(&ring) == 0.0 { Vec::new() } else { ring }
}

/// Returns the part of a ring in a rectangle, as one ring; empty if there is none.
///
/// ```
/// use durer::clip::polygon::{maillot, signed_area};
/// use durer::math::{DVec2, Rect};
/// use durer::trace::NoTrace;
///
/// // Around a corner of the window, which is a turning point.
/// let window = Rect::new(DVec2::ZERO, DVec2::splat(2.0))?;
/// let triangle = [(1.0, 1.0), (5.0, 1.0), (1.0, 5.0)].map(DVec2::from);
/// let clipped = maillot::clip(&window, &triangle, &mut NoTrace)?;
/// assert!(clipped.contains(&DVec2::splat(2.0)));
/// assert_eq!(signed_area(&clipped), 1.0);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::NonFinite`] for a vertex with a NaN or infinite coordinate.
pub fn clip(window: &Rect, ring: &[DVec2], t: &mut impl Tracer<Step>) -> Result<Vec<DVec2>> {
    if let Some(index) = ring.iter().position(|v| !v.is_finite()) {
        return Err(Error::NonFinite { what: "vertex", index });
    }
    let mut points = Vec::new();
    let mut put = |step: Step| {
        t.step(|| step);
        points.extend(step.point());
    };
    let next = ring.iter().cycle().skip(1);
    for (edge, (&from, &to)) in ring.iter().zip(next).enumerate() {
        let [start, end] = [from, to].map(|p| Code::of(window, p));
        put(Step::Edge { edge, start, end });
        let seen = cohen_sutherland::clip(window, Segment::new(from, to), &mut NoTrace)?;
        if let Some(seen) = seen {
            if !start.borders.is_inside() {
                put(Step::Point(seen.start));
            }
            put(Step::Point(seen.end));
        } else if (start.borders & end.borders).is_inside() {
            let (borders, turn) = between(window, [(from, start), (to, end)]);
            put(Step::Turn { corner: corner(window, borders), turn });
        }
        if end.is_corner {
            put(Step::Turn { corner: corner(window, end.borders), turn: CornerReason::Basic });
        }
    }
    Ok(with_area(points))
}

/// Returns the corner where two borders meet.
fn corner(window: &Rect, borders: Outcode) -> DVec2 {
    let (min, max) = (window.min(), window.max());
    let pick = |bit, low, high| if borders.contains(bit) { high } else { low };
    DVec2::new(pick(Outcode::RIGHT, min.x, max.x), pick(Outcode::TOP, min.y, max.y))
}

/// Returns the bits of the borders of x.
fn of_x(code: Outcode) -> Outcode {
    code & (Outcode::LEFT | Outcode::RIGHT)
}

/// Returns the bits of the borders of y.
fn of_y(code: Outcode) -> Outcode {
    code & (Outcode::BOTTOM | Outcode::TOP)
}

/// Returns the corner around which an edge outside the window goes before its end; no border is common to its ends.
fn between(
    window: &Rect,
    [(from, start), (to, end)]: [(DVec2, Code); 2],
) -> (Outcode, CornerReason) {
    let (a, b) = (start.borders, end.borders);
    // The corner of a border and of the border across it that a corner's region is beyond.
    let beside = |border: Outcode, corner: Outcode| {
        border | if of_x(border).is_inside() { of_x(corner) } else { of_y(corner) }
    };
    match (start.is_corner, end.is_corner) {
        (false, false) => (a | b, CornerReason::BorderToBorder),
        (false, true) => (beside(a, b), CornerReason::BorderToCorner),
        (true, false) => (beside(b, a), CornerReason::BorderToCorner),
        (true, true) => {
            // Seen along an edge from the left below to the right above, the window is to the right of those that go
            // around its left upper corner; each reflection exchanges the sides.
            let upwards = a.contains(Outcode::LEFT) == a.contains(Outcode::BOTTOM);
            let far = if upwards { Ordering::Less } else { Ordering::Greater };
            let first = exact::side(from, to, window.min()) == far;
            let corner = if first { of_x(a) | of_y(b) } else { of_x(b) | of_y(a) };
            (corner, CornerReason::CornerToCorner)
        }
    }
}
