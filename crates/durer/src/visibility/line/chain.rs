//! Straight pieces become long polylines.
//!
//! At each point where ends of one class and invisibility meet, the pair that turns least is joined
//! first, then the next, until one or none is left. O(n log n).

use super::overlap::Piece;
use super::page::GridPoint;
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
    /// In steps.
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

/// Joins the pieces; ends are piece · 2 + which end.
pub(super) fn chains(pieces: &[Piece]) -> Vec<Chain> {
    let partner = partners(pieces);
    let mut used = vec![false; pieces.len()];
    let mut found = Vec::new();
    // Open ones start at their ends; what is left then is closed.
    let open = (0..pieces.len() as u32 * 2).filter(|&end| partner[end as usize] == NONE);
    for start in open.chain((0..pieces.len() as u32).map(|p| p * 2)) {
        if !used[start as usize / 2] {
            found.push(follow(pieces, &partner, start, &mut used));
        }
    }
    found
}

fn follow(pieces: &[Piece], partner: &[u32], start: u32, used: &mut [bool]) -> Chain {
    let point = |end: u32| pieces[end as usize / 2].ends[end as usize & 1];
    let first = &pieces[start as usize / 2];
    let mut points = vec![point(start)];
    let mut end = start;
    let closed = loop {
        used[end as usize / 2] = true;
        let far = end ^ 1;
        let next = partner[far as usize];
        if next == start {
            break true;
        }
        points.push(point(far));
        if next == NONE {
            break false;
        }
        end = next;
    };
    Chain { class: first.class, invisibility: first.invisibility, points, closed }
}

/// For each end of a piece the end that it is joined to.
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

/// The cosine between two pieces leaving one point: −1 goes straight on.
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
