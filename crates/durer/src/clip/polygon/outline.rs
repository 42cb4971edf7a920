//! Simple rings from the closed walks that bound a region: OGC-valid polygons have no others.
//!
//! Walks may pass a point several times, and two of them may run along one edge in both directions, which bounds
//! nothing. The remaining edges are joined again at such points, so that every joint has one wedge of the inside on its
//! left; then each closed path is divided where it meets itself.

use super::group::is_flat;
use crate::math::{DVec2, in_sector};
use crate::sorting::CompactSort;
use std::cmp::Ordering;

/// A directed edge between two places, the inside on its left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Edge {
    from: usize,
    to: usize,
}

/// Compares by x, then y; zeros of either sign are one place.
fn order(a: &DVec2, b: &DVec2) -> Ordering {
    (a.x + 0.0).total_cmp(&(b.x + 0.0)).then((a.y + 0.0).total_cmp(&(b.y + 0.0)))
}

/// Returns the rings of the region that walks bound, the inside on the left of them.
pub(super) fn simple_rings(walks: &[Vec<DVec2>]) -> Vec<Vec<DVec2>> {
    let mut places: Vec<DVec2> = walks.iter().flatten().copied().collect();
    places.compact_sort_by(order);
    places.dedup();
    let edges = remaining(&edges(walks, &places));
    let next = joints(&edges, &places);
    let mut rings = Vec::new();
    let mut used = vec![false; edges.len()];
    // Index on the path at which each place occurs.
    let mut standing = vec![usize::MAX; places.len()];
    for start in 0..edges.len() {
        let mut way: Vec<usize> = Vec::new();
        let mut edge = start;
        while !std::mem::replace(&mut used[edge], true) {
            let from = edges[edge].from;
            standing[from] = way.len();
            way.push(from);
            if let Some(loop_start) = Some(standing[edges[edge].to]).filter(|&at| at < way.len()) {
                let ring: Vec<DVec2> = way[loop_start..].iter().map(|&p| places[p]).collect();
                for p in way.drain(loop_start..) {
                    standing[p] = usize::MAX;
                }
                rings.push(ring);
            }
            edge = next[edge];
        }
    }
    rings.retain(|ring| !is_flat(ring));
    rings
}

fn edges(walks: &[Vec<DVec2>], places: &[DVec2]) -> Vec<Edge> {
    let place = |p: &DVec2| places.partition_point(|q| order(q, p).is_lt());
    let mut edges = Vec::new();
    for walk in walks {
        let walk: Vec<usize> = walk.iter().map(place).collect();
        let ends = walk.iter().zip(walk.iter().cycle().skip(1));
        edges.extend(ends.filter(|(a, b)| a != b).map(|(&from, &to)| Edge { from, to }));
    }
    edges
}

/// Returns the edges without pairs of opposite ones.
fn remaining(edges: &[Edge]) -> Vec<Edge> {
    let key = |i: usize| (edges[i].from.min(edges[i].to), edges[i].from.max(edges[i].to));
    let mut order: Vec<usize> = (0..edges.len()).collect();
    order.compact_sort_by_key(|&i| (key(i), i));
    let mut kept = vec![true; edges.len()];
    for same in order.chunk_by(|&i, &j| key(i) == key(j)) {
        let (up, down): (Vec<usize>, Vec<usize>) =
            same.iter().partition(|&&i| edges[i].from < edges[i].to);
        for (&i, &j) in up.iter().zip(&down) {
            (kept[i], kept[j]) = (false, false);
        }
    }
    edges.iter().zip(kept).filter(|(_, kept)| *kept).map(|(&edge, _)| edge).collect()
}

/// Returns for each edge the one to go on with: at a place that is passed several times, the first one clockwise,
/// which bounds the same wedge.
fn joints(edges: &[Edge], places: &[DVec2]) -> Vec<usize> {
    let sorted = |place: fn(&Edge) -> usize| {
        let mut order: Vec<usize> = (0..edges.len()).collect();
        order.compact_sort_by_key(|&i| (place(&edges[i]), i));
        order
    };
    let (arriving, mut leaving) = (sorted(|e| e.to), sorted(|e| e.from));
    // As many edges arrive at a place as leave it: both orders run in step.
    let mut next = vec![0; edges.len()];
    for (k, &i) in arriving.iter().enumerate() {
        let at = edges[i].to;
        let count = leaving[k..].iter().take_while(|&&j| edges[j].from == at).count();
        let nearest = |best: usize, j: usize| {
            let ray = |j: usize| places[edges[leaving[j]].to];
            if in_sector(places[at], ray(best), ray(j), places[edges[i].from]) { j } else { best }
        };
        let best = (k + 1..k + count).fold(k, nearest);
        leaving[k..=best].rotate_right(1);
        next[i] = leaving[k];
    }
    next
}
