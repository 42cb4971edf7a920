//! Triangulation of polygons with holes, by ear clipping (D. Eberly's account of G. Meisters' two-ears
//! theorem, with the z-order search of V. Agafonkin's earcut, whose Rust form does the work).
//!
//! Cost: O(n log n) on ordinary input, O(n²) at worst. Limits: crossing contours give triangles that need
//! not cover exactly the even-odd area; with a winding rule ([`triangulate_by_rule`]) they do. The search as published,
//! corner by corner, is [`super::ear_clipping`].

use earcut::Earcut;

use crate::Result;
use crate::clip::polygon::{
    BooleanOp, Shapes, WindingRule,
    overlay::{self, overlay},
};
use crate::curve::Contours;
use crate::info::{Class, Info, Occluder};
use crate::math::DVec2;
use crate::trace::{NoTrace, PseudocodeLine, Tracer};

/// The facts of triangulation.
pub const INFO: Info = Info {
    name: "triangulate",
    title: "Triangulation by ear clipping",
    authors: "Gary H. Meisters",
    year: 1975,
    source: "Polygons have ears, American Mathematical Monthly 82(6)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n log n) time on usual input, O(n²) at worst; O(n) memory",
    limits: "contours that cross need a winding rule; without one the triangles may differ from the even-odd area",
    pseudocode: &[
        "corners ← the points of all rings",
        "for each hole, from left to right:",
        "    join it to the ring by a bridge to a visible corner",
        "while the ring has more than three corners:",
        "    for each corner B between its neighbours A and C:",
        "        if B is reflex, that is (B − A) × (C − B) ≤ 0: next corner",
        "        if another corner lies in the triangle A B C: next corner",
        "        output the triangle A B C, B is an ear",
        "        remove B from the ring",
        "output the last three corners",
    ],
};

/// Triangles of a polygon.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Triangulation {
    /// The finite points of the contours, in their order.
    pub points: Vec<DVec2>,
    /// Indices into `points`, three to a triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl Triangulation {
    /// Returns the sum of the triangles' areas.
    pub fn area(&self) -> f64 {
        let at = |i: u32| self.points.get(i as usize).copied().unwrap_or_default();
        let area = |t: &[u32; 3]| (at(t[1]) - at(t[0])).perp_dot(at(t[2]) - at(t[0])).abs() / 2.0;
        self.triangles.iter().map(area).sum()
    }
}

/// One step. [`triangulate`] reports points and triangles, [`ears`](super::ear_clipping::ears) all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The next of the points that triangles name.
    Point(DVec2),
    /// A hole is joined to the ring: corners of the hole and of the ring.
    Bridge([u32; 2]),
    /// A corner is no ear, as it is reflex.
    Reflex {
        /// The corner between its neighbours.
        corners: [u32; 3],
        /// (B − A) × (C − B), not positive.
        cross: f64,
    },
    /// A corner is no ear, as another one is in its triangle.
    Blocked {
        /// The corner between its neighbours.
        corners: [u32; 3],
        /// The other one.
        by: u32,
    },
    /// An ear is cut off: its corners.
    Triangle([u32; 3]),
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Point(_) => 1,
            Self::Bridge(_) => 3,
            Self::Reflex { .. } => 6,
            Self::Blocked { .. } => 7,
            Self::Triangle(_) => 8,
        }
    }
}

/// Triangulates a polygon: the first contour is its border, the others are holes in it.
///
/// ```
/// use durer::curve::{Path, flatten};
/// use durer::raster::triangulate::triangulate;
/// use durer::trace::NoTrace;
///
/// let mut frame = Path::rectangle(0.0, 0.0, 4.0, 4.0);
/// frame.extend(&Path::rectangle(1.0, 1.0, 2.0, 2.0));
/// let triangles = triangulate(&flatten(&frame, 0.1), &mut NoTrace);
/// assert_eq!(triangles.area(), 12.0);
/// assert_eq!(triangles.triangles.len(), 8);
/// ```
pub fn triangulate(polygon: &Contours, t: &mut impl Tracer<Step>) -> Triangulation {
    let mut points = Vec::with_capacity(polygon.points().len());
    let mut holes: Vec<u32> = Vec::new();
    for (i, (contour, _)) in polygon.iter().enumerate() {
        if i > 0 {
            holes.push(points.len() as u32);
        }
        points.extend(contour.iter().copied().filter(|p| p.is_finite()));
    }
    let mut indices: Vec<u32> = Vec::new();
    Earcut::new().earcut(points.iter().map(|p| [p.x, p.y]), &holes, &mut indices);
    let triangles = indices.as_chunks::<3>().0.to_vec();
    let found = Triangulation { points, triangles };
    report(&found, t);
    found
}

/// Triangulates the region that contours enclose by a winding rule, as OpenGL's tessellator does: they may cross
/// themselves and one another, and need no order. Where they cross, points are added; the overlay finds them, and the
/// region's polygons are triangulated one after the other.
///
/// ```
/// use durer::clip::polygon::WindingRule;
/// use durer::curve::Contours;
/// use durer::math::DVec2;
/// use durer::raster::triangulate::triangulate_by_rule;
/// use durer::trace::NoTrace;
///
/// // Two squares that overlap in one unit, both counter-clockwise.
/// let square = |x: f64| [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)].map(|(u, v)| DVec2::new(x + u, v));
/// let mut contours = Contours::polygon(square(0.0));
/// contours.push(square(1.0), true);
/// let area = |rule| triangulate_by_rule(&contours, rule, &mut NoTrace).map(|triangles| triangles.area());
/// assert_eq!(area(WindingRule::EvenOdd)?, 2.0);
/// assert_eq!(area(WindingRule::NonZero)?, 3.0);
/// assert_eq!(area(WindingRule::AbsGeqTwo)?, 1.0);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// As [`overlay()`]: for points that are not finite, or are too many.
pub fn triangulate_by_rule(
    contours: &Contours,
    rule: WindingRule,
    t: &mut impl Tracer<Step>,
) -> Result<Triangulation> {
    let mut rings = Shapes::new();
    contours.iter().for_each(|(points, _)| rings.push_ring(points.iter().copied()));
    rings.end_polygon();
    let options = overlay::Options::with_rule(rule);
    let region = overlay(&rings, &Shapes::new(), BooleanOp::Union, &options, &mut NoTrace)?.shapes;
    let mut all = Triangulation::default();
    for polygon in region.polygons() {
        let mut contours = Contours::new();
        polygon.rings().for_each(|ring| contours.push(ring.iter().copied(), true));
        let part = triangulate(&contours, &mut NoTrace);
        let first = all.points.len() as u32;
        all.points.extend(part.points);
        all.triangles.extend(part.triangles.iter().map(|corners| corners.map(|i| i + first)));
    }
    report(&all, t);
    Ok(all)
}

fn report(found: &Triangulation, t: &mut impl Tracer<Step>) {
    found.points.iter().for_each(|p| t.step(|| Step::Point(*p)));
    found.triangles.iter().for_each(|corners| t.step(|| Step::Triangle(*corners)));
}
