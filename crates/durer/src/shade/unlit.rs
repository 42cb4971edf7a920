//! No shading: the base colour as it is.
//!
//! Khronos, *KHR_materials_unlit*, 2017; for scanned models whose textures hold their light.

use crate::info::{Class, Info, Occluder};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "unlit",
    title: "Unlit",
    authors: "Khronos Group",
    year: 2017,
    source: "glTF 2.0 extension KHR_materials_unlit",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(1) per pixel",
    limits: "shows no shape except in the texture",
    pseudocode: &[
        "u/w, v/w, 1/w ← texture coordinates of the corners, divided by w",
        "for each row that the face covers:",
        "    find where the edges cross the row",
        "    u/w, v/w, 1/w ← values there, between those of the corners",
        "    for each pixel between the edges:",
        "        u, v ← u/w, v/w over 1/w; colour ← base colour · texel(u, v) · colour of the vertices",
        "// no normal and no light: a surface painted or photographed with its light",
        "// looks the same from every side",
    ],
};
