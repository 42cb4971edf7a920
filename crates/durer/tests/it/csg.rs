//! Solids combined along scan lines: the same as classifying a ray at each pixel.

use crate::raster_coverage::Random;
use durer::clip::polygon::BooleanOp;
use durer::math::{DVec2, DVec3};
use durer::target::NO_ITEM;
use durer::trace::{NoTrace, Recorder};
use durer::visibility::polygons::csg::{Expression, Step, Term, items, replay};
use durer::visibility::polygons::{Face, Screen};

const SIDE: u32 = 24;

fn screen() -> Screen {
    Screen { width: SIDE, height: SIDE, ..Screen::default() }
}

/// Returns a tetrahedron whose corners are on the grid of sub-pixels, so that rows cut it where it is.
fn tetrahedron(random: &mut Random) -> [DVec3; 4] {
    let on_grid = |v: f64| (v * 256.0).round() / 256.0;
    std::array::from_fn(|_| {
        let (p, z) = (random.point(-3.0, 27.0), random.point(1.0, 20.0).x);
        DVec3::new(on_grid(p.x), on_grid(p.y), z)
    })
}

const SIDES: [[usize; 3]; 4] = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];

fn faces(corners: &[DVec3; 4]) -> Vec<Face> {
    SIDES.map(|side| Face::new(&side.map(|k| corners[k])).expect("a triangle")).to_vec()
}

/// Returns the depths at which the ray of a pixel enters and leaves a tetrahedron, the intersection of the half-spaces
/// of its sides.
fn interval(corners: &[DVec3; 4], at: DVec2) -> Option<[f64; 2]> {
    let [mut enter, mut leave] = [f64::NEG_INFINITY, f64::INFINITY];
    for (side, opposite) in SIDES.iter().zip([3, 2, 1, 0]) {
        let [a, b, c] = side.map(|k| corners[k]);
        let normal = (b - a).cross(c - a);
        let normal = if normal.dot(corners[opposite] - a) < 0.0 { -normal } else { normal };
        // normal · (at + z·Z − a) ≥ 0
        let rest = normal.dot(at.extend(0.0) - a);
        let z = -rest / normal.z;
        if normal.z > 0.0 {
            enter = enter.max(z);
        } else if normal.z < 0.0 {
            leave = leave.min(z);
        } else if rest < 0.0 {
            return None;
        }
    }
    (enter < leave).then_some([enter, leave])
}

/// Returns the nearest depth at which the expression holds along a ray, and whether no layer there is too thin
/// for rounding.
fn classified(bodies: &[[DVec3; 4]], expression: &Expression, at: DVec2) -> (Option<f64>, bool) {
    let spans: Vec<_> = bodies.iter().map(|body| interval(body, at)).collect();
    let mut depths: Vec<f64> = spans.iter().flatten().flatten().copied().collect();
    depths.sort_by(f64::total_cmp);
    let clear = depths.windows(2).all(|pair| pair[1] - pair[0] > 1e-6);
    let holds = |z: f64| {
        let inside = |span: &Option<[f64; 2]>| span.is_some_and(|[near, far]| near < z && z < far);
        expression.holds(&spans.iter().map(inside).collect::<Vec<_>>())
    };
    let found = depths.windows(2).find(|pair| holds((pair[0] + pair[1]) / 2.0));
    (found.map(|pair| pair[0]), clear)
}

#[test]
fn spans_agree_with_rays() {
    let mut random = Random(77);
    let term = |op| Term::Op(op);
    let mut expressions: Vec<Expression> =
        BooleanOp::ALL.iter().map(|op| Expression::fold(*op, 3).unwrap()).collect();
    let [a, b, c] = [0, 1, 2].map(Term::Solid);
    // A − (B ∪ C), and (A ∪ B) − C.
    let [union, difference] = [term(BooleanOp::Union), term(BooleanOp::Difference)];
    expressions.push(Expression::new(&[a, b, c, union, difference]).unwrap());
    expressions.push(Expression::new(&[a, b, union, c, difference]).unwrap());
    let (mut seen, mut divided) = (0, 0);
    for round in 0..40 {
        let bodies: [[DVec3; 4]; 3] = std::array::from_fn(|_| tetrahedron(&mut random));
        let solids: Vec<Vec<Face>> = bodies.iter().map(faces).collect();
        let all: Vec<&Face> = solids.iter().flatten().collect();
        for expression in &expressions {
            let mut steps = Recorder::default();
            let found = items(&solids, expression, &screen(), &mut steps).unwrap();
            assert_eq!(replay(&screen(), steps.steps()).unwrap().data(), found.data());
            let divides = steps.steps().iter().filter(|s| matches!(s, Step::Divide { .. }));
            divided += divides.count();
            for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
                let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let (expected, clear) = classified(&bodies, expression, at);
                if !clear {
                    continue;
                }
                let item = found.get(x, y).unwrap();
                let depth = (item != NO_ITEM).then(|| all[item as usize].depth(at));
                let place = format!("round {round}, {x} {y}: {depth:?} {expected:?}");
                assert_eq!(depth.is_some(), expected.is_some(), "{place}");
                if let (Some(depth), Some(expected)) = (depth, expected) {
                    assert!((depth - expected).abs() < 1e-7 * (1.0 + expected.abs()), "{place}");
                    seen += 1;
                }
            }
        }
    }
    assert!(seen > 10_000 && divided > 100, "{seen} {divided}");
}

/// Checks two blocks with a common face plane: a subtraction up to the plane leaves nothing there.
#[test]
fn faces_at_one_depth_are_passed_together() {
    let block = |near: f64, far: f64| -> Vec<Face> {
        let square = |z: f64| {
            [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(|(x, y)| DVec3::new(x, y, z))
        };
        [near, far].map(|z| Face::new(&square(z)).unwrap()).to_vec()
    };
    let solids = [block(2.0, 6.0), block(2.0, 4.0), block(4.0, 6.0)];
    let screen = Screen { width: 4, height: 4, ..Screen::default() };
    let seen = |terms: &[Term]| {
        let expression = Expression::new(terms).unwrap();
        let items = items(&solids, &expression, &screen, &mut NoTrace).unwrap();
        assert!(items.data().iter().all(|item| item == &items.data()[0]));
        items.data()[0]
    };
    let [a, b, c] = [0, 1, 2].map(Term::Solid);
    let [union, and, minus] =
        [BooleanOp::Union, BooleanOp::Intersection, BooleanOp::Difference].map(Term::Op);
    // A − B begins at the back of B, which is the front of C.
    assert_eq!(seen(&[a, b, minus]), 3);
    assert_eq!(seen(&[a, b, minus, c, minus]), NO_ITEM);
    assert_eq!(seen(&[b, c, and]), NO_ITEM);
    assert_eq!(seen(&[b, c, union]), 2);
    assert_eq!(seen(&[a, b, and]), 0);
}

#[test]
fn expressions_are_checked() {
    let [a, op] = [Term::Solid(0), Term::Op(BooleanOp::Union)];
    for wrong in [&[][..], &[op], &[a, op], &[a, a], &[a, a, op, op]] {
        assert!(Expression::new(wrong).is_err(), "{wrong:?}");
    }
    assert!(Expression::fold(BooleanOp::Union, 0).is_err());
    // An absent solid is empty.
    let missing = Expression::new(&[Term::Solid(0), Term::Solid(9), op]).unwrap();
    assert!(missing.holds(&[true]) && !missing.holds(&[false]));
}
