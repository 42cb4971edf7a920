//! Lines that lie on each other are drawn once.
//!
//! Pieces are taken in the order of preference (visible before hidden, then by class, then the longest);
//! what an earlier one covers is cut from a later one. Candidates come from a uniform grid; O(n) for lines that do
//! not crowd.

use super::page::GridPoint;
use super::table::Table;
use crate::target::drawing::LineClass;
use std::cmp::Reverse;

/// A straight piece on the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    pub ends: [GridPoint; 2],
    pub class: LineClass,
    pub invisibility: u32,
    /// Whether it is a silhouette across a part of the surface that is not sharp there.
    pub smooth: bool,
}

impl Piece {
    /// Silhouettes of round parts and creases; what else ends in the open has a reason.
    pub fn may_end_anywhere(&self) -> bool {
        self.smooth || self.class == LineClass::Crease
    }

    pub fn length(&self) -> f64 {
        self.ends[0].distance(self.ends[1])
    }

    /// Of lines in a bundle each lies on the next and the first not on the last, so what is left
    /// depends on which comes first: that must not be left to the order of the faces.
    fn rank(&self) -> impl Ord + use<> {
        let [dx, dy] = self.ends[1].minus(self.ends[0]);
        (self.invisibility, self.class, Reverse(dx * dx + dy * dy), self.smooth, self.ends)
    }
}

/// Two lines that diverge more than this lie beside each other, however close: they are the two
/// sides of a corner.
const PARALLEL: f64 = 0.02;

/// What is left of the pieces where none lies within `close` steps of another along its length;
/// pieces not longer than `sliver` that a cut leaves are dropped. Creases and silhouettes of round parts
/// go where they lie `beside` an earlier line, if that is more.
pub(super) fn drawn_once(
    mut pieces: Vec<Piece>,
    close: f64,
    beside: f64,
    sliver: f64,
) -> Vec<Piece> {
    pieces.retain(|p| p.ends[0] != p.ends[1]);
    // The first in rank comes last, and is taken from there.
    pieces.sort_unstable_by_key(|p| Reverse(p.rank()));
    let Some(table) = Table::new(&pieces, close) else { return pieces };
    let (mut table, entered) = (table, close);
    let mut kept: Vec<Piece> = Vec::with_capacity(pieces.len());
    let mut near: Vec<u32> = Vec::new();
    let mut gone: Vec<(f64, f64)> = Vec::new();
    while let Some(piece) = pieces.pop() {
        // All edges of a large mesh are many: what is done gives way to what is kept.
        if pieces.len() < pieces.capacity() / 8 * 7 {
            pieces.shrink_to_fit();
        }
        near.clear();
        let close = if piece.may_end_anywhere() { close.max(beside) } else { close };
        table.cells(&piece.ends, close, |list| near.extend_from_slice(list));
        near.sort_unstable();
        near.dedup();
        gone.clear();
        gone.extend(near.iter().filter_map(|&i| overlap(&piece, &kept[i as usize], close)));
        let first = kept.len();
        if gone.is_empty() {
            kept.push(piece);
        } else {
            gone.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
            rest(&piece, &gone, sliver, &mut kept);
        }
        for (i, piece) in kept.iter().enumerate().skip(first) {
            table.enter(piece.ends, entered, i as u32);
        }
    }
    kept
}

/// Which part of `piece`, in steps from its first end, lies on `other`.
fn overlap(piece: &Piece, other: &Piece, close: f64) -> Option<(f64, f64)> {
    let length = piece.length();
    let [ux, uy] = piece.ends[1].minus(piece.ends[0]).map(|d| d as f64 / length);
    let ends = other.ends.map(|e| {
        let [x, y] = e.minus(piece.ends[0]).map(|d| d as f64);
        (ux * x + uy * y, ux * y - uy * x)
    });
    let [a, b] = if ends[0].0 <= ends[1].0 { ends } else { [ends[1], ends[0]] };
    let (from, to) = (a.0.max(0.0), b.0.min(length));
    if to - from <= 1.0 {
        return None;
    }
    let aside = |s: f64| (a.1 + (b.1 - a.1) * ((s - a.0) / (b.0 - a.0))).abs();
    let near = close.min(2.0 + PARALLEL * (to - from));
    (aside(from) <= near && aside(to) <= near).then_some((from, to))
}

/// What the sorted parts leave of a piece.
fn rest(piece: &Piece, gone: &[(f64, f64)], sliver: f64, kept: &mut Vec<Piece>) {
    let length = piece.length();
    let at = |s: f64| {
        let [dx, dy] = piece.ends[1].minus(piece.ends[0]).map(|d| d as f64 * (s / length));
        let [x, y] = [dx.round() as i32, dy.round() as i32];
        GridPoint { x: piece.ends[0].x + x, y: piece.ends[0].y + y }
    };
    let mut keep = |from: f64, to: f64| {
        let start = if from <= 0.0 { piece.ends[0] } else { at(from) };
        let end = if to >= length { piece.ends[1] } else { at(to) };
        if to - from > sliver && start != end {
            kept.push(Piece { ends: [start, end], ..*piece });
        }
    };
    let mut done = 0.0_f64;
    for &(from, to) in gone {
        keep(done, from);
        done = done.max(to);
    }
    keep(done, length);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slivers_that_a_cut_leaves_are_dropped() {
        let line = |from: i32, to: i32| Piece {
            ends: [GridPoint { x: from, y: 0 }, GridPoint { x: to, y: 0 }],
            class: LineClass::Border,
            invisibility: 0,
            smooth: false,
        };
        let (long, short) = (line(0, 100_000), line(90_000, 100_050));
        assert_eq!(drawn_once(vec![short, long], 10.0, 0.0, 64.0), [long]);
        assert_eq!(drawn_once(vec![short, long], 10.0, 0.0, 10.0), [long, line(100_000, 100_050)]);
    }

    #[test]
    fn what_is_left_of_a_bundle_does_not_depend_on_the_order() {
        let line = |x: i32, y: i32| Piece {
            ends: [GridPoint { x: 0, y: 0 }, GridPoint { x, y }],
            class: LineClass::Border,
            invisibility: 0,
            smooth: false,
        };
        // Each lies on the next; the first and the last are apart.
        let bundle = [line(90_000, 0), line(100_000, 60), line(95_000, 114)];
        for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let pieces = order.map(|i| bundle[i]).to_vec();
            assert_eq!(drawn_once(pieces, 100.0, 0.0, 64.0), [bundle[1]], "{order:?}");
        }
    }
}
