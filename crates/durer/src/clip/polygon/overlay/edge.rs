//! An edge of the arrangement, and how windings change across it.

use crate::clip::polygon::{BooleanOp, WindingRule};

/// Winding numbers of subject and clip around a point, or their change across an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Winding {
    pub subject: i32,
    pub clip: i32,
}

impl Winding {
    pub(super) fn plus(self, other: Self) -> Self {
        Self { subject: self.subject + other.subject, clip: self.clip + other.clip }
    }

    pub(super) fn minus(self, other: Self) -> Self {
        Self { subject: self.subject - other.subject, clip: self.clip - other.clip }
    }
}

/// The region of a result: an operation, and the rules by which subject and clip are filled.
#[derive(Debug, Clone, Copy)]
pub struct Inside {
    pub op: BooleanOp,
    pub subject: WindingRule,
    pub clip: WindingRule,
}

impl Inside {
    /// Returns whether points with these winding numbers are in the region.
    #[inline]
    pub fn contains(self, winding: Winding) -> bool {
        self.op.keeps(self.subject.fills(winding.subject), self.clip.fills(winding.clip))
    }
}

/// An edge between two nodes; one without inner nodes runs from the lexicographically smaller node
/// to the larger.
#[derive(Debug, Clone, Copy, Default)]
pub struct Edge {
    pub low: u32,
    pub high: u32,
    /// Winding on the left less winding on the right, seen from `low` to `high`.
    pub step: Winding,
}

/// An edge in one of its directions: 2e runs from the low node of edge e to its high node, 2e + 1
/// back.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Half(pub u32);

impl Half {
    /// Returns the edge in the direction from `low` to `high`.
    pub fn forward(edge: usize) -> Self {
        Self((edge as u32) << 1)
    }

    /// Returns its edge.
    #[inline(always)]
    pub fn edge(self) -> usize {
        (self.0 >> 1) as usize
    }

    /// Returns whether it runs from `high` to `low`.
    #[inline(always)]
    pub fn is_back(self) -> bool {
        self.0 & 1 == 1
    }

    /// Returns the same edge in the other direction.
    #[inline(always)]
    pub fn reversed(self) -> Self {
        Self(self.0 ^ 1)
    }
}
