//! Curves on paper: joined lines stay joined, and parts of one circle stay on one circle.

use durer::math::DVec2;
use durer::paper::{Hidden, Options, lay_out};
use durer::target::drawing::{Drawing, Line, LineClass, Region, RegionKind};
use durer::target::sheet::{PaperMark, Sheet};
use durer::target::{Curve, CurvePiece, EllipticArc};
use std::f64::consts::TAU;

fn circle(count: u32, radius: f64) -> Vec<DVec2> {
    let at = |i: u32| {
        let (sin, cos) = libm::sincos(f64::from(i) * TAU / f64::from(count));
        DVec2::new(cos, sin) * radius
    };
    (0..count).map(at).collect()
}

fn line(points: &[DVec2], closed: bool, invisibility: u32, class: LineClass) -> Line {
    Line { class, invisibility, points: points.to_vec(), closed }
}

fn sheet(lines: Vec<Line>, fit: f64) -> Sheet {
    let drawing = Drawing { lines, ..Drawing::default() };
    let scale = "1:1".parse().expect("a scale");
    let options = Options { fit, scale, hidden: Hidden::Dashed, ..Options::default() };
    lay_out(&drawing, "", &options).expect("laid out").sheet
}

fn curves(sheet: &Sheet) -> Vec<&Curve> {
    let marks = sheet.layers.iter().flat_map(|l| &l.marks);
    marks
        .filter_map(|mark| match mark {
            PaperMark::Curve { curve, .. } => Some(curve),
            _ => None,
        })
        .collect()
}

fn arcs<'a>(curves: &[&'a Curve]) -> Vec<&'a EllipticArc> {
    let arc = |piece: &'a CurvePiece| match piece {
        CurvePiece::Arc(arc, _) => Some(arc),
        _ => None,
    };
    curves.iter().flat_map(|c| &c.pieces).filter_map(arc).collect()
}

#[test]
fn paper_has_polylines_where_nothing_is_fitted() {
    let lines = vec![line(&circle(48, 20.0), true, 0, LineClass::Crease)];
    let polylines = sheet(lines.clone(), 0.0);
    assert!(matches!(polylines.layers[0].marks[..], [PaperMark::Stroke { closed: true, .. }]));
    let fitted = sheet(lines, 0.02);
    assert!(curves(&fitted)[0].whole().is_some_and(EllipticArc::is_circular));
    let straight = vec![line(&circle(4, 20.0), true, 0, LineClass::Crease)];
    assert_eq!(sheet(straight.clone(), 0.02), sheet(straight, 0.0));
    // The mesh's own lines are faceted.
    let wire = vec![line(&circle(48, 20.0), true, 0, LineClass::Wire)];
    assert!(curves(&sheet(wire, 0.02)).is_empty());
}

#[test]
fn parts_of_a_circle_have_one_centre_and_meet() {
    let points = circle(64, 30.0);
    // Coordinates rounded like those of a file.
    let points: Vec<DVec2> =
        points.iter().map(|p| DVec2::new(f64::from(p.x as f32), f64::from(p.y as f32))).collect();
    let seen = line(&points[..25], false, 0, LineClass::Silhouette);
    let rest = [&points[24..], &points[..1]].concat();
    let hidden = line(&rest, false, 1, LineClass::Crease);
    // Another line ends in a point of each.
    let spoke = |i: usize| line(&[points[i], points[i] * 1.5], false, 0, LineClass::Crease);
    let lines = vec![seen, hidden, spoke(10), spoke(40)];
    let fitted = sheet(lines.clone(), 0.02);
    let polylines = sheet(lines, 0.0);
    let curves = curves(&fitted);
    let arcs = arcs(&curves);
    assert_eq!(arcs.len(), 4);
    for arc in &arcs {
        assert_eq!((arc.center, arc.axis, arc.ratio), (arcs[0].center, arcs[0].axis, 1.0));
    }
    let mut ends: Vec<DVec2> = curves
        .iter()
        .flat_map(|c| std::iter::once(c.start).chain(c.pieces.iter().map(CurvePiece::end)))
        .collect();
    let places = polylines.layers.iter().flat_map(|l| &l.marks).filter_map(|m| match m {
        PaperMark::Stroke { points, .. } => Some(points),
        _ => None,
    });
    let places: Vec<DVec2> = places.flatten().copied().collect();
    assert!(ends.iter().all(|end| places.contains(end)));
    ends.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    ends.dedup();
    assert_eq!(ends.len(), 4);
}

#[test]
fn dashed_circles_stay_whole_and_dashed_slots_are_divided_at_corners() {
    let dashed = sheet(vec![line(&circle(48, 20.0), true, 1, LineClass::Crease)], 0.02);
    assert!(curves(&dashed)[0].whole().is_some());
    // Half a circle and its diameter.
    let half = circle(48, 20.0)[..25].to_vec();
    let dashed = sheet(vec![line(&half, true, 1, LineClass::Crease)], 0.02);
    let parts = curves(&dashed);
    assert_eq!(parts.len(), 2);
    assert!(parts.iter().all(|part| !part.closed && part.pieces.len() == 1));
}

fn region(rings: Vec<Vec<DVec2>>) -> Region {
    Region { kind: RegionKind::Surface, rings, color: [9, 9, 9, 255], item: None, part: None }
}

fn areas(regions: Vec<Region>, fit_areas: bool) -> Vec<PaperMark> {
    let drawing = Drawing { regions, ..Drawing::default() };
    let scale = "1:1".parse().expect("a scale");
    let options = Options { fit: 0.02, fit_areas, scale, ..Options::default() };
    let sheet = lay_out(&drawing, "", &options).expect("laid out").sheet;
    sheet.layers.into_iter().flat_map(|l| l.marks).collect()
}

fn backwards(ring: &[DVec2]) -> Vec<DVec2> {
    ring.iter().rev().copied().collect()
}

#[test]
fn areas_share_the_curves_between_them() {
    // A ring around a disc, and the disc as two halves; the ring's outer border is a square.
    let disc = circle(48, 20.0);
    let square = [(-30.0, -30.0), (30.0, -30.0), (30.0, 30.0), (-30.0, 30.0)];
    let square: Vec<DVec2> = square.iter().map(|(x, y)| DVec2::new(*x, *y)).collect();
    let upper: Vec<DVec2> = disc[..=24].to_vec();
    let lower: Vec<DVec2> = disc[24..].iter().chain(&disc[..1]).copied().collect();
    let ring = region(vec![square, backwards(&disc)]);
    let marks = areas(vec![ring, region(vec![upper]), region(vec![lower])], true);
    let rings: Vec<&Curve> = marks
        .iter()
        .flat_map(|mark| match mark {
            PaperMark::Area { rings, .. } => rings,
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(rings.len(), 4);
    assert!(rings.iter().all(|r| r.closed && r.start == r.end()));
    assert_eq!(rings[0].pieces.len(), 4);
    // Two halves, each in two rings, once reversed.
    let arcs_of = |ring: &Curve| -> Vec<(DVec2, EllipticArc, DVec2)> {
        let arc = |(start, piece): (DVec2, &CurvePiece)| match piece {
            CurvePiece::Arc(arc, end) => Some((start, *arc, *end)),
            _ => None,
        };
        ring.iter().filter_map(arc).collect()
    };
    let around = arcs_of(rings[1]);
    assert_eq!(around.len(), 2);
    for half in [arcs_of(rings[2]), arcs_of(rings[3])] {
        let [(start, arc, end)] = half[..] else { panic!("{half:?}") };
        assert!((arc.axis.length() - 20.0).abs() < 1e-9 && arc.is_circular());
        let back = EllipticArc { start: arc.start + arc.turn, turn: -arc.turn, ..arc };
        let shared = |a: &(DVec2, EllipticArc, DVec2)| a.0 == end && a.2 == start && a.1 == back;
        let same = |a: &(DVec2, EllipticArc, DVec2)| {
            a.0 == end && a.2 == start && a.1.center == arc.center
        };
        assert!(around.iter().any(|a| shared(a) || same(a)), "{around:?} {start} {arc:?}");
    }
}

#[test]
fn a_hole_and_what_fills_it_are_one_circle() {
    let hole = circle(60, 7.0);
    let plate: Vec<DVec2> = circle(4, 20.0);
    let disc: Vec<DVec2> = hole[13..].iter().chain(&hole[..13]).copied().collect();
    let marks = areas(vec![region(vec![plate, backwards(&hole)]), region(vec![disc])], true);
    let [PaperMark::Area { rings: a, .. }, PaperMark::Area { rings: b, .. }] = &marks[..] else {
        panic!("{marks:?}")
    };
    let (hole, disc) = (a[1].whole().expect("a circle"), b[0].whole().expect("a circle"));
    assert_eq!((hole.center, hole.axis.length()), (disc.center, disc.axis.length()));
    assert!(hole.turn == -disc.turn && (hole.axis.length() - 7.0).abs() < 1e-9);
}

#[test]
fn areas_that_reach_under_others_stay_as_they_are() {
    let disc = || vec![region(vec![circle(48, 20.0)])];
    assert!(matches!(areas(disc(), false)[..], [PaperMark::Fill { .. }]));
    // The same for lines without anything round.
    let square = vec![region(vec![circle(4, 20.0)])];
    assert!(matches!(areas(square, true)[..], [PaperMark::Fill { .. }]));
}

#[test]
fn a_rim_is_round_whatever_lies_beyond() {
    // A disc, and around it a ring in as many parts as it has facets.
    let (inner, outer) = (circle(48, 20.0), circle(48, 25.0));
    let part = |i: usize| {
        let k = (i + 1) % 48;
        region(vec![vec![inner[i], outer[i], outer[k], inner[k]]])
    };
    let regions = std::iter::once(region(vec![inner.clone()])).chain((0..48).map(part)).collect();
    let marks = areas(regions, true);
    let rings: Vec<&Curve> = marks
        .iter()
        .map(|mark| match mark {
            PaperMark::Area { rings, .. } => &rings[0],
            other => panic!("{other:?}"),
        })
        .collect();
    let circles = arcs(&rings[..1]);
    assert_eq!(circles.len(), 48);
    assert!(circles.iter().all(|a| (a.axis.length() - 20.0).abs() < 1e-9), "{circles:?}");
    // Each part has an arc of each rim, opposite in direction to the disc's.
    for ring in &rings[1..] {
        let [first, second] = arcs(&[ring])[..] else { panic!("{ring:?}") };
        let (low, high) = match first.axis.length() < second.axis.length() {
            true => (first, second),
            false => (second, first),
        };
        assert!((high.axis.length() - 25.0).abs() < 1e-9 && high.turn < 0.0 && low.turn > 0.0);
        let same = |a: &&EllipticArc| a.center == low.center && a.turn == -low.turn;
        assert!(circles.iter().any(same), "{low:?}");
    }
}
