//! B-splines and their rational form, NURBS.
//!
//! Points by de Boor's algorithm (C. de Boor, *On calculating with B-splines*, J. Approx. Theory 6, 1972), basis
//! functions by the recursion of M. G. Cox (1972) and de Boor. Cost: O(p²) per point for degree p, plus a
//! search for the knot span.

use super::bezier::{Point, project};
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, DVec3};
use crate::trace::{NoTrace, PseudocodeLine, Tracer};
use crate::{Error, Result};

/// The facts of de Boor's algorithm.
pub const INFO: Info = Info {
    name: "de-boor",
    title: "B-splines by de Boor's algorithm",
    authors: "Carl de Boor",
    year: 1972,
    source: "On calculating with B-splines, Journal of Approximation Theory 6(1)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(p² + log n) per point for degree p and n knots",
    limits: "knots in ascending order; parameters in the domain",
    pseudocode: &[
        "find the knot span k with u_k ≤ u < u_(k+1)",
        "d_i^0 ← control point i, for i = k − p … k",
        "for level r = 1 … p:",
        "    for i = k down to k − p + r:",
        "        // share of the second of the two points below",
        "        a ← (u − u_i) / (u_(i+p+1−r) − u_i)",
        "        d_i^r ← (1 − a) · d_(i−1)^(r−1) + a · d_i^(r−1)",
        "return d_k^p",
    ],
};

/// A B-spline curve.
///
/// # Guarantees
/// There are more control points than the degree; there are control points + degree + 1 knots, finite and
/// non-decreasing; the domain, from knot `degree` to knot `control points`, is not empty.
#[derive(Debug, Clone, PartialEq)]
pub struct BSpline<P> {
    degree: usize,
    control: Vec<P>,
    knots: Vec<f64>,
}

impl<P: Point> BSpline<P> {
    /// Creates a curve from its parts.
    ///
    /// # Errors
    /// [`Error::Parameter`] if a guarantee would not hold.
    pub fn new(degree: usize, control: Vec<P>, knots: Vec<f64>) -> Result<Self> {
        let count = control.len();
        if degree == 0 || degree > 64 || count <= degree {
            return Err(Error::parameter(
                "degree",
                degree,
                "1 … 64 and less than the control points",
            ));
        }
        if knots.len() != count + degree + 1 {
            return Err(Error::parameter(
                "knots",
                knots.len(),
                "control points + degree + 1 in number",
            ));
        }
        let rising = knots.windows(2).all(|w| w[0] <= w[1]) && knots.iter().all(|k| k.is_finite());
        if !rising || knots[degree] >= knots[count] {
            return Err(Error::parameter(
                "knots",
                "given",
                "finite, not falling, not all the same",
            ));
        }
        Ok(Self { degree, control, knots })
    }

    /// Creates a curve with equally spaced knots, the ends repeated so that it starts and ends in its
    /// first and last control point; the parameter runs from 0 to 1.
    ///
    /// # Errors
    /// As [`BSpline::new`].
    pub fn clamped(degree: usize, control: Vec<P>) -> Result<Self> {
        let inner = control.len().saturating_sub(degree);
        let knot = |i: usize| i.saturating_sub(degree).min(inner) as f64 / inner.max(1) as f64;
        let knots = (0..control.len() + degree + 1).map(knot).collect();
        Self::new(degree, control, knots)
    }

    /// Returns the degree of its pieces.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Returns the control points.
    pub fn control(&self) -> &[P] {
        &self.control
    }

    /// Returns the knots, which do not fall.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Returns the first and last parameter.
    pub fn domain(&self) -> (f64, f64) {
        (self.knots[self.degree], self.knots[self.control.len()])
    }

    /// Returns the knot span of a parameter, which is moved into the domain.
    fn span(&self, t: f64) -> (usize, f64) {
        let (start, end) = self.domain();
        let t = if t.is_nan() { start } else { t.clamp(start, end) };
        let after = self.knots.partition_point(|k| *k <= t);
        let mut span = after.saturating_sub(1).clamp(self.degree, self.control.len() - 1);
        while span > self.degree && self.knots[span] >= self.knots[span + 1] {
            span -= 1;
        }
        (span, t)
    }

    /// Returns the point at a parameter, by [`de_boor`].
    pub fn point(&self, t: f64) -> P {
        de_boor(self, t, &mut NoTrace)
    }

    /// Returns the values of all basis functions at a parameter, by the recursion of Cox and de Boor:
    /// they are not negative and add up to one.
    pub fn basis(&self, t: f64) -> Vec<f64> {
        let (span, t) = self.span(t);
        let mut values = vec![0.0; self.knots.len() - 1];
        values[span] = 1.0;
        let part = |top: f64, bottom: f64| if bottom > 0.0 { top / bottom } else { 0.0 };
        for degree in 1..=self.degree {
            for i in 0..values.len() - degree {
                let k = |j: usize| self.knots[i + j];
                let rising = part(t - k(0), k(degree) - k(0)) * values[i];
                let falling = part(k(degree + 1) - t, k(degree + 1) - k(1)) * values[i + 1];
                values[i] = rising + falling;
            }
        }
        values.truncate(self.control.len());
        values
    }
}

/// One step: a point of a level of the triangle of intermediate points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step<P> {
    /// Level, 1 for the mixes of control points, up to the degree for the curve's point.
    pub level: usize,
    /// It is mixed from the points `index` − 1 and `index` of the level below; on level 0 control points are
    /// counted.
    pub index: usize,
    /// The share of the second.
    pub share: f64,
    /// The point.
    pub point: P,
}

impl<P> PseudocodeLine for Step<P> {
    fn line(&self) -> usize {
        7
    }
}

/// Returns the point of a curve at a parameter, by de Boor's algorithm; parameters outside the domain are
/// moved to its ends.
///
/// ```
/// use durer::curve::b_spline::{BSpline, de_boor};
/// use durer::trace::Recorder;
///
/// let spline = BSpline::clamped(2, vec![0.0, 2.0, 3.0, 7.0]).unwrap();
/// let mut steps = Recorder::default();
/// // Two mixes of three control points, and one of these.
/// assert_eq!(de_boor(&spline, 0.25, &mut steps), 1.625);
/// assert_eq!(steps.steps().len(), 3);
/// ```
pub fn de_boor<P: Point>(curve: &BSpline<P>, t: f64, tracer: &mut impl Tracer<Step<P>>) -> P {
    let (p, (span, t)) = (curve.degree, curve.span(t));
    let mut points = curve.control[span - p..=span].to_vec();
    for level in 1..=p {
        for i in (level..=p).rev() {
            let (low, high) = (curve.knots[span - p + i], curve.knots[span + 1 + i - level]);
            let share = if high > low { (t - low) / (high - low) } else { 0.0 };
            points[i] = points[i - 1].mix(points[i], share);
            let (index, point) = (span - p + i, points[i]);
            tracer.step(|| Step { level, index, share, point });
        }
    }
    points[p]
}

/// Returns the point of a rational curve at a parameter: [`de_boor`] with homogeneous points (x · weight, y ·
/// weight, weight), then one division.
pub fn de_boor_rational(curve: &Nurbs, t: f64, tracer: &mut impl Tracer<Step<DVec3>>) -> DVec2 {
    project(de_boor(&curve.lifted, t, tracer)).unwrap_or_default()
}

/// A non-uniform rational B-spline in the plane: control points with weights.
#[derive(Debug, Clone, PartialEq)]
pub struct Nurbs {
    lifted: BSpline<DVec3>,
}

impl Nurbs {
    /// Creates a curve from control points, weights and knots.
    ///
    /// # Errors
    /// [`Error::Parameter`] for weights that are not positive and finite, or as [`BSpline::new`].
    ///
    /// ```
    /// use durer::curve::b_spline::Nurbs;
    /// use durer::math::DVec2;
    ///
    /// let w = 0.5_f64.sqrt();
    /// let control = vec![(DVec2::X, 1.0), (DVec2::ONE, w), (DVec2::Y, 1.0)];
    /// let quarter = Nurbs::new(2, &control, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0]).unwrap();
    /// assert!((quarter.point(0.3).length() - 1.0).abs() < 1e-14);
    /// ```
    pub fn new(degree: usize, control: &[(DVec2, f64)], knots: Vec<f64>) -> Result<Self> {
        if let Some((_, weight)) = control.iter().find(|(_, w)| !(w.is_finite() && *w > 0.0)) {
            return Err(Error::parameter("weight", weight, "positive and finite"));
        }
        let lifted = control.iter().map(|(p, w)| (*p * *w).extend(*w)).collect();
        Ok(Self { lifted: BSpline::new(degree, lifted, knots)? })
    }

    /// Returns the first and last parameter.
    pub fn domain(&self) -> (f64, f64) {
        self.lifted.domain()
    }

    /// Returns the point at a parameter, by [`de_boor_rational`].
    pub fn point(&self, t: f64) -> DVec2 {
        de_boor_rational(self, t, &mut NoTrace)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::bezier::de_casteljau;
    use crate::trace::Recorder;

    fn control() -> Vec<DVec2> {
        (0..7).map(|i| DVec2::new(f64::from(i), f64::from(i * i % 5))).collect()
    }

    #[test]
    fn de_boor_agrees_with_cox() {
        for degree in 1..=5 {
            let spline = BSpline::clamped(degree, control()).unwrap();
            for i in 0..=40 {
                let t = f64::from(i) / 40.0;
                let basis = spline.basis(t);
                assert!((basis.iter().sum::<f64>() - 1.0).abs() < 1e-12);
                assert!(basis.iter().all(|b| *b >= -1e-15));
                let sum: DVec2 = basis.iter().zip(control()).map(|(b, p)| p * *b).sum();
                assert!(sum.distance(spline.point(t)) < 1e-12, "degree {degree}, t {t}");
            }
        }
    }

    #[test]
    fn without_inner_knots_it_is_a_bezier_curve() {
        let spline = BSpline::clamped(6, control()).unwrap();
        for i in 0..=10 {
            let t = f64::from(i) / 10.0;
            let p = de_casteljau(&control(), t, &mut NoTrace).unwrap();
            assert!(p.distance(spline.point(t)) < 1e-12);
        }
    }

    /// Mixes the points again by the steps; returns the last one.
    fn replayed<P: Point + PartialEq + std::fmt::Debug>(control: &[P], steps: &[Step<P>]) -> P {
        let (mut below, mut level, mut level_number) = (control.to_vec(), control.to_vec(), 1);
        for step in steps {
            if step.level > level_number {
                (below, level_number) = (level.clone(), step.level);
            }
            level[step.index] = below[step.index - 1].mix(below[step.index], step.share);
            assert_eq!(level[step.index], step.point);
        }
        steps.last().expect("a degree of at least 1").point
    }

    #[test]
    fn the_steps_rebuild_the_point() {
        let weights = [1.0, 0.5, 2.0, 1.0, 3.0, 0.1, 1.0];
        let weighted: Vec<(DVec2, f64)> = control().into_iter().zip(weights).collect();
        for degree in 1..=6 {
            let spline = BSpline::clamped(degree, control()).unwrap();
            let nurbs = Nurbs::new(degree, &weighted, spline.knots.clone()).unwrap();
            for i in 0..=20 {
                let (t, mut steps, mut lifted) =
                    (f64::from(i) / 20.0, Recorder::default(), Recorder::default());
                let p = de_boor(&spline, t, &mut steps);
                assert_eq!((p, steps.steps().len()), (spline.point(t), degree * (degree + 1) / 2));
                assert_eq!(replayed(&control(), steps.steps()), p);
                let p = de_boor_rational(&nurbs, t, &mut lifted);
                assert_eq!(p, nurbs.point(t));
                assert_eq!(project(replayed(&nurbs.lifted.control, lifted.steps())), Some(p));
            }
        }
    }

    #[test]
    fn bad_knots_are_refused() {
        assert!(BSpline::new(3, control(), vec![0.0; 11]).is_err());
        assert!(BSpline::new(3, control(), vec![f64::NAN; 11]).is_err());
        assert!(BSpline::new(0, control(), vec![0.0; 8]).is_err());
        assert!(BSpline::<DVec2>::clamped(3, vec![]).is_err());
    }
}
