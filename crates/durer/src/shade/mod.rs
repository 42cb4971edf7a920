//! Light on surfaces.
//!
//! [`PreparedMaterials`] and [`PreparedLights`] are made once per picture, [`shade`] is called per
//! visible sample, [`gouraud::shade_vertex`] and [`flat::shade_face`] for the interpolated and the flat model. Renderers shade eight
//! and sixteen samples of one material at a time by the same formulas.
//!
//! Space: world axes, but with the origin moved to the eye ([`PreparedLights::origin`]), so that
//! `f32` suffices far from the world's own origin. Colours are linear with sRGB's primaries.

mod axes;
pub mod color;
pub(crate) mod environment;
pub(crate) mod exposure;
pub mod flat;
mod formula;
pub mod gouraud;
pub(crate) mod lane;
pub(crate) mod light;
mod lobes;
mod lookup;
pub(crate) mod material;
pub mod metallic_roughness;
mod mip;
mod normal;
pub(crate) mod panorama;
pub mod phong;
mod plain;
mod points;
mod reflected;
pub mod shadow;
mod slot;
pub(crate) mod studio;
mod surface;
mod texel;
pub mod texture;
mod textured;
pub(crate) mod tone;
pub(crate) mod tone_map;
pub mod unlit;
mod usage;

pub use environment::Surroundings;
pub use exposure::Exposure;
pub(crate) use flat::shade_face;
pub(crate) use gouraud::{Reflected, shade_vertex};
pub use light::PreparedLights;
pub(crate) use lookup::TexCoords;
pub use material::{PreparedMaterial, PreparedMaterials, shade, shade_seen};
pub(crate) use normal::Frame;
pub use panorama::Panorama;
pub(crate) use plain::{shade_frame, shade_points};
pub(crate) use points::{Faces, Points};
pub use surface::{Surface, TexCoord};
pub(crate) use texture::PreparedTexture;
pub(crate) use textured::{TexturedPoint, TexturedPoints};
pub use tone_map::ToneMap;

crate::info::family! {
    /// Interpolation of intensities, and the formula that lights a surface.
    pub enum Shading {
        /// One intensity per face (Bouknight 1970).
        Flat => flat::INFO,
        /// Intensities at the vertices, interpolated (Gouraud 1971).
        Gouraud => gouraud::INFO,
        /// Normals interpolated, one intensity per pixel (Phong 1975), Blinn's halfway form.
        Phong => phong::INFO,
        /// glTF's metallic-roughness formula per pixel.
        MetallicRoughness => metallic_roughness::INFO,
        /// The base colour without lighting.
        Unlit => unlit::INFO,
    }
}

impl From<crate::scene::ShadingModel> for Shading {
    fn from(model: crate::scene::ShadingModel) -> Self {
        use crate::scene::ShadingModel;
        match model {
            ShadingModel::MetallicRoughness => Self::MetallicRoughness,
            ShadingModel::Phong => Self::Phong,
            ShadingModel::Unlit => Self::Unlit,
        }
    }
}
