//! Point in polygon: by the winding number, from which all rules follow.
//!
//! M. Shimrat, *Algorithm 112: Position of point relative to polygon*, Communications of the ACM 5(8), 1962, counts the
//! edges that a ray to the right crosses; counted with their directions they give the winding number. Object space.
//! Cost: O(n) for n edges. All decisions are exact, and points on the border are reported as such.

use super::{Ring, WindingRule};
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, Orientation, orient2d};
use crate::trace::{NoTrace, PseudocodeLine, Tracer};

/// Location of a point relative to a region.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Place {
    /// Inside the polygon.
    Inside,
    /// On the border.
    Border,
    /// Neither.
    Outside,
}

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "point-in-polygon",
    title: "Point in polygon by the winding number",
    authors: "M. Shimrat",
    year: 1962,
    source: "Algorithm 112: Position of point relative to polygon, Communications of the ACM 5(8)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n) for n edges",
    limits: "none",
    pseudocode: &[
        "w := 0",
        "for each edge AB of all rings:",
        "    P on AB: on the border, stop",
        "    A.y and B.y on the same side of P.y: next edge",
        "    B above A and P left of AB: it crosses the ray upwards, w := w + 1",
        "    B below A and P right of AB: it crosses downwards, w := w − 1",
        "w is the winding number",
        "even-odd: inside if w is odd; non-zero: inside if w ≠ 0",
    ],
};

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// An edge crosses the ray from the point to the right.
    Crosses {
        /// Start and end of the edge.
        edge: [DVec2; 2],
        /// 1 where it goes up, −1 where it goes down (y up).
        winding: i32,
    },
    /// The point lies on an edge.
    Border {
        /// Start and end of the edge.
        edge: [DVec2; 2],
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Border { .. } => 3,
            Self::Crosses { winding: 1.., .. } => 5,
            Self::Crosses { .. } => 6,
        }
    }
}

/// Returns the winding number that a list of steps leads to; none on the border.
pub fn replay(steps: &[Step]) -> Option<i32> {
    steps.iter().try_fold(0, |sum, step| match step {
        Step::Crosses { winding, .. } => Some(sum + winding),
        Step::Border { .. } => None,
    })
}

/// Returns whether a point lies on a closed segment; exact.
pub(super) fn on_segment(a: DVec2, b: DVec2, p: DVec2) -> bool {
    let (low, high) = (a.min(b), a.max(b));
    p.cmpge(low).all() && p.cmple(high).all() && orient2d(a, b, p) == Orientation::Collinear
}

/// Returns how often rings wind around a point, counter-clockwise counted positive (y up); `None`
/// for a point on one of them.
///
/// ```
/// use durer::clip::polygon::point::winding_number;
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// let square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(DVec2::from);
/// let number = |p| winding_number([&square[..], &square], p, &mut NoTrace);
/// assert_eq!(number(DVec2::ONE), Some(2));
/// assert_eq!(number(DVec2::new(-1.0, 0.0)), Some(0));
/// assert_eq!(number(DVec2::new(4.0, 1.0)), None);
/// ```
pub fn winding_number<'a>(
    rings: impl IntoIterator<Item = &'a Ring>,
    p: DVec2,
    t: &mut impl Tracer<Step>,
) -> Option<i32> {
    let mut sum = 0;
    for ring in rings {
        let Some(mut a) = ring.last().copied() else { continue };
        for &b in ring {
            let edge = [a, b];
            if on_segment(a, b, p) {
                t.step(|| Step::Border { edge });
                return None;
            }
            // Half-open, so that a vertex on the ray counts for one of its edges.
            let wanted =
                if b.y > a.y { Orientation::CounterClockwise } else { Orientation::Clockwise };
            if (a.y > p.y) != (b.y > p.y) && orient2d(a, b, p) == wanted {
                let winding = if b.y > a.y { 1 } else { -1 };
                t.step(|| Step::Crosses { edge, winding });
                sum += winding;
            }
            a = b;
        }
    }
    Some(sum)
}

/// Returns the location of a point relative to the region that rings enclose by a rule; exact.
pub fn locate<'a>(rings: impl IntoIterator<Item = &'a Ring>, p: DVec2, rule: WindingRule) -> Place {
    match winding_number(rings, p, &mut NoTrace) {
        Some(winding) if rule.fills(winding) => Place::Inside,
        Some(_) => Place::Outside,
        None => Place::Border,
    }
}
