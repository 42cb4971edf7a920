//! Coverages stay coverages when they are simplified.

use durer::clip::polygon::{
    BooleanOp, Shapes, WindingRule,
    overlay::{self, overlay},
    signed_area,
};
use durer::clip::simplify::coverage::{Coverage, Options, Step};
use durer::clip::simplify::{LineSimplifier, tolerance_for_share};
use durer::math::{DVec2, Orientation, orient2d};
use durer::trace::{NoTrace, Recorder};
use proptest::prelude::*;

const SIDE: usize = 9;

/// Returns the areas of a map of labels, one polygon set per label, with a point at every corner of a square:
/// neighbours have the same points. The corners are moved by less than would make squares overlap.
fn areas(labels: &[u8], moved: &[(i8, i8)]) -> Vec<Shapes> {
    let place = |p: DVec2| {
        let (dx, dy) = moved[(p.y as usize * (SIDE + 1) + p.x as usize) % moved.len()];
        p + DVec2::new(dx.into(), dy.into()) / 512.0
    };
    (0..4u8)
        .map(|label| {
            let cells = (0..SIDE * SIDE).filter(|&i| labels[i] == label).map(|i| {
                let (x, y) = ((i % SIDE) as f64, (i / SIDE) as f64);
                [(0., 0.), (1., 0.), (1., 1.), (0., 1.)].map(|(u, v)| DVec2::new(x + u, y + v))
            });
            let options = overlay::Options {
                grid: Some(1.0),
                ..overlay::Options::with_rule(WindingRule::NonZero)
            };
            let cells = Shapes::from_rings(cells);
            let joined =
                overlay(&cells, &Shapes::new(), BooleanOp::Union, &options, &mut NoTrace).unwrap();
            let mut dense = Shapes::new();
            for polygon in joined.shapes.polygons() {
                for ring in polygon.rings() {
                    let next = ring.iter().cycle().skip(1);
                    dense.push_ring(
                        ring.iter()
                            .zip(next)
                            .flat_map(|(&a, &b)| {
                                let steps = (b - a).abs().max_element() as usize;
                                (0..steps)
                                    .map(move |k| place(a + (b - a) * (k as f64 / steps as f64)))
                            })
                            .collect::<Vec<_>>(),
                    );
                }
                dense.end_polygon();
            }
            dense
        })
        .collect()
}

/// Returns the areas that remain.
fn kept(areas: &[Shapes], weights: &[f64], tolerance: f64) -> Vec<Shapes> {
    let mut weights = weights.iter();
    areas
        .iter()
        .map(|area| {
            let mut left = Shapes::new();
            for polygon in area.polygons() {
                for ring in polygon.rings() {
                    left.push_ring(
                        ring.iter()
                            .copied()
                            .filter(|_| *weights.next().unwrap() > tolerance)
                            .collect::<Vec<_>>(),
                    );
                }
                left.end_polygon();
            }
            left
        })
        .collect()
}

fn edges(areas: &[Shapes]) -> Vec<(DVec2, DVec2)> {
    let of = |ring: &[DVec2]| {
        ring.iter().copied().zip(ring.iter().copied().cycle().skip(1)).collect::<Vec<_>>()
    };
    areas.iter().flat_map(|area| area.rings().flat_map(of).collect::<Vec<_>>()).collect()
}

/// Returns whether two edges have more in common than end points, without being equal.
fn conflict((a, b): (DVec2, DVec2), (c, d): (DVec2, DVec2)) -> bool {
    if (a, b) == (c, d) || (a, b) == (d, c) {
        return false;
    }
    let side = |p, q, r| orient2d(p, q, r);
    let on = |p: DVec2, q: DVec2, r: DVec2| {
        side(p, q, r) == Orientation::Collinear
            && r != p
            && r != q
            && r.cmpge(p.min(q)).all()
            && r.cmple(p.max(q)).all()
    };
    let opposite = |x, y| x != y && x != Orientation::Collinear && y != Orientation::Collinear;
    on(a, b, c)
        || on(a, b, d)
        || on(c, d, a)
        || on(c, d, b)
        || (opposite(side(a, b, c), side(a, b, d)) && opposite(side(c, d, a), side(c, d, b)))
}

fn check(areas: &[Shapes], left: &[Shapes]) -> Result<(), TestCaseError> {
    let edges = edges(left);
    for (i, &one) in edges.iter().enumerate() {
        for &other in &edges[..i] {
            prop_assert!(!conflict(one, other), "{one:?} {other:?}");
        }
    }
    for (before, after) in areas.iter().zip(left) {
        for (ring, now) in before.rings().zip(after.rings()) {
            prop_assert!(now.len() >= 3);
            prop_assert!(signed_area(ring) * signed_area(now) > 0.0);
        }
    }
    // Without overlaps and gaps, their union is one polygon whose area is the sum of all.
    let mut all = Shapes::new();
    left.iter().for_each(|area| all.append(area));
    // Cells so small that no edge passes within half a cell of another's vertex, through which the overlay would lead
    // it.
    let options = overlay::Options {
        grid: Some(1.0 / f64::from(512 << 16)),
        ..overlay::Options::with_rule(WindingRule::Positive)
    };
    let union = overlay(&all, &Shapes::new(), BooleanOp::Union, &options, &mut NoTrace).unwrap();
    prop_assert_eq!(union.shapes.ring_count(), 1);
    prop_assert!((union.shapes.area() - all.area()).abs() < 1e-9);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::coverage::cases(100)))]

    #[test]
    fn coverages_stay_coverages(
        labels in prop::collection::vec(0..4u8, SIDE * SIDE),
        moved in prop::collection::vec((-100i8..100, -100i8..100), 40),
        tolerance in 0..30u32,
        by_distance: bool,
    ) {
        let method = LineSimplifier::ALL[usize::from(!by_distance)];
        let areas = areas(&labels, &moved);
        check(&areas, &areas)?;
        let mut coverage = Coverage::default();
        areas.iter().flat_map(|area| area.rings().map(<[DVec2]>::to_vec).collect::<Vec<_>>())
            .for_each(|ring| coverage.push_ring(ring));
        let mut steps = Recorder::default();
        let weights = coverage.weights(&Options { method, limit: f64::INFINITY }, &mut NoTrace).unwrap();
        let tolerance = f64::from(tolerance) * 0.2;
        check(&areas, &kept(&areas, &weights, tolerance))?;
        check(&areas, &kept(&areas, &weights, tolerance_for_share(&weights, 0.3)))?;
        // A limit changes nothing below it, and the steps agree.
        let limited = coverage.weights(&Options { method, limit: tolerance }, &mut steps).unwrap();
        for (all, some) in weights.iter().zip(&limited) {
            prop_assert_eq!(if *all <= tolerance { *all } else { f64::INFINITY }, *some);
        }
        let gone: Vec<DVec2> = steps.steps().iter().map(|Step::Removed { at, .. }| *at).collect();
        let points = areas.iter().flat_map(|area| area.points());
        for (point, weight) in points.zip(&limited) {
            prop_assert_eq!(weight.is_finite(), gone.contains(point));
        }
    }
}

fn weights_of(
    lines: &[&[(f64, f64)]],
    rings: &[&[(f64, f64)]],
    method: LineSimplifier,
) -> Vec<f64> {
    let mut coverage = Coverage::default();
    lines.iter().for_each(|line| coverage.push_line(line.iter().copied().map(DVec2::from)));
    rings.iter().for_each(|ring| coverage.push_ring(ring.iter().copied().map(DVec2::from)));
    coverage.weights(&Options { method, limit: f64::INFINITY }, &mut NoTrace).unwrap()
}

#[test]
fn lines_do_not_jump_over_islands() {
    let island: &[(f64, f64)] = &[(4.9, 0.5), (5.1, 0.5), (5.0, 0.7)];
    for &method in LineSimplifier::ALL {
        let alone = weights_of(&[&[(0., 0.), (5., 1.), (10., 0.)]], &[], method);
        assert!(alone[1] < 10.0);
        let with = weights_of(&[&[(0., 0.), (5., 1.), (10., 0.)]], &[island], method);
        assert_eq!(with[1], f64::INFINITY, "{method}");
        assert!(with[3..].iter().all(|w| *w == f64::INFINITY), "three points stay: {with:?}");
    }
}

#[test]
fn rings_keep_three_points_and_lenses_two_borders() {
    let circle: Vec<(f64, f64)> =
        (0..40).map(|i| f64::from(i) * 0.157).map(|a| (a.cos(), a.sin())).collect();
    for &method in LineSimplifier::ALL {
        let weights = weights_of(&[], &[&circle, &circle], method);
        let kept = |range: std::ops::Range<usize>| {
            weights[range].iter().filter(|w| w.is_infinite()).count()
        };
        assert_eq!((kept(0..40), kept(40..80)), (3, 3), "{method}");
        assert_eq!(weights[..40], weights[40..]);
        // Two areas between the same two nodes; one is a lens.
        let lens: &[(f64, f64)] = &[(0., 0.), (5., -1.), (10., 0.), (5., 1.)];
        let around: &[(f64, f64)] = &[(0., 0.), (5., 1.), (10., 0.), (10., 9.), (0., 9.)];
        let weights = weights_of(&[], &[lens, around], method);
        assert_eq!(
            weights[..4].iter().filter(|w| w.is_infinite()).count(),
            3,
            "{method} {weights:?}"
        );
    }
}

#[test]
fn odd_input_gives_some_weights() {
    let nan = Coverage::default();
    for &method in LineSimplifier::ALL {
        assert!(nan.weights(&Options { method, limit: f64::NAN }, &mut NoTrace).is_err());
        assert_eq!(
            weights_of(&[&[], &[(1., 1.)]], &[&[], &[(0., 0.)], &[(2., 2.), (2., 2.)]], method)
                .len(),
            4
        );
        // Spikes, bow ties, repeated points, rings repeated with other vertices.
        let bow: &[(f64, f64)] = &[(0., 0.), (2., 2.), (2., 0.), (0., 2.), (0., 0.)];
        let spike: &[(f64, f64)] = &[(0., 0.), (5., 0.), (5., 0.), (9., 0.), (5., 0.)];
        let far: &[(f64, f64)] =
            &[(-f64::MAX, 0.), (f64::MAX, f64::MAX), (0., -f64::MAX), (1e-300, 1.)];
        let weights = weights_of(&[spike], &[bow, spike, far], method);
        assert_eq!(weights.len(), 5 + 5 + 5 + 4);
        assert_eq!(weights[2], 0.0, "repeated on the spot");
        assert_eq!(weights[9], 0.0, "repeated at the end of a ring");
    }
}
