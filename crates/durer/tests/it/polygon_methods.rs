//! Visible-polygon methods of textbooks: all methods agree, steps rebuild their results, and their numbers are right.

use crate::raster_coverage::Random;
use durer::math::{DVec2, DVec3};
use durer::target::{NO_ITEM, Pixels};
use durer::trace::{NoTrace, Recorder};
use durer::visibility::back_face::Eye;
use durer::visibility::polygons::bsp::{self, Tree};
use durer::visibility::polygons::regions::{self, FaceRegion, regions};
use durer::visibility::polygons::{
    Face, PolygonMethod, Screen, csg, depth_sort, hierarchical_z, octree, painter, warnock,
    watkins, z_buffer,
};
use durer::visibility::surface::warnock::Division;
use durer::work::Work;

fn screen() -> Screen {
    Screen { width: 32, height: 32, ..Screen::default() }
}

/// Returns a star-shaped polygon with corners on a fine grid, in a plane with a random slope.
fn star(random: &mut Random, corners: usize) -> Face {
    let grid = |v: f64| (v * 64.0).round() / 64.0 + 1.0 / 256.0;
    let (center, slope) = (random.point(4.0, 28.0), random.point(-0.4, 0.4));
    let z = 20.0 + random.next() * 10.0;
    let corners: Vec<DVec3> = (0..corners)
        .map(|k| {
            let (turn, reach) = (std::f64::consts::TAU * k as f64 / corners as f64, random.next());
            let p = center + DVec2::from_angle(turn) * (2.0 + 10.0 * reach);
            let p = DVec2::new(grid(p.x), grid(p.y));
            p.extend(z + slope.dot(p - center))
        })
        .collect();
    Face::new(&corners).unwrap()
}

fn scene(random: &mut Random, count: usize) -> Vec<Face> {
    (0..count).map(|k| star(random, 3 + k % 4)).collect()
}

/// Returns a beam from p to q, z from first to last.
fn beam(p: (f64, f64), q: (f64, f64), [first, last]: [f64; 2]) -> Face {
    let (p, q) = (DVec2::from(p), DVec2::from(q));
    let side = (q - p).perp().normalize() * 2.0;
    let corners = [(p + side, first), (p - side, first), (q - side, last), (q + side, last)];
    Face::new(&corners.map(|(p, z)| p.extend(z))).unwrap()
}

/// Returns three cyclically overlapping beams.
fn beams() -> [Face; 3] {
    [
        beam((4.0, 8.0), (28.0, 8.0), [1.0, 5.0]),
        beam((24.0, 4.0), (10.0, 28.0), [1.0, 5.0]),
        beam((22.0, 28.0), (8.0, 4.0), [1.0, 5.0]),
    ]
}

/// Returns whether both pictures are equal, except for faces equally near up to rounding.
fn same(faces: &[Face], a: &Pixels<u32>, b: &Pixels<u32>) -> bool {
    let all = (0..a.height()).flat_map(|y| (0..a.width()).map(move |x| (x, y)));
    all.into_iter().all(|(x, y)| {
        let [a, b] = [a, b].map(|items| items.get(x, y).unwrap());
        let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let depth = |face: u32| faces.get(face as usize).map_or(f64::INFINITY, |f| f.depth(p));
        a == b || (depth(a) - depth(b)).abs() < 1e-9
    })
}

#[test]
fn all_methods_find_the_nearest_polygon() {
    let mut random = Random(11);
    for round in 0..40 {
        let faces = scene(&mut random, 1 + round % 12);
        let expected = z_buffer::items(&faces, &screen(), &mut NoTrace).unwrap();
        for method in PolygonMethod::ALL {
            let found = method.items(&faces, &screen()).unwrap();
            assert!(same(&faces, &found, &expected), "{method}, round {round}");
        }
        assert!(round < 3 || expected.data().iter().any(|item| *item != NO_ITEM));
    }
    let expected = z_buffer::items(&beams(), &screen(), &mut NoTrace).unwrap();
    for method in PolygonMethod::ALL {
        assert!(same(&beams(), &method.items(&beams(), &screen()).unwrap(), &expected), "{method}");
    }
}

#[test]
fn of_equal_depths_the_first_face_is_seen() {
    let square = |at: f64| {
        let corners = [(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)];
        Face::new(&corners.map(|(x, y)| DVec3::new(x + at, y + at, 3.0))).unwrap()
    };
    let faces = [square(4.0), square(0.0), square(8.0)];
    for method in PolygonMethod::ALL {
        let items = method.items(&faces, &screen()).unwrap();
        let seen = [(1, 1), (5, 5), (11, 11), (13, 13)].map(|(x, y)| items.get(x, y).unwrap());
        assert_eq!(seen, [1, 0, 0, 2], "{method}");
    }
    let areas: Vec<_> = seen_areas(&faces);
    assert_eq!(areas, [64.0, 48.0, 48.0]);
}

fn seen_areas(faces: &[Face]) -> Vec<f64> {
    let mut areas = vec![0.0; faces.len()];
    for region in regions(faces, &Default::default(), &Work::default(), &mut NoTrace).unwrap() {
        areas[region.face as usize] += region.shapes.area();
    }
    areas
}

#[test]
fn the_steps_rebuild_the_pictures() {
    let mut random = Random(12);
    let (faces, screen) = (scene(&mut random, 9), screen());
    let mut steps = Recorder::default();
    let found = z_buffer::items(&faces, &screen, &mut steps).unwrap();
    assert_eq!(z_buffer::replay(&screen, steps.steps()).unwrap(), found);
    assert_eq!(z_buffer::items(&faces, &screen, &mut NoTrace).unwrap(), found);
    let mut steps = Recorder::default();
    let found = watkins::items(&faces, &screen, &mut steps).unwrap();
    assert_eq!(watkins::replay(&screen, steps.steps()).unwrap(), found);
    assert_eq!(watkins::items(&faces, &screen, &mut NoTrace).unwrap(), found);
    let mut steps = Recorder::default();
    let how = bsp::Options::default();
    let found = bsp::items(&faces, &screen, &how, &mut steps).unwrap();
    assert_eq!(bsp::replay(&screen, steps.steps()).unwrap(), found);
    assert_eq!(bsp::items(&faces, &screen, &how, &mut NoTrace).unwrap(), found);
    let (how, mut steps) = (hierarchical_z::Options::default(), Recorder::default());
    let found = hierarchical_z::items(&faces, &screen, &how, &mut steps).unwrap();
    assert_eq!(hierarchical_z::replay(&screen, steps.steps()).unwrap(), found);
    assert_eq!(hierarchical_z::items(&faces, &screen, &how, &mut NoTrace).unwrap(), found);
    for division in [Division::Regular, Division::Vertices] {
        let (how, mut steps) = (warnock::Options { division }, Recorder::default());
        let found = warnock::items(&faces, &screen, &how, &mut steps).unwrap();
        assert_eq!(warnock::replay(&screen, steps.steps()).unwrap(), found);
        assert_eq!(warnock::items(&faces, &screen, &how, &mut NoTrace).unwrap(), found);
        assert!(same(&faces, &found, &z_buffer::items(&faces, &screen, &mut NoTrace).unwrap()));
    }
    let (how, mut steps) = (depth_sort::Options::default(), Recorder::default());
    let found = depth_sort::items(&faces, &screen, &how, &mut steps).unwrap();
    assert_eq!(depth_sort::replay(&screen, steps.steps()).unwrap(), found);
    assert_eq!(depth_sort::items(&faces, &screen, &how, &mut NoTrace).unwrap(), found);
    for how in [
        octree::Options::default(),
        octree::Options { capacity: 0, depth: 3, ..Default::default() },
    ] {
        let mut steps = Recorder::default();
        let found = octree::items(&faces, &screen, &how, &mut steps).unwrap();
        assert_eq!(octree::replay(&screen, steps.steps()).unwrap(), found);
        assert_eq!(octree::items(&faces, &screen, &how, &mut NoTrace).unwrap(), found);
        assert!(same(&faces, &found, &z_buffer::items(&faces, &screen, &mut NoTrace).unwrap()));
    }
    let mut steps = Recorder::default();
    let how = painter::Options { key: painter::Key::Mean };
    let found = painter::items(&faces, &screen, &how, &mut steps).unwrap();
    assert_eq!(painter::replay(&screen, steps.steps()).unwrap(), found);
    let mut steps = Recorder::default();
    let mut found = regions(&faces, &Default::default(), &Work::default(), &mut steps).unwrap();
    let mut replayed = regions::replay(steps.steps());
    let by = |a: &FaceRegion, b: &FaceRegion| a.face.cmp(&b.face);
    found.sort_by(by);
    replayed.sort_by(by);
    assert_eq!(replayed, found);
}

#[test]
fn the_z_buffer_clears_compares_and_stores() {
    use z_buffer::Step;
    let wall = |z: f64| {
        let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)];
        Face::new(&corners.map(|(x, y)| DVec3::new(x, y, z))).unwrap()
    };
    let mut steps = Recorder::default();
    let small = Screen { width: 1, height: 1, ..Screen::default() };
    z_buffer::items(&[wall(5.0), wall(7.0), wall(4.0)], &small, &mut steps).unwrap();
    let pixel = [0, 0];
    let compare = |depth, stored| Step::Compare { pixel, depth, stored };
    let store = |face, depth| Step::Store { pixel, face, depth };
    let expected = [
        Step::Clear,
        Step::Face { face: 0 },
        compare(5.0, f64::INFINITY),
        store(0, 5.0),
        Step::Face { face: 1 },
        compare(7.0, 5.0),
        Step::Face { face: 2 },
        compare(4.0, 5.0),
        store(2, 4.0),
    ];
    assert_eq!(steps.steps(), expected);
}

#[test]
fn painting_in_order_of_depth_fails_where_beams_overlap_in_a_ring() {
    let (faces, screen) = (beams(), screen());
    let right = z_buffer::items(&faces, &screen, &mut NoTrace).unwrap();
    for key in [painter::Key::Farthest, painter::Key::Mean] {
        let options = painter::Options { key };
        let painted = painter::items(&faces, &screen, &options, &mut NoTrace).unwrap();
        assert!(!same(&faces, &painted, &right), "{key:?}");
    }
    // A tree splits a beam, and then an order exists.
    let mut steps = Recorder::default();
    bsp::items(&faces, &screen, &bsp::Options::default(), &mut steps).unwrap();
    assert!(steps.steps().iter().any(|step| matches!(step, bsp::Step::Split { .. })));
    // If depths do not overlap, the order alone is right.
    let apart: Vec<Face> = (0..3)
        .map(|k| beam((4.0, 8.0 + f64::from(k)), (28.0, 9.0), [f64::from(k), f64::from(k) + 0.5]))
        .collect();
    let painted = painter::items(&apart, &screen, &Default::default(), &mut NoTrace).unwrap();
    assert_eq!(painted, z_buffer::items(&apart, &screen, &mut NoTrace).unwrap());
}

/// Checks that the key decides the order, and that of equal keys the first face is painted last.
#[test]
fn the_painter_sorts_by_the_key_that_is_chosen() {
    let strip = |z0: f64, z1: f64| {
        let corners = [(0.0, 0.0, z0), (8.0, 0.0, z1), (8.0, 8.0, z1), (0.0, 8.0, z0)];
        Face::new(&corners.map(DVec3::from)).unwrap()
    };
    let faces = [strip(5.0, 5.0), strip(1.0, 9.0), strip(5.0, 5.0)];
    let order = |key| {
        let mut steps = Recorder::default();
        painter::items(&faces, &screen(), &painter::Options { key }, &mut steps).unwrap();
        let sorted = |step: &painter::Step| match *step {
            painter::Step::Sorted { face, z } => Some((face, z)),
            painter::Step::Paint { .. } => None,
        };
        steps.steps().iter().filter_map(sorted).collect::<Vec<_>>()
    };
    assert_eq!(order(painter::Key::Farthest), [(1, 9.0), (2, 5.0), (0, 5.0)]);
    assert_eq!(order(painter::Key::Mean), [(2, 5.0), (1, 5.0), (0, 5.0)]);
}

#[test]
fn trees_order_pieces_for_every_eye() {
    let mut random = Random(13);
    let faces = scene(&mut random, 8);
    for candidates in [1, 5] {
        let how = bsp::Options { candidates, ..Default::default() };
        let tree = Tree::new(&faces, &how, &Work::default(), &mut NoTrace).unwrap();
        for eye in [DVec3::new(16.0, 16.0, -50.0), DVec3::new(-40.0, 3.0, 25.0), DVec3::ZERO] {
            let order = tree.back_to_front(Eye::At(eye), &mut NoTrace);
            // No piece is, on a ray from the eye, in front of one painted later.
            for (k, &far) in order.iter().enumerate() {
                for &near in &order[k + 1..] {
                    assert!(!hides(&tree, &faces, eye, far, near), "{far} {near} from {eye}");
                }
            }
        }
    }
}

/// Returns whether the first piece is in front of the second on a ray to the middle of one of them.
fn hides(tree: &Tree, faces: &[Face], eye: DVec3, first: u32, second: u32) -> bool {
    let face = |piece: u32| &faces[tree.face(piece) as usize];
    let corners = tree.corners(second);
    let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
    if !tree.holds(second, middle) || tree.face(first) == tree.face(second) {
        return false;
    }
    let plane = face(first).plane();
    let (at_eye, at_middle) = (plane.evaluate(eye), plane.evaluate(middle));
    let t = at_eye / (at_eye - at_middle);
    let hit = eye + (middle - eye) * t;
    let outline = tree.corners(first);
    let inside = outline.len() == 3 && {
        let side = |k: usize| {
            let (a, b) = (outline[k], outline[(k + 1) % 3]);
            (b - a).cross(hit - a).dot(plane.normal)
        };
        [0, 1, 2].iter().all(|&k| side(k) > 1e-6)
    };
    inside && t > 0.0 && t < 1.0 - 1e-6
}

#[test]
fn too_many_pieces_are_refused() {
    let how = bsp::Options { candidates: 1, max_pieces: 4 };
    let crossing: Vec<Face> = scene(&mut Random(14), 9);
    let refused = Tree::new(&crossing, &how, &Work::default(), &mut NoTrace).unwrap_err();
    assert!(refused.to_string().contains("pieces of a tree"), "{refused}");
    let how = depth_sort::Options { max_pieces: 10 };
    let refused = depth_sort::items(&crossing, &screen(), &how, &mut NoTrace).unwrap_err();
    assert!(refused.to_string().contains("pieces of polygons"), "{refused}");
    let how = regions::Options { max_cuts: 3 };
    assert!(regions(&crossing, &how, &Work::default(), &mut NoTrace).is_err());
}

/// Checks that lists and tables that grow with the polygons are charged, not only the planes of the picture, and that
/// all of it is given back.
#[test]
fn lists_of_polygons_are_charged_to_the_budget() {
    let faces = scene(&mut Random(15), 48);
    for method in PolygonMethod::ALL {
        let expected = method.items(&faces, &screen()).unwrap();
        // The smallest sufficient power of two.
        let needed = |faces: &[Face]| {
            let suffices = |bytes: &u64| {
                let work = Work::with_budget(*bytes, "the budget");
                let found = method.items(faces, &Screen { work: work.clone(), ..screen() });
                let found = found.inspect_err(|e| assert!(e.is_of_budget(), "{method}: {e}"));
                let is_enough = found.is_ok();
                drop(found);
                assert_eq!(work.used(), 0, "{method}");
                is_enough
            };
            (8..30).map(|bits| 1 << bits).find(suffices).unwrap()
        };
        let [few, many] = [&faces[..6], &faces].map(needed);
        // The simple loop has nothing but planes.
        assert_eq!(many > few, *method != PolygonMethod::ZBuffer, "{method}: {few} {many}");
        let work = Work::with_budget(many, "the budget");
        let found = method.items(&faces, &Screen { work, ..screen() }).unwrap();
        assert!(found == expected, "{method}");
    }
}

/// Checks scenes that are each large in one respect and small in the others.
#[test]
fn pixels_cells_and_regions_that_wait_are_charged() {
    let square = |side: f64, z: f64| {
        let corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)];
        Face::new(&corners.map(|(x, y)| DVec3::new(x, y, z))).unwrap()
    };
    let within = |bytes: u64| Screen { work: Work::with_budget(bytes, "the budget"), ..screen() };
    // Forty times all pixels of the picture, with the points there.
    let walls: Vec<Face> = (0..40).map(|k| square(32.0, f64::from(k))).collect();
    let sorted =
        |bytes: u64| depth_sort::items(&walls, &within(bytes), &Default::default(), &mut NoTrace);
    assert!(sorted(1 << 20).is_err_and(|e| e.to_string().contains("pixels of polygons")));
    assert!(sorted(1 << 21).is_ok());
    // One face in a thousand cells.
    let steep = [(0.0, 0.0, 0.0), (32.0, 0.0, 32.0), (32.0, 32.0, 32.0), (0.0, 32.0, 0.0)];
    let steep = [Face::new(&steep.map(DVec3::from)).unwrap()];
    let how = octree::Options { capacity: 0, depth: 5, ..Default::default() };
    let divided = |bytes: u64| octree::items(&steep, &within(bytes), &how, &mut NoTrace);
    assert!(divided(1 << 16).is_err_and(|e| e.to_string().contains("octree")));
    assert!(divided(1 << 20).is_ok());
    // A wall in front of many things: all of them wait to be cut, and none is visible.
    let mut hidden = vec![square(32.0, 1.0)];
    hidden.extend((0..200).map(|k| square(4.0, f64::from(k + 2))));
    let found = |bytes: u64| {
        let work = Work::with_budget(bytes, "the budget");
        let found = regions(&hidden, &Default::default(), &work, &mut NoTrace);
        assert_eq!(work.used(), 0);
        found
    };
    assert!(found(1 << 13).is_err_and(|e| e.to_string().contains("regions of polygons")));
    assert_eq!(found(1 << 20).unwrap().len(), 1);
}

/// The painter's order, the runs of solids, the cell that is the whole picture, and the edge tables of all.
#[test]
fn orders_runs_and_edge_tables_are_charged() {
    let square = |z: f64| {
        let corners = [(0.0, 0.0), (32.0, 0.0), (32.0, 32.0), (0.0, 32.0)];
        Face::new(&corners.map(|(x, y)| DVec3::new(x, y, z))).unwrap()
    };
    let all: Vec<Face> = (0..2_000).map(|k| square(f64::from(k))).collect();
    let within = |bytes: u64| Screen { work: Work::with_budget(bytes, "the budget"), ..screen() };
    let refused = |found: durer::Result<Pixels<u32>>, what: &str| {
        assert!(found.is_err_and(|e| e.is_of_budget() && e.to_string().contains(what)), "{what}");
    };
    let painted = |screen: &Screen| painter::items(&all, screen, &Default::default(), &mut NoTrace);
    refused(painted(&within(16_000)), "order of polygons");
    let enough = within(64_000);
    assert!(painted(&enough).is_ok());
    assert_eq!(enough.work.used(), 0);
    // A run of each face in each of the rows.
    let solids = [all[..200].to_vec()];
    let union = csg::Expression::fold(durer::clip::polygon::BooleanOp::Union, 1).unwrap();
    let combined = |screen: &Screen| csg::items(&solids, &union, screen, &mut NoTrace);
    refused(combined(&within(64_000)), "runs of pixels");
    assert!(combined(&within(1 << 20)).is_ok());
    // One cell with all pixels.
    let how = octree::Options { capacity: 9, depth: 0, ..Default::default() };
    let filled = |screen: &Screen| octree::items(&all[..2], screen, &how, &mut NoTrace);
    refused(filled(&within(32_000)), "pixels of a cell");
    assert!(filled(&within(1 << 17)).is_ok());
    // The planes take 12 kB, the table of one face with thousands of corners much more.
    let wheel = |k: u32| {
        let angle = f64::from(k) / 2_000.0 * std::f64::consts::TAU;
        (DVec2::from_angle(angle) * 15.0 + 16.0).extend(1.0)
    };
    let wheel = [Face::new(&(0..2_000).map(wheel).collect::<Vec<_>>()).unwrap()];
    for method in PolygonMethod::ALL.iter().filter(|method| **method != PolygonMethod::Watkins) {
        refused(method.items(&wheel, &within(160_000)), "");
        assert!(method.items(&wheel, &within(1 << 20)).is_ok(), "{method}");
    }
    let looped = |bytes: u64| z_buffer::items(&wheel, &within(bytes), &mut NoTrace);
    refused(looped(160_000), "edge table of a polygon");
}

#[test]
fn watkins_has_his_tables() {
    use watkins::Step;
    let quad = |x0: f64, x1: f64, z: f64| {
        let corners = [(x0, 0.5), (x1, 0.5), (x1, 2.5), (x0, 2.5)];
        Face::new(&corners.map(|(x, y)| DVec3::new(x, y, z + 0.25 * x))).unwrap()
    };
    let faces = [quad(0.5, 8.5, 5.0), quad(4.5, 12.5, 2.0)];
    let mut steps = Recorder::default();
    watkins::items(&faces, &screen(), &mut steps).unwrap();
    let steps = steps.steps();
    let is = |wanted: fn(&Step) -> bool| steps.iter().filter(|s| wanted(s)).count();
    // Horizontal edges are in no table: two edges and one plane a polygon, two rows.
    assert_eq!(is(|s| matches!(s, Step::Edge(_))), 4);
    assert_eq!(is(|s| matches!(s, Step::Row { .. })), 2);
    assert_eq!(is(|s| matches!(s, Step::Active(_))), 8);
    let slopes: Vec<_> = steps
        .iter()
        .filter_map(|s| match s {
            Step::Polygon { slope, origin, .. } => Some((*slope, *origin)),
            _ => None,
        })
        .collect();
    for ((slope, origin), z) in slopes.iter().zip([5.0, 2.0]) {
        assert!(slope.distance(DVec2::new(0.25, 0.0)) < 1e-12 && (origin - z).abs() < 1e-12);
    }
    let row: Vec<_> = steps
        .iter()
        .filter_map(|s| match *s {
            Step::Flag { face, x, inside } => Some((face, x, inside)),
            _ => None,
        })
        .collect();
    assert_eq!(row[..4], [(0, 0, true), (1, 4, true), (0, 8, false), (1, 12, false)]);
    let spans: Vec<_> = steps
        .iter()
        .filter_map(|s| match *s {
            Step::Span { face, y: 0, columns } => Some((face, columns)),
            _ => None,
        })
        .collect();
    assert_eq!(spans, [(0, [0, 4]), (1, [4, 8]), (1, [8, 12])]);
    let ends = steps.iter().find_map(|s| match *s {
        Step::Ends { columns: [4, 8], polygons: 2, nearest, depths } => Some((nearest, depths)),
        _ => None,
    });
    assert_eq!(ends, Some(([1, 1], [3.125, 3.875])));
}

#[test]
fn regions_show_the_nearest_face_everywhere() {
    let mut random = Random(15);
    for round in 0..12 {
        let faces = if round == 0 { beams().to_vec() } else { scene(&mut random, 3 + round / 2) };
        let seen = regions(&faces, &Default::default(), &Work::default(), &mut NoTrace).unwrap();
        let inside = |ring: &[DVec2], p: DVec2| {
            let next = ring.iter().cycle().skip(1);
            let crosses = ring.iter().zip(next).filter(|(a, b)| {
                (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)
            });
            crosses.count() % 2 == 1
        };
        for _ in 0..400 {
            let p = random.point(0.0, 32.0);
            let covers = |face: &Face| inside(&face.outline(), p);
            let nearest = (0..faces.len()).filter(|&k| covers(&faces[k]));
            let depth = |k: &usize| faces[*k].depth(p);
            let nearest = nearest.min_by(|a, b| depth(a).total_cmp(&depth(b)));
            let shown: Vec<usize> = seen
                .iter()
                .filter(|r| r.shapes.rings().filter(|ring| inside(ring, p)).count() % 2 == 1)
                .map(|r| r.face as usize)
                .collect();
            assert_eq!(shown, nearest.into_iter().collect::<Vec<_>>(), "{p} in round {round}");
        }
    }
}

/// Checks that whole cells behind a wall are skipped, and that the numbers of the pyramid are the depths.
#[test]
fn a_pyramid_of_depths_hides_cells() {
    use hierarchical_z::{Options, PyramidTest, Step};
    let square = |x: f64, y: f64, side: f64, z: f64| {
        let corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)];
        Face::new(&corners.map(|(u, v)| DVec3::new(x + u, y + v, z))).unwrap()
    };
    let mut faces: Vec<Face> = (0..64)
        .map(|k| square(f64::from(k % 8) * 4.0 + 1.0, f64::from(k / 8) * 4.0 + 1.0, 2.0, 50.0))
        .collect();
    faces.push(square(0.0, 0.0, 32.0, 5.0));
    let mut steps = Recorder::default();
    let found = hierarchical_z::items(&faces, &screen(), &Options::default(), &mut steps).unwrap();
    assert!(found.data().iter().all(|item| *item == 64));
    let left_out: usize = (steps.steps().iter())
        .map(|s| if let Step::LeaveOut { faces, .. } = s { *faces } else { 0 })
        .sum();
    let compared = |s: &&Step| matches!(s, Step::Face { face, .. } if *face != 64);
    assert!(left_out >= 48, "{left_out}");
    assert!(steps.steps().iter().filter(compared).count() <= 16);
    // Four pixels, three of them near: the farthest depth of the four stays until the last is near too.
    let small = Screen { width: 2, height: 2, ..Screen::default() };
    let flat = Options { capacity: 9, depth: 0 };
    let faces =
        [square(0.0, 0.0, 2.0, 7.0), square(0.0, 0.0, 1.0, 3.0), square(0.0, 0.0, 2.0, 8.0)];
    let mut steps = Recorder::default();
    hierarchical_z::items(&faces, &small, &flat, &mut steps).unwrap();
    let face = |face, nearest, level, farthest| Step::Face {
        face,
        test: PyramidTest { nearest, level, entry: [0, 0], farthest },
    };
    let store = |pixel, face, depth| Step::Store { pixel, face, depth };
    let expected = [
        face(0, 7.0, 1, f64::INFINITY),
        store([0, 0], 0, 7.0),
        store([1, 0], 0, 7.0),
        store([0, 1], 0, 7.0),
        store([1, 1], 0, 7.0),
        Step::Lower { level: 1, entry: [0, 0], farthest: 7.0 },
        face(1, 3.0, 0, 7.0),
        store([0, 0], 1, 3.0),
        face(2, 8.0, 1, 7.0),
    ];
    assert_eq!(steps.steps()[2..], expected);
    // A face of a child follows those of the root; at equal depths the first of all is visible.
    let tied = [square(0.0, 0.0, 1.0, 5.0), square(0.0, 0.0, 2.0, 5.0)];
    let divided = Options { capacity: 0, depth: 1 };
    let found = hierarchical_z::items(&tied, &small, &divided, &mut NoTrace).unwrap();
    assert_eq!(found.data(), [0, 1, 1, 1]);
}

/// Checks that cells come from near to far, pixels are filled once, and cells behind filled pixels are skipped.
#[test]
fn an_octree_is_filled_from_front_to_back() {
    use octree::{Options, Step};
    let square = |x: f64, y: f64, side: f64, z: f64| {
        let corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)];
        Face::new(&corners.map(|(u, v)| DVec3::new(x + u, y + v, z))).unwrap()
    };
    let far =
        |k: u32| square(f64::from(k % 8) * 4.0 + 1.0, f64::from(k / 8) * 4.0 + 1.0, 2.0, 50.0);
    let mut faces: Vec<Face> = (0..64).map(far).collect();
    faces.push(square(0.0, 0.0, 32.0, 5.0));
    let mut steps = Recorder::default();
    let found = octree::items(&faces, &screen(), &Options::default(), &mut steps).unwrap();
    assert!(found.data().iter().all(|item| *item == 64));
    let (mut compared, mut left_out, mut pixels) = (0, 0, std::collections::BTreeSet::new());
    let mut cells = Vec::new();
    let mut depth = f64::NEG_INFINITY;
    for step in steps.steps() {
        match step {
            Step::Cell { corners, .. } => cells.push(*corners),
            Step::Leaf { cell, faces } => {
                compared += faces.iter().filter(|face| **face != 64).count();
                // Of two cells over the same pixels the near one comes first; here all near ones come first.
                assert!(cells[*cell][0].z >= depth);
                depth = cells[*cell][0].z;
            }
            Step::LeaveOut { cells, .. } => left_out += cells,
            Step::Store { pixel, .. } => assert!(pixels.insert(*pixel), "{pixel:?} twice"),
            Step::Visit { .. } => {}
        }
    }
    assert_eq!((compared, pixels.len()), (0, 32 * 32));
    assert!(left_out > 20, "{left_out}");
    // The number of parts of a face is limited: a steep face is in many cells.
    let steep = [(0.0, 0.0, 0.0), (32.0, 0.0, 30.0), (0.0, 32.0, 30.0)].map(DVec3::from);
    let steep = [Face::new(&steep).unwrap()];
    let few = Options { capacity: 0, depth: 5, max_parts: 500 };
    let refused = octree::items(&steep, &screen(), &few, &mut NoTrace).unwrap_err();
    assert!(refused.to_string().contains("octree"), "{refused}");
}

#[test]
fn faces_must_be_plane_and_have_an_area() {
    let corners = |z: f64| [(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (4.0, 4.0, z), (0.0, 4.0, 0.0)];
    assert!(Face::new(&corners(0.0).map(DVec3::from)).is_ok());
    assert!(Face::new(&corners(1.0).map(DVec3::from)).is_err());
    assert!(Face::new(&corners(f64::NAN).map(DVec3::from)).is_err());
    assert!(Face::new(&[DVec3::ZERO, DVec3::X, DVec3::X * 2.0]).is_err());
    assert!(Face::new(&[]).is_err());
    // Seen edge-on it covers nothing, but it divides a tree.
    let edge = Face::new(&[DVec3::ZERO, DVec3::Y * 9.0, DVec3::Z * 9.0]).unwrap();
    for method in PolygonMethod::ALL {
        let items = method.items(std::slice::from_ref(&edge), &screen()).unwrap();
        assert!(items.data().iter().all(|item| *item == NO_ITEM));
    }
}
