//! Whether polygons are valid, exactly.

use durer::clip::polygon::{Polygon, Shapes};
use durer::math::{DVec2, Orientation, Rect, orient2d};

/// So many pairs of edges are looked at per edge, at most; beyond that polygons count as not valid,
/// and the overlay, which fears no edge, takes them.
const PAIRS_PER_EDGE: usize = 4096;

/// What two edges may have in common, beside consecutive ones their common vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Touching {
    /// Nothing.
    No,
    /// A vertex of both.
    AtVertices,
    /// Where they are of different rings, a point that is a vertex of one of them: what the OGC allows.
    AtPoints,
}

/// Whether all rings are simple and, but for what is allowed, apart from one another, holes lie in
/// their outer rings and polygons outside one another.
pub fn is_valid(shapes: &Shapes, touching: Touching) -> bool {
    edges_are_apart(shapes, touching) && nests(shapes)
}

struct Edge {
    a: DVec2,
    b: DVec2,
    ring: usize,
    /// Its place in the ring.
    index: usize,
    low: f64,
    high: f64,
}

/// Whether no two edges cross, overlap or, but for what is allowed, touch.
pub fn edges_are_apart(shapes: &Shapes, touching: Touching) -> bool {
    let mut edges = Vec::with_capacity(shapes.points().len());
    for (ring, points) in shapes.rings().enumerate() {
        if points.len() < 3 {
            return false;
        }
        for (index, &a) in points.iter().enumerate() {
            let b = points[(index + 1) % points.len()];
            if a == b {
                return false;
            }
            let (low, high) = (a.x.min(b.x), a.x.max(b.x));
            edges.push(Edge { a, b, ring, index, low, high });
        }
    }
    edges.sort_by(|p, q| p.low.total_cmp(&q.low));
    let mut budget = edges.len().saturating_mul(PAIRS_PER_EDGE);
    let size = |ring: usize| shapes.ring_range(ring).len();
    slabs(&edges).iter().all(|slab| {
        let mut active: Vec<&Edge> = Vec::new();
        slab.iter().all(|edge| {
            active.retain(|other| other.high >= edge.low);
            let Some(left) = budget.checked_sub(active.len() + 1) else { return false };
            budget = left;
            let apart = !active.iter().any(|other| meet(edge, other, size(edge.ring), touching));
            active.push(edge);
            apart
        })
    })
}

/// The edges in horizontal slabs of equal height, each edge in all that it touches, in their order.
fn slabs(edges: &[Edge]) -> Vec<Vec<&Edge>> {
    let low = edges.iter().fold(f64::INFINITY, |y, e| y.min(e.a.y));
    let high = edges.iter().fold(f64::NEG_INFINITY, |y, e| y.max(e.a.y));
    let count = libm::sqrt(edges.len() as f64) as usize + 1;
    // Halves, because the height of the whole may overflow; what is not finite goes to slab 0.
    let slab = |y: f64| {
        let part = (y * 0.5 - low * 0.5) / (high * 0.5 - low * 0.5) * count as f64;
        (part.max(0.0) as usize).min(count - 1)
    };
    let mut slabs = vec![Vec::new(); count];
    for edge in edges {
        let (from, to) = (slab(edge.a.y.min(edge.b.y)), slab(edge.a.y.max(edge.b.y)));
        slabs[from..=to].iter_mut().for_each(|slab| slab.push(edge));
    }
    slabs
}

/// Whether two edges have more in common than they may.
fn meet(p: &Edge, q: &Edge, size: usize, touching: Touching) -> bool {
    let (below, above) = (p.a.y.max(p.b.y) < q.a.y.min(q.b.y), p.a.y.min(p.b.y) > q.a.y.max(q.b.y));
    if below || above {
        return false;
    }
    let side = |a, b, c| match orient2d(a, b, c) {
        Orientation::CounterClockwise => 1,
        Orientation::Clockwise => -1,
        Orientation::Collinear => 0,
    };
    let (qa, qb) = (side(p.a, p.b, q.a), side(p.a, p.b, q.b));
    let (pa, pb) = (side(q.a, q.b, p.a), side(q.a, q.b, p.b));
    if qa * qb > 0 || pa * pb > 0 {
        return false;
    }
    let shared = [p.a, p.b].into_iter().filter(|v| *v == q.a || *v == q.b).count();
    if qa == 0 && qb == 0 {
        // On one line: apart, end to end, or overlapping.
        let axis = usize::from((p.b.y - p.a.y).abs() > (p.b.x - p.a.x).abs());
        let span = |e: &Edge| (e.a[axis].min(e.b[axis]), e.a[axis].max(e.b[axis]));
        let ((low, high), (from, to)) = (span(p), span(q));
        let apart = to < low || from > high;
        let end_to_end = shared == 1 && (to <= low || from >= high);
        return !(apart || end_to_end && allowed(p, q, size, touching));
    }
    // The signs say that they do not cross, or that an end of one lies on the other.
    let crosses = qa * qb != 0 && pa * pb != 0;
    let vertex_is_enough = touching == Touching::AtPoints || shared == 1;
    crosses || !vertex_is_enough || !allowed(p, q, size, touching)
}

/// Whether edges that share one vertex may.
fn allowed(p: &Edge, q: &Edge, size: usize, touching: Touching) -> bool {
    let neighbours =
        p.ring == q.ring && ((p.index + 1) % size == q.index || (q.index + 1) % size == p.index);
    match touching {
        Touching::No => neighbours,
        Touching::AtVertices => true,
        Touching::AtPoints => neighbours || p.ring != q.ring,
    }
}

/// Whether holes lie in their outer rings, not in one another, and polygons not in one another;
/// the edges are apart.
fn nests(shapes: &Shapes) -> bool {
    let polygons: Vec<Polygon<'_>> = shapes.polygons().collect();
    let boxes: Vec<Option<Rect>> =
        polygons.iter().map(|p| Rect::around(p.outer().iter().copied())).collect();
    for (i, polygon) in polygons.iter().enumerate() {
        let holes: Vec<&[DVec2]> = polygon.holes().collect();
        for (k, hole) in holes.iter().enumerate() {
            let others = holes.iter().enumerate().filter(|(j, _)| *j != k);
            let nested = others.into_iter().any(|(_, other)| lies_in(hole, other));
            if nested || !lies_in(hole, polygon.outer()) {
                return false;
            }
        }
        let overlap =
            |j: usize| matches!((boxes[i], boxes[j]), (Some(a), Some(b)) if a.overlaps(&b));
        for j in (0..polygons.len()).filter(|&j| j != i && overlap(j)) {
            let rings = polygons[j].rings();
            let depth: usize = rings.filter(|ring| lies_in(polygon.outer(), ring)).count();
            if depth % 2 == 1 {
                return false;
            }
        }
    }
    true
}

/// Whether a ring lies in another, which it may touch: told by a vertex, or else the middle of an
/// edge, that is not on its border.
fn lies_in(inner: &[DVec2], outer: &[DVec2]) -> bool {
    let ends = inner.iter().zip(inner.iter().cycle().skip(1));
    let middles = ends.map(|(&a, &b)| a * 0.5 + b * 0.5);
    let free = inner.iter().copied().chain(middles).find(|&p| !on_border(outer, p));
    free.is_some_and(|p| crossings(outer, p) % 2 == 1)
}

/// Whether a point lies on a ring.
fn on_border(ring: &[DVec2], p: DVec2) -> bool {
    let on_edge = |a: DVec2, b: DVec2| {
        let (low, high) = (a.min(b), a.max(b));
        p.cmpge(low).all() && p.cmple(high).all() && orient2d(a, b, p) == Orientation::Collinear
    };
    ring.iter().zip(ring.iter().cycle().skip(1)).any(|(a, b)| on_edge(*a, *b))
}

/// How many edges of a ring a ray from a point to the right crosses.
fn crossings(ring: &[DVec2], p: DVec2) -> usize {
    let next = ring.iter().cycle().skip(1);
    let crosses = |(a, b): &(&DVec2, &DVec2)| {
        let upwards = a.y <= p.y;
        let wanted = if upwards { Orientation::CounterClockwise } else { Orientation::Clockwise };
        upwards != (b.y <= p.y) && orient2d(**a, **b, p) == wanted
    };
    ring.iter().zip(next).filter(crosses).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shapes(polygons: &[&[&[(f64, f64)]]]) -> Shapes {
        let mut shapes = Shapes::new();
        for polygon in polygons {
            for ring in *polygon {
                shapes.push_ring(ring.iter().map(|&p| DVec2::from(p)));
            }
            shapes.end_polygon();
        }
        shapes
    }

    const SQUARE: &[(f64, f64)] = &[(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)];
    const SMALL: &[(f64, f64)] = &[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0)];
    const FAR: &[(f64, f64)] = &[(21.0, 1.0), (22.0, 1.0), (22.0, 2.0)];

    #[test]
    fn validity_is_decided_by_edges_and_nesting() {
        let bowtie: &[(f64, f64)] = &[(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)];
        let spike: &[(f64, f64)] = &[(0.0, 0.0), (2.0, 0.0), (2.0, 5.0), (2.0, 2.0), (0.0, 2.0)];
        let touching: &[(f64, f64)] = &[(0.0, 5.0), (2.0, 4.0), (2.0, 6.0)];
        for (polygons, valid) in [
            (&[&[SQUARE, SMALL][..]][..], true),
            (&[&[SQUARE], &[FAR]], true),
            (&[&[SQUARE], &[SMALL]], false),
            (&[&[SQUARE, FAR]], false),
            (&[&[SQUARE, SMALL], &[SMALL]], false),
            (&[&[bowtie]], false),
            (&[&[spike]], false),
            (&[&[SQUARE, touching]], false),
        ] {
            assert_eq!(is_valid(&shapes(polygons), Touching::No), valid, "{polygons:?}");
        }
    }

    #[test]
    fn touching_at_a_vertex_can_be_allowed() {
        let pair = shapes(&[&[SQUARE], &[&[(9.0, 9.0), (12.0, 9.0), (12.0, 12.0)]]]);
        assert!(!edges_are_apart(&pair, Touching::No));
        assert!(edges_are_apart(&pair, Touching::AtVertices));
        // The hole begins on its outer ring: at a vertex, or on an edge.
        let pointed = &[(0.0, 0.0), (3.0, 1.0), (1.0, 3.0)];
        let leaning = &[(9.0, 4.0), (7.0, 5.0), (7.0, 3.0)];
        for (hole, at_vertices) in [(pointed, true), (leaning, false)] {
            let touching = shapes(&[&[SQUARE, hole]]);
            assert!(!is_valid(&touching, Touching::No));
            assert_eq!(is_valid(&touching, Touching::AtVertices), at_vertices);
            assert!(is_valid(&touching, Touching::AtPoints));
            let outside = shapes(&[&[SQUARE], &[hole]]);
            assert!(!is_valid(&outside, Touching::AtPoints));
        }
        let pinched: &[(f64, f64)] =
            &[(0.0, 0.0), (4.0, 0.0), (2.0, 2.0), (4.0, 4.0), (0.0, 4.0), (2.0, 2.0)];
        assert!(!is_valid(&shapes(&[&[pinched]]), Touching::AtPoints));
        let across = shapes(&[&[SQUARE, &[(8.0, 4.0), (10.0, 4.0), (8.0, 5.0)]]]);
        assert!(!is_valid(&across, Touching::AtPoints));
    }
}
