//! Back-face removal: faces that turn their back to the eye are removed first.
//!
//! L. G. Roberts, *Machine Perception of Three-Dimensional Solids*, MIT Lincoln Laboratory TR 315, 1963: the eye is put
//! into the equation of each face's plane. Normals are M. Newell's, from all corners of a polygon (in I. Sutherland, R.
//! Sproull, R. Schumacker, *A Characterization of Ten Hidden-Surface Algorithms*, ACM Computing Surveys 1974), so that
//! concave and slightly bent polygons get the right side too. Object space. Cost: O(corners); memory O(1) besides the
//! result.
//!
//! Limits: only for closed bodies whose faces run counter-clockwise seen from outside. For one convex body the result
//! is exactly the visible faces; otherwise it leaves out faces that are certainly hidden, about half of all. Coherence
//! used: objects (a body's back is hidden by its front).
//!
//! The image-space algorithms do the same by the sign of a triangle's area on the screen (switched by
//! [`super::surface::Cull`]): the same triangles are removed, except slivers that rounding to the grid of
//! 1/256 pixel turns over.
//!
//! ```
//! use durer::math::DVec3;
//! use durer::trace::NoTrace;
//! use durer::visibility::back_face::{Eye, Options, remove};
//!
//! let square = |z: f64| [(0., 0.), (1., 0.), (1., 1.), (0., 1.)].map(|(x, y)| DVec3::new(x, y, z));
//! let (mut bottom, top) = (square(0.0), square(1.0));
//! bottom.reverse();
//! let eye = Eye::At(DVec3::new(0.5, 0.5, 3.0));
//! let kept = remove([&bottom[..], &top[..]], eye, &Options::default(), &mut NoTrace);
//! assert_eq!(kept, [1]);
//! ```

use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec3;
use crate::scene::{Camera, Mesh, Projection, Scene};
use crate::trace::{PseudocodeLine, Tracer};
use crate::view::cull::{FaceSide, face_along, face_from_point, newell_area, triangle_area};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "back-face-removal",
    title: "Back-face removal",
    authors: "L. G. Roberts; M. Newell",
    year: 1963,
    source: "Machine Perception of Three-Dimensional Solids, MIT Lincoln Laboratory TR 315",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Face],
    cost: "O(corners)",
    limits: "closed bodies; complete only for a single convex body",
    pseudocode: &[
        "for each face with corners P_1 … P_n, counter-clockwise from outside:",
        "    N ← (0, 0, 0)",
        "    for each two neighbours P_i, P_j:",
        "        N_x ← N_x + (y_i − y_j)(z_i + z_j), N_y and N_z likewise",
        "    // Newell: N is as long as twice the area of the face",
        "    d ← N · (eye − mean of the corners)",
        "    if d > 0: the face turns its front to the eye: keep it",
        "    if d ≤ 0: it turns its back, or is seen edge-on: remove it",
    ],
};

/// Place or direction from which faces are seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Eye {
    /// A point, in perspective.
    At(DVec3),
    /// A direction, by parallel rays.
    Along(DVec3),
}

impl Eye {
    /// Returns the eye of a camera, world space.
    pub fn of(camera: &Camera) -> Self {
        match camera.projection {
            Projection::Perspective { .. } => Self::At(camera.eye),
            Projection::Orthographic { .. } => Self::Along(-camera.axes()[2]),
        }
    }

    /// Returns the side of a face that is seen from here.
    pub(crate) fn side(self, normal: DVec3, point: DVec3) -> FaceSide {
        match self {
            Self::At(eye) => face_from_point(normal, point, eye),
            Self::Along(direction) => face_along(normal, direction),
        }
    }
}

/// Options for the faces to leave out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// True to keep faces whose plane contains the eye; they cover no area.
    pub keep_edge_on: bool,
    /// True if the triangles of a polygon ([`Mesh::faces`]) in a scene stay or go together, by the
    /// polygon's normal; false if each does by its own.
    pub whole_polygons: bool,
}

impl Default for Options {
    /// Returns the default: faces seen edge-on are removed; polygons stay or are removed as a whole.
    fn default() -> Self {
        Self { keep_edge_on: false, whole_polygons: true }
    }
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The eye was put into the equation of a face's plane.
    Tested {
        /// The face's place among those given.
        face: usize,
        /// Its vector area by Newell's method: along its normal, as long as its area.
        area: DVec3,
        /// The side that is seen.
        side: FaceSide,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        let Self::Tested { side, .. } = self;
        if *side == FaceSide::Front { 7 } else { 8 }
    }
}

/// Returns the places of the polygons that turn their front to the eye, in order. Corners run
/// counter-clockwise seen from the front; faces that are not finite or have no area count as seen
/// edge-on.
pub fn remove<'a>(
    polygons: impl IntoIterator<Item = &'a [DVec3]>,
    eye: Eye,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Vec<usize> {
    let faces = polygons.into_iter().enumerate();
    let kept =
        faces.filter(|(face, ring)| stays(*face, newell_area(ring), mean(ring), eye, options, t));
    kept.map(|(face, _)| face).collect()
}

/// Returns the items of a scene's triangles that turn their front to the eye, in order; the scene has
/// passed [`Scene::check`]. Faces are numbered through all instances. Matrices that mirror turn no
/// front into a back.
pub fn remove_of_scene(
    scene: &Scene,
    eye: Eye,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Vec<u32> {
    let (mut kept, mut corners) = (Vec::new(), Vec::new());
    let (mut face, mut first_item) = (0, 0);
    for instance in &scene.instances {
        let mesh = &scene.meshes[instance.mesh];
        let matrix = instance.world_from_mesh;
        let mirrored = glam::DMat3::from_mat4(matrix).determinant() < 0.0;
        for triangles in polygons(mesh, options.whole_polygons) {
            let corner = |v: u32| matrix.transform_point3(mesh.positions[v as usize].as_dvec3());
            corners.clear();
            corners.extend(triangles.clone().flat_map(|i| mesh.triangle(i)).map(corner));
            let parts = corners.as_chunks().0;
            let area = parts.iter().map(|triangle| triangle_area(*triangle)).sum::<DVec3>();
            let area = if mirrored { -area } else { area };
            if stays(face, area, mean(&corners), eye, options, t) {
                kept.extend(triangles.map(|i| first_item + i as u32));
            }
            face += 1;
        }
        first_item += mesh.triangle_count() as u32;
    }
    kept
}

/// Returns the mean of a face's corners, through which Newell's plane goes.
fn mean(corners: &[DVec3]) -> DVec3 {
    corners.iter().sum::<DVec3>() / corners.len() as f64
}

/// Returns whether a face stays whose plane goes through a point, across its vector area.
fn stays(
    face: usize,
    area: DVec3,
    point: DVec3,
    eye: Eye,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> bool {
    let side = eye.side(area, point);
    t.step(|| Step::Tested { face, area, side });
    match side {
        FaceSide::Front => true,
        FaceSide::Edge => options.keep_edge_on,
        FaceSide::Back => false,
    }
}

/// Returns the triangles of each face of a mesh.
fn polygons(mesh: &Mesh, whole: bool) -> impl Iterator<Item = std::ops::Range<usize>> + '_ {
    let count = mesh.triangle_count();
    let faces = if whole { mesh.faces.as_slice() } else { &[] };
    let faces = faces.iter().map(move |&first| (first as usize).min(count));
    let ends = faces.clone().skip(1).chain([count]);
    let single = if whole && !mesh.faces.is_empty() { 0 } else { count };
    // Without a list of faces each triangle is one.
    faces.zip(ends).map(|(first, end)| first..end.max(first)).chain((0..single).map(|i| i..i + 1))
}
