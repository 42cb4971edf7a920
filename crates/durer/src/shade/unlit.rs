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
    limits: "shows no form but what the texture shows",
    pseudocode: &[],
};
