//! The textbook algorithms on valid polygons whose rings touch one another and the other's borders often, because their
//! coordinates are small integers.

use durer::clip::polygon::greiner_hormann::greiner_hormann;
use durer::clip::polygon::overlay::{Options, overlay};
use durer::clip::polygon::weiler_atherton::weiler_atherton;
use durer::clip::polygon::{BooleanOp, PolygonClipper, Shapes, signed_area};
use durer::math::{DVec2, Orientation, orient2d};
use durer::trace::NoTrace;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::laws::soup;
use super::validity;

/// From this number to the next power of two, crossings are exact multiples of a small number.
const OFFSET: f64 = 64.0;

/// The spacing of numbers from 64 to 128.
const STEP: f64 = 1.0 / (1u64 << 46) as f64;

/// Returns valid polygons with integer coordinates: the overlay of random rings on its coarsest grid, without the
/// vertices on straight borders, so that other rings touch edges too.
fn polygons(grid: i32) -> impl Strategy<Value = Shapes> {
    (soup(4, 8, grid), any::<bool>()).prop_map(|(rings, reversed)| {
        let options = Options { grid: Some(1.0), ..Options::default() };
        let valid = overlay(&rings, &Shapes::new(), BooleanOp::Union, &options, &mut NoTrace);
        let valid = valid.expect("finite").shapes;
        let mut shapes = Shapes::new();
        for polygon in valid.polygons() {
            for ring in polygon.rings() {
                let mut corners = corners(ring);
                if reversed {
                    corners.reverse();
                }
                shapes.push_ring(corners);
            }
            shapes.end_polygon();
        }
        shapes
    })
}

fn corners(ring: &[DVec2]) -> Vec<DVec2> {
    let at = |i: usize| ring[i % ring.len()];
    let turns =
        |&i: &usize| orient2d(at(i + ring.len() - 1), at(i), at(i + 1)) != Orientation::Collinear;
    (0..ring.len()).filter(turns).map(|i| at(i) + DVec2::splat(OFFSET)).collect()
}

fn window(x: (i32, i32), y: (i32, i32)) -> Shapes {
    let at = |x: i32, y: i32| DVec2::new(f64::from(x), f64::from(y)) + DVec2::splat(OFFSET);
    let (right, top) = (x.0 + x.1, y.0 + y.1);
    Shapes::from_rings([[at(x.0, y.0), at(right, y.0), at(right, top), at(x.0, top)]])
}

/// Checks that a result is valid and the region that the overlay finds.
fn agrees(
    clipper: PolygonClipper,
    [a, b]: [&Shapes; 2],
    op: BooleanOp,
    expected: &Shapes,
) -> Result<(), TestCaseError> {
    let found = clipper.clip(a, b, op);
    let found = found.map_err(|e| TestCaseError::fail(format!("{clipper} {op}: {e}")))?;
    let valid = validity::check(&found, STEP);
    prop_assert!(valid.is_ok(), "{clipper} {op}: {valid:?} {found:?}");
    let apart = overlay(&found, expected, BooleanOp::Xor, &Options::default(), &mut NoTrace);
    let apart = apart.expect("finite").shapes.area();
    prop_assert!(apart < 1e-6, "{clipper} {op}: {apart} {found:?}");
    Ok(())
}

fn walks_agree(a: &Shapes, b: &Shapes) -> Result<(), TestCaseError> {
    for &op in BooleanOp::ALL {
        let expected = PolygonClipper::Overlay.clip(a, b, op).expect("finite");
        for clipper in [PolygonClipper::WeilerAtherton, PolygonClipper::GreinerHormann] {
            agrees(clipper, [a, b], op, &expected)?;
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10_000, failure_persistence: None, rng_seed: RngSeed::Fixed(0), ..ProptestConfig::default() })]

    #[test]
    fn walks_take_polygons_whose_rings_touch(a in polygons(7), b in polygons(7)) {
        walks_agree(&a, &b)?;
    }

    #[test]
    fn walks_take_windows_on_such_polygons(
        a in polygons(10), x in (0..=8, 1..=9), y in (0..=8, 1..=9),
    ) {
        walks_agree(&a, &window(x, y))?;
        walks_agree(&window(x, y), &a)?;
    }

    /// Checks polygons off the lattice: borders that touched now pass an ulp apart, and crossings are rounded to
    /// vertices. If then rings of one operand cross, they are refused.
    #[test]
    fn walks_find_the_region_of_rounded_coordinates(
        a in polygons(5), b in polygons(5), scale in 0..4usize, offset in 0..3usize,
    ) {
        let scale = [1.0 / 3.0, 0.1, 1e-7, 1e6 / 3.0][scale];
        let offset = [-OFFSET, 0.3 - OFFSET, 4115.226][offset];
        let [a, b] = [a, b].map(|mut shapes| {
            shapes.points_mut().iter_mut().for_each(|p| *p = (*p + DVec2::splat(offset)) * scale);
            shapes
        });
        for &op in BooleanOp::ALL {
            let expected = PolygonClipper::Overlay.clip(&a, &b, op).expect("finite");
            for clipper in [PolygonClipper::WeilerAtherton, PolygonClipper::GreinerHormann] {
                let Ok(found) = clipper.clip(&a, &b, op) else { continue };
                let options = Options::default();
                let apart = overlay(&found, &expected, BooleanOp::Xor, &options, &mut NoTrace);
                let apart = apart.expect("finite").shapes.area() / (scale * scale);
                prop_assert!(apart < 1e-6, "{} {}: {} {:?}", clipper, op, apart, found);
            }
        }
    }

    /// Checks that a result has no ring without an area and no hole without its outer ring; bridges are allowed.
    #[test]
    fn convex_clips_leave_no_flat_rings(
        a in polygons(10), x in (0..=8, 1..=9), y in (0..=8, 1..=9), triangle: bool,
    ) {
        let mut mask = window(x, y);
        if triangle {
            mask = Shapes::from_rings([&mask.ring(0)[..3]]);
        }
        let clipper = PolygonClipper::SutherlandHodgman;
        let found = clipper.clip(&a, &mask, BooleanOp::Intersection).expect("convex");
        let expected = PolygonClipper::Overlay.clip(&a, &mask, BooleanOp::Intersection).expect("finite");
        prop_assert!(found.rings().all(|ring| signed_area(ring).abs() > 1e-9), "{found:?}");
        prop_assert!((found.area().abs() - expected.area()).abs() < 1e-6, "{found:?}");
    }
}

#[test]
fn a_hole_that_touches_its_shell_on_the_masks_border() {
    let ring = |points: &[(f64, f64)]| points.iter().map(|&p| DVec2::from(p)).collect::<Vec<_>>();
    let mut shapes = Shapes::new();
    shapes.push_ring(ring(&[
        (13., 5.),
        (10., 7.),
        (9., 11.),
        (6., 9.),
        (3., 8.),
        (2., 5.),
        (2., 2.),
        (6., 0.),
        (9., -1.),
        (12., 2.),
    ]));
    shapes.push_ring(ring(&[(8., 8.), (6., 9.), (6., 7.)]));
    shapes.end_polygon();
    let mask = Shapes::from_rings([ring(&[(5., 1.), (6., 1.), (6., 9.), (5., 9.)])]);
    for clipper in [PolygonClipper::WeilerAtherton, PolygonClipper::GreinerHormann] {
        let rest = clipper.clip(&shapes, &mask, BooleanOp::Difference).expect("valid");
        assert!((rest.area() - 71.0 - 2.0 / 3.0).abs() < 1e-9, "{clipper}: {}", rest.area());
        assert_eq!((rest.polygon_count(), rest.ring_count()), (1, 1), "{clipper}");
    }
}

#[test]
fn polygons_that_are_not_valid_are_refused() {
    let ring = |points: &[(f64, f64)]| points.iter().map(|&p| DVec2::from(p)).collect::<Vec<_>>();
    let square = ring(&[(0., 0.), (4., 0.), (4., 4.), (0., 4.)]);
    let mask = Shapes::from_rings([&square]);
    for rings in [
        vec![ring(&[(0., 0.), (4., 4.), (4., 0.), (0., 4.)])],
        vec![square.clone(), square.clone()],
        vec![square.clone(), ring(&[(4., 1.), (6., 1.), (6., 3.), (4., 3.)])],
        vec![square.clone(), ring(&[(2., 2.), (6., 2.), (6., 6.), (2., 6.)])],
        vec![
            square.clone(),
            ring(&[(-2., 2.), (0., 0.), (2., 2.)]),
            ring(&[(0., 4.), (2., 2.), (4., 4.), (3., 9.)]),
        ],
        vec![ring(&[(0., 0.), (4., 0.), (7., 0.), (4., 0.), (4., 4.)])],
    ] {
        let shapes = Shapes::from_rings(&rings);
        for clipper in [PolygonClipper::WeilerAtherton, PolygonClipper::GreinerHormann] {
            for &op in BooleanOp::ALL {
                assert!(clipper.clip(&shapes, &mask, op).is_err(), "{clipper} {op} {rings:?}");
                assert!(clipper.clip(&mask, &shapes, op).is_err(), "{clipper} {op} {rings:?}");
            }
        }
    }
}

#[test]
fn points_that_are_not_finite_are_refused() {
    let bad = [(0., 0.), (4., f64::NAN), (f64::INFINITY, 4.), (1., 9.)].map(DVec2::from);
    let (bad, none) = (Shapes::from_rings([bad]), Shapes::new());
    for (a, b, index) in [(&bad, &none, 1), (&none, &bad, 1)] {
        let expected = Err(durer::Error::NonFinite { what: "point", index });
        let options = Default::default();
        assert_eq!(weiler_atherton(a, b, BooleanOp::Union, &options, &mut NoTrace), expected);
        assert_eq!(
            greiner_hormann(a, b, BooleanOp::Union, &Default::default(), &mut NoTrace),
            expected
        );
    }
}
