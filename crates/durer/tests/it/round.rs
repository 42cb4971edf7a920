//! Cylinders among faces: holes, pins, rounded edges, and shapes that are no cylinders.

use crate::data;
use crate::line_scenes::{Triangle, cuboid, cylinder, placed, soup, torus};
use durer::math::{DMat4, DVec3};
use durer::scene::Scene;
use durer::visibility::object::{Cylinder, Faces, cylinders};
use std::f64::consts::{PI, TAU};
use std::path::Path;

fn of_scene(scene: &Scene) -> Vec<Cylinder> {
    cylinders(&Faces::new(scene).expect("faces"))
}

/// Returns an upright tube between two radii, its sides from one angle to another.
fn tube(center: [f64; 2], radii: [f64; 2], heights: [f64; 2], n: usize) -> Vec<Triangle> {
    let at = |i: usize, r: f64, z: f64| {
        let (sin, cos) = ((i % n) as f64 / n as f64 * TAU).sin_cos();
        DVec3::new(center[0] + r * cos, center[1] + r * sin, z)
    };
    let ([inner, outer], [low, high]) = (radii, heights);
    let side = |i: usize| {
        let (k, corner) = (i + 1, [(outer, low), (outer, high), (inner, high), (inner, low)]);
        (0..4).flat_map(move |j| {
            let ((r, z), (s, w)) = (corner[j], corner[(j + 1) % 4]);
            let [a, b, c, d] = [at(i, r, z), at(k, r, z), at(k, s, w), at(i, s, w)];
            [[a, b, c], [a, c, d]]
        })
    };
    (0..n).flat_map(side).collect()
}

/// Returns a ball with rings of latitude.
fn ball(around: usize, rings: usize) -> Vec<Triangle> {
    let at = |i: usize, k: usize| {
        let (s, c) = ((i % around) as f64 / around as f64 * TAU).sin_cos();
        let (t, d) = (k as f64 / rings as f64 * PI - PI / 2.0).sin_cos();
        DVec3::new(c * d, s * d, t) * 3.0
    };
    let cells = (0..around).flat_map(|i| (0..rings).map(move |k| (i, k)));
    let quads = cells.flat_map(|(i, k)| {
        let [a, b, c, d] = [at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)];
        [[a, b, c], [a, c, d]]
    });
    quads.filter(|t| (t[1] - t[0]).cross(t[2] - t[0]).length() > 1e-9).collect()
}

#[test]
fn a_tube_is_a_hole_and_a_boss() {
    let turned = DMat4::from_rotation_y(0.3) * DMat4::from_rotation_x(1.1);
    for n in [12, 13, 24, 90, 400] {
        let scene = placed(&tube([7.0, -3.0], [2.0, 5.0], [1.0, 4.0], n), turned);
        let found = of_scene(&scene);
        let [outer, inner] = found[..] else { panic!("{n}: {found:?}") };
        for (c, radius, hollow) in [(outer, 5.0, false), (inner, 2.0, true)] {
            assert!((c.radius - radius).abs() < 2e-6 * radius && c.hollow == hollow, "{n}: {c:?}");
            assert!(c.is_full() && c.triangles == 2 * n as u32, "{n}: {c:?}");
            let mut heights = c.ends.map(|p| turned.inverse().transform_point3(p));
            heights.sort_by(|a, b| a.z.total_cmp(&b.z));
            let expected = [DVec3::new(7.0, -3.0, 1.0), DVec3::new(7.0, -3.0, 4.0)];
            for (p, q) in heights.iter().zip(expected) {
                assert!(p.distance(q) < 1e-4, "{n}: {p} {q}");
            }
        }
    }
}

#[test]
fn faces_turned_inside_out_are_still_holes_and_bosses() {
    let mut triangles = tube([0.0, 0.0], [2.0, 5.0], [1.0, 4.0], 48);
    triangles.iter_mut().for_each(|t| t.swap(0, 1));
    let found = of_scene(&soup(&triangles));
    assert_eq!(found.iter().map(|c| c.hollow).collect::<Vec<_>>(), [false, true]);
}

#[test]
fn rims_divided_differently_and_rows_are_one_cylinder() {
    // A side whose lower rim has half as many corners as its upper one, in three rows.
    let at = |i: usize, n: usize, z: f64| {
        let (s, c) = ((i % n) as f64 / n as f64 * TAU).sin_cos();
        DVec3::new(4.0 * c, 4.0 * s, z)
    };
    let mut triangles = Vec::new();
    for i in 0..36 {
        let low = [at(i, 36, 0.0), at(i + 1, 36, 0.0)];
        let high = [at(2 * i, 72, 3.0), at(2 * i + 1, 72, 3.0), at(2 * i + 2, 72, 3.0)];
        triangles.extend([
            [low[0], high[1], high[0]],
            [low[0], low[1], high[1]],
            [low[1], high[2], high[1]],
        ]);
        let [a, b] = [at(i, 36, -5.0), at(i + 1, 36, -5.0)];
        triangles.extend([[a, b, low[1]], [a, low[1], low[0]]]);
    }
    let found = of_scene(&soup(&triangles));
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!((found[0].triangles, found[0].is_full()), (180, true));
    assert!((found[0].ends[0].distance(found[0].ends[1]) - 8.0).abs() < 1e-5);
}

#[test]
fn a_fillet_is_a_quarter() {
    // A bar with one rounded edge: a square of 10 with a corner radius of 3.
    let arc = (0..=9).map(|i| {
        let (s, c) = (f64::from(i) * 10f64.to_radians()).sin_cos();
        [7.0 + 3.0 * c, 7.0 + 3.0 * s]
    });
    let outline: Vec<[f64; 2]> =
        [[0.0, 0.0], [10.0, 0.0]].into_iter().chain(arc).chain([[0.0, 10.0]]).collect();
    let mut triangles = Vec::new();
    for (i, &[x, y]) in outline.iter().enumerate() {
        let [u, v] = outline[(i + 1) % outline.len()];
        let p = |x, y, z| DVec3::new(x, y, z);
        triangles.extend([
            [p(x, y, 0.0), p(u, v, 0.0), p(u, v, 20.0)],
            [p(x, y, 0.0), p(u, v, 20.0), p(x, y, 20.0)],
            [p(0.0, 0.0, 20.0), p(x, y, 20.0), p(u, v, 20.0)],
            [p(0.0, 0.0, 0.0), p(u, v, 0.0), p(x, y, 0.0)],
        ]);
    }
    let found = of_scene(&soup(&triangles));
    assert_eq!(found.len(), 1, "{found:?}");
    let c = &found[0];
    assert!((c.radius - 3.0).abs() < 1e-5 && !c.hollow && (c.angle - PI / 2.0).abs() < 1e-3);
    assert!(c.ends.iter().all(|p| (p.truncate() - 7.0).length() < 1e-5), "{c:?}");
}

#[test]
fn a_cylinder_with_a_slot_is_one() {
    // Two halves a little apart, as in a clamp.
    let keep = |t: &Triangle| {
        let middle = (t[0] + t[1] + t[2]) / 3.0;
        middle.y.abs() > 0.6
    };
    let triangles: Vec<Triangle> =
        cylinder([0.0; 2], 4.0, [0.0, 5.0], 60).into_iter().filter(keep).collect();
    let sides: Vec<Triangle> =
        triangles.into_iter().filter(|t| t.iter().all(|p| p.truncate().length() > 1.0)).collect();
    let found = of_scene(&soup(&sides));
    assert_eq!(found.len(), 1, "{found:?}");
    assert!((found[0].angle - TAU).abs() < 1.0);
}

#[test]
fn prisms_balls_and_rings_are_no_cylinders() {
    for n in [3, 4, 6, 8, 11] {
        assert!(of_scene(&soup(&cylinder([0.0; 2], 2.0, [0.0, 5.0], n))).is_empty(), "{n}");
    }
    for (around, across) in [(16, 12), (48, 24), (49, 25), (200, 99)] {
        let found = of_scene(&soup(&torus(around, across)));
        assert!(found.is_empty(), "torus {around}, {across}: {found:?}");
        let found = of_scene(&soup(&ball(around, across)));
        assert!(found.is_empty(), "ball {around}, {across}: {found:?}");
    }
    assert!(of_scene(&soup(&cuboid([0.0; 3], [1.0; 3]))).is_empty());
    assert!(of_scene(&Scene::default()).is_empty());
}

/// Returns the radius of each full cylinder and whether it is a hole, sorted.
fn full(found: &[Cylinder]) -> Vec<(f64, bool)> {
    let mut list: Vec<(f64, bool)> =
        found.iter().filter(|c| c.is_full()).map(|c| (c.radius, c.hollow)).collect();
    // To a thousandth, so that noise does not affect the order.
    list.sort_by_key(|c| ((c.0 * 1e3).round() as i64, !c.1));
    list
}

fn assert_radii(name: &str, found: &[Cylinder], expected: &[(f64, bool)]) {
    let list = full(found);
    let close = |(a, b): (&(f64, bool), &(f64, bool))| (a.0 - b.0).abs() < 1e-4 && a.1 == b.1;
    assert!(
        list.len() == expected.len() && list.iter().zip(expected).all(close),
        "{name}: {list:?}"
    );
}

#[test]
fn holes_of_parts_are_found() {
    let sample = |name: &str| {
        let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples");
        of_scene(&data::read_model(&samples.join(name)).scene)
    };
    let bracket = [3.0, 3.3, 3.3, 3.3, 3.3, 4.5, 4.5, 6.0].map(|r| (r, true));
    let mut bracket = bracket.to_vec();
    bracket.push((6.0, false));
    assert_radii("bracket", &sample("bracket.stl"), &bracket);
    assert_radii("teapot", &sample("teapot.obj"), &[]);
    let Some(folder) = data::folder() else { return };
    let scene = data::read_model(&folder.join("cases/drawing/flange_tol0.2.stl")).scene;
    let found = of_scene(&scene);
    let bolts = [(3.5, true); 8].into_iter().chain([(14.0, true), (20.0, false), (40.0, false)]);
    assert_radii("flange", &found, &bolts.collect::<Vec<_>>());
    // Its fillets are parts of rings; hardly any is taken for a cylinder.
    assert!(found.len() < 20, "{}", found.len());
}
