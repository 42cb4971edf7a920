//! Weiler–Atherton: walk the subject from where it enters the clip to where it leaves, then the
//! clip until the subject enters again.
//!
//! K. Weiler, P. Atherton, *Hidden surface removal using polygon area sorting*, Computer Graphics
//! (SIGGRAPH) 11(2), 1977. We tell touching vertices and common edges from crossings by the rule of
//! Foster, Hormann and Popa (2019), and give union and difference by the same lists.

use super::cyclic::{Linked, finish, link};
use super::locate::group;
use super::{BooleanOp, Shapes};
use crate::info::{Class, Info};
use crate::math::DVec2;
use crate::trace::Tracer;

/// The facts.
pub const INFO: Info = Info {
    name: "weiler-atherton",
    title: "Weiler–Atherton",
    authors: "K. Weiler, P. Atherton",
    year: 1977,
    source: "Hidden surface removal using polygon area sorting, Computer Graphics 11(2)",
    class: Class::ObjectSpace,
    cost: "O(n m) time for n and m edges, O(n + m + k) memory for k crossings",
    limits: "polygons whose rings are simple and do not touch one another; \
             crossings are rounded to f64",
};

/// There is nothing to choose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {}

/// What happens, step by step.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// The walk turns from one border to the other.
    Turn {
        /// Where.
        at: DVec2,
        /// Whether it goes on along the subject.
        to_subject: bool,
    },
    /// A ring of the result is complete.
    Ring {
        /// Its points, in the order of the walk.
        points: Vec<DVec2>,
        /// Whether it is of the second half of an xor: clip without subject.
        swapped: bool,
    },
}

/// Rebuilds the result from its steps.
pub fn replay(steps: &[Step]) -> Shapes {
    let half = |second: bool| {
        let rings = steps.iter().filter_map(move |step| match step {
            Step::Ring { points, swapped } if *swapped == second => Some(points.clone()),
            _ => None,
        });
        group(rings.collect())
    };
    let mut shapes = half(false);
    shapes.append(&half(true));
    shapes
}

/// Clips polygons with polygons; both with holes, by the even-odd rule.
///
/// ```
/// use durer::clip::polygon::{BooleanOp, Shapes, weiler_atherton::weiler_atherton};
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// let square = |x: f64| [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(u, v)| DVec2::new(x + u, x + v));
/// let (a, b) = (Shapes::from_rings([square(0.0)]), Shapes::from_rings([square(1.0)]));
/// let both = weiler_atherton(&a, &b, BooleanOp::Intersection, &Default::default(), &mut NoTrace);
/// assert_eq!(both.area(), 1.0);
/// ```
pub fn weiler_atherton(
    subject: &Shapes,
    clip: &Shapes,
    op: BooleanOp,
    _options: &Options,
    t: &mut impl Tracer<Step>,
) -> Shapes {
    if op != BooleanOp::Xor {
        return walk(subject, clip, op, false, t);
    }
    let mut shapes = walk(subject, clip, BooleanOp::Difference, false, t);
    shapes.append(&walk(clip, subject, BooleanOp::Difference, true, t));
    shapes
}

fn walk(
    subject: &Shapes,
    clip: &Shapes,
    op: BooleanOp,
    swapped: bool,
    t: &mut impl Tracer<Step>,
) -> Shapes {
    let linked = link(subject, clip);
    // Intersection follows the subject where it has come in, the others where it has gone out.
    let starts_in = op == BooleanOp::Intersection;
    let mut visited = vec![false; linked.subject.vertices.len()];
    let mut found = Vec::new();
    for start in 0..visited.len() {
        let vertex = &linked.subject.vertices[start];
        if vertex.crosses && vertex.enters == starts_in && !visited[start] {
            found.push(trace(&linked, op, start, &mut visited, t));
        }
    }
    found.extend(linked.whole_rings(op));
    finish(found, |points| t.step(|| Step::Ring { points: points.to_vec(), swapped }))
}

/// Walks from a crossing of the subject until it comes back. Orientation is the same all around,
/// so only difference walks the clip backwards.
fn trace(
    linked: &Linked,
    op: BooleanOp,
    start: usize,
    visited: &mut [bool],
    t: &mut impl Tracer<Step>,
) -> Vec<DVec2> {
    let (subject, clip) = (&linked.subject.vertices, &linked.clip.vertices);
    let mut points = Vec::new();
    let mut v = start;
    loop {
        t.step(|| Step::Turn { at: subject[v].at, to_subject: true });
        visited[v] = true;
        loop {
            points.push(subject[v].at);
            v = subject[v].next;
            if subject[v].crosses {
                break;
            }
        }
        let Some(mut w) = subject[v].twin else { return points };
        t.step(|| Step::Turn { at: clip[w].at, to_subject: false });
        loop {
            points.push(clip[w].at);
            w = if op == BooleanOp::Difference { clip[w].previous } else { clip[w].next };
            if clip[w].crosses {
                break;
            }
        }
        match clip[w].twin {
            Some(next) if !visited[next] => v = next,
            _ => return points,
        }
    }
}
