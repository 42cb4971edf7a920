//! Curves as entities of DXF.

use super::dxf_tags::{DxfStrokes, Tags, Target, begin};
use durer::curve::pieces;
use durer::math::DVec2;
use durer::target::{Curve, CurvePiece, EllipticArc};
use std::f64::consts::TAU;

/// Largest distance between arcs and the ellipses and cubic curves that they approximate, in
/// millimetres.
const ARCS: f64 = 0.005;

/// Digits of angles: with them a circle of a metre still meets its neighbours to the last digit of places.
const DIGITS: usize = 10;

/// Writes a curve of a sheet of a given height; the file's y axis points up.
pub(super) fn write(
    tags: &mut Tags,
    to: &Target<'_>,
    curve: &Curve,
    height: f64,
    strokes: DxfStrokes,
) {
    let curve = &turned_up(curve, height);
    if strokes == DxfStrokes::Pieces {
        return pieces_of(tags, to, curve);
    }
    polyline(tags, to, &vertices(curve), curve.closed);
}

/// Writes a bulge.
pub(super) fn bulge(tags: &mut Tags, bulge: f64) {
    tags.precise(42, bulge, DIGITS);
}

/// Returns a curve as points, each with the bulge of the arc that begins there; the first one is not
/// repeated.
pub(super) fn vertices(curve: &Curve) -> Vec<(DVec2, f64)> {
    let arcs = pieces::arcs(curve, ARCS);
    let starts = std::iter::once(curve.start).chain(arcs.iter().map(|a| a.0));
    let bulges = arcs.iter().map(|a| a.1).chain([0.0]);
    let mut points: Vec<(DVec2, f64)> = starts.zip(bulges).collect();
    if curve.closed {
        points.pop();
    }
    points
}

/// Returns a curve seen in a mirror: y counts up from the sheet's lower side.
pub(super) fn turned_up(curve: &Curve, height: f64) -> Curve {
    let place = |p: DVec2| DVec2::new(p.x, height - p.y);
    let way = |v: DVec2| DVec2::new(v.x, -v.y);
    let piece = |piece: &CurvePiece| match *piece {
        CurvePiece::Line(end) => CurvePiece::Line(place(end)),
        CurvePiece::Cubic(a, b, end) => CurvePiece::Cubic(place(a), place(b), place(end)),
        CurvePiece::Arc(arc, end) => {
            let (center, axis) = (place(arc.center), way(arc.axis));
            CurvePiece::Arc(
                EllipticArc { center, axis, start: -arc.start, turn: -arc.turn, ..arc },
                place(end),
            )
        }
    };
    let pieces = curve.pieces.iter().map(piece).collect();
    Curve { start: place(curve.start), pieces, closed: curve.closed }
}

/// Writes an entity for each arc, and one for lines in a row and for cubic curves in a row.
fn pieces_of(tags: &mut Tags, to: &Target<'_>, curve: &Curve) {
    let all: Vec<(DVec2, &CurvePiece)> = curve.iter().collect();
    for row in all.chunk_by(|a, b| goes_on(a.1, b.1)) {
        match row {
            [(start, CurvePiece::Line(end))] => line(tags, to, *start, *end),
            [(_, CurvePiece::Arc(found, _))] => arc(tags, to, found),
            [(start, CurvePiece::Line(_)), ..] => {
                let ends = row.iter().map(|(_, piece)| piece.end());
                let points: Vec<(DVec2, f64)> =
                    std::iter::once(*start).chain(ends).map(|p| (p, 0.0)).collect();
                polyline(tags, to, &points, false);
            }
            _ => spline(tags, to, row),
        }
    }
}

/// Returns whether two pieces are written as one entity.
fn goes_on(a: &CurvePiece, b: &CurvePiece) -> bool {
    matches!(
        (a, b),
        (CurvePiece::Line(_), CurvePiece::Line(_)) | (CurvePiece::Cubic(..), CurvePiece::Cubic(..))
    )
}

/// Writes a line.
pub(super) fn line(tags: &mut Tags, to: &Target<'_>, start: DVec2, end: DVec2) {
    begin(tags, "LINE", to.layer, to.pen);
    tags.class("AcDbLine").place3(10, start).place3(11, end);
}

/// A stroke shorter than this part of its width is a dot.
const DOT: f64 = 0.05;

/// Writes a stroke that is a dot as a circle of the pen's width, and returns whether it is one. The circle's own line
/// is as thin as possible, so that the circle marks the area of the dot.
pub(super) fn dot(tags: &mut Tags, to: &Target<'_>, start: DVec2, end: DVec2) -> bool {
    let Some(pen) = to.pen.filter(|pen| start.distance(end) < DOT * pen.width) else {
        return false;
    };
    begin(tags, "CIRCLE", to.layer, None);
    tags.int(370, 0).class("AcDbCircle");
    tags.place3(10, (start + end) / 2.0).length(40, pen.width / 2.0);
    true
}

/// Writes a polyline of points, each with the bulge of the arc that it begins.
pub(super) fn polyline(tags: &mut Tags, to: &Target<'_>, points: &[(DVec2, f64)], closed: bool) {
    begin(tags, "LWPOLYLINE", to.layer, to.pen);
    tags.class("AcDbPolyline").int(90, points.len() as i64);
    // 128: the line type runs on over corners.
    tags.int(70, if closed { 129 } else { 128 }).real(43, 0.0);
    for (p, bulge) in points {
        tags.place(10, *p);
        if *bulge != 0.0 {
            self::bulge(tags, *bulge);
        }
    }
}

/// Writes a circle, an ellipse or a part of one; parts run counter-clockwise.
fn arc(tags: &mut Tags, to: &Target<'_>, arc: &EllipticArc) {
    let (start, end) = match arc.turn < 0.0 {
        true => (arc.start + arc.turn, arc.start),
        false => (arc.start, arc.start + arc.turn),
    };
    if arc.is_circular() {
        let kind = if arc.is_whole() { "CIRCLE" } else { "ARC" };
        begin(tags, kind, to.layer, to.pen);
        tags.class("AcDbCircle").place3(10, arc.center).length(40, arc.axis.length());
        if !arc.is_whole() {
            let first = libm::atan2(arc.axis.y, arc.axis.x);
            let degrees = |angle: f64| within_turn(first + angle).to_degrees();
            tags.class("AcDbArc").precise(50, degrees(start), DIGITS);
            tags.precise(51, degrees(end), DIGITS);
        }
        return;
    }
    begin(tags, "ELLIPSE", to.layer, to.pen);
    tags.class("AcDbEllipse").place3(10, arc.center).vector(11, arc.axis).real(31, 0.0);
    tags.real(210, 0.0).real(220, 0.0).real(230, 1.0).precise(40, arc.ratio, DIGITS);
    let (first, sweep) = match arc.is_whole() {
        true => (0.0, TAU),
        false => (within_turn(start), end - start),
    };
    tags.precise(41, first, DIGITS).precise(42, first + sweep, DIGITS);
}

/// Returns an angle in 0 … 2π.
fn within_turn(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).floor()
}

/// Writes cubic Bézier curves in a row as one spline, with knots three times each where they meet.
fn spline(tags: &mut Tags, to: &Target<'_>, row: &[(DVec2, &CurvePiece)]) {
    let Some((start, _)) = row.first() else { return };
    let mut control = vec![*start];
    for (_, piece) in row {
        if let CurvePiece::Cubic(a, b, end) = piece {
            control.extend([*a, *b, *end]);
        }
    }
    let last = row.len();
    let knots = (0..=last).flat_map(|i| {
        let times = if i == 0 || i == last { 4 } else { 3 };
        std::iter::repeat_n(i as f64, times)
    });
    let knots: Vec<f64> = knots.collect();
    begin(tags, "SPLINE", to.layer, to.pen);
    // 8: it is planar.
    tags.class("AcDbSpline").real(210, 0.0).real(220, 0.0).real(230, 1.0).int(70, 8).int(71, 3);
    tags.int(72, knots.len() as i64).int(73, control.len() as i64).int(74, 0);
    knots.iter().for_each(|knot| {
        tags.real(40, *knot);
    });
    control.iter().for_each(|p| {
        tags.place3(10, *p);
    });
}
