//! Two sets of rings as cyclic lists of vertices with their crossings linked, on which Weiler–Atherton and
//! Greiner–Hormann walk.
//!
//! Touching vertices and common edges are distinguished from true crossings in the spirit of E. L. Foster, K. Hormann
//! and R. T. Popa (*Clipping simple polygons with degenerate intersections*, Computers & Graphics: X 2, 2019). They
//! consider each pair of borders; we consider a common point with all borders through it, so that rings of one operand
//! may touch one another there (`node.rs`). Where they delay a crossing to the end of common edges, we treat the
//! subject as shrunk, for union as grown, by an infinitesimal amount: then the result has no common edge on two sides.

use super::group::{group, is_flat};
use super::lists::{CROSSING_AND_TOUCHING, Lists, NOT_SIMPLE, Start, join};
use super::near::pairs;
use super::node;
use super::point::{Place, locate, on_segment};
use super::steps::{CrossingMark, Step};
use super::{BooleanOp, Operand, Shapes, WindingRule};
use crate::clip::exact;
use crate::math::{DVec2, Orientation, orient2d};
use crate::sorting::CompactSort;
use crate::trace::Tracer;
use crate::{Error, Result};
use std::cmp::Ordering;

/// Subject and clip with all crossings linked.
#[derive(Debug)]
pub(super) struct Linked {
    /// The lists of subject and clip.
    pub lists: [Lists; 2],
    /// The rings that they come from.
    rings: [Shapes; 2],
}

/// Returns the rings without repeated points and flat rings, outer ones counter-clockwise, holes
/// clockwise.
fn tidy(shapes: &Shapes) -> Shapes {
    group(distinct(shapes).collect())
}

/// Links two sets of rings that may cross themselves and one another, by the even-odd rule: from where a ring starts,
/// entries and exits take turns. The rings keep their directions.
///
/// # Errors
/// [`Error::Unsupported`] if a vertex or an edge of one operand touches the other: which of the borders cross there
/// depends on their neighbours, of which crossing rings may have any number.
pub(super) fn link_crossing(subject: &Shapes, clip: &Shapes) -> Result<Linked> {
    let rings = [subject, clip].map(|shapes| Shapes::from_rings(distinct(shapes)));
    let mut linked = Linked { lists: [Lists::new(&rings[0]), Lists::new(&rings[1])], rings };
    if linked.touches() {
        return Err(CROSSING_AND_TOUCHING);
    }
    linked.locate(&[], false);
    let crossings = linked.crossings();
    linked.insert(crossings);
    linked.lists.iter_mut().for_each(Lists::alternate);
    Ok(linked)
}

/// Returns the rings without repeated points, leaving out flat rings.
fn distinct(shapes: &Shapes) -> impl Iterator<Item = Vec<DVec2>> {
    let rings = shapes.rings().map(|ring| {
        let mut ring = ring.to_vec();
        ring.dedup();
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        ring
    });
    rings.filter(|ring| !is_flat(ring))
}

/// Links two sets of rings for an operation.
///
/// # Errors
/// [`Error::NonFinite`] for a point with a NaN or infinite coordinate; [`Error::Unsupported`] where
/// rings of one operand cross or overlap themselves or one another.
pub(super) fn link(subject: &Shapes, clip: &Shapes, op: BooleanOp) -> Result<Linked> {
    let mut points = subject.points().iter().chain(clip.points());
    if let Some(index) = points.position(|p| !p.is_finite()) {
        return Err(Error::NonFinite { what: "point", index });
    }
    let rings = [tidy(subject), tidy(clip)];
    let mut linked = Linked { lists: [Lists::new(&rings[0]), Lists::new(&rings[1])], rings };
    linked.divide()?;
    let crossings = linked.crossings();
    // Neighbours at common points are examined before rounded crossings come between them.
    let grown = op == BooleanOp::Union;
    let nodes = node::common(&linked.lists);
    for node in &nodes {
        node.check()?;
    }
    linked.locate(&nodes, grown);
    for node in &nodes {
        node.link(&mut linked.lists, grown);
    }
    linked.insert(crossings);
    Ok(linked)
}

impl Linked {
    /// Divides edges at the vertices that lie on them, of either operand.
    fn divide(&mut self) -> Result<()> {
        let count = self.lists[0].vertices.len();
        let edges: Vec<[DVec2; 2]> = self.lists.iter().flat_map(Lists::edges).collect();
        let mut touches: Vec<(usize, DVec2)> = Vec::new();
        let mut apart = true;
        pairs(&edges, |i, j| {
            let ([a, b], [c, d]) = (edges[i], edges[j]);
            touches.extend([a, b].into_iter().filter(|&p| lies_within(c, d, p)).map(|p| (j, p)));
            touches.extend([c, d].into_iter().filter(|&p| lies_within(a, b, p)).map(|p| (i, p)));
            apart &= (i < count) != (j < count) || !crosses([a, b], [c, d]);
        });
        // A point on a segment has its place there given by either coordinate.
        let along = |&(edge, p): &(usize, DVec2)| {
            let [a, b] = edges[edge];
            let steep = (b.y - a.y).abs() > (b.x - a.x).abs();
            if steep { (p.y - a.y).abs() } else { (p.x - a.x).abs() }
        };
        touches.compact_sort_by(|s, t| s.0.cmp(&t.0).then(along(s).total_cmp(&along(t))));
        touches.dedup();
        let mut after = (usize::MAX, 0);
        for (edge, p) in touches {
            let list = usize::from(edge >= count);
            let start = if edge == after.0 { after.1 } else { edge - list * count };
            after = (edge, self.lists[list].insert(start, p));
        }
        if apart { Ok(()) } else { Err(NOT_SIMPLE) }
    }

    /// Returns whether a vertex of one operand lies on the border of the other; exact.
    fn touches(&self) -> bool {
        let count = self.lists[0].vertices.len();
        let edges: Vec<[DVec2; 2]> = self.lists.iter().flat_map(Lists::edges).collect();
        let mut touches = false;
        pairs(&edges, |i, j| {
            let ([a, b], [c, d]) = (edges[i], edges[j]);
            let meets = |p: DVec2, [a, b]: [DVec2; 2]| on_segment(a, b, p);
            touches |= (i < count) != (j < count)
                && ([a, b].into_iter().any(|p| meets(p, [c, d]))
                    || [c, d].into_iter().any(|p| meets(p, [a, b])));
        });
        touches
    }

    /// Returns the pairs of edges that cross inside both, by the vertices where they start.
    fn crossings(&self) -> Vec<[usize; 2]> {
        let count = self.lists[0].vertices.len();
        let edges: Vec<[DVec2; 2]> = self.lists.iter().flat_map(Lists::edges).collect();
        let mut found = Vec::new();
        pairs(&edges, |i, j| {
            let (i, j) = (i.min(j), i.max(j));
            if i < count && j >= count && crosses(edges[i], edges[j]) {
                found.push([i, j - count]);
            }
        });
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Finds for every ring whether it starts inside the other's region.
    fn locate(&mut self, nodes: &[node::Node], grown: bool) {
        for k in 0..2 {
            let starts_inside = |start: &Start| {
                let v = start.vertex;
                let node =
                    nodes.binary_search_by(|node| node.compare(self.lists[k].vertices[v].at));
                let inside = node.ok().and_then(|i| nodes[i].inside(k, v, grown));
                inside.unwrap_or_else(|| {
                    let (rings, p) = (self.rings[1 - k].rings(), self.lists[k].vertices[v].at);
                    locate(rings, p, WindingRule::EvenOdd) == Place::Inside
                })
            };
            let inside: Vec<bool> = self.lists[k].starts.iter().map(starts_inside).collect();
            for (start, inside) in self.lists[k].starts.iter_mut().zip(inside) {
                start.inside = inside;
            }
        }
    }

    /// Puts in crossings of edges, rounded, in their exact order along both edges.
    fn insert(&mut self, crossings: Vec<[usize; 2]>) {
        let edge = |k: usize, v: usize| self.lists[k].edge(self.lists[k].leaves(v));
        let edges: Vec<[[DVec2; 2]; 2]> =
            crossings.iter().map(|&[i, j]| [edge(0, i), edge(1, j)]).collect();
        let places: Vec<DVec2> = edges.iter().map(|&[e, f]| crossing_point(e, f)).collect();
        let mut vertices = [vec![0; crossings.len()], vec![0; crossings.len()]];
        for k in 0..2 {
            let mut order: Vec<usize> = (0..crossings.len()).collect();
            let about = |i: usize| edges[i][k][0].distance_squared(places[i]);
            order.compact_sort_by(|&i, &j| {
                crossings[i][k].cmp(&crossings[j][k]).then(about(i).total_cmp(&about(j)))
            });
            // Nearly in order already, so that sorting by insertion takes little time.
            for end in 1..order.len() {
                let mut at = end;
                while at > 0 {
                    let (i, j) = (order[at - 1], order[at]);
                    let one = crossings[i][k] == crossings[j][k];
                    if !one || order_along(edges[i][k], edges[i][1 - k], edges[j][1 - k]).is_le() {
                        break;
                    }
                    order.swap(at - 1, at);
                    at -= 1;
                }
            }
            let mut after = (usize::MAX, 0);
            for i in order {
                let edge = crossings[i][k];
                let start = if edge == after.0 { after.1 } else { self.lists[k].leaves(edge) };
                after = (edge, self.lists[k].insert(start, places[i]));
                vertices[k][i] = after.1;
            }
        }
        for (i, &[[_, b], [c, d]]) in edges.iter().enumerate() {
            let enters = orient2d(c, d, b) == Orientation::CounterClockwise;
            join(&mut self.lists, [vertices[0][i], vertices[1][i]], enters);
        }
    }

    /// Reports both lists to a tracer.
    pub fn trace(&self, t: &mut impl Tracer<Step>) {
        for (lists, list) in self.lists.iter().zip([Operand::Subject, Operand::Clip]) {
            for v in lists.starts.iter().flat_map(|start| lists.ring(start.vertex)) {
                t.step(|| {
                    let vertex = &lists.vertices[v];
                    let mark =
                        if vertex.enters { CrossingMark::Entering } else { CrossingMark::Leaving };
                    Step::Listed { list, at: vertex.at, mark: vertex.twin.map(|_| mark) }
                });
            }
        }
    }

    /// Returns the rings that nothing crosses and that belong to the result, the inside on their
    /// left.
    pub fn whole_rings(&self, op: BooleanOp) -> Vec<Vec<DVec2>> {
        let mut rings = Vec::new();
        for (k, list) in self.lists.iter().enumerate() {
            let is_clip = k == 1;
            for start in &list.starts {
                let crossed = list.ring(start.vertex).any(|v| list.vertices[v].twin.is_some());
                let kept = match op {
                    BooleanOp::Intersection => start.inside,
                    BooleanOp::Union => !start.inside,
                    BooleanOp::Difference | BooleanOp::Xor => start.inside == is_clip,
                };
                if crossed || !kept {
                    continue;
                }
                let mut ring: Vec<DVec2> =
                    list.ring(start.vertex).map(|v| list.vertices[v].at).collect();
                if is_clip && op == BooleanOp::Difference {
                    ring.reverse();
                }
                rings.push(ring);
            }
        }
        rings
    }
}

/// Returns whether a point lies on a segment, but not at its ends; exact.
fn lies_within(a: DVec2, b: DVec2, p: DVec2) -> bool {
    p != a && p != b && on_segment(a, b, p)
}

/// Returns whether two segments cross inside both; exact.
fn crosses([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let opposite = |s: Orientation, t: Orientation| {
        s != t && s != Orientation::Collinear && t != Orientation::Collinear
    };
    opposite(orient2d(a, b, c), orient2d(a, b, d)) && opposite(orient2d(c, d, a), orient2d(c, d, b))
}

/// Returns the intersection of two segments, correctly rounded.
fn crossing_point(e: [DVec2; 2], f: [DVec2; 2]) -> DVec2 {
    exact::crossing(e, f).unwrap_or(e[0])
}

/// Compares the places where two segments that do not cross each other cross a → b; exact. Of two segments that do not
/// cross, one is on one side of the other's line.
fn order_along([_, b]: [DVec2; 2], first: [DVec2; 2], second: [DVec2; 2]) -> Ordering {
    let side = |[c, d]: [DVec2; 2], of: [DVec2; 2]| match of.map(|p| orient2d(c, d, p)) {
        [Orientation::Collinear, s] | [s, Orientation::Collinear] => Some(s),
        [s, t] => (s == t).then_some(s),
    };
    let beyond = |line: [DVec2; 2], side: Orientation| side == orient2d(line[0], line[1], b);
    match (side(first, second), side(second, first)) {
        (Some(Orientation::Collinear), _) => Ordering::Equal,
        (Some(side), _) => {
            if beyond(first, side) {
                Ordering::Less
            } else {
                Ordering::Greater
            }
        }
        (None, Some(side)) => {
            if beyond(second, side) {
                Ordering::Greater
            } else {
                Ordering::Less
            }
        }
        (None, None) => Ordering::Equal,
    }
}
