//! Blended surfaces by several methods: surfaces behind show through in depth order.

use crate::scenes::{self, Numbers};
use crate::surface_scenes::{Prepared, of_triangles};
use durer::math::{Vec3, Vec4};
use durer::pipeline::{RenderOptions, Samples, SurfaceMethod, render};
use durer::scene::{AlphaMode, Camera, Material, Part, Projection, Scene, ShadingModel};
use durer::shade::color::{encode_rgba8, premultiply};
use durer::target::Framebuffer;
use durer::trace::NoTrace;
use durer::visibility::surface::a_buffer::SubpixelMask;
use durer::visibility::surface::warnock;

/// Returns random triangles, every second one blended, unlit.
fn half_glass(seed: u64) -> Scene {
    let mut numbers = Numbers(seed.wrapping_mul(7919).wrapping_add(3));
    let triangles: Vec<[Vec3; 3]> = (0..24)
        .map(|_| {
            let center = numbers.point(0.8);
            [0; 3].map(|_| center + numbers.point(0.9))
        })
        .collect();
    let mut scene = of_triangles(&triangles);
    for i in 0..24 {
        let blended = i % 2 == 1;
        scene.materials.push(Material {
            model: ShadingModel::Unlit,
            base_color: numbers.point(0.5).abs().extend(if blended {
                0.2 + 0.03 * i as f32
            } else {
                1.0
            }),
            alpha_mode: if blended { AlphaMode::Blend } else { AlphaMode::Opaque },
            ..Material::default()
        });
        let range = i as u32..i as u32 + 1;
        scene.meshes[0].parts.push(Part { range, material: Some(i), name: String::new() });
    }
    scene
}

fn picture(scene: &Scene, algorithm: SurfaceMethod, samples: Samples) -> Framebuffer {
    let options = scenes::options(scene, 90, 70);
    let options = RenderOptions { algorithm, samples, item: true, ..options };
    render(scene, &options).expect("picture").0
}

#[test]
fn all_methods_compose_what_the_z_buffer_sorts() {
    for (name, scene) in (0..12)
        .map(|seed| (format!("seed {seed}"), half_glass(seed)))
        .chain([("materials".to_owned(), scenes::materials())])
    {
        let expected = picture(&scene, SurfaceMethod::ZBuffer, Samples::One);
        // The A-buffer also anti-aliases edges, and has its own test.
        for &method in SurfaceMethod::ALL.iter().filter(|m| **m != SurfaceMethod::ABuffer) {
            let found = picture(&scene, method, Samples::One);
            let pairs = found.color.data().iter().zip(expected.color.data());
            assert_eq!(pairs.filter(|(a, b)| a != b).count(), 0, "{method} {name}");
            assert!(found.item == expected.item, "{method} {name}");
        }
    }
}

/// Draws so many intersecting panes that they are lit in several batches; the last ones are not visible.
#[test]
fn all_methods_agree_where_next_to_nothing_comes_through_many_panes() {
    let mut numbers = Numbers(5);
    let triangles: Vec<[Vec3; 3]> =
        (0..160).map(|_| [0; 3].map(|_| numbers.point(3.0) * Vec3::new(1.0, 1.0, 0.3))).collect();
    let mut scene = of_triangles(&triangles);
    for i in 0..triangles.len() {
        let alpha = if i % 40 == 0 { 1.0 } else { 0.1 + 0.5 * numbers.next() };
        scene.materials.push(Material {
            model: ShadingModel::Unlit,
            base_color: numbers.point(0.5).abs().extend(alpha),
            alpha_mode: AlphaMode::Blend,
            ..Material::default()
        });
        let range = i as u32..i as u32 + 1;
        scene.meshes[0].parts.push(Part { range, material: Some(i), name: String::new() });
    }
    let expected = picture(&scene, SurfaceMethod::ScanLineZ, Samples::One);
    let found = picture(&scene, SurfaceMethod::ZBuffer, Samples::One);
    let pairs = found.color.data().iter().zip(expected.color.data());
    assert_eq!(pairs.filter(|(a, b)| a != b).count(), 0);
}

/// Checks quads that face the eye, with pixel-aligned edges and random depths: sorting and compositing give the
/// expected picture.
#[test]
fn the_a_buffer_is_sorted_compositing() {
    const SIDE: u32 = 24;
    // Behind the first two or three dozen of sixty panes nothing is visible.
    for (seed, count) in (0..20).map(|seed| (seed, 9)).chain([(20, 60), (21, 60)]) {
        let mut numbers = Numbers(seed + 77);
        let mut scene = Scene::default();
        let mut panes: Vec<(f32, [u32; 4], Vec4)> = Vec::new();
        let mut triangles = Vec::new();
        for i in 0..count {
            let mut side = || (numbers.next() * (SIDE as f32 + 1.0)) as u32;
            let (a, b, c, d) = (side(), side(), side(), side());
            let (x0, x1, y0, y1) = (a.min(b), a.max(b), c.min(d), c.max(d));
            let z = numbers.next() * 1.8 - 0.9;
            let alpha = if i % 3 == 0 && i < 9 { 1.0 } else { 0.15 + 0.7 * numbers.next() };
            let color = Vec4::new(numbers.next(), numbers.next(), numbers.next(), alpha);
            let at = |x: u32, y: u32| {
                let half = SIDE as f32 / 2.0;
                Vec3::new(x as f32 / half - 1.0, 1.0 - y as f32 / half, z)
            };
            let [p, q, r, s] = [at(x0, y0), at(x1, y0), at(x1, y1), at(x0, y1)];
            triangles.extend([[p, q, r], [p, r, s]]);
            panes.push((z, [x0, x1, y0, y1], color));
            scene.materials.push(Material {
                model: ShadingModel::Unlit,
                base_color: color,
                alpha_mode: if alpha < 1.0 { AlphaMode::Blend } else { AlphaMode::Opaque },
                ..Material::default()
            });
        }
        let geometry = of_triangles(&triangles);
        (scene.meshes, scene.instances) = (geometry.meshes, geometry.instances);
        let part = |i: u32| Part {
            range: 2 * i..2 * i + 2,
            material: Some(i as usize),
            name: String::new(),
        };
        scene.meshes[0].parts = (0..count).map(part).collect();
        let camera = Camera {
            eye: Vec3::new(0.0, 0.0, 2.0).as_dvec3(),
            target: Vec3::ZERO.as_dvec3(),
            up: Vec3::Y.as_dvec3(),
            projection: Projection::Orthographic { height: 2.0 },
            near: 1.0,
            far: 3.0,
        };
        panes.sort_by(|a, b| a.0.total_cmp(&b.0));
        for mask in [SubpixelMask::M16, SubpixelMask::M64] {
            let mut options = RenderOptions {
                algorithm: SurfaceMethod::ABuffer,
                mask,
                ..RenderOptions::new(camera)
            };
            (options.width, options.height) = (SIDE, SIDE);
            let found = render(&scene, &options).expect("picture").0;
            for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
                let here = panes.iter().filter(|(_, [x0, x1, y0, y1], _)| {
                    (*x0..*x1).contains(&x) && (*y0..*y1).contains(&y)
                });
                let sum = here.fold(Vec4::ONE, |under, (_, _, color)| {
                    premultiply(*color) + under * (1.0 - color.w)
                });
                let found = found.color.get(x, y).expect("pixel");
                let close = encode_rgba8(sum).iter().zip(found).all(|(a, b)| a.abs_diff(b) <= 1);
                assert!(close, "seed {seed} {mask:?} {x},{y}: {found:?}, {:?}", encode_rgba8(sum));
            }
        }
    }
}

/// Checks that with several samples subdivision and rays compose at each sample, and that more samples approach the
/// picture of very many.
#[test]
fn samples_are_composed_one_by_one() {
    for seed in 0..3 {
        let scene = half_glass(seed);
        let p = Prepared::new(&scene, 45, 35);
        let fine = |sub_levels| {
            let mut framebuffer = p.framebuffer();
            let options = warnock::Options { sub_levels, ..Default::default() };
            warnock::render(&p.fine_input(), &p.lights, &options, &mut framebuffer, &mut NoTrace);
            framebuffer
        };
        let best = fine(4);
        let error = |found: &Framebuffer| -> u32 {
            let pairs =
                found.color.data().as_flattened().iter().zip(best.color.data().as_flattened());
            pairs.map(|(a, b)| u32::from(a.abs_diff(*b))).sum()
        };
        let errors = [0, 1, 2].map(|level| error(&fine(level)));
        assert!(errors.is_sorted_by(|a, b| *a > b + b / 4), "seed {seed}: {errors:?}");
        let small = RenderOptions {
            algorithm: SurfaceMethod::Ray,
            width: 45,
            height: 35,
            ..scenes::options(&scene, 45, 35)
        };
        let rays = [Samples::One, Samples::Four, Samples::Sixteen].map(|samples| {
            error(&render(&scene, &RenderOptions { samples, ..small.clone() }).expect("picture").0)
        });
        assert!(rays.is_sorted_by(|a, b| *a > b + b / 4), "seed {seed}: {rays:?}");
        assert_eq!(rays[0], errors[0], "one sample at the centre is the same by both");
    }
}

#[test]
fn planes_show_the_nearest_surface_blended_or_not() {
    let scene = half_glass(3);
    let expected = Prepared::new(&scene, 90, 70).by_z_buffer();
    for sub_levels in [0, 1] {
        let p = Prepared::new(&scene, 90, 70);
        let mut found = p.framebuffer();
        let options = warnock::Options { sub_levels, ..Default::default() };
        warnock::render(&p.input(), &p.lights, &options, &mut found, &mut NoTrace);
        assert!(found.item == expected.item && found.depth == expected.depth, "{sub_levels}");
        assert!(found.normal == expected.normal, "{sub_levels}");
    }
}
