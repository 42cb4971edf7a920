//! The extensions that are read, and the effects of ignoring others.

use super::json::Root;
use crate::{Error, Model, Place, Result};
use durer::math::DVec3;

/// Extensions that are read in full.
const READ: &[&str] = &[
    #[cfg(feature = "draco")]
    "KHR_draco_mesh_compression",
    "CESIUM_RTC",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_meshopt_compression",
    "KHR_lights_punctual",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
];

/// Extensions that are read in part, and the parts left out.
const IN_PART: &[(&str, &str)] = &[
    ("KHR_materials_transmission", "surfaces behind show through, without refraction or blur"),
    ("KHR_materials_volume", "its colour tints the surface, its thickness does nothing"),
];

/// Extensions whose absence is reported elsewhere, or changes no picture: metadata, physics, what avatars can do, and
/// coarser levels of detail.
const SILENT: &[&str] = &[
    "AGI_articulations",
    "EXT_instance_features",
    "EXT_mesh_features",
    "EXT_mesh_manifold",
    "EXT_structural_metadata",
    "FB_geometry_metadata",
    "KHR_interactivity",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_texture_basisu",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_lod",
    "VRMC_node_constraint",
    "VRMC_springBone",
    "VRMC_vrm",
];

/// Beginnings of the names of further ones.
const SILENT_KINDS: &[&str] = &["KHR_audio_", "KHR_collision_", "KHR_physics_", "OMI_"];

/// Describes the effect of an ignored optional extension, for a message.
fn loss(name: &str) -> &'static str {
    match name {
        "MSFT_texture_dds" | "EXT_texture_avif" => {
            "textures without a PNG, JPEG or WebP are drawn white"
        }
        "KHR_animation_pointer" => "animated parts stay at rest",
        "KHR_gaussian_splatting" => "splats are drawn as points",
        "CESIUM_primitive_outline" => "outlines are not drawn; --edges draws edges",
        "EXT_lights_image_based" | "EXT_lights_ies" => "its lights do not shine",
        "VRM" | "VRMC_materials_mtoon" => "toon materials are drawn as ordinary ones",
        n if n.contains("_materials_") => "drawn without its effect",
        _ => "drawn without what it adds",
    }
}

/// Returns the place of the file's origin in the world, by `CESIUM_RTC`: zero without it. The extension's z axis points
/// up, glTF's y axis.
pub fn center(root: &Root) -> DVec3 {
    let center = root.extensions.rtc.as_ref().and_then(|rtc| rtc.center);
    let [x, y, z] = center.filter(|c| c.iter().all(|x| x.is_finite())).unwrap_or_default();
    DVec3::new(x, z, -y)
}

/// Refuses files that require an unsupported extension, and warns of each optional one.
///
/// # Errors
/// [`Error::Unsupported`] naming the required extensions.
pub fn check(root: &Root, model: &mut Model) -> Result<()> {
    let known = |name: &str| {
        READ.contains(&name)
            || SILENT.contains(&name)
            || SILENT_KINDS.iter().any(|kind| name.starts_with(kind))
            || IN_PART.iter().any(|(n, _)| *n == name)
    };
    let required = &root.extensions_required;
    let missing: Vec<&str> = required.iter().map(String::as_str).filter(|n| !known(n)).collect();
    if !missing.is_empty() {
        return Err(Error::Unsupported {
            place: Place::Path("extensionsRequired".to_owned()),
            what: missing.join(", "),
            hint: "export the model without it".to_owned(),
        });
    }
    for name in root.extensions_used.iter().chain(required) {
        if model.extensions.contains(name) {
            continue;
        }
        model.extensions.push(name.clone());
        let place = Place::Path("extensionsUsed".to_owned());
        if let Some((_, what)) = IN_PART.iter().find(|(n, _)| n == name) {
            model.warn(place, format!("{name} is read in part: {what}"));
        } else if !known(name) {
            model.warn(place, format!("{name} is not read; {}", loss(name)));
        }
    }
    Ok(())
}
