//! Whether polygons are valid, exactly.

use super::Shapes;
use super::rectangle::Prepared;
use crate::math::{DVec2, Orientation, Rect, in_sector, orient2d};
use std::cell::OnceCell;

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
/// their outer rings and polygons outside one another. Exact; polygons of which very many edges lie side by
/// side count as not valid.
///
/// ```
/// use durer::clip::polygon::Shapes;
/// use durer::clip::polygon::validity::{Touching, is_valid};
/// use durer::math::DVec2;
///
/// let bow = [(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)].map(DVec2::from);
/// assert!(!is_valid(&Shapes::from_rings([bow]), Touching::AtPoints));
/// ```
pub fn is_valid(shapes: &Shapes, touching: Touching) -> bool {
    edges_are_apart(shapes, touching) && nests(shapes)
}

struct Edge {
    a: DVec2,
    b: DVec2,
    ring: usize,
    /// Its place in the ring.
    index: usize,
    /// The indices of its ends among all points.
    ends: [usize; 2],
    low: f64,
    high: f64,
}

/// Whether no two edges cross, overlap or, but for what is allowed, touch.
pub fn edges_are_apart(shapes: &Shapes, touching: Touching) -> bool {
    each_fault(shapes, touching, |_| false)
}

/// The points, by their indices, at the ends of edges that are not apart, each once; `None` where there
/// are too many to tell.
pub(super) fn faults(shapes: &Shapes, touching: Touching) -> Option<Vec<usize>> {
    let mut points = Vec::new();
    let all = each_fault(shapes, touching, |ends| {
        points.extend_from_slice(ends);
        !ends.is_empty()
    });
    points.sort_unstable();
    points.dedup();
    all.then_some(points)
}

/// Calls with the points of each fault, with none where there are too many edges side by side, as long as
/// the answer is yes; tells whether that was all.
fn each_fault(shapes: &Shapes, touching: Touching, mut tell: impl FnMut(&[usize]) -> bool) -> bool {
    let mut edges = Vec::with_capacity(shapes.points().len());
    for (ring, points) in shapes.rings().enumerate() {
        let start = shapes.ring_range(ring).start;
        if points.len() < 3 && !tell(&[start]) {
            return false;
        }
        for (index, &a) in points.iter().enumerate() {
            let next = (index + 1) % points.len();
            let (b, ends) = (points[next], [start + index, start + next]);
            if a == b && !tell(&ends) {
                return false;
            }
            let (low, high) = (a.x.min(b.x), a.x.max(b.x));
            edges.push(Edge { a, b, ring, index, ends, low, high });
        }
    }
    edges.sort_by(|p, q| p.low.total_cmp(&q.low));
    let mut budget = edges.len().saturating_mul(PAIRS_PER_EDGE);
    let size = |ring: usize| shapes.ring_range(ring).len();
    let all = slabs(&edges).iter().all(|slab| {
        let mut active: Vec<&Edge> = Vec::new();
        slab.iter().all(|edge| {
            active.retain(|other| other.high >= edge.low);
            let Some(left) = budget.checked_sub(active.len() + 1) else { return tell(&[]) };
            budget = left;
            let go_on = active.iter().all(|other| {
                !meet(edge, other, size(edge.ring), touching)
                    || tell(&[edge.ends[0], edge.ends[1], other.ends[0], other.ends[1]])
            });
            active.push(edge);
            go_on
        })
    });
    all && (touching == Touching::No || each_passing(shapes, tell))
}

/// A ring's way through a point.
struct Way {
    /// The point, the one before and the one after.
    places: [DVec2; 3],
    index: usize,
}

/// Calls with the points in which rings do not only touch but pass through each other, as long as the
/// answer is yes; tells whether that was all.
fn each_passing(shapes: &Shapes, mut tell: impl FnMut(&[usize]) -> bool) -> bool {
    let way = |ring: &[DVec2], i: usize, start: usize| {
        let (before, after) = ((i + ring.len() - 1) % ring.len(), (i + 1) % ring.len());
        Way { places: [ring[i], ring[before], ring[after]], index: start + i }
    };
    let of_ring = |ring| {
        let range = shapes.ring_range(ring);
        (0..range.len()).map(move |i| way(shapes.ring(ring), i, range.start))
    };
    let mut ways: Vec<Way> = (0..shapes.ring_count()).flat_map(of_ring).collect();
    // Zeros of either sign are one place.
    let order = |p: &DVec2, q: &DVec2| {
        (p.x + 0.0).total_cmp(&(q.x + 0.0)).then((p.y + 0.0).total_cmp(&(q.y + 0.0)))
    };
    ways.sort_by(|v, w| order(&v.places[0], &w.places[0]));
    ways.chunk_by(|v, w| v.places[0] == w.places[0]).all(|through| {
        through.iter().enumerate().all(|(i, way)| {
            let [at, from, to] = way.places;
            let left = |x: DVec2| in_sector(at, to, x, from);
            let passes = |other: &Way| left(other.places[1]) != left(other.places[2]);
            through[..i].iter().all(|other| !passes(other) || tell(&[way.index, other.index]))
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
    let numbers = shapes.polygons().map(|polygon| polygon.ring_indices()).enumerate();
    let rings: Vec<Ring<'_>> = numbers
        .flat_map(|(polygon, all)| all.clone().map(move |ring| (polygon, ring > all.start, ring)))
        .filter_map(|(polygon, hole, ring)| {
            let points = shapes.ring(ring);
            let around = Rect::around(points.iter().copied())?;
            Some(Ring { points, around, polygon, hole, prepared: OnceCell::new() })
        })
        .collect();
    let mut at_home = vec![false; rings.len()];
    let mut within = Vec::new();
    let mut apart = true;
    each_within(&rings, |inner, outer| {
        let (a, b) = (&rings[inner], &rings[outer]);
        let (same, holes) = (a.polygon == b.polygon, (a.hole, b.hole));
        match (same, holes) {
            (true, (true, false)) => at_home[inner] = a.lies_in(b),
            (true, (true, true)) => apart = apart && !a.lies_in(b),
            (false, (false, _)) if a.lies_in(b) => within.push((inner, b.polygon)),
            _ => {}
        }
        apart
    });
    // In another polygon's ring and hole: in its hole.
    within.sort_unstable();
    let in_holes = within.chunk_by(|a, b| a == b).all(|rings| rings.len() % 2 == 0);
    apart && in_holes && rings.iter().zip(at_home).all(|(ring, home)| !ring.hole || home)
}

struct Ring<'a> {
    points: &'a [DVec2],
    around: Rect,
    polygon: usize,
    hole: bool,
    prepared: OnceCell<Option<Prepared>>,
}

impl Ring<'_> {
    /// Whether it lies in another, which it may touch: told by a vertex, or else the middle of an edge,
    /// that is not on its border.
    fn lies_in(&self, outer: &Self) -> bool {
        let prepare = || Prepared::new(Shapes::from_rings([outer.points])).ok();
        let Some(outer) = outer.prepared.get_or_init(prepare) else { return false };
        let inner = self.points;
        let ends = inner.iter().zip(inner.iter().cycle().skip(1));
        let middles = ends.map(|(&a, &b)| a * 0.5 + b * 0.5);
        let free = inner.iter().copied().chain(middles).find(|&p| !outer.has_on_border(p));
        free.is_some_and(|p| outer.contains(p))
    }
}

/// Calls for each ring and each other one whose box holds its box, as long as the answer is yes: in the
/// order of their left ends, each with those that it may lie in or around.
fn each_within(rings: &[Ring<'_>], mut f: impl FnMut(usize, usize) -> bool) {
    let mut order: Vec<usize> = (0..rings.len()).collect();
    order.sort_by(|&i, &j| rings[i].around.min().x.total_cmp(&rings[j].around.min().x));
    let holds = |i: usize, j: usize| {
        let (outer, inner) = (&rings[i].around, &rings[j].around);
        outer.contains(inner.min()) && outer.contains(inner.max())
    };
    let mut active: Vec<usize> = Vec::new();
    for next in order {
        active.retain(|&i| rings[i].around.max().x >= rings[next].around.min().x);
        for &other in &active {
            let go_on =
                (!holds(other, next) || f(next, other)) && (!holds(next, other) || f(other, next));
            if !go_on {
                return;
            }
        }
        active.push(next);
    }
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
    fn rings_may_touch_in_a_vertex_but_not_pass_through_it() {
        let square = |x: f64| [(x, x), (x + 4.0, x), (x + 4.0, x + 4.0), (x, x + 4.0)];
        let corners = shapes(&[&[&square(0.0)], &[&square(4.0)]]);
        assert!(edges_are_apart(&corners, Touching::AtVertices));
        // They cross in the two vertices that they share.
        let left = [(0.0, 0.0), (2.0, 1.0), (4.0, 0.0), (4.0, 4.0), (2.0, 3.0), (0.0, 4.0)];
        let right = [(1.0, 2.0), (2.0, 1.0), (1.5, -3.0), (9.0, 2.0), (1.5, 7.0), (2.0, 3.0)];
        assert!(!edges_are_apart(&shapes(&[&[&left], &[&right]]), Touching::AtVertices));
    }

    #[test]
    fn squares_nest_as_their_sides_say() {
        let mut state = 5_u64;
        let mut random = |range: u64| {
            let step = (6_364_136_223_846_793_005, 1_442_695_040_888_963_407);
            state = state.wrapping_mul(step.0).wrapping_add(step.1);
            (state >> 33) % range
        };
        let mut seen = [0; 2];
        for _ in 0..20_000 {
            let mut shapes = Shapes::new();
            let mut squares: Vec<(usize, [u64; 3])> = Vec::new();
            for polygon in 0..2 + random(2) as usize {
                for _ in 0..1 + random(3) {
                    let [x, y, side] = [random(12), random(12), 1 + 2 * random(6)];
                    squares.push((polygon, [x, y, side]));
                    let corners = [(0, 0), (side, 0), (side, side), (0, side)];
                    shapes.push_ring(
                        corners.map(|(u, v)| DVec2::new((x + u) as f64, (y + v) as f64)),
                    );
                }
                shapes.end_polygon();
            }
            if !edges_are_apart(&shapes, Touching::No) {
                continue;
            }
            let within = |[x, y, s]: [u64; 3], [u, v, t]: [u64; 3]| {
                x > u && y > v && x + s < u + t && y + s < v + t
            };
            let first = |i: usize| i == 0 || squares[i - 1].0 != squares[i].0;
            let expected = (0..squares.len()).all(|i| {
                let (own, square) = squares[i];
                let others = (0..squares.len()).filter(|&j| j != i && within(square, squares[j].1));
                let (mut home, mut nested, mut depths) = (first(i), false, [0; 4]);
                for j in others {
                    home |= squares[j].0 == own && first(j);
                    nested |= squares[j].0 == own && !first(j) && !first(i);
                    depths[squares[j].0] += usize::from(squares[j].0 != own && first(i));
                }
                home && !nested && depths.iter().all(|depth| depth % 2 == 0)
            });
            assert_eq!(is_valid(&shapes, Touching::No), expected, "{squares:?}");
            seen[usize::from(expected)] += 1;
        }
        assert!(seen.iter().all(|&count| count > 100), "{seen:?}");
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
