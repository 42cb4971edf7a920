//! Polylines to lines, circles, ellipses, arcs of both and cubic Bézier curves within a tolerance.
//!
//! A polyline is divided at its corners and at points that are to be kept. A closed one without such points is tried as
//! a whole circle or ellipse. In the rest, arcs with points almost exactly on a circle or ellipse are found first, as
//! they result from meshed arcs. The stretches between them are fitted greedily: from each point the longest circular
//! arc or cubic curve that fits, or a line where that is about as long. Lengths are found by doubling and halving.
//!
//! Sources: circles through three points and, for whole ones, I. Kåsa, *A circle fitting procedure and its error
//! analysis*, IEEE Transactions on Instrumentation and Measurement, 1976 (`circle`); ellipses by linear least squares
//! of the conic, its trace set to 1, after F. L. Bookstein, *Fitting conic sections to scattered data*, Computer
//! Graphics and Image Processing, 1979 (`ellipse`); cubics after P. J. Schneider, *An algorithm for automatically
//! fitting digitized curves*, Graphics Gems, 1990 (`cubic`). Deviations: Schneider divides where the error is largest;
//! the greedy way costs O(n log n) for any input.

mod bends;
mod circle;
mod cubic;
mod ellipse;
mod loops;
mod measure;
mod rest;
mod stretch;

use crate::math::DVec2;
use crate::target::{Curve, CurvePiece, EllipticArc};
use bends::Bends;
use measure::Run;

/// Options for fitting curves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Largest distance of the polyline's points from the curve, and of the curve from the polyline, in the unit of the
    /// points. 0.02 mm on paper is less than pens, lasers and mills resolve; ten times as much is visible on paper. The
    /// number of pieces grows slowly as it gets smaller. With 0 or less the polyline is returned unchanged.
    pub tolerance: f64,
    /// True if polylines that turn regularly represent round curves. Between two of their points, the curve may then
    /// leave their chord by as much as an arc through the points does. They turn one way, five times or more in a row,
    /// by at most 30° and by similar angles, over chords of similar lengths: a polygon of twelve sides is round, one of
    /// eight is not. Where two such polylines of one circle cross each other, the crossings, where they turn little,
    /// may be inside the circle by as much as the chords.
    pub round: bool,
}

/// Polylines of fewer points are left as they are.
const FEWEST: usize = 5;

/// Part of the tolerance within which points count as on an arc.
const EXACT: f64 = 0.05;

/// Part of the tolerance within which the ends of a run count as the ends of an arc.
const JOINED: f64 = 0.005;

/// A polyline to be fitted.
#[derive(Debug, Clone, Copy)]
pub struct Polyline<'a> {
    /// The points; the first one of a closed polyline is not repeated.
    pub points: &'a [DVec2],
    /// True if the last point is joined to the first.
    pub closed: bool,
    /// True if a point stays the end of a piece, for each point; if there are fewer, those beyond need not.
    pub kept: &'a [bool],
}

/// A fitted curve, and the points that it replaces.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// The curve.
    pub curve: Curve,
    /// Index of the first point of each piece.
    pub from: Vec<usize>,
}

/// Fits lines and curves to a polyline. Its ends and the points to be kept are ends of pieces, to the bit; a closed
/// polyline gives a closed curve. `is_met` returns whether another line ends on the chord between two points: the curve
/// stays within the tolerance of such chords, however round the polyline is.
///
/// `None` if the polyline has fewer than two points, or one that is not finite.
///
/// ```
/// use durer::curve::fit::{Options, Polyline, fit};
/// use durer::math::DVec2;
/// use durer::target::CurvePiece;
/// let points: Vec<DVec2> =
///     (0..40).map(|i| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 40.0) * 8.0).collect();
/// let polygon = Polyline { points: &points, closed: true, kept: &[] };
/// let options = Options { tolerance: 0.02, round: true };
/// let fitted = fit(polygon, |_, _| false, options).unwrap();
/// let circle = fitted.curve.whole().unwrap();
/// assert!((circle.axis.length() - 8.0).abs() < 1e-9);
/// ```
pub fn fit(
    polyline: Polyline<'_>,
    is_met: impl Fn(DVec2, DVec2) -> bool,
    options: Options,
) -> Option<Fitted> {
    let Polyline { points, closed, .. } = polyline;
    let closed = closed && points.len() > 2;
    if points.len() < 2 || !points.iter().all(|p| p.is_finite()) {
        return None;
    }
    let is_exact = options.tolerance.is_nan() || options.tolerance <= 0.0;
    if points.len() < FEWEST || is_exact {
        return Some(straight(points, closed));
    }
    let met = |i: usize| is_met(points[i], points[(i + 1) % points.len()]);
    let bends = Bends::new(points, closed, polyline.kept, &met, options);
    if closed && let Some(whole) = loops::whole(&bends) {
        return Some(whole);
    }
    let bends = bends.started();
    let mut pieces: Vec<(usize, CurvePiece)> = Vec::new();
    for ends in bends.breaks.windows(2) {
        stretch::fit(&bends, ends[0], ends[1], &mut pieces);
    }
    let start = bends.points[0];
    let from = pieces.iter().map(|p| bends.original(p.0)).collect();
    let pieces = pieces.into_iter().map(|p| p.1).collect();
    Some(Fitted { curve: Curve { start, pieces, closed }, from })
}

/// Returns the polyline itself.
fn straight(points: &[DVec2], closed: bool) -> Fitted {
    let again = points.first().filter(|_| closed);
    let pieces: Vec<CurvePiece> =
        points.iter().skip(1).chain(again).map(|p| CurvePiece::Line(*p)).collect();
    let start = points.first().copied().unwrap_or_default();
    Fitted { from: (0..pieces.len()).collect(), curve: Curve { start, pieces, closed } }
}

/// Returns the largest `j` of `least..=end` for which `try_to` succeeds, with its result, assuming that it succeeds for
/// all smaller ones.
fn longest<T>(
    from: usize,
    least: usize,
    end: usize,
    mut try_to: impl FnMut(usize) -> Option<T>,
) -> Option<(usize, T)> {
    let mut step = least;
    let mut best = None;
    let mut limit = end;
    while from + step <= end {
        match try_to(from + step) {
            Some(found) => best = Some((from + step, found)),
            None => {
                limit = from + step - 1;
                break;
            }
        }
        step *= 2;
    }
    let mut low = best.as_ref()?.0;
    while low < limit {
        let middle = low + (limit - low).div_ceil(2);
        match try_to(middle) {
            Some(found) => (low, best) = (middle, Some((middle, found))),
            None => limit = middle - 1,
        }
    }
    best
}

/// Moves an arc, by turning and scaling it, so that it begins and ends in two points.
fn through(arc: &EllipticArc, start: DVec2, end: DVec2) -> Option<EllipticArc> {
    let (first, last) = (arc.at(arc.start), arc.at(arc.start + arc.turn));
    if arc.is_whole() {
        return Some(EllipticArc { center: arc.center + (start - first), ..*arc });
    }
    let (was, is) = (last - first, end - start);
    let scale = was.length_squared();
    if scale == 0.0 {
        return None;
    }
    // The quotient of two complex numbers.
    let by = DVec2::new(is.dot(was), was.perp_dot(is)) / scale;
    let moved = |v: DVec2| by.rotate(v);
    let arc =
        EllipticArc { center: start + moved(arc.center - first), axis: moved(arc.axis), ..*arc };
    (arc.center.is_finite() && arc.axis.is_finite()).then_some(arc)
}

/// Returns an arc that begins and ends where a run does: unchanged if it does so up to rounding, else moved.
fn joined(arc: EllipticArc, run: &Run<'_>, tolerance: f64) -> Option<EllipticArc> {
    let (first, last) = (arc.at(arc.start), arc.at(arc.start + arc.turn));
    let apart = first.distance(run.first()).max(last.distance(run.last()));
    if apart <= tolerance * JOINED {
        return Some(arc);
    }
    through(&arc, run.first(), run.last()).filter(|moved| run.is_near(moved, tolerance))
}

/// Returns the part of an arc between two points that are on it up to rounding.
pub(crate) fn between(
    arc: &EllipticArc,
    start: DVec2,
    end: DVec2,
    tolerance: f64,
) -> Option<EllipticArc> {
    let begin = measure::angle_of(arc, start);
    let turn = measure::forwards(measure::angle_of(arc, end) - begin, arc.turn);
    let part = EllipticArc { start: begin, turn, ..*arc };
    let off = part.at(begin).distance(start).max(part.at(begin + turn).distance(end));
    (off <= tolerance * JOINED && turn != 0.0).then_some(part)
}

/// Largest difference between arcs of one circle, as a part of the tolerance.
const SAME: f64 = 0.25;

/// Returns the part of a whole circle or ellipse that matches an arc from `start` to `end`, up to a small part of the
/// tolerance.
pub(crate) fn part_of(
    whole: &EllipticArc,
    arc: &EllipticArc,
    start: DVec2,
    end: DVec2,
    tolerance: f64,
) -> Option<EllipticArc> {
    let off = whole.center.distance(arc.center);
    let radii = (whole.radii() - arc.radii()).abs().max_element();
    if whole.is_circular() != arc.is_circular() || off + radii > tolerance * SAME {
        return None;
    }
    let begin = measure::angle_of(whole, start);
    let turn = measure::forwards(measure::angle_of(whole, end) - begin, arc.turn);
    let part =
        EllipticArc { start: begin, turn: if arc.is_whole() { arc.turn } else { turn }, ..*whole };
    let middle = |arc: &EllipticArc| arc.at(arc.start + arc.turn * 0.5);
    let ends = part.at(begin).distance(start).max(part.at(begin + part.turn).distance(end));
    let is_same = middle(&part).distance(middle(arc)) <= tolerance * SAME;
    (ends <= tolerance * JOINED && is_same).then_some(part)
}
