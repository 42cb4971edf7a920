//! The method as it is taught: border after border, each with the whole list of vertices.
//!
//! The cuts are those of the chain of stages, so the ring is the same but may begin at another vertex. Four rules cover
//! the two ends of an edge; the first edge leads from the last vertex to the first.

use super::{MixableVertex, cut, finite_vertices};
use crate::Result;
use crate::clip::line::HalfSpace;
use crate::trace::{PseudocodeLine, Tracer};
use std::cmp::Ordering;

/// Rule for an edge, by the sides of a border that its two ends are on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum EdgeRule {
    /// Both inside: the end is emitted.
    InIn,
    /// The edge leaves: its cut is emitted.
    InOut,
    /// The edge enters: its cut and its end are emitted.
    OutIn,
    /// Both outside: nothing is emitted.
    OutOut,
}

impl EdgeRule {
    fn of(from_inside: bool, to_inside: bool) -> Self {
        match (from_inside, to_inside) {
            (true, true) => Self::InIn,
            (true, false) => Self::InOut,
            (false, true) => Self::OutIn,
            (false, false) => Self::OutOut,
        }
    }

    /// Returns the rule's name as it is written on the blackboard.
    pub const fn name(self) -> &'static str {
        match self {
            Self::InIn => "in→in",
            Self::InOut => "in→out",
            Self::OutIn => "out→in",
            Self::OutOut => "out→out",
        }
    }
}

/// Step of the algorithm.
#[derive(Debug, Clone, PartialEq)]
pub enum Step<V> {
    /// An edge was examined.
    Edge {
        /// The border's index.
        border: usize,
        /// Start of the edge.
        from: V,
        /// End of the edge.
        to: V,
        /// Rule that applies to the edge.
        rule: EdgeRule,
        /// Emitted vertices: the cut, and the end. There is no cut if an end lies on the border
        /// itself.
        emitted: [Option<V>; 2],
    },
    /// A border is done: the remaining vertices.
    List {
        /// The border's index.
        border: usize,
        /// The vertices.
        vertices: Vec<V>,
    },
}

impl<V> PseudocodeLine for Step<V> {
    /// Returns the line of [`super::INFO`]'s pseudocode that runs, counted from 1.
    fn line(&self) -> usize {
        match self {
            Self::Edge { rule: EdgeRule::InIn, .. } => 4,
            Self::Edge { rule: EdgeRule::InOut, .. } => 5,
            Self::Edge { rule: EdgeRule::OutIn, .. } => 6,
            Self::Edge { rule: EdgeRule::OutOut, .. } => 7,
            Self::List { .. } => 9,
        }
    }
}

/// Returns the result that a list of steps leads to.
pub fn replay<V: Clone>(ring: &[V], steps: &[Step<V>]) -> Vec<V> {
    let lists = steps.iter().filter_map(|step| match step {
        Step::List { vertices, .. } => Some(vertices),
        Step::Edge { .. } => None,
    });
    lists.last().cloned().unwrap_or_else(|| ring.to_vec())
}

/// Returns the part of a ring on the inner side of all borders, one border after the other, as one
/// ring.
///
/// ```
/// use durer::clip::line::HalfPlane;
/// use durer::clip::polygon::sutherland_hodgman::by_borders::clip;
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// let right = HalfPlane { normal: DVec2::X, point: DVec2::ZERO };
/// let ring = [(-1.0, 0.0), (1.0, 0.0), (1.0, 2.0)].map(DVec2::from);
/// let clipped = clip(&[right], &ring, &mut NoTrace)?;
/// assert_eq!(clipped, [(0.0, 1.0), (0.0, 0.0), (1.0, 0.0), (1.0, 2.0)].map(DVec2::from));
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`NonFinite`](crate::Error::NonFinite) for a vertex with a NaN or infinite coordinate.
pub fn clip<const N: usize, H: HalfSpace<N>, V: MixableVertex<N>>(
    borders: &[H],
    ring: &[V],
    t: &mut impl Tracer<Step<V>>,
) -> Result<Vec<V>> {
    finite_vertices(ring)?;
    let mut vertices = ring.to_vec();
    for (index, border) in borders.iter().enumerate() {
        vertices = past(index, border, &vertices, t);
        t.step(|| Step::List { border: index, vertices: vertices.clone() });
    }
    Ok(vertices)
}

/// Clips a list to one border.
fn past<const N: usize, H: HalfSpace<N>, V: MixableVertex<N>>(
    index: usize,
    border: &H,
    vertices: &[V],
    t: &mut impl Tracer<Step<V>>,
) -> Vec<V> {
    let side = |v: V| (v, border.sign(v.position()) != Ordering::Less);
    let Some(mut from) = vertices.last().copied().map(side) else { return Vec::new() };
    let mut left = Vec::new();
    for to in vertices.iter().copied().map(side) {
        let emitted = [cut(border, from, to), to.1.then_some(to.0)];
        left.extend(emitted.into_iter().flatten());
        let rule = EdgeRule::of(from.1, to.1);
        t.step(|| Step::Edge { border: index, from: from.0, to: to.0, rule, emitted });
        from = to;
    }
    left
}
