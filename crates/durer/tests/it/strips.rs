//! Large unlit, textured triangles: the z-buffer lights columns of them in one go, other methods do not.

use crate::scenes::{Numbers, instance};
use durer::math::{DMat3, DVec2, DVec3, Vec2, Vec3, Vec4};
use durer::pipeline::{RenderOptions, Samples, SurfaceMethod, render};
use durer::scene::{
    AlphaMode, Camera, Image, Material, Mesh, MipFilter, Part, Projection, Sampler, Scene,
    ShadingModel, Texture, TextureRef, Wrap,
};

fn image(width: u32, height: u32, numbers: &mut Numbers) -> Image {
    let data = (0..width * height).map(|_| [0; 4].map(|_: u8| (numbers.next() * 256.0) as u8));
    Image { name: String::new(), width, height, data: data.collect() }
}

/// A tilted wall and a smaller one before it, of two triangles each, whose textures are repeated as often as given;
/// upright ones have rows along those of the picture.
fn walls(size: [u32; 2], wrap: Wrap, alpha_mode: AlphaMode, repeated: f32, upright: bool) -> Scene {
    let mut numbers = Numbers(u64::from(size[0] * 1000 + size[1]));
    let (mut mesh, mut coordinates) = (Mesh::default(), Vec::new());
    for (half, z, tilt) in [(1.6, 0.0, 0.4), (0.5, 0.7, 0.0)] {
        for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        {
            let (tilt, turn) = if upright { (0.0, 0.0) } else { (tilt, 0.3) };
            mesh.positions.push(Vec3::new(x * half, y * half, z + tilt * x));
            coordinates.push(Vec2::new(x + turn * y, y - turn * x) * (0.5 * repeated));
        }
    }
    mesh.tex_coords.push(coordinates);
    let part = |range, material| Part { range, material: Some(material), name: String::new() };
    mesh.parts = vec![part(0..2, 0), part(2..4, 1)];
    let angle = if upright { 0.0 } else { 0.2 };
    let transform =
        DMat3::from_scale_angle_translation(DVec2::new(0.9, 1.1), angle, DVec2::splat(0.3));
    let material = |texture, transform, base_color| Material {
        model: ShadingModel::Unlit,
        base_color,
        base_color_texture: Some(TextureRef { texture, tex_coord: 0, transform }),
        alpha_mode,
        ..Material::default()
    };
    let materials = vec![
        material(0, DMat3::IDENTITY, Vec4::ONE),
        material(1, transform, Vec4::new(1.7, 0.6, 0.9, 0.8)),
    ];
    let sampler =
        Sampler { mip: MipFilter::None, wrap_u: wrap, wrap_v: wrap, ..Sampler::default() };
    let textures = [0, 1].map(|image| Texture { image, sampler }).to_vec();
    let images = vec![image(size[0], size[1], &mut numbers), image(7, 30, &mut numbers)];
    let (meshes, instances) = (vec![mesh], vec![instance(0)]);
    Scene { meshes, instances, materials, textures, images, ..Scene::default() }
}

fn options(width: u32, height: u32, projection: Projection) -> RenderOptions {
    let (eye, target, up) = (DVec3::new(0.1, 0.2, 3.0), DVec3::ZERO, DVec3::Y);
    let camera = Camera { eye, target, up, projection, near: 0.5, far: 9.0 };
    RenderOptions { width, height, ..RenderOptions::new(camera) }
}

#[test]
fn walls_have_the_colours_of_other_methods_at_every_level() {
    let projections =
        [Projection::Orthographic { height: 2.0 }, Projection::Perspective { fov_y: 0.6 }];
    let modes = [AlphaMode::Opaque, AlphaMode::Mask { cutoff: 0.3 }, AlphaMode::Blend];
    let mut number = 0;
    for size in [[1, 1], [5, 3], [40, 24], [64, 64], [300, 130], [0, 0]] {
        for wrap in [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge] {
            for repeated in [0.3, 1.0, 5.0] {
                let mode = modes[number % 3];
                let mut options = options(150, 93, projections[number / 2 % 2]);
                let scene = walls(size, wrap, mode, repeated, number % 5 < 2);
                number += 1;
                options.samples = Samples::One;
                options.algorithm = SurfaceMethod::ScanLineZ;
                let (expected, _) = render(&scene, &options).expect("picture");
                options.algorithm = SurfaceMethod::ZBuffer;
                for level in durer::simd::levels() {
                    options.level = level;
                    let (found, _) = render(&scene, &options).expect("picture");
                    let same = found.color == expected.color;
                    assert!(same, "{size:?} {wrap:?} {repeated} {mode:?} {level:?}");
                }
            }
        }
    }
}

#[test]
fn strange_coordinates_have_the_colours_of_other_methods() {
    for strange in [f32::NAN, f32::INFINITY, f32::MAX, -3e9, 1e-40] {
        let mut scene = walls([16, 16], Wrap::Repeat, AlphaMode::Opaque, 1.0, false);
        scene.meshes[0].tex_coords[0][1] = Vec2::new(strange, 0.5);
        scene.meshes[0].tex_coords[0][8] = Vec2::new(0.5, strange);
        let mut options = options(131, 77, Projection::Orthographic { height: 2.0 });
        options.samples = Samples::One;
        let (found, _) = render(&scene, &options).expect("picture");
        options.algorithm = SurfaceMethod::ScanLineZ;
        let (expected, _) = render(&scene, &options).expect("picture");
        assert!(found.color == expected.color, "{strange}");
    }
}
