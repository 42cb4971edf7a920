//! Straight pieces become long polylines.
//!
//! At each point where ends of one class and invisibility meet, the pair that turns least is joined
//! first, then the next, until one or none is left. O(n log n).

use super::page::GridPoint;
use super::piece::Piece;
use crate::target::drawing::LineClass;

/// A polyline on the grid.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Chain {
    pub class: LineClass,
    pub invisibility: u32,
    pub points: Vec<GridPoint>,
    pub closed: bool,
}

impl Chain {
    /// Returns the length in steps.
    pub fn length(&self) -> f64 {
        let open: f64 = self.points.windows(2).map(|w| w[0].distance(w[1])).sum();
        match (self.closed, self.points.first(), self.points.last()) {
            (true, Some(a), Some(b)) => open + a.distance(*b),
            _ => open,
        }
    }
}

/// No end of a piece.
const NONE: u32 = u32::MAX;

/// Pieces in a row: the end that each begins at; ends are piece · 2 + which end.
pub(super) struct Walk {
    pub ends: Vec<u32>,
    pub closed: bool,
}

/// Returns the position of an end.
pub(super) fn point(pieces: &[Piece], end: u32) -> GridPoint {
    pieces[end as usize / 2].ends[end as usize & 1]
}

/// Joins the pieces.
pub(super) fn chains(pieces: &[Piece]) -> Vec<Chain> {
    let chain = |walk: Walk| {
        let first = &pieces[walk.ends[0] as usize / 2];
        let mut points: Vec<GridPoint> = walk.ends.iter().map(|&e| point(pieces, e)).collect();
        if let (false, Some(last)) = (walk.closed, walk.ends.last()) {
            points.push(point(pieces, last ^ 1));
        }
        let Walk { closed, .. } = walk;
        Chain { class: first.class, invisibility: first.invisibility, points, closed }
    };
    walks(pieces).into_iter().map(chain).collect()
}

/// Returns the chains as walks over the pieces.
pub(super) fn walks(pieces: &[Piece]) -> Vec<Walk> {
    let partner = partners(pieces);
    let mut used = vec![false; pieces.len()];
    let mut found = Vec::new();
    // Open chains start at their ends; the remaining ones are closed.
    let open = (0..pieces.len() as u32 * 2).filter(|&end| partner[end as usize] == NONE);
    for start in open.chain((0..pieces.len() as u32).map(|p| p * 2)) {
        if !used[start as usize / 2] {
            found.push(follow(&partner, start, &mut used));
        }
    }
    found
}

fn follow(partner: &[u32], start: u32, used: &mut [bool]) -> Walk {
    let mut ends = Vec::new();
    let mut end = start;
    loop {
        used[end as usize / 2] = true;
        ends.push(end);
        match partner[end as usize ^ 1] {
            next if next == start => return Walk { ends, closed: true },
            NONE => return Walk { ends, closed: false },
            next => end = next,
        }
    }
}

/// Returns, for each end of a piece, the end that it is joined to.
fn partners(pieces: &[Piece]) -> Vec<u32> {
    let mut ends: Vec<(u32, LineClass, GridPoint, u32)> = (0..pieces.len() as u32 * 2)
        .map(|end| {
            let piece = &pieces[end as usize / 2];
            (piece.invisibility, piece.class, piece.ends[end as usize & 1], end)
        })
        .collect();
    ends.sort_unstable();
    let mut partner = vec![NONE; pieces.len() * 2];
    let mut pairs: Vec<(f64, u32, u32)> = Vec::new();
    for group in ends.chunk_by(|a, b| (a.0, a.1, a.2) == (b.0, b.1, b.2)) {
        match group {
            [_] => {}
            [a, b] => {
                (partner[a.3 as usize], partner[b.3 as usize]) = (b.3, a.3);
            }
            // A hub of many lines is joined in pairs as they come: its square would be too much.
            _ if group.len() > 64 => {
                for pair in group.chunks_exact(2) {
                    (partner[pair[0].3 as usize], partner[pair[1].3 as usize]) =
                        (pair[1].3, pair[0].3);
                }
            }
            _ => {
                pairs.clear();
                for (i, a) in group.iter().enumerate() {
                    pairs.extend(group[i + 1..].iter().map(|b| (turn(pieces, a.3, b.3), a.3, b.3)));
                }
                pairs
                    .sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
                for &(_, a, b) in &pairs {
                    if partner[a as usize] == NONE && partner[b as usize] == NONE {
                        (partner[a as usize], partner[b as usize]) = (b, a);
                    }
                }
            }
        }
    }
    partner
}

/// Returns the cosine between two pieces leaving one point: −1 goes straight on.
fn turn(pieces: &[Piece], a: u32, b: u32) -> f64 {
    let away = |end: u32| {
        let ends = pieces[end as usize / 2].ends;
        let [x, y] = ends[(end as usize & 1) ^ 1].minus(ends[end as usize & 1]).map(|d| d as f64);
        let length = (x * x + y * y).sqrt();
        (x / length, y / length)
    };
    let ((ax, ay), (bx, by)) = (away(a), away(b));
    ax * bx + ay * by
}
