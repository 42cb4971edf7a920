//! The textures of a material in their places.

use super::lane::{Lane, Vec3Lane};
use super::lookup::TexCoords;
use super::mip::MipChain;
use super::surface::{Surface, TexCoord};
use super::texture::{PreparedTexture, Usage};
use crate::math::{DMat3, Vec2, Vec4};
use crate::scene::{MipFilter, Scene, TextureRef};
use fearless_simd::{Simd, f32x16};
use std::sync::Arc;

/// A texture in its place.
#[derive(Debug, Clone)]
pub(super) struct Slot<'a> {
    pub texture: PreparedTexture<'a>,
    pub set: usize,
    /// Columns of the affine map from the mesh's coordinates to the texture's, unless they are the same.
    columns: Option<[Vec2; 3]>,
}

impl Slot<'_> {
    #[inline]
    pub fn coordinates(&self, surface: &Surface<'_>) -> TexCoord {
        let at = surface.tex_coords.get(self.set).copied().unwrap_or_default();
        let Some([x, y, offset]) = self.columns else { return at };
        let turned = |d: Vec2| x * d.x + y * d.y;
        TexCoord { uv: turned(at.uv) + offset, ddx: turned(at.ddx), ddy: turned(at.ddy) }
    }

    #[inline]
    pub fn sample(&self, surface: &Surface<'_>) -> Vec4 {
        let at = self.coordinates(surface);
        self.texture.sample(at.uv, at.ddx, at.ddy)
    }

    /// Samples sixteen points as [`Self::sample`] does one; `at` is of the slot's own set.
    #[inline(always)]
    fn sample_x16<S: Simd>(&self, simd: S, at: &TexCoords<f32x16<S>>) -> [f32x16<S>; 4] {
        let mut at = *at;
        if let Some([x, y, _]) = self.columns {
            let (u, v) = ([x.x, y.x], [x.y, y.y]);
            at = TexCoords {
                uv: self.placed(at.uv),
                ddx: [sum(at.ddx, u), sum(at.ddx, v)],
                ddy: [sum(at.ddy, u), sum(at.ddy, v)],
            };
        }
        PreparedTexture::sample_x16(simd, &self.texture, &at)
    }

    /// Converts coordinates of the mesh to coordinates in the texture.
    #[inline(always)]
    pub fn placed<S: Simd>(&self, uv: [f32x16<S>; 2]) -> [f32x16<S>; 2] {
        let Some([x, y, offset]) = self.columns else { return uv };
        [sum(uv, [x.x, y.x]) + offset.x, sum(uv, [x.y, y.y]) + offset.y]
    }
}

/// Red, green, blue and alpha of a texture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Texel<L>(pub [L; 4]);

impl<L: Lane> Texel<L> {
    #[inline(always)]
    pub fn color(&self) -> Vec3Lane<L> {
        let [r, g, b, _] = self.0;
        Vec3Lane::new(r, g, b)
    }
}

/// Returns a weighted sum of two coordinates.
#[inline(always)]
fn sum<S: Simd>([a, b]: [f32x16<S>; 2], [of_a, of_b]: [f32; 2]) -> f32x16<S> {
    a * of_a + b * of_b
}

/// Values of a material's textures at a point, except for its base colour.
pub(super) struct Texels<L> {
    pub emissive: Option<Texel<L>>,
    pub occlusion: Option<Texel<L>>,
    pub metallic_roughness: Option<Texel<L>>,
    pub specular: Option<Texel<L>>,
}

/// Samples sixteen points as [`Slot::sample_x16`] does, where there is a slot.
#[inline(always)]
pub(super) fn sampled_x16<S: Simd>(
    simd: S,
    slot: &Option<Slot<'_>>,
    at: &TexCoords<f32x16<S>>,
) -> Option<Texel<f32x16<S>>> {
    match slot {
        Some(slot) => Some(Texel(slot.sample_x16(simd, at))),
        None => None,
    }
}

/// The mip chains made so far: one per image and use, with all levels or without, however many
/// materials share it.
pub(super) struct Chains<'a> {
    scene: &'a Scene,
    made: Vec<((usize, Usage, bool), Arc<MipChain<'a>>)>,
}

impl<'a> Chains<'a> {
    /// Creates the set of a scene, without any chains yet.
    pub fn new(scene: &'a Scene) -> Self {
        Self { scene, made: Vec::new() }
    }

    /// Returns a slot for a texture; none if it refers to nothing.
    pub fn slot(&mut self, reference: Option<TextureRef>, usage: Usage) -> Option<Slot<'a>> {
        let reference = reference?;
        let texture = self.scene.textures.get(reference.texture)?;
        let image = self.scene.images.get(texture.image)?;
        let levels = texture.sampler.mip != MipFilter::None;
        let wanted = (texture.image, usage, levels);
        let chain = if let Some((_, chain)) = self.made.iter().find(|(made, _)| *made == wanted) {
            Arc::clone(chain)
        } else {
            let chain = Arc::new(MipChain::new(image, usage, levels));
            self.made.push((wanted, Arc::clone(&chain)));
            chain
        };
        let column = |[x, y, _]: [f64; 3]| Vec2::new(x as f32, y as f32);
        let moves = reference.transform != DMat3::IDENTITY;
        let columns = moves.then(|| reference.transform.to_cols_array_2d().map(column));
        let texture = PreparedTexture::from_chain(chain, texture.sampler);
        Some(Slot { texture, set: reference.tex_coord as usize, columns })
    }
}
