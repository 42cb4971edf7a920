//! Phong shading: normals are interpolated, intensity is computed at each pixel.
//!
//! B. T. Phong, *Illumination for Computer Generated Pictures*, Communications of the ACM 18(6), 1975;
//! specular reflection in the halfway form of J. F. Blinn, *Models of Light Reflection for Computer
//! Synthesized Pictures*, SIGGRAPH 1977. Cost: O(lights) per pixel. Limits: not energy-preserving,
//! no shadows, no interreflection.
//!
//! Intensity = emission + k_d · (ambient + Σ colour · n·l) + k_s · Σ colour · (n·h)^shininess, sums
//! over the lights with n·l > 0. Deviation: h is never formed, as (n·h)² = (n·l + n·v)² / (2 + 2 l·v).

use super::lane::{Lane, Vec3Lane};
use super::light::PreparedLights;
use super::normal::Frame;
use super::reflected::Reflected;
use super::shadow;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::Vec3;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "phong",
    title: "Phong shading",
    authors: "Bui Tuong Phong; James F. Blinn",
    year: 1975,
    source: "Communications of the ACM 18(6); halfway vector: SIGGRAPH 1977",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Face],
    cost: "O(l) per pixel, l lights",
    limits: "empirical: reflects more light than it receives at grazing angles",
    pseudocode: &[
        "for each corner: N ← mean of the normals of its faces",
        "// normals are interpolated, not intensities",
        "for each row that the triangle covers:",
        "    along its two edges: N_a and N_b, linear in y",
        "    for each pixel between them:",
        "        N ← N_a + (N_b − N_a) · (x − x_a) / (x_b − x_a)",
        "        N ← N / |N|",
        "        I ← ambient + diffuse · max(0, N · L) + specular · max(0, R · V)^n",
        "        set the pixel to I",
    ],
};

/// An exponent of the specular term, ready to be applied to (n·h)².
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Shininess {
    /// The whole exponent for repeated squaring; 0 where `half` is used.
    whole: u32,
    /// Half the exponent, for the general power of (n·h)².
    half: f32,
}

/// Largest whole exponent that is applied by repeated squaring.
const LARGEST_WHOLE: f32 = 1024.0;

impl Shininess {
    /// Creates an exponent; below 0 and NaN count as 0.
    pub fn new(exponent: f32) -> Self {
        let exponent = if exponent > 0.0 { exponent.min(1e6) } else { 0.0 };
        let whole = exponent <= LARGEST_WHOLE && exponent.fract() == 0.0;
        Self { whole: if whole { exponent as u32 } else { 0 }, half: exponent * 0.5 }
    }

    /// Raises `cos2`, a squared cosine, to half the exponent, which is the cosine raised to the exponent.
    #[inline(always)]
    fn of_squared<L: Lane>(self, cos2: L) -> L {
        if self.whole == 0 {
            cos2.power_real(self.half)
        } else if self.whole.is_multiple_of(2) {
            cos2.power(self.whole / 2)
        } else {
            cos2.sqrt().power(self.whole)
        }
    }
}

/// Light from all sources, apart from the material's colours.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sums<L> {
    diffuse: Vec3Lane<L>,
    specular: Vec3Lane<L>,
}

impl<L: Lane> Sums<L> {
    /// Adds one light of unit direction `l`, colour and strength.
    #[inline(always)]
    fn add(&mut self, f: &Frame<L>, l: Vec3Lane<L>, color: Vec3, strength: L, s: Shininess) {
        let (nl, nv) = (f.normal.dot(l), f.normal.dot(f.view));
        let lit = nl.at_least(0.0) * strength;
        let sum = (nl + nv).at_least(0.0);
        // 2 + 2 l·v = |l + v|²; it vanishes only for light from straight behind.
        let h2 = (l.dot(f.view) * 2.0 + 2.0).at_least(1e-6);
        let cos2 = (sum * sum / h2).at_most(1.0);
        let shine = nl.if_above(0.0, s.of_squared(cos2) * strength, nl.splat(0.0));
        let color = Vec3Lane::splat(nl, color);
        self.diffuse = self.diffuse.plus(color.scale(lit));
        self.specular = self.specular.plus(color.scale(shine));
    }
}

/// Returns the diffuse (with ambient, times `occlusion`) and specular light that a point reflects.
#[inline(always)]
pub(super) fn reflect<L: Lane>(
    frame: &Frame<L>,
    position: Vec3Lane<L>,
    lights: &PreparedLights,
    shininess: Shininess,
    occlusion: L,
) -> (Vec3Lane<L>, Vec3Lane<L>) {
    let one = occlusion.splat(1.0);
    let mut sums = Sums {
        diffuse: lights.environment.diffuse(frame.normal).scale(occlusion),
        specular: Vec3Lane::splat(one, Vec3::ZERO),
    };
    // Two instances, because shadow look-ups cost time even if there are no shadows.
    if lights.shadows.is_empty() {
        add_lights::<L, false>(frame, position, lights, shininess, &mut sums);
    } else {
        add_lights::<L, true>(frame, position, lights, shininess, &mut sums);
    }
    (sums.diffuse, sums.specular)
}

/// Adds all lights; if `SHADOWED`, the part of them that shadows let through.
#[inline(always)]
fn add_lights<L: Lane, const SHADOWED: bool>(
    frame: &Frame<L>,
    position: Vec3Lane<L>,
    lights: &PreparedLights,
    shininess: Shininess,
    sums: &mut Sums<L>,
) {
    let maps = &lights.shadows;
    for (i, light) in lights.directional.iter().enumerate() {
        let l = Vec3Lane::splat(position.x, light.to_light);
        let mut strength = position.x.splat(1.0);
        if SHADOWED {
            strength = shadow::reach(maps.directional.get(i), position, frame.face, l);
        }
        sums.add(frame, l, light.color, strength, shininess);
    }
    for (i, light) in lights.points.iter().enumerate() {
        let (l, mut strength) = light.seen_from(position);
        if SHADOWED {
            strength = strength * shadow::reach(maps.points.get(i), position, frame.face, l);
        }
        sums.add(frame, l, light.color, strength, shininess);
    }
}

/// Returns the reflected light of one point.
#[inline]
pub(super) fn reflect_one(
    frame: &Frame<f32>,
    position: Vec3,
    lights: &PreparedLights,
    shininess: Shininess,
    occlusion: f32,
) -> Reflected {
    let (diffuse, specular) = reflect(frame, position.into(), lights, shininess, occlusion);
    Reflected { diffuse: diffuse.into(), specular: specular.into() }
}

/// The colours of Phong's formula.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Colors {
    pub diffuse: Vec3,
    pub specular: Vec3,
    pub shininess: Shininess,
}

/// Returns Phong's parameters for a material written for the metallic-roughness formula.
///
/// The exponent, 2/α² − 2, rounded, gives a Blinn–Phong lobe as wide as the GGX lobe; the specular colour makes the
/// highlight about equally bright. Metals keep part of their colour as diffuse, as this formula has no surroundings to
/// mirror.
pub(super) fn from_metallic_roughness(base: Vec3, metallic: f32, roughness: f32) -> Colors {
    let (metallic, roughness) = (metallic.clamp(0.0, 1.0), roughness.clamp(0.1, 1.0));
    let alpha2 = roughness * roughness * roughness * roughness;
    let f0 = Vec3::splat(0.04 * (1.0 - metallic)) + base * metallic;
    let shininess = Shininess::new((2.0 / alpha2 - 2.0).clamp(1.0, LARGEST_WHOLE).round());
    let peak = (1.0 / (4.0 * alpha2)).min(8.0);
    let specular = (f0 * peak).min(Vec3::splat(0.6) * (f0 / f0.max_element().max(1e-6)));
    Colors { diffuse: base * (1.0 - 0.4 * metallic), specular, shininess }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shade::environment::Environment;
    use crate::shade::light::DirectionalLight;
    use crate::shade::normal::face_viewer;

    fn lights(to_light: Vec3) -> PreparedLights {
        let light = DirectionalLight { to_light, color: Vec3::ONE };
        PreparedLights::far(Environment::uniform(Vec3::splat(0.125)), vec![light])
    }

    fn reflected(view: Vec3, to_light: Vec3, exponent: f32) -> Reflected {
        let frame = face_viewer(view.into(), Vec3::Z.into(), Vec3::Z.into());
        reflect_one(&frame, Vec3::ZERO, &lights(to_light), Shininess::new(exponent), 1.0)
    }

    #[test]
    fn diffuse_light_is_lamberts_cosine() {
        for angle in [0.0_f32, 0.3, 1.0, 1.5] {
            let l = Vec3::new(angle.sin(), 0.0, angle.cos());
            let light = reflected(Vec3::Z, l, 8.0).diffuse.x;
            assert!((light - 0.125 - angle.cos()).abs() < 1e-6, "{angle}");
        }
        assert_eq!(reflected(Vec3::Z, -Vec3::Z, 8.0).diffuse, Vec3::splat(0.125));
    }

    #[test]
    fn specular_light_is_the_halfway_cosines_power() {
        let (v, l) = (Vec3::new(0.3, 0.1, 0.9).normalize(), Vec3::new(-0.5, 0.2, 0.7).normalize());
        let nh = f64::from((v + l).normalize().z);
        for exponent in [1.0_f32, 2.0, 7.0, 32.0, 96.078, 225.0, 1024.0, 1500.5] {
            let expected = nh.powf(f64::from(exponent));
            let found = f64::from(reflected(v, l, exponent).specular.x);
            assert!((found - expected).abs() < 2e-5 * f64::from(exponent).sqrt(), "{exponent}");
        }
        assert_eq!(reflected(Vec3::Z, Vec3::Z, 1000.0).specular, Vec3::ONE);
        // No highlight on the side away from the light, even where n·h > 0.
        let low = Vec3::new(1.0, 0.0, -0.01).normalize();
        assert_eq!(reflected(Vec3::Z, low, 1.0).specular, Vec3::ZERO);
    }

    #[test]
    fn strange_exponents_are_held() {
        for exponent in [f32::NAN, -3.0, f32::INFINITY, 0.0] {
            let r = reflected(Vec3::new(0.1, 0.0, 1.0), Vec3::Z, exponent);
            assert!(r.specular.is_finite() && r.specular.x <= 1.0 + 1e-5, "{exponent}");
        }
    }
}
