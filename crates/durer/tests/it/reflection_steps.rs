//! Steps of the metallic-roughness formula: recording them changes nothing, and they rebuild the light that is reflected.

use crate::raster_coverage::Random;
use durer::math::Vec3;
use durer::shade::metallic_roughness::{Lit, Step, reflect_one, replay};
use durer::trace::{NoTrace, PseudocodeLine, Recorder};

fn bits(color: Vec3) -> [u32; 3] {
    color.to_array().map(f32::to_bits)
}

fn recorded(lit: &Lit) -> (Vec3, Vec<Step>) {
    let mut steps = Recorder::default();
    let sum = reflect_one(lit, &mut steps);
    (sum, steps.into_steps())
}

#[test]
fn steps_lead_to_the_light_and_change_nothing() {
    let mut random = Random(12);
    for _ in 0..500 {
        let mut unit = || {
            let (p, z) = (random.point(-1.0, 1.0), random.next());
            p.extend(z + 0.01).normalize().as_vec3()
        };
        let [normal, to_eye, to_light] = [unit(), unit(), unit()];
        let [metallic, roughness] = random.point(0.0, 1.0).as_vec2().to_array();
        let base = Vec3::new(0.9, 0.6, 0.4);
        let lit = Lit { base, metallic, roughness, normal, to_eye, to_light };
        let (sum, steps) = recorded(&lit);
        assert_eq!(bits(sum), bits(reflect_one(&lit, &mut NoTrace)), "{lit:?}");
        assert_eq!(bits(sum), bits(replay(&steps)), "{lit:?}");
        assert!(steps.iter().all(|step| (1..=9).contains(&step.line())));
        assert!(sum.is_finite() && sum.min_element() >= 0.0, "{lit:?}: {sum}");
    }
}

/// l and v at 3 : 4 on both sides of the normal, roughness ½, as in the page on shading.
#[test]
fn the_worked_example_of_the_page() {
    let [to_light, to_eye] = [Vec3::new(-0.6, 0.8, 0.0), Vec3::new(0.6, 0.8, 0.0)];
    let base = Vec3::new(0.9, 0.6, 0.4);
    let plastic = Lit { base, metallic: 0.0, roughness: 0.5, normal: Vec3::Y, to_eye, to_light };
    let (sum, steps) = recorded(&plastic);
    let near = |found: f32, expected: f32| {
        assert!((found - expected).abs() < 1e-3 * expected.abs().max(1.0), "{found} {expected}");
    };
    let [Step::Cosines([nl, nv, nh, vh]), Step::Distribution { alpha, value: d }, rest @ ..] =
        &steps[..]
    else {
        panic!("{steps:?}")
    };
    for (x, y) in [(*nl, 0.8), (*nv, 0.8), (*nh, 1.0), (*vh, 0.8), (*alpha, 0.25)] {
        near(x, y);
    }
    // α² / (α²)² at the mirrored direction.
    near(*d, 16.0);
    let [
        Step::Visibility(v),
        Step::Fresnel { away, value: f, .. },
        Step::Diffuse { through, value },
        Step::Sum(_),
    ] = rest
    else {
        panic!("{steps:?}")
    };
    // ½ / (2 · 0.8 · √(0.64 · 15/16 + 1/16)), 0.2⁵, 1 − (0.04 + 0.96 · 0.2⁵).
    for (x, y) in [(*v, 0.3839), (*away, 0.00032), (*through, 0.9597)] {
        near(x, y);
    }
    near(value.x, 0.9 * 0.9597);
    assert!((0.0403..0.042).contains(&f.x), "{f}");
    near(sum.x, 0.8 * (0.9 * 0.9597 + 16.0 * 0.3839 * f.x));
    // A metal has the colour of its base in the mirrored light, and no other light.
    let (_, steps) = recorded(&Lit { metallic: 1.0, ..plastic });
    assert!(steps.contains(&Step::Diffuse { through: *through, value: Vec3::ZERO }));
    let behind = Lit { to_light: -Vec3::Y, ..plastic };
    assert_eq!(recorded(&behind).0, Vec3::ZERO);
}
