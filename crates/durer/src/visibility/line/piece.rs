//! A straight piece of a line.

use super::page::GridPoint;
use crate::target::drawing::LineClass;
use std::cmp::Reverse;

/// A straight piece on the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    pub ends: [GridPoint; 2],
    pub class: LineClass,
    pub invisibility: u32,
    /// True if it is a silhouette across a part of the surface that is not sharp there.
    pub smooth: bool,
}

impl Piece {
    /// Returns whether it may end in the open without a reason, as silhouettes of round parts and creases may.
    pub fn may_end_anywhere(&self) -> bool {
        self.smooth || self.class == LineClass::Crease
    }

    pub fn length(&self) -> f64 {
        self.ends[0].distance(self.ends[1])
    }

    /// Returns the rank of a line in a bundle: each lies on the next and the first not on the last,
    /// so the rest depends on which comes first, and that must not depend on the order of the
    /// faces.
    pub fn rank(&self) -> impl Ord + use<> {
        let [dx, dy] = self.ends[1].minus(self.ends[0]);
        (self.invisibility, self.class, Reverse(dx * dx + dy * dy), self.smooth, self.ends)
    }
}
