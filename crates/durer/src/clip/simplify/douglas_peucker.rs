//! Douglas–Peucker: the farthest points first.
//!
//! David Douglas and Thomas Peucker, "Algorithms for the reduction of the number of points required to
//! represent a digitized line or its caricature", Cartographica 10(2), 1973; the same was found by Urs Ramer,
//! "An iterative procedure for the polygonal approximation of plane curves", Computer Graphics and Image
//! Processing 1(3), 1972. Object space; O(n log n) for n points on usual lines, O(n²) at worst.
//!
//! The line from the first to the last point is divided at the point farthest from it, and so are the parts,
//! as long as that point is farther away than the tolerance.
//!
//! Distances are measured to the segment, not to the line through it, so that reversals are kept. A point weighs at
//! most as much as the one that split off its part, so that one run serves all tolerances. Of several farthest points
//! the first counts.

use super::{check, or_infinite};
use crate::Result;
use crate::info::{Class, Info, Occluder};
use crate::math::DVec2;
use crate::trace::{PseudocodeLine, Tracer};

/// The facts of Douglas–Peucker.
pub const INFO: Info = Info {
    name: "douglas-peucker",
    title: "Douglas–Peucker",
    authors: "Urs Ramer; David Douglas, Thomas Peucker",
    year: 1973,
    source: "Algorithms for the reduction of the number of points required to represent a digitized line \
             or its caricature, Cartographica 10(2)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n log n) for n points on usual lines, O(n²) at worst",
    limits: "a line simplified alone may cross itself; in a coverage it does not",
    pseudocode: &[
        "keep the first and the last point",
        "parts ← {the whole line}",
        "while there are parts: take one, from A to B",
        "    P ← the point between that is farthest from the segment A B",
        "    if P is farther away than the tolerance:",
        "        keep P, and add the parts from A to P and from P to B",
        "    else:",
        "        leave out all points between A and B",
    ],
};

/// Options for simplifying a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Largest distance of a point that is left out from the line that stays, in units of the coordinates. The
    /// time does not depend on it.
    pub tolerance: f64,
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A point is kept: an end, or the farthest of its part.
    Kept {
        /// Its index.
        point: usize,
        /// Indices of the ends of its part.
        part: [usize; 2],
        /// Its distance from the segment between them; infinite for an end of the line.
        distance: f64,
    },
    /// All points between the ends of a part are left out.
    Straight {
        /// Indices of the ends.
        part: [usize; 2],
        /// The largest distance of a point between them from their segment; 0 if there is none.
        distance: f64,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Kept { distance: f64::INFINITY, .. } => 1,
            Self::Kept { .. } => 6,
            Self::Straight { .. } => 8,
        }
    }
}

/// Rebuilds the result from the steps.
pub fn replay(steps: &[Step]) -> Vec<usize> {
    let point = |step: &Step| if let Step::Kept { point, .. } = step { Some(*point) } else { None };
    let mut kept: Vec<usize> = steps.iter().filter_map(point).collect();
    kept.sort_unstable();
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
    let mut kept = Vec::new();
    let mut decide = |point: Option<usize>, part: [usize; 2], distance: f64| {
        t.step(|| match point {
            Some(point) => Step::Kept { point, part, distance },
            None => Step::Straight { part, distance },
        });
        kept.extend(point);
    };
    let last = points.len().saturating_sub(1);
    if !points.is_empty() {
        decide(Some(0), [0, last], f64::INFINITY);
    }
    if points.len() > 1 {
        decide(Some(last), [0, last], f64::INFINITY);
    }
    divide(points, options.tolerance, |part| {
        decide(part.farthest.filter(|_| part.is_divided), part.ends, part.distance);
    });
    kept.sort_unstable();
    Ok(kept)
}

/// Returns the weight of every point of a line: see [`super`].
///
/// # Errors
/// [`crate::Error::NonFinite`] names the first point with a NaN or infinite coordinate.
pub fn weights(points: &[DVec2]) -> Result<Vec<f64>> {
    check(points, 0.0)?;
    let mut weights = vec![0.0; points.len()];
    for end in [weights.len().checked_sub(1), Some(0)].into_iter().flatten() {
        if let Some(weight) = weights.get_mut(end) {
            *weight = f64::INFINITY;
        }
    }
    divide(points, 0.0, |part| {
        if let Some(at) = part.farthest.filter(|_| part.is_divided) {
            weights[at] = part.weight;
        }
    });
    Ok(weights)
}

/// A part of a line, and the point that decides about it.
struct Part {
    ends: [usize; 2],
    /// The farthest point between the ends.
    farthest: Option<usize>,
    distance: f64,
    /// The distance, or that at which the part began if it is less.
    weight: f64,
    is_divided: bool,
}

/// Divides a line as long as points are farther away than the tolerance; calls `found` with each part.
fn divide(points: &[DVec2], tolerance: f64, mut found: impl FnMut(Part)) {
    let mut open = vec![(0, points.len().saturating_sub(1), f64::INFINITY)];
    while let Some((from, to, limit)) = open.pop() {
        let best = farthest(points, from, to);
        let (farthest, distance) =
            best.map_or((None, 0.0), |(at, squared)| (Some(at), squared.sqrt()));
        let weight = distance.min(limit);
        let is_divided = weight > tolerance;
        found(Part { ends: [from, to], farthest, distance, weight, is_divided });
        if let Some(at) = farthest.filter(|_| is_divided) {
            open.extend([(from, at, weight), (at, to, weight)]);
        }
    }
}

/// Returns the first of the points between two that are farthest from the segment between these, and its
/// squared distance; `None` if no point is between them.
fn farthest(points: &[DVec2], from: usize, to: usize) -> Option<(usize, f64)> {
    let (&a, &b) = (points.get(from)?, points.get(to)?);
    let between = points.get(from + 1..to)?;
    let along = b - a;
    let length = along.length_squared();
    let scale = if length > 0.0 { 1.0 / length } else { 0.0 };
    let squared = |p: DVec2| {
        let part = ((p - a).dot(along) * scale).clamp(0.0, 1.0);
        or_infinite((a + along * part).distance_squared(p))
    };
    let mut best = None;
    for (&p, at) in between.iter().zip(from + 1..) {
        let distance = squared(p);
        if best.is_none_or(|(_, most)| distance > most) {
            best = Some((at, distance));
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::{NoTrace, Recorder};
    use proptest::prelude::*;

    fn line(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().copied().map(DVec2::from).collect()
    }

    #[test]
    fn what_turns_back_is_kept() {
        let spike = line(&[(0.0, 0.0), (5.0, 0.0), (-3.0, 0.0), (2.0, 0.0)]);
        let options = Options { tolerance: 0.5 };
        assert_eq!(simplify(&spike, &options, &mut NoTrace).unwrap(), [0, 1, 2, 3]);
        let closed = line(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 0.0)]);
        assert_eq!(simplify(&closed, &options, &mut NoTrace).unwrap(), [0, 1, 2, 3]);
    }

    #[test]
    fn distances_are_reported() {
        let bump = line(&[(0.0, 0.0), (1.0, 3.0), (2.0, 1.0), (4.0, 0.0)]);
        let weights = weights(&bump).unwrap();
        assert_eq!((weights[0], weights[1], weights[3]), (f64::INFINITY, 3.0, f64::INFINITY));
        assert!((weights[2] - 2f64.sqrt().recip()).abs() < 1.0);
    }

    proptest! {
        #[test]
        fn weights_and_steps_tell_the_same(
            points in prop::collection::vec((-9i32..9, -9i32..9), 0..40),
            tolerance in 0..40u32,
        ) {
            let points: Vec<DVec2> = points.iter().map(|&(x, y)| DVec2::new(x.into(), y.into())).collect();
            let tolerance = f64::from(tolerance) * 0.25;
            let mut steps = Recorder::default();
            let kept = simplify(&points, &Options { tolerance }, &mut steps).unwrap();
            let heavy: Vec<usize> = weights(&points).unwrap().iter().enumerate()
                .filter(|(_, w)| **w > tolerance).map(|(i, _)| i).collect();
            prop_assert_eq!(&kept, &heavy);
            prop_assert_eq!(&kept, &replay(steps.steps()));
            // No point is farther from the simplified line than the tolerance.
            for pair in kept.windows(2) {
                let far = farthest(&points, pair[0], pair[1]);
                prop_assert!(far.is_none_or(|(_, squared)| squared.sqrt() <= tolerance));
            }
        }
    }
}
