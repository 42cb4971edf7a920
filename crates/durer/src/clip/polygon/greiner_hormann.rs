//! Greiner–Hormann: walk forwards on entering the other polygon, backwards on leaving it.
//!
//! G. Greiner, K. Hormann, *Efficient clipping of arbitrary polygons*, ACM Transactions on Graphics
//! 17(2), 1998. Touching vertices and common edges after Foster, Hormann and Popa, 2019.

use super::cyclic::{Lists, finish, link};
use super::locate::{Place, locate};
use super::walk::with_xor;
use super::{BooleanOp, Shapes};
use crate::info::{Class, Info};
use crate::math::DVec2;
use crate::trace::Tracer;

pub use super::walk::{Options, Step, replay};

/// The facts.
pub const INFO: Info = Info {
    name: "greiner-hormann",
    title: "Greiner–Hormann",
    authors: "G. Greiner, K. Hormann; E. L. Foster, K. Hormann, R. T. Popa",
    year: 1998,
    source: "Efficient clipping of arbitrary polygons, ACM Transactions on Graphics 17(2)",
    class: Class::ObjectSpace,
    cost: "O(n m) time for n and m edges, O(n + m + k) memory for k crossings",
    limits: "polygons whose rings are simple and do not touch one another; \
             crossings are rounded to f64",
};

/// Clips polygons with polygons; both with holes, by the even-odd rule.
///
/// ```
/// use durer::clip::polygon::{BooleanOp, Shapes, greiner_hormann::greiner_hormann};
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// let square = |x: f64| [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(u, v)| DVec2::new(x + u, x + v));
/// let (a, b) = (Shapes::from_rings([square(0.0)]), Shapes::from_rings([square(1.0)]));
/// let union = greiner_hormann(&a, &b, BooleanOp::Union, &Default::default(), &mut NoTrace);
/// assert_eq!(union.area(), 7.0);
/// ```
pub fn greiner_hormann(
    subject: &Shapes,
    clip: &Shapes,
    op: BooleanOp,
    _options: &Options,
    t: &mut impl Tracer<Step>,
) -> Shapes {
    with_xor([subject, clip], op, |[a, b], op, swapped| walk(a, b, op, swapped, t))
}

fn walk(
    subject: &Shapes,
    clip: &Shapes,
    op: BooleanOp,
    swapped: bool,
    t: &mut impl Tracer<Step>,
) -> Shapes {
    let linked = link(subject, clip);
    let mut entries = [
        entries(&linked.subject, &linked.clip_rings),
        entries(&linked.clip, &linked.subject_rings),
    ];
    for (vertex, &entry) in linked.subject.vertices.iter().zip(&entries[0]) {
        if vertex.crosses {
            t.step(|| Step::Crossing { at: vertex.at, entry });
        }
    }
    // Union walks outside both, difference outside the clip and inside the subject.
    let inverted = [op != BooleanOp::Intersection, op == BooleanOp::Union];
    for (list, inverted) in entries.iter_mut().zip(inverted) {
        list.iter_mut().for_each(|entry| *entry ^= inverted);
    }
    let lists = [&linked.subject, &linked.clip];
    let mut visited = vec![false; linked.subject.vertices.len()];
    let mut found = Vec::new();
    for start in 0..visited.len() {
        if linked.subject.vertices[start].crosses && !visited[start] {
            found.push(trace(lists, &entries, start, &mut visited));
        }
    }
    found.extend(linked.whole_rings(op));
    finish(found, |points| t.step(|| Step::Ring { points: points.to_vec(), swapped }))
}

/// For each vertex that crosses: whether its list enters the other's region there. The first of a
/// ring is told by a point on the ring, the others alternate.
fn entries(lists: &Lists, other: &[Vec<DVec2>]) -> Vec<bool> {
    let mut entries = vec![false; lists.vertices.len()];
    for &start in &lists.starts {
        let ring: Vec<usize> = lists.ring(start).collect();
        let Some(first) = ring.iter().position(|&v| lists.vertices[v].crosses) else { continue };
        // Between this crossing and the one before, some piece is off the other's border.
        let before = ring[..first].iter().rev().chain(ring[first..].iter().rev());
        let mut pieces = Vec::new();
        for &v in before {
            pieces.push((lists.vertices[v].at + lists.vertices[lists.vertices[v].next].at) * 0.5);
            if lists.vertices[v].crosses {
                break;
            }
        }
        let places = pieces.iter().map(|&p| locate(other.iter().map(Vec::as_slice), p));
        let inside = places.into_iter().find(|&p| p != Place::Border) == Some(Place::Inside);
        let mut entry = !inside;
        for &v in ring[first..].iter().chain(&ring[..first]) {
            if lists.vertices[v].crosses {
                entries[v] = entry;
                entry = !entry;
            }
        }
    }
    entries
}

/// Walks from a crossing of the subject until it comes back. Rings that are not simple may lead a walk
/// into a circle without crossings: then there is no ring.
fn trace(
    lists: [&Lists; 2],
    entries: &[Vec<bool>; 2],
    start: usize,
    visited: &mut [bool],
) -> Vec<DVec2> {
    let all = lists[0].vertices.len() + lists[1].vertices.len();
    let mut points = Vec::new();
    let (mut k, mut v) = (0, start);
    loop {
        let subject = if k == 0 { Some(v) } else { lists[1].vertices[v].twin };
        let seen = subject.and_then(|s| visited.get_mut(s));
        if seen.is_some_and(|seen| std::mem::replace(seen, true)) {
            return points;
        }
        let forward = entries[k][v];
        loop {
            if points.len() > all {
                return Vec::new();
            }
            points.push(lists[k].vertices[v].at);
            let vertex = &lists[k].vertices[v];
            v = if forward { vertex.next } else { vertex.previous };
            if lists[k].vertices[v].crosses {
                break;
            }
        }
        let Some(twin) = lists[k].vertices[v].twin else { return points };
        (k, v) = (1 - k, twin);
    }
}
