//! Weiler–Atherton: walk the subject from where it enters the clip to where it leaves, then the
//! clip until the subject enters again.
//!
//! K. Weiler, P. Atherton, *Hidden surface removal using polygon area sorting*, Computer Graphics (SIGGRAPH) 11(2),
//! 1977. Deviations: touching vertices and common edges are distinguished from crossings by the rule of Foster, Hormann
//! and Popa (2019), and union and difference use the same lists.

use super::cyclic::Linked;
use super::walk::walk_all;
use super::{BooleanOp, Operand, Shapes};
use crate::Result;
use crate::info::{Class, Info, Occluder};
use crate::math::DVec2;
use crate::trace::Tracer;

pub use super::steps::{CrossingMark, Options, Step, replay};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "weiler-atherton",
    title: "Weiler–Atherton",
    authors: "K. Weiler, P. Atherton",
    year: 1977,
    source: "Hidden surface removal using polygon area sorting, Computer Graphics 11(2)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n log n + p) time for n edges of both and p pairs that are near each other, \
           O(n² + r²) at worst for r rings; O(n + k) memory for k crossings",
    limits: "polygons whose rings neither cross nor overlap, refused otherwise; they may touch in points. \
             Crossings are rounded to f64, so rings nearer than that may cross in the result",
    pseudocode: &[
        "insert the crossings into the cyclic lists of both polygons, linked in pairs",
        "mark each crossing: does the subject enter the clip or leave it?",
        "while there is a crossing not yet visited at which the subject enters:",
        "    begin a ring there",
        "    turn onto the subject's list",
        "    emit vertices of the subject up to the next crossing",
        "    turn onto the clip's list at the linked crossing",
        "    emit vertices of the clip up to the next crossing",
        "    back at the ring's first point: it is complete; else go to 5",
        "rings without crossings are inside or outside as a whole",
    ],
};

/// Clips polygons with polygons; both with holes, by the even-odd rule.
///
/// ```
/// use durer::clip::polygon::{BooleanOp, Shapes, weiler_atherton::weiler_atherton};
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// let square = |x: f64| [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(u, v)| DVec2::new(x + u, x + v));
/// let (a, b) = (Shapes::from_rings([square(0.0)]), Shapes::from_rings([square(1.0)]));
/// let both = weiler_atherton(&a, &b, BooleanOp::Intersection, &Default::default(), &mut NoTrace)?;
/// assert_eq!(both.area(), 1.0);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`NonFinite`](crate::Error::NonFinite) for a point with a NaN or infinite coordinate;
/// [`Unsupported`](crate::Error::Unsupported) if rings of an operand cross or overlap themselves or
/// one another, or turn back on themselves.
pub fn weiler_atherton(
    subject: &Shapes,
    clip: &Shapes,
    op: BooleanOp,
    _options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Shapes> {
    walk_all([subject, clip], op, false, t, walk)
}

fn walk(linked: &Linked, op: BooleanOp, t: &mut impl Tracer<Step>) -> Vec<Vec<DVec2>> {
    // Intersection follows the subject where it has entered, the others where it has left.
    let starts_in = op == BooleanOp::Intersection;
    let subject = &linked.lists[0].vertices;
    let mut visited = vec![false; subject.len()];
    let mut found = Vec::new();
    for (start, vertex) in subject.iter().enumerate() {
        if vertex.twin.is_some() && vertex.enters == starts_in && !visited[start] {
            t.step(|| Step::Start { at: vertex.at });
            found.push(trace(linked, op, start, &mut visited, t));
        }
    }
    found
}

/// Walks from a crossing of the subject until it comes back. Orientation is the same all around,
/// so only difference walks the clip backwards. Rings that are not simple may lead a walk into a circle
/// without crossings: then there is no ring.
fn trace(
    linked: &Linked,
    op: BooleanOp,
    start: usize,
    visited: &mut [bool],
    t: &mut impl Tracer<Step>,
) -> Vec<DVec2> {
    let [subject, clip] = [&linked.lists[0].vertices, &linked.lists[1].vertices];
    let all = subject.len() + clip.len();
    let mut points = Vec::new();
    let mut v = start;
    loop {
        t.step(|| Step::Turn { at: subject[v].at, to_subject: true });
        visited[v] = true;
        loop {
            t.step(|| Step::Passed { list: Operand::Subject, at: subject[v].at });
            points.push(subject[v].at);
            v = subject[v].next;
            if points.len() > all {
                return Vec::new();
            }
            if subject[v].twin.is_some() {
                break;
            }
        }
        let Some(mut w) = subject[v].twin else { return points };
        t.step(|| Step::Turn { at: clip[w].at, to_subject: false });
        loop {
            t.step(|| Step::Passed { list: Operand::Clip, at: clip[w].at });
            points.push(clip[w].at);
            if points.len() > all {
                return Vec::new();
            }
            w = if op == BooleanOp::Difference { clip[w].previous } else { clip[w].next };
            if clip[w].twin.is_some() {
                break;
            }
        }
        match clip[w].twin {
            Some(next) if !visited[next] => v = next,
            _ => return points,
        }
    }
}
