//! Any bytes become a scene; all methods must find the same surfaces in it.
//!
//! The fuzz target and a plain test call [`body`].

use durer::math::{DMat4, DVec3, Vec3, Vec4};
use durer::pipeline::{Cull, RenderOptions, Samples, SurfaceMethod, render};
use durer::scene::{
    AlphaMode, Camera, Instance, Material, Mesh, Part, Projection, Scene, ShadingModel,
};

/// Triangles of a scene at most, so that one run stays short.
const TRIANGLES: usize = 64;

/// Numbers from bytes; zeros where they end.
pub struct Bytes<'a>(pub &'a [u8]);

impl Bytes<'_> {
    pub fn next(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        first
    }

    /// −1 … 1 in steps of 1/128: equal coordinates, coplanar faces and ties are frequent.
    fn coordinate(&mut self) -> f32 {
        (f32::from(self.next()) - 128.0) / 128.0
    }

    fn point(&mut self) -> Vec3 {
        Vec3::new(self.coordinate(), self.coordinate(), self.coordinate())
    }

    fn triangle(&mut self, before: &[[Vec3; 3]]) -> [Vec3; 3] {
        let kind = self.next() % 8;
        let (center, size) = (self.point() * 1.5, [1.0, 0.3, 0.05, 6.0, 1.0, 0.6, 1.0, 2.0]);
        let mut points = [0; 3].map(|_| center + self.point() * size[kind as usize]);
        match (kind, before.last()) {
            // In one plane with others.
            (4, _) => points.iter_mut().for_each(|p| p.z = 0.25),
            // The same again, from another corner.
            (5, Some([a, b, c])) => points = [*b, *c, *a],
            // Along an edge of the one before.
            (6, Some([a, b, _])) => points = [*b, *a, points[2]],
            _ => {}
        }
        points
    }
}

/// Opaque, blended and masked triangles, up to 64.
pub fn scene(bytes: &mut Bytes<'_>) -> Scene {
    let count = 1 + bytes.next() as usize % TRIANGLES;
    let mut triangles: Vec<[Vec3; 3]> = Vec::new();
    for _ in 0..count {
        let triangle = bytes.triangle(&triangles);
        triangles.push(triangle);
    }
    let mut positions: Vec<Vec3> = triangles.into_iter().flatten().collect();
    if bytes.next() == 7 {
        positions[0] = Vec3::NAN;
    }
    let material = |alpha_mode| Material {
        model: ShadingModel::Unlit,
        base_color: Vec4::new(0.4, 0.6, 0.2, 0.5),
        alpha_mode,
        ..Material::default()
    };
    let materials =
        [AlphaMode::Opaque, AlphaMode::Blend, AlphaMode::Mask { cutoff: 0.6 }].map(material).into();
    let half = count as u32 / 2;
    let second = match bytes.next() % 4 {
        kind @ 0..3 => Some(kind as usize),
        _ => None,
    };
    let parts = vec![
        Part { range: 0..half, material: None, name: String::new() },
        Part { range: half..count as u32, material: second, name: String::new() },
    ];
    let mesh = Mesh { positions, parts, ..Mesh::default() };
    let mut instances =
        vec![Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() }];
    if bytes.next() % 8 == 1 {
        let world_from_mesh = DMat4::from_scale(DVec3::new(-1.0, 0.7, 1.0));
        instances.push(Instance { mesh: 0, world_from_mesh, name: String::new() });
    }
    Scene { meshes: vec![mesh], instances, materials, ..Scene::default() }
}

/// Outside the scene, or amid it.
pub fn camera(bytes: &mut Bytes<'_>) -> Camera {
    let eye = bytes.point().as_dvec3() * 4.0 + DVec3::new(1e-3, 2e-3, 3e-3);
    let projection = match bytes.next() {
        n if n % 3 == 0 => Projection::Orthographic { height: 1.0 + f64::from(n) / 64.0 },
        n => Projection::Perspective { fov_y: 0.3 + f64::from(n) / 128.0 },
    };
    let target = bytes.point().as_dvec3() * 0.3;
    let up = if bytes.next().is_multiple_of(2) { DVec3::Y } else { DVec3::new(0.3, 0.5, 0.8) };
    Camera { eye, target, up, projection, near: 0.05, far: 6.0 }
}

/// Renders a scene made of the bytes by all methods at a size, and compares items and depths.
///
/// # Panics
/// Where a method finds other surfaces than the z-buffer.
pub fn compare(data: &[u8], width: u32, height: u32) {
    let mut bytes = Bytes(data);
    let mut options = RenderOptions::new(camera(&mut bytes));
    (options.width, options.height) = (width, height);
    options.cull = [Cull::None, Cull::None, Cull::Back, Cull::Material][bytes.next() as usize % 4];
    (options.samples, options.item, options.depth) = (Samples::One, true, true);
    let scene = scene(&mut bytes);
    let Ok((expected, _)) = render(&scene, &options) else { return };
    for &method in SurfaceMethod::ALL {
        options.algorithm = method;
        let (found, _) = render(&scene, &options).expect("what one method renders, all do");
        let items = |f: &durer::target::Framebuffer| f.item.clone().map(|p| p.into_data());
        assert!(items(&found) == items(&expected), "{method}: items at {width}x{height}");
        assert!(found.depth == expected.depth, "{method}: depths at {width}x{height}");
    }
}

/// [`compare`] at a small size that the bytes choose.
pub fn body(data: &[u8]) {
    let (Some((&a, rest)), b) = (data.split_first(), data.last().copied().unwrap_or(0)) else {
        return;
    };
    compare(rest, 1 + u32::from(a) / 3, 1 + u32::from(b) / 3);
}
