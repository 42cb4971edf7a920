//! All visible-surface methods: the same scene gives the same picture.

use crate::scenes;
use durer::math::{DMat4, DVec3, Vec3};
use durer::scene::{Camera, Instance, Mesh, Projection, Scene};
use durer::shade::PreparedLights;
use durer::target::Framebuffer;
use durer::trace::{NoTrace, Recorder};
use durer::view::View;
use durer::visibility::surface::SurfaceInput;
use durer::visibility::surface::TriangleFilter;
use durer::visibility::surface::{Options, SurfaceMethod, render_with};
use durer::visibility::surface::{scan_line_z, spanning_scan_line};

fn mesh_scene(positions: Vec<Vec3>) -> Scene {
    let mesh = Mesh { positions, ..Mesh::default() };
    Scene { meshes: vec![mesh], instances: vec![scenes::instance(0)], ..Scene::default() }
}

/// Returns three cyclically overlapping beams.
fn cyclic() -> Scene {
    let mut positions = Vec::new();
    for i in 0..3 {
        let angle = f64::from(i) * std::f64::consts::TAU / 3.0;
        let turn = DMat4::from_rotation_z(angle);
        let corner = |x: f64, y: f64, z: f64| turn.transform_point3(DVec3::new(x, y, z)).as_vec3();
        let [a, b] = [corner(-1.5, 0.4, -0.4), corner(-1.5, 0.7, -0.4)];
        let [c, d] = [corner(1.5, 0.4, 0.4), corner(1.5, 0.7, 0.4)];
        positions.extend([a, c, b, b, c, d]);
    }
    mesh_scene(positions)
}

/// Returns faces that share edges, planes and depths: three parallel squares twice, crossed by one.
fn ties() -> Scene {
    let mut positions = Vec::new();
    for z in [0.0, 0.0, 0.25, 0.25, -0.5] {
        let corner = |x: f32, y: f32| Vec3::new(x + z, y, z);
        let [a, b, c, d] = [corner(-1., -1.), corner(1., -1.), corner(1., 1.), corner(-1., 1.)];
        positions.extend([a, b, c, a, c, d]);
    }
    let [a, b] = [Vec3::new(0.1, -1.2, 2.0), Vec3::new(0.1, 1.2, 2.0)];
    let [c, d] = [Vec3::new(-0.2, -1.2, -2.0), Vec3::new(-0.2, 1.2, -2.0)];
    positions.extend([a, b, c, b, d, c]);
    mesh_scene(positions)
}

/// Returns the random scene with this number.
fn random_scene(seed: u64) -> Scene {
    match seed % 10 {
        8 => cyclic(),
        9 => ties(),
        n => scenes::soup(3 + 9 * n as usize, seed),
    }
}

/// Returns a camera around or sometimes inside the scene, and a size from 1 × 1 to 256².
fn random_view(seed: u64) -> View {
    let mut numbers = scenes::Numbers(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    for _ in 0..3 {
        numbers.next();
    }
    let eye = numbers.point(3.0).as_dvec3() + DVec3::splat(1e-3);
    let projection = if seed.is_multiple_of(3) {
        Projection::Orthographic { height: 1.0 + 4.0 * f64::from(numbers.next()) }
    } else {
        Projection::Perspective { fov_y: 0.3 + 1.5 * f64::from(numbers.next()) }
    };
    let camera =
        Camera { eye, target: DVec3::ZERO, up: DVec3::Y, projection, near: 0.05, far: 5.0 };
    let mut side = || match seed % 16 {
        0 => 1,
        1 => 256,
        _ => 1 + (numbers.next() * numbers.next() * 140.0) as u32,
    };
    let (width, height) = (side(), side());
    View::new(camera, width, height).expect("view")
}

/// Returns a view in which parts of the scene are behind the eye.
fn amid(width: u32, height: u32) -> View {
    let camera = scenes::options(&Scene::default(), 1, 1).camera;
    View::new(camera, width, height).expect("view")
}

const FILTER: TriangleFilter = TriangleFilter::new(durer::pipeline::Cull::None, 128);

fn planes(view: &View) -> Framebuffer {
    Framebuffer::new(view.width(), view.height()).with_depth().with_items().with_normals()
}

fn picture(method: SurfaceMethod, scene: &Scene, view: &View) -> Framebuffer {
    let input = SurfaceInput::new(scene, view, FILTER).expect("input");
    let lights = PreparedLights::of(scene, view.camera());
    let mut framebuffer = planes(view);
    let options = Options::default();
    render_with(method, &input, &lights, &options, &mut framebuffer, &mut NoTrace)
        .expect("picture");
    framebuffer
}

/// Returns whether a method shows one surface per pixel, so that colours equal the z-buffer's too.
fn one_surface_per_pixel(method: SurfaceMethod) -> bool {
    use SurfaceMethod::{ScanLineZ, SpanningScanLine, ZBuffer};
    matches!(method, ZBuffer | ScanLineZ | SpanningScanLine)
}

fn assert_same(method: SurfaceMethod, found: &Framebuffer, expected: &Framebuffer, what: &str) {
    let differ = |f: &Framebuffer| f.item.as_ref().map(|p| p.data().to_vec());
    assert!(differ(found) == differ(expected), "{method} {what}: items");
    assert!(found.depth == expected.depth, "{method} {what}: depths");
    assert!(found.normal == expected.normal, "{method} {what}: normals");
    if one_surface_per_pixel(method) {
        assert!(found.color == expected.color, "{method} {what}: colours");
    }
}

#[test]
fn all_methods_agree_with_the_z_buffer_on_random_scenes() {
    for seed in 0..320 {
        let (scene, view) = (random_scene(seed), random_view(seed));
        let expected = picture(SurfaceMethod::ZBuffer, &scene, &view);
        for &method in SurfaceMethod::ALL {
            let found = picture(method, &scene, &view);
            assert_same(method, &found, &expected, &format!("seed {seed}"));
        }
    }
}

/// Checks the z-buffer's faster lighting of front faces, sixteen pixels at a time: spheres whose normals agree with
/// their faces, point away, are missing, or are mixed, from all sides.
#[test]
fn colours_of_curved_surfaces_are_those_of_other_methods() {
    for seed in 0..48_u64 {
        let mut numbers = scenes::Numbers(seed);
        // The finest have faces smaller than a pixel.
        let mut mesh = scenes::sphere([5, 17, 41, 160][seed as usize / 6 % 4], None);
        for (i, normal) in mesh.normals.iter_mut().enumerate() {
            match (seed % 6, i % 5) {
                (1, _) => *normal = -*normal,
                (2, 0) => *normal = Vec3::ZERO,
                (3, 0) => *normal = numbers.point(1.0),
                (4, 1) => *normal *= 1e-9,
                (5, 2) => *normal = Vec3::NAN,
                _ => {}
            }
        }
        let mut scene = Scene { meshes: vec![mesh], ..Scene::default() };
        scene.instances = vec![scenes::instance(0)];
        let view = random_view(seed + 1000);
        let expected = picture(SurfaceMethod::ScanLineZ, &scene, &view);
        let found = picture(SurfaceMethod::ZBuffer, &scene, &view);
        assert_same(SurfaceMethod::ZBuffer, &found, &expected, &format!("seed {seed}"));
    }
}

/// Checks faces in one plane perpendicular to the view: all depths are equal, and where they overlap the lowest item
/// must win, whatever its size and position in the order.
#[test]
fn of_equally_deep_faces_the_lowest_item_is_seen() {
    let eye = DVec3::Z * 2.0;
    let projection = Projection::Orthographic { height: 2.0 };
    let camera = Camera { eye, target: DVec3::ZERO, up: DVec3::Y, projection, near: 1.0, far: 3.0 };
    let view = View::new(camera, 48, 40).expect("view");
    for seed in 0..6 {
        let mut numbers = scenes::Numbers(seed);
        let mut positions = Vec::new();
        for _ in 0..30 {
            let center = numbers.point(1.0).with_z(0.0);
            let half = 0.1 + 0.9 * numbers.next();
            let [a, b, c, d] = [(-1., -1.), (1., -1.), (1., 1.), (-1., 1.)]
                .map(|(x, y)| center + half * Vec3::new(x, y, 0.0));
            positions.extend([a, b, c, a, c, d]);
        }
        let scene = mesh_scene(positions);
        let expected = picture(SurfaceMethod::ZBuffer, &scene, &view);
        let items = expected.item.as_ref().expect("items");
        for (y, x) in (0..40).flat_map(|y| (0..48).map(move |x| (y, x))) {
            let at = DVec3::new((x as f64 + 0.5) / 20.0 - 1.2, 1.0 - (y as f64 + 0.5) / 20.0, 0.0);
            let inside = |t: &[Vec3]| {
                let [a, b, c] = [t[0], t[1], t[2]].map(Vec3::as_dvec3);
                [(a, b), (b, c), (c, a)].into_iter().all(|(p, q)| (q - p).cross(at - p).z > 1e-2)
            };
            let triangles = scene.meshes[0].positions.chunks(3);
            let lowest = triangles.enumerate().find(|(_, t)| inside(t));
            if let (Some((lowest, _)), Some(seen)) = (lowest, items.get(x, y)) {
                // Nearer to an edge than can be distinguished here, a lower one may be visible.
                assert!(seen as usize <= lowest, "seed {seed} at {x},{y}: {seen} {lowest}");
            }
        }
        for &method in SurfaceMethod::ALL {
            let found = picture(method, &scene, &view);
            assert_same(method, &found, &expected, &format!("seed {seed}"));
        }
    }
}

#[test]
fn masked_and_textured_surfaces_lines_and_points_agree_too() {
    let scene = scenes::materials();
    for (width, height) in [(150, 130), (33, 70)] {
        let view = amid(width, height);
        let expected = picture(SurfaceMethod::ZBuffer, &scene, &view);
        for &method in SurfaceMethod::ALL {
            let mut found = picture(method, &scene, &view);
            // The z-buffer's colours are blended, those of the others are not.
            found.color = expected.color.clone();
            assert_same(method, &found, &expected, "materials");
        }
    }
}

/// Returns the same triangles in another order, and the original number of each.
fn shuffled(scene: &Scene, seed: u64) -> (Scene, Vec<u32>) {
    let mut numbers = scenes::Numbers(seed);
    let triangles: Vec<[Vec3; 3]> = scene.meshes[0].positions.as_chunks().0.to_vec();
    let mut from: Vec<u32> = (0..triangles.len() as u32).collect();
    for i in (1..from.len()).rev() {
        from.swap(i, (numbers.next() * (i + 1) as f32) as usize);
    }
    let positions = from.iter().flat_map(|&i| triangles[i as usize]).collect();
    (mesh_scene(positions), from)
}

#[test]
fn the_order_of_triangles_changes_nothing() {
    for seed in 0..24 {
        let (scene, view) = (scenes::soup(40, seed), random_view(seed));
        let (other, from) = shuffled(&scene, seed);
        for &method in SurfaceMethod::ALL {
            let a = picture(method, &scene, &view);
            let b = picture(method, &other, &view);
            assert!(a.depth == b.depth && a.color == b.color, "{method} seed {seed}");
            let items = |f: &Framebuffer| f.item.clone().expect("items").into_data();
            let back: Vec<u32> =
                items(&b).iter().map(|&i| *from.get(i as usize).unwrap_or(&i)).collect();
            assert_eq!(items(&a), back, "{method} seed {seed}");
        }
    }
}

/// Returns a scene with two instances of one mesh, so that runs change within rows.
fn two_instances() -> Scene {
    let mut scene = scenes::soup(170, 4);
    let world_from_mesh = DMat4::from_rotation_y(0.7);
    scene.instances.push(Instance { mesh: 0, world_from_mesh, name: String::new() });
    scene
}

#[test]
fn tracing_changes_no_picture() {
    let scene = two_instances();
    let view = random_view(7);
    let input = SurfaceInput::new(&scene, &view, FILTER).expect("input");
    let lights = PreparedLights::of(&scene, view.camera());
    for &method in SurfaceMethod::ALL {
        let mut traced = planes(&view);
        let mut steps = Recorder::with_cap(1000);
        let options = Options::default();
        render_with(method, &input, &lights, &options, &mut traced, &mut steps).expect("picture");
        assert!(traced == picture(method, &scene, &view), "{method}");
        assert_eq!(steps.steps().is_empty(), method == SurfaceMethod::ZBuffer, "{method}");
    }
}

/// Depths and items from writes to a row.
#[test]
fn scan_line_z_is_rebuilt_from_its_steps() {
    let scene = two_instances();
    let view = random_view(7);
    let input = SurfaceInput::new(&scene, &view, FILTER).expect("input");
    let lights = PreparedLights::of(&scene, view.camera());
    let (mut found, mut rebuilt) = (planes(&view), planes(&view));
    let mut steps = Recorder::default();
    let options = scan_line_z::Options::default();
    scan_line_z::render(&input, &lights, &options, &mut found, &mut steps);
    let mut row = 0;
    for step in steps.steps() {
        match *step {
            scan_line_z::Step::Row { y } => row = y as u32,
            scan_line_z::Step::Write { item, x, depth } => {
                rebuilt.item.as_mut().expect("items").set(x as u32, row, item);
                rebuilt.depth.as_mut().expect("depths").set(x as u32, row, depth);
            }
            _ => {}
        }
    }
    assert!(rebuilt.item == found.item && rebuilt.depth == found.depth);
    assert_eq!(steps.dropped(), 0);
}

/// Items from spans and from writes to a row.
#[test]
fn spanning_scan_line_is_rebuilt_from_its_steps() {
    use spanning_scan_line::Step;
    let scene = two_instances();
    let view = amid(120, 90);
    let input = SurfaceInput::new(&scene, &view, FILTER).expect("input");
    let lights = PreparedLights::of(&scene, view.camera());
    let (mut found, mut rebuilt) = (planes(&view), planes(&view));
    let mut steps = Recorder::default();
    let options = spanning_scan_line::Options::default();
    spanning_scan_line::render(&input, &lights, &options, &mut found, &mut steps);
    let items = rebuilt.item.as_mut().expect("items");
    let (mut row, mut spans, mut splits, mut inside) = (0, 0, 0, 0);
    for step in steps.steps() {
        match *step {
            Step::Row { y } => row = y as u32,
            Step::In { .. } => inside += 1,
            Step::Out { .. } => inside -= 1,
            Step::Span { item, x0, x1, .. } => {
                spans += 1;
                (x0..x1).for_each(|x| items.set(x as u32, row, item));
            }
            Step::Split { .. } => splits += 1,
            Step::Write { item, x } => items.set(x as u32, row, item),
        }
        assert!(inside >= 0);
    }
    assert!(rebuilt.item == found.item);
    assert!(spans > 100 && splits > 10 && inside == 0, "{spans} {splits} {inside}");
}

/// Checks that spans decide nearly all pixels if faces do not intersect.
#[test]
fn spanning_scan_line_compares_few_pixels() {
    use spanning_scan_line::Step;
    let (scene, view) = (cyclic(), amid(200, 200));
    let input = SurfaceInput::new(&scene, &view, FILTER).expect("input");
    let lights = PreparedLights::of(&scene, view.camera());
    let mut steps = Recorder::default();
    let options = spanning_scan_line::Options::default();
    spanning_scan_line::render(&input, &lights, &options, &mut planes(&view), &mut steps);
    let (mut by_span, mut one_by_one) = (0, 0);
    for step in steps.steps() {
        match *step {
            Step::Span { x0, x1, .. } => by_span += x1 - x0,
            Step::Write { .. } => one_by_one += 1,
            _ => {}
        }
    }
    assert!(by_span > 10 * one_by_one && one_by_one > 0, "{by_span} {one_by_one}");
}
