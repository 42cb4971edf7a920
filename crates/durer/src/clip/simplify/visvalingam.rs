//! Visvalingam–Whyatt: the smallest triangles first.
//!
//! Maheswari Visvalingam and James Whyatt, "Line generalisation by repeated elimination of points", The
//! Cartographic Journal 30(1), 1993. Object space; O(n log n) for n points.
//!
//! Each inner point makes a triangle with the two points beside it. The point of the smallest triangle is left
//! out, the triangles beside it change, and so on.
//!
//! A triangle counts as at least as large as those removed before it, so that one run serves all tolerances.
//! The tolerance is a length, the side of a square as large as the triangle, to be comparable with
//! [Douglas–Peucker](super::douglas_peucker). Among triangles of the same size, the first one is removed first.

use super::check;
use super::removal::{Free, Links, Measure, Removal};
use crate::Result;
use crate::info::{Class, Info, Occluder};
use crate::math::DVec2;
use crate::trace::{NoTrace, PseudocodeLine, Tracer};

/// The facts of Visvalingam–Whyatt.
pub const INFO: Info = Info {
    name: "visvalingam",
    title: "Visvalingam–Whyatt",
    authors: "Maheswari Visvalingam, James Whyatt",
    year: 1993,
    source: "Line generalisation by repeated elimination of points, The Cartographic Journal 30(1)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n log n) for n points",
    limits: "a line simplified alone may cross itself; in a coverage it does not",
    pseudocode: &[
        "for each inner point: area of the triangle with its two neighbours",
        "while there are inner points:",
        "    P ← the point with the smallest area, the first of several",
        "    side ← √area, but no less than the side of the point before",
        "    if side > tolerance: stop",
        "    remove P",
        "    for each of its two neighbours:",
        "        area ← that of its new triangle",
    ],
};

/// Options for simplifying a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// The side of a square as large as the largest triangle that is left out, in units of the coordinates. Smaller
    /// tolerances take less time.
    pub tolerance: f64,
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The line has this many points.
    Begin {
        /// Number of points.
        points: usize,
    },
    /// A point is left out.
    Removed {
        /// Its index.
        point: usize,
        /// The side of a square as large as its triangle.
        side: f64,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Begin { .. } => 1,
            Self::Removed { .. } => 6,
        }
    }
}

/// Rebuilds the result from the steps.
pub fn replay(steps: &[Step]) -> Vec<usize> {
    let mut kept = Vec::new();
    for step in steps {
        match *step {
            Step::Begin { points } => kept = (0..points).collect(),
            Step::Removed { point, .. } => kept.retain(|&other| other != point),
        }
    }
    kept
}

/// Returns the indices of the points of a line that are kept.
///
/// # Errors
/// As [`super::LineSimplifier::simplify`].
pub fn simplify(
    points: &[DVec2],
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Vec<usize>> {
    check(points, options.tolerance)?;
    t.step(|| Step::Begin { points: points.len() });
    let weights = run(points, options.tolerance, t);
    Ok((0..points.len()).filter(|&i| weights[i].is_infinite()).collect())
}

/// Returns the weight of every point of a line: see [`super`].
///
/// # Errors
/// [`crate::Error::NonFinite`] names the first point with a NaN or infinite coordinate.
pub fn weights(points: &[DVec2]) -> Result<Vec<f64>> {
    check(points, 0.0)?;
    Ok(run(points, f64::INFINITY, &mut NoTrace))
}

/// Returns the weights of points up to a limit, infinite above it.
fn run(points: &[DVec2], limit: f64, t: &mut impl Tracer<Step>) -> Vec<f64> {
    let links = Links::of_line(points.len());
    let removal = Removal { places: points, links, measure: Measure::Area, limit, guard: Free };
    removal.run(|point, side| t.step(|| Step::Removed { point, side }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Recorder;
    use proptest::prelude::*;

    /// Simplifies by examining all triangles in every round.
    fn slow(points: &[DVec2], tolerance: f64) -> Vec<usize> {
        let mut kept: Vec<usize> = (0..points.len()).collect();
        loop {
            let side = |k: &usize| {
                let [a, b, c] = [kept[k - 1], kept[*k], kept[k + 1]].map(|i| points[i]);
                ((b - a).perp_dot(c - a).abs() * 0.5).sqrt()
            };
            let all = 1..kept.len().saturating_sub(1).max(1);
            let Some(least) = all.min_by(|i, j| side(i).total_cmp(&side(j))) else { return kept };
            if side(&least) > tolerance {
                return kept;
            }
            kept.remove(least);
        }
    }

    proptest! {
        #[test]
        fn the_smallest_triangles_go_first(
            points in prop::collection::vec((-9i32..9, -9i32..9), 0..30),
            tolerance in 0..20u32,
        ) {
            let points: Vec<DVec2> = points.iter().map(|&(x, y)| DVec2::new(x.into(), y.into())).collect();
            let tolerance = f64::from(tolerance) * 0.5;
            let mut steps = Recorder::default();
            let kept = simplify(&points, &Options { tolerance }, &mut steps).unwrap();
            prop_assert_eq!(&kept, &slow(&points, tolerance));
            prop_assert_eq!(&kept, &replay(steps.steps()));
            let heavy: Vec<usize> = weights(&points).unwrap().iter().enumerate()
                .filter(|(_, w)| **w > tolerance).map(|(i, _)| i).collect();
            prop_assert_eq!(&kept, &heavy);
        }
    }
}
