//! Ray casting, compared with the z-buffer; shadows, mirrors and glass, compared with computed results.

use crate::scenes::instance;
use crate::surface_scenes::{Prepared, assert_same_planes, each, random};
use durer::math::{DVec2, DVec3, Vec3, Vec4};
use durer::pipeline::{Background, Lighting, RenderOptions, Samples, SurfaceMethod, Surroundings};
use durer::scene::{AlphaMode, Light, LightKind, Material, Mesh, Part, Scene, ShadingModel};
use durer::shade::PreparedLights;
use durer::target::{Framebuffer, NO_ITEM};
use durer::trace::{NoTrace, Recorder};
use durer::visibility::surface::ray::{Options, RayKind, Step, render};

fn picture(p: &Prepared<'_>, options: &Options) -> Framebuffer {
    let mut framebuffer = p.framebuffer();
    render(&p.fine_input(), &p.lights, options, &mut framebuffer, &mut NoTrace);
    framebuffer
}

#[test]
fn ray_casting_agrees_with_the_z_buffer() {
    each(320, |name, p| {
        let found = picture(p, &Options::default());
        let expected = p.by_z_buffer();
        assert_same_planes(name, &found, &expected);
        assert!(found.color == expected.color, "{name}: colour");
    });
}

#[test]
fn rays_at_the_samples_give_the_samples_of_the_z_buffer() {
    for (seed, samples) in [(3, Samples::Four), (9, Samples::Sixteen), (21, Samples::Four)] {
        let scene = random(seed);
        let mut p = Prepared::new(&scene, 80, 60);
        p.options.samples = samples;
        let found = picture(&p, &Options { samples, ..Options::default() });
        let expected = p.by_z_buffer();
        let pairs =
            found.color.data().as_flattened().iter().zip(expected.color.data().as_flattened());
        // The sums differ in the order of their terms.
        assert!(pairs.clone().all(|(a, b)| a.abs_diff(*b) <= 1), "{seed}");
        assert!(expected.item.expect("items").data().iter().any(|&i| i != NO_ITEM));
    }
}

#[test]
fn rays_can_be_replayed_on_every_number_of_threads() {
    let scene = crate::scenes::materials();
    let p = Prepared::new(&scene, 50, 40);
    let options = Options { shadows: true, reflections: true, ..Options::default() };
    let mut recorder = Recorder::default();
    let mut traced = p.framebuffer();
    render(&p.fine_input(), &p.lights, &options, &mut traced, &mut recorder);
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        assert!(pool.install(|| picture(&p, &options)) == traced);
    }
    let mut items = vec![NO_ITEM; 50 * 40];
    let mut kinds = std::collections::HashSet::new();
    for step in recorder.steps() {
        let Step::Ray { x, y, kind, origin, direction, hit, t, .. } = *step else { continue };
        assert!((direction.length() - 1.0).abs() < 1e-5 && hit.is_some() == t.is_finite());
        if kind == RayKind::Primary {
            assert_eq!(origin, p.view.camera().eye);
            let seen = p.view.screen_from_world() * (origin + direction).extend(1.0);
            let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            assert!((seen.truncate().truncate() / seen.w).distance(middle) < 1e-6);
        }
        kinds.insert(kind);
        let is_triangle = |i: &u32| u64::from(*i) < scene.triangle_count();
        if let (RayKind::Primary, Some(item)) = (kind, hit.filter(is_triangle)) {
            items[(y * 50 + x) as usize] = item;
        }
    }
    assert_eq!(items, traced.item.expect("items").data());
    for kind in [RayKind::Primary, RayKind::Shadow, RayKind::Mirror, RayKind::Refraction] {
        assert!(kinds.contains(&kind), "{kind:?}");
    }
}

/// A square across the z axis, with a material.
fn square(scene: &mut Scene, z: f32, half: f32, material: Material) {
    let corner = |x: f32, y: f32| Vec3::new(x * half, y * half, z);
    let positions =
        vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    scene.materials.push(material);
    let part = Part { range: 0..2, material: Some(scene.materials.len() - 1), name: String::new() };
    let indices = Some(vec![0, 1, 2, 0, 2, 3]);
    scene.meshes.push(Mesh { positions, indices, parts: vec![part], ..Mesh::default() });
    scene.instances.push(instance(scene.meshes.len() - 1));
}

fn unlit(r: f32, g: f32, b: f32) -> Material {
    let base_color = Vec4::new(r, g, b, 1.0);
    Material { model: ShadingModel::Unlit, base_color, ..Material::default() }
}

/// Seen along −z from the distance 4.
fn in_front<'a>(scene: &'a Scene, lights: &[Light]) -> Prepared<'a> {
    let mut p = Prepared::new(scene, 64, 64);
    p.options.camera.eye = DVec3::new(0.0, 0.0, 4.0);
    p.view = durer::view::View::new(p.options.camera, 64, 64).expect("view");
    p.lights = PreparedLights::new(lights, &p.options.camera);
    p
}

fn color_at(f: &Framebuffer, x: u32, y: u32) -> [u8; 4] {
    f.color.get(x, y).expect("pixel")
}

#[test]
fn a_square_throws_its_shadow_where_it_must() {
    let mut scene = Scene::default();
    let matte = Material { specular: Vec3::ZERO, ..Material::default() };
    square(&mut scene, 0.0, 3.0, matte.clone());
    square(&mut scene, 1.0, 0.25, matte);
    // Straight from a lamp at x = 2 above the small square: the shadow of its middle is at x = −2/3.
    let position = DVec3::new(2.0, 0.0, 4.0);
    let kind = LightKind::Point { position, range: None };
    let dark = Light { kind: LightKind::Ambient, color: Vec3::ZERO };
    let p = in_front(&scene, &[Light { kind, color: Vec3::splat(12.0) }, dark]);
    let plain = picture(&p, &Options::default());
    let shadowed = picture(&p, &Options { shadows: true, ..Options::default() });
    let pixel = |x: f64| {
        let s = p.view.screen_from_world() * DVec3::new(x, 0.0, 0.0).extend(1.0);
        (s.x / s.w) as u32
    };
    let middle = pixel(-2.0 / 3.0);
    assert!(color_at(&plain, middle, 32)[0] > 100);
    assert_eq!(color_at(&shadowed, middle, 32), [0, 0, 0, 255]);
    for x in [pixel(-1.2), pixel(1.2)] {
        assert_eq!(color_at(&shadowed, x, 32), color_at(&plain, x, 32));
    }
    // A square of 1/2 at 3/4 of the way from the floor to the lamp is 2/3 wide as a shadow.
    let dark = (0..64).filter(|&x| color_at(&shadowed, x, 32)[0] == 0).count() as u32;
    let width = pixel(0.0).abs_diff(pixel(2.0 / 3.0));
    assert!(dark.abs_diff(width) <= 1, "{dark} {width}");
}

#[test]
fn a_mirror_shows_what_is_behind_the_eye() {
    let mut scene = Scene::default();
    let mirror = Material {
        model: ShadingModel::MetallicRoughness,
        base_color: Vec4::ONE,
        metallic: 1.0,
        roughness: 0.0,
        ..Material::default()
    };
    square(&mut scene, 0.0, 1.0, mirror);
    square(&mut scene, 6.0, 20.0, unlit(1.0, 0.0, 0.0));
    let p = in_front(&scene, &[]);
    let found = picture(&p, &Options { reflections: true, ..Options::default() });
    assert_eq!(color_at(&found, 32, 32), [255, 0, 0, 255]);
    assert_eq!(found.item.as_ref().expect("items").get(32, 40), Some(0));
    let blind = picture(&p, &Options { reflections: true, depth: 0, ..Options::default() });
    assert_eq!(color_at(&blind, 32, 32), [255, 255, 255, 255]);
}

#[test]
fn glass_bends_rays_and_clear_film_does_not() {
    let mut scene = Scene::default();
    let mut glass = unlit(1.0, 1.0, 1.0);
    (glass.base_color.w, glass.alpha_mode) = (0.25, AlphaMode::Blend);
    square(&mut scene, 1.0, 2.0, glass);
    square(&mut scene, 0.0, 0.5, unlit(0.0, 0.0, 1.0));
    let p = in_front(&scene, &[]);
    let blue = |refractive_index| {
        let options = Options { reflections: true, refractive_index, ..Options::default() };
        let found = picture(&p, &options);
        (0..64).filter(|&x| color_at(&found, x, 32)[0] < 200).count() as i32
    };
    let (film, glass) = (blue(1.0), blue(1.5));
    let edge = p.view.screen_from_world() * DVec3::new(0.5, 0.0, 0.0).extend(1.0);
    let width = 2.0 * (edge.x / edge.w - 32.0);
    assert!((f64::from(film) - width).abs() <= 1.0, "{film} {width}");
    // Behind glass the angle of a ray to the axis is 2/3 of its angle before: 3 + 1 becomes 3 + 2/3.
    let wider = width * 4.0 / (3.0 + 2.0 / 3.0);
    assert!((f64::from(glass) - wider).abs() <= 1.0, "{glass} {wider}");
}

#[test]
fn what_lies_behind_more_glass_than_rays_bounce_is_seen() {
    let mut scene = Scene::default();
    for i in 0..6 {
        let mut glass = unlit(1.0, 1.0, 1.0);
        (glass.base_color.w, glass.alpha_mode) = (0.1, AlphaMode::Blend);
        square(&mut scene, 2.0 - 0.2 * i as f32, 2.0, glass);
    }
    square(&mut scene, 0.0, 2.0, unlit(0.0, 0.0, 1.0));
    let p = in_front(&scene, &[]);
    // Straight through, so that the order of bounces does not matter.
    let seen = |depth| {
        let options = Options { reflections: true, depth, ..Options::default() };
        color_at(&picture(&p, &options), 32, 32)
    };
    let expected = seen(20);
    assert!(expected[0] > 100 && expected[2] == 255, "{expected:?}");
    for depth in [0, 1, 2, 5, 7] {
        let found = seen(depth);
        assert!((0..4).all(|i| found[i].abs_diff(expected[i]) <= 1), "{depth}: {found:?}");
    }
}

#[test]
fn mirrors_show_the_studio_where_they_show_nothing_else() {
    let mut scene = Scene::default();
    let (model, base_color) = (ShadingModel::MetallicRoughness, Vec4::ONE);
    let (metallic, roughness) = (1.0, 0.0);
    square(
        &mut scene,
        0.0,
        1.0,
        Material { model, base_color, metallic, roughness, ..Material::default() },
    );
    let p = in_front(&scene, &[]);
    let mirrored = |lights: &[Light], surroundings| {
        let options = RenderOptions {
            algorithm: SurfaceMethod::Ray,
            bounces: 1,
            lighting: Lighting::Given(lights.to_vec()),
            surroundings,
            background: Background::Color(Vec4::ZERO),
            ..p.options.clone()
        };
        color_at(&durer::pipeline::render(&scene, &options).expect("picture").0, 32, 32)
    };
    assert_eq!(mirrored(&[], Surroundings::None)[..3], [0, 0, 0]);
    let white = Light { kind: LightKind::Ambient, color: Vec3::ONE };
    let [r, _, b, a] = mirrored(&[white], Surroundings::Studio);
    assert!(r > 100 && r == b && a == 255, "{r} {b} {a}");
}

/// Returns the number of rays of a kind that a picture takes.
fn rays(p: &Prepared<'_>, options: &Options, wanted: RayKind) -> usize {
    let mut recorder = Recorder::default();
    render(&p.fine_input(), &p.lights, options, &mut p.framebuffer(), &mut recorder);
    let is_one = |s: &&Step| matches!(s, Step::Ray { kind, .. } if *kind == wanted);
    recorder.steps().iter().filter(is_one).count()
}

#[test]
fn what_lies_behind_a_lamp_or_around_it_throws_no_shadow() {
    let matte = Material { specular: Vec3::ZERO, ..Material::default() };
    let with_square = |z: Option<f32>| {
        let mut scene = Scene::default();
        square(&mut scene, 0.0, 1.0, matte.clone());
        if let Some(z) = z {
            square(&mut scene, z, 0.5, matte.clone());
        }
        scene
    };
    let options = Options { shadows: true, ..Options::default() };
    let kind = LightKind::Point { position: DVec3::new(0.0, 0.0, 5.0), range: None };
    let light = Light { kind, color: Vec3::splat(20.0) };
    let seen = |z| picture(&in_front(&with_square(z), &[light]), &options).color;
    let expected = seen(None);
    // Behind the eye, so that only their shadows could be visible.
    for z in [5.0, 6.0, 50.0] {
        assert!(seen(Some(z)) == expected, "{z}");
    }
    assert!(seen(Some(4.5)) != expected);
}

#[test]
fn what_is_blended_throws_no_shadow() {
    let options = Options { shadows: true, ..Options::default() };
    let kind = LightKind::Point { position: DVec3::new(0.0, 0.0, 6.0), range: None };
    let light = Light { kind, color: Vec3::splat(20.0) };
    let seen = |alpha_mode| {
        let mut scene = Scene::default();
        square(&mut scene, 0.0, 1.0, Material::default());
        // Behind the eye.
        let base_color = Vec4::new(1.0, 1.0, 1.0, 0.9);
        square(&mut scene, 5.0, 0.5, Material { alpha_mode, base_color, ..Material::default() });
        color_at(&picture(&in_front(&scene, &[light]), &options), 32, 30)
    };
    let (blended, opaque) = (seen(AlphaMode::Blend), seen(AlphaMode::Opaque));
    assert!(blended[0] > opaque[0] + 50, "{blended:?} {opaque:?}");
    assert_eq!(seen(AlphaMode::Mask { cutoff: 0.5 }), opaque);
    assert_eq!(seen(AlphaMode::Mask { cutoff: 0.95 }), blended);
}

#[test]
fn what_faces_away_from_a_light_asks_no_ray() {
    let mut scene = Scene::default();
    square(&mut scene, 0.0, 1.0, Material::default());
    let options = Options { shadows: true, ..Options::default() };
    for (z, requested) in [(-5.0, false), (5.0, true)] {
        let kind = LightKind::Point { position: DVec3::new(0.0, 0.0, z), range: None };
        let p = in_front(&scene, &[Light { kind, color: Vec3::ONE }]);
        assert_eq!(rays(&p, &options, RayKind::Shadow) > 0, requested, "{z}");
    }
}

#[test]
fn a_face_never_shades_itself() {
    // A lamp just above the plane of one triangle: rays to it leave at angles of a degree and less.
    let corners =
        [Vec3::new(-2.1, -1.3, 0.37), Vec3::new(2.3, -0.7, -0.51), Vec3::new(0.2, 1.9, 0.13)];
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
    let scene = crate::surface_scenes::of_triangles(&[corners]);
    for (corner, height) in [(0, 0.02), (1, 0.01), (2, 0.03), (2, 0.001)] {
        let position = (corners[corner] * 1.3 + normal * height).as_dvec3();
        let kind = LightKind::Point { position, range: None };
        let p = in_front(&scene, &[Light { kind, color: Vec3::splat(9.0) }]);
        let shadowed = picture(&p, &Options { shadows: true, ..Options::default() });
        assert!(shadowed.color == picture(&p, &Options::default()).color, "{corner} {height}");
    }
}

#[test]
fn at_grazing_angles_everything_smooth_is_a_mirror() {
    let mut scene = Scene::default();
    let base_color = Vec4::new(0.0, 0.0, 0.0, 1.0);
    let (model, metallic, roughness) = (ShadingModel::MetallicRoughness, 0.0, 0.0);
    let black = Material { model, base_color, metallic, roughness, ..Material::default() };
    square(&mut scene, 0.0, 1.0, black);
    for degrees in [0.0f64, 45.0, 70.0, 80.0] {
        let mut p = in_front(&scene, &[]);
        let (sin, cos) = (libm::sin(degrees.to_radians()), libm::cos(degrees.to_radians()));
        p.options.camera.eye = DVec3::new(0.0, -400.0 * sin, 400.0 * cos);
        p.options.camera.projection = durer::scene::Projection::Perspective { fov_y: 0.002 };
        p.options.camera.far = 1000.0;
        p.view = durer::view::View::new(p.options.camera, 64, 64).expect("view");
        let linear = |reflections| {
            let found = picture(&p, &Options { reflections, ..Options::default() });
            f64::from(durer::shade::color::decode_srgb8(color_at(&found, 32, 32)[0]))
        };
        // The sky is white, so the picture shows the reflectance: Schlick's formula.
        let share = 0.04 + 0.96 * libm::pow(1.0 - cos, 5.0);
        let (own, seen) = (linear(false), linear(true));
        let expected = own * (1.0 - share) + share;
        assert!((seen - expected).abs() < 0.004, "{degrees}: {seen} for {expected}");
    }
}
