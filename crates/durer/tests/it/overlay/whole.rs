//! `overlay()` on integers.

use durer::Error;
use durer::clip::polygon::Operand;
use durer::clip::polygon::overlay::{self, Options, Origin, Output, overlay};
use durer::clip::polygon::vatti::vatti;
use durer::clip::polygon::{BooleanOp, Shapes};
use durer::math::{DVec2, I64Vec2};
use durer::trace::{NoTrace, Recorder};
use proptest::prelude::*;

use super::laws::{op, rule};

pub fn soup(rings: usize, size: usize, grid: i64) -> impl Strategy<Value = Shapes<I64Vec2>> {
    let point = (0..=grid, 0..=grid).prop_map(|(x, y)| I64Vec2::new(x, y));
    let ring = prop::collection::vec(point, 0..size);
    prop::collection::vec(ring, 0..rings).prop_map(Shapes::from_rings)
}

fn run(
    a: &Shapes<I64Vec2>,
    b: &Shapes<I64Vec2>,
    op: BooleanOp,
    options: &Options,
) -> Output<I64Vec2> {
    overlay(a, b, op, options, &mut NoTrace).expect("within the range")
}

fn moved(shapes: &Shapes<I64Vec2>, f: impl Fn(I64Vec2) -> I64Vec2) -> Shapes<I64Vec2> {
    let mut shapes = shapes.clone();
    shapes.points_mut().iter_mut().for_each(|p| *p = f(*p));
    shapes
}

fn floats(shapes: &Shapes<I64Vec2>) -> Shapes {
    let mut out = Shapes::new();
    for polygon in shapes.polygons() {
        for ring in polygon.rings() {
            out.push_ring(ring.iter().map(|p| p.as_dvec2()));
        }
        out.end_polygon();
    }
    out
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn whole_numbers_give_what_floats_on_their_grid_give(
        a in soup(4, 7, 40), b in soup(4, 7, 40), op in op(), rule in rule(),
    ) {
        let options = Options { origins: true, ..Options::with_rule(rule) };
        let whole = run(&a, &b, op, &options);
        let grid = Options { grid: Some(1.0), ..options.clone() };
        let float = overlay(&floats(&a), &floats(&b), op, &grid, &mut NoTrace).expect("finite");
        prop_assert_eq!(&floats(&whole.shapes), &float.shapes);
        prop_assert_eq!((&whole.origins, whole.cell), (&float.origins, float.cell));
        let swept = vatti(&a, &b, op, &options, &mut NoTrace).expect("within the range");
        prop_assert_eq!(&swept.shapes, &whole.shapes);
    }

    #[test]
    fn results_move_with_their_input_to_the_ends_of_the_range(
        a in soup(4, 7, 90), b in soup(4, 7, 90), op in op(), rule in rule(),
        x in prop::sample::select(vec![i64::MIN, (1 << 53) + 1, 1 << 62, i64::MAX - 90]),
        y in prop::sample::select(vec![i64::MIN, -(1 << 53) - 1, i64::MAX - 90]),
    ) {
        let by = I64Vec2::new(x, y);
        let options = Options::with_rule(rule);
        let out = run(&moved(&a, |p| p + by), &moved(&b, |p| p + by), op, &options);
        prop_assert_eq!(moved(&out.shapes, |p| p - by), run(&a, &b, op, &options).shapes);
    }

    #[test]
    fn steps_rebuild_what_whole_numbers_give(a in soup(3, 7, 20), b in soup(3, 7, 20), op in op()) {
        let mut recorder = Recorder::default();
        let options = Options::default();
        let traced = overlay(&a, &b, op, &options, &mut recorder).expect("within the range");
        prop_assert_eq!(&traced.shapes, &run(&a, &b, op, &options).shapes);
        prop_assert_eq!(&overlay::replay(recorder.steps()), &traced.shapes);
    }
}

/// Checks an extent of 2⁴¹ − 2, more than the 32-bit path supports, and odd numbers beyond 2⁵³.
#[test]
fn the_widest_input_is_exact() {
    let wide = (1 << 41) - 2;
    let corner = I64Vec2::new(i64::MAX - wide, i64::MIN);
    let at = |x, y| corner + I64Vec2::new(x, y);
    let square = [at(0, 0), at(wide, 0), at(wide, wide), at(0, wide)];
    // A needle from corner to corner, one unit wide, and a bar with odd coordinates across it.
    let needle = [at(0, 0), at(wide, wide - 1), at(wide, wide)];
    let bar = [at(1001, 0), at(1003, 0), at(1003, wide), at(1001, wide)];
    let options = Options { origins: true, ..Options::default() };
    let (square, needle) = (Shapes::from_rings([square]), Shapes::from_rings([needle]));
    let inside = run(&square, &needle, BooleanOp::Intersection, &options);
    assert_eq!(inside.shapes, needle, "nothing is snapped");
    assert_eq!(inside.origins[0], Origin::Vertex { operand: Operand::Subject, index: 0 });
    let bar = Shapes::from_rings([bar]);
    let rest = run(&square, &bar, BooleanOp::Difference, &options);
    assert_eq!(rest.shapes.ring(0), [at(0, 0), at(1001, 0), at(1001, wide), at(0, wide)]);
    assert_eq!(rest.shapes.ring(1), [at(1003, 0), at(wide, 0), at(wide, wide), at(1003, wide)]);
}

#[test]
fn what_whole_numbers_cannot_have_is_refused() {
    let ends = [0, (1 << 41) - 1].map(|x| I64Vec2::new(x, 0));
    let all = [i64::MIN, i64::MAX].map(I64Vec2::splat);
    let try_on = |ring: [I64Vec2; 2], options: Options| {
        let shapes = Shapes::from_rings([ring]);
        overlay(&shapes, &Shapes::new(), BooleanOp::Union, &options, &mut NoTrace)
    };
    for (ring, value) in [(ends, (1 << 41) - 1), (all, u64::MAX)] {
        let expected = Error::Limit { what: "number of cells across", value, limit: (1 << 41) - 2 };
        assert_eq!(try_on(ring, Options::default()), Err(expected));
    }
    let coarse = Options { grid: Some(2.0), ..Options::default() };
    assert!(matches!(try_on([I64Vec2::ZERO; 2], coarse), Err(Error::Parameter { .. })));
    let own = Options { grid: Some(1.0), ..Options::default() };
    assert!(try_on([I64Vec2::ZERO; 2], own).is_ok());
    // In f64 alone these two coincide.
    let (p, q) = (I64Vec2::new((1 << 53) + 1, 0), I64Vec2::new(1 << 53, 0));
    assert_eq!((p.as_dvec2(), p == q), (DVec2::new(q.x as f64, 0.0), false));
}
