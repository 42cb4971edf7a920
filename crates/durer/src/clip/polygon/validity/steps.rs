//! The steps of the check of polygons.

use super::{Fault, Flaw, sort};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;

/// Relation of two edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EdgeRelation {
    /// Nothing in common.
    Apart,
    /// Neighbours in their ring, with just their vertex in common.
    Neighbours,
    /// Edges of two rings with one point in common, which is an end of one or both.
    Touch(DVec2),
    /// A fault.
    Flaw(Flaw),
}

/// Step of the check. Edges are given by their ring, counted over all polygons, and their place in it, counted without
/// repeated points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// Repeated points of a ring were left out.
    Ring {
        /// The ring.
        ring: usize,
        /// Points that are left; 0 if fewer than three different ones were.
        points: usize,
    },
    /// Two edges were compared; some are compared twice.
    Pair {
        /// Ring and place of both.
        edges: [[usize; 2]; 2],
        /// Their relation.
        relation: EdgeRelation,
    },
    /// A fault other than those of two edges.
    Found(Flaw),
    /// Edges cross or run along each other: the nesting of rings is not checked.
    Stopped,
    /// The faults were sorted, each place of two rings once.
    Sorted {
        /// Their number.
        count: usize,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Ring { .. } => 1,
            Self::Pair { relation, .. } => match relation {
                EdgeRelation::Apart | EdgeRelation::Neighbours => 3,
                EdgeRelation::Flaw(Flaw { fault: Fault::SelfTouch, .. }) => 5,
                EdgeRelation::Flaw(_) => 4,
                EdgeRelation::Touch(_) => 6,
            },
            Self::Found(Flaw { fault, .. }) => match fault {
                Fault::FewPoints => 1,
                Fault::Crossing | Fault::Overlap | Fault::SelfTouch => 7,
                Fault::Divided => 9,
                Fault::HoleOutside | Fault::HoleInHole | Fault::PolygonInPolygon => 10,
            },
            Self::Stopped => 8,
            Self::Sorted { .. } => 11,
        }
    }
}

/// Returns the faults that the steps lead to.
pub fn replay(steps: &[Step]) -> Vec<Flaw> {
    let flaw = |step: &Step| match *step {
        Step::Pair { relation: EdgeRelation::Flaw(flaw), .. } | Step::Found(flaw) => Some(flaw),
        Step::Pair { .. } | Step::Ring { .. } | Step::Stopped | Step::Sorted { .. } => None,
    };
    let mut flaws: Vec<Flaw> = steps.iter().filter_map(flaw).collect();
    sort(&mut flaws);
    flaws
}
