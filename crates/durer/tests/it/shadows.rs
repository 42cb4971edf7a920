//! Shadows by maps and by rays agree away from their edges.

use crate::scenes::{self, sphere};
use durer::math::{DMat4, DVec3, Vec3, Vec4};
use durer::pipeline::{Lighting, RenderOptions, Samples, Shading, Shadows, SurfaceMethod, render};
use durer::scene::{
    AlphaMode, Camera, Instance, Light, LightKind, Material, Mesh, Part, Projection, Scene,
};
use durer::target::Framebuffer;

/// Returns a floor, a sphere above it, and a tilted plate.
fn scene() -> Scene {
    let quad = |[a, b, c, d]: [Vec3; 4]| vec![a, b, c, a, c, d];
    let floor = quad([
        Vec3::new(-3.0, -1.0, 3.0),
        Vec3::new(3.0, -1.0, 3.0),
        Vec3::new(3.0, -1.0, -3.0),
        Vec3::new(-3.0, -1.0, -3.0),
    ]);
    let plate = quad([
        Vec3::new(-1.6, 0.2, 0.3),
        Vec3::new(-0.8, 0.5, 0.3),
        Vec3::new(-0.8, 0.7, -0.6),
        Vec3::new(-1.6, 0.4, -0.6),
    ]);
    let mesh = |positions| Mesh { positions, ..Mesh::default() };
    let place = |mesh, world_from_mesh| Instance { mesh, world_from_mesh, name: String::new() };
    let ball =
        DMat4::from_translation(DVec3::new(0.5, 0.1, 0.0)) * DMat4::from_scale(DVec3::splat(0.6));
    Scene {
        meshes: vec![mesh(floor), mesh(plate), sphere(12, None)],
        instances: vec![place(0, DMat4::IDENTITY), place(1, DMat4::IDENTITY), place(2, ball)],
        ..Scene::default()
    }
}

fn lights() -> Vec<(&'static str, LightKind)> {
    // From behind on the right, so that shadows fall to the front.
    let position = DVec3::new(2.6, 2.5, -1.5);
    let direction = (DVec3::new(0.1, -0.6, 0.0) - position).normalize();
    let spot = |outer: f64| LightKind::Spot { position, direction, range: None, inner: 0.0, outer };
    vec![
        ("directional", LightKind::Directional { direction }),
        ("spot", spot(0.6)),
        ("wide spot", spot(1.4)),
        ("point", LightKind::Point { position: DVec3::new(-0.2, 1.4, 0.4), range: None }),
    ]
}

fn options(kind: LightKind, shading: Option<Shading>) -> RenderOptions {
    let camera = Camera {
        eye: DVec3::new(1.0, 2.5, 5.0),
        target: DVec3::new(0.0, -0.4, 0.0),
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 0.8 },
        near: 0.5,
        far: 20.0,
    };
    let strength = if matches!(kind, LightKind::Directional { .. }) { 0.9 } else { 6.0 };
    let light = Light { kind, color: Vec3::splat(strength) };
    let (width, height, samples) = (120, 90, Samples::One);
    let lighting = Lighting::Given(vec![light]);
    RenderOptions { width, height, samples, shading, lighting, ..RenderOptions::new(camera) }
}

fn picture(
    kind: LightKind,
    shading: Option<Shading>,
    algorithm: SurfaceMethod,
    shadows: Shadows,
) -> Framebuffer {
    let options =
        RenderOptions { algorithm, shadows, shadow_map_side: 1024, ..options(kind, shading) };
    render(&scene(), &options).expect("picture").0
}

/// Returns whether rays give the same result, lit or in shadow, for all pixels around one.
fn is_inner(none: &Framebuffer, rays: &Framebuffer, x: u32, y: u32) -> bool {
    let dark = |x: u32, y: u32| none.color.get(x, y) != rays.color.get(x, y);
    let mut around = (y.saturating_sub(2)..=y + 2)
        .flat_map(|j| (x.saturating_sub(2)..=x + 2).map(move |i| (i, j)));
    around.all(|(i, j)| dark(i, j) == dark(x, y))
}

#[test]
fn maps_and_rays_agree_away_from_edges() {
    for (name, kind) in lights() {
        for shading in [None, Some(Shading::Phong)] {
            let none = picture(kind, shading, SurfaceMethod::ZBuffer, Shadows::None);
            let map = picture(kind, shading, SurfaceMethod::ZBuffer, Shadows::Map);
            let rays = picture(kind, shading, SurfaceMethod::Ray, Shadows::Rays);
            let (mut inner, mut dark) = (0, 0);
            for (x, y) in (0..90).flat_map(|y| (0..120).map(move |x| (x, y))) {
                let green = |f: &Framebuffer| f.color.get(x, y).map_or(0, |c| u32::from(c[1]));
                if !is_inner(&none, &rays, x, y) {
                    continue;
                }
                inner += 1;
                dark += u32::from(green(&rays) + 20 < green(&none));
                let message = format!("{name} {shading:?} {x},{y}");
                assert!(
                    green(&map).abs_diff(green(&rays)) <= 2,
                    "{message}: {} {}",
                    green(&map),
                    green(&rays)
                );
            }
            assert!(inner > 7000 && dark > 100, "{name}: {inner} inner pixels, {dark} in shadow");
        }
    }
}

#[test]
fn nothing_shadows_itself_wherever_in_the_map_it_is() {
    let mut floor = scene();
    floor.instances.truncate(1);
    for (name, kind) in lights() {
        for shadow_map_side in [64, 256] {
            let (width, height) = (240, 180);
            let options = RenderOptions { width, height, shadow_map_side, ..options(kind, None) };
            let [none, map] = [Shadows::None, Shadows::Map].map(|shadows| {
                render(&floor, &RenderOptions { shadows, ..options.clone() }).expect("picture").0
            });
            assert!(none.color == map.color, "{name} {shadow_map_side}");
        }
    }
}

#[test]
fn maps_go_with_every_method_and_shading() {
    let kind = lights()[0].1;
    for shading in [None, Some(Shading::Flat), Some(Shading::Gouraud)] {
        let expected = picture(kind, shading, SurfaceMethod::ZBuffer, Shadows::Map);
        assert!(expected != picture(kind, shading, SurfaceMethod::ZBuffer, Shadows::None));
        for method in [SurfaceMethod::ScanLineZ, SurfaceMethod::DepthSort, SurfaceMethod::Warnock] {
            assert!(
                picture(kind, shading, method, Shadows::Map) == expected,
                "{method} {shading:?}"
            );
        }
    }
}

#[test]
fn only_rays_cast_rays() {
    let scene = scenes::soup(3, 1);
    let base = scenes::options(&scene, 4, 4);
    for options in [
        RenderOptions { shadows: Shadows::Rays, ..base.clone() },
        RenderOptions { bounces: 1, ..base.clone() },
    ] {
        assert!(render(&scene, &options).is_err());
        let options = RenderOptions { algorithm: SurfaceMethod::Ray, ..options };
        assert!(render(&scene, &options).is_ok());
    }
    for shadow_map_side in [0, u32::MAX] {
        let options = RenderOptions { shadows: Shadows::Map, shadow_map_side, ..base.clone() };
        assert!(render(&scene, &options).is_err());
    }
}

#[test]
fn what_is_blended_throws_no_shadow_by_maps_either() {
    for (name, kind) in lights() {
        let differing = |alpha_mode| {
            let mut scene = scene();
            // Blended, it is clear: only its shadow is visible.
            let base_color = Vec4::new(1.0, 1.0, 1.0, 0.0);
            scene.materials.push(Material { alpha_mode, base_color, ..Material::default() });
            for mesh in &mut scene.meshes[1..] {
                let range = 0..mesh.triangle_count() as u32;
                mesh.parts = vec![Part { range, material: Some(0), name: String::new() }];
            }
            let [plain, shadowed] = [Shadows::None, Shadows::Map].map(|shadows| {
                let options =
                    RenderOptions { shadows, shadow_map_side: 1024, ..options(kind, None) };
                render(&scene, &options).expect("picture").0.color
            });
            plain.data().iter().zip(shadowed.data()).filter(|(a, b)| a != b).count()
        };
        let (blended, opaque) = (differing(AlphaMode::Blend), differing(AlphaMode::Opaque));
        println!("{name}: {blended} {opaque}");
        assert!(blended * 10 < opaque, "{name}: {blended} {opaque}");
    }
}
