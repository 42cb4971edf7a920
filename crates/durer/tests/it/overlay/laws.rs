//! Laws that hold for every input, on deliberately hard inputs.

use durer::clip::polygon::Operand;
use durer::clip::polygon::overlay::{self, Options, Output, overlay};
use durer::clip::polygon::{BooleanOp, Shapes, WindingRule};
use durer::math::DVec2;
use durer::trace::{NoTrace, Recorder};
use proptest::prelude::*;

use super::validity;

fn run(a: &Shapes, b: &Shapes, op: BooleanOp, options: &Options) -> Output {
    overlay(a, b, op, options, &mut NoTrace).expect("finite input")
}

fn valid(out: &Output) -> Result<(), TestCaseError> {
    validity::check(&out.shapes, out.cell).map_err(TestCaseError::fail)
}

/// Returns a bound on the change of an area by snapping: every edge sweeps at most its length times a cell's diagonal,
/// and an edge of the input is at most as long as the extent's diagonal.
fn bound(a: &Shapes, b: &Shapes, cell: f64) -> f64 {
    let length = |s: &Shapes| -> f64 {
        let around =
            |r: &[DVec2]| (0..r.len()).map(|i| r[i].distance(r[(i + 1) % r.len()])).sum::<f64>();
        s.rings().map(around).sum()
    };
    2.0 * cell * (length(a) + length(b) + cell)
}

fn ring(size: usize, grid: i32) -> impl Strategy<Value = Vec<DVec2>> {
    let point = (0..=grid, 0..=grid).prop_map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)));
    prop::collection::vec(point, 0..size)
}

pub fn soup(rings: usize, size: usize, grid: i32) -> impl Strategy<Value = Shapes> {
    prop::collection::vec(ring(size, grid), 0..rings).prop_map(Shapes::from_rings)
}

pub fn rule() -> impl Strategy<Value = WindingRule> {
    prop::sample::select(WindingRule::ALL)
}

pub fn op() -> impl Strategy<Value = BooleanOp> {
    prop::sample::select(BooleanOp::ALL)
}

fn moved(shapes: &Shapes, f: impl Fn(DVec2) -> DVec2) -> Shapes {
    let mut shapes = shapes.clone();
    for p in shapes.points_mut() {
        *p = f(*p);
    }
    shapes
}

/// Returns a star of long spikes: every second point far out, the others close in.
fn star(n: usize, turn: f64, x: f64) -> Shapes {
    let point = |i: usize| {
        let t = (i as f64 + turn) / n as f64;
        let r = if i.is_multiple_of(2) { 1.0 + (i % 7) as f64 * 0.01 } else { 0.2 };
        // The border of a square replaces a circle: no sine is needed.
        let s = 4.0 * t.rem_euclid(1.0);
        let (side, along) = (s.floor() as i32, s.fract() * 2.0 - 1.0);
        let p = match side {
            0 => DVec2::new(1.0, along),
            1 => DVec2::new(-along, 1.0),
            2 => DVec2::new(-1.0, -along),
            _ => DVec2::new(along, -1.0),
        };
        p * r + DVec2::new(x, 0.0)
    };
    Shapes::from_rings([(0..n).map(point).collect::<Vec<_>>()])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn results_on_a_tiny_grid_are_valid(
        a in soup(4, 7, 6), b in soup(4, 7, 6), op in op(), rule in rule(), coarse: bool,
    ) {
        // With cells as large as the spacing of the points, everything snaps to everything.
        let grid = coarse.then_some(1.0);
        let out = run(&a, &b, op, &Options { grid, ..Options::with_rule(rule) });
        valid(&out)?;
    }

    #[test]
    fn areas_add_up(a in soup(3, 7, 8), b in soup(3, 7, 8), rule in rule()) {
        let options = Options::with_rule(rule);
        let [and, or, sub, xor] =
            [BooleanOp::Intersection, BooleanOp::Union, BooleanOp::Difference, BooleanOp::Xor]
                .map(|op| run(&a, &b, op, &options));
        let none = Shapes::new();
        let alone = |s: &Shapes| run(s, &none, BooleanOp::Union, &options).shapes.area();
        let within = bound(&a, &b, and.cell);
        let [and, or, sub, xor] = [and, or, sub, xor].map(|o| o.shapes.area());
        prop_assert!((and + or - alone(&a) - alone(&b)).abs() <= 4.0 * within);
        prop_assert!((sub + and - alone(&a)).abs() <= 4.0 * within);
        prop_assert!((xor + and - or).abs() <= 4.0 * within);
    }

    #[test]
    fn twice_is_once(a in soup(3, 7, 8), rule in rule()) {
        let none = Shapes::new();
        let options = Options { grid: Some(1.0 / 1024.0), ..Options::with_rule(rule) };
        let once = run(&a, &none, BooleanOp::Union, &options);
        let again = Options::with_rule(WindingRule::NonZero);
        let options = Options { grid: options.grid, ..again };
        let twice = run(&once.shapes, &none, BooleanOp::Union, &options);
        prop_assert_eq!(&once.shapes, &twice.shapes);
        let minus = run(&a, &a, BooleanOp::Difference, &Options::with_rule(rule));
        prop_assert!(minus.shapes.is_empty());
    }

    #[test]
    fn order_and_starts_do_not_matter(
        a in soup(3, 7, 8), b in soup(3, 7, 8), rule in rule(), op in op(), turn in 0usize..7,
    ) {
        let options = Options::with_rule(rule);
        let out = run(&a, &b, op, &options).shapes;
        let turned = |s: &Shapes| {
            let mut rings: Vec<Vec<DVec2>> = s.rings().map(<[DVec2]>::to_vec).collect();
            rings.reverse();
            for r in rings.iter_mut().filter(|r| !r.is_empty()) {
                let by = turn % r.len();
                r.rotate_left(by);
            }
            Shapes::from_rings(rings)
        };
        prop_assert_eq!(&out, &run(&turned(&a), &turned(&b), op, &options).shapes);
        if op != BooleanOp::Difference {
            prop_assert_eq!(&out, &run(&b, &a, op, &options).shapes);
        }
    }

    #[test]
    fn mirrors_and_scales_keep_the_area(
        a in soup(3, 7, 8), b in soup(3, 7, 8), op in op(), exponent in -9i32..=12,
    ) {
        let options = Options::default();
        let out = run(&a, &b, op, &options);
        let within = 4.0 * bound(&a, &b, out.cell);
        let mirror = |s: &Shapes| moved(s, |p| DVec2::new(-p.x, p.y));
        let mirrored = run(&mirror(&a), &mirror(&b), op, &options);
        valid(&mirrored)?;
        prop_assert!((out.shapes.area() - mirrored.shapes.area()).abs() <= within);
        let scale = 10f64.powi(exponent);
        let scaled = run(&moved(&a, |p| p * scale), &moved(&b, |p| p * scale), op, &options);
        valid(&scaled)?;
        prop_assert!((out.shapes.area() - scaled.shapes.area() / scale / scale).abs() <= 4.0 * within);
    }

    #[test]
    fn fine_grids_agree_with_coarse_ones(a in soup(3, 7, 8), b in soup(3, 7, 8), op in op()) {
        let narrow = run(&a, &b, op, &Options::default());
        let fine = Options { grid: Some(2f64.powi(-36)), ..Options::default() };
        let wide = run(&a, &b, op, &fine);
        valid(&wide)?;
        let within = 4.0 * bound(&a, &b, narrow.cell);
        prop_assert!((narrow.shapes.area() - wide.shapes.area()).abs() <= within);
        let steps = &mut Recorder::default();
        let traced = overlay(&a, &b, op, &fine, steps).expect("finite");
        prop_assert_eq!(&traced, &wide);
        prop_assert_eq!(overlay::replay(steps.steps()), wide.shapes);
    }

    #[test]
    fn origins_tell_where_vertices_come_from(a in soup(3, 7, 8), b in soup(3, 7, 8), op in op()) {
        let out = run(&a, &b, op, &Options { origins: true, ..Options::default() });
        let point = |operand: Operand, i: usize| match operand {
            Operand::Subject => a.points()[i],
            Operand::Clip => b.points()[i],
        };
        // The points themselves are attributes too: interpolated, they equal the result's points.
        let points = out.attributes(point, |p, q, t| p.lerp(q, t), |p, q| {
            assert!(p.distance(q) <= out.cell * 1e-3 + 1e-12, "{p} {q}");
            p
        });
        prop_assert_eq!(points.len(), out.shapes.points().len());
        for (p, q) in points.iter().zip(out.shapes.points()) {
            prop_assert!((*p - *q).abs().max_element() <= out.cell * 0.5001);
        }
    }
}

#[test]
fn stars_take_the_strips_and_stay_valid() {
    for (n, x) in [(300, 0.0), (300, 0.001), (120, 0.4)] {
        let (a, b) = (star(n, 0.0, 0.0), star(n, 0.5, x));
        let options = Options::with_rule(WindingRule::NonZero);
        let areas = BooleanOp::ALL.iter().map(|&op| {
            let out = run(&a, &b, op, &options);
            validity::check(&out.shapes, out.cell).expect("valid");
            out.shapes.area()
        });
        let areas: Vec<f64> = areas.collect();
        assert!((areas[0] + areas[3] - areas[1]).abs() < 1e-6, "{areas:?}");
    }
}

#[test]
fn threads_change_nothing() {
    let cell = |i: usize| DVec2::new((i * 7919 % 4093) as f64, (i * 104_729 % 4099) as f64);
    let ring = |i: usize| {
        let size = 5.0 + (i % 13) as f64 * 2.0;
        [(0.0, 0.0), (1.0, 0.3), (0.7, 1.0), (0.1, 0.6)]
            .map(|(x, y)| cell(i) + DVec2::new(x, y) * size)
    };
    let many = Shapes::from_rings((0..40_000).map(ring));
    let options = Options { origins: true, ..Options::with_rule(WindingRule::NonZero) };
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("pool");
        pool.install(|| run(&many, &star(2_000, 0.0, 0.0), BooleanOp::Union, &options))
    };
    let (one, two) = (with(1), with(2));
    assert!(one.shapes.ring_count() > 1_000);
    assert_eq!(one, two);
}

#[test]
fn coarse_cells_bend_edges_to_their_centres() {
    // A thin spike passes 0.4 cells above a vertex: it must be bent through that vertex's cell.
    let p = |x: f64, y: f64| DVec2::new(x, y);
    let spike = Shapes::from_rings([[p(0.0, 0.0), p(10.0, 1.0), p(0.0, 5.0)]]);
    let tooth = Shapes::from_rings([[p(5.0, 0.0), p(6.0, -3.0), p(4.0, -3.0)]]);
    let options = Options { grid: Some(1.0), ..Options::with_rule(WindingRule::NonZero) };
    let out = run(&spike, &tooth, BooleanOp::Union, &options);
    validity::check(&out.shapes, out.cell).expect("valid");
    assert_eq!(out.shapes.polygon_count(), 2);
}

#[test]
fn errors_are_typed() {
    let bad = Shapes::from_rings([[DVec2::ZERO, DVec2::new(f64::NAN, 0.0), DVec2::ONE]]);
    let good = Shapes::from_rings([[DVec2::ZERO, DVec2::X, DVec2::ONE]]);
    let run = |s: &Shapes, grid| {
        let options = Options { grid, ..Options::default() };
        overlay(s, &good, BooleanOp::Union, &options, &mut NoTrace)
    };
    assert!(matches!(run(&bad, None), Err(durer::Error::NonFinite { index: 1, .. })));
    for grid in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-30] {
        assert!(matches!(run(&good, Some(grid)), Err(durer::Error::Parameter { .. })), "{grid}");
    }
    let far = moved(&good, |p| p * 1e299);
    let out = overlay(&far, &Shapes::new(), BooleanOp::Union, &Options::default(), &mut NoTrace);
    assert_eq!(out.expect("in range").shapes.points().len(), 3);
    let beyond = moved(&good, |p| p * 1e301);
    assert!(run(&beyond, None).is_err());
}
