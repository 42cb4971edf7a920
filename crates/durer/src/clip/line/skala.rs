//! Skala's line clipping in homogeneous coordinates.
//!
//! Václav Skala, "A new approach to line and line segment clipping in homogeneous coordinates", The Visual Computer 21(11),
//! 2005; for convex polygons his "An efficient algorithm for line clipping by convex polygon", Computers & Graphics 17(4),
//! 1993. Object space; O(n) for a window with n corners, two crossings at most. The line is the cross product of its
//!       ends; the signs of the corners relative to it are a code, which gives the crossed borders before any crossing
//!       is computed.
//!
//! The paper finds the two borders in a table of the 2ⁿ codes; here they are the borders whose corners have different signs,
//! which are the table's entries for any n. A corner on the line belongs to both sides, so windows are closed. Signs are exact;
//! crossings are computed as in the other algorithms of the family instead of by a second cross product.

use super::border::Canonical;
use super::convex::{self, HalfSpace};
use super::{ClipBox, ConvexPolygon, End, HalfPlane, Segment};
use crate::Result;
use crate::clip::exact;
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, DVec3, Rect};
use crate::trace::{PseudocodeLine, Tracer};
use std::cmp::Ordering;

/// The facts of Skala's clipping.
pub const INFO: Info = Info {
    name: "skala",
    title: "Skala",
    authors: "Václav Skala",
    year: 2005,
    source: "A new approach to line and line segment clipping in homogeneous coordinates, The Visual Computer 21(11)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n) per segment for a window of n corners; no crossing is computed in vain",
    limits: "convex windows in two dimensions",
    pseudocode: &[
        "both ends inside all borders: accept, stop",
        "both ends beyond one border: reject, stop",
        "(a, b, c) ← A × B, the line a·x + b·y + c = 0 through (x_A, y_A, 1) and (x_B, y_B, 1)",
        "for each corner X of the window:",
        "    s ← sign of a·x + b·y + c, a digit of the code",
        "all digits + or all −: the line misses the window, reject, stop",
        "// a border is crossed if the digits of its two corners differ",
        "A is outside: A ← crossing with the crossed border that A is beyond",
        "B is outside: B ← crossing with the crossed border that B is beyond",
        "accept AB",
    ],
};

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The line through the ends in homogeneous coordinates; rounded.
    Line {
        /// a, b and c.
        coefficients: DVec3,
    },
    /// A corner of the window was compared with the line.
    Corner {
        /// Its index: counter-clockwise, of a rectangle from the one with the smallest coordinates.
        corner: usize,
        /// a·x + b·y + c, positive on the left of A → B; rounded.
        value: f64,
        /// Its exact sign.
        side: Ordering,
    },
    /// One end moves to a border.
    Cut {
        /// End that moves.
        end: End,
        /// The border: for a rectangle 2·axis, plus 1 for the larger coordinate; for a polygon the number of the corner
        /// where it begins.
        border: usize,
        /// New position of the end.
        point: DVec2,
    },
    /// The rest is inside.
    Accepted {
        /// True if both ends were inside.
        at_once: bool,
    },
    /// Nothing remains.
    Rejected {
        /// The first border that both ends are beyond; none if the window is on one side of the line.
        beyond: Option<usize>,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Accepted { at_once: true } => 1,
            Self::Rejected { beyond: Some(_) } => 2,
            Self::Line { .. } => 3,
            Self::Corner { .. } => 5,
            Self::Rejected { beyond: None } => 6,
            Self::Cut { end: End::Start, .. } => 8,
            Self::Cut { end: End::End, .. } => 9,
            Self::Accepted { at_once: false } => 10,
        }
    }
}

/// Returns the result that a list of steps leads to.
pub fn replay(mut segment: Segment<DVec2>, steps: &[Step]) -> Option<Segment<DVec2>> {
    for step in steps {
        match *step {
            Step::Line { .. } | Step::Corner { .. } => {}
            Step::Cut { end, point, .. } => segment = segment.moved(end, point),
            Step::Accepted { .. } => return Some(segment),
            Step::Rejected { .. } => return None,
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
    let (min, max) = (window.min(), window.max());
    let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
    let search = Search {
        corners: &corners,
        borders: &HalfPlane::of_rect(window),
        ends: |border| [[3, 0], [1, 2], [0, 1], [2, 3]][border % 4],
        line,
    };
    let ends = ClipBox::from(window);
    let cut = |border: usize| line.cut(&ends, border / 2, border % 2);
    Ok(search.run(segment, cut, t))
}

/// Returns the part of a segment in a closed convex polygon.
///
/// ```
/// use durer::clip::line::{ConvexPolygon, Segment, skala};
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// let p = DVec2::new;
/// let triangle = ConvexPolygon::new(&[p(0.0, 0.0), p(4.0, 0.0), p(0.0, 4.0)])?;
/// let clipped = skala::clip_polygon(&triangle, Segment::new(p(1.0, 1.0), p(5.0, 1.0)), &mut NoTrace)?;
/// assert_eq!(clipped, Some(Segment::new(p(1.0, 1.0), p(3.0, 1.0))));
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`crate::Error::NonFinite`] for a NaN or infinite coordinate.
pub fn clip_polygon(
    window: &ConvexPolygon,
    segment: Segment<DVec2>,
    t: &mut impl Tracer<Step>,
) -> Result<Option<Segment<DVec2>>> {
    let line = Canonical::new(segment.start.to_array(), segment.end.to_array())?;
    let edges = window.edges();
    let count = edges.len();
    let ends = |border| [border, (border + 1) % count];
    let search = Search { corners: window.vertices(), borders: &edges, ends, line };
    Ok(search.run(segment, |border| convex::crossing(&edges, border, &line), t))
}

/// A segment before a convex window.
struct Search<'a, H, F> {
    corners: &'a [DVec2],
    borders: &'a [H],
    /// The two corners of a border.
    ends: F,
    line: Canonical<2>,
}

impl<H: HalfSpace<2>, F: Fn(usize) -> [usize; 2]> Search<'_, H, F> {
    fn run(
        &self,
        segment: Segment<DVec2>,
        cut: impl Fn(usize) -> [f64; 2],
        t: &mut impl Tracer<Step>,
    ) -> Option<Segment<DVec2>> {
        let beyond = |p: [f64; 2], border: usize| self.borders[border].sign(p) == Ordering::Less;
        let outside = [self.line.p, self.line.q]
            .map(|p| (0..self.borders.len()).any(|border| beyond(p, border)));
        if outside == [false; 2] {
            t.step(|| Step::Accepted { at_once: true });
            return Some(segment);
        }
        let all = 0..self.borders.len();
        let both = |border: &usize| [self.line.p, self.line.q].iter().all(|p| beyond(*p, *border));
        if let Some(border) = all.clone().find(both) {
            t.step(|| Step::Rejected { beyond: Some(border) });
            return None;
        }
        let sides = self.sides(segment, t);
        let meets = |other: Ordering| sides.iter().any(|side| *side != other);
        if !meets(Ordering::Less) || !meets(Ordering::Greater) {
            t.step(|| Step::Rejected { beyond: None });
            return None;
        }
        let is_crossed = |border: &usize| {
            let [a, b] = (self.ends)(*border).map(|corner| sides[corner]);
            a != b || a == Ordering::Equal
        };
        // Two borders only if they meet in a corner on the line.
        let find = |p| all.clone().filter(|border| beyond(p, *border)).find(is_crossed);
        let [lower, upper] = [self.line.p, self.line.q].map(find);
        let cut = |border: Option<usize>| border.map(|border| (border, cut(border)));
        let (lower, upper) = (cut(lower), cut(upper));
        let [first, last] = if self.line.swapped { [upper, lower] } else { [lower, upper] };
        for (cut, end) in [(first, End::Start), (last, End::End)] {
            if let Some((border, point)) = cut {
                t.step(|| Step::Cut { end, border, point: point.into() });
            }
        }
        t.step(|| Step::Accepted { at_once: false });
        let ends = [lower.map_or(self.line.p, |cut| cut.1), upper.map_or(self.line.q, |cut| cut.1)];
        Some(self.line.in_order(ends[0], ends[1]))
    }

    /// Returns the side of the directed line p → q on which each corner lies.
    fn sides(&self, segment: Segment<DVec2>, t: &mut impl Tracer<Step>) -> Vec<Ordering> {
        let (a, b) = (segment.start, segment.end);
        t.step(|| Step::Line { coefficients: a.extend(1.0).cross(b.extend(1.0)) });
        let (p, q) = (DVec2::from(self.line.p), DVec2::from(self.line.q));
        let side = |(corner, &at): (usize, &DVec2)| {
            let side = exact::side(p, q, at);
            t.step(|| {
                let value = (b - a).perp_dot(at - a);
                let side = if self.line.swapped { side.reverse() } else { side };
                Step::Corner { corner, value, side }
            });
            side
        };
        self.corners.iter().enumerate().map(side).collect()
    }
}
