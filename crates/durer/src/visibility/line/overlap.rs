//! Coincident lines are drawn once.
//!
//! Pieces are processed in the order of preference (visible before hidden, then by class, then the longest); the parts
//! that an earlier piece covers are cut from later ones. Candidates come from a uniform grid; O(n) for lines that are
//! not crowded.

use super::page::GridPoint;
use super::piece::Piece;
use super::table::Table;
use std::cmp::Reverse;

/// Two lines that diverge more than this lie beside each other, however close: they are the two
/// sides of a corner.
const PARALLEL: f64 = 0.02;

/// Largest turn of a piece's rest, as a part of its length, that makes it end where another does.
const TURN: f64 = 0.05;

/// Distances, in steps, at which lines are drawn once.
#[derive(Debug, Clone, Copy)]
pub(super) struct Near<'a> {
    /// Lines within this lie on each other.
    pub close: f64,
    /// Creases and silhouettes of round parts go where they lie within this of an earlier line, if it is more.
    pub beside: f64,
    /// Hidden lines go where they lie within this of a visible one, if it is more.
    pub beneath: f64,
    /// Pieces not longer than this that a cut leaves are dropped.
    pub sliver: f64,
    /// Points at which sharp edges meet, sorted: hidden lines between two of these may be left out though
    /// they do not run along a visible one.
    pub corners: &'a [GridPoint],
}

/// Returns the pieces without those that lie on another along their length.
pub(super) fn drawn_once(mut pieces: Vec<Piece>, how: Near<'_>) -> Vec<Piece> {
    pieces.retain(|p| p.ends[0] != p.ends[1]);
    // The first in rank comes last, and is taken from there.
    pieces.sort_unstable_by_key(|p| Reverse(p.rank()));
    let Some(mut table) = Table::new(&pieces, how.close) else { return pieces };
    let mut kept: Vec<Piece> = Vec::with_capacity(pieces.len());
    let mut near: Vec<u32> = Vec::new();
    let mut gone: Vec<Gone> = Vec::new();
    while let Some(piece) = pieces.pop() {
        // The edges of a large mesh are many: memory of processed ones is released as results grow.
        if pieces.len() < pieces.capacity() / 8 * 7 {
            pieces.shrink_to_fit();
        }
        let close = if piece.may_end_anywhere() { how.close.max(how.beside) } else { how.close };
        let beneath = if piece.invisibility > 0 { how.beneath } else { 0.0 };
        near.clear();
        table.cells(&piece.ends, close.max(beneath), |list| near.extend_from_slice(list));
        near.sort_unstable();
        near.dedup();
        gone.clear();
        for other in near.iter().map(|&i| &kept[i as usize]) {
            gone.extend(overlap(&piece, other, close));
            if beneath > 0.0 && other.invisibility == 0 {
                gone.extend(under(&piece, other, how));
            }
        }
        let first = kept.len();
        if gone.is_empty() {
            kept.push(piece);
        } else {
            gone.sort_unstable_by(|a, b| a.from.0.total_cmp(&b.from.0));
            rest(&piece, &gone, how.sliver.max(beneath), &mut kept);
        }
        for (i, piece) in kept.iter().enumerate().skip(first) {
            table.enter(piece.ends, how.close, i as u32);
        }
    }
    kept
}

/// The part of a piece that lies on another one: where it begins and ends, in steps from its first end,
/// and the point of the other that lies there, if that one ends there.
#[derive(Debug, Clone, Copy)]
struct Gone {
    from: (f64, Option<GridPoint>),
    to: (f64, Option<GridPoint>),
}

/// A piece seen along another: the ends by how far along they lie and how far aside, the nearer first.
struct Along {
    length: f64,
    ends: [(f64, f64, GridPoint); 2],
}

impl Along {
    fn new(piece: &Piece, other: &Piece) -> Self {
        let length = piece.length();
        let [ux, uy] = piece.ends[1].minus(piece.ends[0]).map(|d| d as f64 / length);
        let [a, b] = other.ends.map(|e| {
            let [x, y] = e.minus(piece.ends[0]).map(|d| d as f64);
            (ux * x + uy * y, ux * y - uy * x, e)
        });
        Self { length, ends: if a.0 <= b.0 { [a, b] } else { [b, a] } }
    }

    /// Returns the common part of both, along the first.
    fn common(&self) -> Option<Gone> {
        let ([a, b], length) = (self.ends, self.length);
        let from = if a.0 > 0.0 { (a.0, Some(a.2)) } else { (0.0, None) };
        let to = if b.0 < length { (b.0, Some(b.2)) } else { (length, None) };
        (to.0 - from.0 > 1.0).then_some(Gone { from, to })
    }

    /// Returns the distance of the other from a place, sideways.
    fn aside(&self, s: f64) -> f64 {
        let [a, b] = self.ends;
        a.1 + (b.1 - a.1) * ((s - a.0) / (b.0 - a.0))
    }
}

/// Returns the part of `piece` that lies on `other`.
fn overlap(piece: &Piece, other: &Piece, close: f64) -> Option<Gone> {
    let along = Along::new(piece, other);
    let common = along.common()?;
    let near = close.min(2.0 + PARALLEL * (common.to.0 - common.from.0));
    let is_near = |s: f64| along.aside(s).abs() <= near;
    (is_near(common.from.0) && is_near(common.to.0)).then_some(common)
}

/// Returns the part of `piece` that lies under `other`, beside it: any part that runs along it, and short
/// edges whole. Curves that pass under it consist of short pieces too, but those do not end at corners.
fn under(piece: &Piece, other: &Piece, how: Near<'_>) -> Option<Gone> {
    let (along, beneath) = (Along::new(piece, other), how.beneath);
    let is_edge_within =
        |p: &GridPoint| distance(*p, other) <= beneath && how.corners.binary_search(p).is_ok();
    if piece.ends.iter().all(is_edge_within) {
        return Some(Gone { from: (0.0, None), to: (along.length, None) });
    }
    let mut common = along.common()?;
    let asides = [common.from.0, common.to.0].map(|s| along.aside(s));
    let parallel = 2.0 + PARALLEL * (common.to.0 - common.from.0);
    let lies =
        asides.iter().all(|a| a.abs() <= beneath) && (asides[0] - asides[1]).abs() <= parallel;
    (common.from.1, common.to.1) = (None, None);
    lies.then_some(common)
}

/// Adds the parts of a piece outside the sorted parts. It ends at the ends of the lines that it lay on, if
/// that turns it by little.
fn rest(piece: &Piece, gone: &[Gone], sliver: f64, kept: &mut Vec<Piece>) {
    let length = piece.length();
    let at = |s: f64| {
        let [dx, dy] = piece.ends[1].minus(piece.ends[0]).map(|d| d as f64 * (s / length));
        let [x, y] = [dx.round() as i32, dy.round() as i32];
        GridPoint { x: piece.ends[0].x + x, y: piece.ends[0].y + y }
    };
    let mut keep = |from: (f64, Option<GridPoint>), to: (f64, Option<GridPoint>)| {
        let point = |(s, known): (f64, Option<GridPoint>)| {
            let on = at(s);
            known.filter(|p| p.distance(on) <= (to.0 - from.0) * TURN).unwrap_or(on)
        };
        let start = if from.0 <= 0.0 { piece.ends[0] } else { point(from) };
        let end = if to.0 >= length { piece.ends[1] } else { point(to) };
        if to.0 - from.0 > sliver && start != end {
            kept.push(Piece { ends: [start, end], ..*piece });
        }
    };
    let mut done = (0.0_f64, None);
    for part in gone {
        keep(done, part.from);
        if part.to.0 > done.0 {
            done = part.to;
        }
    }
    keep(done, (length, None));
}

/// Returns the distance of a point from a piece.
pub(super) fn distance(p: GridPoint, piece: &Piece) -> f64 {
    let ([px, py], [dx, dy]) = (
        p.minus(piece.ends[0]).map(|d| d as f64),
        piece.ends[1].minus(piece.ends[0]).map(|d| d as f64),
    );
    let t = ((px * dx + py * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
    let (x, y) = (px - t * dx, py - t * dy);
    (x * x + y * y).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::drawing::LineClass;

    fn near(close: f64, sliver: f64) -> Near<'static> {
        Near { close, beside: 0.0, beneath: 0.0, sliver, corners: &[] }
    }

    #[test]
    fn hidden_lines_go_under_visible_ones_beside_them() {
        let line = |ends: [[i32; 2]; 2], invisibility: u32| Piece {
            ends: ends.map(|[x, y]| GridPoint { x, y }),
            class: LineClass::Border,
            invisibility,
            smooth: false,
        };
        let seen = line([[0, 0], [10_000, 0]], 0);
        let left = |ends: [[i32; 2]; 2]| {
            let corners = [[3000, 0], [3000, 180]].map(|[x, y]| GridPoint { x, y });
            let how = Near { beneath: 200.0, corners: &corners, ..near(2.0, 64.0) };
            drawn_once(vec![line(ends, 1), seen], how)[1..].to_vec()
        };
        // Beside it, and a little longer; from it to neighbouring lines; and longer ones by more.
        assert_eq!(left([[100, 150], [10_100, 150]]), []);
        assert_eq!(left([[3000, 0], [3000, 180]]), []);
        assert_eq!(left([[100, 150], [12_000, 150]]), [line([[10_000, 150], [12_000, 150]], 1)]);
        // Across it, at an angle to it, and farther away.
        for ends in [
            [[500, -300], [500, 300]],
            [[0, 0], [5000, 190]],
            [[0, 300], [9000, 300]],
            [[4000, 0], [4000, 180]],
        ] {
            assert_eq!(left(ends), [line(ends, 1)]);
        }
    }

    #[test]
    fn what_is_cut_off_ends_where_the_other_does() {
        let line = |ends: [[i32; 2]; 2]| Piece {
            ends: ends.map(|[x, y]| GridPoint { x, y }),
            class: LineClass::Border,
            invisibility: 0,
            smooth: false,
        };
        let (long, short) = (line([[0, 0], [9000, 0]]), line([[5000, 3], [12_000, 5]]));
        let kept = drawn_once(vec![short, long], near(10.0, 64.0));
        assert_eq!(kept, [long, line([[9000, 0], [12_000, 5]])]);
    }

    #[test]
    fn slivers_that_a_cut_leaves_are_dropped() {
        let line = |from: i32, to: i32| Piece {
            ends: [GridPoint { x: from, y: 0 }, GridPoint { x: to, y: 0 }],
            class: LineClass::Border,
            invisibility: 0,
            smooth: false,
        };
        let (long, short) = (line(0, 100_000), line(90_000, 100_050));
        assert_eq!(drawn_once(vec![short, long], near(10.0, 64.0)), [long]);
        assert_eq!(drawn_once(vec![short, long], near(10.0, 10.0)), [long, line(100_000, 100_050)]);
    }

    #[test]
    fn what_is_left_of_a_bundle_does_not_depend_on_the_order() {
        let line = |x: i32, y: i32| Piece {
            ends: [GridPoint { x: 0, y: 0 }, GridPoint { x, y }],
            class: LineClass::Border,
            invisibility: 0,
            smooth: false,
        };
        // Each overlaps the next; the first and the last are apart.
        let bundle = [line(90_000, 0), line(100_000, 60), line(95_000, 114)];
        for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let pieces = order.map(|i| bundle[i]).to_vec();
            assert_eq!(drawn_once(pieces, near(100.0, 64.0)), [bundle[1]], "{order:?}");
        }
    }
}
