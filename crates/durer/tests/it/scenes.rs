//! Generated scenes, small enough to render many times.

use durer::math::{DMat3, DMat4, DVec3, Vec2, Vec3, Vec4};
use durer::pipeline::{RenderOptions, Samples};
use durer::scene::{
    AlphaMode, Camera, Image, Instance, Material, Mesh, Projection, Scene, ShadingModel, Texture,
    TextureRef, Topology,
};
use durer::shade::Panorama;

/// Pseudo-random numbers in 0…1, the same everywhere.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> f32 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 24) as f32
    }

    pub fn point(&mut self, extent: f32) -> Vec3 {
        Vec3::new(self.next() - 0.5, self.next() - 0.5, self.next() - 0.5) * (2.0 * extent)
    }
}

pub fn instance(mesh: usize) -> Instance {
    Instance { mesh, world_from_mesh: DMat4::IDENTITY, name: String::new() }
}

/// Returns intersecting triangles, some behind the eye, some without area, some not finite.
pub fn soup(triangles: usize, seed: u64) -> Scene {
    let mut numbers = Numbers(seed);
    let mut positions = Vec::new();
    for i in 0..triangles {
        let center = numbers.point(1.0);
        let size = if i % 80 == 79 { 4.0 } else { 0.3 };
        positions.extend([0; 3].map(|_| center + numbers.point(size)));
    }
    positions[0] = Vec3::NAN;
    positions[4] = positions[3];
    let mesh = Mesh { positions, ..Mesh::default() };
    Scene { meshes: vec![mesh], instances: vec![instance(0)], ..Scene::default() }
}

/// Returns a sphere of quads with normals and texture coordinates.
pub fn sphere(rings: u32, material: Option<usize>) -> Mesh {
    let mut mesh = Mesh { tex_coords: vec![Vec::new()], ..Mesh::default() };
    let columns = 2 * rings;
    for ring in 0..=rings {
        for column in 0..=columns {
            let (u, v) = (column as f32 / columns as f32, ring as f32 / rings as f32);
            let (theta, phi) = (libm::acosf(1.0 - 2.0 * v), u * std::f32::consts::TAU);
            let (s, c) = (libm::sinf(theta), libm::cosf(theta));
            let p = Vec3::new(s * libm::sinf(phi), c, s * libm::cosf(phi));
            mesh.positions.push(p);
            mesh.normals.push(p);
            mesh.tex_coords[0].push(Vec2::new(4.0 * u, 2.0 * v));
        }
    }
    let mut indices = Vec::new();
    for ring in 0..rings {
        for column in 0..columns {
            let a = ring * (columns + 1) + column;
            let b = a + columns + 1;
            indices.extend([a, b, a + 1, a + 1, b, b + 1]);
        }
    }
    let count = indices.len() as u32 / 3;
    mesh.indices = Some(indices);
    mesh.parts = vec![durer::scene::Part { range: 0..count, material, name: String::new() }];
    mesh
}

fn checkers() -> Image {
    let texel = |i: u32| {
        if (i % 16 / 4 + i / 16 / 4).is_multiple_of(2) {
            [220, 60, 40, 255]
        } else {
            [40, 90, 200, 90]
        }
    };
    Image { name: "checkers".into(), width: 16, height: 16, data: (0..256).map(texel).collect() }
}

/// Returns textured, masked, blended, metallic and mirrored spheres; lines and points.
pub fn materials() -> Scene {
    let texture = TextureRef { texture: 0, tex_coord: 0, transform: DMat3::IDENTITY };
    let plain = Material {
        model: ShadingModel::MetallicRoughness,
        metallic: 1.0,
        roughness: 0.3,
        ..Material::default()
    };
    let textured = Material { base_color_texture: Some(texture), ..Material::default() };
    let masked = Material { alpha_mode: AlphaMode::Mask { cutoff: 0.5 }, ..textured.clone() };
    let blended = Material { alpha_mode: AlphaMode::Blend, ..textured.clone() };
    let materials = vec![plain, textured, masked, blended];
    let mut meshes: Vec<Mesh> = (0..4).map(|m| sphere(12, Some(m))).collect();
    let mut numbers = Numbers(5);
    let positions: Vec<Vec3> = (0..60).map(|_| numbers.point(1.6)).collect();
    let colors: Vec<Vec4> = positions.iter().map(|p| (p.abs() * 0.6).extend(1.0)).collect();
    for topology in [Topology::Lines, Topology::Points] {
        meshes.push(Mesh {
            topology,
            positions: positions.clone(),
            colors: colors.clone(),
            ..Mesh::default()
        });
    }
    let place = |x: f64, y: f64, z: f64| DMat4::from_translation(DVec3::new(x, y, z));
    let mirrored = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let places = [
        place(-1.0, 0.0, 0.0),
        place(1.0, 0.0, 0.3),
        place(0.0, 1.0, 0.8),
        place(0.2, -0.6, 1.2),
        mirrored,
        DMat4::IDENTITY,
    ];
    let instances = places
        .into_iter()
        .enumerate()
        .map(|(mesh, world_from_mesh)| Instance { mesh, world_from_mesh, name: String::new() })
        .collect();
    let textures = vec![Texture { image: 0, sampler: Default::default() }];
    Scene { meshes, instances, materials, textures, images: vec![checkers()], ..Scene::default() }
}

/// Returns a chrome, a gold, a coated, a woven, a tinted and a glass sphere.
pub fn lobes() -> Scene {
    let plain = Material {
        model: ShadingModel::MetallicRoughness,
        base_color: Vec4::new(0.6, 0.1, 0.1, 1.0),
        roughness: 0.5,
        ..Material::default()
    };
    let metal = |r: f32, g: f32, b: f32, roughness| Material {
        base_color: Vec4::new(r, g, b, 1.0),
        metallic: 1.0,
        roughness,
        ..plain.clone()
    };
    let materials = vec![
        metal(0.9, 0.9, 0.9, 0.0),
        metal(1.0, 0.77, 0.34, 0.4),
        Material { clearcoat: 1.0, clearcoat_roughness: 0.05, ..plain.clone() },
        Material { sheen_color: Vec3::new(0.9, 0.7, 0.8), sheen_roughness: 0.4, ..plain.clone() },
        Material { ior: 2.2, specular_tint: Vec3::new(0.3, 0.6, 1.0), ..plain.clone() },
        Material {
            base_color: Vec4::new(0.8, 0.9, 1.0, 0.2),
            transmission: 0.9,
            roughness: 0.1,
            alpha_mode: AlphaMode::Blend,
            ..plain.clone()
        },
    ];
    let meshes = (0..materials.len()).map(|m| sphere(10, Some(m))).collect();
    let place = |mesh: usize| {
        let at = DVec3::new((mesh % 3) as f64 * 1.1 - 1.1, (mesh / 3) as f64 * 1.1 - 0.6, 0.0);
        let world_from_mesh = DMat4::from_translation(at) * DMat4::from_scale(DVec3::splat(0.5));
        Instance { mesh, world_from_mesh, name: String::new() }
    };
    Scene {
        meshes,
        instances: (0..materials.len()).map(place).collect(),
        materials,
        ..Scene::default()
    }
}

/// Returns a panorama: blue above, brown below, and a bright window on the left.
pub fn panorama() -> Panorama {
    let color = |x: u32, y: u32| match (x, y) {
        (6..10, 5..9) => [9.0, 8.0, 7.0],
        (_, 0..8) => [0.4, 0.6, 1.0],
        _ => [0.3, 0.2, 0.1],
    };
    let pixels: Vec<_> = (0..16).flat_map(|y| (0..32).map(move |x| color(x, y))).collect();
    Panorama::new(32, 16, &pixels).expect("panorama")
}

/// Returns all scenes, by name.
pub fn all() -> Vec<(&'static str, Scene)> {
    vec![("soup", soup(400, 1)), ("materials", materials())]
}

/// Returns a camera that sees a scene with an extent of about two units, and has some of it behind the eye.
pub fn options(_scene: &Scene, width: u32, height: u32) -> RenderOptions {
    let camera = Camera {
        eye: DVec3::new(1.2, 1.0, 4.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 0.9 },
        near: 0.1,
        far: 20.0,
    };
    let mut options = RenderOptions::new(camera);
    (options.width, options.height, options.samples) = (width, height, Samples::Four);
    options
}
