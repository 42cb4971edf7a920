//! The surroundings of a model and their shading: occlusion, ground, grid, axes, edges.

use crate::scenes::{instance, sphere};
use durer::math::{DMat4, DVec2, DVec3, Rect, Vec3, Vec4};
use durer::pipeline::{
    EdgeStyle, RenderOptions, Samples, add_axes, add_grid, add_ground, draw_edges, render,
};
use durer::scene::{
    AlphaMode, Camera, Material, Mesh, Projection, Scene, ShadingModel, Topology, UpAxis,
};
use durer::view::View;
use durer::view::projection::drawn_bounds;
use durer::visibility::surface::ambient_occlusion;

/// Returns two walls at a right angle in the line x = z = 0, one along +x, one along +z.
fn corner() -> Scene {
    let quad = |a: [f32; 3], b: [f32; 3]| {
        let [a, b] = [Vec3::from(a), Vec3::from(b)];
        let up = Vec3::Y * 4.0;
        vec![a - up, b - up, b + up, a - up, b + up, a + up]
    };
    let positions = [quad([0.; 3], [8., 0., 0.]), quad([0., 0., 8.], [0.; 3])].concat();
    let mesh = Mesh { positions, ..Mesh::default() };
    Scene { meshes: vec![mesh], instances: vec![instance(0)], ..Scene::default() }
}

fn parallel(eye: DVec3, height: f64) -> Camera {
    let projection = Projection::Orthographic { height };
    Camera { eye, target: DVec3::ZERO, up: DVec3::Y, projection, near: 1.0, far: 40.0 }
}

fn options(camera: Camera, side: u32) -> RenderOptions {
    let samples = Samples::One;
    RenderOptions { width: side, height: side, samples, ..RenderOptions::new(camera) }
}

/// Returns the light at a position in the corner.
fn light(camera: Camera, radius: f64, at: DVec3) -> f32 {
    let options = RenderOptions { depth: true, normal: true, ..options(camera, 240) };
    let (picture, _) = render(&corner(), &options).expect("picture");
    let view = View::new(camera, 240, 240).expect("view");
    let (depth, normal) = (picture.depth.expect("depth"), picture.normal.expect("normals"));
    let light = ambient_occlusion::occlusion(&view, &depth, &normal, radius, options.level);
    let p = view.screen_from_world() * at.extend(1.0);
    light.get((p.x / p.w) as u32, (p.y / p.w) as u32).expect("pixel")
}

#[test]
fn half_of_the_light_gets_into_a_corner_and_all_onto_a_wall() {
    let projection = Projection::Perspective { fov_y: 0.5 };
    let eye = DVec3::new(10.0, 0.0, 10.0);
    let parallel = parallel(eye, 8.0);
    let perspective = Camera { projection, ..parallel };
    for camera in [parallel, perspective] {
        // At the edge of an infinite corner half of the hemisphere is visible, weighted by the cosine.
        let near = light(camera, 3.0, DVec3::new(0.06, 0.0, 0.0));
        assert!((0.45..0.62).contains(&near), "{near}");
        let between = light(camera, 1.0, DVec3::new(0.4, 0.0, 0.0));
        assert!((0.6..0.97).contains(&between), "{between}");
        let far = light(camera, 0.5, DVec3::new(1.5, 0.0, 0.0));
        assert!(far > 0.985, "{far}");
    }
}

#[test]
fn occlusion_darkens_and_leaves_no_planes_that_are_not_requested() {
    let plain = options(parallel(DVec3::new(10.0, 1.0, 10.0), 8.0), 100);
    let occlusion = ambient_occlusion::Options { radius: 1.0, strength: 1.0 };
    let dark = RenderOptions { ambient_occlusion: Some(occlusion), ..plain.clone() };
    let (before, after) =
        (render(&corner(), &plain).expect("before").0, render(&corner(), &dark).expect("after").0);
    assert!(after.depth.is_none() && after.normal.is_none());
    let pairs = || before.color.data().iter().zip(after.color.data());
    assert!(pairs().all(|(a, b)| b[0] <= a[0]));
    assert!(pairs().any(|(a, b)| a[0].abs_diff(b[0]) > 20));
    let occlusion = ambient_occlusion::Options { strength: 0.0, ..occlusion };
    let none = RenderOptions { ambient_occlusion: Some(occlusion), ..plain };
    assert!(render(&corner(), &none).expect("none").0.color == before.color);
}

/// Returns a sphere of radius 1 whose lowest point is at height −1.
fn ball(up_axis: UpAxis) -> Scene {
    Scene {
        meshes: vec![sphere(12, Some(0))],
        instances: vec![instance(0)],
        materials: vec![Material::default()],
        up_axis,
        ..Scene::default()
    }
}

#[test]
fn the_ground_is_dark_below_the_model_and_clear_far_away() {
    for (up_axis, up) in [(UpAxis::Y, DVec3::Y), (UpAxis::Z, DVec3::Z)] {
        let mut scene = ball(up_axis);
        // A second ball, high up and to the side, casts no contact shadow.
        scene.instances.push(instance(0));
        let aside = if up_axis == UpAxis::Y { DVec3::Z } else { DVec3::Y };
        scene.instances[1].world_from_mesh = DMat4::from_translation(up * 1.5 + aside * 2.5);
        let model = scene.clone();
        let bounds = drawn_bounds(&model).expect("bounds");
        add_ground(&mut scene, &model, &bounds).expect("ground");
        scene.check().expect("a scene");
        let ground = &scene.materials[scene.materials.len() - 1];
        assert_eq!(ground.alpha_mode, AlphaMode::Blend);
        // The floor alone, from above.
        scene.instances.drain(..2);
        let camera =
            Camera { eye: up * 8.0, target: DVec3::ZERO, up: aside, ..parallel(DVec3::ZERO, 8.0) };
        let (picture, _) = render(&scene, &options(camera, 80)).expect("picture");
        let at = |p: DVec3| {
            let view = View::new(camera, 80, 80).expect("view");
            let p = view.screen_from_world() * p.extend(1.0);
            picture.color.get((p.x / p.w) as u32, (p.y / p.w) as u32).expect("pixel")[0]
        };
        let (below, high, far) = (at(DVec3::ZERO), at(aside * 2.5), at(-aside * 3.5));
        assert!(below < 200 && high > 250 && far > 250, "{below} {high} {far}");
        // From below nothing hides the model.
        let from_below = Camera { eye: up * -8.0, ..camera };
        let seen =
            RenderOptions { cull: durer::pipeline::Cull::Material, ..options(from_below, 80) };
        let (picture, _) = render(&scene, &seen).expect("picture");
        assert!(picture.color.data().iter().all(|c| *c == [255; 4]));
    }
}

#[test]
fn a_grid_lies_on_the_floor_and_axes_begin_at_the_origin() {
    let mut scene = ball(UpAxis::Y);
    let bounds = drawn_bounds(&scene).expect("bounds");
    add_grid(&mut scene, &bounds);
    add_axes(&mut scene, &bounds);
    scene.check().expect("a scene");
    let lines: Vec<_> = scene
        .instances
        .iter()
        .filter(|i| scene.meshes[i.mesh].topology == Topology::Lines)
        .map(|i| {
            let p = &scene.meshes[i.mesh].positions;
            p.iter().map(|p| i.world_from_mesh.transform_point3(p.as_dvec3())).collect::<Vec<_>>()
        })
        .collect();
    // Cells of 0.2 from −1.2 to 1.2, 13 lines each way.
    assert_eq!(lines[0].len(), 2 * 26);
    assert!(lines[0].iter().all(|p| (p.y + 1.0).abs() < 1e-6 && p.x.abs() < 1.2 + 1e-6));
    for (line, axis) in lines[1..].iter().zip([DVec3::X, DVec3::Y, DVec3::Z]) {
        assert!((line[0] - DVec3::ZERO).length() + (line[1] - axis * 1.2).length() < 1e-6);
    }
}

#[test]
fn edges_are_where_outlines_are() {
    let camera = Camera { eye: DVec3::new(0.0, 0.0, 9.0), ..parallel(DVec3::ZERO, 4.0) };
    let mut scene = ball(UpAxis::Y);
    let white =
        Material { model: ShadingModel::Unlit, base_color: Vec4::ONE, ..Material::default() };
    scene.materials = vec![white];
    scene.meshes = vec![sphere(60, Some(0))];
    // Its seam is open by a rounding error, at the back.
    scene.instances[0].world_from_mesh = DMat4::from_rotation_y(std::f64::consts::PI);
    let options = RenderOptions { height: 100, ..options(camera, 200) };
    let (mut picture, _) = render(&scene, &options).expect("picture");
    draw_edges(&scene, &options, &EdgeStyle::default(), &mut picture).expect("edges");
    let middle = DVec2::new(100.0, 50.0);
    let around = Rect::new(DVec2::ZERO, DVec2::new(200.0, 100.0)).expect("window");
    let mut dark = 0;
    for (x, y) in (0..100).flat_map(|y| (0..200).map(move |x| (x, y))) {
        let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        if picture.color.get(x, y).expect("pixel")[0] < 128 {
            dark += 1;
            assert!(((p - middle).length() - 25.0).abs() < 2.5 && around.contains(p), "{p}");
        }
    }
    // 1.5 pixels wide, all around.
    assert!((150..320).contains(&dark), "{dark}");
}
