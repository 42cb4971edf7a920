//! Greiner–Hormann on rings that cross themselves and one another, compared with the overlay.

use durer::clip::polygon::greiner_hormann::{Step, greiner_hormann, replay};
use durer::clip::polygon::overlay::{Options, overlay};
use durer::clip::polygon::point::{Place, locate};
use durer::clip::polygon::{BooleanOp, Shapes, WindingRule};
use durer::math::DVec2;
use durer::trace::{NoTrace, Recorder};
use proptest::prelude::*;

fn points(ring: &[(f64, f64)]) -> Vec<DVec2> {
    ring.iter().map(|&p| p.into()).collect()
}

fn shapes(rings: &[&[(f64, f64)]]) -> Shapes {
    Shapes::from_rings(rings.iter().map(|ring| points(ring)))
}

fn cut(a: &Shapes, b: &Shapes, op: BooleanOp) -> durer::Result<Shapes> {
    greiner_hormann(a, b, op, &Default::default(), &mut NoTrace)
}

/// Returns the area of rings by the even-odd rule.
fn enclosed(shapes: &Shapes) -> f64 {
    let options = Options::with_rule(WindingRule::EvenOdd);
    let valid = overlay(shapes, &Shapes::new(), BooleanOp::Union, &options, &mut NoTrace);
    valid.expect("finite").shapes.area()
}

/// Checks a pentagram, whose centre is wound around twice: outside by the even-odd rule.
const STAR: &[(f64, f64)] = &[(5., 10.), (8., 0.5), (0., 6.5), (10., 6.5), (2., 0.5)];
const RIGHT: &[(f64, f64)] = &[(5.5, 1.), (11., 1.), (11., 9.), (5.5, 9.)];

#[test]
fn a_pentagram_is_cut_as_by_the_overlay() {
    let (star, right) = (shapes(&[STAR]), shapes(&[RIGHT]));
    for &op in BooleanOp::ALL {
        let found = cut(&star, &right, op).expect("touches nowhere");
        let options = Options::default();
        let expected = overlay(&star, &right, op, &options, &mut NoTrace).expect("finite").shapes;
        assert!((enclosed(&found) - expected.area()).abs() < 1e-6, "{op}");
        for (x, y) in (0..24).flat_map(|x| (0..24).map(move |y| (x, y))) {
            let p = DVec2::new(f64::from(x) * 0.503 + 0.07, f64::from(y) * 0.451 + 0.03);
            let place = |shapes: &Shapes| locate(shapes.rings(), p, WindingRule::EvenOdd);
            assert_eq!(place(&found), place(&expected), "{op} {p}");
        }
    }
    // The centre is outside, as the points around it are not.
    let inside = cut(&star, &right, BooleanOp::Intersection).expect("touches nowhere");
    let place = |x, y| locate(inside.rings(), DVec2::new(x, y), WindingRule::EvenOdd);
    assert_eq!((place(5.6, 4.5), place(8.5, 6.2)), (Place::Outside, Place::Inside));
}

#[test]
fn a_bow_tie_may_be_on_either_side() {
    let bow = shapes(&[&[(0., 0.), (4., 4.), (4., 0.), (0., 4.)]]);
    let band = shapes(&[&[(-1., 1.), (5., 1.), (5., 3.), (-1., 3.)]]);
    // Two triangles of area 4; beyond each border of the band there are two small ones of area ½.
    for (op, area) in [
        (BooleanOp::Intersection, 6.),
        (BooleanOp::Union, 14.),
        (BooleanOp::Difference, 2.),
        (BooleanOp::Xor, 8.),
    ] {
        assert!((enclosed(&cut(&bow, &band, op).expect("valid")) - area).abs() < 1e-9, "{op}");
    }
    let other = cut(&band, &bow, BooleanOp::Difference).expect("valid");
    assert!((enclosed(&other) - 6.).abs() < 1e-9);
}

#[test]
fn rings_that_cross_and_touch_are_refused() {
    let bow = shapes(&[&[(0., 0.), (4., 4.), (4., 0.), (0., 4.)]]);
    let corner_on_edge = shapes(&[&[(1., 1.), (5., 1.), (5., 5.), (1., 5.)]]);
    let refused = cut(&bow, &corner_on_edge, BooleanOp::Union);
    assert!(refused.is_err_and(|e| e.to_string().contains("touches the other polygon")));
    // The same corner on a ring that does not cross is accepted.
    let triangle = shapes(&[&[(0., 0.), (4., 0.), (4., 4.)]]);
    assert!(cut(&triangle, &corner_on_edge, BooleanOp::Union).is_ok());
}

/// Checks rings of few points on two lattices that have no point and no line in common.
fn ring(shift: f64) -> impl Strategy<Value = Vec<DVec2>> {
    let at = move |(x, y): (i32, i32)| DVec2::new(f64::from(x) + shift, f64::from(y) + shift * 0.7);
    prop::collection::vec((0..12, 0..12), 3..9)
        .prop_map(move |ring| ring.into_iter().map(at).collect())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_rings_are_cut_as_by_the_overlay(
        a in prop::collection::vec(ring(0.0), 1..3), b in prop::collection::vec(ring(0.317_811), 1..3),
    ) {
        let (a, b) = (Shapes::from_rings(a), Shapes::from_rings(b));
        for &op in BooleanOp::ALL {
            let mut steps = Recorder::default();
            let Ok(found) = greiner_hormann(&a, &b, op, &Default::default(), &mut steps) else {
                // Lattices with a vertex on an edge of the other are rare.
                continue;
            };
            let expected = overlay(&a, &b, op, &Options::default(), &mut NoTrace).expect("finite").shapes;
            let apart = overlay(&found, &expected, BooleanOp::Xor, &Options::default(), &mut NoTrace);
            let apart = apart.expect("finite").shapes.area();
            prop_assert!(apart < 1e-6, "{op}: {apart}");
            prop_assert_eq!(replay(steps.steps()), found.clone());
            prop_assert_eq!(&found, &cut(&a, &b, op).expect("as before"));
            let marks = steps.steps().iter().filter(|s| matches!(s, Step::Crossing { .. })).count();
            prop_assert!(marks % 2 == 0, "entries and exits come in pairs");
        }
    }
}
