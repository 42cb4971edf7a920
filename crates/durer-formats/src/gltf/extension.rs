//! Which extensions are read, and what becomes of the others.

use super::json::Root;
use crate::{Error, Model, Place, Result};

/// Extensions that are read in full.
const READ: &[&str] = &[
    #[cfg(feature = "draco")]
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Extensions that are read in part, and what is left out.
const IN_PART: &[(&str, &str)] = &[(
    "KHR_materials_pbrSpecularGlossiness",
    "its diffuse colour and glossiness are taken for a rough dielectric, its specular colour is not",
)];

/// Extensions that change no picture.
const SILENT: &[&str] = &["KHR_xmp", "KHR_xmp_json_ld"];

/// What a message calls the loss of an optional extension.
fn loss(name: &str) -> &'static str {
    match name {
        "EXT_mesh_gpu_instancing" => "each instanced mesh is drawn once, at its node",
        "EXT_texture_webp" | "KHR_texture_basisu" | "MSFT_texture_dds" | "EXT_texture_avif" => {
            "textures without a PNG or JPEG are drawn white"
        }
        "KHR_materials_variants" => "the first choice of material is drawn",
        "KHR_animation_pointer" => "what it moves stays at rest",
        n if n.starts_with("KHR_materials_") => "drawn without its effect",
        _ => "passed over",
    }
}

/// Refuses files that require what is not read, and warns of each optional extension that is not.
///
/// # Errors
/// [`Error::Unsupported`] naming the required extensions.
pub fn check(root: &Root, model: &mut Model) -> Result<()> {
    let known = |name: &str| READ.contains(&name) || IN_PART.iter().any(|(n, _)| *n == name);
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
        } else if !known(name) && !SILENT.contains(&name.as_str()) {
            model.warn(place, format!("{name} is not read; {}", loss(name)));
        }
    }
    Ok(())
}
