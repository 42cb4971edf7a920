//! Lobes, compared with expected results.

use super::*;
use crate::shade::environment::Environment;
use crate::shade::normal::face_viewer;

fn plain() -> Material {
    Material { model: ShadingModel::MetallicRoughness, ..Material::default() }
}

/// Returns the light that leaves a surface of base colour 0.5 in a white room, at the given cosine of the viewing
/// angle.
fn in_white_room(m: &Material, cosine: f32) -> Vec3 {
    let lights = PreparedLights::far(Environment::uniform(Vec3::ONE), Vec::new());
    let view = Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    let frame = face_viewer(view.into(), Vec3::Z.into(), Vec3::Z.into());
    let substance = Substance {
        base: Vec3Lane::from(Vec3::splat(0.5)),
        metallic: 0.0,
        roughness: 0.2,
        occlusion: 1.0,
        mirrors: true,
    };
    let dark = Vec3::ZERO.into();
    let lobes = Lobes::of(m).expect("more than plain");
    lobes.reflect(&frame, dark, (&substance, dark), &lights).into()
}

#[test]
fn plain_materials_have_no_lobes() {
    assert_eq!(Lobes::of(&plain()), None);
    assert_eq!(Lobes::of(&Material { clearcoat: 1.0, ..Material::default() }), None);
    let nan = f32::NAN;
    let odd = Material { ior: nan, clearcoat: nan, transmission: nan, ..plain() };
    assert_eq!(Lobes::of(&Material { specular_strength: nan, ..odd }), None);
}

#[test]
fn reflectance_follows_index_strength_and_tint() {
    let straight = |m: Material| dielectric(&m).straight;
    assert_eq!(straight(plain()), Vec3::splat(0.04));
    assert!((straight(Material { ior: 2.0, ..plain() }).x - 1.0 / 9.0).abs() < 1e-6);
    assert_eq!(straight(Material { ior: 0.0, ..plain() }), Vec3::ONE);
    assert_eq!(straight(Material { ior: 1.0, ..plain() }), Vec3::ZERO);
    let weak = Material { specular_strength: 0.5, ..plain() };
    assert_eq!(straight(weak.clone()), Vec3::splat(0.02));
    assert_eq!(dielectric(&weak).grazing, 0.5);
    let specular_tint = Vec3::new(1.0, 0.5, 99.0);
    let tinted = Material { specular_tint, ..plain() };
    assert_eq!(straight(tinted), Vec3::new(0.04, 0.02, 1.0));
}

#[test]
fn no_lobe_makes_more_light_than_there_is() {
    let all = [
        Material { clearcoat: 1.0, ..plain() },
        Material { clearcoat: 0.5, clearcoat_roughness: 0.7, ..plain() },
        Material { sheen_color: Vec3::ONE, sheen_roughness: 0.1, ..plain() },
        Material { sheen_color: Vec3::ONE, sheen_roughness: 0.8, ..plain() },
        Material { ior: 2.4, ..plain() },
        Material { transmission: 1.0, ..plain() },
    ];
    for (m, cosine) in all.iter().flat_map(|m| [0.05, 0.2, 0.5, 1.0].map(|c| (m, c))) {
        let light = in_white_room(m, cosine);
        // The closed form of the reflected light exceeds Fresnel's law at grazing angles.
        assert!(light.min_element() > 0.3 && light.max_element() < 1.06, "{cosine}: {light}");
    }
}

#[test]
fn coats_reflect_most_at_grazing_angles() {
    let coat = Material { clearcoat: 1.0, ..plain() };
    let bare = Material { clearcoat: 1e-6, ..plain() };
    let more = |cosine| in_white_room(&coat, cosine).x - in_white_room(&bare, cosine).x;
    assert!(more(1.0) > 0.01 && more(1.0) < 0.03, "{}", more(1.0));
    assert!(more(0.1) > 0.05, "{}", more(0.1));
}

#[test]
fn sheen_is_seen_at_the_border_of_cloth() {
    let black = |sheen_color| Material { sheen_color, sheen_roughness: 0.3, ..plain() };
    let red = black(Vec3::X);
    let (straight, grazing) = (in_white_room(&red, 1.0), in_white_room(&red, 0.05));
    assert!(grazing.x - grazing.y > 4.0 * (straight.x - straight.y), "{straight} {grazing}");
}

#[test]
fn what_goes_through_does_not_come_back() {
    let clear = Material { transmission: 1.0, ..plain() };
    let lobes = Lobes::of(&clear).expect("lobes");
    assert_eq!((lobes.dielectric.matte, lobes.through, lobes.glass), (0.0, 1.0, false));
    let blended = Material { alpha_mode: AlphaMode::Blend, ..clear };
    let lobes = Lobes::of(&blended).expect("lobes");
    assert_eq!((lobes.dielectric.matte, lobes.through, lobes.glass), (1.0, 0.0, true));
}

#[test]
fn reflections_stay_on_clear_glass() {
    // Only a highlight: as bright over black as if it were opaque.
    let (color, alpha) = glass(Vec3::splat(0.9), Vec3::splat(0.8), 0.0);
    assert!((color * alpha - Vec3::splat(0.8)).length() < 1e-6);
    // No highlight: plain blending.
    let (color, alpha) = glass(Vec3::new(0.1, 0.2, 0.3), Vec3::ZERO, 0.25);
    assert_eq!((color, alpha), (Vec3::new(0.1, 0.2, 0.3), 0.25));
    let (color, alpha) = glass(Vec3::ZERO, Vec3::ZERO, 0.0);
    assert_eq!((color, alpha), (Vec3::ZERO, 0.0));
}
