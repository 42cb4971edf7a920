//! Where a point lies of rings, and which ring lies in which: exact, by looking at every edge.

use super::{Ring, Shapes, signed_area};
use crate::math::{DVec2, Orientation, Rect, orient2d};

/// Where a point lies of a region.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    Inside,
    Border,
    Outside,
}

/// Whether a point lies on a closed segment; exact.
pub(super) fn on_segment(a: DVec2, b: DVec2, p: DVec2) -> bool {
    let (low, high) = (a.min(b), a.max(b));
    p.cmpge(low).all() && p.cmple(high).all() && orient2d(a, b, p) == Orientation::Collinear
}

/// Where a point lies of the region that rings enclose by the even-odd rule; exact.
pub(super) fn locate<'a>(rings: impl IntoIterator<Item = &'a Ring>, p: DVec2) -> Place {
    let mut inside = false;
    for ring in rings {
        let Some(&last) = ring.last() else { continue };
        let mut a = last;
        for &b in ring {
            if on_segment(a, b, p) {
                return Place::Border;
            }
            if (a.y > p.y) != (b.y > p.y) {
                let left = orient2d(a, b, p) == Orientation::CounterClockwise;
                inside ^= left == (b.y > a.y);
            }
            a = b;
        }
    }
    if inside { Place::Inside } else { Place::Outside }
}

/// Whether `inner` lies within `outer`, for rings that touch at most in points or along edges.
fn within(inner: &Ring, outer: &Ring) -> bool {
    let next = |i: usize| inner.get(i + 1).or(inner.first()).copied().unwrap_or_default();
    let middles = inner.iter().enumerate().map(|(i, &p)| (p + next(i)) * 0.5);
    let places = inner.iter().copied().chain(middles).map(|p| locate([outer], p));
    places.into_iter().find(|&place| place != Place::Border) == Some(Place::Inside)
}

/// Whether all points of a ring lie on one line; exact.
pub(super) fn is_flat(ring: &Ring) -> bool {
    let Some(&a) = ring.first() else { return true };
    let Some(&b) = ring.iter().find(|&&b| b != a) else { return true };
    ring.iter().all(|&c| orient2d(a, b, c) == Orientation::Collinear)
}

/// Groups rings into polygons: a ring within an odd number of others is a hole of the innermost of
/// them. Outer rings come out counter-clockwise, holes clockwise.
pub(super) fn group(rings: Vec<Vec<DVec2>>) -> Shapes {
    let boxes: Vec<Option<Rect>> =
        rings.iter().map(|ring| Rect::around(ring.iter().copied())).collect();
    let holds = |j: usize, i: usize| match (boxes[j], boxes[i]) {
        (Some(outer), Some(inner)) => outer.contains(inner.min()) && outer.contains(inner.max()),
        _ => false,
    };
    let around = |i: usize| {
        let others = (0..rings.len()).filter(|&j| j != i && holds(j, i));
        others.filter(|&j| within(&rings[i], &rings[j])).collect::<Vec<usize>>()
    };
    let parents: Vec<Vec<usize>> = (0..rings.len()).map(around).collect();
    let is_hole = |i: usize| parents[i].len() % 2 == 1;
    let oriented = |i: usize, positive: bool| {
        let mut ring = rings[i].clone();
        if (signed_area(&ring) > 0.0) != positive {
            ring.reverse();
        }
        ring
    };
    let mut shapes = Shapes::new();
    for outer in (0..rings.len()).filter(|&i| !is_hole(i)) {
        shapes.push_ring(oriented(outer, true));
        for hole in (0..rings.len()).filter(|&i| is_hole(i)) {
            let depth = parents[outer].len() + 1;
            if parents[hole].len() == depth && parents[hole].contains(&outer) {
                shapes.push_ring(oriented(hole, false));
            }
        }
        shapes.end_polygon();
    }
    shapes
}
