//! Ellipses around points.

use super::measure::{Run, angle_of, forwards};
use super::{EXACT, joined};
use crate::math::DVec2;
use crate::target::EllipticArc;
use std::f64::consts::{PI, TAU};

/// Smallest ratio of an ellipse's axes: the ends of flatter ones are corners.
const FLATTEST: f64 = 0.01;

/// Smallest turn of an ellipse: shorter arcs are ambiguous.
const LEAST_TURN: f64 = PI / 3.0;

/// Returns the elliptical arc that contains all points of a run exactly. `turned` is the sum of the turns between its
/// ends.
pub(super) fn exact(run: &Run<'_>, turned: f64, tolerance: f64) -> Option<EllipticArc> {
    if turned.abs() >= TAU - 0.05 {
        return None;
    }
    let whole = whole(run, turned)?;
    let start = angle_of(&whole, run.first());
    let turn = forwards(angle_of(&whole, run.last()) - start, turned);
    let turn = if turn.abs() > TAU { turn - TAU.copysign(turn) } else { turn };
    let arc = EllipticArc { start, turn, ..whole };
    let is_near = run.is_near(&arc, tolerance * EXACT);
    is_near.then(|| joined(arc, run, tolerance)).flatten()
}

/// Returns whether a run that turns so far determines its ellipse.
pub(super) fn is_certain(turned: f64) -> bool {
    turned.abs() > LEAST_TURN
}

/// Returns the ellipse whose equation the points of a run fulfil best: x² + y² + d (x² − y²) + e xy + f x + g y + h =
/// 0, by least squares. It begins where the run does.
pub(super) fn whole(run: &Run<'_>, turned: f64) -> Option<EllipticArc> {
    let count = run.points.len() as f64;
    let middle = run.points.iter().sum::<DVec2>() / count;
    let spread = run.points.iter().map(|p| p.distance_squared(middle)).sum::<f64>() / count;
    let size = spread.sqrt();
    if !(size > 0.0 && size.is_finite()) {
        return None;
    }
    let mut system = [[0.0; 6]; 5];
    for p in &*run.points {
        let DVec2 { x, y } = (*p - middle) / size;
        let terms = [x * x - y * y, x * y, x, y, 1.0, -(x * x + y * y)];
        for (row, a) in system.iter_mut().zip(terms) {
            row.iter_mut().zip(terms).for_each(|(sum, b)| *sum += a * b);
        }
    }
    let [d, e, f, g, h] = solved(system)?;
    // The conic a x² + e xy + c y² + f x + g y + h = 0.
    let (a, c) = (1.0 + d, 1.0 - d);
    let determinant = 4.0 * a * c - e * e;
    if determinant.is_nan() || determinant <= 0.0 {
        return None;
    }
    let center = DVec2::new(e * g - 2.0 * c * f, e * f - 2.0 * a * g) / determinant;
    let level = -(h + 0.5 * (f * center.x + g * center.y));
    // The halves of the sum and of the difference of the eigenvalues.
    let (half, apart) = (1.0, (d * d + e * e * 0.25).sqrt());
    let (longer, shorter) = ((level / (half - apart)).sqrt(), (level / (half + apart)).sqrt());
    let turned_by = 0.5 * libm::atan2(-e, -2.0 * d);
    let (sin, cos) = libm::sincos(turned_by);
    let ratio = shorter / longer;
    if !(FLATTEST..=1.0).contains(&ratio) || !longer.is_finite() {
        return None;
    }
    let axis = DVec2::new(cos, sin) * (longer * size);
    let turn = TAU.copysign(turned);
    let arc = EllipticArc { center: middle + center * size, axis, ratio, start: 0.0, turn };
    Some(EllipticArc { start: angle_of(&arc, run.first()), ..arc })
}

/// Solves five linear equations, the right side last in each row, by Gauss's elimination with the largest pivots.
fn solved(mut rows: [[f64; 6]; 5]) -> Option<[f64; 5]> {
    for k in 0..5 {
        let pivot = (k..5).max_by(|a, b| rows[*a][k].abs().total_cmp(&rows[*b][k].abs()))?;
        rows.swap(k, pivot);
        let first = rows[k];
        if first[k] == 0.0 || !first[k].is_finite() {
            return None;
        }
        for row in &mut rows[k + 1..] {
            let by = row[k] / first[k];
            row.iter_mut().zip(first).for_each(|(v, f)| *v -= by * f);
        }
    }
    let mut found = [0.0; 5];
    for k in (0..5).rev() {
        let known: f64 = (k + 1..5).map(|i| rows[k][i] * found[i]).sum();
        found[k] = (rows[k][5] - known) / rows[k][k];
    }
    found.iter().all(|v| v.is_finite()).then_some(found)
}
