//! Rings where they touch: whether they pass through each other, and whether they divide a polygon.

use super::edges::Edge;
use super::{Fault, Flaw};
use crate::clip::polygon::Shapes;
use crate::math::{DVec2, in_sector};
use std::collections::{BTreeMap, BTreeSet};

/// A ring at one of its vertices, or at a point of an edge: this point, the previous and the next one.
pub type Way = [DVec2; 3];

/// Returns the ways of a ring through its vertices.
pub fn ways(ring: &[DVec2]) -> impl Iterator<Item = Way> + '_ {
    let last = ring.len().saturating_sub(1);
    let before = move |i: usize| if i == 0 { last } else { i - 1 };
    let after = move |i: usize| if i == last { 0 } else { i + 1 };
    (0..ring.len()).map(move |i| [ring[i], ring[before(i)], ring[after(i)]])
}

/// Returns whether two ways through one point only touch there, and do not pass through each other.
pub fn ways_touch([at, from, to]: Way, [_, a, b]: Way) -> bool {
    let left = |x: DVec2| in_sector(at, to, x, from);
    left(a) == left(b)
}

/// A ring along an edge, or at a vertex, by the bits of the coordinates of a [`Way`].
type RingWay = (usize, [[u64; 2]; 3]);

/// Points at which different rings touch.
#[derive(Default)]
pub struct Touches {
    /// The ways through each place, by ring; places by the bits of their coordinates.
    places: BTreeMap<[u64; 2], BTreeSet<RingWay>>,
}

/// Returns the bits of a point; zeros of either sign are one place.
fn bits(p: DVec2) -> [u64; 2] {
    (p + 0.0).to_array().map(f64::to_bits)
}

fn of_bits(p: [u64; 2]) -> DVec2 {
    DVec2::from(p.map(f64::from_bits))
}

impl Touches {
    /// Adds two edges of different rings that have just a point in common.
    pub fn add(&mut self, p: &Edge, q: &Edge, at: DVec2) {
        let ways = self.places.entry(bits(at)).or_default();
        for edge in [p, q] {
            // At vertices, both adjacent edges are known from the shapes.
            let way = [at, edge.a, edge.b].map(bits);
            ways.insert((edge.ring, way));
        }
    }

    /// Returns the rings that pass through another one where they touch.
    pub fn passages(&self, shapes: &Shapes) -> Vec<Flaw> {
        let mut at_vertices: BTreeMap<[u64; 2], Vec<(usize, Way)>> = BTreeMap::new();
        for ring in 0..shapes.ring_count() {
            for way in
                ways(shapes.ring(ring)).filter(|[at, ..]| self.places.contains_key(&bits(*at)))
            {
                at_vertices.entry(bits(way[0])).or_default().push((ring, way));
            }
        }
        let mut flaws = Vec::new();
        for (place, edges) in &self.places {
            let at = of_bits(*place);
            let mut through = at_vertices.remove(place).unwrap_or_default();
            let along = edges.iter().map(|(ring, way)| (*ring, way.map(of_bits)));
            through.extend(along.filter(|(_, [at, a, b])| at != a && at != b));
            for (i, &(ring, way)) in through.iter().enumerate() {
                let others = through[..i].iter().filter(|(other, _)| *other != ring);
                flaws.extend(others.filter(|(_, w)| !ways_touch(way, *w)).map(|&(other, _)| {
                    let rings = [ring.min(other), ring.max(other)];
                    Flaw { fault: Fault::Crossing, at, rings }
                }));
            }
        }
        flaws
    }

    /// Returns the places where rings of one polygon close a chain of touching rings, which divides its
    /// inside.
    pub fn divisions(&self, shapes: &Shapes) -> Vec<Flaw> {
        let mut polygon_of = vec![0; shapes.ring_count()];
        for (polygon, rings) in shapes.polygons().enumerate() {
            rings.ring_indices().for_each(|ring| polygon_of[ring] = polygon);
        }
        let mut chains = Chains::new(shapes.ring_count());
        let mut flaws = Vec::new();
        for (place, edges) in &self.places {
            let rings: BTreeSet<usize> = edges.iter().map(|(ring, _)| *ring).collect();
            let mut first_of: BTreeMap<usize, usize> = BTreeMap::new();
            for ring in rings {
                let first = *first_of.entry(polygon_of[ring]).or_insert(ring);
                if first != ring && !chains.join(first, ring) {
                    let at = of_bits(*place);
                    flaws.push(Flaw { fault: Fault::Divided, at, rings: [first, ring] });
                }
            }
        }
        flaws
    }
}

/// Sets of rings that are connected by touching (disjoint sets).
struct Chains(Vec<usize>);

impl Chains {
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn root(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }

    /// Joins two sets; returns `false` if they were joined before.
    fn join(&mut self, i: usize, j: usize) -> bool {
        let (i, j) = (self.root(i), self.root(j));
        self.0[j] = i;
        i != j
    }
}
