//! Curves on paper: lines that were joined stay joined, and parts of one circle are.

use durer::math::DVec2;
use durer::paper::{Hidden, Options, lay_out};
use durer::target::drawing::{Drawing, Line, LineClass};
use durer::target::sheet::{Mark, Sheet};
use durer::target::{Arc, Curve, Piece};
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
            Mark::Curve { curve, .. } => Some(curve),
            _ => None,
        })
        .collect()
}

fn arcs<'a>(curves: &[&'a Curve]) -> Vec<&'a Arc> {
    let arc = |piece: &'a Piece| match piece {
        Piece::Arc(arc, _) => Some(arc),
        _ => None,
    };
    curves.iter().flat_map(|c| &c.pieces).filter_map(arc).collect()
}

#[test]
fn paper_has_polylines_where_nothing_is_fitted() {
    let lines = vec![line(&circle(48, 20.0), true, 0, LineClass::Crease)];
    let polylines = sheet(lines.clone(), 0.0);
    assert!(matches!(polylines.layers[0].marks[..], [Mark::Stroke { closed: true, .. }]));
    let fitted = sheet(lines, 0.02);
    assert!(curves(&fitted)[0].whole().is_some_and(Arc::is_circular));
    let straight = vec![line(&circle(4, 20.0), true, 0, LineClass::Crease)];
    assert_eq!(sheet(straight.clone(), 0.02), sheet(straight, 0.0));
    // The mesh's own lines have facets.
    let wire = vec![line(&circle(48, 20.0), true, 0, LineClass::Wire)];
    assert!(curves(&sheet(wire, 0.02)).is_empty());
}

#[test]
fn parts_of_a_circle_have_one_centre_and_meet() {
    let points = circle(64, 30.0);
    // Coordinates as rounded as those of a file.
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
        .flat_map(|c| std::iter::once(c.start).chain(c.pieces.iter().map(Piece::end)))
        .collect();
    let places = polylines.layers.iter().flat_map(|l| &l.marks).filter_map(|m| match m {
        Mark::Stroke { points, .. } => Some(points),
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
