//! Long rings, and redrawn cases of published bug reports.

use durer::clip::line::{LineClipper, Segment};
use durer::clip::polygon::overlay::{Options, overlay};
use durer::clip::polygon::vatti::vatti;
use durer::clip::polygon::{
    BooleanOp, PolygonClipper, Shapes, WindingRule, rectangle, signed_area,
};
use durer::math::{DVec2, Rect};
use durer::trace::NoTrace;
use proptest::prelude::*;

use super::{distance, validity};

fn area(a: &Shapes, b: &Shapes, op: BooleanOp) -> f64 {
    let out = overlay(a, b, op, &Options::default(), &mut NoTrace).expect("finite");
    validity::check(&out.shapes, out.cell).expect("valid");
    out.shapes.area()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Checks two slanted quads side by side whose common edge is rounded differently in each, by some ulps: neither
    /// half may vanish, and their intersection is empty (libgeos/geos#1344, iOverlay#19).
    #[test]
    fn neighbours_with_a_rounded_edge_are_joined(
        angle in -1.6..1.6f64, at in prop::array::uniform2(-400.0..400.0f64), size in prop::array::uniform3(0.5..40.0f64),
        off in prop::array::uniform4(-3i64..=3),
    ) {
        let (sin, cos) = libm::sincos(angle);
        let place = |x: f64, y: f64| DVec2::new(at[0] + cos * x - sin * y, at[1] + sin * x + cos * y);
        let nudged = |v: f64, by: i64| f64::from_bits((v.to_bits() as i64 + by) as u64);
        let (low, high) = (place(0.0, 0.0), place(0.0, size[2]));
        let again = [DVec2::new(nudged(low.x, off[0]), nudged(low.y, off[1])), DVec2::new(nudged(high.x, off[2]), nudged(high.y, off[3]))];
        let a = Shapes::from_rings([[low, high, place(-size[0], size[2]), place(-size[0], 0.0)]]);
        let b = Shapes::from_rings([[again[0], place(size[1], 0.0), place(size[1], size[2]), again[1]]]);
        let (whole, both) = ((size[0] + size[1]) * size[2], area(&a, &b, BooleanOp::Intersection));
        prop_assert!((area(&a, &b, BooleanOp::Union) - whole).abs() < 1e-4 && both < 1e-4);
        prop_assert!((area(&a, &b, BooleanOp::Difference) - size[0] * size[2]).abs() < 1e-4);
    }

    /// Checks that the result contains no corner of the window that the polygon does not cover
    /// (AngusJohnson/Clipper2#542, #1095): areas do not show it, distances do.
    #[test]
    fn rectangle_clips_have_no_stray_corner(
        ring in prop::collection::vec((-9i32..=9, -9i32..=9), 3), window in (-6i32..=2, -6i32..=2, 1i32..=8, 1i32..=8),
    ) {
        let ring: Vec<DVec2> = ring.iter().map(|&(x, y)| DVec2::new(x.into(), y.into())).collect();
        let triangle = Shapes::from_rings([&ring]);
        prop_assume!(triangle.area() != 0.0);
        let min = DVec2::new(window.0.into(), window.1.into());
        let window = Rect::new(min, min + DVec2::new(window.2.into(), window.3.into())).expect("a window");
        let clipped = rectangle::clip(&window, &triangle, &rectangle::Options, &mut NoTrace).expect("finite");
        let (a, b) = (window.min(), window.max());
        let mask = Shapes::from_rings([[a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y)]]);
        let options = Options::default();
        let apart = distance::both_ways([&triangle, &mask], BooleanOp::Intersection, &options, &clipped, 1e-9);
        prop_assert!(apart.iter().all(|d| *d < 1e-7), "{:?} {:?}", apart, clipped);
    }
}

fn whole((x, y): (i32, i32)) -> DVec2 {
    DVec2::new(x.into(), y.into())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Checks that triangles with hardly any area, beside and across others, add hardly any to a union
    /// (AngusJohnson/Clipper2#1067).
    #[test]
    fn slivers_add_no_more_than_their_area(
        corners in prop::array::uniform6((-40_000_000..=40_000_000i32, -40_000_000..=40_000_000i32)),
        slivers in prop::collection::vec((0..6usize, 1..6usize, 0.0..1.0f64, -2..=2i32, -2..=2i32), 1..4),
    ) {
        let corner = |i: usize| whole(corners[i % 6]);
        // All have one direction: in a region wound in both, winding numbers may cancel.
        let triangle = |mut ring: [DVec2; 3]| {
            if signed_area(&ring) < 0.0 {
                ring.reverse();
            }
            ring
        };
        let a = Shapes::from_rings([triangle([corner(0), corner(1), corner(2)])]);
        let b = Shapes::from_rings([triangle([corner(3), corner(4), corner(5)])]);
        let mut with = b.clone();
        for &(i, by, t, x, y) in &slivers {
            let (p, q) = (corner(i), corner(i + by));
            with.push_ring(triangle([p, (p + (q - p) * t).round() + whole((x, y)), q]));
            with.end_polygon();
        }
        let area = |clip: &Shapes| {
            let options = Options::with_rule(WindingRule::NonZero);
            let out = overlay(&a, clip, BooleanOp::Union, &options, &mut NoTrace).expect("finite");
            validity::check(&out.shapes, out.cell).expect("valid");
            out.shapes.area()
        };
        let added = area(&with) - area(&b);
        let length: f64 = distance::edges(&a).iter().chain(&distance::edges(&with)).map(|(p, q)| p.distance(*q)).sum();
        let most: f64 = with.rings().skip(1).map(|r| signed_area(r).abs()).sum();
        // Crossings move by less than a tenth: the cells are an eighth wide.
        prop_assert!(added >= -0.1 * length && added <= most + 0.1 * length, "{added} {most}");
    }

    /// Checks that a strip a few units wide along a bent line, whose two sides touch and cross after rounding, gives
    /// simple rings (AngusJohnson/Clipper2#1083).
    #[test]
    fn narrow_strips_give_simple_rings(
        steps in prop::collection::vec((-900..=900i32, 200..=1500i32), 4..30),
        off in prop::collection::vec((-2..=2i32, -1..=1i32), 30),
    ) {
        let mut at = DVec2::ZERO;
        let line: Vec<DVec2> = steps.iter().map(|&s| { at += whole(s); at }).collect();
        let back = line.iter().zip(&off).rev().map(|(&p, &o)| p + whole(o));
        // Midpoints of the way back, rounded, are beside the way out.
        let back: Vec<DVec2> = back.collect();
        let halves = back.windows(2).flat_map(|w| [w[0], ((w[0] + w[1]) * 0.5).round()]);
        let strip = Shapes::from_rings([line.iter().copied().chain(halves).collect::<Vec<_>>()]);
        let none = Shapes::new();
        let alone = area(&strip, &none, BooleanOp::Union);
        prop_assert!((area(&strip, &strip, BooleanOp::Union) - alone).abs() < 1e-6 * alone.max(1.0));
    }
}

/// Checks that a window with swapped borders is refused, and that NaN is not accepted (ratatui/ratatui#2722).
#[test]
fn reversed_windows_and_nan_end_at_once() {
    assert!(Rect::new(DVec2::ONE, DVec2::ZERO).is_err());
    let window = Rect::new(DVec2::ZERO, DVec2::ONE).expect("a window");
    for &clipper in LineClipper::ALL {
        let segment = Segment::new(DVec2::splat(f64::NAN), DVec2::ONE);
        assert!(clipper.clip(&window, segment).is_err());
    }
}

/// Returns a ring of n vertices that alternates between two radii, with integer noise.
fn coast(n: usize, seed: u64, center: DVec2) -> Shapes {
    let mut state = seed;
    let mut noise = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1u32 << 24)
    };
    let point = |i: usize| {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / n as f64);
        center + DVec2::new(cos, sin) * (1e6 + 300.0 * noise())
    };
    Shapes::from_rings([(0..n).map(point).collect::<Vec<_>>()])
}

#[test]
fn rings_of_a_hundred_thousand_vertices() {
    let (a, b) = (coast(100_000, 1, DVec2::ZERO), coast(100_000, 2, DVec2::new(40.0, -30.0)));
    let area = |op| {
        let options = Options::default();
        overlay(&a, &b, op, &options, &mut NoTrace).expect("finite").shapes.area()
    };
    let [and, or, sub] =
        [BooleanOp::Intersection, BooleanOp::Union, BooleanOp::Difference].map(area);
    let within = 1e-9 * or;
    assert!(
        (and + or - a.area() - b.area()).abs() < within && (and + sub - a.area()).abs() < within
    );
    // In a window that cuts it thousands of times, three algorithms give one area.
    let (low, high) = (DVec2::new(-1e6, -1e6 - 150.0), DVec2::new(1e6 + 150.0, 1e6));
    let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
    let window = Shapes::from_rings([corners]);
    let clipped = |clipper: PolygonClipper| {
        clipper.clip(&a, &window, BooleanOp::Intersection).expect("a window").area()
    };
    let expected = clipped(PolygonClipper::Rectangle);
    for clipper in [PolygonClipper::SutherlandHodgman, PolygonClipper::Overlay] {
        assert!((clipped(clipper) - expected).abs() < 1e-9 * expected, "{clipper}");
    }
}

/// Checks a lattice of holes: straight below the first point of a hole there are only further such points.
#[test]
fn holes_in_columns_find_what_is_below_all_of_them() {
    let square = |x: f64, y: f64, side: f64| {
        [(x, y), (x + side, y), (x + side, y + side), (x, y + side)].map(DVec2::from)
    };
    let places = (0..144).map(|i| (f64::from(i % 12), f64::from(i / 12)));
    // Around the upper left quarter there is another ring, and every other row steps to the left.
    let mut rings = vec![square(-9.0, -9.0, 40.0), square(-5.0, 14.0, 12.0)];
    rings.extend(places.clone().map(|(x, y)| square(4.0 * x - 4.0 + y % 2.0, 4.0 * y - 6.0, 2.0)));
    let shapes = Shapes::from_rings(rings);
    let none = Shapes::new();
    for rule in [WindingRule::EvenOdd, WindingRule::Positive, WindingRule::AbsGeqTwo] {
        let swept =
            vatti(&shapes, &none, BooleanOp::Union, &Options::with_rule(rule), &mut NoTrace);
        let options = Options::with_rule(rule);
        let found = overlay(&shapes, &none, BooleanOp::Union, &options, &mut NoTrace)
            .expect("finite")
            .shapes;
        assert_eq!(found, swept.expect("finite").shapes, "{rule}");
    }
}
