//! The rectangle clip, compared with areas of Sutherland–Hodgman, and its own laws.

use super::*;
use crate::clip::attribute::interpolate;
use crate::clip::polygon::{signed_area, sutherland_hodgman};
use crate::trace::{NoTrace, Recorder};
use proptest::prelude::*;

fn p(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

fn window(x0: f64, y0: f64, x1: f64, y1: f64) -> Rect {
    Rect::new(p(x0, y0), p(x1, y1)).unwrap()
}

fn polygon(rings: &[&[(f64, f64)]]) -> Shapes {
    let mut shapes = Shapes::new();
    for ring in rings {
        shapes.push_ring(ring.iter().map(|&(x, y)| p(x, y)));
    }
    shapes.end_polygon();
    shapes
}

fn clipped(w: &Rect, shapes: &Shapes) -> Vec<Vec<Vec<(f64, f64)>>> {
    let out = clip(w, shapes, &Options, &mut NoTrace).unwrap();
    let ring = |r: &[DVec2]| r.iter().map(|p| (p.x, p.y)).collect::<Vec<_>>();
    out.polygons().map(|p| p.rings().map(ring).collect()).collect()
}

const SQUARE: [(f64, f64); 4] = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];

#[test]
fn a_window_inside_is_put_out_with_the_holes_inside_it() {
    let hole = [(4.0, 4.0), (4.0, 6.0), (6.0, 6.0), (6.0, 4.0)];
    let w = window(3.0, 3.0, 7.0, 7.0);
    let got = clipped(&w, &polygon(&[&SQUARE, &hole]));
    assert_eq!(got, [vec![vec![(3.0, 3.0), (7.0, 3.0), (7.0, 7.0), (3.0, 7.0)], hole.to_vec()]]);
    // In the hole there is nothing.
    assert!(clipped(&window(4.5, 4.5, 5.5, 5.5), &polygon(&[&SQUARE, &hole])).is_empty());
}

#[test]
fn a_hole_across_the_border_becomes_part_of_the_outline() {
    let hole = [(4.0, 4.0), (4.0, 6.0), (6.0, 6.0), (6.0, 4.0)];
    let got = clipped(&window(5.0, 0.0, 10.0, 10.0), &polygon(&[&SQUARE, &hole]));
    assert_eq!(got.len(), 1);
    assert_eq!((got[0].len(), got[0][0].len()), (1, 8));
}

#[test]
fn directions_of_input_rings_do_not_matter() {
    let hole = [(4.0, 4.0), (4.0, 6.0), (6.0, 6.0), (6.0, 4.0)];
    let mut backwards = (SQUARE, hole);
    backwards.0.reverse();
    backwards.1.reverse();
    let w = window(5.0, 1.0, 12.0, 9.0);
    let area = |s: Shapes| clip(&w, &s, &Options, &mut NoTrace).unwrap().area();
    assert_eq!(area(polygon(&[&SQUARE, &hole])), 38.0);
    assert_eq!(area(polygon(&[&backwards.0, &backwards.1])), 38.0);
}

#[test]
fn touching_the_border_adds_nothing() {
    let w = window(0.0, 0.0, 10.0, 10.0);
    // Outside, touching along an edge, and in a corner.
    assert!(
        clipped(&w, &polygon(&[&[(10.0, 2.0), (12.0, 2.0), (12.0, 4.0), (10.0, 4.0)]])).is_empty()
    );
    assert!(clipped(&w, &polygon(&[&[(10.0, 10.0), (12.0, 10.0), (12.0, 14.0)]])).is_empty());
    // Inside, touching the border from inside: copied.
    let diamond = [(5.0, 0.0), (10.0, 5.0), (5.0, 10.0), (0.0, 5.0)];
    assert_eq!(clipped(&w, &polygon(&[&diamond])), [vec![diamond.to_vec()]]);
}

#[test]
fn a_polygon_pinched_at_the_border_falls_apart_there() {
    // Two peaks below y = 0 meet the line y = 0 between them in (5, 0), where the subject's notch ends.
    let m = [(0.0, -5.0), (10.0, -5.0), (10.0, 5.0), (5.0, 0.0), (0.0, 5.0)];
    let got = clipped(&window(-1.0, 0.0, 11.0, 9.0), &polygon(&[&m]));
    assert_eq!(got.len(), 2, "{got:?}");
    let below = clipped(&window(-1.0, -9.0, 11.0, 0.0), &polygon(&[&m]));
    assert_eq!(below.len(), 1);
}

#[test]
fn a_hole_that_touches_the_border_stays_a_hole() {
    let hole = [(5.0, 2.0), (4.0, 5.0), (6.0, 5.0)];
    let got = clipped(&window(-1.0, 2.0, 11.0, 11.0), &polygon(&[&SQUARE, &hole]));
    assert_eq!((got.len(), got[0].len()), (1, 2), "{got:?}");
}

#[test]
fn corners_belong_to_who_covers_them() {
    // A band across the lower left corner: cut by two sides, its outer part covers the corner.
    let band = [(-2.0, 1.0), (1.0, -2.0), (3.0, -2.0), (-2.0, 3.0)];
    let got = clipped(&window(0.0, 0.0, 10.0, 10.0), &polygon(&[&band]));
    assert_eq!(got, [vec![vec![(1.0, 0.0), (0.0, 1.0), (0.0, 0.0)]]]);
}

#[test]
fn a_point_that_is_not_finite_is_named() {
    let shapes = polygon(&[&[(0.0, 0.0), (1.0, f64::NAN), (1.0, 1.0)]]);
    let error = clip(&window(0.0, 0.0, 1.0, 1.0), &shapes, &Options, &mut NoTrace).unwrap_err();
    assert_eq!(error, Error::NonFinite { what: "point", index: 1 });
}

/// Returns a star-shaped ring around a centre: simple for any radii.
fn star(center: DVec2, radii: &[f64]) -> Vec<DVec2> {
    let n = radii.len() as f64;
    let at = |(i, r): (usize, &f64)| {
        let angle = std::f64::consts::TAU * i as f64 / n;
        center + p(libm::cos(angle), libm::sin(angle)) * *r
    };
    radii.iter().enumerate().map(at).collect()
}

/// Returns a star with a scaled copy of itself as a hole.
fn star_with_hole() -> impl Strategy<Value = Shapes> {
    let radii = prop::collection::vec(0.2..4.0f64, 3..24);
    (radii, -2.0..2.0f64, -2.0..2.0f64, 0.1..0.9f64).prop_map(|(radii, x, y, scale)| {
        let inner: Vec<f64> = radii.iter().map(|r| r * scale).collect();
        let mut shapes = Shapes::new();
        shapes.push_ring(star(p(x, y), &radii));
        shapes.push_ring(star(p(x, y), &inner).into_iter().rev());
        shapes.end_polygon();
        shapes
    })
}

/// Returns a simple ring on a small grid: the outline of random columns of cells in a row.
fn skyline() -> impl Strategy<Value = Shapes> {
    prop::collection::vec(1i32..5, 1..8).prop_map(|heights| {
        let mut ring = vec![p(-3.0, -2.0)];
        for (i, h) in heights.iter().enumerate().rev() {
            let (x, y) = (i as f64 - 3.0, f64::from(*h) - 2.0);
            ring.extend([p(x + 1.0, -2.0), p(x + 1.0, y), p(x, y)]);
        }
        let mut outline: Vec<DVec2> = vec![p(-3.0, -2.0), p(heights.len() as f64 - 3.0, -2.0)];
        outline.extend(ring.iter().filter(|v| v.y > -2.0));
        outline.dedup();
        Shapes::from_rings([outline])
    })
}

fn laws(w: &Rect, shapes: &Shapes) -> Result<(), TestCaseError> {
    let mut steps = Recorder::default();
    let (got, sources) = clip_with_sources(w, shapes, &Options, &mut steps).unwrap();
    prop_assert_eq!(&clip(w, shapes, &Options, &mut NoTrace).unwrap(), &got);
    prop_assert_eq!(&replay(shapes, steps.steps()), &got);

    // The area is that of Sutherland–Hodgman, whose bridging edges enclose none.
    let expected: f64 = shapes
        .rings()
        .map(|r| signed_area(&sutherland_hodgman::clip(w, r, &mut NoTrace).unwrap()))
        .sum();
    prop_assert!((got.area() - expected).abs() < 1e-9, "{} {} {:?}", got.area(), expected, got);

    // Outer rings have one direction, holes the other; all points are in the window; none is repeated.
    for polygon in got.polygons() {
        prop_assert!(signed_area(polygon.outer()) > -1e-12);
        prop_assert!(polygon.holes().all(|h| signed_area(h) < 1e-12));
    }
    for ring in got.rings() {
        prop_assert!(ring.len() > 2 && ring.iter().all(|p| w.contains(*p)));
        prop_assert!(ring.iter().zip(ring.iter().cycle().skip(1)).all(|(a, b)| a != b));
    }

    // Positions interpolated as attributes are the positions.
    let points = got.points();
    let mixed = interpolate(&sources, shapes.points(), |a, b, t| a + (b - a) * t, |i| points[i]);
    let mixed = mixed.unwrap();
    prop_assert_eq!(mixed.len(), points.len());
    for (a, b) in mixed.iter().zip(points) {
        prop_assert!((*a - *b).abs().max_element() < 1e-13, "{} {}", a, b);
    }
    let corners = [w.min(), w.max(), p(w.min().x, w.max().y), p(w.max().x, w.min().y)];
    for (source, point) in sources.iter().zip(points) {
        prop_assert!(*source != VertexSource::Corner || corners.contains(point));
    }

    // A second clip changes only the starting vertex.
    let again = clip(w, &got, &Options, &mut NoTrace).unwrap();
    prop_assert_eq!(again, got);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    #[test]
    fn stars_with_holes_obey_the_laws(shapes in star_with_hole(), a in -3.0..3.0f64, b in -3.0..3.0f64, c in 0.1..4.0f64, d in 0.1..4.0f64) {
        laws(&window(a, b, a + c, b + d), &shapes)?;
    }

    #[test]
    fn skylines_on_a_grid_obey_the_laws(shapes in skyline(), x in -4i32..4, y in -4i32..4, c in 1i32..6, d in 1i32..6) {
        let (x, y) = (f64::from(x), f64::from(y));
        laws(&window(x, y, x + f64::from(c), y + f64::from(d)), &shapes)?;
    }

    #[test]
    fn anything_goes_without_panic(ring in prop::collection::vec((-3i32..=3, -3i32..=3), 0..12), hole in prop::collection::vec((-3i32..=3, -3i32..=3), 0..6)) {
        let w = window(-1.0, -2.0, 2.0, 1.0);
        let mut shapes = Shapes::new();
        for r in [ring, hole] {
            shapes.push_ring(r.iter().map(|&(x, y)| p(f64::from(x), f64::from(y))));
        }
        shapes.end_polygon();
        let got = clip(&w, &shapes, &Options, &mut NoTrace).unwrap();
        prop_assert!(got.points().len() <= 8 * shapes.points().len() + 8);
    }

    #[test]
    fn polylines_keep_their_order(points in prop::collection::vec((-4i32..=4, -4i32..=4), 2..12)) {
        let points: Vec<DVec2> = points.iter().map(|&(x, y)| p(f64::from(x), f64::from(y))).collect();
        let w = window(-2.0, -1.0, 2.0, 3.0);
        let got = clip_lines(&w, &points, &[points.len()], true).unwrap();
        // The pieces are those left of single segments, in the same order.
        let length = |pieces: &mut dyn Iterator<Item = (DVec2, DVec2)>| pieces.map(|(a, b)| (b - a).length()).sum::<f64>();
        let mut singles = points.windows(2).filter_map(|e| crate::clip::line::cut_inside(&w, e[0], e[1])).map(|s| (s.start, s.end));
        let mut ours = got.pieces().flat_map(|(_, piece)| piece.windows(2).map(|e| (e[0], e[1])).collect::<Vec<_>>());
        prop_assert!((length(&mut singles) - length(&mut ours)).abs() < 1e-9);
        let mut last = -1.0;
        for source in &got.sources {
            let at = match *source {
                VertexSource::Vertex(i) => i as f64,
                VertexSource::Cut { from, to, t } => from as f64 + (to - from) as f64 * t,
                VertexSource::Corner => f64::NAN,
            };
            prop_assert!(at >= last, "{:?}", got.sources);
            last = at;
        }
        // Cuts only at the border: the ends of pieces are the polyline's ends, or on the border.
        let on_border = |v: &DVec2| v.x == -2.0 || v.x == 2.0 || v.y == -1.0 || v.y == 3.0;
        let ends = [points[0], points[points.len() - 1]];
        for (_, piece) in got.pieces() {
            prop_assert!([piece[0], piece[piece.len() - 1]].iter().all(|v| on_border(v) || ends.contains(v)));
        }
    }
}
