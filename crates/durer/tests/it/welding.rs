//! Faces that meet up to rounding: vertices, T-junctions, triangles without height.

use crate::line_scenes::{Random, Triangle, cuboid, cylinder, quad, soup, view};
use durer::math::{DMat4, DVec3, Vec3};
use durer::scene::{Instance, Mesh, Scene};
use durer::target::drawing::{Drawing, LineClass};
use durer::trace::NoTrace;
use durer::visibility::line::hidden_line::{Options, draw};
use durer::visibility::object::{Bodies, Faces, Weld};

const ISO: DVec3 = DVec3::new(1.0, -1.7, 0.9);

fn drawn(scene: &Scene, weld: Weld) -> Drawing {
    let options = Options { weld, ..Options::default() };
    draw(scene, &view(DVec3::splat(1.0), ISO, 8.0, false), &options, &mut NoTrace).expect("drawing")
}

fn lengths(drawing: &Drawing) -> [f64; 2] {
    [drawing.length(|l| l.is_visible()), drawing.length(|l| !l.is_visible())]
}

/// Compares lines with those of the same body without faults.
fn assert_like(name: &str, found: &Drawing, expected: &Drawing) {
    let borders = found.length(|l| matches!(l.class, LineClass::Border | LineClass::NonManifold));
    assert_eq!((found.edges.borders, borders), (0, 0.0), "{name}");
    for (a, b) in lengths(found).iter().zip(lengths(expected)) {
        assert!((a - b).abs() < 1e-4 * b, "{name}: {a} instead of {b}");
    }
}

/// Returns a cuboid with noise in all corners of all triangles.
fn noisy(amount: f64) -> Vec<Triangle> {
    let mut random = Random(5);
    let mut number = || (random.next() - 0.5) * 2.0 * amount;
    let mut jitter = |p: DVec3| p + DVec3::new(number(), number(), number());
    cuboid([0.0; 3], [2.0; 3]).into_iter().map(|t| t.map(&mut jitter)).collect()
}

#[test]
fn corners_that_rounding_has_moved_are_one() {
    let exact = drawn(&soup(&cuboid([0.0; 3], [2.0; 3])), Weld::Auto);
    assert_eq!((exact.edges.edges, exact.edges.borders), (18, 0));
    for amount in [1e-9, 1e-8, 1e-7, 1e-6, 2e-6] {
        let found = drawn(&soup(&noisy(amount)), Weld::Auto);
        assert_like(&format!("{amount}"), &found, &exact);
    }
    // Larger displacements are not rounding, but welding them may be requested.
    let apart = soup(&noisy(1e-3));
    assert!(drawn(&apart, Weld::Auto).edges.borders > 18);
    assert_eq!(drawn(&apart, Weld::Within(4e-3)).edges.borders, 0);
    assert!(drawn(&soup(&noisy(1e-6)), Weld::None).edges.borders > 18);
}

#[test]
fn what_few_digits_have_moved_is_one() {
    let mut body = cuboid([0.0; 3], [2.0; 3]);
    let exact = drawn(&soup(&body), Weld::Auto);
    body[4][0] += DVec3::new(1e-4, -1e-4, 1e-4);
    let mut scene = soup(&body);
    assert!(drawn(&scene, Weld::Auto).edges.borders > 0);
    scene.last_digit = 1e-4;
    assert_like("four decimals", &drawn(&scene, Weld::Auto), &exact);
    // Coordinates with so few digits are taken as exact.
    scene.last_digit = 0.01;
    assert!(drawn(&scene, Weld::Auto).edges.borders > 0);
}

/// Splits each second triangle into a fan from one corner: its sides are divided but those of its neighbours are not.
fn with_junctions(triangles: &[Triangle], parts: usize) -> Vec<Triangle> {
    let mut made = Vec::new();
    for (i, &[a, b, c]) in triangles.iter().enumerate() {
        let at = |k: usize| b + (c - b) * (k as f64 / parts as f64);
        match i % 2 {
            0 => made.push([a, b, c]),
            _ => made.extend((0..parts).map(|k| [a, at(k), at(k + 1)])),
        }
    }
    made
}

#[test]
fn edges_along_several_others_have_two_sides() {
    for (name, body) in [
        ("cuboid", cuboid([0.0; 3], [2.0; 3])),
        ("cylinder", cylinder([1.0, 1.0], 1.0, [0.0, 2.0], 48)),
    ] {
        let whole = drawn(&soup(&body), Weld::Auto);
        for parts in [2, 3, 7] {
            let found = drawn(&soup(&with_junctions(&body, parts)), Weld::Auto);
            assert_like(&format!("{name} in {parts}"), &found, &whole);
        }
    }
}

#[test]
fn triangles_without_height_make_no_lines() {
    let body = cuboid([0.0; 3], [2.0; 3]);
    let whole = drawn(&soup(&body), Weld::Auto);
    // Between two triangles, one of them divided; and along an edge that has two sides already.
    let [a, b, c] = body[3];
    let middle = (b + c) * 0.5;
    let mut between = body.clone();
    between.splice(3..4, [[a, b, middle], [a, middle, c], [b, c, middle]]);
    let along = [&body[..], &[[b, middle, c]]].concat();
    for off in [0.0, 1e-7, 1e-6] {
        for (name, triangles) in [("between", &between), ("along", &along)] {
            let mut moved = triangles.clone();
            moved.iter_mut().flatten().filter(|p| **p == middle).for_each(|p| p.x += off);
            assert_like(&format!("{name}, {off}"), &drawn(&soup(&moved), Weld::Auto), &whole);
        }
    }
}

/// Returns each face of a body as a mesh of its own, under matrices of its own.
fn facewise(triangles: &[Triangle]) -> Scene {
    let mut scene = Scene::default();
    for (pair, i) in triangles.chunks(2).zip(0..) {
        let turn = DMat4::from_rotation_z(0.3 * f64::from(i));
        let world_from_mesh = turn * DMat4::from_translation(DVec3::new(0.1, 0.2, 0.3));
        let back = world_from_mesh.inverse();
        let local = |p: &DVec3| back.transform_point3(*p).as_vec3();
        let positions: Vec<Vec3> = pair.iter().flatten().map(local).collect();
        scene.instances.push(Instance { mesh: i as usize, world_from_mesh, name: String::new() });
        scene.meshes.push(Mesh { positions, ..Mesh::default() });
    }
    scene
}

#[test]
fn faces_of_one_tree_meet_and_those_of_others_do_not() {
    let body = cuboid([0.0; 3], [2.0; 3]);
    let mut scene = facewise(&body);
    assert_like("one tree", &drawn(&scene, Weld::Auto), &drawn(&soup(&body), Weld::Auto));
    scene.trees = vec![0, 0, 0, 1, 1, 1];
    let borders = drawn(&scene, Weld::Auto).edges.borders;
    assert!(borders > 0, "{borders}");
    assert_eq!(drawn(&scene, Weld::None).edges.borders, 24);
}

#[test]
fn what_is_apart_stays_apart() {
    // Walls are closed, however thin; sheets a hair apart; a hole no larger than the reach of a border.
    let wall = cuboid([0.0; 3], [2.0, 2.0, 1e-6]);
    assert_eq!(drawn(&soup(&wall), Weld::Auto).edges.edges, 18);
    let sheet = |z: f64| quad([[0.0, 0.0, z], [2.0, 0.0, z], [2.0, 2.0, z], [0.0, 2.0, z]]);
    let two = [sheet(0.0), sheet(1e-4)].concat();
    assert_eq!(drawn(&soup(&two), Weld::Auto).edges.borders, 8);
    let small = DMat4::from_scale(DVec3::splat(1e-5));
    let mut scene = soup(&[sheet(0.0), cuboid([5.0; 3], [6.0; 3])].concat());
    let tiny = sheet(0.5).iter().map(|t| t.map(|p| small.transform_point3(p))).collect::<Vec<_>>();
    scene.meshes[0].positions.extend(tiny.iter().flatten().map(|p| p.as_vec3()));
    assert_eq!(drawn(&scene, Weld::Auto).edges.borders, 8);
}

#[test]
fn many_borders_on_each_other_are_given_up_soon() {
    // Each overlaps all others and ends within them.
    let fan = |i: u32| {
        let x = f64::from(i) * 1e-3;
        [DVec3::new(x, 0.0, 0.0), DVec3::new(x + 3.0, 0.0, 0.0), DVec3::new(x, 1.0, x)]
    };
    let fans: Vec<Triangle> = (0..2000).map(fan).collect();
    let faces = Faces::new(&soup(&fans)).expect("faces");
    assert_eq!(Bodies::find(&faces).1.count().borders, 6000);
}
