//! Energy that is kept, and limits that the formula tends to.

use super::*;
use crate::shade::environment::Environment;
use crate::shade::light::DirectionalLight;
use crate::shade::normal::face_viewer;

fn leaving(view: Vec3, base: f32, metallic: f32, roughness: f32, lights: &PreparedLights) -> f32 {
    let frame = face_viewer(view.into(), Vec3::Z.into(), Vec3::Z.into());
    let base = Vec3Lane::from(Vec3::splat(base));
    let mirrors = metallic > 0.0;
    let substance = Substance { base, metallic, roughness, occlusion: 1.0, mirrors };
    reflect(&frame, Vec3::ZERO.into(), &substance, Dielectric::PLAIN, lights).x
}

fn direction(cosine: f32, turn: f32) -> Vec3 {
    let sine = (1.0 - cosine * cosine).sqrt();
    Vec3::new(sine * turn.cos(), sine * turn.sin(), cosine)
}

#[test]
fn white_things_vanish_in_white_surroundings() {
    let furnace = PreparedLights::far(Environment::uniform(Vec3::ONE), Vec::new());
    for (m, r, c) in (0..=10).flat_map(|m| {
        (0..=10).flat_map(move |r| (1..=10).map(move |c| (m as f32, r as f32, c as f32)))
    }) {
        let view = direction(c / 10.0, 0.3);
        let light = leaving(view, 1.0, m / 10.0, r / 10.0, &furnace);
        assert!((light - 1.0).abs() < 0.01, "{m} {r} {c}: {light}");
    }
}

/// Returns the whole hemisphere of directional lights, each with its share of a uniform
/// surrounding.
fn hemisphere() -> PreparedLights {
    let mut directional = Vec::new();
    let (rings, sectors) = (96, 192);
    for ring in 0..rings {
        // Rings of equal solid angle; radiance 1 over π in the light's unit.
        let cosine = (ring as f32 + 0.5) / rings as f32;
        for sector in 0..sectors {
            let turn = (sector as f32 + 0.5) / sectors as f32 * std::f32::consts::TAU;
            let color = Vec3::splat(2.0 / (rings * sectors) as f32);
            directional.push(DirectionalLight { to_light: direction(cosine, turn), color });
        }
    }
    PreparedLights::far(Environment::uniform(Vec3::ZERO), directional)
}

#[test]
fn lights_from_everywhere_make_white_metal_white() {
    let furnace = hemisphere();
    for roughness in [0.35, 0.5, 0.7, 0.85, 1.0] {
        for cosine in [0.4, 0.7, 0.95] {
            let light = leaving(direction(cosine, 0.1), 1.0, 1.0, roughness, &furnace);
            assert!((light - 1.0).abs() < 0.12, "{roughness} {cosine}: {light}");
            let matte = leaving(direction(cosine, 0.1), 1.0, 0.0, roughness, &furnace);
            assert!((matte - 1.0).abs() < 0.12, "matte {roughness} {cosine}: {matte}");
        }
    }
}

#[test]
fn direct_and_ambient_reflection_agree() {
    // The closed form, compared with the formula that it approximates, summed over the hemisphere.
    let (sum, closed) =
        (hemisphere(), PreparedLights::far(Environment::uniform(Vec3::ONE), Vec::new()));
    for roughness in [0.4, 0.6, 0.8, 1.0] {
        for (base, metallic) in [(0.5, 1.0), (0.9, 1.0), (0.0, 0.0), (0.5, 0.0)] {
            let view = direction(0.8, 0.0);
            let a = leaving(view, base, metallic, roughness, &sum);
            let b = leaving(view, base, metallic, roughness, &closed);
            assert!((a - b).abs() < 0.06, "{roughness} {base} {metallic}: {a} {b}");
        }
    }
}

#[test]
fn rough_dielectrics_tend_to_lambert() {
    let key = DirectionalLight { to_light: direction(0.6, 1.0), color: Vec3::ONE };
    let one = PreparedLights::far(Environment::uniform(Vec3::ZERO), vec![key]);
    let light = leaving(Vec3::Z, 0.5, 0.0, 1.0, &one);
    // 0.5 · 0.6 · 0.96, and a specular part of at most 4 %.
    assert!((light - 0.288).abs() < 0.04, "{light}");
    let dark = leaving(Vec3::Z, 0.0, 0.0, 1.0, &one);
    assert!(dark > 0.0 && dark < 0.04, "{dark}");
}
