//! Points of a material with textures: looked up one by one, lit eight at a time.

use super::Shading;
use super::formula::{self, Inputs};
use super::lane::Vec3Lane;
use super::light::PreparedLights;
use super::lobes::Lobes;
use super::metallic_roughness::Substance;
use super::normal::Frame;
use super::phong::Shininess;
use fearless_simd::{f32x8, prelude::*};
use fearless_simd_macros::simd;

/// A point of a surface with the values of its material's textures, ready to be lit.
#[derive(Debug, Clone, Copy)]
pub struct TexturedPoint<'a> {
    pub(super) frame: Frame<f32>,
    pub(super) position: Vec3Lane<f32>,
    pub(super) inputs: Inputs<'a, f32>,
}

/// Up to eight points of one material; those not set keep their earlier contents.
#[derive(Debug, Clone, Copy, Default)]
pub struct TexturedPoints<'a> {
    /// The vectors and colours of a [`TexturedPoint`], by axis: direction to the eye, face, normal, position; base,
    /// diffuse, specular and emitted colour.
    vectors: [[[f32; 8]; 3]; 8],
    /// Metalness, roughness and occlusion.
    numbers: [[f32; 8]; 3],
    /// Common to all points, like the fields below.
    shininess: Shininess,
    mirrors: bool,
    lobes: Option<&'a Lobes>,
}

impl<'a> TexturedPoints<'a> {
    /// Sets the point `lane`, 0 … 7, whose material must
    /// [be lit together](super::PreparedMaterial::is_lit_together).
    #[inline(always)]
    pub fn set(&mut self, lane: usize, point: &TexturedPoint<'a>) {
        let TexturedPoint { frame: Frame { view, face, normal }, position, inputs } = *point;
        let Inputs { substance, diffuse, specular, shininess, emission, lobes } = inputs;
        let Substance { base, metallic, roughness, occlusion, mirrors } = substance;
        let lane = lane % 8;
        let vectors = [view, face, normal, position, base, diffuse, specular, emission];
        for ([x, y, z], vector) in self.vectors.iter_mut().zip(vectors) {
            (x[lane], y[lane], z[lane]) = (vector.x, vector.y, vector.z);
        }
        for (to, number) in self.numbers.iter_mut().zip([metallic, roughness, occlusion]) {
            to[lane] = number;
        }
        (self.shininess, self.mirrors, self.lobes) = (shininess, mirrors, lobes);
    }

    /// Returns linear red, green and blue, with the same bits as [`super::shade`]. Cost: O(lights).
    #[simd]
    pub fn shade<S: Simd>(
        simd: S,
        this: &Self,
        lights: &PreparedLights,
        shading: Shading,
    ) -> [[f32; 8]; 3] {
        let zero = f32x8::splat(simd, 0.0);
        let mut vectors = [Vec3Lane::new(zero, zero, zero); 8];
        for (to, [x, y, z]) in vectors.iter_mut().zip(&this.vectors) {
            let (x, y) = (f32x8::from_slice(simd, x), f32x8::from_slice(simd, y));
            *to = Vec3Lane::new(x, y, f32x8::from_slice(simd, z));
        }
        let [view, face, normal, position, base, diffuse, specular, emission] = vectors;
        let substance = Substance {
            base,
            metallic: f32x8::from_slice(simd, &this.numbers[0]),
            roughness: f32x8::from_slice(simd, &this.numbers[1]),
            occlusion: f32x8::from_slice(simd, &this.numbers[2]),
            mirrors: this.mirrors,
        };
        let Self { shininess, lobes, .. } = *this;
        let inputs = Inputs { substance, diffuse, specular, shininess, emission, lobes };
        let frame = Frame { view, face, normal };
        let color = formula::display(&frame, position, &inputs, None, lights, shading);
        [color.x.into(), color.y.into(), color.z.into()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{DVec3, Vec3, Vec4};
    use crate::scene::{AlphaMode, Light, LightKind, Material, ShadingModel};
    use crate::shade::environment::Mirrored;
    use crate::shade::studio::Studio;
    use crate::shade::tone::Tone;
    use crate::shade::{Panorama, PreparedMaterials, Surface, ToneMap, shade_seen};
    use crate::simd::dispatch;
    use crate::simd::levels;
    use crate::testing::camera_at;
    use std::sync::Arc;

    /// Returns a material with each kind of lobe, and one with all.
    fn materials() -> Vec<Material> {
        let plain = Material {
            model: ShadingModel::MetallicRoughness,
            base_color: Vec4::new(0.9, 0.5, 0.2, 1.0),
            metallic: 0.2,
            roughness: 0.4,
            alpha_mode: AlphaMode::Mask { cutoff: 0.5 },
            ..Material::default()
        };
        let coat = Material { clearcoat: 0.8, clearcoat_roughness: 0.1, ..plain.clone() };
        let sheen_color = Vec3::new(0.9, 0.2, 0.5);
        let fibres = |sheen_roughness| Material { sheen_color, sheen_roughness, ..plain.clone() };
        let specular_tint = Vec3::new(1.0, 0.5, 0.1);
        let tinted = Material { ior: 1.9, specular_strength: 0.7, specular_tint, ..plain.clone() };
        let clear = Material { transmission: 0.6, ..plain.clone() };
        let all = Material { sheen_color, transmission: 0.4, ior: 1.2, ..coat.clone() };
        vec![coat, fibres(0.1), fibres(0.7), tinted, clear, all, plain]
    }

    fn lights() -> Vec<PreparedLights> {
        let camera = camera_at(0.0, 0.0, 5.0);
        let kind = LightKind::Point { position: DVec3::new(1.0, 2.0, 3.0), range: None };
        let lamp = Light { kind, color: Vec3::new(9.0, 7.0, 5.0) };
        let mut studio = PreparedLights::auto(&camera);
        studio.environment.mirrored = Mirrored::Studio(Studio::of_camera(&camera));
        let sky: Vec<_> = (0..32).map(|i| [0.1 * i as f32, 1.0, 0.3]).collect();
        let sky = Arc::new(Panorama::new(8, 4, &sky).expect("panorama"));
        let around = Some((&sky, crate::scene::UpAxis::Z));
        let mut lit = vec![studio, PreparedLights::within(around, &[lamp], &camera)];
        for &map in ToneMap::ALL {
            let tone = Tone { gain: 0.7, map };
            lit.push(PreparedLights { tone, ..lit[0].clone() });
        }
        lit
    }

    fn surface(i: u32) -> Surface<'static> {
        let number = |k: u32| (i * 7 + k * 3) as f32 * 0.618_034 % 1.0 - 0.5;
        Surface {
            position: Vec3::new(number(1), number(2), number(3)),
            view: Vec3::new(number(4), number(5), 1.0),
            normal: Vec3::new(number(6), number(7), 0.9),
            ..Surface::default()
        }
    }

    #[test]
    fn eight_at_a_time_are_bit_for_bit_one_at_a_time() {
        let scene = crate::scene::Scene { materials: materials(), ..Default::default() };
        let prepared = PreparedMaterials::new(&scene);
        let shading = Shading::MetallicRoughness;
        for (lights, m) in lights().iter().flat_map(|l| (0..7).map(move |m| (l, m))) {
            let material = prepared.get(Some(m));
            assert!(!material.is_plain() && material.is_lit_together(shading));
            let mut points = TexturedPoints::default();
            for i in 0..8 {
                points.set(i as usize, &material.textured_point(&surface(i), shading));
            }
            for level in levels() {
                let [r, g, b] =
                    dispatch!(level, simd => TexturedPoints::shade(simd, &points, lights, shading));
                for i in 0..8 {
                    let one = shade_seen(&surface(i as u32), material, lights, shading);
                    let eight = [r[i], g[i], b[i]];
                    let bits = |c: [f32; 3]| c.map(f32::to_bits);
                    assert_eq!(bits(one.truncate().to_array()), bits(eight), "{m} {level:?}");
                }
            }
        }
    }
}
