//! Dashes: a path cut at their lengths. Lengths of curves are measured by kurbo.

use kurbo::{Affine, BezPath, PathEl, Point};

use super::{Cap, Stroke};
use crate::curve::{Path, PathElement, chain};
use crate::math::DVec2;

/// Largest number of dashes and gaps of a path; with more the line is drawn solid.
const MAX_DASHES: f64 = 100_000.0;

/// Number of dashes and gaps above which lengths are measured along chords, not along curves.
const MAX_MEASURED: f64 = 2000.0;

/// Paths that are longer are made this long while they are cut into dashes.
const MEASURED: f64 = 1e4;

/// Distance of control points below which curves are treated as lines: the squares of their lengths may underflow, and
/// kurbo would divide them into endless dashes.
const SHORTEST: f64 = 1e-9;

/// Length of the lines that stand for dots (dashes of zero length with round or square caps), as a share of the width:
/// too short to be seen, long enough to have a direction.
const DOT: f64 = 1e-4;

/// Returns whether a path has too many dashes and gaps and is drawn solid.
pub(super) fn are_too_many(path: impl Iterator<Item = PathElement>, stroke: &Stroke) -> bool {
    period(stroke) > 0.0
        && count(control_length(&path.map(to_kurbo).collect()), stroke) >= MAX_DASHES
}

fn period(stroke: &Stroke) -> f64 {
    stroke.dashes.iter().sum()
}

/// Returns the dashes and gaps on a length.
fn count(length: f64, stroke: &Stroke) -> f64 {
    length / period(stroke) * stroke.dashes.len() as f64
}

/// Returns whether all dashes are dots, whose corners are round whatever the join.
pub(super) fn only_dots(stroke: &Stroke) -> bool {
    stroke.cap != Cap::Butt && repeated(&stroke.dashes).step_by(2).all(|d| d == 0.0)
}

/// Returns the lengths, twice if their number is odd, as SVG does, so that dashes and gaps change places.
fn repeated(dashes: &[f64]) -> impl Iterator<Item = f64> {
    let times = if dashes.len() % 2 == 1 { 2 } else { 1 };
    dashes.iter().copied().cycle().take(times * dashes.len())
}

/// Returns the dashes of a path of finite points; `None` if it stays solid: without dashes, or with
/// too many.
pub(super) fn dashed(
    path: impl Iterator<Item = PathElement>,
    stroke: &Stroke,
    tolerance: f64,
) -> Option<Path> {
    if period(stroke) <= 0.0 {
        return None;
    }
    let source: BezPath = with_ends(path.map(to_kurbo))
        .map(|(start, element, end)| match element {
            PathEl::QuadTo(..) | PathEl::CurveTo(..) if chain_length(start, element) < SHORTEST => {
                PathEl::LineTo(end)
            }
            _ => element,
        })
        .collect();
    let source = with_dots(&source, (stroke.cap != Cap::Butt).then_some(stroke.width));
    let length = control_length(&source);
    let count = count(length, stroke);
    if !(length > 0.0 && count < MAX_DASHES) {
        return None;
    }
    let mut dashes: Vec<f64> = repeated(&stroke.dashes).collect();
    if stroke.cap != Cap::Butt {
        lengthen_dots(&mut dashes, stroke.width * DOT);
    }
    let offset = stroke.dash_offset.rem_euclid(dashes.iter().sum());
    // kurbo measures to a fixed accuracy, which takes for ever on paths much longer than this.
    let scale = libm::exp2(-libm::ceil(libm::log2((length / MEASURED).max(1.0))));
    let source = if count < MAX_MEASURED { source } else { chords(&source, length, tolerance) };
    dashes.iter_mut().for_each(|d| *d *= scale);
    let small = Affine::scale(scale) * source;
    let start = small.elements().first().copied();
    let mut dashed = kurbo::dash(small.into_iter(), offset * scale, &dashes).peekable();
    // If a dash ends at the start up to rounding, the following dash comes without its first point.
    let start = start.filter(|_| !matches!(dashed.peek(), None | Some(PathEl::MoveTo(_))));
    let mut out = Path::new();
    for element in start.into_iter().chain(dashed) {
        out.push(from_kurbo(Affine::scale(1.0 / scale) * element));
    }
    Some(out)
}

/// Returns the curves as chains of chords.
fn chords(path: &BezPath, length: f64, tolerance: f64) -> BezPath {
    let tolerance = tolerance.max(length * 1e-7);
    let (mut out, mut points) = (BezPath::new(), Vec::new());
    for (start, element, _) in with_ends(path.iter()) {
        match element {
            PathEl::QuadTo(..) | PathEl::CurveTo(..) => {
                chain(DVec2::new(start.x, start.y), &from_kurbo(element), tolerance, &mut points);
                points.drain(..).for_each(|p| out.line_to((p.x, p.y)));
            }
            _ => out.push(element),
        }
    }
    out
}

/// Returns the elements with the points where they start and where they end; every contour begins with its start.
fn with_ends(
    elements: impl Iterator<Item = PathEl>,
) -> impl Iterator<Item = (Point, PathEl, Point)> {
    let (mut first, mut at) = (Point::ORIGIN, Point::ORIGIN);
    elements.map(move |element| {
        if let PathEl::MoveTo(p) = element {
            first = p;
        }
        let start = std::mem::replace(&mut at, element.end_point().unwrap_or(first));
        (start, element, at)
    })
}

/// Returns the total length of the lines through all control points, an upper bound of the curves' length.
fn control_length(path: &BezPath) -> f64 {
    with_ends(path.iter())
        .map(|(start, element, end)| match element {
            PathEl::ClosePath => start.distance(end),
            _ => chain_length(start, element),
        })
        .sum()
}

/// Returns the length of one element that begins at a point; 0 for moves and closing elements.
fn chain_length(mut at: Point, element: PathEl) -> f64 {
    let chain = match element {
        PathEl::LineTo(p) => [p, p, p],
        PathEl::QuadTo(a, p) => [a, p, p],
        PathEl::CurveTo(a, b, p) => [a, b, p],
        PathEl::MoveTo(_) | PathEl::ClosePath => return 0.0,
    };
    let mut sum = 0.0;
    for p in chain {
        sum += at.distance(p);
        at = p;
    }
    sum
}

/// Lengthens dashes without length, at the cost of the gap after them, where it has enough.
fn lengthen_dots(dashes: &mut [f64], length: f64) {
    for pair in dashes.chunks_exact_mut(2).filter(|p| p[0] == 0.0 && p[1] > length) {
        pair[0] += length;
        pair[1] -= length;
    }
}

/// Returns the path with each contour that stays in one point replaced by a line of a dot's length along x, as SVG
/// requires; contours with only moves give no dot. Without a width there are no dots: kurbo would begin the next dash
/// at the origin.
fn with_dots(path: &BezPath, width: Option<f64>) -> BezPath {
    let mut out = BezPath::new();
    let starts = |e: &PathEl| matches!(e, PathEl::MoveTo(_));
    for contour in path.elements().chunk_by(|_, next| !starts(next)) {
        let start = contour.first().and_then(PathEl::end_point);
        match start {
            Some(p)
                if contour.len() > 1
                    && control_length(&contour.iter().copied().collect()) == 0.0 =>
            {
                if let Some(width) = width {
                    out.move_to((p.x - 0.5 * DOT * width, p.y));
                    out.line_to((p.x + 0.5 * DOT * width, p.y));
                }
            }
            _ => out.extend(contour.iter().copied()),
        }
    }
    out
}

fn to_kurbo(element: PathElement) -> PathEl {
    let at = |p: DVec2| Point::new(p.x, p.y);
    match element {
        PathElement::MoveTo(p) => PathEl::MoveTo(at(p)),
        PathElement::LineTo(p) => PathEl::LineTo(at(p)),
        PathElement::QuadTo(c, p) => PathEl::QuadTo(at(c), at(p)),
        PathElement::CubicTo(a, b, p) => PathEl::CurveTo(at(a), at(b), at(p)),
        PathElement::Close => PathEl::ClosePath,
    }
}

fn from_kurbo(element: PathEl) -> PathElement {
    let at = |p: Point| DVec2::new(p.x, p.y);
    match element {
        PathEl::MoveTo(p) => PathElement::MoveTo(at(p)),
        PathEl::LineTo(p) => PathElement::LineTo(at(p)),
        PathEl::QuadTo(c, p) => PathElement::QuadTo(at(c), at(p)),
        PathEl::CurveTo(a, b, p) => PathElement::CubicTo(at(a), at(b), at(p)),
        PathEl::ClosePath => PathElement::Close,
    }
}
