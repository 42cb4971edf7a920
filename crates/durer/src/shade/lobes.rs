//! The additions of glTF's extensions to the metallic-roughness formula: another refractive index, a tinted
//! or weak reflection, a clear coat, sheen, and glass.
//!
//! Khronos, *KHR_materials_ior*, *_specular*, *_clearcoat*, *_sheen*, *_transmission*, 2020–2021. Sheen: A. Estevez and
//! C. Kulla, *Production Friendly Microfacet Sheen BRDF*, SIGGRAPH 2017 (the "Charlie" distribution) with the
//! visibility of D. Neubelt and M. Pettineo, *Crafting a Next-Gen Material Pipeline for The Order: 1886*, 2013; its
//! albedo, which darkens the layer below, by the fit of three.js (2021). Deviations: a coat has the normal of the layer
//! below.

#[cfg(test)]
mod tests;

use super::lane::{Lane, Vec3Lane};
use super::light::PreparedLights;
use super::metallic_roughness::{self, Dielectric, Substance, under_lights};
use super::normal::Frame;
use crate::math::Vec3;
use crate::scene::{AlphaMode, Material, ShadingModel};

/// Properties of a material beyond base colour, metalness and roughness; the same at all of its
/// points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lobes {
    dielectric: Dielectric,
    coat: Option<Coat>,
    sheen: Option<Sheen>,
    /// The part of light that an unblended material transmits.
    through: f32,
    /// True if a blended material shows its reflections in full, as glass does.
    glass: bool,
}

/// A clear layer over the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Coat {
    strength: f32,
    roughness: f32,
}

/// Fibres over the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sheen {
    color: Vec3,
    /// One over the distribution's α.
    sharpness: f32,
    /// The fit of the albedo: e^(slope · n·v + offset) + more, over π.
    slope: f32,
    offset: f32,
    more: f32,
}

/// Returns a number from a file, clamped to 0 … `most`; `default` for NaN.
fn held(value: f32, most: f32, default: f32) -> f32 {
    if value.is_nan() { default } else { value.clamp(0.0, most) }
}

fn held_color(color: Vec3, default: f32) -> Vec3 {
    Vec3::from_array(color.to_array().map(|channel| held(channel, 1e6, default)))
}

impl Lobes {
    /// Returns the lobes of a material, or `None` if the plain formula covers it.
    pub fn of(m: &Material) -> Option<Self> {
        let sheen_color = held_color(m.sheen_color, 0.0);
        let coat = held(m.clearcoat, 1.0, 0.0);
        let transmission = held(m.transmission, 1.0, 0.0);
        let blends = m.alpha_mode == AlphaMode::Blend;
        let through = if blends { 0.0 } else { transmission };
        let lobes = Self {
            dielectric: Dielectric { matte: 1.0 - through, ..dielectric(m) },
            coat: (coat > 0.0).then(|| {
                let roughness = held(m.clearcoat_roughness, 1.0, 0.0);
                Coat { strength: coat, roughness }
            }),
            sheen: (sheen_color != Vec3::ZERO).then(|| Sheen::new(sheen_color, m.sheen_roughness)),
            through,
            glass: blends && transmission > 0.0,
        };
        let Self { coat, sheen, .. } = lobes;
        let plain = lobes.dielectric == Dielectric::PLAIN && !lobes.glass;
        let plain = plain && coat.is_none() && sheen.is_none();
        (m.model == ShadingModel::MetallicRoughness && !plain).then_some(lobes)
    }

    /// Returns whether blended surfaces show reflections, however clear they are.
    pub fn is_glass(&self) -> bool {
        self.glass
    }

    /// Returns the light that leaves a point towards the eye, including emission.
    #[inline(always)]
    pub fn reflect<L: Lane>(
        &self,
        frame: &Frame<L>,
        position: Vec3Lane<L>,
        light: (&Substance<L>, Vec3Lane<L>),
        lights: &PreparedLights,
    ) -> Vec3Lane<L> {
        position.x.apart(
            #[inline(always)]
            || self.all(frame, position, light, lights),
        )
    }

    #[inline(always)]
    fn all<L: Lane>(
        &self,
        frame: &Frame<L>,
        position: Vec3Lane<L>,
        (substance, emission): (&Substance<L>, Vec3Lane<L>),
        lights: &PreparedLights,
    ) -> Vec3Lane<L> {
        let mut sum = reflect_apart(frame, position, substance, self.dielectric, lights);
        if self.through > 0.0 {
            sum = sum.plus(self.seen_through(frame, substance, lights));
        }
        if let Some(sheen) = &self.sheen {
            sum = sheen.over(sum, frame, position, substance.occlusion, lights);
        }
        sum = sum.plus(emission);
        match self.coat {
            Some(coat) => coat.over(sum, frame, position, substance.occlusion, lights),
            None => sum,
        }
    }

    /// Returns the reflections alone, without the light that the surface scatters or emits itself.
    #[inline(always)]
    pub fn shine<L: Lane>(
        &self,
        frame: &Frame<L>,
        position: Vec3Lane<L>,
        substance: &Substance<L>,
        lights: &PreparedLights,
    ) -> Vec3Lane<L> {
        let dark = Vec3Lane::splat(position.x, Vec3::ZERO);
        let dielectric = Dielectric { matte: 0.0, ..self.dielectric };
        Self { dielectric, sheen: None, ..*self }.reflect(
            frame,
            position,
            (substance, dark),
            lights,
        )
    }

    /// Returns the surroundings straight behind the surface, tinted, where nothing behind it is
    /// drawn.
    #[inline(always)]
    fn seen_through<L: Lane>(
        &self,
        frame: &Frame<L>,
        substance: &Substance<L>,
        lights: &PreparedLights,
    ) -> Vec3Lane<L> {
        let alpha = substance.roughness * substance.roughness;
        let lamps = Some(alpha.splat(1.0));
        let behind = lights.environment.reflection(frame.view.reversed(), alpha, lamps);
        let metallic = substance.metallic.at_least(0.0).at_most(1.0);
        behind.times(substance.base).scale(metallic.one_minus() * self.through)
    }
}

/// Returns the plain formula, once for all that call it.
#[inline(always)]
fn reflect_apart<L: Lane>(
    frame: &Frame<L>,
    position: Vec3Lane<L>,
    substance: &Substance<L>,
    dielectric: Dielectric,
    lights: &PreparedLights,
) -> Vec3Lane<L> {
    position.x.apart(
        #[inline(always)]
        || metallic_roughness::reflect(frame, position, substance, dielectric, lights),
    )
}

/// Returns the reflectance by KHR_materials_ior and KHR_materials_specular. An index of 0 reflects all, as for
/// materials that were converted from specular-glossiness.
fn dielectric(m: &Material) -> Dielectric {
    let index = held(m.ior, 1e6, 1.5);
    let root = (index.max(1.0) - 1.0) / (index.max(1.0) + 1.0);
    // The quotient of 1.5 is not 0.2 to the last bit.
    let plain = index == 1.5;
    let straight = if plain { Dielectric::PLAIN.most } else { root * root };
    let straight = if index == 0.0 { 1.0 } else { straight };
    let grazing = held(m.specular_strength, 1.0, 1.0);
    let straight = (held_color(m.specular_tint, 1.0) * straight).min(Vec3::ONE) * grazing;
    Dielectric { straight, most: straight.max_element(), grazing, matte: 1.0 }
}

impl Coat {
    /// Returns the light of the surface seen through a coat, plus the coat's own.
    #[inline(always)]
    fn over<L: Lane>(
        self,
        under: Vec3Lane<L>,
        frame: &Frame<L>,
        position: Vec3Lane<L>,
        occlusion: L,
        lights: &PreparedLights,
    ) -> Vec3Lane<L> {
        let like = position.x;
        let substance = Substance {
            base: Vec3Lane::splat(like, Vec3::ZERO),
            metallic: like.splat(0.0),
            roughness: like.splat(self.roughness),
            occlusion,
            mirrors: true,
        };
        let clear = Dielectric { matte: 0.0, ..Dielectric::PLAIN };
        let shine = reflect_apart(frame, position, &substance, clear, lights);
        let nv = frame.normal.dot(frame.view).at_least(0.0).at_most(1.0);
        let reflected = nv.one_minus().power(5) * (1.0 - clear.most) + clear.most;
        let let_in = (reflected * self.strength).one_minus();
        under.scale(let_in).plus(shine.scale(like.splat(self.strength)))
    }
}

impl Sheen {
    fn new(color: Vec3, roughness: f32) -> Self {
        let roughness = held(roughness, 1.0, 0.0);
        let square = roughness * roughness;
        let (slope, offset, more) = if roughness < 0.25 {
            let slope = -339.2 * square + 161.4 * roughness - 25.9;
            (slope, 44.0 * square - 23.7 * roughness + 3.26, 0.0)
        } else {
            let slope = -8.48 * square + 14.3 * roughness - 9.95;
            (slope, 1.97 * square - 3.27 * roughness + 0.72, 0.1 * (roughness - 0.25))
        };
        // Smoother than this is thinner than any highlight.
        let sharpness = 1.0 / square.max(0.005);
        Self { color: color.min(Vec3::ONE), sharpness, slope, offset, more }
    }

    /// Returns the part of light from all around that the fibres send towards the eye.
    #[inline(always)]
    fn albedo<L: Lane>(&self, nv: L) -> L {
        let exponent = (nv * self.slope + self.offset) * std::f32::consts::LOG2_E;
        ((exponent.exp2() + self.more) * std::f32::consts::FRAC_1_PI).at_most(1.0)
    }

    /// Lays the reflection of fibres over the light that leaves the surface.
    #[inline(always)]
    fn over<L: Lane>(
        &self,
        under: Vec3Lane<L>,
        frame: &Frame<L>,
        position: Vec3Lane<L>,
        occlusion: L,
        lights: &PreparedLights,
    ) -> Vec3Lane<L> {
        let nv = frame.normal.dot(frame.view).at_least(1e-3).at_most(1.0);
        let albedo = self.albedo(nv);
        let left = (albedo * self.color.max_element()).one_minus();
        let around = lights.environment.diffuse(frame.normal).scale(occlusion * albedo);
        let sheen = under_lights(
            frame,
            position,
            lights,
            around,
            #[inline(always)]
            |l| {
                let strength = self.towards_eye(frame, nv, l);
                Vec3Lane::new(strength, strength, strength)
            },
        );
        under.scale(left).plus(sheen.times_all(self.color))
    }

    /// Returns the part of one light that the fibres send towards the eye; π is contained in the
    /// light's unit.
    #[inline(always)]
    fn towards_eye<L: Lane>(&self, frame: &Frame<L>, nv: L, l: Vec3Lane<L>) -> L {
        let nl = frame.normal.dot(l).at_least(0.0).at_most(1.0);
        let h = l.plus(frame.view).unit_or(frame.normal);
        let across = frame.normal.cross(h);
        let sine2 = across.dot(across).at_least(1.0 / 128.0).at_most(1.0);
        let half = self.sharpness * 0.5;
        let distribution = sine2.power_real(half) * (half + 1.0);
        let visibility = nl.splat(0.25) / (nl + nv - nl * nv).at_least(1e-6);
        distribution * visibility * nl
    }
}

/// Returns the look of glass over a background: the colour, and the alpha by which its scattered light
/// covers with `alpha` and its reflections, `shine`, in full.
pub(super) fn glass(whole: Vec3, shine: Vec3, alpha: f32) -> (Vec3, f32) {
    let shine = shine.max(Vec3::ZERO);
    let premultiplied = whole * alpha + shine * (1.0 - alpha);
    let covered = alpha + (1.0 - alpha) * shine.max_element().min(1.0);
    (premultiplied / covered.max(1e-6), covered)
}
