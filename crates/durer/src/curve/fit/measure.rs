//! The distance of arcs from a run of points.

use super::bends::Bends;
use crate::math::DVec2;
use crate::target::EllipticArc;
use std::borrow::Cow;
use std::f64::consts::TAU;

/// Some points in a row of a polyline.
pub(super) struct Run<'a> {
    /// Points that are not folds, and the ends.
    pub points: Cow<'a, [DVec2]>,
    /// Largest distances of the curve from the chords between them.
    pub allowed: Cow<'a, [f64]>,
    /// The folds between.
    pub folds: Vec<DVec2>,
}

impl<'a> Run<'a> {
    pub fn new(bends: &'a Bends, from: usize, to: usize) -> Self {
        if !(from + 1..to).any(|i| bends.is_fold(i)) {
            return Self::of_all(bends, from, to);
        }
        let (folds, inner): (Vec<usize>, Vec<usize>) =
            (from + 1..to).partition(|i| bends.is_fold(*i));
        let points = [&[from], &inner[..], &[to]].concat();
        let allowed = points[..points.len() - 1].iter().map(|i| bends.allowed[*i]).collect();
        Self {
            points: points.iter().map(|i| bends.points[*i]).collect(),
            allowed,
            folds: folds.iter().map(|i| bends.points[*i]).collect(),
        }
    }

    /// Returns a run in which folds are treated like all other points.
    pub fn of_all(bends: &'a Bends, from: usize, to: usize) -> Self {
        let (points, allowed) = (&bends.points[from..=to], &bends.allowed[from..to]);
        Self { points: points.into(), allowed: allowed.into(), folds: Vec::new() }
    }

    pub fn first(&self) -> DVec2 {
        self.points[0]
    }

    pub fn last(&self) -> DVec2 {
        self.points[self.points.len() - 1]
    }

    /// Returns whether all points are within `tolerance` of an arc, in order along it, and the arc leaves no chord by
    /// more than is allowed.
    pub fn is_near(&self, arc: &EllipticArc, tolerance: f64) -> bool {
        let has_folds = self.folds.iter().all(|fold| is_within(arc, *fold, tolerance));
        has_folds
            && if arc.is_circular() {
                self.is_near_circle(arc, tolerance)
            } else {
                self.is_near_ellipse(arc, tolerance)
            }
    }

    /// Returns whether all points are within `tolerance` of the line between the ends, in order along it.
    pub fn is_near_line(&self, tolerance: f64) -> bool {
        let (first, across) = (self.first(), self.last() - self.first());
        let length = across.length();
        let along = across / length;
        let off = |p: &DVec2| (*p - first).perp_dot(along).abs();
        let goes_on = |w: &[DVec2]| (w[1] - w[0]).dot(along) >= 0.0;
        length > 0.0
            && self.points.iter().all(|p| off(p) <= tolerance)
            && self.points.windows(2).all(goes_on)
    }

    fn is_near_circle(&self, arc: &EllipticArc, tolerance: f64) -> bool {
        let radius2 = arc.axis.length_squared();
        let radius = radius2.sqrt();
        let off = |p: &DVec2| (p.distance(arc.center) - radius).abs();
        let rise = |a: DVec2, b: DVec2| {
            // Near to a diameter the root says that the arc leaves the chord by a radius.
            radius - (radius2 - a.distance_squared(b) * 0.25).max(0.0).sqrt()
        };
        let turns = |a: DVec2, b: DVec2| (a - arc.center).perp_dot(b - arc.center) * arc.turn > 0.0;
        self.points.iter().all(|p| off(p) <= tolerance)
            && self.points.windows(2).zip(self.allowed.iter()).all(|(w, allowed)| {
                let ends = off(&w[0]).max(off(&w[1]));
                turns(w[0], w[1]) && rise(w[0], w[1]) + ends <= *allowed
            })
    }

    fn is_near_ellipse(&self, arc: &EllipticArc, tolerance: f64) -> bool {
        let mut angle = f64::NAN;
        let mut last_off = 0.0;
        for (i, p) in self.points.iter().enumerate() {
            let here = angle_of(arc, *p);
            let off = p.distance(arc.at(here));
            if off.is_nan() || off > tolerance {
                return false;
            }
            if let Some(k) = i.checked_sub(1) {
                let step = forwards(here - angle, arc.turn);
                let rise = rise(arc, angle, step, self.points[k], *p);
                if step.abs() > TAU / 4.0 || rise + f64::max(off, last_off) > self.allowed[k] {
                    return false;
                }
            }
            (angle, last_off) = (here, off);
        }
        true
    }
}

/// Returns whether a point is within an arc's ellipse, or outside by at most the tolerance.
fn is_within(arc: &EllipticArc, p: DVec2, tolerance: f64) -> bool {
    let on = arc.at(angle_of(arc, p));
    on.distance(arc.center) + tolerance >= p.distance(arc.center)
}

/// Returns the largest distance of an ellipse from the chord between two of its points.
fn rise(arc: &EllipticArc, angle: f64, step: f64, from: DVec2, to: DVec2) -> f64 {
    let middle = arc.at(angle + step * 0.5) - arc.center;
    let height = middle * (1.0 - libm::cos(step * 0.5));
    height.perp_dot((to - from).normalize_or_zero()).abs()
}

/// Returns the angle of a point on an arc's ellipse, measured like the arc's `start`.
pub(super) fn angle_of(arc: &EllipticArc, p: DVec2) -> f64 {
    let v = p - arc.center;
    libm::atan2(arc.axis.perp_dot(v) / arc.ratio, arc.axis.dot(v))
}

/// Returns an angle as a turn in the direction of another one: with its sign, less than a full turn.
pub(super) fn forwards(angle: f64, turn: f64) -> f64 {
    match angle {
        a if turn >= 0.0 && a < 0.0 => a + TAU,
        a if turn < 0.0 && a > 0.0 => a - TAU,
        a => a,
    }
}
