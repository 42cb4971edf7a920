//! The contours of paths as curves of sheets.

use crate::curve::{Path, PathElement};
use crate::math::{DVec2, Rect};
use crate::target::{Curve, CurvePiece};

/// Returns the contours of a path that have an extent, all of them closed where areas are meant.
pub(super) fn contours(path: &Path, areas: bool) -> Vec<Curve> {
    let mut found: Vec<Curve> = Vec::new();
    let mut open: Option<Curve> = None;
    let mut end = |open: &mut Option<Curve>, closes: bool| {
        let Some(mut curve) = open.take().filter(|curve| !curve.pieces.is_empty()) else { return };
        if closes || areas {
            if curve.end() != curve.start {
                curve.pieces.push(CurvePiece::Line(curve.start));
            }
            curve.closed = true;
        }
        let points = curve.pieces.iter().map(CurvePiece::end).chain([curve.start]);
        if points.into_iter().all(DVec2::is_finite) {
            found.push(curve);
        }
    };
    let mut start = DVec2::ZERO;
    for element in path.elements() {
        let piece = match *element {
            PathElement::MoveTo(p) => {
                end(&mut open, false);
                start = p;
                open = Some(Curve { start: p, pieces: Vec::new(), closed: false });
                continue;
            }
            PathElement::Close => {
                end(&mut open, true);
                continue;
            }
            PathElement::LineTo(p) => CurvePiece::Line(p),
            PathElement::QuadTo(c, p) => {
                let from = open.as_ref().map_or(start, Curve::end);
                CurvePiece::Cubic(from.lerp(c, 2.0 / 3.0), p.lerp(c, 2.0 / 3.0), p)
            }
            PathElement::CubicTo(a, b, p) => CurvePiece::Cubic(a, b, p),
        };
        // After its end, a contour continues at its start.
        let curve = open.get_or_insert(Curve { start, pieces: Vec::new(), closed: false });
        curve.pieces.push(piece);
    }
    end(&mut open, false);
    found
}

/// Returns the points of a straight curve; of a closed one, the first is not repeated.
pub(super) fn corners(curve: &Curve) -> Vec<DVec2> {
    let mut points: Vec<DVec2> =
        std::iter::once(curve.start).chain(curve.pieces.iter().map(CurvePiece::end)).collect();
    if curve.closed && points.len() > 1 {
        points.pop();
    }
    points
}

/// Returns the rectangle that a path is, if it is an upright one.
pub(super) fn upright(path: &Path) -> Option<Rect> {
    let curves = contours(path, true);
    let [curve] = &curves[..] else { return None };
    let points = corners(curve);
    let &[a, b, c, d] = &points[..] else { return None };
    let is_upright = (a.x == b.x && b.y == c.y && c.x == d.x && d.y == a.y)
        || (a.y == b.y && b.x == c.x && c.y == d.y && d.x == a.x);
    if is_upright && curve.is_straight() { Rect::around(points) } else { None }
}
