//! Sixteen samples of one plain material at a time.

use super::lane::{Lane, Vec3Lane};
use super::light::PreparedLights;
use super::material::PreparedMaterial;
use super::normal::Frame;
use super::points::Points;
use super::{Shading, formula};
use fearless_simd::{f32x16, prelude::*};
use fearless_simd_macros::simd;

/// Returns linear red, green and blue of sixteen samples, with the same bits as [`super::shade_seen`].
///
/// The material must be [plain](PreparedMaterial::is_plain): textures and vertex colours are ignored, alpha is
/// [`PreparedMaterial::plain_alpha`]. Cost: O(lights), a tenth of [`super::shade`] per sample where eight lanes
/// are native.
#[simd]
pub fn shade_points<S: Simd>(
    simd: S,
    points: &Points<f32x16<S>>,
    material: &PreparedMaterial<'_>,
    lights: &PreparedLights,
    shading: Shading,
) -> [[f32; 16]; 3] {
    let color = shade_frame(&points.frame(), points.position, material, lights, shading);
    [color.x.into(), color.y.into(), color.z.into()]
}

/// Computes the second half of [`shade_points`], after [`Points::frame`], to be inlined into the caller's loop.
#[inline(always)]
pub(crate) fn shade_frame<L: Lane>(
    frame: &Frame<L>,
    position: Vec3Lane<L>,
    material: &PreparedMaterial<'_>,
    lights: &PreparedLights,
    shading: Shading,
) -> Vec3Lane<L> {
    let inputs = material.constant_inputs(position.x);
    formula::display(frame, position, &inputs, None, lights, shading)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{DVec3, Vec3, Vec4};
    use crate::scene::{Light, LightKind, Material, ShadingModel};
    use crate::shade::{Faces, PreparedMaterials, Surface, shade_seen};
    use crate::simd::dispatch;
    use crate::simd::levels;
    use crate::testing::{Numbers, camera_at};

    /// Sixteen points of test data.
    type Sixteen = [[[f32; 16]; 3]; 4];

    #[inline(always)]
    fn load<S: Simd>(simd: S, [x, y, z]: &[[f32; 16]; 3]) -> Vec3Lane<f32x16<S>> {
        let (x, y) = (f32x16::from_slice(simd, x), f32x16::from_slice(simd, y));
        Vec3Lane::new(x, y, f32x16::from_slice(simd, z))
    }

    #[simd]
    fn shade_sixteen<S: Simd>(
        simd: S,
        [position, view, normal, face]: &Sixteen,
        material: &PreparedMaterial<'_>,
        lights: &PreparedLights,
        shading: Shading,
    ) -> [[f32; 16]; 3] {
        let points = Points {
            position: load(simd, position),
            view: load(simd, view),
            normal: load(simd, normal),
            faces: Faces::Seen(load(simd, face)),
        };
        shade_points(simd, &points, material, lights, shading)
    }

    fn lamps() -> PreparedLights {
        let position = DVec3::new(1.0, 2.0, 3.0);
        let spot = LightKind::Spot {
            position,
            direction: DVec3::new(0.0, -1.0, -0.5),
            range: Some(9.0),
            inner: 0.2,
            outer: 0.9,
        };
        let kinds = [LightKind::Point { position, range: None }, spot];
        let lights = kinds.map(|kind| Light { kind, color: Vec3::new(3.0, 2.0, 1.0) });
        PreparedLights::new(&lights, &camera_at(0.0, 0.0, 5.0))
    }

    fn materials() -> Vec<Material> {
        let phong = |shininess| Material { shininess, ..Material::default() };
        let metal = |metallic, roughness| Material {
            model: ShadingModel::MetallicRoughness,
            base_color: Vec4::new(1.0, 0.7, 0.2, 1.0),
            emissive: Vec3::new(0.0, 0.1, 0.9),
            metallic,
            roughness,
            ..Material::default()
        };
        vec![phong(32.0), phong(7.0), phong(96.078), metal(1.0, 0.0), metal(0.3, 0.6)]
    }

    /// Returns a pseudo-random number −1 … 1, sometimes one that breaks formulas.
    fn number(numbers: &mut Numbers) -> f32 {
        match (numbers.unit() * 256.0) as u32 {
            0 => 0.0,
            1 => f32::NAN,
            2 => f32::INFINITY,
            3 => 1e-30,
            4 => -1e25,
            _ => numbers.signed(),
        }
    }

    fn sixteen_points(numbers: &mut Numbers) -> Sixteen {
        let mut v = || std::array::from_fn(|_| std::array::from_fn(|_| number(numbers)));
        [v(), v(), v(), v()]
    }

    fn lane(v: &[[f32; 16]; 3], i: usize) -> Vec3 {
        Vec3::new(v[0][i], v[1][i], v[2][i])
    }

    #[test]
    fn sixteen_at_a_time_are_bit_for_bit_one_at_a_time() {
        let scene = crate::scene::Scene { materials: materials(), ..Default::default() };
        let prepared = PreparedMaterials::new(&scene);
        let mut numbers = Numbers(1);
        for lights in [PreparedLights::auto(&camera_at(0.0, 0.0, 5.0)), lamps()] {
            for (material, &shading) in
                (0..5).flat_map(|m| Shading::ALL.iter().map(move |s| (m, s)))
            {
                let material = prepared.get(Some(material));
                assert!(material.is_plain());
                for _ in 0..30 {
                    let points = sixteen_points(&mut numbers);
                    for level in levels() {
                        let colors = dispatch!(level, simd =>
                            shade_sixteen(simd, &points, material, &lights, shading));
                        for i in 0..16 {
                            let surface = Surface {
                                position: lane(&points[0], i),
                                view: lane(&points[1], i),
                                normal: lane(&points[2], i),
                                geometric_normal: lane(&points[3], i),
                                ..Surface::default()
                            };
                            let one = shade_seen(&surface, material, &lights, shading);
                            let bits = |v: Vec3| v.to_array().map(f32::to_bits);
                            let sixteen = lane(&colors, i);
                            assert_eq!(bits(one.truncate()), bits(sixteen), "{shading} {level:?}");
                            // No NaN, whatever the input.
                            assert!(one.min_element() >= 0.0 && one.max_element() <= 1.0);
                        }
                    }
                }
            }
        }
    }
}
