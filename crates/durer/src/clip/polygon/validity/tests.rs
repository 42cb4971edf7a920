//! Small shapes with every fault, and random squares.

use super::*;
use crate::trace::PseudocodeLine;

fn shapes(polygons: &[&[&[(f64, f64)]]]) -> Shapes {
    let mut shapes = Shapes::new();
    for polygon in polygons {
        for ring in *polygon {
            shapes.push_ring(ring.iter().map(|&p| DVec2::from(p)));
        }
        shapes.end_polygon();
    }
    shapes
}

const SQUARE: &[(f64, f64)] = &[(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)];
const SMALL: &[(f64, f64)] = &[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0)];
const FAR: &[(f64, f64)] = &[(21.0, 1.0), (22.0, 1.0), (22.0, 2.0)];

#[test]
fn validity_is_decided_by_edges_and_nesting() {
    let bowtie: &[(f64, f64)] = &[(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)];
    let spike: &[(f64, f64)] = &[(0.0, 0.0), (2.0, 0.0), (2.0, 5.0), (2.0, 2.0), (0.0, 2.0)];
    let touching: &[(f64, f64)] = &[(0.0, 5.0), (2.0, 4.0), (2.0, 6.0)];
    for (polygons, valid) in [
        (&[&[SQUARE, SMALL][..]][..], true),
        (&[&[SQUARE], &[FAR]], true),
        (&[&[SQUARE], &[SMALL]], false),
        (&[&[SQUARE, FAR]], false),
        (&[&[SQUARE, SMALL], &[SMALL]], false),
        (&[&[bowtie]], false),
        (&[&[spike]], false),
        (&[&[SQUARE, touching]], false),
    ] {
        assert_eq!(is_valid(&shapes(polygons), Touching::No), valid, "{polygons:?}");
    }
}

fn faults(polygons: &[&[&[(f64, f64)]]]) -> Vec<(Fault, (f64, f64))> {
    let shapes = shapes(polygons);
    let (mut steps, found) = (crate::trace::Recorder::default(), flaws(&shapes).expect("flaws"));
    assert_eq!(flaws_traced(&shapes, &mut steps).expect("flaws"), found);
    assert_eq!(replay(steps.steps()), found, "{polygons:?}");
    assert!(steps.steps().iter().all(|step| (1..=11).contains(&step.line())));
    found.into_iter().map(|f| (f.fault, f.at.into())).collect()
}

#[test]
fn flaws_have_a_reason_and_a_place() {
    let bowtie: &[(f64, f64)] = &[(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)];
    assert_eq!(faults(&[&[bowtie]]), [(Fault::Crossing, (2.0, 2.0))]);
    let spike: &[(f64, f64)] = &[(0.0, 0.0), (2.0, 0.0), (2.0, 5.0), (2.0, 2.0), (0.0, 2.0)];
    // Back along the same line, and then away from it.
    let both = [Fault::Overlap, Fault::SelfTouch].map(|fault| (fault, (2.0, 2.0)));
    assert_eq!(faults(&[&[spike]]), both);
    let flat: &[(f64, f64)] = &[(1.0, 1.0), (2.0, 2.0), (1.0, 1.0), (1.0, 1.0)];
    assert_eq!(faults(&[&[flat]]), [(Fault::FewPoints, (1.0, 1.0))]);
    let pinched: &[(f64, f64)] =
        &[(0.0, 0.0), (4.0, 0.0), (2.0, 2.0), (4.0, 4.0), (0.0, 4.0), (2.0, 2.0)];
    assert_eq!(faults(&[&[pinched]]), [(Fault::SelfTouch, (2.0, 2.0))]);
    assert_eq!(faults(&[&[SQUARE, FAR]]), [(Fault::HoleOutside, (21.0, 1.0))]);
    assert_eq!(faults(&[&[SQUARE], &[SMALL]]), [(Fault::PolygonInPolygon, (1.0, 1.0))]);
    let inner: &[(f64, f64)] = &[(1.2, 1.2), (1.8, 1.2), (1.8, 1.8)];
    assert_eq!(faults(&[&[SQUARE, SMALL, inner]]), [(Fault::HoleInHole, (1.2, 1.2))]);
    assert_eq!(faults(&[&[SQUARE, SMALL], &[inner]]), []);
    // Repeated consecutive points and a ring closed twice are no faults.
    let twice: &[(f64, f64)] = &[(0.0, 0.0), (9.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 0.0)];
    assert_eq!(faults(&[&[twice]]), []);
    assert!(flaws(&shapes(&[&[&[(f64::NAN, 0.0), (1.0, 0.0), (1.0, 1.0)]]])).is_err());
}

#[test]
fn rings_touch_but_do_not_pass_or_divide() {
    // With a vertex on an edge: from inside; and passing through to the outside, at two such points.
    let leaning: &[(f64, f64)] = &[(9.0, 4.0), (7.0, 5.0), (7.0, 3.0)];
    assert_eq!(faults(&[&[SQUARE, leaning]]), []);
    let through: &[(f64, f64)] = &[(7.0, 3.0), (9.0, 4.0), (12.0, 5.0), (9.0, 6.0), (7.0, 7.0)];
    let places = [(Fault::Crossing, (9.0, 4.0)), (Fault::Crossing, (9.0, 6.0))];
    assert_eq!(faults(&[&[SQUARE, through]]), places);
    // A hole across the whole polygon that touches it in two points: the interior is in two parts.
    let across: &[(f64, f64)] = &[(0.0, 4.0), (4.0, 3.0), (9.0, 4.0), (4.0, 5.0)];
    assert_eq!(faults(&[&[SQUARE, across]]), [(Fault::Divided, (9.0, 4.0))]);
    // A chain of three, each touching the next, from side to side.
    let left: &[(f64, f64)] = &[(0.0, 4.0), (3.0, 3.0), (3.0, 5.0)];
    let right: &[(f64, f64)] = &[(9.0, 4.0), (3.0, 5.0), (6.0, 6.0)];
    assert_eq!(faults(&[&[SQUARE, left, right]]), [(Fault::Divided, (9.0, 4.0))]);
    // Polygons that share a side overlap along it; corners may meet.
    let next: &[(f64, f64)] = &[(9.0, 0.0), (12.0, 0.0), (12.0, 9.0), (9.0, 9.0)];
    assert_eq!(faults(&[&[SQUARE], &[next]]), [(Fault::Overlap, (9.0, 0.0))]);
    let corner: &[(f64, f64)] = &[(9.0, 9.0), (12.0, 9.0), (12.0, 12.0)];
    assert_eq!(faults(&[&[SQUARE], &[corner]]), []);
}

#[test]
fn rings_may_touch_in_a_vertex_but_not_pass_through_it() {
    let square = |x: f64| [(x, x), (x + 4.0, x), (x + 4.0, x + 4.0), (x, x + 4.0)];
    let corners = shapes(&[&[&square(0.0)], &[&square(4.0)]]);
    assert!(edges_are_apart(&corners, Touching::AtVertices));
    // They cross in the two vertices that they share.
    let left = [(0.0, 0.0), (2.0, 1.0), (4.0, 0.0), (4.0, 4.0), (2.0, 3.0), (0.0, 4.0)];
    let right = [(1.0, 2.0), (2.0, 1.0), (1.5, -3.0), (9.0, 2.0), (1.5, 7.0), (2.0, 3.0)];
    assert!(!edges_are_apart(&shapes(&[&[&left], &[&right]]), Touching::AtVertices));
}

#[test]
fn squares_nest_as_their_sides_say() {
    let mut state = 5_u64;
    let mut random = |range: u64| {
        let step = (6_364_136_223_846_793_005, 1_442_695_040_888_963_407);
        state = state.wrapping_mul(step.0).wrapping_add(step.1);
        (state >> 33) % range
    };
    let mut seen = [0; 2];
    for _ in 0..20_000 {
        let mut shapes = Shapes::new();
        let mut squares: Vec<(usize, [u64; 3])> = Vec::new();
        for polygon in 0..2 + random(2) as usize {
            for _ in 0..1 + random(3) {
                let [x, y, side] = [random(12), random(12), 1 + 2 * random(6)];
                squares.push((polygon, [x, y, side]));
                let corners = [(0, 0), (side, 0), (side, side), (0, side)];
                shapes.push_ring(corners.map(|(u, v)| DVec2::new((x + u) as f64, (y + v) as f64)));
            }
            shapes.end_polygon();
        }
        if !edges_are_apart(&shapes, Touching::No) {
            continue;
        }
        let within = |[x, y, s]: [u64; 3], [u, v, t]: [u64; 3]| {
            x > u && y > v && x + s < u + t && y + s < v + t
        };
        let first = |i: usize| i == 0 || squares[i - 1].0 != squares[i].0;
        let expected = (0..squares.len()).all(|i| {
            let (own, square) = squares[i];
            let others = (0..squares.len()).filter(|&j| j != i && within(square, squares[j].1));
            let (mut home, mut nested, mut depths) = (first(i), false, [0; 4]);
            for j in others {
                home |= squares[j].0 == own && first(j);
                nested |= squares[j].0 == own && !first(j) && !first(i);
                depths[squares[j].0] += usize::from(squares[j].0 != own && first(i));
            }
            home && !nested && depths.iter().all(|depth| depth % 2 == 0)
        });
        assert_eq!(is_valid(&shapes, Touching::No), expected, "{squares:?}");
        seen[usize::from(expected)] += 1;
    }
    assert!(seen.iter().all(|&count| count > 100), "{seen:?}");
}

#[test]
fn touching_at_a_vertex_can_be_allowed() {
    let pair = shapes(&[&[SQUARE], &[&[(9.0, 9.0), (12.0, 9.0), (12.0, 12.0)]]]);
    assert!(!edges_are_apart(&pair, Touching::No));
    assert!(edges_are_apart(&pair, Touching::AtVertices));
    // The hole begins on its outer ring: at a vertex, or on an edge.
    let pointed = &[(0.0, 0.0), (3.0, 1.0), (1.0, 3.0)];
    let leaning = &[(9.0, 4.0), (7.0, 5.0), (7.0, 3.0)];
    for (hole, at_vertices) in [(pointed, true), (leaning, false)] {
        let touching = shapes(&[&[SQUARE, hole]]);
        assert!(!is_valid(&touching, Touching::No));
        assert_eq!(is_valid(&touching, Touching::AtVertices), at_vertices);
        assert!(is_valid(&touching, Touching::AtPoints));
        let outside = shapes(&[&[SQUARE], &[hole]]);
        assert!(!is_valid(&outside, Touching::AtPoints));
    }
    let pinched: &[(f64, f64)] =
        &[(0.0, 0.0), (4.0, 0.0), (2.0, 2.0), (4.0, 4.0), (0.0, 4.0), (2.0, 2.0)];
    assert!(!is_valid(&shapes(&[&[pinched]]), Touching::AtPoints));
    let across = shapes(&[&[SQUARE, &[(8.0, 4.0), (10.0, 4.0), (8.0, 5.0)]]]);
    assert!(!is_valid(&across, Touching::AtPoints));
}

#[test]
fn few_edges_are_judged_as_many() {
    let mut state = 7_u64;
    let mut random = |range: u64| {
        let step = (6_364_136_223_846_793_005, 1_442_695_040_888_963_407);
        state = state.wrapping_mul(step.0).wrapping_add(step.1);
        (state >> 33) % range
    };
    let mut seen = [0; 2];
    for _ in 0..20_000 {
        let mut shapes = Shapes::new();
        let width = 3 + random(8);
        for _ in 0..1 + random(2) {
            let count = 2 + random(5);
            shapes.push_ring(
                (0..count).map(|_| DVec2::new(random(width) as f64, random(width) as f64)),
            );
            shapes.end_polygon();
        }
        let expected = each_fault_of_many(&shapes, Touching::No, &mut |_| false);
        assert_eq!(few::are_apart(&shapes), expected, "{shapes:?}");
        seen[usize::from(expected)] += 1;
    }
    assert!(seen.iter().all(|&count| count > 1000), "{seen:?}");
    // As many as there may be, and one more.
    for count in [few::FEW, few::FEW + 1] {
        let ring = (0..count).map(|i| DVec2::new(((count - i) % 2) as f64, i as f64));
        let comb =
            Shapes::from_rings([ring.chain([DVec2::new(9.0, 0.0)]).skip(1).collect::<Vec<_>>()]);
        assert!(edges_are_apart(&comb, Touching::No), "{count}");
    }
}
