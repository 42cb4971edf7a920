//! Materials with their textures, ready for shading, and the common entry to all shading models.

mod materials;
mod shaded;

pub use materials::PreparedMaterials;
pub use shaded::{shade, shade_seen};

use super::formula::{self, Inputs};
use super::lane::{Lane, Vec3Lane};
use super::light::PreparedLights;
use super::lobes::Lobes;
use super::lookup::TexCoords;
use super::metallic_roughness::Substance;
use super::normal::{Frame, face_seen, perturbed};
use super::phong::{Colors, Shininess, from_metallic_roughness};
use super::points::Points;
use super::slot::{Chains, Slot, Texel, Texels, sampled_x16};
use super::surface::Surface;
use super::texture::Usage;
use super::textured::TexturedPoint;
use super::{Shading, tone};
use crate::math::{Vec3, Vec4};
use crate::scene::{AlphaMode, Material, ShadingModel};
use fearless_simd::{Simd, f32x16};
use fearless_simd_macros::simd;

/// Roughness up to which dielectrics mirror the same surroundings as metals. The reflections of rougher ones are so
/// soft that the sky, which takes less time, looks the same.
const SMOOTH: f32 = 0.4;

/// Returns whether a formula takes Phong's inputs.
fn by_phong(shading: Shading) -> bool {
    !matches!(shading, Shading::MetallicRoughness | Shading::Unlit)
}

/// Function from the directions to the eye, of the face and of the normal to a frame.
type Framing = fn(Vec3Lane<f32>, Vec3Lane<f32>, Vec3Lane<f32>) -> Frame<f32>;

/// A material with its textures.
#[derive(Debug, Clone)]
pub struct PreparedMaterial<'a> {
    model: ShadingModel,
    base_color: Vec4,
    alpha_mode: AlphaMode,
    metallic: f32,
    roughness: f32,
    normal_scale: f32,
    occlusion_strength: f32,
    emissive: Vec3,
    specular: Vec3,
    /// Phong's parameters without textures.
    phong: Colors,
    /// True if it is metal, even in places only, or smooth, or has a clear layer, or transmits
    /// light.
    mirrors: bool,
    /// Further lobes of the metallic-roughness model.
    lobes: Option<Lobes>,
    base_color_slot: Option<Slot<'a>>,
    metallic_roughness_slot: Option<Slot<'a>>,
    normal_slot: Option<Slot<'a>>,
    occlusion_slot: Option<Slot<'a>>,
    emissive_slot: Option<Slot<'a>>,
    specular_slot: Option<Slot<'a>>,
    textured: bool,
}

impl<'a> PreparedMaterial<'a> {
    fn new(m: &Material, chains: &mut Chains<'a>) -> Self {
        let base_usage = match m.alpha_mode {
            AlphaMode::Opaque => Usage::Color,
            _ => Usage::ColorWithAlpha,
        };
        let (metallic, roughness) = metallic_roughness_of(m);
        let mut slot = |reference, usage| chains.slot(reference, usage);
        let mut prepared = Self {
            model: m.model,
            base_color: m.base_color,
            alpha_mode: m.alpha_mode,
            metallic,
            roughness,
            normal_scale: m.normal_scale,
            occlusion_strength: m.occlusion_strength,
            emissive: m.emissive,
            specular: m.specular,
            phong: phong_of(m),
            mirrors: metallic > 0.0 || roughness <= SMOOTH || Lobes::of(m).is_some(),
            lobes: Lobes::of(m),
            base_color_slot: slot(m.base_color_texture, base_usage),
            metallic_roughness_slot: slot(m.metallic_roughness_texture, Usage::Data),
            normal_slot: slot(m.normal_texture, Usage::Data),
            occlusion_slot: slot(m.occlusion_texture, Usage::Data),
            emissive_slot: slot(m.emissive_texture, Usage::Color),
            specular_slot: slot(m.specular_texture, Usage::Color),
            textured: false,
        };
        let textured = prepared.slots().next().is_some();
        prepared.textured = textured;
        prepared
    }

    fn slots(&self) -> impl Iterator<Item = &Slot<'a>> {
        let slots = [
            &self.base_color_slot,
            &self.metallic_roughness_slot,
            &self.normal_slot,
            &self.occlusion_slot,
            &self.emissive_slot,
            &self.specular_slot,
        ];
        slots.into_iter().flatten()
    }

    /// Returns the one set of texture coordinates that all textures use, where samples of the
    /// material may also be looked up sixteen at a time, by [`Self::shade_x16`]; nothing has vertex
    /// colours.
    pub(crate) fn looked_up_together(&self, shading: Shading) -> Option<usize> {
        let set = self.slots().next()?.set;
        let suits = |slot: &Slot<'_>| slot.set == set && slot.texture.suits_lanes();
        let plain = self.normal_slot.is_none() && self.lobes.is_none();
        let together = self.has_one_exponent(shading) && plain;
        (together && self.slots().all(suits)).then_some(set)
    }

    /// Returns whether [`Self::shade_x16`] asks how texture coordinates change over the screen.
    pub(crate) fn has_levels(&self) -> bool {
        self.slots().any(|slot| slot.texture.has_levels())
    }

    /// Returns linear red, green and blue of sixteen points and their alpha, with the same bits as [`shade`], except
    /// that colours without alpha are not black; the material must be [looked up together](Self::looked_up_together).
    /// Cost: O(lights) and sixteen samples per texture.
    #[simd]
    pub(crate) fn shade_x16<S: Simd>(
        simd: S,
        this: &Self,
        points: &Points<f32x16<S>>,
        at: &TexCoords<f32x16<S>>,
        lights: &PreparedLights,
        shading: Shading,
    ) -> (Vec3Lane<f32x16<S>>, f32x16<S>) {
        let like = points.position.x;
        let white = Texel([like.splat(1.0); 4]);
        let texel = sampled_x16(simd, &this.base_color_slot, at).unwrap_or(white);
        let (base, alpha) = (this.base_times(&texel), this.alpha_times(&texel));
        if shading == Shading::Unlit {
            return (tone::display(base), alpha);
        }
        let frame = points.frame();
        let texels = Texels {
            emissive: sampled_x16(simd, &this.emissive_slot, at),
            occlusion: sampled_x16(simd, &this.occlusion_slot, at),
            metallic_roughness: sampled_x16(simd, &this.metallic_roughness_slot, at),
            specular: sampled_x16(simd, &this.specular_slot, at),
        };
        let inputs = this.inputs(like, base, &texels, shading);
        (formula::display(&frame, points.position, &inputs, None, lights, shading), alpha)
    }

    /// Returns the base colour with its texture, without the vertex colour.
    #[inline(always)]
    pub(super) fn base_times<L: Lane>(&self, texel: &Texel<L>) -> Vec3Lane<L> {
        Vec3Lane::splat(texel.0[0], self.base_color.truncate()).times(texel.color())
    }

    /// Returns the alpha of the base colour with its texture, without the vertex colour, by the material's alpha mode;
    /// 1 for masked materials.
    #[inline(always)]
    pub(super) fn alpha_times<L: Lane>(&self, texel: &Texel<L>) -> L {
        let alpha = texel.0[3] * self.base_color.w;
        match self.alpha_mode {
            AlphaMode::Blend => alpha.at_most(1.0).at_least(0.0),
            _ => alpha.splat(1.0),
        }
    }

    /// Returns the formula the material was written for.
    pub fn shading(&self) -> Shading {
        self.model.into()
    }

    /// Returns whether the material has one alpha, no textures and no more lobes than most, so that many points of a
    /// mesh without vertex colours are shaded at a time.
    pub fn is_plain(&self) -> bool {
        let clear = matches!(self.alpha_mode, AlphaMode::Opaque | AlphaMode::Blend);
        !self.textured && clear && self.lobes.is_none()
    }

    /// Returns the alpha of all points of a [plain](Self::is_plain) material.
    pub(crate) fn plain_alpha(&self) -> f32 {
        self.coverage(self.base_color.w)
    }

    /// Returns whether any slot has a texture, so that texture coordinates are needed.
    pub fn is_textured(&self) -> bool {
        self.textured
    }

    /// Returns whether tangents or position derivatives are needed.
    pub(crate) fn has_normal_map(&self) -> bool {
        self.normal_slot.is_some()
    }

    /// Returns the use of alpha.
    pub fn alpha_mode(&self) -> AlphaMode {
        self.alpha_mode
    }

    /// Returns Phong's exponent without textures.
    pub(super) fn shininess(&self) -> Shininess {
        self.phong.shininess
    }

    /// Returns the inputs of all formulas where no texture has a say.
    #[inline(always)]
    pub(super) fn constant_inputs<L: Lane>(&self, like: L) -> Inputs<'_, L> {
        let substance = Substance {
            base: Vec3Lane::splat(like, self.base_color.truncate()),
            metallic: like.splat(self.metallic),
            roughness: like.splat(self.roughness),
            occlusion: like.splat(1.0),
            mirrors: self.mirrors,
        };
        Inputs {
            substance,
            diffuse: Vec3Lane::splat(like, self.phong.diffuse),
            specular: Vec3Lane::splat(like, self.phong.specular),
            shininess: self.phong.shininess,
            emission: Vec3Lane::splat(like, self.emissive),
            // Materials with lobes are never lit from constants alone.
            lobes: None,
        }
    }

    /// Returns the base colour with its texture and the vertex colour.
    #[inline]
    fn base(&self, surface: &Surface<'_>) -> Vec4 {
        let base = self.base_color * surface.color;
        self.base_color_slot.as_ref().map_or(base, |slot| base * slot.sample(surface))
    }

    /// Returns the alpha of a point, equal to that of [`shade`], without lighting it.
    pub(crate) fn alpha(&self, surface: &Surface<'_>) -> f32 {
        self.coverage(self.base(surface).w)
    }

    /// Returns the alpha that is left of `alpha`: 1 or 0 unless the material blends.
    #[inline]
    fn coverage(&self, alpha: f32) -> f32 {
        match self.alpha_mode {
            AlphaMode::Opaque => 1.0,
            AlphaMode::Mask { cutoff } => f32::from(u8::from(alpha >= cutoff)),
            AlphaMode::Blend if alpha > 0.0 => alpha.min(1.0),
            AlphaMode::Blend => 0.0,
        }
    }

    /// Returns the inputs of all formulas, with textures applied.
    #[inline(always)]
    fn inputs<L: Lane>(
        &self,
        like: L,
        base: Vec3Lane<L>,
        texels: &Texels<L>,
        shading: Shading,
    ) -> Inputs<'_, L> {
        let mut inputs = self.constant_inputs(like);
        inputs.substance.base = base;
        if let Some(texel) = &texels.emissive {
            inputs.emission = Vec3Lane::splat(like, self.emissive).times(texel.color());
        }
        if let Some(Texel([light, ..])) = texels.occlusion {
            inputs.substance.occlusion = (light.one_minus() * self.occlusion_strength).one_minus();
        }
        if let Some(Texel([_, rough, metal, _])) = texels.metallic_roughness {
            inputs.substance.roughness = inputs.substance.roughness * rough;
            inputs.substance.metallic = inputs.substance.metallic * metal;
        }
        if by_phong(shading) && self.model != ShadingModel::MetallicRoughness {
            inputs.diffuse = base;
            if let Some(texel) = &texels.specular {
                inputs.specular = Vec3Lane::splat(like, self.specular).times(texel.color());
            }
        }
        inputs
    }

    /// Sets Phong's inputs from metallic-roughness ones, unless the factors alone decide them.
    #[inline]
    fn phong_inputs(&self, surface: &Surface<'_>, base: Vec3, inputs: &mut Inputs<'_, f32>) {
        if self.textured || surface.color != Vec4::ONE {
            let s = &inputs.substance;
            let colors = from_metallic_roughness(base, s.metallic, s.roughness);
            inputs.diffuse = colors.diffuse.into();
            inputs.specular = colors.specular.into();
            inputs.shininess = colors.shininess;
        }
    }

    /// Returns whether samples of the material may be lit by [`super::TexturedPoints`]: nothing shines
    /// through, and the formula's parameter for all of them at once is one number.
    pub(crate) fn is_lit_together(&self, shading: Shading) -> bool {
        self.has_one_exponent(shading) && self.alpha_mode != AlphaMode::Blend
    }

    /// Returns whether the formula's parameter for eight points at once is one number.
    fn has_one_exponent(&self, shading: Shading) -> bool {
        match shading {
            Shading::MetallicRoughness | Shading::Unlit => true,
            Shading::Phong => self.model != ShadingModel::MetallicRoughness,
            Shading::Flat | Shading::Gouraud => false,
        }
    }

    /// Returns a point with its textures applied, to be lit with others; its geometric normal must
    /// be on the viewer's side, as for [`shade_seen`].
    pub(crate) fn textured_point(
        &self,
        surface: &Surface<'_>,
        shading: Shading,
    ) -> TexturedPoint<'_> {
        self.textured_point_with(surface, face_seen, self.base(surface), shading)
    }

    #[inline]
    fn textured_point_with(
        &self,
        surface: &Surface<'_>,
        frame: Framing,
        base: Vec4,
        shading: Shading,
    ) -> TexturedPoint<'_> {
        let (view, face) = (surface.view.into(), surface.geometric_normal.into());
        let mut frame = frame(view, face, surface.normal.into());
        if self.has_normal_map() {
            // The map bends the side that the mesh's normal is on; seen from behind, it is turned
            // with it.
            let bent = self.normal(surface);
            let kept = Vec3::from(frame.normal).dot(surface.normal) >= 0.0;
            frame.normal = if kept { bent } else { -bent }.into();
        }
        let base = base.truncate();
        let texel = |slot: &Option<Slot<'_>>| {
            slot.as_ref().map(|slot| Texel(slot.sample(surface).to_array()))
        };
        let texels = Texels {
            emissive: texel(&self.emissive_slot),
            occlusion: texel(&self.occlusion_slot),
            metallic_roughness: texel(&self.metallic_roughness_slot),
            specular: texel(&self.specular_slot),
        };
        let mut inputs = self.inputs(1.0, base.into(), &texels, shading);
        inputs.lobes = self.lobes.as_ref();
        if by_phong(shading) && self.model == ShadingModel::MetallicRoughness {
            self.phong_inputs(surface, base, &mut inputs);
        }
        TexturedPoint { frame, position: surface.position.into(), inputs }
    }

    /// Returns the interpolated normal, bent by the normal map.
    #[inline]
    fn normal(&self, surface: &Surface<'_>) -> Vec3 {
        let Some(slot) = &self.normal_slot else { return surface.normal };
        let at = slot.coordinates(surface);
        let texel = slot.texture.sample(at.uv, at.ddx, at.ddy).truncate() * 2.0 - Vec3::ONE;
        let map = Vec3::new(texel.x * self.normal_scale, texel.y * self.normal_scale, texel.z);
        perturbed(surface, at, map)
    }
}

/// Returns the metallic-roughness parameters of a material, whichever formula it was written for.
fn metallic_roughness_of(m: &Material) -> (f32, f32) {
    if m.model == ShadingModel::Phong {
        // The GGX lobe as wide as the Blinn–Phong lobe: α² = 2/(s + 2), roughness = √α.
        let exponent = if m.shininess > 0.0 { m.shininess } else { 0.0 };
        (0.0, (2.0 / (exponent + 2.0)).sqrt().sqrt())
    } else {
        (m.metallic, m.roughness)
    }
}

/// Returns Phong's parameters of a material, whichever formula it was written for.
fn phong_of(m: &Material) -> Colors {
    let base = m.base_color.truncate();
    if m.model == ShadingModel::MetallicRoughness {
        return from_metallic_roughness(base, m.metallic, m.roughness);
    }
    Colors { diffuse: base, specular: m.specular, shininess: Shininess::new(m.shininess) }
}
