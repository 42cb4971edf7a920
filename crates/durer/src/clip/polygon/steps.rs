//! The steps of the clippers along linked borders.

use super::group::group;
use super::{Operand, Shapes};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;

/// Empty options: the algorithm has none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {}

/// Direction of a list at a crossing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CrossingMark {
    /// Into the other polygon.
    Entering,
    /// Out of it.
    Leaving,
}

/// Step of the algorithm, in the direction of the subject's first ring.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// A vertex of a list once crossings are inserted: ring after ring, each in its order.
    Listed {
        /// Operand of the list.
        list: Operand,
        /// Position of the point.
        at: DVec2,
        /// Direction of the list at a crossing.
        mark: Option<CrossingMark>,
    },
    /// A ring begins at a crossing of the subject.
    Start {
        /// Position of the point.
        at: DVec2,
    },
    /// The walk passes a vertex, which belongs to the ring that is being made.
    Passed {
        /// List that was followed.
        list: Operand,
        /// Position of the point.
        at: DVec2,
    },
    /// Greiner and Hormann: the borders cross here; the subject enters or leaves the clip.
    Crossing {
        /// Position of the point.
        at: DVec2,
        /// True if the subject enters.
        entry: bool,
    },
    /// Weiler and Atherton: the walk turns from one border to the other.
    Turn {
        /// Position of the point.
        at: DVec2,
        /// True if the walk continues along the subject.
        to_subject: bool,
    },
    /// Greiner and Hormann: rings of an operand cross themselves or one another. Entries and exits take turns along
    /// each ring, and rings of the result may cross, too: the area that they enclose by the even-odd rule is the
    /// result.
    CrossingRings,
    /// A ring of the result is complete.
    Ring {
        /// Its points, the inside on the left, or on the right where the subject's first ring runs clockwise; in either
        /// direction after [`Self::CrossingRings`].
        points: Vec<DVec2>,
    },
}

impl PseudocodeLine for Step {
    /// Returns the line of both algorithms' pseudocode that runs, counted from 1.
    fn line(&self) -> usize {
        match self {
            Self::Listed { .. } | Self::CrossingRings => 1,
            Self::Crossing { .. } => 2,
            Self::Start { .. } => 4,
            Self::Turn { to_subject: true, .. } => 5,
            Self::Passed { list: Operand::Subject, .. } => 6,
            Self::Turn { to_subject: false, .. } => 7,
            Self::Passed { list: Operand::Clip, .. } => 8,
            Self::Ring { .. } => 9,
        }
    }
}

/// Rebuilds the result from its steps.
pub fn replay(steps: &[Step]) -> Shapes {
    let rings = steps.iter().filter_map(|step| match step {
        Step::Ring { points } => Some(points.clone()),
        _ => None,
    });
    if steps.contains(&Step::CrossingRings) {
        return Shapes::from_rings(rings);
    }
    group(rings.collect())
}
