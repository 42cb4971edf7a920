//! Polygon clipping where rings coincide, touch the window's border in a point, or meet a vertex.

use durer::clip::polygon::rectangle;
use durer::clip::polygon::sutherland_hodgman;
use durer::clip::polygon::{BooleanOp, PolygonClipper, Shapes, overlay};
use durer::math::{DVec2, Rect};
use durer::trace::NoTrace;

fn p(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

/// Algorithms that support all operations.
fn general() -> impl Iterator<Item = PolygonClipper> {
    PolygonClipper::ALL.iter().copied().filter(|c| !c.keeps_inside_only())
}

#[test]
fn a_region_and_itself() {
    let ring = [p(0.0, 0.0), p(7.0, 1.0), p(8.0, 6.0), p(3.0, 4.0), p(1.0, 9.0)];
    let hole = [p(1.0, 1.0), p(1.0, 2.0), p(2.0, 1.0)];
    let mut donut = Shapes::new();
    donut.push_ring(ring);
    donut.push_ring(hole);
    donut.end_polygon();
    // The same rings with other starting points and directions.
    let mut turned = Shapes::new();
    turned.push_ring([ring[3], ring[2], ring[1], ring[0], ring[4]]);
    turned.push_ring([hole[1], hole[2], hole[0]]);
    turned.end_polygon();
    let area = donut.area().abs();
    for clipper in general() {
        for other in [&donut, &turned] {
            for (op, expected) in [
                (BooleanOp::Intersection, area),
                (BooleanOp::Union, area),
                (BooleanOp::Difference, 0.0),
                (BooleanOp::Xor, 0.0),
            ] {
                let found = clipper.clip(&donut, other, op).expect("valid");
                assert!((found.area() - expected).abs() < 1e-6, "{clipper} {op}: {}", found.area());
                assert_eq!(found.is_empty(), expected == 0.0, "{clipper} {op}");
            }
        }
    }
}

#[test]
fn a_region_and_the_one_in_its_hole() {
    let square = |low: f64, high: f64| [p(low, low), p(high, low), p(high, high), p(low, high)];
    let mut frame = Shapes::new();
    frame.push_ring(square(0.0, 6.0));
    frame.push_ring(square(2.0, 4.0));
    frame.end_polygon();
    let plug = Shapes::from_rings([square(2.0, 4.0)]);
    for clipper in general() {
        for (op, ours, theirs) in [
            (BooleanOp::Intersection, 0.0, 0.0),
            (BooleanOp::Union, 36.0, 36.0),
            (BooleanOp::Difference, 32.0, 4.0),
            (BooleanOp::Xor, 36.0, 36.0),
        ] {
            let area = |a: &Shapes, b: &Shapes| clipper.clip(a, b, op).expect("valid").area();
            let found = (area(&frame, &plug), area(&plug, &frame));
            assert!((found.0 - ours).abs() < 1e-6, "{clipper} {op}: {found:?}");
            assert!((found.1 - theirs).abs() < 1e-6, "{clipper} {op}: {found:?}");
        }
    }
}

#[test]
fn a_hole_that_touches_the_border_goes_to_its_own_part() {
    // Two arms that reach out of the window; a hole in one of them touches its border.
    let bridge = [
        p(1.0, 2.0),
        p(4.0, 2.0),
        p(4.0, 12.0),
        p(6.0, 12.0),
        p(6.0, 2.0),
        p(9.0, 2.0),
        p(9.0, 14.0),
        p(1.0, 14.0),
    ];
    let window = Rect::new(DVec2::ZERO, DVec2::splat(10.0)).expect("window");
    for x in [2.5, 7.5] {
        let hole = [p(x, 10.0), p(x + 0.5, 8.0), p(x, 6.0), p(x - 0.5, 8.0)];
        // Rotated, so that each border is touched, and begun at each point of the hole.
        for turn in 0..4 {
            for start in 0..4 {
                let about = |q: DVec2| {
                    let turned = (0..turn).fold(q - DVec2::splat(5.0), |v, _| v.perp());
                    turned + DVec2::splat(5.0)
                };
                let mut shapes = Shapes::new();
                shapes.push_ring(bridge.map(about));
                shapes.push_ring((0..4).map(|i| about(hole[(i + start) % 4])));
                shapes.end_polygon();
                let out = rectangle::clip(&window, &shapes, &rectangle::Options, &mut NoTrace)
                    .expect("finite");
                let holes: usize = out.polygons().map(|part| part.holes().len()).sum();
                let (parts, area) = (out.polygon_count(), out.area());
                assert_eq!((parts, holes, area), (2, 1, 46.0), "{x} {turn} {start}");
            }
        }
    }
}

#[test]
fn points_that_are_not_finite_are_named_wherever_they_stand() {
    let window = Rect::new(DVec2::ZERO, DVec2::splat(10.0)).expect("window");
    for count in 3..12 {
        for bad in 0..count {
            let angle = |i: usize| i as f64 / count as f64 * 6.0;
            let mut ring: Vec<DVec2> = (0..count)
                .map(|i| p(5.0 + libm::cos(angle(i)), 5.0 + libm::sin(angle(i))))
                .collect();
            ring[bad].y = f64::NAN;
            let shapes = Shapes::from_rings([ring]);
            let error = rectangle::clip(&window, &shapes, &rectangle::Options, &mut NoTrace);
            let error = error.expect_err("not finite").to_string();
            assert!(error.contains(&bad.to_string()), "{count} {bad}: {error}");
        }
    }
}

#[test]
fn a_vertex_that_another_ring_touches_stays() {
    let square = [p(0.0, 0.0), p(4.0, 0.0), p(4.0, 4.0), p(0.0, 4.0)];
    let touching = [p(4.0, 2.0), p(7.0, 1.0), p(7.0, 3.0)];
    let options = overlay::Options::default();
    let (a, b) = (Shapes::from_rings([square]), Shapes::from_rings([touching]));
    let union = overlay::overlay(&a, &b, BooleanOp::Union, &options, &mut NoTrace).expect("finite");
    assert_eq!(union.shapes.polygon_count(), 2);
    let corners: Vec<usize> = union.shapes.rings().map(<[DVec2]>::len).collect();
    assert_eq!(corners, [5, 3]);
    assert_eq!(union.shapes.points().iter().filter(|q| **q == p(4.0, 2.0)).count(), 2);
}

/// Checks crossings whose coordinates, rounded, are those of a vertex.
#[test]
fn crossings_rounded_to_a_vertex_do_not_turn_a_walk_round() {
    let shape = |points: [(f64, f64); 3]| Shapes::from_rings([points.map(|(x, y)| p(x, y))]);
    let small = [
        shape([(0.4, 0.1), (0.15000000000000002, 0.1), (0.0, 0.4)]),
        shape([(0.2, 0.30000000000000004), (0.2, 0.2), (0.1, 0.2)]),
    ];
    let far = [
        shape([
            (100000.33333333333, 100001.66666666667),
            (100000.5, 100002.0),
            (100000.66666666667, 100002.0),
        ]),
        shape([
            (100003.0, 100000.0),
            (100000.54545454546, 100001.63636363637),
            (100001.0, 100003.0),
        ]),
    ];
    for [subject, clip] in [small, far] {
        for &op in BooleanOp::ALL {
            let options = overlay::Options::default();
            let expected = overlay::overlay(&subject, &clip, op, &options, &mut NoTrace).unwrap();
            for clipper in [PolygonClipper::WeilerAtherton, PolygonClipper::GreinerHormann] {
                let found = clipper.clip(&subject, &clip, op).unwrap();
                let off = (found.area() - expected.shapes.area()).abs();
                // The grid of the overlay moves borders by up to 3e-9 here.
                assert!(off < 1e-8, "{clipper:?} {op:?}: {off}");
            }
        }
    }
}

#[test]
fn a_vertex_on_the_border_comes_out_once() {
    let window = Rect::new(DVec2::ZERO, DVec2::splat(4.0)).expect("window");
    // From the border outside and back, and along the border.
    let ring = [p(4.0, 1.0), p(6.0, 2.0), p(4.0, 3.0), p(1.0, 3.0), p(0.0, 2.0), p(1.0, 1.0)];
    let out = sutherland_hodgman::clip(&window, &ring, &mut NoTrace).expect("finite");
    assert_eq!(out, [ring[0], ring[2], ring[3], ring[4], ring[5]]);
}

/// Returns a histogram with whole heights, seen from one of four sides: simple, with many edges in common with others
/// of its kind.
fn skyline(heights: &[u32], side: usize) -> Shapes {
    let mut ring = vec![p(0.0, 0.0)];
    for (i, &height) in heights.iter().enumerate() {
        ring.extend([p(i as f64, height.into()), p(i as f64 + 1.0, height.into())]);
    }
    ring.push(p(heights.len() as f64, 0.0));
    ring.dedup();
    let middle = DVec2::splat(2.0);
    let turned = |q: DVec2| (0..side).fold(q - middle, |v, _| v.perp()) + middle;
    Shapes::from_rings([ring.into_iter().map(turned).collect::<Vec<_>>()])
}

#[test]
fn walks_along_common_edges_leave_no_spikes() {
    let mut state = 5_u64;
    let mut random = |range: u64| {
        let step = (6_364_136_223_846_793_005, 1_442_695_040_888_963_407);
        state = state.wrapping_mul(step.0).wrapping_add(step.1);
        ((state >> 33) % range) as u32
    };
    for case in 0..1500 {
        let mut shape = || skyline(&[0; 4].map(|_| 1 + random(3)), random(4) as usize);
        let (a, b) = (shape(), shape());
        for clipper in [PolygonClipper::WeilerAtherton, PolygonClipper::GreinerHormann] {
            for &op in BooleanOp::ALL {
                let found = clipper.clip(&a, &b, op).expect("valid");
                for ring in found.rings() {
                    let n = ring.len();
                    let turns_back = (0..n).any(|i| ring[i] == ring[(i + 2) % n]);
                    let repeats = (0..n).any(|i| ring[i] == ring[(i + 1) % n]);
                    assert!(!turns_back && !repeats, "{case} {clipper} {op}: {ring:?}");
                }
                let expected = PolygonClipper::Overlay.clip(&a, &b, op).expect("valid").area();
                assert_eq!(found.area(), expected, "{case} {clipper} {op}");
            }
        }
    }
}
