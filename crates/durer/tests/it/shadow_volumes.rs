//! Shadow volumes: hand-computed counts, and the same by rays to the light, from both ends and for every kind of light.

use crate::line_scenes::Random;
use durer::math::{DMat3, DVec2, DVec3};
use durer::target::NO_ITEM;
use durer::trace::{NoTrace, Recorder};
use durer::visibility::back_face::Eye;
use durer::visibility::polygons::shadow_volumes::{
    Count, Options, ShadowPicture, Step, render, replay,
};
use durer::visibility::polygons::{Face, Screen};
use durer::work::Work;

fn screen() -> Screen {
    Screen { width: 24, height: 18, ..Screen::default() }
}

/// Returns the six faces of a box in any position, counter-clockwise seen from outside.
fn turned_box(random: &mut Random) -> Vec<Face> {
    let mut number = |low: f64, high: f64| low + random.next() * (high - low);
    let half = DVec3::from([0; 3].map(|_| number(0.8, 4.0)));
    let middle = DVec3::new(number(2.0, 22.0), number(2.0, 16.0), number(12.0, 30.0));
    let axis = DVec3::from([0; 3].map(|_| number(-1.0, 1.0))).normalize();
    let turn = DMat3::from_axis_angle(axis, number(0.0, 6.0));
    let corner = |i: usize| {
        let sign = |k: usize| if i >> k & 1 == 1 { 1.0 } else { -1.0 };
        middle + turn * (half * DVec3::new(sign(0), sign(1), sign(2)))
    };
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    faces.iter().map(|face| Face::new(&face.map(corner)).unwrap()).collect()
}

/// Returns a triangle in any position.
fn sheet(random: &mut Random) -> Face {
    let mut number = |low: f64, high: f64| low + random.next() * (high - low);
    let mut corner = || DVec3::new(number(-4.0, 28.0), number(-4.0, 22.0), number(8.0, 34.0));
    Face::new(&[corner(), corner(), corner()]).unwrap()
}

/// Returns the number of crossings of the way from a point to the light with faces that `casts` accepts; `None` if it
/// is too close to a border to decide. The face of the point itself counts if the eye sees its dark side.
fn passed(faces: &[Face], own: u32, point: DVec3, light: Eye, closed: bool) -> Option<i32> {
    let to_light = match light {
        Eye::At(at) => at - point,
        Eye::Along(direction) => -direction * 1e3,
    };
    let mut count = 0;
    for (number, face) in (0..).zip(faces) {
        let normal = face.plane().normal;
        let is_front = normal.dot(to_light) > 0.0;
        if number == own {
            let sees_front = normal.z < 0.0;
            count += i32::from(sees_front != is_front && !closed);
            continue;
        }
        // Whether a closed body's face casts depends on the light, not on the point.
        let toward = match light {
            Eye::At(at) => at - face.corners()[0],
            Eye::Along(direction) => -direction,
        };
        let casts = !closed || normal.dot(toward) > 0.0;
        let corners = face.corners();
        for (b, c) in corners[1..].iter().zip(&corners[2..]) {
            let (e1, e2, s) = (*b - corners[0], *c - corners[0], point - corners[0]);
            let p = to_light.cross(e2);
            let det = e1.dot(p);
            if det.abs() < 1e-9 {
                return None;
            }
            let q = s.cross(e1);
            let (u, v, t) = (s.dot(p) / det, to_light.dot(q) / det, e2.dot(q) / det);
            let inner = u.min(v).min(1.0 - u - v);
            if inner.abs() < 1e-6 || (inner > 0.0 && t.abs().min((t - 1.0).abs()) < 1e-9) {
                return None;
            }
            count += i32::from(casts && inner > 0.0 && t > 0.0 && t < 1.0);
        }
    }
    Some(count)
}

/// Renders from one end, and compares everything that must agree with it.
fn rendered(faces: &[Face], light: Eye, options: &Options) -> ShadowPicture {
    let mut steps = Recorder::default();
    let found = render(faces, &screen(), light, options, &mut steps).unwrap();
    assert_eq!(render(faces, &screen(), light, options, &mut NoTrace).unwrap(), found);
    assert_eq!(replay(&screen(), steps.steps()).unwrap(), found);
    found
}

fn lights(random: &mut Random) -> Vec<Eye> {
    let mut number = |low: f64, high: f64| low + random.next() * (high - low);
    let along = |x: f64, y: f64, z: f64| Eye::Along(DVec3::new(x, y, z));
    vec![
        // From the eye's side, from behind, among the faces, and exactly along the rays.
        along(number(-1.0, 1.0), number(-1.0, 1.0), 1.0),
        along(number(-1.0, 1.0), number(-1.0, 1.0), -1.0),
        Eye::At(DVec3::new(number(-9.0, 30.0), number(-9.0, 30.0), number(-9.0, 5.0))),
        Eye::At(DVec3::new(number(0.0, 24.0), number(0.0, 18.0), number(10.0, 30.0))),
        Eye::At(DVec3::new(number(0.0, 24.0), number(0.0, 18.0), 60.0)),
        along(0.0, 0.0, 1.0),
        along(0.0, 0.0, -1.0),
    ]
}

#[test]
fn counts_are_those_of_rays_to_the_light() {
    let mut random = Random(23);
    let (mut checked, mut dark) = (0, 0);
    for round in 0..8 {
        let boxes: Vec<Face> = (0..3).flat_map(|_| turned_box(&mut random)).collect();
        let sheets: Vec<Face> = (0..4).map(|_| sheet(&mut random)).collect();
        for light in lights(&mut random) {
            for closed in [true, false] {
                let faces =
                    if closed { boxes.clone() } else { [&boxes[..6], &sheets[..]].concat() };
                let z_pass = Options { count: Count::ZPass, closed };
                let found = rendered(&faces, light, &z_pass);
                let other = rendered(&faces, light, &Options { count: Count::ZFail, closed });
                for y in 0..screen().height {
                    for x in 0..screen().width {
                        let item = found.items.get(x, y).unwrap();
                        assert_eq!(other.items.get(x, y), Some(item));
                        if item == NO_ITEM {
                            assert_eq!(found.counts.get(x, y), Some(0));
                            continue;
                        }
                        let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                        let point = p.extend(faces[item as usize].depth(p));
                        let Some(expected) = passed(&faces, item, point, light, closed) else {
                            continue;
                        };
                        let counts = [&found, &other].map(|o| o.counts.get(x, y).unwrap());
                        assert_eq!(counts, [expected; 2], "{round} {light:?} {closed} {x},{y}");
                        assert_eq!(found.is_dark(x, y), expected > 0);
                        checked += 1;
                        dark += i32::from(expected > 0);
                    }
                }
            }
        }
    }
    assert!(checked > 10_000 && dark > 2_000, "{checked} {dark}");
}

/// Checks that shadows fall on a floor and on bodies above it, and that the common edge of two faces casts no side.
#[test]
fn volumes_overlap_and_neighbours_share_theirs() {
    let slab = |x: [f64; 2], y: [f64; 2], z: f64| {
        let corners = [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])];
        Face::new(&corners.map(|(x, y)| DVec3::new(x, y, z))).unwrap()
    };
    let light = Eye::Along(DVec3::new(1.0, 0.0, 1.0));
    let floor = slab([0.0, 24.0], [0.0, 18.0], 9.0);
    // Shadows on the floor at x from 9 to 13, and from 12 to 15.
    let faces = [floor, slab([3.0, 7.0], [0.0, 18.0], 3.0), slab([10.0, 13.0], [0.0, 18.0], 7.0)];
    let found = rendered(&faces, light, &Options::default());
    let row: Vec<i32> = (0..24).map(|x| found.counts.get(x, 5).unwrap()).collect();
    let mut expected = [0; 24];
    // At the lower plate's height the shadow of the upper one is from 7 to 11.
    expected[9] = 1;
    expected[10] = 1;
    expected[13] = 1;
    expected[14] = 1;
    assert_eq!(row[..], expected);
    // The same plate in two halves: their common edge is not part of the outline.
    let halves = [slab([3.0, 5.0], [0.0, 18.0], 3.0), slab([5.0, 7.0], [0.0, 18.0], 3.0)];
    let sides = |faces: &[Face]| {
        let mut steps = Recorder::default();
        render(faces, &screen(), light, &Options::default(), &mut steps).unwrap();
        steps.steps().iter().filter(|step| matches!(step, Step::Side { .. })).count()
    };
    assert_eq!([sides(&halves[..1]), sides(&halves)], [4, 6]);
}

#[test]
fn volumes_are_charged_to_the_budget() {
    let mut random = Random(5);
    let faces: Vec<Face> = (0..200).map(|_| sheet(&mut random)).collect();
    let small = Screen { work: Work::with_budget(50_000, "the budget"), ..screen() };
    let light = Eye::Along(DVec3::Z);
    let refused = render(&faces, &small, light, &Options::default(), &mut NoTrace).unwrap_err();
    assert!(refused.to_string().contains("shadow volumes"), "{refused}");
}
