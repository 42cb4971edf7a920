//! The check that polygons are valid, exactly, with the kind and place of each fault.
//!
//! Validity is defined by the OGC's Simple Features (ISO 19125-1, 2004, 6.1.11), except that rings may run either way:
//! rings that neither cross nor touch themselves, that touch one another in single points only, holes within their
//! outer ring and not in one another, polygons outside one another, and the inside of each polygon in one piece. All
//! decisions are made by exact predicates.
//!
//! Edges are compared within horizontal slabs, in the order of their left ends. Cost: O(n √n) for n edges of usual
//! data, O(n²) where most of them overlap in both axes; that is cut off at some thousand comparisons per edge. Few edges are
//! compared each with each.

mod edges;
mod few;
mod nesting;
mod steps;
#[cfg(test)]
mod tests;
mod touches;

pub(super) use edges::{Edge, Meeting, crossing, each_pair, edges_of, meeting};
pub use steps::{EdgeRelation, Step, replay};
pub(super) use touches::{Way, ways};

use super::Shapes;
use crate::info::{Class, Info, Occluder};
use crate::math::DVec2;
use crate::sorting::CompactSort;
use crate::trace::{NoTrace, Tracer};
use crate::{Error, Result};
use nesting::{each_misplaced, nests};
use touches::{Touches, ways_touch};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "validity",
    title: "Validity of polygons by exact predicates",
    authors: "Open Geospatial Consortium",
    year: 2004,
    source: "ISO 19125-1, Simple feature access, 6.1.11",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n √n) for n edges of usual data",
    limits: "some thousand comparisons per edge",
    pseudocode: &[
        "leave out repeated points; fewer than three different ones in a ring: a fault",
        "sort the edges by their left ends; for each two whose boxes may meet:",
        "    apart, or neighbours in their ring with just their vertex in common: no fault",
        "    they cross, or run along each other: a fault",
        "    they touch, and are of one ring: a fault, the ring touches itself",
        "    they touch, and are of two rings: keep the point",
        "for each kept point: a ring passes through another one there: a fault",
        "some edges cross or run along each other: do not check more, go to line 11",
        "rings of one polygon make a cycle by kept points: a fault, they divide its inside",
        "a hole outside its outer ring or in another hole, a polygon in another one: a fault",
        "sort the faults; if there are none, the polygons are valid",
    ],
};

/// Limit on the pairs of edges compared per edge.
pub(super) const PAIRS_PER_EDGE: usize = 4096;

/// Intersections that two edges may have, beside the common vertex of consecutive ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Touching {
    /// None.
    No,
    /// A vertex of both.
    AtVertices,
    /// Edges of different rings may meet in a point that is a vertex of one of them, as the OGC allows.
    AtPoints,
}

/// Fault of polygons.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Fault {
    /// A ring has less than three different points.
    FewPoints,
    /// Two edges cross, or a ring passes through another where they touch.
    Crossing,
    /// Two edges run along each other: spikes, doubled rings, rings with a common side.
    Overlap,
    /// A ring touches itself.
    SelfTouch,
    /// A hole lies outside its polygon's outer ring.
    HoleOutside,
    /// A hole lies in another hole of its polygon.
    HoleInHole,
    /// A polygon lies in another one.
    PolygonInPolygon,
    /// Touching rings cut the inside of a polygon in two.
    Divided,
}

impl Fault {
    /// Returns the words for it in messages.
    pub const fn words(self) -> &'static str {
        match self {
            Self::FewPoints => "a ring has less than three different points",
            Self::Crossing => "edges cross",
            Self::Overlap => "edges run along each other",
            Self::SelfTouch => "a ring touches itself",
            Self::HoleOutside => "a hole lies outside its outer ring",
            Self::HoleInHole => "a hole lies in another hole",
            Self::PolygonInPolygon => "a polygon lies in another",
            Self::Divided => "touching rings divide the inside",
        }
    }

    /// Returns its name, as programs read it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::FewPoints => "few-points",
            Self::Crossing => "crossing",
            Self::Overlap => "overlap",
            Self::SelfTouch => "self-touch",
            Self::HoleOutside => "hole-outside",
            Self::HoleInHole => "hole-in-hole",
            Self::PolygonInPolygon => "polygon-in-polygon",
            Self::Divided => "divided",
        }
    }
}

/// A fault and its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flaw {
    /// Kind of fault.
    pub fault: Fault,
    /// A point of it: of crossings the nearest to it, of rings a vertex.
    pub at: DVec2,
    /// The two rings, by their index over all polygons; equal if the fault is within one ring.
    pub rings: [usize; 2],
}

/// Returns whether all rings are simple and apart from one another, except for allowed touches, holes lie in their
/// outer rings and polygons outside one another. Also `false` if that takes too many comparisons.
///
/// With [`Touching::AtPoints`], polygons whose inside is [divided](Fault::Divided) pass.
pub fn is_valid(shapes: &Shapes, touching: Touching) -> bool {
    edges_are_apart(shapes, touching) && nests(shapes)
}

/// Returns the faults of polygons, sorted by rings and places; empty if they are valid. Repeated points are not a
/// fault.
///
/// Crossings and touches of one pair of rings are reported once per place. If edges cross or overlap, the nesting of
/// rings is not checked.
///
/// ```
/// use durer::clip::polygon::{Shapes, validity::{Fault, flaws}};
/// use durer::math::DVec2;
///
/// let bow = [(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)].map(DVec2::from);
/// let flaws = flaws(&Shapes::from_rings([bow]))?;
/// assert_eq!((flaws[0].fault, flaws[0].at), (Fault::Crossing, DVec2::splat(2.0)));
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::NonFinite`] for a coordinate that is not finite, [`Error::Limit`] if it takes more than some thousand
/// comparisons per edge.
pub fn flaws(shapes: &Shapes) -> Result<Vec<Flaw>> {
    flaws_traced(shapes, &mut NoTrace)
}

/// Returns the faults of polygons as [`flaws`] does, and reports the steps.
///
/// # Errors
/// As [`flaws`].
pub fn flaws_traced(shapes: &Shapes, t: &mut impl Tracer<Step>) -> Result<Vec<Flaw>> {
    if let Some(index) = shapes.points().iter().position(|p| !p.is_finite()) {
        return Err(Error::NonFinite { what: "point", index });
    }
    let (shapes, mut found) = without_repeats(shapes);
    for ring in 0..shapes.ring_count() {
        t.step(|| Step::Ring { ring, points: shapes.ring(ring).len() });
    }
    found.iter().for_each(|&flaw| t.step(|| Step::Found(flaw)));
    let edges = edges_of(&shapes);
    let pairs = edges.len().saturating_mul(PAIRS_PER_EDGE);
    let size = |ring: usize| shapes.ring_range(ring).len();
    let mut touches = Touches::default();
    let all = each_pair(&edges, pairs, |p, q| {
        let relation = match meeting(p, q) {
            Meeting::Apart => EdgeRelation::Apart,
            Meeting::Crossing => EdgeRelation::Flaw(p.flaw(q, Fault::Crossing, crossing(p, q))),
            Meeting::Overlap(at) => EdgeRelation::Flaw(p.flaw(q, Fault::Overlap, at)),
            Meeting::Touch(at) if p.ring != q.ring => {
                touches.add(p, q, at);
                EdgeRelation::Touch(at)
            }
            Meeting::Touch(_) if are_neighbours(p, q, size(p.ring)) => EdgeRelation::Neighbours,
            Meeting::Touch(at) => EdgeRelation::Flaw(p.flaw(q, Fault::SelfTouch, at)),
        };
        if let EdgeRelation::Flaw(flaw) = relation {
            found.push(flaw);
        }
        t.step(|| Step::Pair { edges: [p, q].map(|edge| [edge.ring, edge.index]), relation });
        true
    });
    if !all {
        let (value, limit) = (edges.len() as u64, PAIRS_PER_EDGE as u64);
        return Err(Error::Limit { what: "number of comparisons of edges", value, limit });
    }
    let first = found.len();
    found.extend(touches.passages(&shapes));
    let nested = found.iter().all(|f| f.fault == Fault::SelfTouch);
    if nested {
        found.extend(touches.divisions(&shapes));
        each_misplaced(&shapes, |flaw| {
            found.push(flaw);
            true
        });
    }
    found.iter().skip(first).for_each(|&flaw| t.step(|| Step::Found(flaw)));
    if !nested {
        t.step(|| Step::Stopped);
    }
    sort(&mut found);
    t.step(|| Step::Sorted { count: found.len() });
    Ok(found)
}

/// Sorts flaws and leaves each place of each pair of rings once.
fn sort(flaws: &mut Vec<Flaw>) {
    let place = |p: DVec2, q: DVec2| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y));
    flaws.compact_sort_by(|a, b| {
        a.rings.cmp(&b.rings).then(place(a.at, b.at)).then(a.fault.cmp(&b.fault))
    });
    flaws.dedup_by(|a, b| a == b);
}

/// Returns the shapes without repeated points, and the rings that degenerate by their removal.
fn without_repeats(shapes: &Shapes) -> (Shapes, Vec<Flaw>) {
    let (mut kept, mut few) = (Shapes::new(), Vec::new());
    for polygon in shapes.polygons() {
        for ring in polygon.ring_indices() {
            let mut points = shapes.ring(ring).to_vec();
            points.dedup();
            while points.len() > 1 && points.first() == points.last() {
                points.pop();
            }
            let mut different: Vec<DVec2> = Vec::new();
            points.iter().for_each(|p| {
                if different.len() < 3 && !different.contains(p) {
                    different.push(*p);
                }
            });
            if different.len() < 3 {
                let at = points.first().copied().unwrap_or_default();
                few.push(Flaw { fault: Fault::FewPoints, at, rings: [ring; 2] });
                points.clear();
            }
            kept.push_ring(points);
        }
        kept.end_polygon();
    }
    (kept, few)
}

/// Returns whether no two edges cross, overlap or touch, except for allowed touches. Also `false` for rings of fewer
/// than three points, for repeated points, and if there are too many comparisons.
pub(crate) fn edges_are_apart(shapes: &Shapes, touching: Touching) -> bool {
    if touching == Touching::No && shapes.points().len() <= few::FEW {
        return few::are_apart(shapes);
    }
    each_fault(shapes, touching, |_| false)
}

/// Returns the points, by their indices, at the ends of edges that are not apart, each once; `None` if it
/// takes too many comparisons.
pub(super) fn faults(shapes: &Shapes, touching: Touching) -> Option<Vec<usize>> {
    let mut points = Vec::new();
    let all = each_fault(shapes, touching, |ends| {
        points.extend_from_slice(ends);
        !ends.is_empty()
    });
    points.sort_unstable();
    points.dedup();
    all.then_some(points)
}

/// Calls `visit` with the points of each fault, or without a fault if there are too many comparisons, as long as it
/// returns true; returns whether it always did.
fn each_fault(
    shapes: &Shapes,
    touching: Touching,
    mut visit: impl FnMut(&[usize]) -> bool,
) -> bool {
    if shapes.points().len() <= few::FEW && few::are_apart(shapes) {
        return true;
    }
    each_fault_of_many(shapes, touching, &mut visit)
}

/// Does the same by sorted edges.
fn each_fault_of_many(
    shapes: &Shapes,
    touching: Touching,
    visit: &mut impl FnMut(&[usize]) -> bool,
) -> bool {
    for ring in 0..shapes.ring_count() {
        let range = shapes.ring_range(ring);
        if range.len() < 3 && !visit(&[range.start]) {
            return false;
        }
    }
    let edges = edges_of(shapes);
    if !edges.iter().filter(|e| e.a == e.b).all(|e| visit(&e.ends)) {
        return false;
    }
    let size = |ring: usize| shapes.ring_range(ring).len();
    let most = edges.len().saturating_mul(PAIRS_PER_EDGE);
    let mut goes_on = true;
    let all = each_pair(&edges, most, |p, q| {
        let apart = match meeting(p, q) {
            Meeting::Apart => true,
            Meeting::Crossing | Meeting::Overlap(_) => false,
            Meeting::Touch(at) => may_touch(p, q, at, size(p.ring), touching),
        };
        goes_on = apart || visit(&[p.ends[0], p.ends[1], q.ends[0], q.ends[1]]);
        goes_on
    });
    // Too many comparisons, unless the answer was no.
    let all = all || goes_on && visit(&[]);
    all && (touching == Touching::No || each_passage(shapes, visit))
}

/// Returns whether two edges may touch in a point.
fn may_touch(p: &Edge, q: &Edge, at: DVec2, size: usize, touching: Touching) -> bool {
    match touching {
        Touching::No => are_neighbours(p, q, size),
        Touching::AtVertices => [p.a, p.b].contains(&at) && [q.a, q.b].contains(&at),
        Touching::AtPoints => p.ring != q.ring || are_neighbours(p, q, size),
    }
}

/// Returns whether one edge of a ring of `size` edges follows the other.
fn are_neighbours(p: &Edge, q: &Edge, size: usize) -> bool {
    p.ring == q.ring && ((p.index + 1) % size == q.index || (q.index + 1) % size == p.index)
}

/// Calls `visit` with the vertices in which rings do not only touch but pass through each other, as long as it returns
/// true; returns whether it always did.
fn each_passage(shapes: &Shapes, mut visit: impl FnMut(&[usize]) -> bool) -> bool {
    let of_ring = |ring| shapes.ring_range(ring).zip(ways(shapes.ring(ring)));
    let mut ways: Vec<(usize, Way)> = (0..shapes.ring_count()).flat_map(of_ring).collect();
    // Zeros of either sign are one place.
    let order = |p: &DVec2, q: &DVec2| {
        (p.x + 0.0).total_cmp(&(q.x + 0.0)).then((p.y + 0.0).total_cmp(&(q.y + 0.0)))
    };
    ways.compact_sort_by(|(_, [p, ..]), (_, [q, ..])| order(p, q));
    ways.chunk_by(|(_, [p, ..]), (_, [q, ..])| p == q).all(|through| {
        through.iter().enumerate().all(|(i, &(index, way))| {
            through[..i].iter().all(|&(other, w)| ways_touch(way, w) || visit(&[index, other]))
        })
    })
}
