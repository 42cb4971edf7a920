//! The check that polygons side by side are a coverage: none overlaps another, and where two share a border, both have
//! the same edges there, point for point.
//!
//! M. Davis, *Polygonal coverage validation in JTS*, 2022: by edges, without an overlay. An edge of two features must
//! run the other way in the second one; edges that cross, run along each other in part, or end on one another have no
//! counterpart. At common vertices no edge may lead into the other polygon, and a polygon that meets no border of
//! another feature is tested for being inside it. Gaps are holes of the union. Class: object space, exact but for the
//! gaps. Cost: as for [validity](super::validity), plus a union if gaps are requested.

use super::rectangle::{Near, Prepared};
use super::validity::{
    Edge, Meeting, PAIRS_PER_EDGE, Way, crossing, each_pair, edges_of, meeting, ways,
};
use super::{
    BooleanOp, Shapes, WindingRule, overlay, overlay::Options as OverlayOptions, signed_area,
};
use crate::clip::touch::{is_on, reach};
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, Orientation, Rect, in_sector, orient2d};
use crate::trace::NoTrace;
use crate::{Error, Result};
use std::collections::{BTreeMap, BTreeSet};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "coverage-check",
    title: "Validity of coverages by their edges",
    authors: "M. Davis",
    year: 2022,
    source: "Polygonal coverage validation in JTS",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n √n) for n edges of usual data, and a union if gaps are requested",
    limits: "features must be valid",
    pseudocode: &[],
};

/// Mismatch between two features.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Mismatch {
    /// They have an area in common.
    Overlap,
    /// They share a border, or touch, and one has a point there that the other has not.
    Unmatched,
    /// A narrow hole between them and others.
    Gap,
}

impl Mismatch {
    /// Returns the words for it in messages.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Overlap => "two features overlap",
            Self::Unmatched => {
                "one of two neighbours has a point on the border that the other has not"
            }
            Self::Gap => "there is a gap",
        }
    }

    /// Returns its name, as programs read it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Overlap => "overlap",
            Self::Unmatched => "unmatched",
            Self::Gap => "gap",
        }
    }
}

/// A mismatch and its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Misfit {
    /// Kind of mismatch.
    pub mismatch: Mismatch,
    /// A point of it.
    pub at: DVec2,
    /// The two features, in order; for gaps, one adjacent feature twice.
    pub features: [usize; 2],
}

/// Returns the mismatches that keep features from being a coverage, sorted by features and places; empty if they are
/// one. Each feature must be [valid](super::validity::flaws).
///
/// `gap_width`: holes of the whole whose area is less than this times half their length are gaps; `None`: none is.
///
/// ```
/// use durer::clip::polygon::{Shapes, mismatch::{Mismatch, misfits}};
/// use durer::math::DVec2;
///
/// let ring = |points: &[(f64, f64)]| Shapes::from_rings([points.iter().map(|&p| p.into()).collect::<Vec<DVec2>>()]);
/// let left = ring(&[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]);
/// let right = ring(&[(2.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 2.0), (2.0, 1.0)]);
/// let found = misfits(&[left, right], None)?;
/// // The left one has no point where the right one has.
/// assert_eq!((found[0].mismatch, found[0].at), (Mismatch::Unmatched, DVec2::new(2.0, 1.0)));
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::NonFinite`] for a coordinate that is not finite, [`Error::Limit`] if it takes more than some thousand
/// comparisons per edge; with `gap_width` as [`overlay()`].
pub fn misfits(features: &[Shapes], gap_width: Option<f64>) -> Result<Vec<Misfit>> {
    let layer = Layer::new(features)?;
    let mut found = Found::default();
    layer.compare_edges(&mut found)?;
    layer.compare_directions(&mut found);
    layer.compare_corners(&mut found);
    layer.look_inside(&mut found);
    if let Some(width) = gap_width {
        layer.find_gaps(width, &mut found)?;
    }
    Ok(found.sorted())
}

/// All features in one.
struct Layer<'a> {
    features: &'a [Shapes],
    whole: Shapes,
    /// Each ring of the whole: its feature, and whether it runs against the direction required for outer rings and
    /// holes.
    rings: Vec<(usize, bool)>,
}

#[derive(Default)]
struct Found {
    misfits: Vec<Misfit>,
    /// Overlapping features, which need not be tested for one inside the other.
    overlapping: BTreeSet<[usize; 2]>,
}

impl Found {
    fn add(&mut self, mismatch: Mismatch, at: DVec2, features: [usize; 2]) {
        let features = sorted(features);
        if mismatch == Mismatch::Overlap {
            self.overlapping.insert(features);
        }
        self.misfits.push(Misfit { mismatch, at: at + 0.0, features });
    }

    fn sorted(mut self) -> Vec<Misfit> {
        let place = |p: DVec2, q: DVec2| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y));
        self.misfits.sort_by(|a, b| {
            let places = place(a.at, b.at);
            a.features.cmp(&b.features).then(places).then(a.mismatch.cmp(&b.mismatch))
        });
        self.misfits.dedup_by(|a, b| a == b);
        self.misfits
    }
}

fn sorted([i, j]: [usize; 2]) -> [usize; 2] {
    [i.min(j), i.max(j)]
}

/// Returns a point as a key; zeros of either sign are one.
fn key(p: DVec2) -> [u64; 2] {
    (p + 0.0).to_array().map(f64::to_bits)
}

impl<'a> Layer<'a> {
    fn new(features: &'a [Shapes]) -> Result<Self> {
        let (mut whole, mut rings) = (Shapes::new(), Vec::new());
        for (feature, shapes) in features.iter().enumerate() {
            if let Some(index) = shapes.points().iter().position(|p| !p.is_finite()) {
                return Err(Error::NonFinite { what: "point", index });
            }
            for polygon in shapes.polygons() {
                for (i, ring) in polygon.rings().enumerate() {
                    let mut points = ring.to_vec();
                    points.dedup();
                    while points.len() > 1 && points.first() == points.last() {
                        points.pop();
                    }
                    rings.push((feature, (signed_area(&points) < 0.0) == (i == 0)));
                    whole.push_ring(points);
                }
                whole.end_polygon();
            }
        }
        Ok(Self { features, whole, rings })
    }

    fn feature(&self, edge: &Edge) -> usize {
        self.rings[edge.ring].0
    }

    /// Finds edges of two features that cross, or have no counterpart.
    fn compare_edges(&self, found: &mut Found) -> Result<()> {
        let edges = edges_of(&self.whole);
        let pairs = edges.len().saturating_mul(PAIRS_PER_EDGE);
        let all = each_pair(&edges, pairs, |p, q| {
            let features = [self.feature(p), self.feature(q)];
            if features[0] != features[1] {
                match meeting(p, q) {
                    Meeting::Crossing => found.add(Mismatch::Overlap, crossing(p, q), features),
                    Meeting::Overlap(_) if has_same_ends(p, q) => {}
                    Meeting::Overlap(_) => {
                        let ends = [(p.a, q), (p.b, q), (q.a, p), (q.b, p)];
                        let free = ends.into_iter().filter(|(end, e)| is_within(*end, e));
                        free.for_each(|(at, _)| found.add(Mismatch::Unmatched, at, features));
                    }
                    Meeting::Touch(at)
                        if !([p.a, p.b].contains(&at) && [q.a, q.b].contains(&at)) =>
                    {
                        found.add(Mismatch::Unmatched, at, features);
                    }
                    Meeting::Touch(_) | Meeting::Apart => {}
                }
            }
            true
        });
        let (value, limit) = (edges.len() as u64, PAIRS_PER_EDGE as u64);
        let limit = Error::Limit { what: "number of comparisons of edges", value, limit };
        if all { Ok(()) } else { Err(limit) }
    }

    /// Finds edges that two features have in the same direction, so that both are on the same side of it.
    fn compare_directions(&self, found: &mut Found) {
        let mut owners: BTreeMap<[[u64; 2]; 2], Vec<(usize, bool)>> = BTreeMap::new();
        for edge in edges_of(&self.whole) {
            let (a, b) = (key(edge.a), key(edge.b));
            let (feature, turned) = self.rings[edge.ring];
            owners.entry([a.min(b), a.max(b)]).or_default().push((feature, (a < b) != turned));
        }
        for ([a, _], owners) in owners {
            for (i, &(feature, direction)) in owners.iter().enumerate() {
                for &(other, its) in owners[..i].iter().filter(|(other, _)| *other != feature) {
                    if its == direction {
                        let at = DVec2::from(a.map(f64::from_bits));
                        found.add(Mismatch::Overlap, at, [feature, other]);
                    }
                }
            }
        }
    }

    /// Finds vertices of two features at which an edge of one leads into the other.
    fn compare_corners(&self, found: &mut Found) {
        let of_ring = |ring: usize| {
            let (feature, turned) = self.rings[ring];
            let inside_left = move |[at, from, to]: Way| match turned {
                true => [at, to, from],
                false => [at, from, to],
            };
            ways(self.whole.ring(ring)).map(move |way| (feature, inside_left(way)))
        };
        let mut corners: Vec<(usize, Way)> = (0..self.rings.len()).flat_map(of_ring).collect();
        corners.sort_by_key(|(feature, [at, ..])| (key(*at), *feature));
        for there in corners.chunk_by(|(_, [p, ..]), (_, [q, ..])| p == q) {
            for &(feature, [at, from, to]) in there {
                for &(other, corner) in there.iter().filter(|(other, _)| *other != feature) {
                    if [from, to].into_iter().any(|end| leads_into(end, corner)) {
                        found.add(Mismatch::Overlap, at, [feature, other]);
                    }
                }
            }
        }
    }

    /// Finds features that have a polygon in another one. A polygon without an edge that crosses the other's or leads
    /// into it is wholly inside or outside.
    fn look_inside(&self, found: &mut Found) {
        let boxes: Vec<Option<Rect>> = self.features.iter().map(Shapes::bounds).collect();
        let mut order: Vec<(Rect, usize)> =
            boxes.into_iter().enumerate().filter_map(|(i, around)| Some((around?, i))).collect();
        order.sort_by(|(a, i), (b, j)| a.min().x.total_cmp(&b.min().x).then(i.cmp(j)));
        let mut prepared: BTreeMap<usize, Option<Prepared>> = BTreeMap::new();
        let mut active: Vec<(Rect, usize)> = Vec::new();
        for (around, next) in order {
            active.retain(|(other, _)| other.max().x >= around.min().x);
            for &(other, feature) in &active {
                let apart = other.max().y < around.min().y || other.min().y > around.max().y;
                if apart || found.overlapping.contains(&sorted([feature, next])) {
                    continue;
                }
                for (inner, outer) in [(next, feature), (feature, next)] {
                    let make = || Prepared::new(self.features[outer].clone()).ok();
                    let outer = prepared.entry(outer).or_insert_with(make);
                    let Some(outer) = outer else { continue };
                    if let Some(at) = first_within(&self.features[inner], outer) {
                        found.add(Mismatch::Overlap, at, [feature, next]);
                    }
                }
            }
            active.push((around, next));
        }
    }

    /// Finds the holes of the union that are narrow.
    fn find_gaps(&self, width: f64, found: &mut Found) -> Result<()> {
        let mut turned = self.whole.clone();
        for (ring, _) in self.rings.iter().enumerate().filter(|(_, (_, turned))| *turned) {
            let range = turned.ring_range(ring);
            turned.points_mut()[range].reverse();
        }
        let rule = OverlayOptions::with_rule(WindingRule::Positive);
        let union = overlay(&turned, &Shapes::new(), BooleanOp::Union, &rule, &mut NoTrace)?;
        let corners = self.whole.rings().zip(&self.rings);
        let owner: BTreeMap<[u64; 2], usize> = corners
            .flat_map(|(ring, (feature, _))| ring.iter().map(|p| (key(*p), *feature)))
            .collect();
        for hole in union.shapes.polygons().flat_map(|p| p.holes().collect::<Vec<_>>()) {
            let next = hole.iter().cycle().skip(1);
            let length: f64 = hole.iter().zip(next).map(|(a, b)| a.distance(*b)).sum();
            if -signed_area(hole) < width * length * 0.5 {
                let known = hole.iter().find_map(|p| Some((*p, *owner.get(&key(*p))?)));
                let (at, feature) = known.unwrap_or((hole[0], 0));
                found.misfits.push(Misfit { mismatch: Mismatch::Gap, at, features: [feature; 2] });
            }
        }
        Ok(())
    }
}

/// Returns whether an edge from a corner to `end` leads between its sides, to the left of the path through it, and not
/// along them.
fn leads_into(end: DVec2, [at, from, to]: Way) -> bool {
    let along = |side: DVec2| {
        orient2d(at, side, end) == Orientation::Collinear && (side - at).dot(end - at) > 0.0
    };
    !along(from) && !along(to) && in_sector(at, to, end, from)
}

fn has_same_ends(p: &Edge, q: &Edge) -> bool {
    (p.a == q.a && p.b == q.b) || (p.a == q.b && p.b == q.a)
}

/// Returns whether a point of an edge's line is between its ends.
fn is_within(p: DVec2, edge: &Edge) -> bool {
    let (low, high) = (edge.a.min(edge.b), edge.a.max(edge.b));
    p != edge.a && p != edge.b && p.cmpge(low).all() && p.cmple(high).all()
}

/// Returns a point of the first polygon that is inside `outer`. The first of its vertices that is not on the border of
/// `outer` decides, or else the first such middle of its edges; middles are rounded.
fn first_within(inner: &Shapes, outer: &Prepared) -> Option<DVec2> {
    let around = outer.bounds()?;
    inner.polygons().find_map(|polygon| {
        let ring = polygon.outer();
        let middles =
            ring.iter().zip(ring.iter().cycle().skip(1)).map(|(a, b)| *a * 0.5 + *b * 0.5);
        let free = ring.iter().copied().chain(middles).find(|&p| !is_on_border(outer, p))?;
        (around.contains(free) && outer.contains(free)).then_some(free)
    })
}

/// Returns whether a point is on a feature's border, up to the rounding of its coordinates.
fn is_on_border(of: &Prepared, p: DVec2) -> bool {
    let reach = 2.0 * reach(p);
    match Rect::new(p - reach, p + reach) {
        Ok(around) if of.has_edges_near(&around) => {
            let near = Near::around(of, &around);
            near.lines.iter().any(|&edge| is_on(p, edge, edge))
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn feature(rings: &[&[(f64, f64)]]) -> Shapes {
        let mut shapes = Shapes::new();
        rings.iter().for_each(|ring| shapes.push_ring(ring.iter().map(|&p| DVec2::from(p))));
        shapes.end_polygon();
        shapes
    }

    fn found(features: &[Shapes]) -> Vec<(Mismatch, (f64, f64), [usize; 2])> {
        let misfits = misfits(features, None).expect("misfits");
        misfits.into_iter().map(|m| (m.mismatch, m.at.into(), m.features)).collect()
    }

    const LEFT: &[(f64, f64)] = &[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];

    #[test]
    fn neighbours_with_the_same_border_are_a_coverage() {
        let right = feature(&[&[(4.0, 0.0), (4.0, 4.0), (9.0, 4.0)]]);
        assert_eq!(found(&[feature(&[LEFT]), right]), []);
        let corner = feature(&[&[(4.0, 4.0), (9.0, 4.0), (9.0, 9.0)]]);
        assert_eq!(found(&[feature(&[LEFT]), corner]), []);
        // Whatever the direction of the rings; and a feature that fills the hole of another.
        let hole: &[(f64, f64)] = &[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0)];
        let filled = feature(&[&[(2.0, 2.0), (2.0, 1.0), (1.0, 1.0)]]);
        assert_eq!(found(&[feature(&[LEFT, hole]), filled]), []);
        let island = feature(&[&[(1.3, 1.1), (1.9, 1.1), (1.9, 1.6)]]);
        assert_eq!(found(&[feature(&[LEFT, hole]), island]), []);
    }

    #[test]
    fn overlaps_are_found_by_crossings_directions_and_places() {
        let shifted = feature(&[&[(3.0, 1.0), (8.0, 1.0), (8.0, 2.0), (3.0, 2.0)]]);
        let crossings = [(4.0, 1.0), (4.0, 2.0)].map(|at| (Mismatch::Overlap, at, [0, 1]));
        assert_eq!(found(&[feature(&[LEFT]), shifted]), crossings);
        // At the lower end of each edge; two of them coincide.
        let doubled = found(&[feature(&[LEFT]), feature(&[LEFT])]);
        let ends = [(0.0, 0.0), (0.0, 4.0), (4.0, 0.0)].map(|at| (Mismatch::Overlap, at, [0, 1]));
        assert_eq!(doubled, ends);
        let inside = feature(&[&[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0)]]);
        let within = [(Mismatch::Overlap, (1.0, 1.0), [0, 1])];
        assert_eq!(found(&[feature(&[LEFT]), inside.clone()]), within);
        assert_eq!(found(&[inside, feature(&[LEFT])]), within);
    }

    /// Checks Lesotho and the hole of South Africa around it, in Natural Earth's map 1:110 million: the midpoints of
    /// their common edges are rounded to one side or the other.
    #[test]
    fn what_fills_a_hole_does_not_overlap_with_what_is_around() {
        let lesotho: &[(f64, f64)] = &[
            (28.978262566857243, -28.95559661226171),
            (29.32516645683259, -29.257386976846256),
            (29.018415154748027, -29.74376555757737),
            (28.84839969250774, -30.070050551068256),
            (28.29106937023991, -30.2262167294543),
            (28.107204624145425, -30.54573211031495),
            (27.749397006956485, -30.645105889612225),
            (26.999261915807637, -29.875953871379984),
            (27.532511020627478, -29.24271087007536),
            (28.074338413207784, -28.851468601193588),
            (28.541700066855498, -28.64750172293757),
        ];
        let around: &[(f64, f64)] = &[(16.0, -35.0), (33.0, -35.0), (33.0, -22.0), (16.0, -22.0)];
        let features = [feature(&[around, lesotho]), feature(&[lesotho])];
        assert_eq!(found(&features), []);
        // In the middle of the surrounding country it is different.
        let moved: Vec<(f64, f64)> = lesotho.iter().map(|(x, y)| (x - 5.0, *y)).collect();
        assert_eq!(found(&[features[0].clone(), feature(&[&moved])]).len(), 1);
    }

    #[test]
    fn overlaps_are_found_where_no_edges_cross() {
        // Through two corners of the square, and back around it.
        let through = [(4.0, 0.0), (9.0, 9.0), (0.0, 4.0)];
        let ends = [(0.0, 4.0), (4.0, 0.0)].map(|at| (Mismatch::Overlap, at, [0, 1]));
        assert_eq!(found(&[feature(&[LEFT]), feature(&[&through])]), ends);
        let back: Vec<(f64, f64)> = through.into_iter().rev().collect();
        assert_eq!(found(&[feature(&[&back]), feature(&[LEFT])]), ends);
        // A neighbour that shares an edge, and has a second polygon inside.
        let mut two = feature(&[&[(4.0, 0.0), (9.0, 2.0), (4.0, 4.0)]]);
        two.append(&feature(&[&[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0)]]));
        assert_eq!(found(&[feature(&[LEFT]), two]), [(Mismatch::Overlap, (1.0, 1.0), [0, 1])]);
        // Around a corner common to three, and with a corner in a corner: no mismatch.
        let rest = [
            feature(&[&[(4.0, 0.0), (8.0, 0.0), (8.0, 4.0), (4.0, 4.0)]]),
            feature(&[&[(0.0, 4.0), (4.0, 4.0), (8.0, 4.0), (8.0, 8.0), (0.0, 8.0)]]),
        ];
        assert_eq!(found(&[&[feature(&[LEFT])], &rest[..]].concat()), []);
    }

    #[test]
    fn points_that_one_of_two_has_are_unmatched() {
        let longer = feature(&[&[(4.0, -2.0), (9.0, 0.0), (4.0, 5.0)]]);
        let ends = [(4.0, 0.0), (4.0, 4.0)].map(|at| (Mismatch::Unmatched, at, [0, 1]));
        assert_eq!(found(&[feature(&[LEFT]), longer]), ends);
        let touching = feature(&[&[(4.0, 2.0), (9.0, 0.0), (9.0, 4.0)]]);
        assert_eq!(
            found(&[feature(&[LEFT]), touching]),
            [(Mismatch::Unmatched, (4.0, 2.0), [0, 1])]
        );
    }

    #[test]
    fn gaps_are_narrow_holes_of_the_union() {
        let around: &[(f64, f64)] = &[(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)];
        let hole: &[(f64, f64)] = &[(1.0, 1.0), (4.0, 1.0), (4.0, 4.0), (1.0, 4.0)];
        let filled = feature(&[&[(1.0, 1.0), (4.0, 1.0), (4.0, 4.0), (1.1, 3.9)]]);
        let features = [feature(&[around, hole]), filled];
        let gaps = |width| misfits(&features, width).expect("misfits");
        assert_eq!(gaps(None), []);
        assert_eq!(gaps(Some(0.01)), []);
        let found = gaps(Some(0.2));
        assert_eq!((found.len(), found[0].mismatch), (1, Mismatch::Gap));
        assert!(hole.contains(&found[0].at.into()), "{:?}", found[0].at);
    }
}
