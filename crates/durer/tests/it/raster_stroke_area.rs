//! The points that a stroke covers: compared with the distance from its path, and with the union of its pieces.

use std::f64::consts::SQRT_2;

use crate::raster_coverage::Random;
use durer::clip::polygon::{BooleanOp, Shapes, WindingRule, overlay};
use durer::curve::{Contours, Path, PathElement, flatten};
use durer::math::DVec2;
use durer::raster::coverage::fill;
use durer::raster::line::wide::{Cap, Join, Step, Stroke, StrokePart, outline};
use durer::trace::{Counts, NoTrace, Recorder};

const TOLERANCE: f64 = 0.01;
const FINE: f64 = 1e-4;

/// Returns how often an outline winds around a point.
fn winding(outline: &Contours, p: DVec2) -> i32 {
    let mut winding = 0;
    for (points, _) in outline.iter() {
        for (i, a) in points.iter().enumerate() {
            let b = points[(i + 1) % points.len()];
            let side = (b - *a).perp_dot(p - *a);
            if a.y <= p.y && b.y > p.y && side > 0.0 {
                winding += 1;
            } else if a.y > p.y && b.y <= p.y && side < 0.0 {
                winding -= 1;
            }
        }
    }
    winding
}

fn distance(chain: &Contours, p: DVec2) -> f64 {
    let to = |(a, b): (DVec2, DVec2)| {
        let (way, length) = (b - a, a.distance_squared(b));
        let t = if length > 0.0 { ((p - a).dot(way) / length).clamp(0.0, 1.0) } else { 0.0 };
        p.distance(a + way * t)
    };
    let edges = chain.iter().flat_map(|(points, closed)| {
        let last = if closed { points.len() } else { points.len() - 1 };
        (0..last.max(1)).map(move |i| (points[i], points[(i + 1) % points.len()]))
    });
    edges.map(to).fold(f64::INFINITY, f64::min)
}

/// Returns chains of lines and curves of all sizes, open and closed, with spikes, repeated points and cusps.
fn any_path(random: &mut Random, curved: bool) -> Path {
    let mut path = Path::new();
    for _ in 0..1 + (random.next() * 2.0) as u32 {
        let reach = [0.5, 3.0, 20.0, 60.0][(random.next() * 4.0) as usize];
        let centre = random.point(40.0, 60.0);
        let mut point = |last: DVec2| match (random.next() * 12.0) as u32 {
            0 => last,
            1 => last + DVec2::new(reach, 0.0),
            2 => last + (centre - last) * 0.1,
            _ => centre + random.point(-reach, reach),
        };
        let mut last = point(centre);
        path.push(PathElement::MoveTo(last));
        for i in 0..8 {
            let [a, b] = [point(last), point(last)];
            let end = point(b);
            path.push(match (curved, i % 3) {
                (true, 1) => PathElement::QuadTo(a, end),
                (true, 2) => PathElement::CubicTo(a, b, end),
                _ => PathElement::LineTo(end),
            });
            last = end;
        }
        if random.next() < 0.5 {
            path.close();
        }
    }
    path
}

fn round(width: f64) -> Stroke {
    Stroke { width, cap: Cap::Round, join: Join::Round, ..Stroke::default() }
}

#[test]
fn round_strokes_cover_what_is_within_half_their_width() {
    let mut random = Random(11);
    for case in 0..400 {
        let path = any_path(&mut random, case % 2 == 1);
        let width = [0.2, 2.0, 10.0, 60.0][case / 2 % 4];
        let outline = outline(&path, &round(width), TOLERANCE, &mut NoTrace).expect("style");
        let chain = flatten(&path, 1e-4);
        let mut inside = 0;
        for _ in 0..400 {
            let p = random.point(-10.0, 110.0);
            let (away, winding) = (distance(&chain, p) - width / 2.0, winding(&outline, p));
            assert!(winding <= 0, "{case}: {p} is passed backwards: {away} {width} {path:?}");
            if away.abs() > TOLERANCE * 1.1 + 1e-4 {
                assert_eq!(winding < 0, away < 0.0, "{case}: {away} {p} {width} {path:?}");
            }
            inside += u32::from(away < 0.0);
        }
        assert!(inside > 0 || width < 20.0);
    }
}

#[test]
fn strokes_are_the_union_of_their_pieces() {
    let mut random = Random(5);
    for case in 0..300 {
        let path = any_path(&mut random, false);
        let width = [0.5, 4.0, 30.0][case % 3];
        let stroke = Stroke {
            width,
            join: if case % 2 == 0 { Join::Miter } else { Join::Bevel },
            miter_limit: [1.0, 1.5, 4.0, 20.0][case / 6 % 4],
            cap: [Cap::Butt, Cap::Square][case / 3 % 2],
            ..Stroke::default()
        };
        let outline = outline(&path, &stroke, FINE, &mut NoTrace).expect("style");
        let own = Shapes::from_rings(outline.iter().map(|(points, _)| points));
        let pieces = Shapes::from_rings(pieces(&path, &stroke));
        let options = overlay::Options::with_rule(WindingRule::NonZero);
        let both = overlay::overlay(&own, &pieces, BooleanOp::Xor, &options, &mut NoTrace);
        let area = both.expect("finite").shapes.area();
        // Corners that are nearly straight may have a tip of the tolerance.
        let tips = 20.0 * FINE * (FINE * width).sqrt();
        assert!(area < tips + 1e-4, "{case}: {area} {stroke:?} {path:?}");
    }
}

/// Returns rectangles of the pieces, wedges of the corners and caps, all with the same direction.
fn pieces(path: &Path, stroke: &Stroke) -> Vec<Vec<DVec2>> {
    let (half, mut out) = (stroke.width / 2.0, Vec::new());
    for (points, closed) in flatten(path, 1.0).iter() {
        let mut points = points.to_vec();
        points.dedup();
        if closed {
            while points.len() > 1 && points.first() == points.last() {
                points.pop();
            }
        }
        let count = points.len();
        let n = if closed && count > 1 { count } else { count - 1 };
        let along = |i: usize| (points[(i + 1) % count] - points[i]).normalize();
        for i in 0..n {
            let (mut a, mut b) = (points[i], points[(i + 1) % count]);
            let side = along(i).perp() * half;
            if stroke.cap == Cap::Square && !closed {
                a -= if i == 0 { along(i) * half } else { DVec2::ZERO };
                b += if i + 1 == n { along(i) * half } else { DVec2::ZERO };
            }
            out.push(vec![a + side, a - side, b - side, b + side]);
            if i + 1 < n || closed {
                let (p, next) = (points[(i + 1) % count], along((i + 1) % n));
                let outer = if along(i).perp_dot(next) > 0.0 { -half } else { half };
                let [from, to] = [along(i), next].map(|d| d.perp() * outer);
                // The miter over the width is 1 / sin of half the angle between the pieces.
                let angle = (-along(i)).angle_to(next).abs();
                let mut wedge = vec![p, p + from, p + to];
                if stroke.join == Join::Miter && 1.0 / (angle / 2.0).sin() <= stroke.miter_limit {
                    wedge.insert(2, p + (from + to).normalize() * half / (angle / 2.0).sin());
                }
                out.push(wedge);
            }
        }
        if n == 0 && stroke.cap == Cap::Square {
            let corner = DVec2::splat(half);
            let other = DVec2::new(half, -half);
            let p = points[0];
            out.push(vec![p + corner, p - other, p - corner, p + other]);
        }
    }
    for ring in &mut out {
        if durer::clip::polygon::signed_area(ring) < 0.0 {
            ring.reverse();
        }
    }
    out
}

#[test]
fn a_small_square_with_a_wide_stroke_has_no_hole() {
    let square = Path::rectangle(95.0, 95.0, 10.0, 10.0);
    for (join, area) in [
        (Join::Round, 100.0 + 40.0 * 30.0 + std::f64::consts::PI * 900.0),
        (Join::Miter, 4900.0),
        (Join::Bevel, 4900.0 - 4.0 * 450.0),
    ] {
        let stroke = Stroke { width: 60.0, join, ..Stroke::default() };
        let outline = outline(&square, &stroke, 0.025, &mut NoTrace).expect("style");
        let mask = fill(&outline, 200, 200, &Default::default(), &mut NoTrace).expect("size");
        let found: f64 = mask.data().iter().map(|a| f64::from(*a) / 255.0).sum();
        assert!((found - area).abs() < 0.025 * 230.0, "{join:?}: {found}, not {area}");
    }
}

/// Checks that the pen sweeps the area beyond the centre of a bend, however few ends are near it.
#[test]
fn tight_bends_are_swept_on_both_sides() {
    let (centre, r) = (DVec2::new(100.0, 110.0), 10.0);
    let k = r * 0.552_284_75;
    let at = |x: f64, y: f64| centre + DVec2::new(x, y);
    let mut arch = Path::new();
    arch.push(PathElement::MoveTo(at(-r, 0.0)));
    arch.push(PathElement::CubicTo(at(-r, -k), at(-k, -r), at(0.0, -r)));
    arch.push(PathElement::CubicTo(at(k, -r), at(r, -k), at(r, 0.0)));
    for cap in [Cap::Butt, Cap::Square] {
        let stroke = Stroke { width: 80.0, cap, ..Stroke::default() };
        let outline = outline(&arch, &stroke, TOLERANCE, &mut NoTrace).expect("style");
        let mut random = Random(7);
        for _ in 0..5000 {
            let p = random.point(-60.0, 60.0);
            let (away, winding) = (p.length(), winding(&outline, centre + p));
            assert!(winding <= 0, "{cap:?} {p}");
            // Above: the outer half of half a ring; below: the area swept by the other end of the pen.
            let reach = if p.y < 0.0 { 50.0 } else { 30.0 };
            if away < reach - 0.1 {
                assert!(winding < 0, "{cap:?} {p}");
            } else if away > reach + 0.1 && cap == Cap::Butt {
                assert_eq!(winding, 0, "{p}");
            }
        }
    }
}

/// Checks that the area swept beyond the centre of a bend ends in a circle, however few chords the bend itself needs.
#[test]
fn the_far_side_of_a_tight_bend_is_round() {
    let (centre, r) = (DVec2::new(100.0, 100.0), 0.2);
    let k = r * 0.552_284_75;
    let at = |x: f64, y: f64| centre + DVec2::new(x, y);
    let mut arch = Path::new();
    arch.push(PathElement::MoveTo(at(-r, 0.0)));
    arch.push(PathElement::CubicTo(at(-r, -k), at(-k, -r), at(0.0, -r)));
    arch.push(PathElement::CubicTo(at(k, -r), at(r, -k), at(r, 0.0)));
    let stroke = Stroke { width: 80.0, ..Stroke::default() };
    let outline = outline(&arch, &stroke, TOLERANCE, &mut NoTrace).expect("style");
    for i in 1..180 {
        let way = DVec2::from_angle(f64::from(i).to_radians());
        for (away, inside) in [(39.75, true), (40.05, false)] {
            let p = centre + way * away;
            assert_eq!(winding(&outline, p) != 0, inside, "{i} degrees, {away}");
        }
    }
}

#[test]
fn curves_without_length_do_not_end_dashes() {
    let mut path = Path::polyline([DVec2::new(10.0, 10.0), DVec2::new(30.0, 10.0)]);
    path.quad_to(30.0, 10.0, 30.0, 10.0).line_to(90.0, 10.0);
    let stroke = Stroke { width: 4.0, dashes: vec![10.0, 10.0], ..Stroke::default() };
    let outline = outline(&path, &stroke, TOLERANCE, &mut NoTrace).expect("style");
    for i in 0..16 {
        let p = DVec2::new(12.5 + 5.0 * f64::from(i), 10.0);
        assert_eq!(winding(&outline, p) != 0, i % 4 < 2, "{p}");
    }
}

/// Checks that a contour that consists only of a close has no dashes; formerly a stroke ran to it from the origin.
#[test]
fn dashes_begin_where_an_empty_contour_was() {
    let [at, to] = [DVec2::new(20.0, 10.0), DVec2::new(60.0, 10.0)];
    for cap in [Cap::Butt, Cap::Square, Cap::Round] {
        for next in [PathElement::LineTo(to), PathElement::QuadTo(at, to)] {
            let mut path = Path::new();
            path.push(PathElement::MoveTo(at));
            path.push(PathElement::Close);
            path.push(next);
            path.push(PathElement::MoveTo(to));
            path.push(PathElement::Close);
            let stroke = Stroke { width: 2.0, cap, dashes: vec![5.0, 5.0], ..Stroke::default() };
            let outline = outline(&path, &stroke, TOLERANCE, &mut NoTrace).expect("style");
            // Dots are a ten-thousandth of their width long.
            let near = |p: &DVec2| (19.0 - 1e-3..=61.0 + 1e-3).contains(&p.x);
            assert!(outline.points().iter().all(near), "{cap:?} {next:?}: {outline:?}");
            assert!(winding(&outline, DVec2::new(22.5, 10.0)) != 0, "{cap:?} {next:?}");
            assert_eq!(winding(&outline, DVec2::new(27.5, 10.0)), 0, "{cap:?} {next:?}");
        }
    }
}

#[test]
fn strokes_wider_than_any_picture_cover_it() {
    let square = Path::rectangle(95.0, 95.0, 10.0, 10.0);
    let mut ring = Path::circle(DVec2::splat(100.0), 3.0);
    ring.move_to(90.0, 90.0).quad_to(90.0, 91.0, 91.0, 90.0);
    for path in [square, ring] {
        for width in [600.0, 3e3, 1e5, 1e9, 1e30] {
            for join in [Join::Round, Join::Miter, Join::Bevel] {
                let stroke = Stroke { join, ..round(width) };
                let outline = outline(&path, &stroke, 0.025, &mut NoTrace).expect("style");
                let mask = fill(&outline, 200, 200, &Default::default(), &mut NoTrace);
                assert!(mask.expect("size").data().iter().all(|a| *a == 255), "{join:?} {width}");
            }
        }
    }
}

#[test]
fn outlines_have_few_points() {
    let mut corner = Path::new();
    corner.move_to(0.0, 0.0).line_to(50.0, 0.0).line_to(50.0, 50.0).line_to(0.0, 50.0).close();
    let count = |path: &Path, join| {
        let stroke = Stroke { width: 4.0, join, ..Stroke::default() };
        outline(path, &stroke, 0.025, &mut NoTrace).expect("style").points().len()
    };
    assert_eq!(count(&corner, Join::Miter), 8);
    assert_eq!(count(&corner, Join::Bevel), 12);
    // A wide bend: as many points on each side as the flattened path has.
    let circle = Path::circle(DVec2::ZERO, 100.0);
    let pieces = flatten(&circle, 0.025).points().len() - 1;
    assert_eq!(count(&circle, Join::Miter), 2 * pieces);
}

#[test]
fn caps_of_curves_stand_across_their_ends() {
    // A quarter circle from (50, 20) down to (20, 50) around (20, 20).
    let mut quarter = Path::new();
    quarter.arc(DVec2::splat(20.0), 30.0, 0.0, std::f64::consts::FRAC_PI_2);
    for width in [10.0, 55.0] {
        let stroke = Stroke { width, ..Stroke::default() };
        let outline = outline(&quarter, &stroke, 0.1, &mut NoTrace).expect("style");
        for sign in [-1.0, 1.0] {
            let side = sign * width / 2.0;
            for (x, y) in [(50.0 + side, 20.0), (20.0, 50.0 + side)] {
                let near = outline.points().iter().any(|p| p.distance(DVec2::new(x, y)) < 1e-9);
                assert!(near, "{width}: no corner at {x}, {y}");
            }
        }
        let beyond = outline.points().iter().filter(|p| p.min_element() < 20.0 - 1e-9);
        assert_eq!(beyond.count(), 0, "{width}");
    }
}

#[test]
fn lengths_of_miters_are_right_at_the_limit() {
    // A right angle has a miter of √2 widths.
    let corner =
        Path::polyline([(0.0, 0.0), (9.0, 0.0), (9.0, 9.0)].map(|(x, y)| DVec2::new(x, y)));
    for (miter_limit, sharp) in [(SQRT_2 * 1.001, true), (SQRT_2 * 0.999, false)] {
        let stroke = Stroke { width: 2.0, miter_limit, ..Stroke::default() };
        let outline = outline(&corner, &stroke, 0.01, &mut NoTrace).expect("style");
        assert_eq!(outline.points().contains(&DVec2::new(10.0, -1.0)), sharp);
    }
}

#[test]
fn steps_of_strokes_rebuild_the_outline() {
    let mut random = Random(3);
    for case in 0..60 {
        let path = any_path(&mut random, case % 2 == 1);
        let dashes = if case % 3 == 0 { vec![5.0, 2.0] } else { vec![] };
        let stroke = Stroke { width: 8.0, join: Join::Round, dashes, ..Stroke::default() };
        let mut recorder = Recorder::default();
        let traced = outline(&path, &stroke, TOLERANCE, &mut recorder).expect("style");
        let (mut rings, mut parts) = (Vec::<Vec<DVec2>>::new(), Vec::new());
        for step in recorder.steps() {
            match *step {
                Step::Ring => rings.push(Vec::new()),
                Step::Point { vertex, point, part } => {
                    assert!(part != StrokePart::Pivot || vertex == point);
                    rings.last_mut().expect("a ring").push(point);
                    parts.push(part);
                }
            }
        }
        let mut replayed = Contours::new();
        rings.into_iter().for_each(|ring| replayed.push(ring, true));
        assert_eq!(replayed, traced, "{case}");
        assert!(parts.contains(&StrokePart::Side) && parts.contains(&StrokePart::Join));
        let mut counts = Counts::default();
        assert_eq!(outline(&path, &stroke, TOLERANCE, &mut counts).expect("style"), traced);
        assert_eq!(counts.steps, recorder.steps().len() as u64);
    }
}
