//! Vatti's scan beams: polygons swept upwards from vertex to vertex, the result as trapezoids.
//!
//! B. R. Vatti, *A generic solution to polygon clipping*, Communications of the ACM 35(7), 1992. Object space. The
//! heights of all vertices divide the plane into beams, in which no edge begins or ends. Edges come in by pairs, a left
//! and a right bound, at local minima of the rings, and are followed upwards in a list of active edges; where two
//! change places within a beam, they cross. From left to right each active edge changes the winding number of subject
//! or clip; it contributes where that change enters or leaves the result.
//!
//! Cost: O(b a²) for b beams and a active edges, O(trapezoids) memory. Deviations: the result is given as the
//! trapezoids between contributing edges, which Vatti names as the other form of output; horizontal edges bound beams
//! and are in no list. Crossings are rounded to f64. It shares no code with [`super::overlay()`] and serves as its
//! oracle in tests; for polygons use that, or [`super::vatti`].

use super::{BooleanOp, Shapes, WindingRule};
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec2;
use crate::sorting::CompactSort;
use crate::trace::{PseudocodeLine, Tracer};
use crate::{Error, Result};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "scan-beams",
    title: "Vatti's scan beams",
    authors: "B. R. Vatti",
    year: 1992,
    source: "A generic solution to polygon clipping, Communications of the ACM 35(7)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge, Coherence::ScanLine],
    cost: "O(b a²) time for b beams and a edges active at once, memory for the trapezoids",
    limits: "the result is trapezoids; crossings are rounded to f64",
    pseudocode: &[
        "find the local minima: two bounds begin at each",
        "sort the heights of all vertices: beams lie between neighbours",
        "for each beam, from below to above:",
        "    active edges: those that ended leave, those that begin come in",
        "    sort them by x; where two change places they cross",
        "    divide the beam at the crossings; in each part, from left to right:",
        "        the edge changes the winding of its polygon",
        "        it contributes if the result begins or ends at it",
        "        between two contributing edges is a trapezoid of the result",
    ],
};

/// Options for sweeping polygons.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Winding rule of the subject.
    pub subject_rule: WindingRule,
    /// Winding rule of the clip.
    pub clip_rule: WindingRule,
    /// The most trapezoids that are made.
    pub max_trapezoids: usize,
}

impl Default for Options {
    fn default() -> Self {
        let rule = WindingRule::EvenOdd;
        Self { subject_rule: rule, clip_rule: rule, max_trapezoids: 1 << 22 }
    }
}

/// A part of the result between two edges, in one beam or a part of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trapezoid {
    /// y of its lower and its upper side.
    pub y: [f64; 2],
    /// The left and the right end of its lower side.
    pub bottom: [f64; 2],
    /// The left and the right end of its upper side.
    pub top: [f64; 2],
}

impl Trapezoid {
    /// Returns its area.
    pub fn area(&self) -> f64 {
        let width = |[left, right]: [f64; 2]| right - left;
        (self.y[1] - self.y[0]) * 0.5 * (width(self.bottom) + width(self.top))
    }
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A local minimum of a ring: two bounds begin here.
    Minimum {
        /// Position of the point.
        at: DVec2,
        /// True if it belongs to the clip.
        clip: bool,
    },
    /// A beam begins.
    Beam {
        /// Lower and upper y.
        y: [f64; 2],
        /// Number of active edges.
        active: usize,
    },
    /// Two edges cross in the beam.
    Crossing {
        /// Position of the point.
        at: DVec2,
    },
    /// An active edge, from left to right, within a beam or between crossings in it.
    Active {
        /// x below and above.
        x: [f64; 2],
        /// The winding numbers of subject and clip to the right of it.
        winding: [i32; 2],
        /// True if it bounds the result.
        contributes: bool,
    },
    /// A part of the result.
    Part(Trapezoid),
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Minimum { .. } => 1,
            Self::Beam { .. } => 4,
            Self::Crossing { .. } => 5,
            Self::Active { .. } => 7,
            Self::Part(_) => 9,
        }
    }
}

/// Returns the result that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<Trapezoid> {
    let part = |step: &Step| if let Step::Part(part) = *step { Some(part) } else { None };
    steps.iter().filter_map(part).collect()
}

/// An edge directed upwards, whatever the ring's direction.
#[derive(Debug, Clone, Copy)]
struct Edge {
    lower: DVec2,
    upper: DVec2,
    /// Change of the winding number from left to right: 1 where the ring goes down, as on the left
    /// of a counter-clockwise one.
    winding: i32,
    /// 0 of the subject, 1 of the clip.
    operand: usize,
}

impl Edge {
    fn at(&self, y: f64) -> f64 {
        let t = (y - self.lower.y) / (self.upper.y - self.lower.y);
        if t >= 1.0 { self.upper.x } else { self.lower.x + (self.upper.x - self.lower.x) * t }
    }
}

/// Returns the result of a boolean operation as trapezoids, from the lowest beam up and from left
/// to right.
///
/// ```
/// use durer::clip::polygon::scan_beams::{Trapezoid, scan_beams};
/// use durer::clip::polygon::{BooleanOp, Shapes};
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// let square = |x: f64| [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(u, v)| DVec2::new(x + u, x + v));
/// let (a, b) = (Shapes::from_rings([square(0.0)]), Shapes::from_rings([square(1.0)]));
/// let parts = scan_beams(&a, &b, BooleanOp::Union, &Default::default(), &mut NoTrace)?;
/// assert_eq!(parts.iter().map(Trapezoid::area).collect::<Vec<_>>(), [2.0, 3.0, 2.0]);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::NonFinite`] for a point with a NaN or infinite coordinate; [`Error::Limit`] for more trapezoids than the
/// options allow.
pub fn scan_beams(
    subject: &Shapes,
    clip: &Shapes,
    op: BooleanOp,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Vec<Trapezoid>> {
    let mut points = subject.points().iter().chain(clip.points());
    if let Some(index) = points.position(|p| !p.is_finite()) {
        return Err(Error::NonFinite { what: "point", index });
    }
    let mut waiting: Vec<Edge> = Vec::new();
    for (operand, shapes) in [subject, clip].into_iter().enumerate() {
        for ring in shapes.rings() {
            minima(ring, operand == 1, t);
            waiting.extend(edges(ring, operand));
        }
    }
    let mut heights: Vec<f64> = waiting.iter().flat_map(|e| [e.lower.y, e.upper.y]).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup();
    waiting.compact_sort_by(|a, b| b.lower.y.total_cmp(&a.lower.y));
    let (mut active, mut parts): (Vec<Edge>, Vec<Trapezoid>) = (Vec::new(), Vec::new());
    for y in heights.windows(2).map(|pair| [pair[0], pair[1]]) {
        active.retain(|edge| edge.upper.y > y[0]);
        while let Some(edge) = waiting.pop_if(|edge| edge.lower.y <= y[0]) {
            active.push(edge);
        }
        t.step(|| Step::Beam { y, active: active.len() });
        let cuts = cuts(&mut active, y, t);
        for y in cuts.windows(2).map(|pair| [pair[0], pair[1]]) {
            sweep(&mut active, y, op, options, &mut parts, t);
        }
        if parts.len() > options.max_trapezoids {
            let (value, limit) = (parts.len() as u64, options.max_trapezoids as u64);
            return Err(Error::Limit { what: "number of trapezoids", value, limit });
        }
    }
    Ok(parts)
}

/// Reports the local minima of a ring: corners, and ends of level stretches, from which both neighbours rise.
fn minima(ring: &[DVec2], clip: bool, t: &mut impl Tracer<Step>) {
    let mut found = Vec::new();
    let n = ring.len();
    for (i, &at) in ring.iter().enumerate() {
        let other = |k: usize| ring[(i + k) % n];
        if other(1).y > at.y {
            let before = (1..n).map(|k| other(n - k)).find(|p| p.y != at.y);
            found.extend(before.filter(|p| p.y > at.y).map(|_| at));
        }
    }
    found.into_iter().for_each(|at| t.step(|| Step::Minimum { at, clip }));
}

fn edges(ring: &[DVec2], operand: usize) -> impl Iterator<Item = Edge> + '_ {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).filter(|(a, b)| a.y != b.y).map(move |(&a, &b)| {
        let (lower, upper, winding) = if a.y < b.y { (a, b, -1) } else { (b, a, 1) };
        Edge { lower, upper, winding, operand }
    })
}

/// Sorts the active edges by x at the beam's lower side, and returns the heights at which they change places within it, with
/// both sides of the beam.
fn cuts(active: &mut [Edge], y: [f64; 2], t: &mut impl Tracer<Step>) -> Vec<f64> {
    let ends = |e: &Edge| [e.at(y[0]), e.at(y[1])];
    active.compact_sort_by(|a, b| {
        let ([a0, a1], [b0, b1]) = (ends(a), ends(b));
        a0.total_cmp(&b0).then(a1.total_cmp(&b1))
    });
    let mut cuts = y.to_vec();
    for (i, a) in active.iter().enumerate() {
        for b in &active[i + 1..] {
            let ([a0, a1], [b0, b1]) = (ends(a), ends(b));
            if a1 > b1 && a0 < b0 {
                let s = (b0 - a0) / ((b0 - a0) + (a1 - b1));
                let height = y[0] + (y[1] - y[0]) * s;
                t.step(|| Step::Crossing { at: DVec2::new(a0 + (a1 - a0) * s, height) });
                cuts.push(height.clamp(y[0], y[1]));
            }
        }
    }
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    cuts
}

/// Goes from left to right between two heights, where no edges change places.
fn sweep(
    active: &mut [Edge],
    y: [f64; 2],
    op: BooleanOp,
    options: &Options,
    parts: &mut Vec<Trapezoid>,
    t: &mut impl Tracer<Step>,
) {
    let middle = y[0] + (y[1] - y[0]) * 0.5;
    active.compact_sort_by(|a, b| a.at(middle).total_cmp(&b.at(middle)));
    let (mut winding, mut left): ([i32; 2], Option<[f64; 2]>) = ([0; 2], None);
    for edge in active.iter() {
        let x = [edge.at(y[0]), edge.at(y[1])];
        winding[edge.operand] += edge.winding;
        let inside =
            op.keeps(options.subject_rule.fills(winding[0]), options.clip_rule.fills(winding[1]));
        let contributes = inside != left.is_some();
        t.step(|| Step::Active { x, winding, contributes });
        if !contributes {
            continue;
        }
        left = match left {
            None => Some(x),
            Some([bottom, top]) => {
                let part = Trapezoid { y, bottom: [bottom, x[0]], top: [top, x[1]] };
                t.step(|| Step::Part(part));
                parts.push(part);
                None
            }
        };
    }
}
