//! Outlines of smooth surfaces without zigzags.
//!
//! Where triangles are slivers, an outline may cross their sides in another order in the picture than along the
//! outline. An outline can turn back at a cusp, but then one of its sides is hidden; one that turns back twice, and is
//! entirely visible, is noise of the mesh. The part between the turns becomes one point. O(n log n).

use super::chain::{point, walks};
use super::page::GridPoint;
use super::piece::Piece;

/// Removes the parts of smooth outlines that run back and forth.
pub(super) fn without_zigzags(pieces: &mut Vec<Piece>) {
    let (mut smooth, others): (Vec<Piece>, Vec<Piece>) = pieces.iter().partition(|p| p.smooth);
    for walk in walks(&smooth) {
        straighten(&mut smooth, &walk.ends);
    }
    smooth.retain(|p| p.ends[0] != p.ends[1]);
    *pieces = others;
    pieces.append(&mut smooth);
}

/// Removes those parts from pieces in a row, which are given by the ends that they begin at.
fn straighten(pieces: &mut [Piece], row: &[u32]) {
    let mut places: Vec<GridPoint> = row.iter().map(|end| point(pieces, *end)).collect();
    places.extend(row.last().map(|end| point(pieces, end ^ 1)));
    let length = |from: usize, to: usize| {
        places[from..=to].windows(2).map(|w| w[0].distance(w[1])).sum::<f64>()
    };
    let turns: Vec<usize> = (1..row.len()).filter(|k| turns_back(&places, *k)).collect();
    let mut next = 0;
    let mut done = 0;
    while let Some(&[first, second]) = turns.get(next..next + 2).and_then(|t| t.first_chunk()) {
        let end = turns.get(next + 2).copied().unwrap_or(row.len());
        let between = length(first, second);
        if between > length(done, first).min(length(second, end)) {
            next += 1;
            done = first;
            continue;
        }
        let middle = halfway(places[first], places[second]);
        set(pieces, row[first - 1] ^ 1, middle);
        set(pieces, row[second], middle);
        for end in &row[first..second] {
            set(pieces, *end, middle);
            set(pieces, end ^ 1, middle);
        }
        (next, done) = (next + 2, second);
    }
}

fn turns_back(places: &[GridPoint], k: usize) -> bool {
    let [ax, ay] = places[k].minus(places[k - 1]);
    let [bx, by] = places[k + 1].minus(places[k]);
    ax * bx + ay * by < 0
}

fn set(pieces: &mut [Piece], end: u32, at: GridPoint) {
    pieces[end as usize / 2].ends[end as usize & 1] = at;
}

fn halfway(a: GridPoint, b: GridPoint) -> GridPoint {
    let middle = |a: i32, b: i32| ((i64::from(a) + i64::from(b)) / 2) as i32;
    GridPoint { x: middle(a.x, b.x), y: middle(a.y, b.y) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::drawing::LineClass;

    fn row(places: &[[i32; 2]], smooth: bool) -> Vec<Piece> {
        let at = |[x, y]: [i32; 2]| GridPoint { x, y };
        let piece = |w: &[[i32; 2]]| Piece {
            ends: [at(w[0]), at(w[1])],
            class: LineClass::Silhouette,
            invisibility: 0,
            smooth,
        };
        places.windows(2).map(piece).collect()
    }

    #[test]
    fn what_runs_back_and_forth_becomes_a_point() {
        let zigzag = [[0, 0], [1000, 0], [900, 20], [920, 30], [1900, 50]];
        let mut pieces = row(&zigzag, true);
        without_zigzags(&mut pieces);
        assert_eq!(pieces, row(&[[0, 0], [950, 10], [920, 30], [1900, 50]], true));
        // Sharp edges, a single turn and a long way back stay unchanged.
        let cases: [(&[[i32; 2]], bool); 3] = [
            (&zigzag, false),
            (&[[0, 0], [1000, 0], [900, 20]], true),
            (&[[0, 0], [500, 0], [0, 200], [500, 300]], true),
        ];
        for (places, smooth) in cases {
            let mut pieces = row(places, smooth);
            without_zigzags(&mut pieces);
            assert_eq!(pieces, row(places, smooth));
        }
    }
}
