//! Insertion of points so that neighbours have the same points on shared borders.

use super::conform::{Edge, OWN_REACH, each_near, with_points};
use crate::clip::attribute::VertexSource;
use crate::clip::polygon::Shapes;
use crate::clip::polygon::validity::{Touching, is_valid};
use crate::clip::touch::{are_one, is_within, reach};
use crate::math::DVec2;

/// A feature with more points than before.
#[derive(Debug, Clone, PartialEq)]
pub struct Matched {
    /// The same polygons, ring by ring.
    pub shapes: Shapes,
    /// Source of each point: a vertex, or a place on an edge.
    pub sources: Vec<VertexSource>,
}

/// Returns the features that gain points because others have points on their edges, or within 32 to 64 ulp of them;
/// `None` for features that do not change. No point is moved.
///
/// So the common corner of two parcels becomes a point of a third one that borders on both, and all may be clipped or
/// simplified without a gap. The features must be valid; a feature that would become invalid does not change.
///
/// Cost: O(n log n) for n edges of usual data.
///
/// ```
/// use durer::clip::polygon::{Shapes, coverage::matched};
/// use durer::math::DVec2;
///
/// let ring = |points: &[(f64, f64)]| Shapes::from_rings([points.iter().map(|&p| p.into()).collect::<Vec<DVec2>>()]);
/// let wide = ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 2.0)]);
/// let narrow = ring(&[(0.0, 2.0), (1.0, 2.0), (1.0, 3.0), (0.0, 3.0)]);
/// let found = matched(&[wide, narrow]);
/// let wide = found[0].as_ref().map(|matched| matched.shapes.points()[3]);
/// assert_eq!((wide, found[1].is_none()), (Some(DVec2::new(1.0, 2.0)), true));
/// ```
pub fn matched(features: &[Shapes]) -> Vec<Option<Matched>> {
    let mut edges = Vec::new();
    // Edges are numbered over all features.
    let mut starts = vec![0];
    for shapes in features {
        let start = edges.len();
        edges.extend(Edge::all(shapes).into_iter().map(|e| Edge { index: e.index + start, ..e }));
        starts.push(edges.len());
    }
    let feature_of = |edge: usize| starts.partition_point(|&start| start <= edge) - 1;
    let mut inserted: Vec<Vec<(usize, DVec2)>> = vec![Vec::new(); features.len()];
    each_near(&edges, &edges, OWN_REACH, |edge, other| {
        let (p, [a, b]) = (edge.ends[0], other.ends);
        let lies_on = || is_within(OWN_REACH * reach(p), p, [a, b], [a, b]);
        if !are_one(p, a) && !are_one(p, b) && lies_on() {
            let (own, its) = (feature_of(other.index), feature_of(edge.index));
            if own != its {
                inserted[own].push((other.index - starts[own], p));
            }
        }
    });
    features.iter().zip(inserted).map(|(shapes, points)| divided(shapes, points)).collect()
}

/// Returns the shapes with the points inserted into their edges; `None` if there are none, or if the shapes would
/// become invalid.
fn divided(input: &Shapes, inserted: Vec<(usize, DVec2)>) -> Option<Matched> {
    if inserted.is_empty() {
        return None;
    }
    let (shapes, sources) = with_points(input, inserted);
    is_valid(&shapes, Touching::AtPoints).then_some(Matched { shapes, sources })
}
