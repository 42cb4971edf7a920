//! Scenes that are hard for visible-surface algorithms, and their items by the z-buffer.

use crate::scenes::{Numbers, instance, options};
use durer::math::Vec3;
use durer::pipeline::{Cull, RenderOptions, render};
use durer::raster::Span;
use durer::raster::triangle::{self, TriangleRasterizer};
use durer::scene::{Mesh, Scene};
use durer::shade::PreparedLights;
use durer::target::Framebuffer;
use durer::view::View;
use durer::view::window::PixelRect;
use durer::visibility::surface::SurfaceInput;
use durer::visibility::surface::{ScreenTriangle, TriangleFilter};

/// Returns the depth of a triangle's plane at a pixel's centre.
pub fn depth_at(t: &ScreenTriangle, x: i32, y: i32) -> f32 {
    let [ox, oy] = t.origin();
    t.depth_at((x - ox) as f32, (y - oy) as f32)
}

/// Returns the rows of pixels of a window that a triangle covers.
pub fn covered(t: &ScreenTriangle, clip: PixelRect) -> Vec<Span> {
    let mut spans = Vec::new();
    let options = triangle::Options { clip };
    TriangleRasterizer::EdgeFunction.rasterize(&t.snapped(), &options, |span| spans.push(span));
    spans
}

/// Returns one mesh of separate triangles.
pub fn of_triangles(triangles: &[[Vec3; 3]]) -> Scene {
    let positions = triangles.iter().flatten().copied().collect();
    let mesh = Mesh { positions, ..Mesh::default() };
    Scene { meshes: vec![mesh], instances: vec![instance(0)], ..Scene::default() }
}

fn quad([a, b, c, d]: [Vec3; 4]) -> [[Vec3; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// Returns a beam between two points, as a strip of two triangles that faces the viewer.
fn beam(a: Vec3, b: Vec3, width: f32) -> [[Vec3; 3]; 2] {
    let side = (b - a).cross(Vec3::Z).normalize() * width;
    quad([a - side, b - side, b + side, a + side])
}

/// Returns three cyclically overlapping beams.
pub fn three_beams() -> Scene {
    let corner = |i: usize| {
        let angle = i as f32 * std::f32::consts::TAU / 3.0;
        Vec3::new(libm::cosf(angle), libm::sinf(angle), 0.0)
    };
    let up = Vec3::new(0.0, 0.0, 0.3);
    let beams = [0, 1, 2].map(|i| {
        let (a, b) = (corner(i), corner(i + 1));
        let along = (b - a) * 0.3;
        beam(a - along - up, b + along + up, 0.2)
    });
    of_triangles(beams.as_flattened())
}

/// Returns two squares that penetrate each other.
pub fn crossing_quads() -> Scene {
    let square = |depth: f32| {
        quad([
            Vec3::new(-1.0, -1.0, depth),
            Vec3::new(1.0, -1.0, -depth),
            Vec3::new(1.0, 1.0, -depth),
            Vec3::new(-1.0, 1.0, depth),
        ])
    };
    of_triangles([square(1.0), square(-1.0)].as_flattened())
}

/// Returns the same faces twice, each time with another first vertex, and overlapping coplanar ones.
pub fn duplicates() -> Scene {
    let mut triangles = Vec::new();
    let mut numbers = Numbers(11);
    for _ in 0..8 {
        let [a, b, c] = [0; 3].map(|_| numbers.point(1.2));
        triangles.extend([[a, b, c], [b, c, a], [c, b, a], [a, b, c], [a, (b + c) * 0.5, c]]);
    }
    of_triangles(&triangles)
}

/// Returns triangles of all sizes: crossing, behind the eye, without area, equal, at one distance.
pub fn random(seed: u64) -> Scene {
    let mut numbers = Numbers(seed.wrapping_mul(977).wrapping_add(5));
    let count = 1 + (numbers.next() * 40.0) as usize;
    let mut triangles: Vec<[Vec3; 3]> = Vec::new();
    for i in 0..count {
        let kind = (numbers.next() * 8.0) as u32;
        let center = numbers.point(1.0);
        let size = [0.05, 0.3, 0.3, 1.0, 1.0, 8.0, 1.5, 0.6][kind as usize % 8];
        let mut triangle = [0; 3].map(|_| center + numbers.point(size));
        match kind {
            6 => triangle.iter_mut().for_each(|p| p.z = 0.25),
            7 if i > 0 => triangle = triangles[i / 2],
            _ => {}
        }
        triangles.push(triangle);
    }
    of_triangles(&triangles)
}

/// Returns flat needles across the view, at most a pixel high and steep in depth, close behind one another.
pub fn needles(seed: u64) -> Scene {
    let mut numbers = Numbers(seed.wrapping_mul(7919).wrapping_add(3));
    let camera = options(&Scene::default(), 1, 1).camera;
    let ahead = (camera.target - camera.eye).normalize();
    let right = ahead.cross(camera.up).normalize();
    let axes = [right, right.cross(ahead), ahead].map(|axis| axis.as_vec3());
    let mut triangles = Vec::new();
    for _ in 0..4 {
        let row = (numbers.next() - 0.5) * 1.6;
        for _ in 0..6 {
            let mut corner = |x: f32| {
                let place = [x, row + (numbers.next() - 0.5) * 0.05, numbers.next() * 0.6];
                axes.iter().zip(place).map(|(axis, v)| *axis * v).sum::<Vec3>()
            };
            triangles.push([corner(-1.0), corner(1.0), corner(0.2)]);
        }
    }
    of_triangles(&triangles)
}

/// View of a scene to which an algorithm is applied.
pub struct Prepared<'a> {
    pub scene: &'a Scene,
    pub options: RenderOptions,
    pub view: View,
    pub lights: PreparedLights,
}

impl<'a> Prepared<'a> {
    pub fn new(scene: &'a Scene, width: u32, height: u32) -> Self {
        let mut options = options(scene, width, height);
        (options.item, options.depth, options.normal) = (true, true, true);
        options.samples = durer::pipeline::Samples::One;
        // These lights have no studio.
        options.surroundings = durer::pipeline::Surroundings::None;
        let view = View::new(options.camera, width, height).expect("view");
        let lights = PreparedLights::of(scene, &options.camera);
        Self { scene, options, view, lights }
    }

    pub fn input(&self) -> SurfaceInput<'_> {
        let filter = TriangleFilter::new(Cull::None, 0);
        SurfaceInput::new(self.scene, &self.view, filter).expect("input")
    }

    /// Returns the input for anti-aliasing, which includes triangles that miss all centres.
    pub fn fine_input(&self) -> SurfaceInput<'_> {
        let filter = TriangleFilter::new(Cull::None, 128);
        SurfaceInput::new(self.scene, &self.view, filter).expect("input")
    }

    pub fn framebuffer(&self) -> Framebuffer {
        Framebuffer::new(self.options.width, self.options.height)
            .with_items()
            .with_depth()
            .with_normals()
    }

    pub fn by_z_buffer(&self) -> Framebuffer {
        render(self.scene, &self.options).expect("picture").0
    }
}

/// Returns the sizes at which scenes are tested; large ones are rare.
pub fn size(seed: u64) -> (u32, u32) {
    match seed % 16 {
        0 => (256, 256),
        1 => (1, 1),
        2 => (200, 3),
        3 => (2, 100),
        4 => (129, 127),
        k => (16 + 5 * k as u32, 64 - 3 * k as u32),
    }
}

/// Runs over the special scenes and `count` random ones.
pub fn each(count: u64, mut f: impl FnMut(&str, &Prepared<'_>)) {
    for (name, scene) in [
        ("beams", three_beams()),
        ("crossing", crossing_quads()),
        ("duplicates", duplicates()),
        ("materials", crate::scenes::materials()),
    ] {
        for (width, height) in [(1, 1), (64, 64), (150, 130)] {
            f(name, &Prepared::new(&scene, width, height));
        }
    }
    for seed in 0..count {
        let (width, height) = size(seed);
        f(&format!("random {seed}"), &Prepared::new(&random(seed), width, height));
    }
}

/// Fails unless two pictures have the same planes except colour.
pub fn assert_same_planes(name: &str, found: &Framebuffer, expected: &Framebuffer) {
    let items = |f: &Framebuffer| f.item.as_ref().expect("items").data().to_vec();
    let (found_items, expected_items) = (items(found), items(expected));
    let pairs = found_items.iter().zip(&expected_items).enumerate();
    let differing: Vec<_> = pairs.filter(|(_, (a, b))| a != b).take(5).collect();
    assert!(differing.is_empty(), "{name}: {}x{}: {differing:?}", found.width(), found.height());
    assert!(found.depth == expected.depth, "{name}: depth");
    assert!(found.normal == expected.normal, "{name}: normal");
}

/// A triangle across the middle of the view.
pub const FACING: [Vec3; 3] =
    [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
