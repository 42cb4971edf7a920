//! The materials of surfaces.

use crate::math::{DMat3, Vec3, Vec4};

/// A texture and its mapping to a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TextureRef {
    /// Index into [`super::Scene::textures`].
    pub texture: usize,
    /// Index of the set in [`super::Mesh::tex_coords`].
    pub tex_coord: u32,
    /// Matrix from the mesh's texture coordinates to the texture's (KHR_texture_transform).
    pub transform: DMat3,
}

/// Use of a surface's alpha.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum AlphaMode {
    /// Alpha is ignored: the surface is opaque.
    #[default]
    Opaque,
    /// The surface exists where alpha ≥ cutoff and has holes elsewhere.
    Mask {
        /// The threshold, usually 0.5.
        cutoff: f32,
    },
    /// The surface is blended over the surfaces behind it.
    Blend,
}

/// Shading formula that a material is written for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ShadingModel {
    /// glTF's metallic-roughness model.
    MetallicRoughness,
    /// Ambient, diffuse and specular reflection after Phong and Blinn (MTL).
    #[default]
    Phong,
    /// The base colour without lighting.
    Unlit,
}

/// Material of a surface. Colours are linear; factors multiply their textures.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Material {
    /// Name in the file.
    pub name: String,
    /// Shading formula that it is written for.
    pub model: ShadingModel,
    /// Base colour: linear RGBA, straight alpha.
    pub base_color: Vec4,
    /// Texture of the base colour: sRGB and alpha.
    pub base_color_texture: Option<TextureRef>,
    /// Metalness: 0 = dielectric, 1 = metal.
    pub metallic: f32,
    /// Roughness: 0 = mirror, 1 = matte; perceptual (squared before use).
    pub roughness: f32,
    /// Texture with roughness in green and metalness in blue; linear.
    pub metallic_roughness_texture: Option<TextureRef>,
    /// Texture of tangent-space normals; linear.
    pub normal_texture: Option<TextureRef>,
    /// Scale of the normal texture's x and y.
    pub normal_scale: f32,
    /// Texture of ambient occlusion, in red; linear.
    pub occlusion_texture: Option<TextureRef>,
    /// Strength of the occlusion texture: 0 = none, 1 = full.
    pub occlusion_strength: f32,
    /// Emitted colour: linear; may be above 1 (KHR_materials_emissive_strength).
    pub emissive: Vec3,
    /// Texture of the emitted colour: sRGB.
    pub emissive_texture: Option<TextureRef>,
    /// Phong: linear specular colour.
    pub specular: Vec3,
    /// Phong: sRGB specular colour map.
    pub specular_texture: Option<TextureRef>,
    /// Phong: the exponent of Blinn's halfway form.
    pub shininess: f32,
    /// Metallic-roughness: refractive index of the dielectric part, at least 1; 1.5 reflects 4 % of the light at normal
    /// incidence (KHR_materials_ior).
    pub ior: f32,
    /// Metallic-roughness: strength of the dielectric part's reflection, 0 … 1 (KHR_materials_specular).
    pub specular_strength: f32,
    /// Metallic-roughness: linear colour of the dielectric part's reflection at normal incidence
    /// (KHR_materials_specular).
    pub specular_tint: Vec3,
    /// Metallic-roughness: strength of a clear layer over the surface, 0 … 1 (KHR_materials_clearcoat).
    pub clearcoat: f32,
    /// Perceptual roughness of the clear layer.
    pub clearcoat_roughness: f32,
    /// Metallic-roughness: linear colour of light that fibres scatter at grazing angles; black = none
    /// (KHR_materials_sheen).
    pub sheen_color: Vec3,
    /// Perceptual roughness of the fibres.
    pub sheen_roughness: f32,
    /// Metallic-roughness: part of the light that the dielectric transmits instead of scattering it diffusely, 0 … 1
    /// (KHR_materials_transmission).
    pub transmission: f32,
    /// Use of alpha.
    pub alpha_mode: AlphaMode,
    /// True if back faces are visible, with reversed normals.
    pub double_sided: bool,
}

impl Default for Material {
    /// Creates a light grey, slightly shiny plastic, the material of files without materials.
    fn default() -> Self {
        Self {
            name: String::new(),
            model: ShadingModel::Phong,
            base_color: Vec4::new(0.8, 0.8, 0.8, 1.0),
            base_color_texture: None,
            metallic: 0.0,
            roughness: 0.5,
            metallic_roughness_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            occlusion_texture: None,
            occlusion_strength: 1.0,
            emissive: Vec3::ZERO,
            emissive_texture: None,
            specular: Vec3::splat(0.2),
            specular_texture: None,
            shininess: 32.0,
            ior: 1.5,
            specular_strength: 1.0,
            specular_tint: Vec3::ONE,
            clearcoat: 0.0,
            clearcoat_roughness: 0.0,
            sheen_color: Vec3::ZERO,
            sheen_roughness: 0.0,
            transmission: 0.0,
            alpha_mode: AlphaMode::Opaque,
            double_sided: true,
        }
    }
}

impl Material {
    /// Returns all textures that the material uses.
    pub fn textures(&self) -> impl Iterator<Item = &TextureRef> {
        [
            &self.base_color_texture,
            &self.metallic_roughness_texture,
            &self.normal_texture,
            &self.occlusion_texture,
            &self.emissive_texture,
            &self.specular_texture,
        ]
        .into_iter()
        .flatten()
    }
}
