//! Flat shading: one intensity for a whole face.
//!
//! W. J. Bouknight, *A Procedure for Generation of Three-Dimensional Half-Toned Computer Graphics Presentations*,
//! Communications of the ACM 13(9), 1970. Cost: O(lights) per face. Limits: curved surfaces look faceted, which shows
//! the structure of a mesh.
//!
//! Intensity is computed at the face's centroid with the face's normal by Phong's formula.

use super::gouraud::{Reflected, shade_vertex};
use super::light::PreparedLights;
use super::material::PreparedMaterial;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::Vec3;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "flat",
    title: "Flat shading",
    authors: "W. Jack Bouknight",
    year: 1970,
    source: "Communications of the ACM 13(9)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Face],
    cost: "O(l) per face, l lights; O(1) per pixel",
    limits: "curved surfaces look faceted",
    pseudocode: &[
        "N ← normal of the face",
        "M ← mean of its corners",
        "I ← ambient light + what each light adds at M with N, once for the face",
        "for each row that the face covers:",
        "    for each pixel between its edges:",
        "        set the pixel to I",
        "// nothing is interpolated: pixels of a face are alike,",
        "// and at an edge between two faces the intensity jumps",
    ],
};

/// Returns the light on a whole face, for [`super::Surface::lit`].
///
/// `centroid` is relative to the lights' origin, `view` points from it to the eye (any length),
/// `face` is the face's unit normal. Cost: O(lights).
pub fn shade_face(
    centroid: Vec3,
    view: Vec3,
    face: Vec3,
    material: &PreparedMaterial<'_>,
    lights: &PreparedLights,
) -> Reflected {
    shade_vertex(centroid, view, face, face, material, lights)
}
