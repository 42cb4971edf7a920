//! `KHR_materials_pbrSpecularGlossiness` as a metallic-roughness material.
//!
//! Source: the conversion that Khronos publishes with the extension. It solves for the metalness at which both
//! models reflect as brightly, so that a coloured mirror becomes a metal of that colour.

use super::json;
use durer::math::{Vec3, Vec4};
use durer::shade::color::{decode_rgba8, decode_unorm8, encode_srgb8, encode_unorm8};

/// Reflectance of a dielectric at normal incidence.
const DIELECTRIC: f32 = 0.04;

/// The factors of a material.
#[derive(Debug, Clone, Copy)]
pub struct Glossy {
    /// Diffuse colour: linear RGBA.
    pub diffuse: Vec4,
    /// Colour of the reflection at normal incidence: linear RGB.
    pub specular: Vec3,
    /// 1 = mirror, 0 = matte.
    pub glossiness: f32,
}

/// The same as metallic-roughness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metallic {
    /// Linear.
    pub base_color: Vec4,
    pub metallic: f32,
    pub roughness: f32,
}

impl Glossy {
    /// Returns the factors in the file; missing ones are 1.
    pub fn of(glossy: &json::SpecularGlossiness) -> Self {
        let unit = |v: f32| v.clamp(0.0, 1.0);
        Self {
            diffuse: Vec4::from(glossy.diffuse_factor.unwrap_or([1.0; 4]).map(unit)),
            specular: Vec3::from(glossy.specular_factor.unwrap_or([1.0; 3]).map(unit)),
            glossiness: unit(glossy.glossiness_factor.unwrap_or(1.0)),
        }
    }

    /// Returns whether it is a dielectric whatever its diffuse colour is.
    pub fn is_dielectric(&self) -> bool {
        brightness(self.specular) < DIELECTRIC
    }

    /// Multiplies by texels of the diffuse and the specular-glossiness texture, as they are stored.
    fn textured(self, [diffuse, specular]: [Option<[u8; 4]>; 2]) -> Self {
        let texel = |texel: Option<[u8; 4]>| decode_rgba8(texel.unwrap_or([255; 4]));
        let glossiness = decode_unorm8(specular.map_or(255, |s| s[3]));
        Self {
            diffuse: self.diffuse * texel(diffuse),
            specular: self.specular * texel(specular).truncate(),
            glossiness: self.glossiness * glossiness,
        }
    }

    /// Returns the texels of a base colour and of a metallic-roughness texture.
    pub fn texels(self, texels: [Option<[u8; 4]>; 2]) -> [[u8; 4]; 2] {
        let Metallic { base_color, metallic, roughness } = self.textured(texels).metallic();
        let [r, g, b] = base_color.truncate().to_array().map(encode_srgb8);
        // The alpha of the factor stays one.
        let alpha = texels[0].map_or(255, |d| d[3]);
        [[r, g, b, alpha], [255, encode_unorm8(roughness), encode_unorm8(metallic), 255]]
    }

    /// Returns the conversion.
    pub fn metallic(self) -> Metallic {
        let (diffuse, specular) = (self.diffuse.truncate(), self.specular);
        let scattered = 1.0 - specular.max_element();
        let metallic = metalness(brightness(diffuse), brightness(specular), scattered);
        let small = 1e-6;
        let from_diffuse = diffuse * (scattered / (1.0 - DIELECTRIC) / (1.0 - metallic).max(small));
        let reflected = specular - Vec3::splat(DIELECTRIC * (1.0 - metallic));
        let from_specular = reflected * (1.0 / metallic.max(small));
        let part = metallic * metallic;
        let color = from_diffuse * (1.0 - part) + from_specular * part;
        Metallic {
            base_color: color.clamp(Vec3::ZERO, Vec3::ONE).extend(self.diffuse.w),
            metallic,
            roughness: 1.0 - self.glossiness,
        }
    }
}

/// Returns the perceived brightness of a colour: the length of its weighted channels.
fn brightness(color: Vec3) -> f32 {
    (color * color).dot(Vec3::new(0.299, 0.587, 0.114)).sqrt()
}

/// Returns the root of the quadratic equation for the metalness, 0 … 1.
fn metalness(diffuse: f32, specular: f32, scattered: f32) -> f32 {
    if specular < DIELECTRIC {
        return 0.0;
    }
    let b = diffuse * scattered / (1.0 - DIELECTRIC) + specular - 2.0 * DIELECTRIC;
    let c = DIELECTRIC - specular;
    let root = (b * b - 4.0 * DIELECTRIC * c).max(0.0).sqrt();
    // The form of the root without a subtraction.
    let root = if b > 0.0 { -2.0 * c / (b + root) } else { (root - b) / (2.0 * DIELECTRIC) };
    root.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn metallic(diffuse: [f32; 3], specular: [f32; 3]) -> Metallic {
        let (diffuse, specular) = (Vec3::from(diffuse).extend(0.5), Vec3::from(specular));
        Glossy { diffuse, specular, glossiness: 0.75 }.metallic()
    }

    #[test]
    fn mirrors_become_metals_and_plastics_stay() {
        let gold = metallic([0.0; 3], [1.0, 0.76, 0.33]);
        assert!(gold.metallic > 1.0 - 1e-6 && gold.roughness == 0.25, "{gold:?}");
        assert!((gold.base_color - Vec4::new(1.0, 0.76, 0.33, 0.5)).length() < 1e-6, "{gold:?}");
        let plastic = metallic([0.96, 0.48, 0.0], [0.04; 3]);
        assert!(plastic.metallic < 1e-6, "{plastic:?}");
        assert!((plastic.base_color - Vec4::new(0.96, 0.48, 0.0, 0.5)).length() < 1e-5);
        assert_eq!(metallic([1.0; 3], [0.0; 3]).metallic, 0.0);
        // A metal of reflectance 0.5 without a diffuse part, as the published conversion gives it.
        let dark = metallic([0.0; 3], [0.5; 3]);
        assert!(dark.metallic > 0.99 && (dark.base_color.x - 0.5).abs() < 1e-3, "{dark:?}");
    }

    #[test]
    fn texels_are_those_of_the_factors() {
        let glossy = Glossy { diffuse: Vec4::ONE, specular: Vec3::ONE, glossiness: 1.0 };
        let [base, rough] = glossy.texels([Some([0, 0, 0, 9]), Some([255, 226, 155, 191])]);
        assert_eq!((base, rough), ([255, 226, 155, 9], [255, 64, 255, 255]));
        let [base, rough] = glossy.texels([Some([200, 100, 50, 255]), Some([0, 0, 0, 0])]);
        // Nothing is reflected: the scattered light is that of a dielectric, a little brighter.
        assert_eq!((rough[1], rough[2], base[3]), (255, 0, 255));
        assert!(base[0] > 200 && base[0] < 206, "{base:?}");
    }
}
