//! Gouraud shading: intensities are computed at the vertices and interpolated over the face.
//!
//! H. Gouraud, *Continuous Shading of Curved Surfaces*, IEEE Transactions on Computers C-20(6), 1971.
//! Cost: O(lights) per vertex, one interpolation per pixel. Limits: highlights inside a face are
//! lost, and those at a vertex show the face's shape (Mach bands).
//!
//! Diffuse and specular light are interpolated separately, so that textures and vertex colours, which are looked up per
//! pixel, tint only the diffuse light.

use super::light::PreparedLights;
use super::material::PreparedMaterial;
use super::normal::face_viewer;
use super::phong;
pub use super::reflected::Reflected;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::Vec3;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "gouraud",
    title: "Gouraud shading",
    authors: "Henri Gouraud",
    year: 1971,
    source: "IEEE Transactions on Computers C-20(6)",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Face],
    cost: "O(l) per vertex, l lights; O(1) per pixel",
    limits: "highlights inside a face are lost; the result depends on the triangulation",
    pseudocode: &[
        "for each corner: N ← mean of the normals of its faces",
        "    I ← light there: ambient + diffuse · max(0, N · L) + …",
        "for each row that the triangle covers:",
        "    along its two edges: I_a and I_b, linear in y",
        "    for each pixel between them:",
        "        I ← I_a + (I_b − I_a) · (x − x_a) / (x_b − x_a)",
        "        set the pixel to I",
        "// a highlight between the corners is lost",
    ],
};

/// Returns the light at one vertex of a face, for [`super::Surface::lit`].
///
/// `position` is relative to the lights' origin, `view` points to the eye (any length), `normal` is the vertex's and
/// `face` the face's unit normal, which decides from which side it is seen. Textures of roughness and occlusion are
/// ignored at a vertex. Cost: O(lights).
pub fn shade_vertex(
    position: Vec3,
    view: Vec3,
    normal: Vec3,
    face: Vec3,
    material: &PreparedMaterial<'_>,
    lights: &PreparedLights,
) -> Reflected {
    let frame = face_viewer(view.into(), face.into(), normal.into());
    phong::reflect_one(&frame, position, lights, material.shininess(), 1.0)
}
