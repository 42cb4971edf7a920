//! Eight or sixteen samples of one plain material at a time.

use super::lane::{Lane, Vec3Lane};
use super::light::PreparedLights;
use super::material::PreparedMaterial;
use super::normal::{Frame, face_viewer};
use super::{Shading, formula};
use fearless_simd::{f32x8, f32x16, prelude::*};
use fearless_simd_macros::simd;

/// Surface points, component by component; lanes without a sample may hold anything.
#[derive(Debug, Clone, Copy)]
pub struct Points<L> {
    /// Relative to the lights' origin. Only read where there are point or spot lights.
    pub position: Vec3Lane<L>,
    /// Towards the eye, any length.
    pub view: Vec3Lane<L>,
    /// Interpolated normals, any length.
    pub normal: Vec3Lane<L>,
    /// By what it is known which side of the surface is seen.
    pub faces: Faces<L>,
}

/// By what it is known which side of a surface is seen at several points.
#[derive(Debug, Clone, Copy)]
pub enum Faces<L> {
    /// The unit normals of the faces' planes.
    Normals(Vec3Lane<L>),
    /// Nothing needs to be known: faces are seen from their fronts, interpolated normals have a length
    /// and are on the fronts' sides, and neither flat shading nor shadows ask for the faces' own normals.
    Settled,
}

impl<L: Lane> Points<L> {
    /// The unit vectors at the points, all on the viewer's side.
    #[inline(always)]
    pub(super) fn frame(&self) -> Frame<L> {
        match self.faces {
            Faces::Normals(face) => face_viewer(self.view, face, self.normal),
            Faces::Settled => {
                let normal = self.normal.unit();
                Frame { view: self.view.unit(), face: normal, normal }
            }
        }
    }
}

/// Linear red, green and blue of several samples, each bit for bit what [`super::shade`] gives.
///
/// The material must be [plain](PreparedMaterial::is_plain): textures and vertex colours are not
/// looked at, alpha is [`PreparedMaterial::plain_alpha`]. Cost: O(lights), a tenth of [`super::shade`] per sample where eight lanes are
/// native.
#[simd]
pub fn shade_points<S: Simd>(
    simd: S,
    points: &Points<f32x8<S>>,
    material: &PreparedMaterial<'_>,
    lights: &PreparedLights,
    shading: Shading,
) -> [[f32; 8]; 3] {
    let color = shade_lanes(points, material, lights, shading);
    [color.x.into(), color.y.into(), color.z.into()]
}

/// [`shade_points`] for sixteen samples; where fewer than eight lanes are native, for eight twice.
#[simd]
pub fn shade_points_x16<S: Simd>(
    simd: S,
    points: &Points<f32x16<S>>,
    material: &PreparedMaterial<'_>,
    lights: &PreparedLights,
    shading: Shading,
) -> [[f32; 16]; 3] {
    // Two chains of divisions and roots side by side, which one waits for, take little longer than one.
    if has_eight_lanes::<S>() {
        let color = shade_lanes(points, material, lights, shading);
        return [color.x.into(), color.y.into(), color.z.into()];
    }
    let mut colors = [[0.0; 16]; 3];
    for (half, first) in points.halves(simd).iter().zip([0, 8]) {
        let eight = shade_points(simd, half, material, lights, shading);
        for (to, from) in colors.iter_mut().zip(eight) {
            to[first..first + 8].copy_from_slice(&from);
        }
    }
    colors
}

/// Whether eight numbers fit one of the machine's registers.
#[inline(always)]
fn has_eight_lanes<S: Simd>() -> bool {
    size_of::<S::f32s>() >= size_of::<[f32; 8]>()
}

#[inline(always)]
fn shade_lanes<L: Lane>(
    points: &Points<L>,
    material: &PreparedMaterial<'_>,
    lights: &PreparedLights,
    shading: Shading,
) -> Vec3Lane<L> {
    let frame = points.frame();
    let inputs = material.constant_inputs(points.position.x);
    formula::display(&frame, points.position, &inputs, None, lights, shading)
}

impl<S: Simd> Points<f32x16<S>> {
    /// The first eight and the last eight.
    #[inline(always)]
    fn halves(&self, simd: S) -> [Points<f32x8<S>>; 2] {
        let [position, view] = [split(simd, self.position), split(simd, self.view)];
        let normal = split(simd, self.normal);
        let faces = match self.faces {
            Faces::Normals(face) => split(simd, face).map(Faces::Normals),
            Faces::Settled => [Faces::Settled; 2],
        };
        let half = |i: usize| Points {
            position: position[i],
            view: view[i],
            normal: normal[i],
            faces: faces[i],
        };
        [half(0), half(1)]
    }
}

#[inline(always)]
fn split<S: Simd>(simd: S, v: Vec3Lane<f32x16<S>>) -> [Vec3Lane<f32x8<S>>; 2] {
    let (x, y, z) = (simd.split_f32x16(v.x), simd.split_f32x16(v.y), simd.split_f32x16(v.z));
    [Vec3Lane::new(x.0, y.0, z.0), Vec3Lane::new(x.1, y.1, z.1)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{DVec3, Vec3, Vec4};
    use crate::scene::{Camera, Light, LightKind, Material, Projection, ShadingModel};
    use crate::shade::{PreparedMaterials, Surface, shade};
    use crate::simd::levels;
    use fearless_simd::dispatch;

    /// Eight points of test data.
    type Eight = [[[f32; 8]; 3]; 4];

    #[inline(always)]
    fn load<S: Simd>(simd: S, [x, y, z]: &[[f32; 8]; 3]) -> Vec3Lane<f32x8<S>> {
        let (x, y) = (f32x8::from_slice(simd, x), f32x8::from_slice(simd, y));
        Vec3Lane::new(x, y, f32x8::from_slice(simd, z))
    }

    #[simd]
    fn shade_eight<S: Simd>(
        simd: S,
        [position, view, normal, geometric_normal]: &Eight,
        material: &PreparedMaterial<'_>,
        lights: &PreparedLights,
        shading: Shading,
    ) -> [[f32; 8]; 3] {
        let points = Points {
            position: load(simd, position),
            view: load(simd, view),
            normal: load(simd, normal),
            faces: Faces::Normals(load(simd, geometric_normal)),
        };
        shade_points(simd, &points, material, lights, shading)
    }

    /// The colours of two times eight points, at once.
    #[simd]
    fn shade_sixteen<S: Simd>(
        simd: S,
        both: &[Eight; 2],
        material: &PreparedMaterial<'_>,
        lights: &PreparedLights,
        shading: Shading,
    ) -> [[f32; 16]; 3] {
        let both_of = |i: usize| {
            let [a, b] = [load(simd, &both[0][i]), load(simd, &both[1][i])];
            Vec3Lane::new(
                simd.combine_f32x8(a.x, b.x),
                simd.combine_f32x8(a.y, b.y),
                simd.combine_f32x8(a.z, b.z),
            )
        };
        let points = Points {
            position: both_of(0),
            view: both_of(1),
            normal: both_of(2),
            faces: Faces::Normals(both_of(3)),
        };
        shade_points_x16(simd, &points, material, lights, shading)
    }

    fn camera() -> Camera {
        Camera {
            eye: DVec3::new(0.0, 0.0, 5.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Perspective { fov_y: 0.7 },
            near: 0.1,
            far: 100.0,
        }
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
        PreparedLights::new(&lights, &camera())
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

    /// Pseudo-random numbers −1…1 with some that break formulas.
    fn numbers(seed: &mut u32) -> f32 {
        *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        match *seed >> 24 {
            0 => 0.0,
            1 => f32::NAN,
            2 => f32::INFINITY,
            3 => 1e-30,
            4 => -1e25,
            _ => (*seed >> 8) as f32 / 8_388_608.0 - 1.0,
        }
    }

    fn eight_points(seed: &mut u32) -> Eight {
        let mut v = || std::array::from_fn(|_| std::array::from_fn(|_| numbers(seed)));
        [v(), v(), v(), v()]
    }

    fn lane(v: &[[f32; 8]; 3], i: usize) -> Vec3 {
        Vec3::new(v[0][i], v[1][i], v[2][i])
    }

    #[test]
    fn eight_at_a_time_are_bit_for_bit_one_at_a_time() {
        let scene = crate::scene::Scene { materials: materials(), ..Default::default() };
        let prepared = PreparedMaterials::new(&scene);
        let mut seed = 1;
        for lights in [PreparedLights::auto(&camera()), lamps()] {
            for (material, &shading) in
                (0..5).flat_map(|m| Shading::ALL.iter().map(move |s| (m, s)))
            {
                let material = prepared.get(Some(material));
                assert!(material.is_plain());
                let mut points = eight_points(&mut seed);
                for _ in 0..60 {
                    let before = points;
                    points = eight_points(&mut seed);
                    for level in levels() {
                        let colors = dispatch!(level, simd =>
                            shade_eight(simd, &points, material, &lights, shading));
                        let both = [before, points];
                        let sixteen = dispatch!(level, simd =>
                            shade_sixteen(simd, &both, material, &lights, shading));
                        for i in 0..8 {
                            let surface = Surface {
                                position: lane(&points[0], i),
                                view: lane(&points[1], i),
                                normal: lane(&points[2], i),
                                geometric_normal: lane(&points[3], i),
                                ..Surface::default()
                            };
                            let one = shade(&surface, material, &lights, shading);
                            let eight = lane(&colors, i);
                            let bits = |v: Vec3| v.to_array().map(f32::to_bits);
                            assert_eq!(bits(one.truncate()), bits(eight), "{shading} {level:?}");
                            let sixteen = Vec3::from(sixteen.map(|channel| channel[8 + i]));
                            assert_eq!(bits(sixteen), bits(eight), "{shading} {level:?}");
                            // No NaN, whatever goes in.
                            assert!(one.min_element() >= 0.0 && one.max_element() <= 1.0);
                        }
                    }
                }
            }
        }
    }
}
