//! The edges at which curved faces meet others smoothly.
//!
//! A mesh does not record its original faces, but at their borders the curvature changes abruptly: straight across the
//! first edge of a fillet, the surface bends like the fillet on one side, and hardly on the other, along a plane or a
//! cylinder. The facets of the fillet begin at the edge itself, so the mesh turns there by half of the turn from facet
//! to facet. O(n log n).

use super::planes::Planes;
use super::roundness::FLAT;
use super::vertex_normals::{Directions, UNEVEN};
use crate::parallel;
use crate::visibility::object::{EdgeSide, Edges, Faces};
use std::ops::Range;

/// Range of an edge's turn relative to a facet's own: half of it, or less if its neighbour is coarse too, or a whole
/// turn if the triangulation is uneven.
const TURN: Range<f64> = 0.25..1.0;

/// The edges of the mesh that are tangent edges, the smaller vertex first, in order.
pub(super) struct Tangents(Vec<[u32; 2]>);

impl Tangents {
    /// Finds the tangent edges with bends of less than the angle `crease`, in radians.
    pub fn new((faces, edges): (&Faces, &Edges), planes: &Planes, crease: f64) -> Self {
        let items: Vec<u32> = faces.triangles().map(|(item, _)| item).collect();
        let directions = Directions::new((faces, edges), planes, crease, &items);
        let (count, crease) = (faces.points().len() as u32, libm::cos(crease));
        let jobs: Vec<_> =
            (0..count).step_by(JOB).map(|v| v..(v + JOB as u32).min(count)).collect();
        let of = |vertices| {
            let edges = edges.of_vertices(vertices);
            let tangent =
                edges.filter(|(ends, sides)| is_tangent(&directions, *ends, sides, crease));
            tangent.map(|(ends, _)| ends).collect::<Vec<_>>()
        };
        Self(parallel::map(jobs, of).concat())
    }

    /// Returns whether an edge is one.
    pub fn contains(&self, ends: [u32; 2]) -> bool {
        self.0.binary_search(&ends).is_ok()
    }
}

/// Vertices per job.
const JOB: usize = 1 << 15;

fn is_tangent(
    directions: &Directions<'_>,
    ends: [u32; 2],
    sides: &[EdgeSide],
    crease: f64,
) -> bool {
    let [a, b] = sides else { return false };
    let items = [a.item(), b.item()];
    let cosine = directions.of(items[0]).dot(directions.of(items[1]));
    if a.forward() == b.forward() || !(crease..FLAT).contains(&cosine) {
        return false;
    }
    let turn = (2.0 * (1.0 - cosine)).sqrt();
    let [a, b] = items.map(|item| directions.next_bend(ends, item));
    let meets = |round: (f64, Option<f64>), flat: (f64, Option<f64>)| {
        let (width, Some(curvature)) = round else { return false };
        let own = turn / (curvature.abs() * width);
        let is_flatter = |o: f64| o.abs() * UNEVEN <= curvature.abs();
        // The adjoining face is wider than a facet and flatter, or it would be just as round.
        TURN.contains(&own) && width < flat.0 && flat.1.is_none_or(is_flatter)
    };
    meets(a, b) || meets(b, a)
}
