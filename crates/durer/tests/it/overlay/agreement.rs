//! The four polygon algorithms on inputs that all of them accept.

use durer::clip::polygon::overlay::{Options, overlay};
use durer::clip::polygon::{
    BooleanOp, PolygonClipper, Shapes, WindingRule, greiner_hormann, vatti, weiler_atherton,
};
use durer::math::DVec2;
use durer::trace::{NoTrace, Recorder};
use proptest::prelude::*;

/// Sixteen directions, counter-clockwise, as integers.
const DIRECTIONS: [(i32, i32); 16] = [
    (2, 0),
    (2, 1),
    (2, 2),
    (1, 2),
    (0, 2),
    (-1, 2),
    (-2, 2),
    (-2, 1),
    (-2, 0),
    (-2, -1),
    (-2, -2),
    (-1, -2),
    (0, -2),
    (1, -2),
    (2, -2),
    (2, -1),
];

fn ring(center: (i32, i32), lengths: &[i32]) -> Vec<DVec2> {
    let point = |(d, l): (&(i32, i32), &i32)| {
        DVec2::new(f64::from(center.0 + d.0 * l), f64::from(center.1 + d.1 * l))
    };
    DIRECTIONS.iter().zip(lengths).map(point).collect()
}

/// Returns a star-shaped polygon around an integer centre, with or without a star-shaped hole, on a grid so coarse that
/// borders often touch and coincide.
fn star() -> impl Strategy<Value = Shapes> {
    let center = (-4..=4, -4..=4);
    let lengths = prop::collection::vec(5..=8, 16);
    let inner = prop::option::of(prop::collection::vec(1..=2, 16));
    (center, lengths, inner).prop_map(|(center, lengths, inner)| {
        let mut shapes = Shapes::new();
        shapes.push_ring(ring(center, &lengths));
        if let Some(lengths) = inner {
            shapes.push_ring(ring(center, &lengths));
        }
        shapes.end_polygon();
        shapes
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn all_algorithms_give_the_same_region(a in star(), b in star()) {
        for &op in BooleanOp::ALL {
            let expected = PolygonClipper::Overlay.clip(&a, &b, op).expect("finite");
            for clipper in [PolygonClipper::WeilerAtherton, PolygonClipper::GreinerHormann] {
                let region = clipper.clip(&a, &b, op).expect("finite");
                let (area, other) = (region.area(), expected.area());
                prop_assert!((area - other).abs() < 1e-4, "{clipper} {op}: {area} {other}");
                let difference = overlay(&region, &expected, BooleanOp::Xor, &Options::default(), &mut NoTrace);
                let apart = difference.expect("finite").shapes.area();
                prop_assert!(apart < 1e-4, "{clipper} {op}: {apart}");
            }
        }
    }

    /// Checks that all members of the family give one region in a rectangle, and all but the first in a triangle.
    #[test]
    fn the_whole_family_clips_to_convex_masks(
        a in star(), x in (-12..=4, 1..=14), y in (-12..=4, 1..=14),
    ) {
        let at = |u: i32, v: i32| DVec2::new(f64::from(x.0 + u), f64::from(y.0 + v));
        let corners = [at(0, 0), at(x.1, 0), at(x.1, y.1), at(0, y.1)];
        for mask in [Shapes::from_rings([corners]), Shapes::from_rings([&corners[..3]])] {
            let expected = PolygonClipper::Overlay.clip(&a, &mask, BooleanOp::Intersection).expect("finite");
            for &clipper in PolygonClipper::ALL {
                let region = clipper.clip(&a, &mask, BooleanOp::Intersection);
                if clipper.needs_rectangle() && mask.points().len() == 3 {
                    prop_assert!(region.is_err());
                    continue;
                }
                let region = region.expect("a convex mask");
                let difference = overlay(&region, &expected, BooleanOp::Xor, &Options::default(), &mut NoTrace);
                let apart = difference.expect("finite").shapes.area();
                prop_assert!(apart < 1e-4, "{clipper}: {apart}");
            }
        }
    }

    #[test]
    fn steps_rebuild_the_results(a in star(), b in star()) {
        let mut steps = Recorder::default();
        let traced = weiler_atherton::weiler_atherton(&a, &b, BooleanOp::Xor, &Default::default(), &mut steps).expect("valid");
        prop_assert_eq!(&traced, &weiler_atherton::replay(steps.steps()));
        prop_assert_eq!(&traced, &PolygonClipper::WeilerAtherton.clip(&a, &b, BooleanOp::Xor).expect("finite"));
        let mut steps = Recorder::default();
        let traced = greiner_hormann::greiner_hormann(&a, &b, BooleanOp::Union, &Default::default(), &mut steps).expect("valid");
        prop_assert_eq!(&traced, &greiner_hormann::replay(steps.steps()));
        prop_assert_eq!(&traced, &PolygonClipper::GreinerHormann.clip(&a, &b, BooleanOp::Union).expect("finite"));
    }

    #[test]
    fn the_sweep_is_the_overlay(
        a in super::laws::soup(3, 8, 7), b in super::laws::soup(3, 8, 7),
        op in super::laws::op(), rule in super::laws::rule(), coarse: bool,
    ) {
        let options = Options { grid: coarse.then_some(1.0), ..Options::with_rule(rule) };
        let by_parts = overlay(&a, &b, op, &options, &mut NoTrace).expect("finite");
        let mut steps = Recorder::default();
        let by_sweep = vatti::vatti(&a, &b, op, &options, &mut steps).expect("finite");
        prop_assert_eq!(&by_parts, &by_sweep);
        prop_assert_eq!(vatti::replay(steps.steps()), by_sweep.shapes);
    }
}

#[test]
fn what_an_algorithm_cannot_do_is_an_error() {
    let square =
        Shapes::from_rings([[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from)]);
    let two = Shapes::from_rings([square.points(), square.points()]);
    for &clipper in PolygonClipper::ALL {
        for &op in BooleanOp::ALL {
            let able = op == BooleanOp::Intersection || !clipper.keeps_inside_only();
            assert_eq!(clipper.clip(&square, &square, op).is_ok(), able, "{clipper} {op}");
        }
        let able = matches!(clipper, PolygonClipper::Overlay | PolygonClipper::Vatti);
        assert_eq!(clipper.clip(&square, &two, BooleanOp::Intersection).is_ok(), able, "{clipper}");
    }
}

#[test]
fn names_are_found() {
    for &clipper in PolygonClipper::ALL {
        assert_eq!(clipper.name().parse(), Ok(clipper));
    }
    assert_eq!("even-odd".parse(), Ok(WindingRule::EvenOdd));
    assert!("nonsense".parse::<BooleanOp>().is_err());
}
