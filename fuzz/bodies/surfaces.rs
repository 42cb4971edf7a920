//! Any bytes become a scene; all methods must find the same surfaces in it.
//!
//! The fuzz target and a plain test call [`body`].

use durer::math::{DMat3, DMat4, DVec3, Vec3, Vec4};
use durer::pipeline::{Cull, RenderOptions, Samples, SurfaceMethod, render};
use durer::scene::{
    AlphaMode, Camera, Image, Instance, Material, Mesh, MipFilter, Part, Projection, Sampler,
    Scene, ShadingModel, Texture, TextureRef, Wrap,
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

/// Returns a texture of any size, wrap mode and transparency, with a mip chain or without.
fn texture(number: usize) -> (Image, Sampler) {
    let (width, height) = (1 + number as u32 * 5 % 37, 1 + number as u32 * 7 % 53);
    let data = (0..width * height).map(|i| {
        let code = i.wrapping_mul(0x9e37_79b9).to_le_bytes();
        [code[3], code[2], code[1], if number.is_multiple_of(2) { 255 } else { code[0] }]
    });
    let wrap = [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge][number % 3];
    let mip = if number % 5 < 3 { MipFilter::None } else { MipFilter::Linear };
    let sampler = Sampler { mip, wrap_u: wrap, wrap_v: wrap, ..Sampler::default() };
    (Image { name: String::new(), width, height, data: data.collect() }, sampler)
}

/// Returns opaque, blended and masked triangles, up to 64; two scenes of three have a texture.
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
    let (image, sampler) = texture(count);
    let transform = DMat3::IDENTITY;
    let texture = TextureRef { texture: 0, tex_coord: 0, transform };
    let material = |alpha_mode| Material {
        model: ShadingModel::Unlit,
        base_color: Vec4::new(0.4, 0.6, 0.2, 0.5),
        base_color_texture: (!count.is_multiple_of(3)).then_some(texture),
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
    let tex_coords = vec![positions.iter().map(|p| p.truncate() * 0.5).collect()];
    let mesh = Mesh { positions, tex_coords, parts, ..Mesh::default() };
    let mut instances =
        vec![Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() }];
    if bytes.next() % 8 == 1 {
        let world_from_mesh = DMat4::from_scale(DVec3::new(-1.0, 0.7, 1.0));
        instances.push(Instance { mesh: 0, world_from_mesh, name: String::new() });
    }
    let textures = vec![Texture { image: 0, sampler }];
    let meshes = vec![mesh];
    Scene { meshes, instances, materials, textures, images: vec![image], ..Scene::default() }
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

/// Renders a scene made of the bytes by all methods at a size, and compares items and depths, and colours with those of
/// the scan line; then with four samples at the least and the best SIMD level.
///
/// # Panics
/// Where a method finds other surfaces than the z-buffer, or colours differ.
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
        if method == SurfaceMethod::ScanLineZ {
            assert!(found.color == expected.color, "{method}: colours at {width}x{height}");
        }
    }
    (options.algorithm, options.samples) = (SurfaceMethod::ZBuffer, Samples::Four);
    let colors = durer::simd::levels().into_iter().map(|level| {
        options.level = level;
        render(&scene, &options).expect("what is rendered at one level is at all").0.color
    });
    let colors: Vec<_> = colors.collect();
    assert!(colors.iter().all(|c| *c == colors[0]), "levels at {width}x{height}");
}

/// [`compare`] at a small size that the bytes choose.
pub fn body(data: &[u8]) {
    let (Some((&a, rest)), b) = (data.split_first(), data.last().copied().unwrap_or(0)) else {
        return;
    };
    compare(rest, 1 + u32::from(a) / 3, 1 + u32::from(b) / 3);
}
