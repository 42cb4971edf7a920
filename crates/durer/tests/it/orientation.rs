//! Orientation of faces: components, neighbours, the outside, cavities, scenes.

use durer::math::{DMat4, DVec3, Vec3};
use durer::scene::{Instance, Mesh, Scene};
use durer::trace::{NoTrace, Recorder};
use durer::visibility::object::orientation::{Options, Outward, Step, orient, replay};
use durer::visibility::object::{Bodies, Faces, SceneOrientation};

/// The corners and faces of a box, outwards.
fn cuboid(low: DVec3, high: DVec3) -> (Vec<DVec3>, Vec<Vec<usize>>) {
    let corner = |n: usize| {
        let pick = |bit: usize, k: usize| if n >> bit & 1 == 1 { high[k] } else { low[k] };
        DVec3::new(pick(0, 0), pick(1, 1), pick(2, 2))
    };
    let faces =
        [[4, 5, 7, 6], [0, 2, 3, 1], [1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4]];
    ((0..8).map(corner).collect(), faces.map(|f| f.to_vec()).to_vec())
}

fn unit() -> (Vec<DVec3>, Vec<Vec<usize>>) {
    cuboid(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0))
}

fn centroid() -> Options {
    Options { outward: Outward::Centroid }
}

#[test]
fn every_choice_of_turned_faces_is_found() {
    let (points, right) = unit();
    for turned in 0..1_u32 << 6 {
        let mut faces = right.clone();
        for (face, ring) in faces.iter_mut().enumerate().filter(|(f, _)| turned >> f & 1 == 1) {
            ring.reverse();
            // Any corner may come first.
            ring.rotate_left(face % 4);
        }
        let expected: Vec<bool> = (0..6).map(|f| turned >> f & 1 == 1).collect();
        for options in [Options::default(), centroid()] {
            let mut steps = Recorder::default();
            let found = orient(&points, &faces, &options, &mut steps).expect("a box");
            assert_eq!(found.turned, expected, "{turned:06b} {options:?}");
            assert_eq!(replay(steps.steps(), 6), expected);
            assert_eq!(orient(&points, &faces, &options, &mut NoTrace), Ok(found.clone()));
            let [piece] = found.pieces[..] else { panic!("{found:?}") };
            let count = turned.count_ones() as usize;
            assert_eq!((piece.closed, piece.orientable, piece.faces), (true, true, 6));
            assert_eq!((piece.inside_out, piece.flipped), (count > 3, count.min(6 - count)));
        }
    }
}

#[test]
fn the_volume_and_each_product_are_shown() {
    let (points, mut faces) = unit();
    faces.iter_mut().for_each(|ring| ring.reverse());
    let mut steps = Recorder::default();
    let found = orient(&points, &faces, &Options::default(), &mut steps).expect("a box");
    assert!(steps.steps().contains(&Step::Volume { piece: 0, volume: -6.0 }));
    assert_eq!(found.pieces[0].volume, 6.0);
    let mut steps = Recorder::default();
    orient(&points, &faces, &centroid(), &mut steps).expect("a box");
    // The top has area 2 and a distance of 1.5 from the middle.
    assert!(steps.steps().contains(&Step::Compared { face: 0, product: -3.0 }));
}

#[test]
fn surfaces_with_a_border_stay_as_most_of_them_are() {
    let (points, right) = unit();
    let mut open = right[..5].to_vec();
    open[1].reverse();
    let found = orient(&points, &open, &Options::default(), &mut NoTrace).expect("a box");
    assert_eq!(found.turned, [false, true, false, false, false]);
    assert!(!found.pieces[0].closed && !found.pieces[0].inside_out);
    open.iter_mut().for_each(|ring| ring.reverse());
    let found = orient(&points, &open, &Options::default(), &mut NoTrace).expect("a box");
    assert_eq!(found.turned, [false, true, false, false, false], "nobody knows which way is out");
    // The test for convex bodies does so.
    let found = orient(&points, &open, &centroid(), &mut NoTrace).expect("a box");
    assert_eq!(found.turned, [true, false, true, true, true]);
    assert!(found.pieces[0].inside_out);
}

/// Returns a strip with a half twist.
#[test]
fn what_cannot_be_oriented_stays_as_it_is() {
    let count = 7;
    let points: Vec<DVec3> = (0..count)
        .flat_map(|k| {
            let angle = f64::from(k) / f64::from(count) * std::f64::consts::TAU;
            let (s, c) = angle.sin_cos();
            let (hs, hc) = (angle / 2.0).sin_cos();
            [-0.3, 0.3].map(|r| DVec3::new((1.0 + r * hc) * c, (1.0 + r * hc) * s, r * hs))
        })
        .collect();
    let n = count as usize;
    let quad = |k: usize| {
        let (a, b) = (2 * k, 2 * k + 1);
        // After one turn around the strip the sides have swapped.
        if k + 1 < n { vec![a, b, b + 2, a + 2] } else { vec![a, b, 0, 1] }
    };
    let faces: Vec<Vec<usize>> = (0..n).map(quad).collect();
    let mut steps = Recorder::default();
    let found = orient(&points, &faces, &Options::default(), &mut steps).expect("a strip");
    assert!(!found.pieces[0].orientable && !found.turned.contains(&true));
    assert!(steps.steps().iter().any(|s| matches!(s, Step::Torn { .. })));
    assert_eq!(replay(steps.steps(), n), found.turned);
}

#[test]
fn corners_that_do_not_exist_are_refused() {
    let refused = orient(&[DVec3::ZERO], &[[0, 1, 2]], &Options::default(), &mut NoTrace);
    assert!(refused.is_err_and(|e| e.to_string().contains('1')));
    let empty: [&[usize]; 2] = [&[], &[0]];
    assert_eq!(
        orient(&[DVec3::ZERO], &empty, &Options::default(), &mut NoTrace).map(|o| o.turned),
        Ok(vec![false; 2])
    );
}

/// Returns a mesh of triangles from faces.
fn mesh(parts: &[(Vec<DVec3>, Vec<Vec<usize>>)]) -> Mesh {
    let (mut positions, mut indices, mut faces) = (Vec::new(), Vec::new(), Vec::new());
    for (points, rings) in parts {
        let offset = positions.len();
        positions.extend(points.iter().map(|p| p.as_vec3()));
        for ring in rings {
            faces.push(indices.len() as u32 / 3);
            for k in 2..ring.len() {
                indices.extend([0, k - 1, k].map(|i| (offset + ring[i]) as u32));
            }
        }
    }
    Mesh { positions, indices: Some(indices), faces, ..Mesh::default() }
}

fn reversed((points, rings): (Vec<DVec3>, Vec<Vec<usize>>)) -> (Vec<DVec3>, Vec<Vec<usize>>) {
    (points, rings.into_iter().map(|ring| ring.into_iter().rev().collect()).collect())
}

fn counts(scene: &Scene) -> (u64, u64, u64) {
    let found = SceneOrientation::of(scene).expect("a scene");
    (found.closed, found.inside_out, found.flipped)
}

#[test]
fn cavities_are_right_and_bodies_beside_are_not() {
    let outer = cuboid(DVec3::ZERO, DVec3::splat(10.0));
    let cavity = reversed(cuboid(DVec3::splat(2.0), DVec3::splat(5.0)));
    let beside = reversed(cuboid(DVec3::splat(20.0), DVec3::splat(25.0)));
    let within_cavity = reversed(cuboid(DVec3::splat(3.0), DVec3::splat(4.0)));
    let scene = |parts: &[_]| Scene::from(mesh(parts));
    assert_eq!(counts(&scene(&[outer.clone(), cavity.clone()])), (2, 0, 0));
    assert_eq!(counts(&scene(&[outer.clone(), beside])), (2, 1, 0));
    assert_eq!(counts(&scene(&[outer.clone(), cavity.clone(), within_cavity])), (3, 1, 0));
    let mut odd = cavity;
    odd.1[2].reverse();
    assert_eq!(counts(&scene(&[outer, odd])), (2, 0, 1));
}

#[test]
fn turned_scenes_are_right_and_agree_with_the_published_method() {
    let (points, right) = unit();
    for turned in 0..1_u32 << 6 {
        let mut rings = right.clone();
        rings
            .iter_mut()
            .enumerate()
            .filter(|(f, _)| turned >> f & 1 == 1)
            .for_each(|(_, r)| r.reverse());
        let mut scene = Scene::from(mesh(&[(points.clone(), rings.clone())]));
        scene.meshes[0].normals = vec![Vec3::Z; 8];
        let count = u64::from(turned.count_ones());
        let expected = (1, u64::from(count > 3), count.min(6 - count));
        assert_eq!(counts(&scene), expected, "{turned:06b}");
        let found = SceneOrientation::of(&scene).expect("a scene");
        assert_eq!(found.is_right(), turned == 0);
        found.apply(&mut scene);
        scene.check().expect("a scene");
        assert_eq!(counts(&scene), (1, 0, 0), "{turned:06b}");
        // As in the Bodies from which drawings are made.
        let faces = Faces::new(&scene).expect("a scene");
        let (bodies, _) = Bodies::find(&faces);
        assert!((0..12).all(|item| !bodies.turned(item)));
        // No corner of a turned triangle has a normal that points away.
        for (k, turned) in (0..12).map(|k| (k, turned >> (k / 2) & 1 == 1)) {
            let corners = scene.meshes[0].triangle(k);
            let [a, b, c] = corners.map(|v| scene.meshes[0].positions[v as usize]);
            let front = (b - a).cross(c - a);
            let away =
                corners.iter().any(|v| scene.meshes[0].normals[*v as usize].dot(front) < 0.0);
            assert!(!turned || !away, "{turned}");
        }
    }
}

#[test]
fn instances_that_mirror_or_differ_get_what_they_need() {
    let mut scene = Scene::from(mesh(&[unit()]));
    let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    scene.instances.push(Instance { world_from_mesh: mirror, ..scene.instances[0].clone() });
    // The second touches the first in a face; separately they are two bodies.
    scene.instances[1].world_from_mesh = DMat4::from_translation(DVec3::X * -9.0) * mirror;
    assert_eq!(counts(&scene), (2, 0, 0), "a matrix that mirrors turns no front into a back");
    // A single triangle that belongs to a body in one instance and to none in the other.
    let (points, rings) = unit();
    let whole = mesh(&[(points.clone(), rings[1..].to_vec())]);
    let lid = reversed((points, vec![rings[0].clone()]));
    let mut scene = Scene::from(whole);
    scene.meshes.push(mesh(&[lid]));
    let mut other = scene.instances[0].clone();
    other.mesh = 1;
    scene.instances.push(other.clone());
    other.world_from_mesh = DMat4::from_translation(DVec3::X * 50.0);
    scene.instances.push(other);
    assert_eq!(counts(&scene), (1, 0, 1));
    SceneOrientation::of(&scene).expect("a scene").apply(&mut scene);
    assert_eq!(counts(&scene), (1, 0, 0));
    assert_eq!(scene.meshes.len(), 3, "the lid that belongs to nothing stays as it was");
}
