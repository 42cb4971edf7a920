//! The visibility of scenes, and the reason if nothing is visible.

use crate::scenes::{instance, sphere};
use durer::math::{DVec3, Vec3, Vec4};
use durer::pipeline::{
    Background, Cull, DrawOptions, RenderOptions, Samples, Status, Unseen, draw, drawing_status,
    render, status,
};
use durer::scene::{AlphaMode, Camera, Material, Mesh, Projection, Scene, ShadingModel, Topology};
use durer::visibility::line::{ClassSet, hidden_line};

fn camera() -> Camera {
    Camera {
        eye: DVec3::new(0.0, 0.0, 6.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 0.6 },
        near: 0.5,
        far: 20.0,
    }
}

fn with_material(material: Material) -> Scene {
    Scene {
        meshes: vec![sphere(8, Some(0))],
        instances: vec![instance(0)],
        materials: vec![material],
        ..Scene::default()
    }
}

fn of(scene: &Scene, options: &RenderOptions) -> Status {
    let (picture, _) = render(scene, options).expect("picture");
    status(scene, options, &picture).expect("status")
}

fn unlit(color: Vec4) -> Material {
    Material { model: ShadingModel::Unlit, base_color: color, ..Material::default() }
}

fn options() -> RenderOptions {
    RenderOptions { width: 60, height: 40, samples: Samples::One, ..RenderOptions::new(camera()) }
}

#[test]
fn a_scene_that_is_seen_is_ok_wherever_it_is() {
    let grey = with_material(Material::default());
    let white = with_material(unlit(Vec4::ONE));
    let gradient = Background::Gradient(Vec4::new(0.2, 0.4, 0.6, 1.0), Vec4::ONE);
    assert_eq!(of(&grey, &options()), Status::Ok);
    assert_eq!(of(&white, &RenderOptions { background: gradient, ..options() }), Status::Ok);
    let clear = Background::Color(Vec4::ZERO);
    assert_eq!(of(&white, &RenderOptions { background: clear, ..options() }), Status::Ok);
    // From inside, it fills the whole picture.
    let inside = Camera { eye: DVec3::ZERO, target: DVec3::Z, near: 0.1, ..camera() };
    let black = with_material(unlit(Vec4::new(0.0, 0.0, 0.0, 1.0)));
    assert_eq!(of(&black, &RenderOptions { camera: inside, ..options() }), Status::Ok);
}

#[test]
fn what_hides_a_scene_is_reported() {
    let invisible = Status::Invisible;
    assert_eq!(of(&Scene::default(), &options()), Status::Empty);
    let no_faces = Mesh { indices: Some(Vec::new()), parts: Vec::new(), ..sphere(4, None) };
    let no_faces =
        Scene { meshes: vec![no_faces], instances: vec![instance(0)], ..Scene::default() };
    assert_eq!(of(&no_faces, &options()), Status::Empty);

    let scene = with_material(Material::default());
    let seen_by = |camera: Camera| of(&scene, &RenderOptions { camera, ..options() });
    let behind = Camera { target: DVec3::new(0.0, 0.0, 9.0), ..camera() };
    assert_eq!(seen_by(behind), invisible(Unseen::BehindEye));
    assert_eq!(seen_by(Camera { near: 10.0, ..camera() }), invisible(Unseen::BeforeNear));
    assert_eq!(seen_by(Camera { far: 1.0, ..camera() }), invisible(Unseen::BeyondFar));
    let aside = Camera { target: DVec3::new(9.0, 0.0, 0.0), ..camera() };
    assert_eq!(seen_by(aside), invisible(Unseen::Beside));

    let inside_out = Scene {
        meshes: vec![Mesh {
            indices: sphere(8, None).indices.map(|i| i.into_iter().rev().collect()),
            ..sphere(8, None)
        }],
        ..scene.clone()
    };
    let one_sided = Mesh { topology: Topology::Triangles, ..half(&inside_out.meshes[0]) };
    let one_sided = Scene { meshes: vec![one_sided], ..inside_out };
    let culled = RenderOptions { cull: Cull::Back, ..options() };
    assert_eq!(of(&one_sided, &culled), invisible(Unseen::Culled));

    for alpha_mode in [AlphaMode::Blend, AlphaMode::Mask { cutoff: 0.5 }] {
        let clear = Material { alpha_mode, ..unlit(Vec4::new(1.0, 0.0, 0.0, 0.0)) };
        assert_eq!(of(&with_material(clear), &options()), invisible(Unseen::Transparent));
    }
    assert_eq!(of(&with_material(unlit(Vec4::ONE)), &options()), invisible(Unseen::LikeBackground));
    let not_finite = Mesh { positions: vec![Vec3::NAN; 3], ..Mesh::default() };
    let not_finite = Scene { meshes: vec![not_finite], ..scene.clone() };
    assert_eq!(of(&not_finite, &options()), invisible(Unseen::NotFinite));
    let mut tiny = scene.clone();
    tiny.instances[0].world_from_mesh *= durer::math::DMat4::from_scale(DVec3::splat(1e-6));
    assert_eq!(of(&tiny, &options()), invisible(Unseen::Missed));
}

/// Returns the faces of a mesh with all corners above z = 0.
fn half(mesh: &Mesh) -> Mesh {
    let indices = mesh.indices.clone().unwrap_or_default();
    let front = |t: &&[u32; 3]| t.iter().all(|&v| mesh.positions[v as usize].z > 0.1);
    let kept = indices.as_chunks::<3>().0.iter().filter(front).flatten().copied().collect();
    Mesh { indices: Some(kept), parts: Vec::new(), faces: Vec::new(), ..mesh.clone() }
}

#[test]
fn drawings_without_lines_say_why() {
    let scene = with_material(Material::default());
    let of = |scene: &Scene, options: &DrawOptions| {
        let drawing = draw(scene, options).expect("drawing");
        drawing_status(scene, &options.camera, options.aspect, &drawing).expect("status")
    };
    assert_eq!(of(&scene, &DrawOptions::new(camera())), Status::Ok);
    assert_eq!(of(&Scene::default(), &DrawOptions::new(camera())), Status::Empty);
    let behind = Camera { target: DVec3::new(0.0, 0.0, 9.0), ..camera() };
    let behind = of(&scene, &DrawOptions::new(behind));
    assert_eq!(behind, Status::Invisible(Unseen::BehindEye));
    let none = hidden_line::Options { classes: ClassSet::NONE, ..Default::default() };
    let none = DrawOptions { lines: none, ..DrawOptions::new(camera()) };
    assert_eq!(of(&scene, &none), Status::Invisible(Unseen::Missed));
}
