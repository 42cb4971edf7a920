//! Circles clipped to a rectangle: the arcs that are left.
//!
//! J. D. Foley, A. van Dam, S. K. Feiner, J. F. Hughes, *Computer Graphics: Principles and Practice*, 2nd ed. 1990, section
//! 3.13; D. Hearn, M. P. Baker, *Computer Graphics*, 2nd ed. 1994, section 6-9: the square around the circle decides most
//! cases; otherwise the circle is intersected with each border. Object space. Cost: O(1), two square roots and arctangents
//! for each border that is crossed.
//!
//! Deviation: the books test quadrants and octants before they compute crossings. Here each border takes away the arc that
//! is beyond it, so that no order of crossings must be found afterwards.

use super::outcode::Outcode;
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, Rect};
use crate::trace::{PseudocodeLine, Tracer};
use crate::{Error, Result};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "circle-clipping",
    title: "Circle clipping",
    authors: "J. D. Foley, A. van Dam, S. K. Feiner, J. F. Hughes",
    year: 1990,
    source: "Computer Graphics: Principles and Practice, 2nd ed., section 3.13",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(1): at most four borders",
    limits: "circles and axis-parallel rectangles; the curve, not its area",
    pseudocode: &[
        "compare the square around the circle with the window",
        "    beyond a border: reject, stop",
        "    inside all borders: accept the whole circle, stop",
        "arcs ← the whole circle, angles 0 … 2π",
        "for each border, at the distance d from the centre, negative if the centre is beyond it:",
        "    d ≥ r: all of the circle is inside it, next border",
        "    α ← arccos(d / r), φ ← direction of the border from the window's middle",
        "    take the angles φ − α … φ + α out of the arcs",
        "the remaining arcs are in the window, at most four",
    ],
};

/// Arcs shorter than this, in radians, are left out: rounding leaves them at a corner on the circle, where two borders meet.
const SHORT: f64 = 4e-15;

/// Largest radius: its square is finite.
pub const MAX_RADIUS: f64 = 1e150;

/// A circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// Centre.
    pub center: DVec2,
    /// Radius, in units of the coordinates.
    pub radius: f64,
}

impl Circle {
    /// Returns the point in a direction from the centre.
    pub fn at(&self, angle: f64) -> DVec2 {
        self.center + DVec2::new(libm::cos(angle), libm::sin(angle)) * self.radius
    }
}

/// An arc of a circle, counter-clockwise (y up).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// Directions of its start, 0 … 2π, and of its end, which is larger by at most 2π, in radians.
    pub angles: [f64; 2],
    /// Its start and its end; where a border cuts it they are on the border, bit for bit.
    pub ends: [DVec2; 2],
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The square around the circle was compared with the window.
    Box {
        /// Borders that all of it is beyond.
        beyond: Outcode,
        /// Borders that a part of it is beyond.
        crossed: Outcode,
    },
    /// A border was compared with the circle.
    Border {
        /// The border, one bit.
        border: Outcode,
        /// Its distance from the centre, negative if the centre is beyond it.
        distance: f64,
        /// Angles between which the circle is beyond it; none if it takes nothing away.
        taken: Option<[f64; 2]>,
    },
    /// An arc is inside all borders.
    Arc(Arc),
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Box { beyond, .. } if !beyond.is_inside() => 2,
            Self::Box { crossed, .. } if crossed.is_inside() => 3,
            Self::Box { .. } => 1,
            Self::Border { taken: None, .. } => 6,
            Self::Border { .. } => 8,
            Self::Arc(_) => 9,
        }
    }
}

/// Returns the result that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<Arc> {
    let arc = |step: &Step| if let Step::Arc(arc) = *step { Some(arc) } else { None };
    steps.iter().filter_map(arc).collect()
}

/// Returns the arcs of a circle that are in a closed rectangle, by the angles of their starts.
///
/// ```
/// use durer::clip::circle::{Circle, clip};
/// use durer::math::{DVec2, Rect};
/// use durer::trace::NoTrace;
///
/// let window = Rect::new(DVec2::ZERO, DVec2::new(9.0, 8.0))?;
/// let circle = Circle { center: DVec2::new(5.0, 5.0), radius: 5.0 };
/// // The top takes the arc from (1, 8) to (9, 8) away, the right side that from (9, 2) to (9, 8).
/// let arcs = clip(&window, &circle, &mut NoTrace)?;
/// assert_eq!(arcs.len(), 1);
/// assert_eq!(arcs[0].ends, [DVec2::new(1.0, 8.0), DVec2::new(9.0, 2.0)]);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::NonFinite`] for a centre, [`Error::Parameter`] for a radius that is negative, NaN or above [`MAX_RADIUS`].
pub fn clip(window: &Rect, circle: &Circle, t: &mut impl Tracer<Step>) -> Result<Vec<Arc>> {
    let Circle { center, radius } = *circle;
    if !center.is_finite() {
        return Err(Error::NonFinite { what: "centre", index: 0 });
    }
    if !(0.0..=MAX_RADIUS).contains(&radius) {
        return Err(Error::parameter("radius", radius, "from 0 to 1e150"));
    }
    let distances = distances(window, center);
    let beyond = Outcode::from_inside(distances.map(|d| d >= -radius));
    let crossed = Outcode::from_inside(distances.map(|d| d >= radius));
    t.step(|| Step::Box { beyond, crossed });
    let mut arcs = vec![Arc { angles: [0.0, TAU], ends: [circle.at(0.0); 2] }];
    if !beyond.is_inside() {
        arcs.clear();
    } else if !crossed.is_inside() {
        for ((border, distance), direction) in
            Outcode::BORDERS.into_iter().zip(distances).zip(DIRECTIONS)
        {
            let cut =
                (distance < radius).then(|| Cut::new(window, circle, border, distance, direction));
            let taken = cut.as_ref().map(|cut| cut.angles);
            t.step(|| Step::Border { border, distance, taken });
            if let Some(cut) = cut {
                arcs = arcs.iter().flat_map(|arc| cut.left_of(arc)).flatten().collect();
            }
        }
        join(&mut arcs);
        arcs.retain(|arc| arc.angles[1] - arc.angles[0] > SHORT);
    }
    arcs.iter().for_each(|arc| t.step(|| Step::Arc(*arc)));
    Ok(arcs)
}

/// Directions of the left, the right, the lower and the upper border from the middle of a window.
const DIRECTIONS: [f64; 4] = [PI, 0.0, 3.0 * FRAC_PI_2, FRAC_PI_2];

/// Returns the distances of the four borders from a point, negative for those that it is beyond.
fn distances(window: &Rect, p: DVec2) -> [f64; 4] {
    let (min, max) = (window.min(), window.max());
    [p.x - min.x, max.x - p.x, p.y - min.y, max.y - p.y]
}

/// An arc beyond a border.
struct Cut {
    /// Its angles, around the direction of the border.
    angles: [f64; 2],
    /// Its ends.
    ends: [DVec2; 2],
}

impl Cut {
    /// Creates the arc beyond a border that the circle crosses.
    fn new(window: &Rect, circle: &Circle, border: Outcode, distance: f64, direction: f64) -> Self {
        let (center, r) = (circle.center, circle.radius);
        let half = ((r - distance) * (r + distance)).max(0.0).sqrt();
        // More exact than the arccosine where the circle hardly passes the border.
        let angle = libm::atan2(half, distance);
        let (min, max) = (window.min(), window.max());
        let along = match border {
            Outcode::LEFT => {
                [DVec2::new(min.x, center.y + half), DVec2::new(min.x, center.y - half)]
            }
            Outcode::RIGHT => {
                [DVec2::new(max.x, center.y - half), DVec2::new(max.x, center.y + half)]
            }
            Outcode::BOTTOM => {
                [DVec2::new(center.x - half, min.y), DVec2::new(center.x + half, min.y)]
            }
            _ => [DVec2::new(center.x + half, max.y), DVec2::new(center.x - half, max.y)],
        };
        Self { angles: [direction - angle, direction + angle], ends: along }
    }

    /// Returns what is left of an arc between 0 and 2π: parts before and behind the cut. The cut may begin before 0 or
    /// end after 2π.
    fn left_of(&self, arc: &Arc) -> [Option<Arc>; 2] {
        let [from, to] = self.angles;
        let (start, end) = (from < 0.0, to > TAU);
        // Of angles 0 … 2π, the cut leaves those from `low` to `high`, or those outside of `from` … `to`.
        let before = |high: f64| {
            let is_cut = high < arc.angles[1];
            let (angle, point) =
                if is_cut { (high, self.ends[0]) } else { (arc.angles[1], arc.ends[1]) };
            Arc { angles: [arc.angles[0], angle], ends: [arc.ends[0], point] }
        };
        let behind = |low: f64, arc: Arc| {
            let is_cut = low > arc.angles[0];
            let (angle, point) =
                if is_cut { (low, self.ends[1]) } else { (arc.angles[0], arc.ends[0]) };
            Arc { angles: [angle, arc.angles[1]], ends: [point, arc.ends[1]] }
        };
        let parts = match (start, end) {
            (true, _) => [Some(behind(to, before(from + TAU))), None],
            (_, true) => [Some(behind(to - TAU, before(from))), None],
            _ => [Some(before(from)), Some(behind(to, *arc))],
        };
        parts.map(|part| part.filter(|part| part.angles[0] < part.angles[1]))
    }
}

/// Joins an arc that ends at 2π with one that begins at 0.
fn join(arcs: &mut Vec<Arc>) {
    let [Some(first), Some(last)] = [arcs.first().copied(), arcs.last().copied()] else { return };
    if arcs.len() > 1 && first.angles[0] == 0.0 && last.angles[1] == TAU {
        arcs.remove(0);
        if let Some(joined) = arcs.last_mut() {
            joined.angles[1] = first.angles[1] + TAU;
            joined.ends[1] = first.ends[1];
        }
    }
}
