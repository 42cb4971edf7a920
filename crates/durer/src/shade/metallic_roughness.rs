//! glTF's metallic-roughness formula: a matte dielectric under a clear rough surface, or a metal.
//!
//! Khronos, *glTF 2.0*, appendix B, 2017: Lambert's diffuse reflection; microfacets after Trowbridge and Reitz,
//! *Average Irregularity Representation of a Rough Surface*, JOSA 65(5), 1975 (the "GGX" of Walter et al. 2007);
//! Smith's height-correlated masking after Heitz, *Understanding the Masking-Shadowing Function*, JCGT 3(2), 2014;
//! Fresnel reflection after Schlick, *An Inexpensive BRDF Model for Physically-based Rendering*, 1994. Reflections of
//! the surroundings ([`Surroundings`](super::Surroundings)) are weighted by the closed form of Karis, *Physically Based Shading on
//! Mobile*, 2014. Light reflected more than once between microfacets is restored by scaling, as in Turquin, *Practical
//! Multiple Scattering Compensation for Microfacet Models*, 2019. Cost: O(lights) per pixel. Limits: no shadows.

mod steps;
#[cfg(test)]
mod tests;

pub use steps::{Lit, Step, reflect_one, replay};

use super::lane::{Lane, Vec3Lane};
use super::light::PreparedLights;
use super::normal::Frame;
use super::shadow;
use crate::info::{Class, Info, Occluder};
use crate::math::Vec3;
use crate::trace::{NoTrace, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "metallic-roughness",
    title: "Metallic-roughness",
    authors: "Khronos Group; T. S. Trowbridge and K. P. Reitz; Christophe Schlick; Brian Karis",
    year: 2017,
    source: "glTF 2.0 specification, appendix B",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(l) per pixel, l lights",
    limits: "the environment is a closed form, not an image; no shadows",
    pseudocode: &[
        "h ← (l + v) / |l + v|; the cosines n·l, n·v, n·h, v·h, at least 0",
        "α ← roughness²; D ← α² / ((n·h)² (α² − 1) + 1)²",
        "V ← ½ / (n·l √((n·v)² (1 − α²) + α²) + n·v √((n·l)² (1 − α²) + α²))",
        "F0 ← the base colour for metals, 0.04 for dielectrics; F90 ← 1",
        "both times 1 + g·F0: g makes up for light that is reflected more than once",
        "F ← F0 + (F90 − F0) (1 − v·h)⁵",
        "diffuse ← (1 − metallic) · base · (1 − F of the dielectric)",
        "the light times n·l · (diffuse + D V F)",
        "// π is contained in the unit of the light: D and diffuse are without it",
    ],
};

/// Smoother surfaces than this would lose the highlight's shape in single precision.
const LEAST_ROUGHNESS: f32 = 0.06;

/// Reflection and scattering of a surface's dielectric part, the same at all points of a material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Dielectric {
    /// Reflectance seen straight on, by colour.
    pub straight: Vec3,
    /// The largest of them.
    pub most: f32,
    /// Reflectance at grazing angles.
    pub grazing: f32,
    /// The part of light that is let in and comes back diffusely.
    pub matte: f32,
}

impl Dielectric {
    /// Dielectric of refractive index 1.5, like most plastics and glasses.
    pub const PLAIN: Self =
        Self { straight: Vec3::splat(0.04), most: 0.04, grazing: 1.0, matte: 1.0 };
}

/// A surface point's parameters, in lanes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Substance<L> {
    pub base: Vec3Lane<L>,
    /// Metalness, 0 … 1.
    pub metallic: L,
    /// Perceptual roughness, 0 … 1.
    pub roughness: L,
    /// Part of the ambient light that arrives.
    pub occlusion: L,
    /// True if the material mirrors the surroundings clearly: metals, smooth surfaces, clear layers.
    pub mirrors: bool,
}

/// Factor by which screens are brighter in reflections from dielectrics than from metals: dielectrics reflect only four
/// hundredths of them, and metals would burn out with brighter ones.
const BRIGHTER: f32 = 1.5;

/// Terms that all lights share at one point.
struct Point<L> {
    nv: L,
    alpha: L,
    alpha2: L,
    /// Diffuse colour of the dielectric part.
    diffuse: Vec3Lane<L>,
    dielectric: Dielectric,
    direct: Specular<L>,
}

/// Specular reflection of the metal and the dielectric part together: reflectance straight on and at
/// grazing angles, each times its part of the surface and the gain from multiple scattering.
struct Specular<L> {
    straight: Vec3Lane<L>,
    grazing: Vec3Lane<L>,
    /// The gain of the dielectric alone.
    dielectric_gain: L,
}

impl<L: Lane> Specular<L> {
    /// Creates the reflection; `lack` is the light that a white mirror of this roughness loses by single scattering,
    /// divided by the light it reflects.
    #[inline(always)]
    fn new(base: Vec3Lane<L>, metallic: L, dielectric: &Dielectric, lack: L) -> Self {
        let dielectric_gain = lack * dielectric.most + 1.0;
        let part = metallic.one_minus() * dielectric_gain;
        let gain = |f0: L| (f0 * lack + 1.0) * metallic;
        let metal = Vec3Lane::new(gain(base.x), gain(base.y), gain(base.z));
        let (straight, grazing) = (dielectric.straight, part * dielectric.grazing);
        let straight = Vec3Lane::new(part * straight.x, part * straight.y, part * straight.z);
        Self {
            straight: base.times(metal).plus(straight),
            grazing: metal.plus(Vec3Lane::new(grazing, grazing, grazing)),
            dielectric_gain,
        }
    }
}

/// Returns the terms that all lights share, with metalness and roughness as they count.
#[inline(always)]
fn point<L: Lane>(
    frame: &Frame<L>,
    substance: &Substance<L>,
    dielectric: Dielectric,
) -> (Point<L>, (L, L)) {
    let roughness = substance.roughness.at_least(LEAST_ROUGHNESS).at_most(1.0);
    let metallic = substance.metallic.at_least(0.0).at_most(1.0);
    let nv = frame.normal.dot(frame.view).at_least(1e-3).at_most(1.0);
    let alpha = roughness * roughness;
    let direct = Specular::new(substance.base, metallic, &dielectric, lack(alpha, nv));
    let diffuse = substance.base.scale(metallic.one_minus() * dielectric.matte);
    let point = Point { nv, alpha, alpha2: alpha * alpha, diffuse, dielectric, direct };
    (point, (metallic, roughness))
}

/// Returns the light that leaves a point towards the eye, without emission.
#[inline(always)]
pub(super) fn reflect<L: Lane>(
    frame: &Frame<L>,
    position: Vec3Lane<L>,
    substance: &Substance<L>,
    dielectric: Dielectric,
    lights: &PreparedLights,
) -> Vec3Lane<L> {
    let (point, used) = point(frame, substance, dielectric);
    let around = surroundings(frame, &point, substance, used, lights);
    let around = around.scale(substance.occlusion);
    // Code that is not inlined would lose the SIMD level.
    under_lights(
        frame,
        position,
        lights,
        around,
        #[inline(always)]
        |l| lit(frame, &point, l, &mut NoTrace),
    )
}

/// Adds the light that each light source sends towards the eye to `sum`; `lit` returns the part of a light's colour by
/// the unit vector to the light.
#[inline(always)]
pub(super) fn under_lights<L: Lane>(
    frame: &Frame<L>,
    position: Vec3Lane<L>,
    lights: &PreparedLights,
    mut sum: Vec3Lane<L>,
    lit: impl Fn(Vec3Lane<L>) -> Vec3Lane<L>,
) -> Vec3Lane<L> {
    for (i, light) in lights.directional.iter().enumerate() {
        let l = Vec3Lane::splat(position.x, light.to_light);
        let reach = shadow::reach(lights.shadows.directional.get(i), position, frame.face, l);
        sum = sum.plus(lit(l).scale(reach).times_all(light.color));
    }
    for (i, light) in lights.points.iter().enumerate() {
        let (l, strength) = light.seen_from(position);
        let reach = shadow::reach(lights.shadows.points.get(i), position, frame.face, l);
        sum = sum.plus(lit(l).scale(strength * reach).times_all(light.color));
    }
    sum
}

/// Returns the reflected ambient light: diffuse from all around, specular from the direction of the mirror image.
#[inline(always)]
fn surroundings<L: Lane>(
    frame: &Frame<L>,
    p: &Point<L>,
    substance: &Substance<L>,
    (metallic, roughness): (L, L),
    lights: &PreparedLights,
) -> Vec3Lane<L> {
    let n = frame.normal;
    let mirrored = n.scale(n.dot(frame.view) * 2.0).minus(frame.view);
    let (slope, offset) = environment_brdf(roughness, p.nv);
    let lack = p.nv.splat(1.0) / (slope + offset).at_least(0.05) - 1.0;
    let parts = Specular::new(substance.base, metallic, &p.dielectric, lack);
    let specular = parts.straight.scale(slope).plus(parts.grazing.scale(offset));
    let reflected = slope * p.dielectric.most + offset * p.dielectric.grazing;
    let through = (reflected * parts.dielectric_gain).one_minus();
    let environment = &lights.environment;
    let around = environment.diffuse(n).times(p.diffuse).scale(through);
    let lamps = substance.mirrors.then(|| metallic.one_minus() * BRIGHTER + 1.0);
    around.plus(environment.reflection(mirrored, p.alpha, lamps).times(specular))
}

/// Terms of the formula for one light, in lanes.
struct Terms<L> {
    cosines: [L; 4],
    distribution: L,
    visibility: L,
    away: L,
    fresnel: Vec3Lane<L>,
    through: L,
    diffuse: Vec3Lane<L>,
}

/// Returns the part of one light's colour that leaves towards the eye; π is contained in the
/// light's unit.
#[inline(always)]
fn lit<L: Lane>(
    frame: &Frame<L>,
    p: &Point<L>,
    l: Vec3Lane<L>,
    t: &mut impl Tracer<Terms<L>>,
) -> Vec3Lane<L> {
    let half = p.nv.splat(0.5);
    let nl = frame.normal.dot(l).at_least(0.0).at_most(1.0);
    let h = l.plus(frame.view).unit_or(frame.normal);
    let nh = frame.normal.dot(h).at_least(0.0);
    let vh = frame.view.dot(h).at_least(0.0).at_most(1.0);

    // Trowbridge–Reitz times π. 1 − (n·h)² as |n × h|², which keeps its digits in single precision.
    let across = frame.normal.cross(h);
    let spread = nh * nh * p.alpha2 + across.dot(across);
    let distribution = p.alpha2 / (spread * spread).at_least(1e-20);

    // Smith's masking, height-correlated, with the 4 n·l n·v of the microfacet formula in it.
    let rest = p.alpha2.one_minus();
    let to_eye = nl * (p.nv * p.nv * rest + p.alpha2).sqrt();
    let to_light = p.nv * (nl * nl * rest + p.alpha2).sqrt();
    let visibility = half / (to_eye + to_light).at_least(1e-6);

    // Schlick's Fresnel reflection; the light that enters the dielectric is reflected diffusely.
    let away = vh.one_minus().power(5);
    let keep = away.one_minus();
    let fresnel = p.direct.straight.scale(keep).plus(p.direct.grazing.scale(away));
    let through = (keep * p.dielectric.most + away * p.dielectric.grazing).one_minus();
    let specular = fresnel.scale(distribution * visibility);
    let diffuse = p.diffuse.scale(through);
    t.step(|| {
        let cosines = [nl, p.nv, nh, vh];
        Terms { cosines, distribution, visibility, away, fresnel, through, diffuse }
    });
    diffuse.plus(specular).scale(nl)
}

/// Returns the light that a white rough mirror loses by single scattering, over its reflection: 1/E
/// − 1, where E is the formula of [`lit`] integrated over the hemisphere. A least-squares fit to
/// that integral on 20 × 20 roughnesses and cosines: mean error 0.015, largest 0.11 at grazing
/// angles.
#[inline(always)]
fn lack<L: Lane>(alpha: L, nv: L) -> L {
    let first = (nv * -1.9565 + 1.0881) * nv + 0.4286;
    let second = (nv * 1.5642 + 1.4984) * nv - 0.4053;
    ((second * alpha + first) * alpha).at_least(0.0)
}

/// Returns the scale of f0 and the offset that make up the reflected part of uniform light (Karis 2014).
#[inline(always)]
fn environment_brdf<L: Lane>(roughness: L, nv: L) -> (L, L) {
    let x = roughness.one_minus();
    let y = roughness * -0.0275 + 0.0425;
    let z = roughness * -0.572 + 1.04;
    let w = roughness * 0.022 - 0.04;
    let (square, grazing) = (x * x, (nv * -9.28).exp2());
    let least = (square - grazing).if_above(0.0, grazing, square);
    let a = least * x + y;
    (a * -1.04 + z, (a * 1.04 + w).at_least(0.0))
}
