//! Edges of rings, the pairs of them that may meet, and their intersections.

use super::{Fault, Flaw};
use crate::clip::exact;
use crate::clip::polygon::Shapes;
use crate::math::DVec2;

/// An edge of a ring.
pub struct Edge {
    pub a: DVec2,
    pub b: DVec2,
    pub ring: usize,
    /// Its place in the ring.
    pub index: usize,
    /// The indices of its ends among all points.
    pub ends: [usize; 2],
    low: f64,
    high: f64,
}

impl Edge {
    /// Returns a fault between it and another edge.
    pub fn flaw(&self, other: &Self, fault: Fault, at: DVec2) -> Flaw {
        let rings = [self.ring.min(other.ring), self.ring.max(other.ring)];
        Flaw { fault, at: at + 0.0, rings }
    }
}

/// Returns all edges, in the order of their left ends.
pub fn edges_of(shapes: &Shapes) -> Vec<Edge> {
    let mut edges = Vec::with_capacity(shapes.points().len());
    for (ring, points) in shapes.rings().enumerate() {
        let start = shapes.ring_range(ring).start;
        for (index, &a) in points.iter().enumerate() {
            let next = (index + 1) % points.len();
            let (b, ends) = (points[next], [start + index, start + next]);
            let (low, high) = (a.x.min(b.x), a.x.max(b.x));
            edges.push(Edge { a, b, ring, index, ends, low, high });
        }
    }
    edges.sort_by(|p, q| p.low.total_cmp(&q.low));
    edges
}

/// Calls for each two edges whose boxes may meet, some of them twice, as long as the answer is yes and `budget` lasts;
/// returns whether that was to the end.
pub fn each_pair(
    edges: &[Edge],
    mut budget: usize,
    mut f: impl FnMut(&Edge, &Edge) -> bool,
) -> bool {
    slabs(edges).iter().all(|slab| {
        let mut active: Vec<&Edge> = Vec::new();
        slab.iter().all(|edge| {
            active.retain(|other| other.high >= edge.low);
            let Some(left) = budget.checked_sub(active.len() + 1) else { return false };
            budget = left;
            let go_on = active.iter().all(|other| f(edge, other));
            active.push(edge);
            go_on
        })
    })
}

/// Returns the edges in horizontal slabs of equal height, each edge in all that it touches, in
/// their order.
fn slabs(edges: &[Edge]) -> Vec<Vec<&Edge>> {
    let low = edges.iter().fold(f64::INFINITY, |y, e| y.min(e.a.y));
    let high = edges.iter().fold(f64::NEG_INFINITY, |y, e| y.max(e.a.y));
    let count = libm::sqrt(edges.len() as f64) as usize + 1;
    // Halves, because the total height may overflow; values that are not finite go to slab 0.
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

/// Intersection of two edges.
pub enum Meeting {
    Apart,
    /// One point within both.
    Crossing,
    /// More than a point; one of them.
    Overlap(DVec2),
    /// One point, which is an end of one or both.
    Touch(DVec2),
}

pub fn meeting(p: &Edge, q: &Edge) -> Meeting {
    let (below, above) = (p.a.y.max(p.b.y) < q.a.y.min(q.b.y), p.a.y.min(p.b.y) > q.a.y.max(q.b.y));
    if below || above || p.high < q.low || q.high < p.low {
        return Meeting::Apart;
    }
    let side = |a, b, c| exact::side(a, b, c) as i32;
    let (qa, qb) = (side(p.a, p.b, q.a), side(p.a, p.b, q.b));
    if qa * qb > 0 {
        return Meeting::Apart;
    }
    let (pa, pb) = (side(q.a, q.b, p.a), side(q.a, q.b, p.b));
    if pa * pb > 0 {
        return Meeting::Apart;
    }
    if qa == 0 && qb == 0 {
        return on_one_line(p, q);
    }
    // By the signs, they cross or an end of one lies on the other.
    let ends = [(qa, q.a), (qb, q.b), (pa, p.a), (pb, p.b)];
    match ends.into_iter().find(|(side, _)| *side == 0) {
        None => Meeting::Crossing,
        Some((_, at)) => Meeting::Touch(at),
    }
}

/// Returns the intersection of edges on one line: nothing, an end, or more.
fn on_one_line(p: &Edge, q: &Edge) -> Meeting {
    let axis = usize::from((p.b.y - p.a.y).abs() > (p.b.x - p.a.x).abs());
    let sorted = |e: &Edge| if e.a[axis] <= e.b[axis] { (e.a, e.b) } else { (e.b, e.a) };
    let ((low, high), (from, to)) = (sorted(p), sorted(q));
    if to[axis] < low[axis] || from[axis] > high[axis] {
        Meeting::Apart
    } else if to[axis] == low[axis] {
        Meeting::Touch(low)
    } else if from[axis] == high[axis] {
        Meeting::Touch(high)
    } else {
        Meeting::Overlap(if from[axis] > low[axis] { from } else { low })
    }
}

/// Returns the crossing of two edges, as exact as f64 allows.
pub fn crossing(p: &Edge, q: &Edge) -> DVec2 {
    let (along, other) = (p.b * 0.5 - p.a * 0.5, q.b * 0.5 - q.a * 0.5);
    let t = (q.a * 0.5 - p.a * 0.5).perp_dot(other) / along.perp_dot(other);
    let t = if t.is_nan() { 0.5 } else { t.clamp(0.0, 1.0) };
    p.a * (1.0 - t) + p.b * t
}
