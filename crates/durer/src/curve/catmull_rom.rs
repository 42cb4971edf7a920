//! Catmull–Rom splines: cubic pieces through all points, and Hermite's form of a cubic.
//!
//! E. Catmull, R. Rom, *A class of local interpolating splines*, Computer Aided Geometric Design (Academic Press),
//! 1974: the tangent at a point is half the vector from the point before to the point after, so a point moves only the
//! four pieces near it. A piece between two points with these tangents is Hermite's cubic, and that is a Bézier curve.
//! Object space. Cost: O(1) per piece.
//!
//! Deviation: the paper's curve begins at the second point and ends at the last but one; here the end points are taken
//! twice, so that it runs through all points.

use super::path::Path;
use crate::info::{Class, Info, Occluder};
use crate::math::DVec2;
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "catmull-rom",
    title: "Catmull–Rom spline",
    authors: "E. Catmull, R. Rom",
    year: 1974,
    source: "A class of local interpolating splines, Computer Aided Geometric Design, Academic Press",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n) for n points",
    limits: "uniform parameters: with unequal distances between the points the curve overshoots",
    pseudocode: &[
        "for each point P_i, with the first and last one taken twice:",
        "    // the tangent is parallel to the chord of the neighbours",
        "    m_i ← τ · (P_(i+1) − P_(i−1)), with the tension's τ = ½",
        "for each two neighbours P_i, P_(i+1):",
        "    // Hermite's cubic with these ends and tangents, as a Bézier curve",
        "    B_0 ← P_i, B_1 ← P_i + m_i / 3",
        "    B_2 ← P_(i+1) − m_(i+1) / 3, B_3 ← P_(i+1)",
        "    emit the curve B_0 … B_3",
    ],
};

/// Options for the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Factor of the chord from the point before to the one after: ½ as published; 0 gives straight lines.
    pub tension: f64,
    /// True if the curve runs from the last point back to the first.
    pub closed: bool,
}

impl Default for Options {
    /// Returns the default: as published, from the first point to the last.
    fn default() -> Self {
        Self { tension: 0.5, closed: false }
    }
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// Tangent of a point.
    Tangent {
        /// Index of the point.
        index: usize,
        /// Derivative of the curve there.
        tangent: DVec2,
    },
    /// A piece between a point and the next one.
    Piece {
        /// Index of the point where it begins.
        index: usize,
        /// Its Bézier control points.
        control: [DVec2; 4],
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Tangent { .. } => 3,
            Self::Piece { .. } => 8,
        }
    }
}

/// Returns the Bézier control points of the cubic with these ends and derivatives there: C. Hermite's form, as
/// J. Ferguson, *Multivariable curve interpolation*, Journal of the ACM 11(2), 1964, uses it for pieces of curves.
///
/// ```
/// use durer::curve::catmull_rom::hermite;
/// use durer::math::DVec2;
///
/// let control = hermite([DVec2::ZERO, DVec2::X * 3.0], [DVec2::Y * 3.0, DVec2::NEG_Y * 3.0]);
/// assert_eq!(control[1], DVec2::Y);
/// assert_eq!(control[2], DVec2::new(3.0, 1.0));
/// ```
pub fn hermite(ends: [DVec2; 2], tangents: [DVec2; 2]) -> [DVec2; 4] {
    [ends[0], ends[0] + tangents[0] / 3.0, ends[1] - tangents[1] / 3.0, ends[1]]
}

/// Returns the pieces of the curve through points, each as the control points of a Bézier curve; fewer than two points
/// have none.
pub fn pieces(points: &[DVec2], options: &Options, t: &mut impl Tracer<Step>) -> Vec<[DVec2; 4]> {
    let count = points.len();
    if count < 2 {
        return Vec::new();
    }
    let tangent = |index: usize| {
        let (before, after) = if options.closed {
            ((index + count - 1) % count, (index + 1) % count)
        } else {
            (index.saturating_sub(1), (index + 1).min(count - 1))
        };
        (points[after] - points[before]) * options.tension
    };
    let tangents: Vec<DVec2> = (0..count).map(tangent).collect();
    for (index, &tangent) in tangents.iter().enumerate() {
        t.step(|| Step::Tangent { index, tangent });
    }
    let last = if options.closed { count } else { count - 1 };
    let piece = |index: usize| {
        let ends = [index, (index + 1) % count];
        let control = hermite(ends.map(|i| points[i]), ends.map(|i| tangents[i]));
        t.step(|| Step::Piece { index, control });
        control
    };
    (0..last).map(piece).collect()
}

/// Returns the curve through points as a path.
pub fn path(points: &[DVec2], options: &Options, t: &mut impl Tracer<Step>) -> Path {
    let mut path = Path::new();
    for (number, [start, b, c, end]) in pieces(points, options, t).into_iter().enumerate() {
        if number == 0 {
            path.move_to(start.x, start.y);
        }
        path.cubic_to(b, c, end);
    }
    if options.closed {
        path.close();
    }
    path
}

/// Returns the pieces that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<[DVec2; 4]> {
    let piece = |step: &Step| match step {
        Step::Piece { control, .. } => Some(*control),
        Step::Tangent { .. } => None,
    };
    steps.iter().filter_map(piece).collect()
}
