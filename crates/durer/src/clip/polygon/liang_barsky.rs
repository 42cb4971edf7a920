//! Liang–Barsky polygon clipping: edge by edge, with turning points at the window's corners.
//!
//! Y.-D. Liang, B. A. Barsky, *An analysis and algorithm for polygon clipping*, Communications of the ACM 26(11), 1983;
//! named as in Foley, van Dam, Feiner, Hughes, *Computer Graphics* (1990), 19.1.3. Object space. Cost: O(n) for n
//! vertices, one pass. An edge's line enters both slabs of the window and leaves both; where it is in both at once the
//! edge is seen, and where it enters one only after it has left the other, or leaves the last, the border that is being
//! made turns around a corner of the window.
//!
//! **Bridging edges**, as with [`super::sutherland_hodgman`]: the result is one ring, which may run to and fro along
//! the window's border. Parameters are compared as rounded; cuts lie exactly on their border.

use super::signed_area;
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, Rect};
use crate::trace::{PseudocodeLine, Tracer};
use crate::{Error, Result};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "liang-barsky-polygon",
    title: "Liang–Barsky polygon clipping",
    authors: "You-Dong Liang, Brian A. Barsky",
    year: 1983,
    source: "An analysis and algorithm for polygon clipping, Communications of the ACM 26(11)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n) for n vertices",
    limits: "rectangles; one ring, with bridging edges along the border",
    pseudocode: &[
        "for each edge PQ of the ring:",
        "    t at which its line enters and leaves the slabs of x and of y",
        "    t_in2 := the later entry; t_out1, t_out2 := the exits in order",
        "    t_out1 < t_in2: not seen; a corner is passed if 0 < t_out1 ≤ 1: emit it",
        "    else if 0 < t_out1 and t_in2 ≤ 1: seen",
        "        t_in2 > 0: emit the point of entry",
        "        emit the point of exit, or Q if it is inside",
        "    0 < t_out2 ≤ 1: emit the corner behind the last exit",
        "the points emitted are the ring",
    ],
};

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// An edge's parameters: 0 at its start, 1 at its end, infinite where it is parallel to a border.
    Edge {
        /// Its index.
        edge: usize,
        /// Parameters at which it enters the window's slabs of x and y: the later one is t_in2.
        enters: [f64; 2],
        /// Parameters at which it leaves them: the earlier one is t_out1, the later one t_out2.
        leaves: [f64; 2],
    },
    /// A point where the edge enters, leaves, or ends.
    Point(DVec2),
    /// A corner of the window.
    Turn(DVec2),
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Edge { .. } => 2,
            Self::Point(_) => 7,
            Self::Turn(_) => 8,
        }
    }
}

/// Returns the result that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<DVec2> {
    let point = |step: &Step| match *step {
        Step::Point(p) | Step::Turn(p) => Some(p),
        Step::Edge { .. } => None,
    };
    let ring: Vec<DVec2> = steps.iter().filter_map(point).collect();
    if signed_area(&ring) == 0.0 { Vec::new() } else { ring }
}

/// Returns the part of a ring in a rectangle, as one ring; empty if there is none.
///
/// ```
/// use durer::clip::polygon::{liang_barsky, signed_area};
/// use durer::math::{DVec2, Rect};
/// use durer::trace::NoTrace;
///
/// // Around a corner of the window, which is a turning point.
/// let window = Rect::new(DVec2::ZERO, DVec2::splat(2.0))?;
/// let triangle = [(1.0, 1.0), (5.0, 1.0), (1.0, 5.0)].map(DVec2::from);
/// let clipped = liang_barsky::clip(&window, &triangle, &mut NoTrace)?;
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
    let next = ring.iter().cycle().skip(1);
    for (edge, (&from, &to)) in ring.iter().zip(next).enumerate() {
        let line = Line::new(window, from, to);
        let (enters, leaves) = ([line.x.t_in, line.y.t_in], [line.x.t_out, line.y.t_out]);
        t.step(|| Step::Edge { edge, enters, leaves });
        line.walk(|step| {
            t.step(|| step);
            points.extend(match step {
                Step::Point(p) | Step::Turn(p) => Some(p),
                Step::Edge { .. } => None,
            });
        });
    }
    Ok(if signed_area(&points) == 0.0 { Vec::new() } else { points })
}

/// An edge seen along one axis: where its line enters the window's slab and leaves it.
struct Slab {
    border_in: f64,
    border_out: f64,
    t_in: f64,
    t_out: f64,
}

impl Slab {
    fn new(low: f64, high: f64, from: f64, to: f64) -> Self {
        let way = to - from;
        // Without movement along the axis, the edge is always in the slab or never, and enters at the border that it is
        // beyond.
        let forward = way > 0.0 || (way == 0.0 && from > high);
        let (border_in, border_out) = if forward { (low, high) } else { (high, low) };
        if way == 0.0 {
            let inside = low <= from && from <= high;
            let t_out = if inside { f64::INFINITY } else { f64::NEG_INFINITY };
            return Self { border_in, border_out, t_in: f64::NEG_INFINITY, t_out };
        }
        Self {
            border_in,
            border_out,
            t_in: (border_in - from) / way,
            t_out: (border_out - from) / way,
        }
    }
}

/// An edge seen along both.
struct Line {
    from: DVec2,
    to: DVec2,
    x: Slab,
    y: Slab,
}

impl Line {
    fn new(window: &Rect, from: DVec2, to: DVec2) -> Self {
        let (low, high) = (window.min(), window.max());
        let x = Slab::new(low.x, high.x, from.x, to.x);
        Self { from, to, x, y: Slab::new(low.y, high.y, from.y, to.y) }
    }

    /// Returns the intersection with a border of x.
    fn at_x(&self, border: f64, t: f64) -> DVec2 {
        DVec2::new(border, self.from.y + (self.to.y - self.from.y) * t)
    }

    /// Returns the intersection with a border of y.
    fn at_y(&self, border: f64, t: f64) -> DVec2 {
        DVec2::new(self.from.x + (self.to.x - self.from.x) * t, border)
    }

    /// Emits the points that the edge adds to the ring.
    fn walk(&self, mut put: impl FnMut(Step)) {
        let (x, y) = (&self.x, &self.y);
        let (out_1, out_2) = (x.t_out.min(y.t_out), x.t_out.max(y.t_out));
        if out_2 <= 0.0 {
            return;
        }
        let in_2 = x.t_in.max(y.t_in);
        if out_1 < in_2 {
            // Not seen: it passes a corner outside.
            if 0.0 < out_1 && out_1 <= 1.0 {
                put(Step::Turn(if x.t_in < y.t_in {
                    DVec2::new(x.border_out, y.border_in)
                } else {
                    DVec2::new(x.border_in, y.border_out)
                }));
            }
        } else if 0.0 < out_1 && in_2 <= 1.0 {
            if in_2 > 0.0 {
                let by_x = x.t_in > y.t_in;
                put(Step::Point(if by_x {
                    self.at_x(x.border_in, x.t_in)
                } else {
                    self.at_y(y.border_in, y.t_in)
                }));
            }
            if out_1 < 1.0 {
                let by_x = x.t_out < y.t_out;
                put(Step::Point(if by_x {
                    self.at_x(x.border_out, x.t_out)
                } else {
                    self.at_y(y.border_out, y.t_out)
                }));
            } else {
                put(Step::Point(self.to));
            }
        }
        if 0.0 < out_2 && out_2 <= 1.0 {
            put(Step::Turn(DVec2::new(x.border_out, y.border_out)));
        }
    }
}
