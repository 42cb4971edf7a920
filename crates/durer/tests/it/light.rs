//! The exposure, and the environment of a scene, tested on whole pictures.

use crate::scenes;
use durer::math::{DVec3, Vec3, Vec4};
use durer::pipeline::{Exposure, Lighting, RenderOptions, Surroundings, render};
use durer::scene::{Light, LightKind, Scene};
use durer::target::Pixels;

fn picture(scene: &Scene, options: &RenderOptions) -> Pixels<[u8; 4]> {
    render(scene, options).expect("picture").0.color
}

fn lamps(factor: f32) -> Vec<Light> {
    let position = DVec3::new(1.0, 2.0, 3.0);
    let direction = DVec3::new(1.0, -1.0, -0.5);
    vec![
        Light {
            kind: LightKind::Point { position, range: None },
            color: Vec3::splat(4.0 * factor),
        },
        Light {
            kind: LightKind::Directional { direction },
            color: Vec3::new(0.2, 0.1, 0.0) * factor,
        },
    ]
}

/// Returns the brightest channel of any pixel.
fn brightest(picture: &Pixels<[u8; 4]>) -> u8 {
    picture.data().iter().map(|p| p[0].max(p[1]).max(p[2])).max().unwrap_or(0)
}

/// Returns the largest difference of two pictures.
fn difference(a: &Pixels<[u8; 4]>, b: &Pixels<[u8; 4]>) -> u8 {
    let pairs = a.data().as_flattened().iter().zip(b.data().as_flattened());
    pairs.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

fn options(scene: &Scene) -> RenderOptions {
    let mut options = scenes::options(scene, 80, 60);
    options.background = durer::pipeline::Background::Color(Vec4::new(0.0, 0.0, 0.0, 1.0));
    options
}

#[test]
fn a_files_lamps_of_any_strength_make_one_picture() {
    let mut scene = scenes::soup(60, 3);
    scene.lights = lamps(1.0);
    let expected = picture(&scene, &options(&scene));
    assert!(brightest(&expected) > 200, "{}", brightest(&expected));
    for factor in [1e-4, 0.1, 10.0, 1e4] {
        scene.lights = lamps(factor);
        let found = picture(&scene, &options(&scene));
        assert!(difference(&found, &expected) <= 1, "{factor}");
    }
}

#[test]
fn lights_that_are_given_are_shown_as_they_are() {
    let scene = scenes::soup(60, 3);
    let mut options = options(&scene);
    options.lighting = Lighting::Given(lamps(0.1));
    let given = picture(&scene, &options);
    assert!(brightest(&given) < 150, "{}", brightest(&given));
    options.exposure = Some(Exposure::Ev(0.0));
    assert!(picture(&scene, &options) == given);
    options.exposure = Some(Exposure::Auto);
    let exposed = picture(&scene, &options);
    assert!(brightest(&exposed) > 200);
    // As with a file's own environment.
    let own = Scene { lights: lamps(7.0), ..scene };
    assert!(difference(&picture(&own, &self::options(&own)), &exposed) <= 1);
}

#[test]
fn light_of_the_camera_is_exposed_already() {
    let scene = scenes::materials();
    let mut options = options(&scene);
    let expected = picture(&scene, &options);
    for same in [Exposure::Auto, Exposure::Ev(0.0)] {
        options.exposure = Some(same);
        assert!(picture(&scene, &options) == expected, "{same:?}");
    }
    options.exposure = Some(Exposure::Ev(-1.0));
    let sum = |p: &Pixels<[u8; 4]>| -> u64 { p.data().iter().map(|p| u64::from(p[1])).sum() };
    assert!(sum(&picture(&scene, &options)) * 10 < sum(&expected) * 8);
    options.exposure = Some(Exposure::Ev(f32::NAN));
    assert!(render(&scene, &options).is_err());
}

#[test]
fn metals_and_smooth_plastics_mirror_the_studio_and_matte_things_do_not() {
    let metals = scenes::lobes();
    let differs = |scene: &Scene| {
        let studio = options(scene);
        let none = RenderOptions { surroundings: Surroundings::None, ..options(scene) };
        difference(&picture(scene, &studio), &picture(scene, &none))
    };
    assert!(differs(&metals) > 60);
    let mut plain = scenes::lobes();
    for material in &mut plain.materials {
        (material.metallic, material.clearcoat, material.transmission) = (0.0, 0.0, 0.0);
        material.sheen_color = Vec3::ZERO;
        (material.ior, material.specular_tint) = (1.5, Vec3::ONE);
        material.roughness = 0.5;
    }
    assert_eq!(differs(&plain), 0);
    plain.materials.iter_mut().for_each(|material| material.roughness = 0.2);
    assert!(differs(&plain) > 20);
}
