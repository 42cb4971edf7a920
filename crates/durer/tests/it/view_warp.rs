//! Pictures warped from others, compared with rendered ones.

use crate::scenes::sphere;
use durer::math::{DMat4, DVec3, Vec3, Vec4};
use durer::pipeline::{RenderOptions, Samples, render};
use durer::scene::{Camera, Instance, Material, Mesh, Part, Projection, Scene, ShadingModel};
use durer::target::{Framebuffer, Pixels};
use durer::trace::{NoTrace, Recorder};
use durer::view::warp::{DepthPicture, HOLE, Options, Step, Warped, warp};

const SIDE: u32 = 120;

/// Returns a sphere in front of a wall, each in one colour.
fn scene() -> Scene {
    let color = |r, g, b| Material {
        model: ShadingModel::Unlit,
        base_color: Vec4::new(r, g, b, 1.0),
        ..Material::default()
    };
    let corner = |x: f32, y: f32| Vec3::new(x * 8.0, y * 8.0, -1.5);
    let positions = vec![corner(-1., -1.), corner(1., -1.), corner(1., 1.), corner(-1., 1.)];
    let wall = Mesh {
        positions,
        indices: Some(vec![0, 1, 2, 0, 2, 3]),
        parts: vec![Part { range: 0..2, material: Some(1), name: String::new() }],
        ..Mesh::default()
    };
    let place = |mesh| Instance { mesh, world_from_mesh: DMat4::IDENTITY, name: String::new() };
    Scene {
        meshes: vec![sphere(24, Some(0)), wall],
        instances: vec![place(0), place(1)],
        materials: vec![color(0.8, 0.1, 0.1), color(0.1, 0.2, 0.7)],
        ..Scene::default()
    }
}

fn camera(eye: DVec3, parallel: bool) -> Camera {
    let projection = match parallel {
        true => Projection::Orthographic { height: 4.0 },
        false => Projection::Perspective { fov_y: 0.7 },
    };
    Camera { eye, target: DVec3::ZERO, up: DVec3::Y, projection, near: 3.0, far: 9.0 }
}

fn picture(camera: Camera) -> Framebuffer {
    let options =
        RenderOptions { samples: Samples::One, depth: true, ..RenderOptions::new(camera) };
    let options = RenderOptions { width: SIDE, height: SIDE, ..options };
    render(&scene(), &options).expect("picture").0
}

fn source(picture: &Framebuffer, camera: Camera) -> DepthPicture<'_> {
    DepthPicture { color: &picture.color, depth: picture.depth.as_ref().expect("depth"), camera }
}

fn warped(pictures: &[(Framebuffer, Camera)], to: &Camera) -> Warped {
    let sources: Vec<_> = pictures.iter().map(|(p, c)| source(p, *c)).collect();
    warp(&sources, to, [SIDE; 2], &Options::default(), &mut NoTrace).expect("warped")
}

/// Returns the pixels that are not holes but have the wrong colour.
fn wrong(found: &Warped, expected: &Framebuffer) -> usize {
    let pairs = found.framebuffer.color.data().iter().zip(expected.color.data());
    let shown = found.source.data().iter().map(|&s| s != HOLE);
    pairs.zip(shown).filter(|((a, b), shown)| *shown && a != b).count()
}

#[test]
fn a_near_camera_sees_what_it_would_see() {
    for parallel in [false, true] {
        let from = camera(DVec3::new(0.0, 0.0, 5.0), parallel);
        let pictures = [(picture(from), from)];
        for eye in
            [DVec3::new(0.5, 0.2, 5.0), DVec3::new(-0.4, 0.0, 4.6), DVec3::new(0.0, 0.6, 5.3)]
        {
            let to = camera(eye, parallel);
            let (found, expected) = (warped(&pictures, &to), picture(to));
            // Only the outline of the sphere, of about 220 pixels, may be off by a pixel.
            let wrong = wrong(&found, &expected);
            assert!(wrong < 110, "{eye} {parallel}: {wrong} wrong");
            assert!(found.holes > 20 && found.holes < 3000, "{eye}: {} holes", found.holes);
            let depths = found.framebuffer.depth.as_ref().expect("depth");
            let right = expected.depth.as_ref().expect("depth");
            let middle = (SIDE / 2, SIDE / 2);
            let [a, b] = [depths, right].map(|d| d.get(middle.0, middle.1).expect("pixel"));
            assert!((a - b).abs() < 2e-3, "{a} {b}");
        }
    }
}

#[test]
fn the_same_camera_gives_the_same_picture() {
    let from = camera(DVec3::new(0.3, 0.1, 5.0), false);
    let pictures = [(picture(from), from)];
    let found = warped(&pictures, &from);
    assert_eq!(found.holes, 0);
    assert!(wrong(&found, &pictures[0].0) < 60, "{}", wrong(&found, &pictures[0].0));
}

#[test]
fn a_second_picture_fills_holes() {
    let eyes = [DVec3::new(-0.6, 0.0, 5.0), DVec3::new(0.9, 0.0, 5.0)];
    let pictures = eyes.map(|eye| {
        let camera = camera(eye, false);
        (picture(camera), camera)
    });
    let to = camera(DVec3::new(0.3, 0.0, 5.0), false);
    let (one, both) = (warped(&pictures[..1], &to), warped(&pictures, &to));
    assert!(both.holes * 4 < one.holes, "{} of {}", both.holes, one.holes);
    assert!(wrong(&both, &picture(to)) < 150);
    let magenta =
        both.framebuffer.color.data().iter().filter(|c| **c == [255, 0, 255, 255]).count();
    assert_eq!(magenta as u64, both.holes);
}

/// Returns a red square on an empty background; the pixels at its outline are `mixed`.
fn square(mixed: [u8; 4]) -> (Pixels<[u8; 4]>, Pixels<f32>) {
    let (mut color, mut depth) = (Pixels::new(SIDE, SIDE, [255; 4]), Pixels::new(SIDE, SIDE, 1.0));
    for (x, y) in (40..80).flat_map(|y| (40..80).map(move |x| (x, y))) {
        color.set(x, y, [200, 0, 0, 255]);
        depth.set(x, y, 0.6);
    }
    for i in 39..=80 {
        // Half of the mixed pixels have the depth of the square, half that of the background.
        for (x, y) in [(39, i), (79, i), (i, 39), (i, 79)] {
            color.set(x, y, mixed);
        }
    }
    (color, depth)
}

#[test]
fn nothing_is_no_wall() {
    let (color, depth) = square([200, 0, 0, 255]);
    let from = camera(DVec3::new(0.0, 0.0, 5.0), false);
    let source = DepthPicture { color: &color, depth: &depth, camera: from };
    let to = DVec3::new(0.8, 0.0, 0.0);
    let to = Camera { target: to, ..camera(to + DVec3::new(0.0, 0.0, 5.0), false) };
    let found = warp(&[source], &to, [SIDE; 2], &Options::default(), &mut NoTrace).expect("view");
    // A camera that is moved, not turned, keeps the background in place: only the area that the square hid is a hole,
    // and no border of the picture.
    let border = (0..SIDE).flat_map(|i| [(0, i), (SIDE - 1, i), (i, 0), (i, SIDE - 1)]);
    for (x, y) in border {
        assert_eq!(found.framebuffer.color.get(x, y), Some([255; 4]), "{x} {y}");
    }
    assert!(found.holes > 0 && found.holes < 42 * 42, "{}", found.holes);
    // Pixels without a surface in one picture may have one in another.
    let far = Pixels::new(SIDE, SIDE, 0.9);
    let green = Pixels::new(SIDE, SIDE, [0, 200, 0, 255]);
    let second = DepthPicture { color: &green, depth: &far, camera: to };
    let both = [source, second];
    let found = warp(&both, &to, [SIDE; 2], &Options::default(), &mut NoTrace).expect("view");
    assert_eq!(found.framebuffer.color.get(2, 2), Some([0, 200, 0, 255]));
    assert_eq!(found.holes, 0);
}

#[test]
fn smoothed_outlines_leave_no_ghosts() {
    let (color, depth) = square([228, 128, 128, 255]);
    let from = camera(DVec3::new(0.0, 0.0, 5.0), false);
    let source = DepthPicture { color: &color, depth: &depth, camera: from };
    for x in [0.0, 0.7, -0.4] {
        let to = camera(DVec3::new(x, 0.0, 5.0), false);
        let found =
            warp(&[source], &to, [SIDE; 2], &Options::default(), &mut NoTrace).expect("view");
        let mixed = found.framebuffer.color.data().iter().filter(|c| c[1] == 128).count();
        // The corners have mixed neighbours too.
        assert!(mixed <= 8, "{x}: {mixed}");
    }
}

#[test]
fn the_view_is_rebuilt_from_its_steps_and_listening_changes_nothing() {
    let from = camera(DVec3::new(0.0, 0.0, 5.0), false);
    let (picture, to) = (picture(from), camera(DVec3::new(0.5, 0.2, 5.0), false));
    let (mut steps, options) = (Recorder::default(), Options::default());
    let sources = [source(&picture, from)];
    let found = warp(&sources, &to, [SIDE; 2], &options, &mut steps).expect("warped");
    assert_eq!(steps.dropped(), 0);
    let mut rebuilt = Pixels::new(SIDE, SIDE, options.hole);
    let mut latest = options.hole;
    for step in steps.steps() {
        match *step {
            Step::Move { color, .. } => latest = color,
            Step::Write { at: [x, y] } => rebuilt.set(x, y, latest),
        }
    }
    assert!(rebuilt == found.framebuffer.color);
    assert!(found == warp(&sources, &to, [SIDE; 2], &options, &mut NoTrace).expect("warped"));
}

#[test]
fn strange_depths_and_sizes_do_no_harm() {
    let from = camera(DVec3::new(0.0, 0.0, 5.0), false);
    let color = Pixels::new(8, 8, [1, 2, 3, 255]);
    let strange = [f32::NAN, f32::INFINITY, -1.0, 2.0, 0.0, 1.0, 1e-40, 0.5];
    let depth = Pixels::from_data(8, 8, strange.repeat(8)).expect("size");
    let to = camera(DVec3::new(0.0, 0.0, 3.2), false);
    let options = Options::default();
    let sources = [DepthPicture { color: &color, depth: &depth, camera: from }];
    assert!(warp(&sources, &to, [9, 5], &options, &mut NoTrace).is_ok());
    let small = Pixels::new(7, 8, 0.5);
    let sources = [DepthPicture { depth: &small, ..sources[0] }];
    assert!(warp(&sources, &to, [9, 5], &options, &mut NoTrace).is_err());
    assert!(warp(&[], &to, [0, 5], &options, &mut NoTrace).is_err());
}
