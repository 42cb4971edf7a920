//! Knot insertion: more control points and knots for the same B-spline curve.
//!
//! One knot: W. Boehm, *Inserting new knots into B-spline curves*, Computer-Aided Design 12(4), 1980. Many at once: E.
//! Cohen, T. Lyche, R. Riesenfeld, *Discrete B-splines and subdivision techniques in computer-aided geometric design
//! and computer graphics*, Computer Graphics and Image Processing 14(2), 1980, the Oslo algorithm. Both mix neighbours
//! of the control polygon, so the new one is nearer to the curve. Object space. Cost: O(p) points for a knot by Boehm,
//! O(p²) for each new control point by the Oslo algorithm, of degree p.
//!
//! ```
//! use durer::curve::b_spline::BSpline;
//! use durer::curve::knot_insertion::{insert, refine};
//! use durer::trace::NoTrace;
//!
//! let curve = BSpline::clamped(2, vec![0.0, 2.0, 3.0, 7.0])?;
//! let finer = insert(&curve, 0.25, &mut NoTrace)?;
//! assert_eq!(finer.control(), [0.0, 1.0, 2.25, 3.0, 7.0]);
//! assert!((finer.point(0.6) - curve.point(0.6)).abs() < 1e-12);
//! assert_eq!(refine(&curve, &[0.25], &mut NoTrace)?, finer);
//! # Ok::<(), durer::Error>(())
//! ```

use super::b_spline::BSpline;
use super::bezier::Point;
use crate::info::{Class, Info, Occluder};
use crate::trace::{PseudocodeLine, Tracer};
use crate::{Error, Result};

/// The facts of Boehm's algorithm.
pub const INFO: Info = Info {
    name: "boehm",
    title: "Knot insertion by Boehm's algorithm",
    authors: "W. Boehm",
    year: 1980,
    source: "Inserting new knots into B-spline curves, Computer-Aided Design 12(4)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n) per knot for n control points, of which p are computed for degree p",
    limits: "knots inside the domain, each at most as often as the degree",
    pseudocode: &[
        "find the knot span k with u_k ≤ u < u_(k+1)",
        "Q_i ← P_i for i ≤ k − p",
        "for i = k − p + 1 … k:",
        "    // share of the second of the two old points",
        "    a ← (u − u_i) / (u_(i+p) − u_i)",
        "    Q_i ← (1 − a) · P_(i−1) + a · P_i",
        "Q_i ← P_(i−1) for i > k",
        "put u after u_k into the knots",
    ],
};

/// The facts of the Oslo algorithm.
pub const OSLO: Info = Info {
    name: "oslo",
    title: "Knot insertion by the Oslo algorithm",
    authors: "E. Cohen, T. Lyche, R. Riesenfeld",
    year: 1980,
    source: "Discrete B-splines and subdivision techniques in computer-aided geometric design and computer graphics, \
             Computer Graphics and Image Processing 14(2)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(p²) per new control point for degree p",
    limits: "knots inside the domain, each at most as often as the degree",
    pseudocode: &[
        "τ ← the old knots u and the new ones, sorted",
        "for each new control point j:",
        "    find the knot span k with u_k ≤ τ_j < u_(k+1)",
        "    d_i^0 ← P_i, for i = k − p … k",
        "    for level r = 1 … p:",
        "        for i = k down to k − p + r:",
        "            a ← (τ_(j+r) − u_i) / (u_(i+p+1−r) − u_i)",
        "            d_i^r ← (1 − a) · d_(i−1)^(r−1) + a · d_i^(r−1)",
        "    Q_j ← d_k^p",
    ],
};

/// Step of Boehm's algorithm: a new control point, mixed from two old ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step<P> {
    /// Its index; it is mixed from the old points `index` − 1 and `index`.
    pub index: usize,
    /// The share of the second.
    pub share: f64,
    /// The point.
    pub point: P,
}

impl<P> PseudocodeLine for Step<P> {
    fn line(&self) -> usize {
        6
    }
}

/// Step of the Oslo algorithm: a point of a level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OsloStep<P> {
    /// Index of the new control point.
    pub of: usize,
    /// Level, 1 for the mixes of old control points, up to the degree for the new one.
    pub level: usize,
    /// It is mixed from the points `index` − 1 and `index` of the level below; on level 0 old control points are
    /// counted.
    pub index: usize,
    /// The share of the second.
    pub share: f64,
    /// The point.
    pub point: P,
}

impl<P> PseudocodeLine for OsloStep<P> {
    fn line(&self) -> usize {
        8
    }
}

/// Checks a knot for a curve.
fn check<P: Point>(curve: &BSpline<P>, knot: f64) -> Result<()> {
    let (first, last) = curve.domain();
    let times = curve.knots().iter().filter(|k| **k == knot).count();
    if knot > first && knot < last && times < curve.degree() {
        return Ok(());
    }
    let expected = "inside the domain, and there less often than the degree";
    Err(Error::parameter("new knot", knot, expected))
}

/// Inserts a knot into a curve, which stays the same, by Boehm's algorithm.
///
/// # Errors
/// [`Error::Parameter`] for a knot that is not inside the domain, or there as often as the degree already.
pub fn insert<P: Point>(
    curve: &BSpline<P>,
    knot: f64,
    t: &mut impl Tracer<Step<P>>,
) -> Result<BSpline<P>> {
    check(curve, knot)?;
    let (p, old, knots) = (curve.degree(), curve.control(), curve.knots());
    let after = knots.partition_point(|k| *k <= knot);
    let k = after - 1;
    let mut control = old[..=k - p].to_vec();
    for index in k - p + 1..=k {
        let (low, high) = (knots[index], knots[index + p]);
        let share = if high > low { (knot - low) / (high - low) } else { 0.0 };
        let point = old[index - 1].mix(old[index], share);
        t.step(|| Step { index, share, point });
        control.push(point);
    }
    control.extend(&old[k..]);
    let knots = [&knots[..after], &[knot], &knots[after..]].concat();
    BSpline::new(p, control, knots)
}

/// Inserts knots, in any order, into a curve, which stays the same, by the Oslo algorithm.
///
/// # Errors
/// [`Error::Parameter`] as in [`insert`].
pub fn refine<P: Point>(
    curve: &BSpline<P>,
    new: &[f64],
    t: &mut impl Tracer<OsloStep<P>>,
) -> Result<BSpline<P>> {
    let (p, old, knots) = (curve.degree(), curve.control(), curve.knots());
    for &knot in new {
        check(curve, knot)?;
        let times = |all: &[f64]| all.iter().filter(|k| **k == knot).count();
        if times(knots) + times(new) > p {
            let expected = "no more often than the degree, old ones counted";
            return Err(Error::parameter("new knot", knot, expected));
        }
    }
    let mut finer = [knots, new].concat();
    finer.sort_by(f64::total_cmp);
    let mut control = Vec::with_capacity(old.len() + new.len());
    for of in 0..old.len() + new.len() {
        let k = knots.partition_point(|k| *k <= finer[of]) - 1;
        let k = k.clamp(p, old.len() - 1);
        let mut points = old[k - p..=k].to_vec();
        for level in 1..=p {
            for i in (level..=p).rev() {
                let index = k - p + i;
                let (low, high) = (knots[index], knots[index + p + 1 - level]);
                let share = if high > low { (finer[of + level] - low) / (high - low) } else { 0.0 };
                points[i] = points[i - 1].mix(points[i], share);
                let point = points[i];
                t.step(|| OsloStep { of, level, index, share, point });
            }
        }
        control.push(points[p]);
    }
    BSpline::new(p, control, finer)
}

/// Returns the new control points that the steps of [`insert`] lead to, from the old ones.
pub fn replay<P: Point>(old: &[P], steps: &[Step<P>]) -> Vec<P> {
    let (Some(first), Some(last)) = (steps.first(), steps.last()) else { return old.to_vec() };
    let mixed = steps.iter().map(|s| old[s.index - 1].mix(old[s.index], s.share));
    let (before, after) = (old.iter().take(first.index), old.iter().skip(last.index));
    before.copied().chain(mixed).chain(after.copied()).collect()
}
