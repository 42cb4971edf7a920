//! The A-buffer: more accurate than samples, order-independent blending, bounded memory.

use crate::{data, scenes};
use durer::math::{DMat4, DVec3, Vec3, Vec4};
use durer::pipeline::{RenderOptions, Samples};
use durer::scene::{
    AlphaMode, Camera, Instance, Material, Mesh, Part, Projection, Scene, ShadingModel,
};
use durer::shade::{PreparedLights, color};
use durer::target::Framebuffer;
use durer::trace::Recorder;
use durer::view::View;
use durer::visibility::surface::SurfaceInput;
use durer::visibility::surface::TriangleFilter;
use durer::visibility::surface::a_buffer::{self, Options, Step, SubpixelMask};

const FILTER: TriangleFilter = TriangleFilter::new(durer::pipeline::Cull::None, 128);

fn flat(rgba: Vec4) -> Material {
    let alpha_mode = if rgba.w < 1.0 { AlphaMode::Blend } else { AlphaMode::Opaque };
    let model = ShadingModel::Unlit;
    Material { model, base_color: rgba, alpha_mode, ..Material::default() }
}

fn camera() -> Camera {
    scenes::options(&Scene::default(), 1, 1).camera
}

fn render(scene: &Scene, view: &View, options: &Options) -> (Framebuffer, Vec<Step>) {
    let input = SurfaceInput::new(scene, view, FILTER).expect("input");
    let lights = PreparedLights::of(scene, view.camera());
    let mut framebuffer = Framebuffer::new(view.width(), view.height());
    let mut steps = Recorder::default();
    a_buffer::render(&input, &lights, options, &mut framebuffer, &mut steps);
    assert_eq!(steps.dropped(), 0);
    (framebuffer, steps.into_steps())
}

/// Returns linear grey of each pixel of a scene in black and white.
fn linear(framebuffer: &Framebuffer) -> Vec<f64> {
    let of = |rgba: &[u8; 4]| f64::from(color::decode_srgb8(rgba[0]));
    framebuffer.color.data().iter().map(of).collect()
}

/// Returns the z-buffer's picture with `scale`² times 16 samples in each pixel.
fn sampled(scene: &Scene, camera: Camera, side: u32, scale: u32) -> Vec<f64> {
    let mut options = RenderOptions::new(camera);
    (options.width, options.height) = (side * scale, side * scale);
    options.samples = Samples::Sixteen;
    let (framebuffer, _) = durer::pipeline::render(scene, &options).expect("picture");
    let fine = linear(&framebuffer);
    let mut sums = vec![0.0; (side * side) as usize];
    for (i, value) in fine.iter().enumerate() {
        let (x, y) = (i as u32 % (side * scale), i as u32 / (side * scale));
        sums[(y / scale * side + x / scale) as usize] += value;
    }
    sums.iter().map(|sum| sum / f64::from(scale * scale)).collect()
}

/// Returns the mean absolute difference at the pixels where the truth is neither black nor white.
fn error_at_edges(found: &[f64], truth: &[f64]) -> f64 {
    let at_edges = |t: &f64| *t > 0.002 && *t < 0.998;
    let edges = truth.iter().filter(|t| at_edges(t)).count();
    assert!(edges > 100, "{edges} pixels at edges");
    let pairs = found.iter().zip(truth).filter(|(_, t)| at_edges(t));
    pairs.map(|(f, t)| (f - t).abs()).sum::<f64>() / edges as f64
}

/// Errors against 256 samples: mask 16, 16 samples, mask 64, 64 samples.
fn errors(scene: &Scene, camera: Camera, side: u32) -> [f64; 4] {
    let view = View::new(camera, side, side).expect("view");
    let truth = sampled(scene, camera, side, 4);
    let by_mask = |mask| {
        let options = Options { mask, ..Options::default() };
        error_at_edges(&linear(&render(scene, &view, &options).0), &truth)
    };
    let by_samples = |scale| error_at_edges(&sampled(scene, camera, side, scale), &truth);
    [by_mask(SubpixelMask::M16), by_samples(1), by_mask(SubpixelMask::M64), by_samples(2)]
}

fn assert_better(errors: [f64; 4], what: &str) {
    println!("{what}: mask 16, 16 samples, mask 64, 64 samples: {errors:.5?}");
    let [mask_16, samples_16, mask_64, samples_64] = errors;
    assert!(mask_16 < samples_16, "{what}: {errors:?}");
    assert!(mask_64 < samples_64, "{what}: {errors:?}");
}

/// Returns the scene with one black material on everything.
fn black(mut scene: Scene) -> Scene {
    scene.materials = vec![flat(Vec3::ZERO.extend(1.0))];
    for mesh in &mut scene.meshes {
        let range = 0..mesh.triangle_count() as u32;
        mesh.colors.clear();
        mesh.parts = vec![Part { range, material: Some(0), name: String::new() }];
    }
    scene
}

/// Returns intersecting spheres, alternately black and white.
fn spheres() -> Scene {
    let materials = [0.0, 1.0].map(|v| flat(Vec3::splat(v).extend(1.0))).to_vec();
    let mut scene = Scene { materials, ..Scene::default() };
    for i in 0..4 {
        scene.meshes.push(scenes::sphere(8, Some(i % 2)));
        let place = DVec3::new(0.7 * i as f64 - 1.0, 0.3 * (i % 3) as f64, 0.2 * i as f64);
        let world_from_mesh = DMat4::from_translation(place) * DMat4::from_rotation_z(i as f64);
        scene.instances.push(Instance { mesh: i, world_from_mesh, name: String::new() });
    }
    scene
}

#[test]
fn edges_are_closer_to_the_truth_than_by_as_many_samples() {
    for side in [90, 131] {
        assert_better(errors(&spheres(), camera(), side), "spheres");
        assert_better(errors(&black(scenes::soup(24, 3)), camera(), side), "soup");
    }
}

/// Returns a camera that sees all of a model.
fn around(scene: &Scene) -> Camera {
    let points = scene.instances.iter().flat_map(|i| {
        let place = |p: &Vec3| i.world_from_mesh.transform_point3(p.as_dvec3());
        scene.meshes[i.mesh].positions.iter().map(place)
    });
    let (lo, hi) =
        points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
    let (middle, size) = ((lo + hi) * 0.5, (hi - lo).length());
    let projection = Projection::Perspective { fov_y: 0.6 };
    let eye = middle + DVec3::new(0.9, 0.6, 1.3) * size;
    Camera { eye, target: middle, up: DVec3::Y, projection, near: 0.05 * size, far: 10.0 * size }
}

#[test]
fn conformance_edges_of_models_are_closer_to_the_truth_than_by_as_many_samples() {
    let Some(folder) = data::folder() else { return };
    for name in ["meshes/spot/spot_triangulated.obj", "meshes/benchy_parts/wheel.stl"] {
        let scene = black(data::read_model(&folder.join(name)).scene);
        assert_better(errors(&scene, around(&scene), 160), name);
    }
}

/// Returns panes one behind the other that fill the picture, in random order, and from far to near.
fn panes() -> (Scene, Vec<Vec4>) {
    let depths = [0.3, -1.0, 0.9, 0.0, -0.4];
    let colors: Vec<Vec4> = (0..5)
        .map(|i| Vec4::new(0.2 * i as f32, 1.0 - 0.2 * i as f32, 0.5, 0.25 + 0.12 * i as f32))
        .collect();
    let mut scene =
        Scene { materials: colors.iter().map(|&c| flat(c)).collect(), ..Scene::default() };
    for (i, &z) in depths.iter().enumerate() {
        let corner = |x: f32, y: f32| Vec3::new(x * 20.0, y * 20.0, z);
        let positions = vec![corner(-1., -1.), corner(3., -1.), corner(-1., 3.)];
        let parts = vec![Part { range: 0..1, material: Some(i), name: String::new() }];
        scene.meshes.push(Mesh { positions, parts, ..Mesh::default() });
        scene.instances.push(scenes::instance(i));
    }
    let mut order: Vec<usize> = (0..5).collect();
    order.sort_by(|&a, &b| depths[a].total_cmp(&depths[b]));
    let sorted = order.into_iter().map(|i| colors[i]).collect();
    (scene, sorted)
}

#[test]
fn blended_surfaces_are_composed_as_if_sorted() {
    let (scene, far_to_near) = panes();
    let eye = DVec3::new(0.4, 0.2, 4.0);
    let view = View::new(Camera { eye, ..camera() }, 40, 30).expect("view");
    let expected = far_to_near
        .iter()
        .fold(Vec4::ONE, |under, c| c.truncate().extend(1.0) * c.w + under * (1.0 - c.w));
    for mask in [SubpixelMask::M16, SubpixelMask::M64] {
        let (found, _) = render(&scene, &view, &Options { mask, ..Options::default() });
        for pixel in found.color.data() {
            for (found, expected) in pixel.iter().zip(color::encode_rgba8(expected)) {
                assert!(found.abs_diff(expected) <= 1, "{pixel:?} {expected}");
            }
        }
    }
}

/// Returns a scene of opaque and blended faces that intersect.
fn glass() -> Scene {
    let mut scene = spheres();
    scene.materials[1] = flat(Vec4::new(0.9, 0.4, 0.2, 0.4));
    scene
}

#[test]
fn a_low_limit_of_fragments_changes_no_pixel() {
    let view = View::new(camera(), 90, 70).expect("view");
    let (expected, whole) = render(&glass(), &view, &Options::default());
    let options = Options { max_fragments: 40, ..Options::default() };
    let (found, parts) = render(&glass(), &view, &options);
    assert!(found == expected);
    let rows = |steps: &[Step]| steps.iter().filter(|s| matches!(s, Step::Row { .. })).count();
    assert!(rows(&parts) > 2 * rows(&whole));
}

#[test]
fn the_picture_is_rebuilt_from_its_steps() {
    let scene = glass();
    let view = View::new(camera(), 90, 70).expect("view");
    let (found, steps) = render(&scene, &view, &Options::default());
    let per_sphere = scene.meshes[0].triangle_count() as u32;
    let color_of = |item: u32| scene.materials[(item / per_sphere) as usize % 2].base_color;
    let mut sums = vec![Vec4::ZERO; found.color.data().len()];
    let (mut row, mut blended) = (0, 0);
    for step in steps {
        let mut add = |x: i32, color: Vec4, share: f32| {
            sums[row as usize * 90 + x as usize] += color.truncate().extend(1.0) * share;
        };
        match step {
            Step::Row { y, .. } => row = y,
            Step::Fragment { mask, area, depths, .. } => {
                assert!(area > 0.0 && area <= 1.0 && mask <= 0xffff && depths[0] <= depths[1]);
            }
            Step::Share { x, item, share } => {
                blended += u32::from(color_of(item).w < 1.0);
                add(x, color_of(item), share);
            }
            Step::Background { x, share } => add(x, Vec4::ONE, share),
        }
    }
    assert!(blended > 500, "{blended}");
    for (pixel, sum) in found.color.data().iter().zip(sums) {
        assert!((sum.w - 1.0).abs() < 1e-4, "{sum}");
        for (found, expected) in pixel.iter().zip(color::encode_rgba8(sum)) {
            assert!(found.abs_diff(expected) <= 1, "{pixel:?} {sum}");
        }
    }
}

/// Checks that closed bodies have no gaps between their faces, and that no face shines through another.
#[test]
fn faces_that_meet_leave_no_gap() {
    let scene = black(Scene {
        meshes: vec![scenes::sphere(40, None)],
        instances: vec![scenes::instance(0)],
        ..Scene::default()
    });
    let view = View::new(camera(), 64, 64).expect("view");
    let (found, _) = render(&scene, &view, &Options::default());
    let mut black = 0;
    for y in 24..40 {
        for x in 24..40 {
            assert!(found.color.get(x, y) == Some([0, 0, 0, 255]), "{x} {y}");
            black += 1;
        }
    }
    assert_eq!(black, 256);
}

/// Returns a view of the plane z = 0, one pixel per unit, x to the right from the left border and y down from the upper
/// one; z = 0 is the far plane.
fn upright() -> View {
    let camera = Camera {
        eye: DVec3::new(4.0, -4.0, 10.0),
        target: DVec3::new(4.0, -4.0, 0.0),
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 8.0 },
        near: 1.0,
        far: 10.0,
    };
    View::new(camera, 8, 8).expect("view")
}

/// x, y and z.
type Corners = [(f32, f32, f32); 3];

/// Returns triangles, each in its own material.
fn faces(triangles: &[(Corners, Vec3)]) -> Scene {
    let mut scene = Scene::default();
    for (i, (corners, color)) in triangles.iter().enumerate() {
        scene.materials.push(flat(color.extend(1.0)));
        let positions = corners.map(|(x, y, z)| Vec3::new(x, -y, z)).to_vec();
        let parts = vec![Part { range: 0..1, material: Some(i), name: String::new() }];
        scene.meshes.push(Mesh { positions, parts, ..Mesh::default() });
        scene.instances.push(scenes::instance(i));
    }
    scene
}

/// Returns the linear grey of pixel (2, 3) by both masks.
fn grey(scene: &Scene) -> [f64; 2] {
    [SubpixelMask::M16, SubpixelMask::M64].map(|mask| {
        let options = Options { mask, ..Options::default() };
        linear(&render(scene, &upright(), &options).0)[3 * 8 + 2]
    })
}

/// Returns a triangle left of x = `border`, at a height.
fn left_of(border: f32, z: f32) -> Corners {
    [(border, -20.0, z), (border, 28.0, z), (border - 90.0, 4.0, z)]
}

#[test]
fn what_is_half_hidden_fills_what_the_front_leaves() {
    let far = [(-60.0, -60.0, 2.0), (90.0, -60.0, 2.0), (4.0, 90.0, 2.0)];
    for border in [2.3, 2.45, 2.55, 2.7] {
        let scene = faces(&[(left_of(border, 4.0), Vec3::ONE), (far, Vec3::ZERO)]);
        for found in grey(&scene) {
            let expected = f64::from(border) - 2.0;
            assert!((found - expected).abs() < 0.006, "{found} for {expected}");
        }
    }
}

#[test]
fn a_sliver_between_sub_pixels_is_hidden_by_what_is_in_front() {
    // Between the sample positions of both masks; 3/16 and 5/16 are the nearest ones.
    let sliver = [(2.2, 3.2, 2.0), (2.3, 3.2, 2.0), (2.25, 3.3, 2.0)];
    let by = |front: Option<f32>, color: Vec3| {
        let sliver = (sliver, Vec3::ZERO);
        let front = front.map(|z| (left_of(2.5, z), color));
        grey(&faces(&front.into_iter().chain([sliver]).collect::<Vec<_>>()))
    };
    let alone = by(None, Vec3::ONE);
    assert!(alone.iter().all(|g| (g - 0.995).abs() < 0.006), "{alone:?}");
    assert_eq!(by(Some(4.0), Vec3::ONE), [1.0; 2]);
    assert_eq!(by(Some(1.0), Vec3::ONE), alone);
}

#[test]
fn a_face_ends_at_the_far_plane_within_a_pixel() {
    for border in [2.2, 2.45, 2.8] {
        // Nearer than the far plane only left of the border.
        let steep =
            [(border - 8.0, -60.0, 8.0), (border + 8.0, 4.0, -8.0), (border - 8.0, 68.0, 8.0)];
        for (found, step) in grey(&faces(&[(steep, Vec3::ZERO)])).into_iter().zip([4.0, 8.0]) {
            let expected = 1.0 - (f64::from(border) - 2.0);
            assert!((found - expected).abs() <= 0.5 / step, "{found} for {expected}");
        }
    }
}
