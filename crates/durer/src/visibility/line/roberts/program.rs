//! The linear program of one line and one body.

use super::body::ConvexBody;
use super::step::{Bound, Values};
use crate::math::{DVec3, Plane};

/// Parameters that differ by less are one.
const SAME: f64 = 1e-9;

/// The eye in homogeneous coordinates: a point, or with w = 0 a direction towards it.
#[derive(Debug, Clone, Copy)]
pub struct EyePoint {
    pub at: DVec3,
    pub w: f64,
}

impl EyePoint {
    /// Returns the value of a plane at the eye: positive inside.
    pub fn value(&self, plane: &Plane) -> f64 {
        plane.normal.dot(self.at) + plane.distance * self.w
    }
}

/// The inequalities of a line before a body, and the part of the line that they leave.
pub struct Program {
    values: Vec<Values>,
    /// Values below this are zero.
    small: f64,
    /// The part of the line that may be hidden.
    part: [f64; 2],
}

impl Program {
    /// Evaluates the planes of a body at the ends of a line and at the eye.
    pub fn new(body: &ConvexBody, [p, q]: [DVec3; 2], eye: &EyePoint, small: f64) -> Self {
        let whole = |v: f64| if v.abs() <= small { 0.0 } else { v };
        let values = |plane: &Plane| Values {
            start: whole(plane.evaluate(p)),
            end: whole(plane.evaluate(q)),
            eye: whole(eye.value(plane)),
        };
        Self { values: body.planes().iter().map(values).collect(), small, part: [0.0, 1.0] }
    }

    /// Returns the values of the planes in their order.
    pub fn values(&self) -> &[Values] {
        &self.values
    }

    /// Returns the first plane that has the line, and all between it and the eye, on its outer side or on it.
    pub fn apart(&self) -> Option<usize> {
        self.values.iter().position(|v| v.start <= 0.0 && v.end <= 0.0 && v.eye <= 0.0)
    }

    /// Finds the part of the line that is hidden: where some α ≥ 0 makes h = start + t (end − start) + α · eye positive
    /// for all planes. α is eliminated: planes whose value at the eye is positive bound it from below, those where it
    /// is negative from above, and each lower bound must be less than each upper one.
    pub fn hidden(mut self, mut report: impl FnMut(Bound)) -> Option<[f64; 2]> {
        let lower = |v: &Values| v.eye > 0.0;
        for far in 0..self.values.len() {
            let upper = self.values[far];
            if lower(&upper) {
                continue;
            }
            // α ≥ 0 itself is a lower bound; a plane seen edge-on bounds t alone.
            let ends = [upper.start, upper.end];
            self.restrict(ends, self.small, [None, Some(far)], &mut report)?;
            for near in (0..self.values.len()).filter(|_| upper.eye < 0.0) {
                let v = self.values[near];
                if !lower(&v) {
                    continue;
                }
                let sum = |near: f64, far: f64| v.eye * far - upper.eye * near;
                let sums = [sum(v.start, upper.start), sum(v.end, upper.end)];
                let small = self.small * (v.eye - upper.eye);
                self.restrict(sums, small, [Some(near), Some(far)], &mut report)?;
            }
        }
        let [from, to] = self.part;
        (to - from > SAME).then_some(self.part)
    }

    /// Leaves the part where a value that is linear along the line is positive; `None` if nothing is left.
    fn restrict(
        &mut self,
        ends: [f64; 2],
        small: f64,
        planes: [Option<usize>; 2],
        report: &mut impl FnMut(Bound),
    ) -> Option<()> {
        let [start, end] = ends.map(|v| if v.abs() <= small { 0.0 } else { v });
        if start > 0.0 && end > 0.0 {
            return Some(());
        }
        if start <= 0.0 && end <= 0.0 {
            report(Bound { planes, t: None, part: self.part });
            return None;
        }
        let t = start / (start - end);
        let before = self.part;
        if end > start {
            self.part[0] = self.part[0].max(t);
        } else {
            self.part[1] = self.part[1].min(t);
        }
        if self.part != before {
            report(Bound { planes, t: Some(t), part: self.part });
        }
        (self.part[1] - self.part[0] > SAME).then_some(())
    }
}
