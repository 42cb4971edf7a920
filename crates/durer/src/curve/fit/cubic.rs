//! Cubic Bézier curves near to points.
//!
//! P. J. Schneider, *An algorithm for automatically fitting digitized curves*, Graphics Gems, 1990: the directions at
//! both ends are given, least squares determine the distances of the control points along them, and Newton's method
//! moves the parameters of the points. The control polygon bounds the distance from the polyline between its points.

use super::measure::Run;
use crate::math::DVec2;

/// Number of times that parameters are moved; more hardly ever helps.
const ROUNDS: usize = 4;

/// An error that is this many times too large is not mended by moving parameters.
const HOPELESS: f64 = 6.0;

/// The unit directions in which a curve leaves its start and reaches its end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ways {
    pub first: DVec2,
    pub last: DVec2,
}

/// Returns the two control points of a cubic curve between the ends of a run that is nowhere further from it than
/// allowed, and no point of the run further from the curve than `tolerance`.
pub(super) fn near(run: &Run<'_>, ways: Ways, tolerance: f64) -> Option<[DVec2; 2]> {
    let mut parameters = by_length(&run.points)?;
    for _ in 0..ROUNDS {
        let curve = least_squares(&run.points, &parameters, ways)?;
        let error = largest_error(&run.points, &parameters, &curve);
        if error <= tolerance && is_inside(run, &parameters, &curve) {
            return Some([curve[1], curve[2]]);
        }
        if error.is_nan() || error > tolerance * HOPELESS {
            return None;
        }
        move_parameters(&run.points, &mut parameters, &curve)?;
    }
    None
}

fn by_length(points: &[DVec2]) -> Option<Vec<f64>> {
    let mut along = Vec::with_capacity(points.len());
    let mut length = 0.0;
    along.push(length);
    for w in points.windows(2) {
        length += w[0].distance(w[1]);
        along.push(length);
    }
    along.iter_mut().for_each(|a| *a /= length);
    (length > 0.0).then_some(along)
}

/// Returns the values of the four Bernstein polynomials.
fn weights(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

fn at(curve: &[DVec2; 4], t: f64) -> DVec2 {
    curve.iter().zip(weights(t)).map(|(p, w)| *p * w).sum()
}

fn least_squares(points: &[DVec2], parameters: &[f64], ways: Ways) -> Option<[DVec2; 4]> {
    let (first, last) = (*points.first()?, *points.last()?);
    let (one, other) = (ways.first, -ways.last);
    let (mut c00, mut c01, mut c11, mut x0, mut x1) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (p, &t) in points.iter().zip(parameters) {
        let [w0, w1, w2, w3] = weights(t);
        let (a, b) = (one * w1, other * w2);
        let left = *p - first * (w0 + w1) - last * (w2 + w3);
        (c00, c01, c11) = (c00 + a.dot(a), c01 + a.dot(b), c11 + b.dot(b));
        (x0, x1) = (x0 + left.dot(a), x1 + left.dot(b));
    }
    let determinant = c00 * c11 - c01 * c01;
    let (alpha, beta) = ((x0 * c11 - x1 * c01) / determinant, (c00 * x1 - c01 * x0) / determinant);
    let across = first.distance(last);
    // A curve whose ends point backwards has a loop or a cusp.
    let is_sound = |v: f64| v > across * 1e-3 && v.is_finite();
    (is_sound(alpha) && is_sound(beta)).then_some([
        first,
        first + one * alpha,
        last + other * beta,
        last,
    ])
}

fn largest_error(points: &[DVec2], parameters: &[f64], curve: &[DVec2; 4]) -> f64 {
    let errors = points.iter().zip(parameters).map(|(p, t)| p.distance_squared(at(curve, *t)));
    errors.fold(0.0, f64::max).sqrt()
}

/// Moves parameters by Newton's step towards the foot of each point on the curve; `None` if the points would not
/// follow each other.
fn move_parameters(points: &[DVec2], parameters: &mut [f64], curve: &[DVec2; 4]) -> Option<()> {
    let [a, b, c, d] = *curve;
    let first = [b - a, c - b, d - c].map(|v| v * 3.0);
    let second = [first[1] - first[0], first[2] - first[1]].map(|v| v * 2.0);
    let inner = 1..points.len() - 1;
    for i in inner {
        let t = parameters[i];
        let s = 1.0 - t;
        let off = at(curve, t) - points[i];
        let speed = first[0] * (s * s) + first[1] * (2.0 * s * t) + first[2] * (t * t);
        let turn = second[0] * s + second[1] * t;
        let slope = speed.length_squared() + off.dot(turn);
        if slope > 0.0 {
            parameters[i] = (t - off.dot(speed) / slope).clamp(0.0, 1.0);
        }
    }
    parameters.windows(2).all(|w| w[0] < w[1]).then_some(())
}

/// Returns whether each part of the curve between the parameters of two points stays as near to their chord as is
/// allowed.
///
/// The distance to a chord is a convex function, so on the curve it is at most the weighted mean of the control points'
/// distances: here of the larger one at the ends and the larger one between them.
fn is_inside(run: &Run<'_>, parameters: &[f64], curve: &[DVec2; 4]) -> bool {
    let chords = run.points.windows(2).zip(parameters.windows(2)).zip(run.allowed.iter());
    chords.into_iter().all(|((ends, t), allowed)| {
        let (a, b) = (t[0], t[1]);
        let part = [[a, a, a], [a, a, b], [a, b, b], [b, b, b]].map(|t| blossom(curve, t));
        let off = part.map(|p| distance(p, ends[0], ends[1]));
        let (outer, inner) = (off[0].max(off[3]), off[1].max(off[2]));
        outer.max(0.25 * outer + 0.75 * inner) <= *allowed
    })
}

/// Returns the polar form of the curve: its control points between two parameters are its values at
/// those.
fn blossom(curve: &[DVec2; 4], [r, s, t]: [f64; 3]) -> DVec2 {
    let [a, b, c, d] = *curve;
    let (ab, bc, cd) = (a.lerp(b, r), b.lerp(c, r), c.lerp(d, r));
    ab.lerp(bc, s).lerp(bc.lerp(cd, s), t)
}

/// Returns the distance from a point to a segment.
fn distance(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    p.distance(a + along * t)
}
