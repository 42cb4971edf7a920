//! Circular arcs through the ends of a run, and circles around points.

use super::measure::{Run, forwards};
use super::{EXACT, joined};
use crate::math::DVec2;
use crate::target::EllipticArc;
use std::f64::consts::TAU;

/// The fewest chords of a circular arc.
pub(super) const LEAST: usize = 4;

/// Largest turn of an arc: a curve that ends where it began is a whole circle.
const FURTHEST: f64 = TAU - 0.05;

/// Returns the arc that contains all points of a run exactly. `turned` is the sum of the turns between its ends.
pub(super) fn exact(run: &Run<'_>, turned: f64, tolerance: f64) -> Option<EllipticArc> {
    let middle = run.points[run.points.len() / 2];
    let found = arc(run.first(), middle, run.last(), turned)?;
    run.is_near(&found, tolerance * EXACT).then_some(found)
}

/// Returns an arc between the ends of a run that all its points are near to: that through the middle one, moved to
/// where the errors on both sides are equal.
pub(super) fn loose(run: &Run<'_>, turned: f64, tolerance: f64) -> Option<EllipticArc> {
    let (first, last) = (run.first(), run.last());
    let middle = run.points[run.points.len() / 2];
    let through = arc(first, middle, last, turned)?;
    let radius = through.axis.length();
    let (mut least, mut most) = (0.0_f64, 0.0_f64);
    for p in &*run.points {
        let off = p.distance(through.center) - radius;
        (least, most) = (least.min(off), most.max(off));
    }
    let out = (middle - through.center).normalize_or_zero();
    let found = arc(first, middle + out * ((least + most) * 0.5), last, turned)?;
    run.is_near(&found, tolerance).then_some(found)
}

/// Returns the arc between two points through a third one, which turns as `turned` says.
fn arc(first: DVec2, middle: DVec2, last: DVec2, turned: f64) -> Option<EllipticArc> {
    let center = center(first, middle, last)?;
    let (a, b) = (first - center, last - center);
    let turn = forwards(libm::atan2(a.perp_dot(b), a.dot(b)), turned);
    let is_one = turned != 0.0 && turned.abs() < FURTHEST && turn.abs() < FURTHEST;
    // The turns inside cover all chords except half of the first and half of the last.
    (is_one && turn.abs() >= turned.abs() * 0.5).then_some(EllipticArc {
        center,
        axis: a,
        ratio: 1.0,
        start: 0.0,
        turn,
    })
}

/// Returns the middle of the circle through three points.
fn center(a: DVec2, b: DVec2, c: DVec2) -> Option<DVec2> {
    let (ab, ac) = (b - a, c - a);
    let twice = 2.0 * ab.perp_dot(ac);
    let offset = (ac.perp() * -ab.length_squared() + ab.perp() * ac.length_squared()) / twice;
    // Beyond this, the centre depends on rounding alone.
    let is_near = offset.length_squared() < 1e12 * ac.length_squared().max(ab.length_squared());
    is_near.then_some(a + offset)
}

/// Returns the circle around all points of a closed run that has the least squares of its equation's errors (Kåsa).
pub(super) fn whole(run: &Run<'_>, turned: f64) -> Option<EllipticArc> {
    let points = run.points.get(1..)?;
    let middle = points.iter().sum::<DVec2>() / points.len() as f64;
    let (mut xx, mut xy, mut yy, mut right) = (0.0, 0.0, 0.0, DVec2::ZERO);
    for p in points {
        let v = *p - middle;
        (xx, xy, yy) = (xx + v.x * v.x, xy + v.x * v.y, yy + v.y * v.y);
        right += v * (v.length_squared() * 0.5);
    }
    let determinant = xx * yy - xy * xy;
    let off = DVec2::new(right.x * yy - right.y * xy, right.y * xx - right.x * xy) / determinant;
    let radius = (off.length_squared() + (xx + yy) / points.len() as f64).sqrt();
    let center = middle + off;
    let axis = (run.first() - center).normalize_or_zero() * radius;
    let arc = EllipticArc { center, axis, ratio: 1.0, start: 0.0, turn: TAU.copysign(turned) };
    (center.is_finite() && radius > 0.0 && radius.is_finite()).then_some(arc)
}

/// Returns an arc that ends one point earlier or later than a run's, moved as [`joined`] does.
pub(super) fn prolonged(arc: &EllipticArc, run: &Run<'_>, tolerance: f64) -> Option<EllipticArc> {
    let at = |p: DVec2| super::measure::angle_of(arc, p);
    let start = at(run.first());
    let turn = forwards(at(run.last()) - start, arc.turn);
    let turn = if turn.abs() > TAU { turn - TAU.copysign(turn) } else { turn };
    let longer = EllipticArc { start, turn, ..*arc };
    let is_longer = turn.abs() >= arc.turn.abs() && turn.abs() < FURTHEST;
    joined(longer, run, tolerance).filter(|found| is_longer && run.is_near(found, tolerance))
}
