//! Greiner–Hormann: walk forwards on entering the other polygon, backwards on leaving it.
//!
//! G. Greiner, K. Hormann, *Efficient clipping of arbitrary polygons*, ACM Transactions on Graphics
//! 17(2), 1998. Touching vertices and common edges after Foster, Hormann and Popa, 2019; where
//! several borders pass one point, each pair of them is linked there (`node.rs`).
//!
//! Rings may cross themselves and one another, as published: entries and exits alternate along each ring from its
//! start, and the rings of the result, which may also cross, enclose it by the even-odd rule. The paper slightly moves
//! vertices that touch the other polygon; here such input is refused if rings cross.

use super::cyclic::Linked;
use super::lists::Lists;
use super::walk::walk_all;
use super::{BooleanOp, Operand, Shapes};
use crate::Result;
use crate::info::{Class, Info, Occluder};
use crate::math::DVec2;
use crate::trace::Tracer;

pub use super::steps::{CrossingMark, Options, Step, replay};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "greiner-hormann",
    title: "Greiner–Hormann",
    authors: "G. Greiner, K. Hormann; E. L. Foster, K. Hormann, R. T. Popa",
    year: 1998,
    source: "Efficient clipping of arbitrary polygons, ACM Transactions on Graphics 17(2)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n log n + p) time for n edges of both and p pairs that are near each other, \
           O(n² + r²) at worst for r rings; O(n + k) memory for k crossings",
    limits: "rings of a polygon that cross or overlap are filled by the even-odd rule, must not touch the other \
             polygon with a vertex or edge, and give rings that may cross; other polygons may touch in any way. \
             Crossings are rounded to f64, so rings nearer than that may cross in the result",
    pseudocode: &[
        "insert the crossings into the lists of both polygons, by their alpha, linked in pairs",
        "mark each crossing of each list as entry or exit",
        "while there is a crossing not yet visited:",
        "    begin a ring there",
        "    take the linked crossing of the subject's list",
        "    subject: emit vertices, forward from an entry, backward from an exit",
        "    take the linked crossing of the clip's list",
        "    clip: emit vertices, forward from an entry, backward from an exit",
        "    at a crossing that was visited the ring is complete; else go to 5",
        "rings without crossings are inside or outside as a whole",
    ],
};

/// Clips polygons with polygons; both with holes, by the even-odd rule. Where rings of an operand cross, each ring of
/// the result is a separate polygon, and a point is inside if an odd number of them contain it.
///
/// ```
/// use durer::clip::polygon::{BooleanOp, Shapes, greiner_hormann::greiner_hormann};
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// let square = |x: f64| [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(u, v)| DVec2::new(x + u, x + v));
/// let (a, b) = (Shapes::from_rings([square(0.0)]), Shapes::from_rings([square(1.0)]));
/// let union = greiner_hormann(&a, &b, BooleanOp::Union, &Default::default(), &mut NoTrace)?;
/// assert_eq!(union.area(), 7.0);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`NonFinite`](crate::Error::NonFinite) for a point with a NaN or infinite coordinate;
/// [`Unsupported`](crate::Error::Unsupported) if rings of an operand cross or overlap themselves or
/// one another, or turn back on themselves, and a vertex of an operand lies on the border of the other.
pub fn greiner_hormann(
    subject: &Shapes,
    clip: &Shapes,
    op: BooleanOp,
    _options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Shapes> {
    walk_all([subject, clip], op, true, t, walk)
}

fn walk(linked: &Linked, op: BooleanOp, t: &mut impl Tracer<Step>) -> Vec<Vec<DVec2>> {
    let mut entries = [entries(&linked.lists[0]), entries(&linked.lists[1])];
    for (vertex, &entry) in linked.lists[0].vertices.iter().zip(&entries[0]) {
        if vertex.twin.is_some() {
            t.step(|| Step::Crossing { at: vertex.at, entry });
        }
    }
    // Union walks outside both, difference outside the clip and inside the subject.
    let inverted = [op != BooleanOp::Intersection, op == BooleanOp::Union];
    for (list, inverted) in entries.iter_mut().zip(inverted) {
        list.iter_mut().for_each(|entry| *entry ^= inverted);
    }
    let subject = &linked.lists[0].vertices;
    let mut visited = vec![false; subject.len()];
    let mut found = Vec::new();
    for (start, vertex) in subject.iter().enumerate() {
        if vertex.twin.is_some() && !visited[start] {
            t.step(|| Step::Start { at: vertex.at });
            let mut ring = trace(&linked.lists, &entries, start, &mut visited, t);
            // The result is on the left of the subject's border, like the subject itself.
            if !entries[0][start] {
                ring.reverse();
            }
            found.push(ring);
        }
    }
    found
}

/// Returns for each vertex that crosses whether its list enters the other's region there.
///
/// Entries and exits alternate along a ring, from its start on. If rings do not cross, the edges at each crossing
/// decide alone, and exactly, even where rounding has put several crossings in one place.
fn entries(lists: &Lists) -> Vec<bool> {
    lists.vertices.iter().map(|vertex| vertex.enters).collect()
}

/// Walks from a crossing of the subject until it comes back. Rings that are not simple may lead a walk
/// into a circle without crossings: then there is no ring.
fn trace(
    lists: &[Lists; 2],
    entries: &[Vec<bool>; 2],
    start: usize,
    visited: &mut [bool],
    t: &mut impl Tracer<Step>,
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
            let at = lists[k].vertices[v].at;
            t.step(|| Step::Passed { list: [Operand::Subject, Operand::Clip][k], at });
            points.push(at);
            let vertex = &lists[k].vertices[v];
            v = if forward { vertex.next } else { vertex.previous };
            if lists[k].vertices[v].twin.is_some() {
                break;
            }
        }
        let Some(twin) = lists[k].vertices[v].twin else { return points };
        (k, v) = (1 - k, twin);
    }
}
