//! Textures of the classic pipeline: an image, its sampler, and the combination of its colour with a fragment's.
//!
//! M. Segal, K. Akeley, *The OpenGL Graphics System: A Specification* 2.1 (2006), 3.8.13, for images with alpha.

use crate::math::{DVec2, DVec4, Vec4};
use crate::scene::{Image, MipFilter, Sampler, TextureFilter};
use crate::shade::PreparedTexture;
use crate::shade::texture::Usage;
use std::sync::Arc;

/// Function that combines the texture's colour with the fragment's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TextureFunction {
    /// The texture's.
    Replace,
    /// Their product: the initial state.
    #[default]
    Modulate,
    /// The texture's over the fragment's, by the texture's alpha; the fragment's alpha stays.
    Decal,
    /// Interpolation from the fragment's colour to the environment's, by the texture's colour.
    Blend,
    /// Their sum; alphas are multiplied.
    Add,
}

/// A texture in use. Texture coordinates (0, 0) are the corner of the image's first row and column, (1, 1) that of the
/// last ones.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundTexture {
    /// Image, 8-bit sRGB with straight alpha.
    pub image: Arc<Image>,
    /// Filters, and extension outside 0 … 1. Levels are computed for each drawing command: O(texels).
    pub sampler: Sampler,
    /// Function by which its colour is applied.
    pub function: TextureFunction,
    /// Linear colour of the environment, for [`TextureFunction::Blend`]; at first 0.
    pub color: Vec4,
}

impl BoundTexture {
    /// Creates a texture with OpenGL's magnification filter, without levels, that multiplies colours.
    pub fn new(image: Image) -> Self {
        let sampler =
            Sampler { min: TextureFilter::Linear, mip: MipFilter::None, ..Sampler::default() };
        let (function, color) = (TextureFunction::default(), Vec4::ZERO);
        Self { image: Arc::new(image), sampler, function, color }
    }

    pub(super) fn prepare(&self) -> Prepared<'_> {
        let texels = PreparedTexture::new(&self.image, self.sampler, Usage::ColorWithAlpha);
        Prepared { texels, texture: self }
    }
}

/// A texture with its levels.
pub(super) struct Prepared<'a> {
    texels: PreparedTexture<'a>,
    texture: &'a BoundTexture,
}

impl Prepared<'_> {
    /// Returns the colour of a fragment with the texture applied. `at` are the texture coordinates of the fragment, and
    /// those one pixel further along x and y.
    pub fn apply(&self, color: DVec4, at: [DVec2; 3]) -> DVec4 {
        let [uv, right, down] = at;
        let (ddx, ddy) = ((right - uv).as_vec2(), (down - uv).as_vec2());
        let texel = self.texels.sample(uv.as_vec2(), ddx, ddy).as_dvec4();
        combine(self.texture.function, color, texel, self.texture.color.as_dvec4())
    }
}

fn combine(function: TextureFunction, fragment: DVec4, texel: DVec4, environment: DVec4) -> DVec4 {
    let (f, t, e) = (fragment.truncate(), texel.truncate(), environment.truncate());
    let alpha = fragment.w * texel.w;
    match function {
        TextureFunction::Replace => texel,
        TextureFunction::Modulate => fragment * texel,
        TextureFunction::Decal => f.lerp(t, texel.w).extend(fragment.w),
        TextureFunction::Blend => (f * (1.0 - t) + e * t).extend(alpha),
        TextureFunction::Add => (f + t).min(crate::math::DVec3::ONE).extend(alpha),
    }
}
