//! Fewer points for lines and for the borders of areas.
//!
//! Every algorithm here returns the **weight** of each point: the tolerance, in units of the coordinates, above which
//! the point is left out. So one run serves all tolerances, and shares of the points as well: see
//! [`tolerance_for_share`]. Ends of lines weigh infinitely.
//!
//! [`douglas_peucker`] and [`visvalingam`] take one line. [`coverage`] takes lines and rings together: shared borders
//! are simplified once, and no new crossings arise.

pub mod coverage;
pub mod douglas_peucker;
mod geometry;
mod index;
mod network;
mod removal;
pub mod visvalingam;

pub use geometry::{Amount, Dropped, simplify};

use crate::math::DVec2;
use crate::trace::NoTrace;
use crate::{Error, Result};

crate::info::family! {
    /// The algorithms that choose the points of a line.
    pub enum LineSimplifier {
        /// [`douglas_peucker`]
        DouglasPeucker => douglas_peucker::INFO,
        /// [`visvalingam`]
        Visvalingam => visvalingam::INFO,
    }
}

impl LineSimplifier {
    /// Returns the indices of the points of a line that are kept, in ascending order; the first and the last
    /// are always among them.
    ///
    /// ```
    /// use durer::clip::simplify::LineSimplifier;
    /// use durer::math::DVec2;
    ///
    /// let line = [(0.0, 0.0), (2.0, 0.1), (4.0, 0.0), (4.0, 5.0)].map(DVec2::from);
    /// for simplifier in LineSimplifier::ALL {
    ///     assert_eq!(simplifier.simplify(&line, 0.5)?, [0, 2, 3]);
    /// }
    /// # Ok::<(), durer::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NonFinite`] names the first point with a NaN or infinite coordinate; [`Error::Parameter`] for a
    /// tolerance that is negative or no number.
    pub fn simplify(self, points: &[DVec2], tolerance: f64) -> Result<Vec<usize>> {
        match self {
            Self::DouglasPeucker => {
                let options = douglas_peucker::Options { tolerance };
                douglas_peucker::simplify(points, &options, &mut NoTrace)
            }
            Self::Visvalingam => {
                let options = visvalingam::Options { tolerance };
                visvalingam::simplify(points, &options, &mut NoTrace)
            }
        }
    }
}

/// Returns the tolerance at which a share of the points with finite weights is kept, rounded down; 0 keeps
/// none of them, 1 all.
///
/// ```
/// use durer::clip::simplify::tolerance_for_share;
/// let weights = [f64::INFINITY, 1.0, 3.0, 2.0, 4.0, f64::INFINITY];
/// let tolerance = tolerance_for_share(&weights, 0.5);
/// assert_eq!(weights.iter().filter(|w| w.is_finite() && **w > tolerance).count(), 2);
/// ```
pub fn tolerance_for_share(weights: &[f64], share: f64) -> f64 {
    let mut finite: Vec<f64> = weights.iter().copied().filter(|w| w.is_finite()).collect();
    finite.sort_unstable_by(f64::total_cmp);
    let kept = (share.clamp(0.0, 1.0) * finite.len() as f64) as usize;
    let dropped = finite.len() - kept.min(finite.len());
    // −1 keeps even the points of weight 0: repeated ones, and points on straight lines.
    dropped.checked_sub(1).and_then(|last| finite.get(last)).copied().unwrap_or(-1.0)
}

/// Checks that points and tolerance are usable.
fn check(points: &[DVec2], tolerance: f64) -> Result<()> {
    if let Some(index) = points.iter().position(|p| !p.is_finite()) {
        return Err(Error::NonFinite { what: "point", index });
    }
    if tolerance.is_nan() || tolerance < 0.0 {
        return Err(Error::parameter("tolerance", tolerance, "0 or more"));
    }
    Ok(())
}

/// Returns a measure, or infinity, which keeps the point, if it is NaN because of overflow.
fn or_infinite(measure: f64) -> f64 {
    if measure.is_nan() { f64::INFINITY } else { measure }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_input_is_named() {
        let line = [DVec2::ZERO, DVec2::new(1.0, f64::NAN), DVec2::X];
        for simplifier in LineSimplifier::ALL {
            let found = simplifier.simplify(&line, 1.0);
            assert_eq!(found, Err(Error::NonFinite { what: "point", index: 1 }));
            assert!(matches!(simplifier.simplify(&[], -1.0), Err(Error::Parameter { .. })));
            assert_eq!(simplifier.simplify(&[], 1.0), Ok(vec![]));
            assert_eq!(simplifier.simplify(&[DVec2::X], 1.0), Ok(vec![0]));
            // If differences overflow, points are kept.
            let far = [-f64::MAX, f64::MAX, -f64::MAX].map(DVec2::splat);
            assert!(simplifier.simplify(&far, 1.0).is_ok());
        }
    }

    #[test]
    fn shares_are_kept() {
        let weights = [1.0, 2.0, 2.0, 3.0, f64::INFINITY];
        let kept = |share| {
            let tolerance = tolerance_for_share(&weights, share);
            weights.iter().filter(|w| **w > tolerance).count()
        };
        // Points of equal weight are removed together.
        assert_eq!([0.0, 0.25, 0.5, 0.75, 1.0, 7.0].map(kept), [1, 2, 2, 4, 5, 5]);
        assert_eq!(tolerance_for_share(&[], 0.5), -1.0);
    }
}
