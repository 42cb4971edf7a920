//! Hidden lines and visible surfaces of bodies and patches: the worked examples of the pages `carried-lines`, `roberts`,
//! `shadow-volumes`, `patch-subdivision`, `portals`, `csg` and `octree`.

use super::near;
use crate::line_scenes::{Triangle, cuboid};
use durer::clip::polygon::BooleanOp;
use durer::math::{DVec2, DVec3};
use durer::target::NO_ITEM;
use durer::trace::{NoTrace, Recorder};
use durer::visibility::back_face::Eye;
use durer::visibility::line::face_net::FaceNet;
use durer::visibility::line::roberts::{self, ConvexBody, Values};
use durer::visibility::line::{appel, galimberti_montanari as natures};
use durer::visibility::polygons::patch_subdivision::{self, BicubicPatch};
use durer::visibility::polygons::portals::{self, Plan, PortalWindow};
use durer::visibility::polygons::shadow_volumes::{self, Count};
use durer::visibility::polygons::{Face, Screen, csg, octree};
use durer::work::Work;

/// Returns the bar and the plate before it, as the pages have them.
fn bar_and_plate() -> Vec<Triangle> {
    let mut triangles = cuboid([0.0, 1.0, 0.0], [10.0, 2.0, 1.0]);
    triangles.extend(cuboid([2.0, 0.0, 5.0], [4.0, 3.0, 6.0]));
    triangles
}

/// Returns a face parallel to the picture.
fn slab(low: (f64, f64), high: (f64, f64), z: f64) -> Vec<DVec3> {
    let corners = [(low.0, low.1), (high.0, low.1), (high.0, high.1), (low.0, high.1)];
    corners.map(|(x, y)| DVec3::new(x, y, z)).to_vec()
}

/// Q = 0 by a ray at the corner behind (0, 1, 1), 1 behind the plate's left side, 0 behind its right one; every other corner of
/// the bar follows.
#[test]
fn appel_carries_the_invisibility_along_the_bar() {
    use appel::{Cause, Step};
    let faces: Vec<Vec<DVec3>> = bar_and_plate().iter().map(|t| t.to_vec()).collect();
    let net = FaceNet::new(&faces, Eye::Along(DVec3::NEG_Z)).unwrap();
    let mut steps = Recorder::default();
    appel::draw(&net, &appel::Options::default(), &Work::default(), &mut steps).unwrap();
    let steps = steps.steps();
    let at = |corner: usize| net.corners()[corner];
    let rays: Vec<_> = steps
        .iter()
        .filter_map(|s| match s {
            Step::Ray { corner, faces } => Some((at(*corner), faces.len())),
            _ => None,
        })
        .collect();
    let [bar, plate] = [DVec3::new(0.0, 1.0, 0.0), DVec3::new(2.0, 0.0, 5.0)];
    assert_eq!(rays, [(bar, 0), (plate, 0)]);
    let ends = [DVec3::new(0.0, 1.0, 1.0), DVec3::new(10.0, 1.0, 1.0)];
    let begins = |s: &Step| matches!(s, Step::Edge { corners, .. } if corners.map(at) == ends);
    let first = steps.iter().position(begins).unwrap();
    assert!(matches!(steps[first], Step::Edge { invisibility: [0, 0], .. }));
    // Behind the plate's sides x = 2 and x = 4, each seen edge-on.
    for (step, (x, place, numbers)) in
        steps[first + 1..].iter().zip([(2.0, 0.2, [0, 1]), (4.0, 0.4, [1, 0])])
    {
        let Step::Change { t, cause: Cause::Contour(side), invisibility, .. } = *step else {
            panic!("{step:?}");
        };
        assert!((t - place).abs() < 1e-5, "{t}");
        assert!(net.edges()[side].corners.iter().all(|corner| at(*corner).x == x));
        assert_eq!(invisibility, numbers);
    }
    let end = &steps[first + 3];
    assert!(
        matches!(end, Step::Corner { corner, invisibility: [0, 0], .. } if at(*corner) == ends[1])
    );
}

/// The natures of the long edges of A are ∅, {B}, {B, C}, {C}, ∅; all of D is behind B.
#[test]
fn galimberti_and_montanari_carry_the_faces_along_the_strip() {
    let faces = [
        slab((0.0, 2.0), (10.0, 3.0), 5.0),
        slab((2.0, 0.0), (6.0, 4.0), 3.0),
        slab((4.0, 1.0), (8.0, 5.0), 4.0),
        slab((2.5, 1.0), (3.5, 1.8), 6.0),
    ];
    let net = FaceNet::new(&faces, Eye::Along(DVec3::Z)).unwrap();
    let lines = natures::draw(&net, &Default::default(), &Work::default(), &mut NoTrace).unwrap();
    let long = lines.iter().filter(|line| line.ends[0].distance(line.ends[1]) == 10.0);
    let mut count = 0;
    for line in long {
        let mut natures: Vec<&[usize]> = line.parts.iter().map(|part| &part.nature[..]).collect();
        let mut cuts: Vec<f64> = line.parts[1..].iter().map(|part| part.from).collect();
        if line.ends[0].x > 0.0 {
            natures.reverse();
            cuts = cuts.iter().rev().map(|t| 1.0 - t).collect();
        }
        let expected: [&[usize]; 5] = [&[], &[1], &[1, 2], &[2], &[]];
        assert_eq!(natures, expected);
        let places = [0.2, 0.4, 0.6, 0.8];
        assert!(cuts.iter().zip(places).all(|(t, place)| (t - place).abs() < 1e-5), "{cuts:?}");
        count += 1;
    }
    assert_eq!(count, 2);
    let behind: Vec<_> = lines.iter().filter(|line| line.ends[0].z == 6.0).collect();
    assert_eq!(behind.len(), 4);
    assert!(behind.iter().all(|line| line.parts.len() == 1 && line.parts[0].nature == [1]));
}

/// Returns the values p, p + q and w of the planes of the bar's plate, at the edge from (0, 1, 1) to (10, 1, 1).
fn values_of_a_plate(depths: [f64; 2]) -> (Vec<roberts::Step>, usize) {
    let mut triangles = cuboid([0.0, 1.0, 0.0], [10.0, 2.0, 1.0]);
    triangles.extend(cuboid([2.0, 0.0, depths[0]], [4.0, 3.0, depths[1]]));
    let faces: Vec<Vec<DVec3>> = triangles.iter().map(|t| t.to_vec()).collect();
    let bodies = ConvexBody::several(&faces).unwrap();
    let mut steps = Recorder::default();
    let eye = Eye::Along(DVec3::NEG_Z);
    roberts::draw(&bodies, eye, &roberts::Options::default(), &Work::default(), &mut steps)
        .unwrap();
    let ends = [DVec3::new(0.0, 1.0, 1.0), DVec3::new(10.0, 1.0, 1.0)];
    let line = steps.steps().iter().find_map(|s| match s {
        roberts::Step::Line { line, ends: own, .. } if *own == ends => Some(*line),
        _ => None,
    });
    (steps.into_steps(), line.expect("the edge is a line"))
}

#[test]
fn roberts_has_the_values_of_all_planes() {
    let (steps, own) = values_of_a_plate([5.0, 6.0]);
    let compared = steps.iter().find_map(|s| match s {
        roberts::Step::Compare { line, body: 1, values } if *line == own => Some(values),
        _ => None,
    });
    let mut table: Vec<[f64; 3]> =
        compared.unwrap().iter().map(|Values { start, end, eye }| [*start, *end, *eye]).collect();
    let mut expected = [
        [-2.0, 8.0, 0.0],
        [4.0, -6.0, 0.0],
        [1.0, 1.0, 0.0],
        [2.0, 2.0, 0.0],
        [-4.0, -4.0, 1.0],
        [5.0, 5.0, -1.0],
    ];
    let by_value = |a: &[f64; 3], b: &[f64; 3]| a[0].total_cmp(&b[0]);
    table.sort_by(by_value);
    expected.sort_by(by_value);
    assert_eq!(table.len(), 6);
    assert!(table.iter().flatten().zip(expected.iter().flatten()).all(|(a, b)| near(*a, *b)));
    let hidden = steps.iter().find_map(|s| match *s {
        roberts::Step::Hidden { line, body: 1, part } if line == own => Some(part),
        _ => None,
    });
    let hidden = hidden.unwrap();
    assert!(near(hidden[0], 0.2) && near(hidden[1], 0.4), "{hidden:?}");
    // Exercise 1: behind the bar, the front 0 − z ends the comparison.
    let (steps, own) = values_of_a_plate([-1.0, 0.0]);
    let apart = steps.iter().find_map(|s| match s {
        roberts::Step::Apart { line, body: 1, plane, values } if *line == own => {
            Some(values[*plane])
        }
        _ => None,
    });
    let Values { start, end, eye } = apart.unwrap();
    assert!([start, end, eye].iter().all(|value| near(*value, -1.0)));
}

/// At x = 9.5 the floor is behind one front and before one back: dark. At x = 11.5 the second plate is before both: lit.
#[test]
fn sides_of_shadow_volumes_are_passed_before_or_behind_what_is_seen() {
    use shadow_volumes::{Options, Step};
    let screen = Screen { width: 24, height: 18, ..Screen::default() };
    let faces = [
        slab((0.0, 0.0), (24.0, 18.0), 9.0),
        slab((3.0, 0.0), (7.0, 18.0), 3.0),
        slab((10.0, 0.0), (13.0, 18.0), 7.0),
    ]
    .map(|corners| Face::new(&corners).unwrap());
    let light = Eye::Along(DVec3::new(1.0, 0.0, 1.0));
    let how = Options { count: Count::ZPass, ..Options::default() };
    let mut steps = Recorder::default();
    let found = shadow_volumes::render(&faces, &screen, light, &how, &mut steps).unwrap();
    // Depth of each side at the pixel, in order, and what it changes.
    let passed = |x: u32| {
        let of_pixel = |s: &Step| match *s {
            Step::Count { pixel, depth, stored, change, .. } if pixel == [x, 5] => {
                Some((depth, stored, change))
            }
            _ => None,
        };
        let mut passed: Vec<_> = steps.steps().iter().filter_map(of_pixel).collect();
        passed.sort_by(|a, b| a.0.total_cmp(&b.0));
        passed
    };
    assert_eq!(passed(9)[..2], [(5.5, 9.0, 1), (9.5, 9.0, 0)]);
    assert_eq!(passed(11)[..2], [(7.5, 7.0, 0), (8.5, 7.0, 0)]);
    let at = |x: u32| (found.items.get(x, 5), found.counts.get(x, 5), found.is_dark(x, 5));
    assert_eq!(at(9), (Some(0), Some(1), true));
    assert_eq!(at(11), (Some(2), Some(0), false));
    // The sides x = 3 and x = 7 begin at z = 3 and move as far along x as along z.
    for (x, front) in [(3.0, false), (7.0, true)] {
        let side = steps.steps().iter().find_map(|s| match *s {
            Step::Side { side, front, .. } if side.ends.iter().all(|end| end.x == x) => {
                Some((side, front))
            }
            _ => None,
        });
        let (side, own) = side.unwrap();
        assert_eq!(own, Some(front));
        for r in [0.5, 2.5] {
            assert_eq!(side.depth(DVec2::new(x + r, 5.5)), Some(3.0 + r));
        }
    }
}

/// 36 centres, then nine in a quarter of them; at (3, 3) the four inner points weigh (35/48)².
#[test]
fn a_patch_is_divided_down_to_one_centre() {
    use patch_subdivision::{Options, Step};
    let inner = |k: usize| k == 1 || k == 2;
    let point = |i: usize, j: usize| {
        let z = if inner(i) && inner(j) { 1.0 } else { 5.0 };
        DVec3::new(2.0 * i as f64, 2.0 * j as f64, z)
    };
    let patch = BicubicPatch::new([0, 1, 2, 3].map(|j| [0, 1, 2, 3].map(|i| point(i, j)))).unwrap();
    let screen = Screen { width: 6, height: 6, ..Screen::default() };
    let mut steps = Recorder::default();
    let found =
        patch_subdivision::render(&[patch], &screen, &Options::default(), &mut steps).unwrap();
    let weight = 35.0 / 48.0;
    let depth = found.depths.get(3, 3).unwrap();
    assert!((depth - (5.0 - 4.0 * weight * weight)).abs() < 1e-9, "{depth}");
    assert!((depth - 2.873).abs() < 5e-4);
    assert!(found.items.data().iter().all(|item| *item == 0));
    let centers = |size: f64| {
        let of_size = |s: &Step| match *s {
            Step::Divide { part: [[u0, u1], _], centers, .. } if u1 - u0 == size => Some(centers),
            _ => None,
        };
        let mut all: Vec<u64> = steps.steps().iter().filter_map(of_size).collect();
        all.sort_unstable();
        all
    };
    assert_eq!([1.0, 0.5, 0.25].map(centers), [vec![36], vec![9; 4], vec![4; 16]]);
    assert!(centers(0.125).is_empty());
}

/// Columns of three doors in a row, from two places of the eye.
#[test]
fn windows_are_intersected_from_door_to_door() {
    use portals::Step;
    let room = |k: f64| slab((0.0, k), (8.0, k + 4.0), 0.0).iter().map(|p| p.truncate()).collect();
    let rooms: Vec<Vec<DVec2>> = [0.0, 4.0, 8.0, 12.0].map(room).to_vec();
    let door = |a: f64, b: f64, z: f64| [DVec2::new(a, z), DVec2::new(b, z)];
    let doors = [door(2.0, 4.0, 4.0), door(2.5, 6.0, 8.0), door(6.0, 7.0, 12.0)];
    let plan = Plan::of_rooms(&rooms, &doors, 2.0).unwrap();
    let screen = Screen { width: 48, height: 12, ..Screen::default() };
    let columns = |x: f64| {
        let eye = portals::PlanEye { at: DVec3::new(x, 0.0, 2.0), cell: 0, focal: 24.0 };
        let mut steps = Recorder::default();
        portals::visits(&plan, &eye, &screen, &Default::default(), &mut steps).unwrap();
        let of = |window: PortalWindow| [window.low[0], window.high[0]];
        let portal = |s: &Step| match *s {
            Step::Portal { bounds, window, .. } => Some((bounds.map(of), window.map(of))),
            _ => None,
        };
        steps.steps().iter().filter_map(portal).collect::<Vec<_>>()
    };
    let seen = |bounds: [u32; 2], window: [u32; 2]| (Some(bounds), Some(window));
    assert_eq!(
        columns(3.0),
        [seen([12, 36], [12, 36]), seen([22, 36], [22, 36]), seen([31, 34], [31, 34])]
    );
    assert_eq!(
        columns(3.9),
        [seen([1, 26], [1, 26]), seen([18, 33], [18, 26]), (Some([29, 32]), None)]
    );
}

/// A from z = 2 to 5, B from 1 to 3: in, in, out, out, and where each expression begins to hold.
#[test]
fn faces_are_passed_until_the_expression_holds() {
    use csg::{Expression, Step};
    let block = |x: [f64; 2], depths: [f64; 2]| {
        depths.map(|z| Face::new(&slab((x[0], 0.0), (x[1], 1.0), z)).unwrap()).to_vec()
    };
    let solids = [block([0.0, 4.0], [2.0, 5.0]), block([2.0, 6.0], [1.0, 3.0])];
    let screen = Screen { width: 6, height: 1, ..Screen::default() };
    // Solid, in or out, whether the expression holds, for each face of the span of columns 2 and 3.
    let passed = |op: BooleanOp| {
        let mut steps = Recorder::default();
        let expression = Expression::fold(op, 2).unwrap();
        let items = csg::items(&solids, &expression, &screen, &mut steps).unwrap();
        let both = |s: &Step| matches!(s, Step::Span { part, faces } if (part.x0, part.x1) == (2, 4) && *faces == [2, 0, 3, 1]);
        let first = steps.steps().iter().position(both).unwrap();
        let cross = |s: &Step| match *s {
            Step::Cross { solid, inside, holds, .. } => Some((solid, inside, holds)),
            _ => None,
        };
        let all: Vec<_> = steps.steps()[first + 1..].iter().map_while(cross).collect();
        (all, items.data().to_vec())
    };
    let (a, b) = (0, 1);
    let none = NO_ITEM;
    let (steps, items) = passed(BooleanOp::Union);
    assert_eq!((steps, items), (vec![(b, true, true)], vec![0, 0, 2, 2, 2, 2]));
    let (steps, items) = passed(BooleanOp::Intersection);
    let expected = vec![(b, true, false), (a, true, true)];
    assert_eq!((steps, items), (expected, vec![none, none, 0, 0, none, none]));
    let (steps, items) = passed(BooleanOp::Difference);
    let expected = vec![(b, true, false), (a, true, false), (b, false, true)];
    assert_eq!((steps, items), (expected, vec![0, 0, 3, 3, none, none]));
}

/// The near half of the octree has the wall alone and fills all pixels; the far half is left out.
#[test]
fn a_wall_fills_the_near_cells_and_hides_the_far_ones() {
    use octree::{Options, Step};
    let far = |k: u32| {
        let low = (f64::from(k % 8) * 4.0 + 1.0, f64::from(k / 8) * 4.0 + 1.0);
        slab(low, (low.0 + 2.0, low.1 + 2.0), 50.0)
    };
    let mut faces: Vec<Face> = (0..64).map(|k| Face::new(&far(k)).unwrap()).collect();
    faces.push(Face::new(&slab((0.0, 0.0), (32.0, 32.0), 5.0)).unwrap());
    let screen = Screen { width: 32, height: 32, ..Screen::default() };
    let mut steps = Recorder::default();
    octree::items(&faces, &screen, &Options::default(), &mut steps).unwrap();
    let steps = steps.steps();
    let Some(Step::Cell { cell: 0, corners, children }) = steps.first() else { panic!() };
    assert_eq!(corners.map(|corner| corner.z), [5.0, 50.0]);
    let visits: Vec<usize> = steps
        .iter()
        .filter_map(|s| if let Step::Visit { cell } = *s { Some(cell) } else { None })
        .collect();
    let left_out: Vec<usize> = steps
        .iter()
        .filter_map(|s| if let Step::LeaveOut { cell, .. } = *s { Some(cell) } else { None })
        .collect();
    assert_eq!((visits, &left_out[..]), (vec![0], &children[4..]));
    let leaves = steps.iter().filter_map(|s| match s {
        Step::Leaf { faces, .. } => Some(&faces[..]),
        _ => None,
    });
    assert!(leaves.clone().all(|faces| faces == [64]) && leaves.count() == 4);
    assert_eq!(steps.iter().filter(|s| matches!(s, Step::Store { .. })).count(), 1024);
}
