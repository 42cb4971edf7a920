//! Tests of the work in patches: this build makes them so small that these inputs have many.

use std::sync::LazyLock;

use proptest::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::super::vatti::vatti;
use super::super::{BooleanOp, Shapes, WindingRule};
use super::{Options, Output, overlay};
use crate::math::DVec2;
use crate::trace::NoTrace;

fn run(a: &Shapes, b: &Shapes, op: BooleanOp, rule: WindingRule) -> Output {
    overlay(a, b, op, &Options::with_rule(rule), &mut NoTrace).expect("finite")
}

/// Returns small rings all over a large grid, or long ones across it, some of them with repeated
/// points.
fn soup(grid: i32) -> impl Strategy<Value = Shapes> {
    let point = (0..grid, 0..grid).prop_map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)));
    let ring = (point, prop::collection::vec((-3..4, -3..4, 1..9), 2..40), any::<bool>());
    let ring = ring.prop_map(|(start, steps, far)| {
        let mut at = start;
        let mut ring = vec![start];
        for (x, y, by) in steps {
            let by = if far { f64::from(by) } else { 1.0 };
            at += DVec2::new(f64::from(x), f64::from(y)) * by;
            ring.push(at);
        }
        ring
    });
    prop::collection::vec(ring, 0..24).prop_map(Shapes::from_rings)
}

const OPS: [BooleanOp; 4] =
    [BooleanOp::Intersection, BooleanOp::Union, BooleanOp::Difference, BooleanOp::Xor];

const RULES: [WindingRule; 4] =
    [WindingRule::EvenOdd, WindingRule::NonZero, WindingRule::Positive, WindingRule::Negative];

proptest! {
    // A case takes milliseconds with such small patches; tests/it/overlay has more cases of these laws.
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn patches_find_what_a_sweep_finds(
        a in soup(60), b in soup(60), op in 0usize..4, rule in 0usize..4,
    ) {
        let (op, rule) = (OPS[op], RULES[rule]);
        let swept = vatti(&a, &b, op, &Options::with_rule(rule), &mut NoTrace).expect("finite");
        prop_assert_eq!(run(&a, &b, op, rule).shapes, swept.shapes);
    }

    #[test]
    fn areas_of_patches_add_up(a in soup(60), b in soup(60), rule in 0usize..4) {
        let none = Shapes::new();
        let area = |a: &Shapes, b: &Shapes, op| run(a, b, op, RULES[rule]).shapes.area();
        let (one, other) = (area(&a, &none, OPS[1]), area(&b, &none, OPS[1]));
        let [both, any, less, xor] = OPS.map(|op| area(&a, &b, op));
        let bound = 1e-6 * (1.0 + any);
        prop_assert!((one + other - both - any).abs() < bound);
        prop_assert!((one - both - less).abs() < bound);
        prop_assert!((any - both - xor).abs() < bound);
    }

    #[test]
    fn threads_and_order_change_nothing_in_patches(
        a in soup(40), b in soup(40), op in 0usize..4, turn in 0usize..9,
    ) {
        static POOLS: LazyLock<[ThreadPool; 2]> = LazyLock::new(|| {
            [1, 2].map(|n| ThreadPoolBuilder::new().num_threads(n).build().expect("pool"))
        });
        let with = |count: usize, a: &Shapes, b: &Shapes| {
            POOLS[count - 1].install(|| run(a, b, OPS[op], WindingRule::EvenOdd).shapes)
        };
        let turned = |shapes: &Shapes| {
            let mut rings: Vec<Vec<DVec2>> = shapes.rings().map(<[DVec2]>::to_vec).collect();
            let count = rings.len().max(1);
            rings.rotate_left(turn % count);
            for ring in &mut rings {
                let count = ring.len();
                ring.rotate_left(turn % count);
            }
            Shapes::from_rings(rings)
        };
        let one = with(1, &a, &b);
        prop_assert_eq!(&with(2, &a, &b), &one);
        prop_assert_eq!(&with(2, &turned(&a), &turned(&b)), &one);
    }
}

/// Checks a ring that spans many patches and touches nothing, and one with holes that do not.
#[test]
fn long_rings_keep_their_points() {
    let circle = |n: usize, radius: f64| -> Vec<DVec2> {
        let at = |i: usize| {
            let angle = std::f64::consts::TAU * i as f64 / n as f64;
            DVec2::new(libm::cos(angle), libm::sin(angle)) * radius
        };
        (0..n).map(at).collect()
    };
    let rings = || [circle(500, 9.0), circle(400, 8.0), circle(300, 1.0)];
    let shapes = Shapes::from_rings(rings());
    let out = run(&shapes, &Shapes::new(), BooleanOp::Union, WindingRule::EvenOdd).shapes;
    assert_eq!((out.points().len(), out.ring_count(), out.polygon_count()), (1200, 3, 2));
    let out = run(&shapes, &Shapes::new(), BooleanOp::Union, WindingRule::NonZero).shapes;
    assert_eq!((out.points().len(), out.ring_count()), (500, 1));
}

/// Checks that coincident edges never separate, however often the plane is divided.
#[test]
fn many_copies_of_a_ring_are_one_ring() {
    let square = [(0.0, 0.0), (30.0, 0.0), (30.0, 30.0), (0.0, 30.0)];
    let slanted = [(0.0, 0.0), (29.0, 3.0), (26.0, 30.0), (-3.0, 27.0)];
    for (ring, count) in [(square, 26), (slanted, 26), (square, 400), (slanted, 400)] {
        let ring = ring.map(DVec2::from);
        let shapes = Shapes::from_rings(std::iter::repeat_n(ring, count));
        let out = run(&shapes, &Shapes::new(), BooleanOp::Union, WindingRule::NonZero).shapes;
        assert_eq!((out.points().len(), out.area()), (4, Shapes::from_rings([ring]).area()));
    }
}
