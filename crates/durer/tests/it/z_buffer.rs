//! The production path, compared with a z-buffer of a dozen lines over the textbook rasterizer.

use crate::scenes::{self, Numbers};
use durer::math::{DMat4, DVec3, Vec3};
use durer::pipeline::{Cull, RenderOptions, Samples, render};
use durer::raster::triangle::{Options, SnappedTriangle, TriangleRasterizer};
use durer::scene::{Camera, Mesh, Projection, Scene};
use durer::target::NO_ITEM;
use durer::view::View;
use durer::view::window::PixelRect;
use durer::visibility::surface::SurfaceInput;
use durer::visibility::surface::TriangleFilter;

/// Returns the nearest item and its depth at each pixel's centre.
fn by_the_book(scene: &Scene, view: &View) -> (Vec<u32>, Vec<f32>) {
    let filter = TriangleFilter::new(Cull::None, 0);
    let input = SurfaceInput::new(scene, view, filter).expect("triangles");
    let (width, height) = (view.width(), view.height());
    let options = Options { clip: PixelRect::of_size(width, height).expect("size") };
    let mut items = vec![NO_ITEM; (width * height) as usize];
    let mut depths = vec![1.0; items.len()];
    for t in &input.triangles {
        let corners = [0, 1, 2].map(|i| [t.x[i], t.y[i]]);
        let snapped = SnappedTriangle::new(corners).expect("inside the guard band");
        let [ox, oy] = t.origin();
        TriangleRasterizer::EdgeFunction.rasterize(&snapped, &options, |span| {
            for x in span.x0..span.x1 {
                let at = (span.y as u32 * width + x as u32) as usize;
                let depth = t.depth_at((x - ox) as f32, (span.y - oy) as f32);
                let wins = depth < depths[at] || (depth == depths[at] && t.item < items[at]);
                if wins && depth < 1.0 {
                    (items[at], depths[at]) = (t.item, depth);
                }
            }
        });
    }
    (items, depths)
}

#[test]
fn items_and_depths_are_those_of_the_definition() {
    let mut numbers = Numbers(9);
    for seed in 0..120 {
        let triangles = [3, 40, 400][seed as usize % 3];
        let scene = scenes::soup(triangles, seed);
        let size = |n: &mut Numbers| 1 + (n.next() * n.next() * 300.0) as u32;
        let (width, height) = (size(&mut numbers), size(&mut numbers));
        let mut options = scenes::options(&scene, width, height);
        (options.item, options.depth) = (true, true);
        agrees_with_the_book(&scene, &options, &format!("seed {seed} {width}x{height}"));
    }
}

fn agrees_with_the_book(scene: &Scene, options: &RenderOptions, what: &str) {
    let (found, _) = render(scene, options).expect("picture");
    let view = View::new(options.camera, options.width, options.height).expect("view");
    let (items, depths) = by_the_book(scene, &view);
    assert_eq!(found.item.expect("items").data(), items, "{what}");
    assert_eq!(found.depth.expect("depths").data(), depths, "{what}");
}

/// Checks triangles of a few pixels or less, among larger ones and on the picture's border, in two instances, one of
/// them mirrored.
#[test]
fn items_and_depths_of_small_triangles_are_those_of_the_definition() {
    for seed in 0..40 {
        let mut numbers = Numbers(seed + 100);
        let mut scene = scenes::soup(40, seed);
        let positions = &mut scene.meshes[0].positions;
        for _ in 0..6000 {
            let (center, size) = (numbers.point(1.2), 0.01 + 0.04 * numbers.next());
            positions.extend([0; 3].map(|_| center + numbers.point(size)));
        }
        scene.instances.push(scenes::instance(0));
        scene.instances[1].world_from_mesh = DMat4::from_scale(DVec3::new(-0.9, 0.9, 0.9));
        let width = 40 + (numbers.next() * 120.0) as u32;
        let mut options = scenes::options(&scene, width, 97);
        (options.item, options.depth, options.samples) = (true, true, Samples::One);
        agrees_with_the_book(&scene, &options, &format!("seed {seed}"));
    }
}

/// Returns triangles with corners on pixel centres and pixel corners, in a view with one pixel per unit; they extend
/// over `reach` pixels.
fn on_the_grid(seed: u64, size: f64, reach: f64) -> (Scene, Camera) {
    let mut numbers = Numbers(seed);
    let mut at = |extent: f64| (numbers.next() * 2.0 * extent as f32).floor() * 0.5;
    let (middle, room) = (0.5 * size as f32, size - reach);
    let mut positions = Vec::new();
    for i in 0..40 {
        let (x, y, z) = (at(room) - middle, at(room) - middle, -(i as f32) * 0.01);
        positions.extend([0; 3].map(|_| Vec3::new(x + at(reach), y + at(reach), z)));
    }
    let mesh = Mesh { positions, ..Mesh::default() };
    let scene =
        Scene { meshes: vec![mesh], instances: vec![scenes::instance(0)], ..Scene::default() };
    let camera = Camera {
        eye: DVec3::Z,
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: size },
        near: 0.5,
        far: 4.0,
    };
    (scene, camera)
}

#[test]
fn pixels_on_edges_belong_to_the_top_left_side() {
    for seed in 0..60 {
        for reach in [3.0, 4.5, 24.0] {
            let (scene, camera) = on_the_grid(seed, 24.0, reach);
            for samples in [Samples::One, Samples::Four] {
                let mut options = RenderOptions::new(camera);
                (options.width, options.height, options.samples) = (24, 24, samples);
                (options.item, options.depth) = (true, true);
                agrees_with_the_book(&scene, &options, &format!("seed {seed} {reach}"));
            }
        }
    }
}
