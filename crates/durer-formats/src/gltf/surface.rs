//! The changes that extensions make to a material.
//!
//! The scene has single numbers for some values that extensions may vary by a texture: for these the mean of the
//! texture is used, with one warning per extension. Values that need a texture become one (`derived.rs`).

use super::json::{Clearcoat, MaterialExtensions, Sheen, Specular};
use super::specular_glossiness::Glossy;
use super::texture_ref::texture;
use super::todo::{Job, Todo, What};
use durer::math::Vec3;
use durer::scene::{Material, ShadingModel};

/// Largest factor of emission, so that light stays finite for any file.
pub const BRIGHTEST: f32 = 1e6;

/// The index that means infinity (KHR_materials_ior: 0): everything is reflected.
const MIRROR: f32 = 1e6;

/// Changes a material as its extensions say.
pub fn extend(
    index: usize,
    material: &mut Material,
    extensions: &MaterialExtensions,
    todo: &mut Todo,
) {
    if let Some(glossy) = &extensions.specular_glossiness {
        material.base_color = Glossy::of(glossy).diffuse;
        material.base_color_texture = texture(glossy.diffuse_texture.as_ref());
        material.metallic_roughness_texture = None;
    }
    if extensions.unlit.is_some() {
        // Shown without lighting, so reflection and transmission have no meaning.
        material.model = ShadingModel::Unlit;
        return;
    }
    if let Some(glossy) = &extensions.specular_glossiness {
        let texture = texture(glossy.specular_glossiness_texture.as_ref());
        let what = What::Glossy(Glossy::of(glossy));
        todo.jobs.push(Job { material: index, texture, what });
        // The others go with the other model only.
        return;
    }
    if let Some(ior) = extensions.ior.as_ref().and_then(|e| e.ior) {
        material.ior = if ior == 0.0 { MIRROR } else { ior.clamp(1.0, MIRROR) };
    }
    if let Some(specular) = &extensions.specular {
        set_specular(index, material, specular, todo);
    }
    if let Some(clearcoat) = &extensions.clearcoat {
        set_clearcoat(index, material, clearcoat, todo);
    }
    if let Some(sheen) = &extensions.sheen {
        set_sheen(index, material, sheen, todo);
    }
    if let Some(transmission) = &extensions.transmission {
        material.transmission = transmission.transmission_factor.clamp(0.0, 1.0);
    }
    if material.transmission > 0.0 {
        let tint = extensions.volume.as_ref().and_then(|v| v.attenuation_color);
        let tint = Vec3::from(tint.unwrap_or([1.0; 3])).clamp(Vec3::ZERO, Vec3::ONE);
        material.base_color *= tint.extend(1.0);
        let map = extensions.transmission.as_ref().and_then(|t| t.transmission_texture.as_ref());
        todo.jobs.push(Job { material: index, texture: texture(map), what: What::Glass });
    }
}

fn set_specular(index: usize, material: &mut Material, specular: &Specular, todo: &mut Todo) {
    const NAME: &str = "KHR_materials_specular";
    material.specular_strength = specular.specular_factor.unwrap_or(1.0).clamp(0.0, 1.0);
    let tint = Vec3::from(specular.specular_color_factor.unwrap_or([1.0; 3]));
    material.specular_tint = tint.clamp(Vec3::ZERO, Vec3::splat(BRIGHTEST));
    let (strength, tint) = (&specular.specular_texture, &specular.specular_color_texture);
    todo.mean(index, strength.as_ref(), false, NAME, |m, mean| m.specular_strength *= mean.w);
    todo.mean(index, tint.as_ref(), true, NAME, |m, mean| m.specular_tint *= mean.truncate());
}

fn set_clearcoat(index: usize, material: &mut Material, coat: &Clearcoat, todo: &mut Todo) {
    const NAME: &str = "KHR_materials_clearcoat";
    material.clearcoat = coat.clearcoat_factor.clamp(0.0, 1.0);
    material.clearcoat_roughness = coat.clearcoat_roughness_factor.clamp(0.0, 1.0);
    let (strength, rough) = (&coat.clearcoat_texture, &coat.clearcoat_roughness_texture);
    todo.mean(index, strength.as_ref(), false, NAME, |m, mean| m.clearcoat *= mean.x);
    todo.mean(index, rough.as_ref(), false, NAME, |m, mean| m.clearcoat_roughness *= mean.y);
    if coat.clearcoat_normal_texture.is_some() {
        todo.leave_out(NAME, "of normals is left out", index);
    }
}

fn set_sheen(index: usize, material: &mut Material, sheen: &Sheen, todo: &mut Todo) {
    const NAME: &str = "KHR_materials_sheen";
    material.sheen_color = Vec3::from(sheen.sheen_color_factor).clamp(Vec3::ZERO, Vec3::ONE);
    material.sheen_roughness = sheen.sheen_roughness_factor.clamp(0.0, 1.0);
    let (color, rough) = (&sheen.sheen_color_texture, &sheen.sheen_roughness_texture);
    todo.mean(index, color.as_ref(), true, NAME, |m, mean| m.sheen_color *= mean.truncate());
    todo.mean(index, rough.as_ref(), false, NAME, |m, mean| m.sheen_roughness *= mean.w);
}
