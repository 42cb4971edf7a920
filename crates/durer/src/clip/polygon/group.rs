//! Rings grouped into polygons by how they nest: exact, by examining every edge.

use super::point::{Place, locate};
use super::{Ring, Shapes, WindingRule, signed_area};
use crate::math::{DVec2, Orientation, Rect, orient2d};

/// Returns whether `inner` lies within `outer`, for rings that touch at most in points or along
/// edges.
fn within(inner: &Ring, outer: &Ring) -> bool {
    let next = |i: usize| inner.get(i + 1).or(inner.first()).copied().unwrap_or_default();
    let middles = inner.iter().enumerate().map(|(i, &p)| (p + next(i)) * 0.5);
    let places =
        inner.iter().copied().chain(middles).map(|p| locate([outer], p, WindingRule::EvenOdd));
    places.into_iter().find(|&place| place != Place::Border) == Some(Place::Inside)
}

/// Returns whether all points of a ring lie on one line; exact.
pub(super) fn is_flat(ring: &Ring) -> bool {
    let Some(&a) = ring.first() else { return true };
    let Some(&b) = ring.iter().find(|&&b| b != a) else { return true };
    ring.iter().all(|&c| orient2d(a, b, c) == Orientation::Collinear)
}

/// Returns for each ring the rings around it; boxes are compared first, in the order of their left sides.
fn parents(rings: &[Vec<DVec2>]) -> Vec<Vec<usize>> {
    let mut parents = vec![Vec::new(); rings.len()];
    let boxes = rings.iter().map(|ring| Rect::around(ring.iter().copied()));
    let mut order: Vec<(Rect, usize)> =
        boxes.enumerate().filter_map(|(i, around)| Some((around?, i))).collect();
    order.sort_by(|(a, _), (b, _)| a.min().x.total_cmp(&b.min().x));
    let mut active: Vec<(Rect, usize)> = Vec::new();
    for (inner, i) in order {
        active.retain(|(outer, _)| outer.max().x >= inner.min().x);
        for &(outer, j) in &active {
            let mut look = |outer: Rect, j: usize, inner: Rect, i: usize| {
                let holds = outer.contains(inner.min()) && outer.contains(inner.max());
                if holds && within(&rings[i], &rings[j]) {
                    parents[i].push(j);
                }
            };
            look(outer, j, inner, i);
            look(inner, i, outer, j);
        }
        active.push((inner, i));
    }
    parents
}

/// Groups rings into polygons: a ring within an odd number of others is a hole of the innermost of
/// them. The resulting outer rings are counter-clockwise, holes clockwise.
pub(super) fn group(rings: Vec<Vec<DVec2>>) -> Shapes {
    let parents = parents(&rings);
    let depth = |i: usize| parents[i].len();
    let mut holes: Vec<Vec<usize>> = vec![Vec::new(); rings.len()];
    for hole in (0..rings.len()).filter(|&i| depth(i) % 2 == 1) {
        if let Some(&outer) = parents[hole].iter().find(|&&j| depth(j) + 1 == depth(hole)) {
            holes[outer].push(hole);
        }
    }
    let oriented = |i: usize, positive: bool| {
        let mut ring = rings[i].clone();
        if (signed_area(&ring) > 0.0) != positive {
            ring.reverse();
        }
        ring
    };
    let mut shapes = Shapes::new();
    for outer in (0..rings.len()).filter(|&i| depth(i) % 2 == 0) {
        shapes.push_ring(oriented(outer, true));
        for &hole in &holes[outer] {
            shapes.push_ring(oriented(hole, false));
        }
        shapes.end_polygon();
    }
    shapes
}
