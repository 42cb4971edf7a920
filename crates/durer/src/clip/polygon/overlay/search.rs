//! Finds the edge below a node by walking down the grid.

use std::cmp::Ordering;

use super::arrangement::Arrangement;
use super::edge::Half;
use super::grid::Grid;
use super::lattice::{Coord, Point, Segment, cross};
use super::noding::Noding;

/// Search for the edge below a node.
#[derive(Debug)]
pub struct Search<'a, C> {
    pub grid: &'a Grid,
    pub segments: &'a [Segment<C>],
    pub noding: &'a Noding<C>,
}

/// A straight piece of an edge, from left to right.
#[derive(Debug, Clone, Copy)]
struct Piece<C> {
    half: Half,
    a: Point<C>,
    b: Point<C>,
}

impl<C: Coord> Search<'_, C> {
    /// Returns for each of some nodes, in the order of their points, the highest of the edges that pass just left of
    /// it, strictly below it, and that `take` accepts, in the direction in which it passes to the right.
    pub fn below_each(
        &self,
        graph: &Arrangement<C>,
        nodes: impl Iterator<Item = u32>,
        take: impl Fn(usize) -> bool,
    ) -> Vec<Option<Half>> {
        let mut last: Option<(Point<C>, Option<Half>)> = None;
        let below = nodes.map(|node| {
            let p = graph.nodes[node as usize];
            // Many points may be directly below one another, as in a lattice of holes: then the next one has the same
            // answer.
            let known = last.filter(|(q, _)| q.x == p.x).map(|(q, half)| (q.y.i64(), half));
            let half = self.below(graph, p, known, &take);
            last = Some((p, half));
            half
        });
        below.collect()
    }

    /// Returns the edge below a point; `known` is a height at the same x, not above it, and the answer there.
    fn below(
        &self,
        graph: &Arrangement<C>,
        p: Point<C>,
        known: Option<(i64, Option<Half>)>,
        take: &impl Fn(usize) -> bool,
    ) -> Option<Half> {
        let (x, mut y) = (p.x.i64(), p.y.i64());
        let mut best: Option<Piece<C>> = None;
        while let Some((block, items)) = self.grid.locate(x, y) {
            self.highest(graph, items, p, take, &mut best);
            let floor = Point { x: p.x, y: C::from_i64(block.min.1) };
            if best.is_some_and(|top| cross(top.a, top.b, floor) <= C::Wide::default()) {
                break;
            }
            match known {
                Some((height, half)) if block.min.1 <= height => return half,
                _ => y = block.min.1 - 1,
            }
        }
        best.map(|piece| piece.half)
    }

    fn highest(
        &self,
        graph: &Arrangement<C>,
        items: &[u32],
        p: Point<C>,
        take: &impl Fn(usize) -> bool,
        best: &mut Option<Piece<C>>,
    ) {
        for &i in items {
            let s = &self.segments[i as usize];
            if s.a.x >= p.x || s.b.x < p.x || s.y_range().0 > p.y {
                continue;
            }
            let Some((from, to)) = self.piece_before(graph, i as usize, p.x) else { continue };
            let (a, b) = (graph.nodes[from as usize], graph.nodes[to as usize]);
            if cross(a, b, p) <= C::Wide::default() {
                continue;
            }
            let Some(half) = graph.between(from, to) else { continue };
            let piece = Piece { half, a, b };
            if take(half.edge()) && best.is_none_or(|top| piece.is_above(&top)) {
                *best = Some(piece);
            }
        }
    }

    /// Returns the ends of the piece of a segment that passes just left of x.
    fn piece_before(&self, graph: &Arrangement<C>, segment: usize, x: C) -> Option<(u32, u32)> {
        let chain = self.noding.chain(segment);
        let k = chain.partition_point(|&n| graph.nodes[n as usize].x < x);
        Some((*chain.get(k.checked_sub(1)?)?, *chain.get(k)?))
    }
}

impl<C: Coord> Piece<C> {
    /// Returns whether it is above another one, if both pass a common x and neither is vertical.
    fn is_above(&self, other: &Self) -> bool {
        let zero = C::Wide::default();
        let ((a, b), (c, d)) = ((self.a, self.b), (other.a, other.b));
        if a >= c {
            let side = cross(c, d, a).cmp(&zero).then_with(|| cross(c, d, b).cmp(&zero));
            side == Ordering::Greater
        } else {
            let side = cross(a, b, c).cmp(&zero).then_with(|| cross(a, b, d).cmp(&zero));
            side == Ordering::Less
        }
    }
}
