//! glTF's metallic-roughness formula: a matte dielectric under a clear rough surface, or a metal.
//!
//! Khronos, *glTF 2.0*, appendix B, 2017: Lambert's diffuse reflection; microfacets after Trowbridge and Reitz,
//! *Average Irregularity Representation of a Rough Surface*, JOSA 65(5), 1975 (the "GGX" of Walter et al. 2007);
//! Smith's height-correlated masking after Heitz, *Understanding the Masking-Shadowing Function*, JCGT 3(2), 2014;
//! Fresnel reflection after Schlick, *An Inexpensive BRDF Model for Physically-based Rendering*, 1994. Reflections of
//! the surroundings ([`super::environment`]) are weighted by the closed form of Karis, *Physically Based Shading on
//! Mobile*, 2014. Light reflected more than once between microfacets is restored by scaling, as in Turquin, *Practical
//! Multiple Scattering Compensation for Microfacet Models*, 2019. Cost: O(lights) per pixel. Limits: no shadows.

use super::lane::{Lane, Vec3Lane};
use super::light::PreparedLights;
use super::normal::{Frame, face_viewer};
use super::shadow;
use crate::info::{Class, Info, Occluder};
use crate::math::Vec3;
use crate::trace::{NoTrace, Recorder, Tracer};

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
    direct: Layers<L>,
}

/// Specular reflection of the metal and the dielectric part together: reflectance straight on and at
/// grazing angles, each times its part of the surface and the gain from multiple scattering.
struct Layers<L> {
    straight: Vec3Lane<L>,
    grazing: Vec3Lane<L>,
    /// The gain of the dielectric alone.
    dielectric_gain: L,
}

impl<L: Lane> Layers<L> {
    /// Creates the layers; `lack` is the light that a white mirror of this roughness loses by single scattering,
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

/// A point of a surface and a light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lit {
    /// Base colour, linear, 0 … 1.
    pub base: Vec3,
    /// Metalness, 0 … 1.
    pub metallic: f32,
    /// Perceptual roughness, 0 … 1.
    pub roughness: f32,
    /// Unit normal; it is turned to the side of the eye.
    pub normal: Vec3,
    /// Unit vector to the eye.
    pub to_eye: Vec3,
    /// Unit vector to the light.
    pub to_light: Vec3,
}

/// Step of reflecting a light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The cosines n·l, n·v, n·h and v·h.
    Cosines([f32; 4]),
    /// The distribution of facets.
    Distribution {
        /// The square of the roughness, which is at least 0.06.
        alpha: f32,
        /// D, times π.
        value: f32,
    },
    /// The visibility of facets from the light and from the eye, over 4 n·l n·v.
    Visibility(f32),
    /// Fresnel reflection.
    Fresnel {
        /// Reflectance straight on, with the light that is reflected more than once.
        straight: Vec3,
        /// Reflectance at grazing angles, likewise.
        grazing: Vec3,
        /// (1 − v·h)⁵, the part of the latter.
        away: f32,
        /// F.
        value: Vec3,
    },
    /// Diffuse reflection.
    Diffuse {
        /// Part of the light that enters the dielectric.
        through: f32,
        /// The diffuse reflectance, times π.
        value: Vec3,
    },
    /// Everything that leaves towards the eye.
    Sum(Vec3),
}

impl Step {
    /// Returns the line of [`INFO`]'s pseudocode that runs, counted from 1.
    pub fn line(&self) -> usize {
        match self {
            Self::Cosines(_) => 1,
            Self::Distribution { .. } => 2,
            Self::Visibility(_) => 3,
            Self::Fresnel { .. } => 6,
            Self::Diffuse { .. } => 7,
            Self::Sum(_) => 8,
        }
    }
}

/// Returns the light that the steps before the sum lead to.
pub fn replay(steps: &[Step]) -> Vec3 {
    let [mut n_l, mut mirrored] = [0.0; 2];
    let [mut fresnel, mut diffuse] = [Vec3::ZERO; 2];
    for step in steps {
        match *step {
            Step::Cosines([first, ..]) => n_l = first,
            Step::Distribution { value, .. } => mirrored = value,
            Step::Visibility(value) => mirrored *= value,
            Step::Fresnel { value, .. } => fresnel = value,
            Step::Diffuse { value, .. } => diffuse = value,
            Step::Sum(_) => {}
        }
    }
    (diffuse + fresnel * mirrored) * n_l
}

/// Returns the part of a light that a dielectric of refractive index 1.5, or a metal, reflects towards the eye, by the
/// formula with which surfaces are lit: for the colour 1, in the light's unit, which contains π.
///
/// ```
/// use durer::math::Vec3;
/// use durer::shade::metallic_roughness::{Lit, reflect_one};
/// use durer::trace::NoTrace;
///
/// let straight_on = Lit {
///     base: Vec3::splat(0.5),
///     metallic: 0.0,
///     roughness: 1.0,
///     normal: Vec3::Z,
///     to_eye: Vec3::Z,
///     to_light: Vec3::Z,
/// };
/// // 0.96 of the base colour, and a hundredth from rough reflection.
/// assert!((reflect_one(&straight_on, &mut NoTrace).x - 0.49).abs() < 0.002);
/// ```
pub fn reflect_one(lit: &Lit, t: &mut impl Tracer<Step>) -> Vec3 {
    let frame = face_viewer(lit.to_eye.into(), lit.normal.into(), lit.normal.into());
    let substance = Substance {
        base: lit.base.into(),
        metallic: lit.metallic,
        roughness: lit.roughness,
        occlusion: 1.0,
        mirrors: false,
    };
    let (point, _) = point(&frame, &substance, Dielectric::PLAIN);
    let mut terms = Recorder::with_cap(1);
    let sum = self::lit(&frame, &point, lit.to_light.into(), &mut terms);
    let plain = |v: Vec3Lane<f32>| Vec3::new(v.x, v.y, v.z);
    if let Some(terms) = terms.into_steps().pop() {
        t.step(|| Step::Cosines(terms.cosines));
        t.step(|| Step::Distribution { alpha: point.alpha, value: terms.distribution });
        t.step(|| Step::Visibility(terms.visibility));
        t.step(|| Step::Fresnel {
            straight: plain(point.direct.straight),
            grazing: plain(point.direct.grazing),
            away: terms.away,
            value: plain(terms.fresnel),
        });
        t.step(|| Step::Diffuse { through: terms.through, value: plain(terms.diffuse) });
    }
    t.step(|| Step::Sum(plain(sum)));
    plain(sum)
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
    let direct = Layers::new(substance.base, metallic, &dielectric, lack(alpha, nv));
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
    let layers = Layers::new(substance.base, metallic, &p.dielectric, lack);
    let specular = layers.straight.scale(slope).plus(layers.grazing.scale(offset));
    let reflected = slope * p.dielectric.most + offset * p.dielectric.grazing;
    let through = (reflected * layers.dielectric_gain).one_minus();
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::DVec3;
    use crate::shade::environment::Environment;
    use crate::shade::light::DirectionalLight;
    use crate::shade::normal::face_viewer;

    fn lights(environment: Environment, directional: Vec<DirectionalLight>) -> PreparedLights {
        PreparedLights {
            origin: DVec3::ZERO,
            environment,
            directional,
            points: Vec::new(),
            shadows: Default::default(),
            tone: Default::default(),
        }
    }

    fn leaving(
        view: Vec3,
        base: f32,
        metallic: f32,
        roughness: f32,
        lights: &PreparedLights,
    ) -> f32 {
        let frame = face_viewer(view.into(), Vec3::Z.into(), Vec3::Z.into());
        let base = Vec3Lane::from(Vec3::splat(base));
        let mirrors = metallic > 0.0;
        let substance = Substance { base, metallic, roughness, occlusion: 1.0, mirrors };
        reflect(&frame, Vec3::ZERO.into(), &substance, Dielectric::PLAIN, lights).x
    }

    fn direction(cosine: f32, turn: f32) -> Vec3 {
        let sine = (1.0 - cosine * cosine).sqrt();
        Vec3::new(sine * turn.cos(), sine * turn.sin(), cosine)
    }

    #[test]
    fn white_things_vanish_in_white_surroundings() {
        let furnace = lights(Environment::uniform(Vec3::ONE), Vec::new());
        for (m, r, c) in (0..=10).flat_map(|m| {
            (0..=10).flat_map(move |r| (1..=10).map(move |c| (m as f32, r as f32, c as f32)))
        }) {
            let view = direction(c / 10.0, 0.3);
            let light = leaving(view, 1.0, m / 10.0, r / 10.0, &furnace);
            assert!((light - 1.0).abs() < 0.01, "{m} {r} {c}: {light}");
        }
    }

    /// Returns the whole hemisphere of directional lights, each with its share of a uniform
    /// surrounding.
    fn hemisphere() -> PreparedLights {
        let mut directional = Vec::new();
        let (rings, sectors) = (96, 192);
        for ring in 0..rings {
            // Rings of equal solid angle; radiance 1 over π in the light's unit.
            let cosine = (ring as f32 + 0.5) / rings as f32;
            for sector in 0..sectors {
                let turn = (sector as f32 + 0.5) / sectors as f32 * std::f32::consts::TAU;
                let color = Vec3::splat(2.0 / (rings * sectors) as f32);
                directional.push(DirectionalLight { to_light: direction(cosine, turn), color });
            }
        }
        lights(Environment::uniform(Vec3::ZERO), directional)
    }

    #[test]
    fn lights_from_everywhere_make_white_metal_white() {
        let furnace = hemisphere();
        for roughness in [0.35, 0.5, 0.7, 0.85, 1.0] {
            for cosine in [0.4, 0.7, 0.95] {
                let light = leaving(direction(cosine, 0.1), 1.0, 1.0, roughness, &furnace);
                assert!((light - 1.0).abs() < 0.12, "{roughness} {cosine}: {light}");
                let matte = leaving(direction(cosine, 0.1), 1.0, 0.0, roughness, &furnace);
                assert!((matte - 1.0).abs() < 0.12, "matte {roughness} {cosine}: {matte}");
            }
        }
    }

    #[test]
    fn direct_and_ambient_reflection_agree() {
        // The closed form, compared with the formula that it approximates, summed over the hemisphere.
        let (sum, closed) = (hemisphere(), lights(Environment::uniform(Vec3::ONE), Vec::new()));
        for roughness in [0.4, 0.6, 0.8, 1.0] {
            for (base, metallic) in [(0.5, 1.0), (0.9, 1.0), (0.0, 0.0), (0.5, 0.0)] {
                let view = direction(0.8, 0.0);
                let a = leaving(view, base, metallic, roughness, &sum);
                let b = leaving(view, base, metallic, roughness, &closed);
                assert!((a - b).abs() < 0.06, "{roughness} {base} {metallic}: {a} {b}");
            }
        }
    }

    #[test]
    fn rough_dielectrics_tend_to_lambert() {
        let key = DirectionalLight { to_light: direction(0.6, 1.0), color: Vec3::ONE };
        let one = lights(Environment::uniform(Vec3::ZERO), vec![key]);
        let light = leaving(Vec3::Z, 0.5, 0.0, 1.0, &one);
        // 0.5 · 0.6 · 0.96, and a specular part of at most 4 %.
        assert!((light - 0.288).abs() < 0.04, "{light}");
        let dark = leaving(Vec3::Z, 0.0, 0.0, 1.0, &one);
        assert!(dark > 0.0 && dark < 0.04, "{dark}");
    }
}
