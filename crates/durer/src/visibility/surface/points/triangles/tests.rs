//! The guarantees of settled triangles.

use super::*;
use crate::math::DVec3;
use crate::scene::{Camera, Mesh};
use crate::simd::levels;
use crate::testing::{Numbers, camera, scene_of};
use crate::visibility::surface::setup::runs;

const COUNT: u32 = 2_000;

const EYE: DVec3 = DVec3::new(0.2, 0.1, 3.0);

/// Returns triangles of all sizes, some of them needles, with normals that differ more or less from their faces'.
fn scene() -> Scene {
    let (mut numbers, mut mesh) = (Numbers(3), Mesh::default());
    for _ in 0..COUNT {
        let (size, middle) = (0.01_f32.powf(numbers.unit()), numbers.vector());
        let [a, mut b, c] = [0; 3].map(|_| middle + numbers.vector() * size);
        if numbers.unit() < 0.2 {
            b = a + (c - a) * numbers.unit() + numbers.vector() * (size * 0.01);
        }
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let (off, length) = (numbers.unit() * 1.2, 0.1 + numbers.unit());
        for corner in [a, b, c] {
            mesh.positions.push(corner);
            mesh.normals.push((normal + numbers.vector() * off) * length);
        }
    }
    scene_of(mesh)
}

/// Returns the corners of a triangle on the screen, if all are in front of the eye.
fn on_screen(scene: &Scene, view: &View, item: u32) -> Option<[[f64; 2]; 3]> {
    let mut at = [[0.0; 2]; 3];
    for (i, to) in at.iter_mut().enumerate() {
        let p = scene.meshes[0].positions[item as usize * 3 + i].as_dvec3();
        let p = view.screen_from_world() * p.extend(1.0);
        *to = [p.x / p.w, p.y / p.w];
        if p.w <= 0.0 {
            return None;
        }
    }
    Some(at)
}

fn is_inside([a, b, c]: [[f64; 2]; 3], p: [f64; 2]) -> bool {
    let side =
        |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    let sides = [side(a, b), side(b, c), side(c, a)];
    sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0)
}

#[test]
fn settled_normals_are_those_of_the_corners_and_on_the_side_that_is_seen() {
    let scene = scene();
    let runs = runs(&scene).expect("runs");
    // Settled triangles, samples inside triangles, and samples whose pixel centres are inside too.
    let (mut settled, mut samples, mut centers) = (0, 0, 0);
    for projection in
        [Projection::Perspective { fov_y: 0.8 }, Projection::Orthographic { height: 2.5 }]
    {
        let camera = Camera { far: 10.0, ..camera(EYE, projection) };
        let view = View::new(camera, 200, 150).expect("view");
        for reach in [0, 96, 128] {
            let level = levels()[0];
            let mut triangles = Triangles::new(&scene, &view, &runs, level, (1024, reach));
            let mut numbers = Numbers(5);
            for item in 0..COUNT {
                let t = *triangles.get(item, 0);
                let Some(corners) = on_screen(&scene, &view, item).filter(|_| t.normals.settled)
                else {
                    continue;
                };
                settled += 1;
                let corner = |i: usize, axis: usize| corners[i][axis].floor();
                let [low, high] = [f64::min, f64::max].map(|f| {
                    [0, 1].map(|axis| f(f(corner(0, axis), corner(1, axis)), corner(2, axis)))
                });
                for _ in 0..20 {
                    let pixel = [0, 1].map(|axis| {
                        let range = high[axis] - low[axis] + 1.0;
                        (low[axis] + (range * f64::from(numbers.unit())).floor()) as i32
                    });
                    let center = pixel.map(|v| f64::from(v) + 0.5);
                    // Vertices are rounded before samples are tested against triangles.
                    let most = f64::from(reach) / 256.0 + 0.5 / 256.0;
                    let at = center.map(|v| v + (f64::from(numbers.unit()) * 2.0 - 1.0) * most);
                    if !is_inside(corners, at) {
                        continue;
                    }
                    samples += 1;
                    let normal = t.normals.at(pixel).normalize();
                    assert!(normal.dot(t.seen_face_normal) > 0.1, "{item} {pixel:?} {t:?}");
                    if is_inside(corners, center) {
                        centers += 1;
                        let within = t.normal_within(pixel[0], pixel[1]).normalize();
                        let within = if t.from_behind { -within } else { within };
                        assert!(normal.dot(within) > 0.999_999, "{item} {pixel:?} {t:?}");
                    }
                }
            }
        }
    }
    assert!(settled > 2_000, "{settled}");
    assert!(samples > 10_000 && centers > 8_000 && centers < samples, "{samples} {centers}");
}

#[test]
fn normals_alone_are_those_of_the_whole_triangle() {
    let scene = scene();
    let runs = runs(&scene).expect("runs");
    let projection = Projection::Perspective { fov_y: 0.8 };
    let camera = Camera { far: 10.0, ..camera(EYE, projection) };
    let view = View::new(camera, 200, 150).expect("view");
    for level in levels() {
        let mut whole = Triangles::new(&scene, &view, &runs, level, (64, 96));
        let mut alone = Triangles::new(&scene, &view, &runs, level, (64, 96));
        for item in 0..COUNT {
            let (a, b) = (whole.get(item, 0).normals, *alone.normals(item, 0));
            assert_eq!(format!("{a:?}"), format!("{b:?}"));
        }
    }
}
