//! Bézier curves and patches of any degree, by de Casteljau's algorithm.
//!
//! P. de Casteljau, *Outillages méthodes calcul*, Citroën 1959; P. Bézier, 1962. Cost: O(n²) for degree n, stable
//! for all parameters in 0 … 1. Points may be in any space: pixels, world, or homogeneous for rational curves.

use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, DVec3, DVec4};
use crate::trace::{PseudocodeLine, Tracer};

/// The facts of de Casteljau's algorithm.
pub const INFO: Info = Info {
    name: "de-casteljau",
    title: "Bézier curves by de Casteljau's algorithm",
    authors: "Paul de Casteljau",
    year: 1959,
    source: "Outillages méthodes calcul, Citroën",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n²) per point for degree n",
    limits: "parameters in 0 … 1",
    pseudocode: &[
        "P_i^0 ← control point i, for i = 0 … n",
        "for level r = 1 … n:",
        "    for i = 0 … n − r:",
        "        // the point at t between two neighbours of the level below",
        "        P_i^r ← (1 − t) · P_i^(r−1) + t · P_(i+1)^(r−1)",
        "// one point remains",
        "return P_0^n",
        "// P_0^r and P_(n−r)^r are the control points of both parts",
    ],
};

/// Points that can be interpolated, as the control points of curves.
pub trait Point: Copy {
    /// Returns the point at `t` on the line from `self` (0) to `other` (1).
    fn mix(self, other: Self, t: f64) -> Self;
}

impl Point for f64 {
    fn mix(self, other: Self, t: f64) -> Self {
        self + (other - self) * t
    }
}

macro_rules! point {
    ($($vector:ty),+) => {$(
        impl Point for $vector {
            fn mix(self, other: Self, t: f64) -> Self {
                self.lerp(other, t)
            }
        }
    )+};
}
point!(DVec2, DVec3, DVec4);

/// One step: a point of a level of the triangle of intermediate points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step<P> {
    /// Level, 1 for the mixes of control points, up to the degree for the curve's point.
    pub level: usize,
    /// Index in the level.
    pub index: usize,
    /// The point.
    pub point: P,
}

impl<P> PseudocodeLine for Step<P> {
    fn line(&self) -> usize {
        5
    }
}

/// Returns the point of the curve at parameter `t`; `None` without control points.
///
/// ```
/// use durer::curve::bezier::de_casteljau;
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// let control = [DVec2::ZERO, DVec2::new(1.0, 2.0), DVec2::new(2.0, 0.0)];
/// assert_eq!(de_casteljau(&control, 0.5, &mut NoTrace), Some(DVec2::new(1.0, 1.0)));
/// ```
pub fn de_casteljau<P: Point>(
    control: &[P],
    t: f64,
    tracer: &mut impl Tracer<Step<P>>,
) -> Option<P> {
    let mut points = control.to_vec();
    for level in 1..points.len() {
        for index in 0..points.len() - level {
            points[index] = points[index].mix(points[index + 1], t);
            let point = points[index];
            tracer.step(|| Step { level, index, point });
        }
    }
    points.first().copied()
}

/// Cuts a curve at `t`: the control points of both parts, which meet in the curve's point.
pub fn split<P: Point>(control: &[P], t: f64) -> (Vec<P>, Vec<P>) {
    let mut points = control.to_vec();
    let (mut left, mut right) = (Vec::new(), Vec::new());
    while let (Some(first), Some(last)) = (points.first(), points.last()) {
        left.push(*first);
        right.push(*last);
        points = points.windows(2).map(|w| w[0].mix(w[1], t)).collect();
    }
    right.reverse();
    (left, right)
}

/// Returns the point of a rational curve: control points with weights (x, y, weight); `None` without
/// control points or where the weights cancel.
pub fn rational(control: &[(DVec2, f64)], t: f64) -> Option<DVec2> {
    let lifted: Vec<DVec3> = control.iter().map(|(p, w)| (*p * *w).extend(*w)).collect();
    project(de_casteljau(&lifted, t, &mut crate::trace::NoTrace)?)
}

/// Projects homogeneous coordinates to the plane.
pub(crate) fn project(p: DVec3) -> Option<DVec2> {
    (p.z != 0.0).then(|| p.truncate() / p.z)
}

/// Returns the point, and the derivatives along u and v, of a bicubic patch; the normal is their cross product.
pub fn bicubic(control: &[[DVec3; 4]; 4], u: f64, v: f64) -> (DVec3, DVec3, DVec3) {
    let (bu, du) = (bernstein(u), bernstein_derivative(u));
    let (bv, dv) = (bernstein(v), bernstein_derivative(v));
    let sum = |a: [f64; 4], b: [f64; 4]| {
        let mut total = DVec3::ZERO;
        for (row, weight) in control.iter().zip(b) {
            total += row.iter().zip(a).map(|(p, w)| *p * w).sum::<DVec3>() * weight;
        }
        total
    };
    (sum(bu, bv), sum(du, bv), sum(bu, dv))
}

fn bernstein(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

fn bernstein_derivative(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::{NoTrace, Recorder};

    #[test]
    fn the_parts_of_a_curve_are_the_curve() {
        let control =
            [DVec2::ZERO, DVec2::new(3.0, 8.0), DVec2::new(-4.0, 5.0), DVec2::new(9.0, 1.0)];
        let (left, right) = split(&control, 0.3);
        for i in 0..=10 {
            let t = f64::from(i) / 10.0;
            let at = |c: &[DVec2], t| de_casteljau(c, t, &mut NoTrace).unwrap();
            assert!(at(&left, t).distance(at(&control, 0.3 * t)) < 1e-12);
            assert!(at(&right, t).distance(at(&control, 0.3 + 0.7 * t)) < 1e-12);
        }
    }

    #[test]
    fn a_quarter_circle_is_rational() {
        let w = std::f64::consts::FRAC_1_SQRT_2;
        let control = [(DVec2::X, 1.0), (DVec2::ONE, w), (DVec2::Y, 1.0)];
        for i in 0..=10 {
            let p = rational(&control, f64::from(i) / 10.0).unwrap();
            assert!((p.length() - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn the_last_step_is_the_point() {
        let mut recorder = Recorder::default();
        let p = de_casteljau(&[0.0, 1.0, 5.0, 2.0], 0.4, &mut recorder);
        assert_eq!(recorder.steps().len(), 6);
        assert_eq!(recorder.steps().last().map(|s| s.point), p);
        assert_eq!(p, de_casteljau(&[0.0, 1.0, 5.0, 2.0], 0.4, &mut NoTrace));
        assert_eq!(de_casteljau::<f64>(&[], 0.4, &mut NoTrace), None);
    }

    #[test]
    fn derivatives_of_a_patch_are_differences() {
        let mut control = [[DVec3::ZERO; 4]; 4];
        for (i, row) in control.iter_mut().enumerate() {
            for (j, p) in row.iter_mut().enumerate() {
                *p = DVec3::new(j as f64, i as f64, ((i * 5 + j * 3) % 7) as f64);
            }
        }
        let (h, (u, v)) = (1e-6, (0.3, 0.8));
        let (p, du, dv) = bicubic(&control, u, v);
        let along = |row: &[DVec3; 4]| de_casteljau(row, u, &mut NoTrace).unwrap();
        let point = de_casteljau(&control.each_ref().map(along), v, &mut NoTrace).unwrap();
        assert!(p.distance(point) < 1e-12);
        assert!(((bicubic(&control, u + h, v).0 - p) / h).distance(du) < 1e-4);
        assert!(((bicubic(&control, u, v + h).0 - p) / h).distance(dv) < 1e-4);
    }
}
