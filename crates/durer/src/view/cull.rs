//! The detection of invisible objects: boxes and spheres outside a volume, faces turned away.
//!
//! Bounding volumes against planes: James Clark, *Hierarchical Geometric Models for Visible Surface
//! Algorithms*, CACM 1976. Normals of polygons: Martin Newell, in Sutherland, Sproull and Schumacker,
//! *A Characterization of Ten Hidden-Surface Algorithms*, ACM Computing Surveys 1974.

use crate::clip::outcode::ClipDepths;
use crate::clip::volume::planes_in_source;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::{DMat4, DVec2, DVec3, Plane, Rect};
use crate::scene::{Aabb, BoundingSphere};
use crate::trace::{NoTrace, PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "bounding-volumes",
    title: "Culling by bounding volumes",
    authors: "J. H. Clark",
    year: 1976,
    source: "Hierarchical geometric models for visible surface algorithms, Communications of the ACM 19(10)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Object],
    cost: "O(p) per box or sphere for p planes",
    limits: "conservative: an object outside, near a corner, can be reported as crossing",
    pseudocode: &[
        "C, h ← centre and half sides of the box",
        "result ← inside",
        "for each plane n · P + d = 0 of the region, n inwards:",
        "    s ← n · C + d, for the centre",
        "    r ← |n_x| h_x + |n_y| h_y + |n_z| h_z, the reach of the box along n",
        "    s < −r: return outside; nothing of the box is drawn",
        "    s < r: result ← crossing",
        "return result: a box inside is drawn without clipping",
    ],
};

/// Relation of an object to a volume.
///
/// Conservative: `Outside` and `Inside` are certain, also with respect to rounding; `Crossing` may be returned for an
/// object outside, near a corner of the volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Containment {
    /// No part of it is in the volume.
    Outside,
    /// All of it is in the volume.
    Inside,
    /// Neither is certain.
    Crossing,
}

impl Containment {
    fn of(outside: bool, inside: bool) -> Self {
        match (outside, inside) {
            (true, _) => Self::Outside,
            (false, true) => Self::Inside,
            (false, false) => Self::Crossing,
        }
    }
}

/// Step of the test of a body against a convex region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The body was compared with a plane.
    Plane {
        /// Number of the plane.
        plane: usize,
        /// n · C + d for the body's centre C, positive inside; lengths are those of the normal.
        distance: f64,
        /// Distance that the body extends from its centre along the normal.
        reach: f64,
        /// Relation to this plane alone.
        relation: Containment,
    },
    /// The relation to the region was found.
    Found(Containment),
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Plane { relation: Containment::Inside, .. } => 5,
            Self::Plane { relation: Containment::Outside, .. } => 6,
            Self::Plane { relation: Containment::Crossing, .. } => 7,
            Self::Found(_) => 8,
        }
    }
}

/// Returns the relation that the planes of a list of steps lead to.
pub fn replay(steps: &[Step]) -> Containment {
    let relations = || {
        steps.iter().filter_map(|step| match step {
            Step::Plane { relation, .. } => Some(*relation),
            Step::Found(_) => None,
        })
    };
    let outside = relations().any(|relation| relation == Containment::Outside);
    Containment::of(outside, relations().all(|relation| relation == Containment::Inside))
}

/// Tests a rectangle against a window; exact, because coordinates are only compared.
pub fn rect_in_window(window: &Rect, thing: &Rect) -> Containment {
    let inside = window.contains(thing.min()) && window.contains(thing.max());
    Containment::of(!window.overlaps(thing), inside)
}

/// Returns a disk of the plane against a window.
pub fn disk_in_window(window: &Rect, center: DVec2, radius: f64) -> Containment {
    let nearest = center.clamp(window.min(), window.max());
    let distance2 = (center - nearest).length_squared();
    // Each of the few operations errs by half an ulp of its result.
    let outside = distance2 > radius * radius * (1.0 + 16.0 * f64::EPSILON);
    let reach = radius + 2.0 * f64::EPSILON * (center.abs() + radius);
    let (lo, hi) = (center - reach, center + reach);
    Containment::of(outside, lo.cmpge(window.min()).all() && hi.cmple(window.max()).all())
}

/// A convex region of space: the common inside of planes.
///
/// ```
/// use durer::math::{DMat4, DVec3};
/// use durer::scene::Aabb;
/// use durer::view::cull::{Containment, ConvexVolume};
/// let frustum = ConvexVolume::frustum(&DMat4::IDENTITY, Default::default());
/// let cube = Aabb { min: DVec3::splat(2.0), max: DVec3::splat(3.0) };
/// assert_eq!(frustum.contains_box(&cube), Containment::Outside);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ConvexVolume {
    planes: Vec<Plane>,
}

impl ConvexVolume {
    /// Creates the region inside all planes, normals inward; without planes all of space.
    pub fn new(planes: Vec<Plane>) -> Self {
        Self { planes }
    }

    /// Returns the view volume of a matrix that takes world space to clip space.
    pub fn frustum(clip_from_world: &DMat4, depth: ClipDepths) -> Self {
        Self::new(planes_in_source(clip_from_world, depth).into())
    }

    /// Returns its planes, normals inward.
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// Tests a box against the region by two corners per plane.
    pub fn contains_box(&self, b: &Aabb) -> Containment {
        self.contains_box_traced(b, &mut NoTrace)
    }

    /// Tests a box as [`Self::contains_box`] does, with a listener for its steps.
    pub fn contains_box_traced(&self, b: &Aabb, t: &mut impl Tracer<Step>) -> Containment {
        let (center, half) = (b.min * 0.5 + b.max * 0.5, b.max * 0.5 - b.min * 0.5);
        self.contains(center, |normal| normal.abs().dot(half), t)
    }

    /// Tests a sphere against the region.
    pub fn contains_sphere(&self, s: &BoundingSphere) -> Containment {
        self.contains(s.center, |normal| normal.length() * s.radius, &mut NoTrace)
    }

    /// Tests an object against the region; `reach` returns its extent from its centre along a normal.
    fn contains(
        &self,
        center: DVec3,
        reach: impl Fn(DVec3) -> f64,
        t: &mut impl Tracer<Step>,
    ) -> Containment {
        let mut found = Containment::Inside;
        for (index, plane) in self.planes.iter().enumerate() {
            let (distance, reach) = (plane.evaluate(center), reach(plane.normal));
            // A dozen roundings, each at most half an ulp of the largest term.
            let terms = plane.normal.abs().dot(center.abs()) + plane.distance.abs() + reach;
            let slack = 16.0 * f64::EPSILON * terms;
            let relation = Containment::of(distance + reach < -slack, distance - reach >= slack);
            t.step(|| Step::Plane { plane: index, distance, reach, relation });
            match relation {
                Containment::Inside => {}
                Containment::Crossing => found = Containment::Crossing,
                Containment::Outside => {
                    found = Containment::Outside;
                    break;
                }
            }
        }
        t.step(|| Step::Found(found));
        found
    }
}

/// Visible side of a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FaceSide {
    /// The side from which its corners run counter-clockwise.
    Front,
    /// The other side.
    Back,
    /// Neither: the eye is in its plane, or it has no area.
    Edge,
}

/// Returns the vector area of a closed polygon in space by Newell's method: along its normal, on
/// the side from which the corners run counter-clockwise, as long as its area.
///
/// Correct for concave polygons too, and for the best-fitting plane if the corners are not exactly in one.
pub fn newell_area(ring: &[DVec3]) -> DVec3 {
    let Some(&origin) = ring.first() else { return DVec3::ZERO };
    let next = ring.iter().cycle().skip(1);
    // Newell's sums of (yᵢ − yⱼ)(zᵢ + zⱼ) are these cross products, taken from the first corner.
    ring.iter().zip(next).map(|(&a, &b)| (a - origin).cross(b - origin)).sum::<DVec3>() * 0.5
}

/// Returns the vector area of a triangle by the cross product; see [`newell_area`].
pub fn triangle_area([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a) * 0.5
}

/// Returns the side of a face that an eye at a point sees. `point` is any point of the face's
/// plane.
pub fn face_from_point(normal: DVec3, point: DVec3, eye: DVec3) -> FaceSide {
    side(normal.dot(eye - point))
}

/// Returns the side of a face seen along a direction, as by an orthographic camera.
pub fn face_along(normal: DVec3, direction: DVec3) -> FaceSide {
    side(-normal.dot(direction))
}

fn side(toward_eye: f64) -> FaceSide {
    if toward_eye > 0.0 {
        FaceSide::Front
    } else if toward_eye < 0.0 {
        FaceSide::Back
    } else {
        FaceSide::Edge
    }
}
