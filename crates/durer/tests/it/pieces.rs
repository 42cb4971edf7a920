//! Pictures of scenes processed in pieces equal those of the whole, bit for bit.

use crate::scenes::{self, Numbers};
use durer::math::{DVec3, Vec3, Vec4};
use durer::pipeline::{
    Cull, Exposure, Lighting, RenderOptions, Samples, Shading, Shadows, Status, SurfaceMethod,
    SurveyResult, Unseen, check_pieces, render, render_seen, status, status_of_pieces, survey,
};
use durer::scene::{
    AlphaMode, Light, LightKind, Material, Mesh, Part, Projection, Scene, Topology, UpAxis,
};
use durer::view::projection::{
    EndsOfPieces, FitOptions, FitPieces, Lens, NamedView, PIECE, drawn_bounds, drawn_ends,
    fit_scene,
};
use durer::work::Work;

/// Returns random triangles, each in its own colour, some of them repeated in another colour, either consecutively or
/// far apart.
fn soup(triangles: usize) -> Scene {
    let mut scene = scenes::soup(triangles, 7);
    let mesh = &mut scene.meshes[0];
    let from = triangles / 4 * 3;
    let again: Vec<Vec3> = mesh.positions[from..from + 300].to_vec();
    mesh.positions.splice(600..600, again[..150].to_vec());
    mesh.positions.extend(again);
    let mut numbers = Numbers(5);
    let mut color = || (numbers.point(1.0) * 0.5 + 0.5).extend(1.0);
    mesh.colors = (0..mesh.positions.len() / 3).flat_map(|_| [color(); 3]).collect();
    scene
}

/// Returns the same with points instead of triangles.
fn cloud(triangles: usize) -> Scene {
    let mut scene = soup(triangles);
    scene.meshes[0].topology = Topology::Points;
    scene
}

fn corners(scene: &Scene) -> usize {
    if scene.meshes[0].topology == Topology::Points { 1 } else { 3 }
}

/// Returns a scene with some primitives of one without indices.
fn only(scene: &Scene, numbers: impl Iterator<Item = usize>) -> Scene {
    let (mesh, corners) = (&scene.meshes[0], corners(scene));
    let vertices: Vec<usize> = numbers.flat_map(|i| corners * i..corners * (i + 1)).collect();
    let of = |all: &Vec<Vec3>| vertices.iter().map(|&v| all[v]).collect();
    let mut own = Mesh {
        topology: mesh.topology,
        positions: of(&mesh.positions),
        colors: vertices.iter().map(|&v| mesh.colors[v]).collect(),
        ..Mesh::default()
    };
    if let Some(Part { material, .. }) = mesh.parts.first() {
        let range = 0..own.primitive_count() as u32;
        own.parts.push(Part { range, material: *material, name: String::new() });
    }
    Scene { meshes: vec![own], ..scene.clone() }
}

fn in_pieces(scene: &Scene, at_once: usize) -> Vec<Scene> {
    let count = scene.meshes[0].primitive_count();
    let piece = |start: usize| only(scene, start..count.min(start + at_once));
    (0..count).step_by(at_once).map(piece).collect()
}

fn surveyed(pieces: &[Scene], options: &RenderOptions) -> SurveyResult {
    let mut survey = survey(options).expect("survey");
    pieces.iter().for_each(|piece| survey.add(piece).expect("piece"));
    survey.finish().expect("seen")
}

/// Compares the pictures of a scene as a whole and in pieces of several sizes.
fn compare(scene: &Scene, options: &RenderOptions) {
    let (expected, whole) = render(scene, options).expect("picture");
    for at_once in [150, 1 << 20] {
        let seen = surveyed(&in_pieces(scene, at_once), options);
        let kept = only(scene, seen.items.iter().map(|&item| item as usize));
        let triangles = scene.triangle_count();
        let (found, report) = render_seen(&kept, triangles, &seen, options).expect("picture");
        let what = format!("{:?} {:?} {at_once}", options.samples, options.cull);
        assert!(found == expected, "{what}");
        let counts = |r: &durer::pipeline::Report| {
            [r.triangles_in, r.non_finite, r.clipped, r.culled, r.drawn]
        };
        assert_eq!(counts(&report), counts(&whole), "{what}");
        assert!(seen.items.len() < scene.meshes[0].primitive_count(), "{what}");
    }
}

#[test]
fn pictures_in_pieces_are_those_of_the_whole() {
    let mut scene = soup(700);
    for samples in [Samples::One, Samples::Four, Samples::Sixteen] {
        for planes in [false, true] {
            let mut options = scenes::options(&scene, 100, 70);
            options.samples = samples;
            (options.depth, options.item, options.normal) = (planes, planes, planes);
            compare(&scene, &options);
            // Near enough to cut some triangles.
            options.camera.eye = options.camera.eye.lerp(options.camera.target, 0.8);
            options.cull = Cull::Back;
            compare(&scene, &options);
            options.camera.projection = Projection::Orthographic { height: 1.5 };
            (options.cull, options.shading) = (Cull::Material, Some(Shading::Flat));
            compare(&scene, &options);
            compare(&cloud(500), &options);
        }
    }
    scene.give_material(Material::default());
    let mut options = scenes::options(&scene, 70, 90);
    options.cull = Cull::Material;
    compare(&scene, &options);
}

/// Checks that cameras of pieces are those of the whole. A camera may be determined by any of several points equally
/// far out; the last bits of its position depend on the choice.
#[test]
fn cameras_of_pieces_are_those_of_the_whole() {
    let mut numbers = Numbers(3);
    // On a grid many points are equally far out in each of the views.
    let mut scene = soup(3000);
    for position in &mut scene.meshes[0].positions {
        *position = ((numbers.point(7.0) * 0.5).round() * 0.3).with_y(numbers.next());
    }
    scene.meshes[0].positions[77] = Vec3::NAN;
    for (at_once, view) in
        [1, 2, 5].into_iter().flat_map(|n| NamedView::ALL.iter().map(move |view| (n, view)))
    {
        let pieces = in_pieces(&scene, at_once * PIECE);
        assert!(pieces.len() > 1 || at_once > 2);
        for lens in [Lens::Perspective { fov_y: 0.5 }, Lens::Orthographic] {
            let options = FitOptions { lens, aspect: 1.3, margin: 0.03 };
            let direction = view.direction(UpAxis::Z);
            let mut fit = FitPieces::new(&direction, &options).expect("options");
            let mut ends = EndsOfPieces::new(direction.to_eye());
            for piece in &pieces {
                fit.add(piece);
                ends.add(piece);
            }
            let expected = fit_scene(&scene, &direction, &options).expect("camera");
            assert_eq!(fit.camera().expect("camera"), expected, "{view} {at_once}");
            assert_eq!(ends.ends(), drawn_ends(&scene, direction.to_eye()));
            assert_eq!(ends.bounds(), drawn_bounds(&scene));
        }
    }
}

#[test]
fn what_needs_the_whole_is_refused() {
    let scene = soup(200);
    let plain = scenes::options(&scene, 20, 20);
    assert!(check_pieces(&plain, false).is_ok());
    let light = Light { kind: LightKind::Ambient, color: Vec3::ONE };
    let with = |change: &dyn Fn(&mut RenderOptions)| {
        let mut options = plain.clone();
        change(&mut options);
        check_pieces(&options, false).is_ok()
    };
    assert!(with(&|o| o.lighting = Lighting::Given(vec![light])));
    assert!(!with(&|o| {
        o.lighting = Lighting::Given(vec![light]);
        o.exposure = Some(Exposure::Auto);
    }));
    assert!(!with(&|o| o.shadows = Shadows::Map));
    assert!(!with(&|o| o.algorithm = SurfaceMethod::ABuffer));
    assert!(!with(&|o| o.shading = Some(Shading::Phong)));
    let smooth = RenderOptions { shading: Some(Shading::Phong), ..plain.clone() };
    assert!(check_pieces(&smooth, true).is_ok());

    let mut clear = scene.clone();
    clear.give_material(Material { alpha_mode: AlphaMode::Blend, ..Material::default() });
    let refused = survey(&plain).and_then(|mut survey| survey.add(&clear));
    assert!(refused.unwrap_err().to_string().contains("not opaque"));
    let work = Work::with_budget(10_000, "--max-memory");
    let refused = survey(&RenderOptions { work, ..plain }).err().expect("refused");
    assert!(refused.to_string().starts_with("samples of the picture"), "{refused}");
}

#[test]
fn it_is_reported_why_nothing_is_seen() {
    let away = |scene: &mut Scene, by: Vec3| {
        scene.meshes[0].positions.iter_mut().for_each(|p| *p = *p * 0.01 + by);
    };
    let mut scene = soup(500);
    scene.meshes[0].positions[1500..].fill(Vec3::NAN);
    let plain = scenes::options(&scene, 30, 30);
    for by in [Vec3::X, -Vec3::X, Vec3::Y, Vec3::NAN] {
        let mut scene = scene.clone();
        away(&mut scene, by * 1e4);
        let pieces = in_pieces(&scene, 100);
        let (picture, _) = render(&scene, &plain).expect("picture");
        let whole = status(&scene, &plain, &picture).expect("status");
        assert!(matches!(whole, Status::Invisible(_)), "{by}");
        assert_eq!(reported(&plain, &pieces), whole, "{by}");
    }
    // One face turned away.
    let back = [DVec3::ZERO, DVec3::X, DVec3::Y].map(|p| p.as_vec3());
    let mesh = Mesh { positions: back.to_vec(), colors: vec![Vec4::ONE; 3], ..Mesh::default() };
    let scene = Scene { meshes: vec![mesh], ..scene };
    let mut options = RenderOptions { cull: Cull::Back, ..plain };
    (options.camera.eye, options.camera.target) = (DVec3::NEG_Z * 3.0, DVec3::ZERO);
    (options.camera.near, options.camera.far) = (1.0, 5.0);
    let pieces = in_pieces(&scene, 100);
    assert_eq!(reported(&options, &pieces), Status::Invisible(Unseen::Culled));
    assert_eq!(reported(&options, &[]), Status::Empty);
}

fn reported(options: &RenderOptions, pieces: &[Scene]) -> Status {
    let again =
        |visit: &mut dyn FnMut(&Scene) -> durer::Result<()>| pieces.iter().try_for_each(visit);
    status_of_pieces(options, again).expect("status")
}
