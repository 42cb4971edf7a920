//! Whether polygons are valid, exactly; and if not, what is wrong and where.
//!
//! Valid is what the OGC's Simple Features (ISO 19125-1, 2004, 6.1.11) call so, whichever way rings run: rings that
//! neither cross nor touch themselves, that touch one another in single points only, holes within their outer ring and
//! not in one another, polygons outside one another, and the inside of each polygon in one piece. All
//! decisions are made by exact predicates.
//!
//! Edges are compared within horizontal slabs, in the order of their left ends. Cost: O(n √n) for n edges of usual data,
//! O(n²) where most of them overlap in both axes; that is cut off at some thousand comparisons per edge.

use super::Shapes;
use super::rectangle::Prepared;
use crate::info::{Class, Info};
use crate::math::{DVec2, Orientation, Rect, in_sector, orient2d};
use crate::{Error, Result};
use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};

/// The facts.
pub const INFO: Info = Info {
    name: "validity",
    title: "Validity of polygons by exact predicates",
    authors: "Open Geospatial Consortium",
    year: 2004,
    source: "ISO 19125-1, Simple feature access, 6.1.11",
    class: Class::ObjectSpace,
    cost: "O(n √n) for n edges of usual data",
    limits: "some thousand comparisons per edge",
};

/// So many pairs of edges are looked at per edge, at most.
pub(super) const PAIRS_PER_EDGE: usize = 4096;

/// What two edges may have in common, beside consecutive ones their common vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Touching {
    /// Nothing.
    No,
    /// A vertex of both.
    AtVertices,
    /// Where they are of different rings, a point that is a vertex of one of them: what the OGC allows.
    AtPoints,
}

/// What is wrong with polygons.
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
    /// Returns the words for it, as a message says them.
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
    /// What is wrong.
    pub fault: Fault,
    /// A point of it: of crossings the nearest to it, of rings a vertex.
    pub at: DVec2,
    /// The two rings, by their index over all polygons; twice the same where it is one.
    pub rings: [usize; 2],
}

/// Returns whether all rings are simple and, but for what is allowed, apart from one another, holes lie in
/// their outer rings and polygons outside one another. `false` too where that takes too many comparisons.
///
/// With [`Touching::AtPoints`], polygons whose inside is [divided](Fault::Divided) pass.
pub fn is_valid(shapes: &Shapes, touching: Touching) -> bool {
    edges_are_apart(shapes, touching) && nests(shapes)
}

/// Returns what is wrong with polygons, sorted by rings and places; empty where they are valid. Points that come
/// twice in a row are no fault.
///
/// Crossings and touches of one pair of rings come once per place. Where edges cross or overlap, it is not
/// looked at how rings lie in each other.
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
/// [`Error::NonFinite`] for a coordinate that is not finite, [`Error::Limit`] where it takes more than some thousand
/// comparisons per edge.
pub fn flaws(shapes: &Shapes) -> Result<Vec<Flaw>> {
    if let Some(index) = shapes.points().iter().position(|p| !p.is_finite()) {
        return Err(Error::NonFinite { what: "point", index });
    }
    let (shapes, mut found) = without_repeats(shapes);
    let edges = edges_of(&shapes);
    let pairs = edges.len().saturating_mul(PAIRS_PER_EDGE);
    let size = |ring: usize| shapes.ring_range(ring).len();
    let mut touches = Touches::default();
    let all = each_pair(&edges, pairs, |p, q| {
        match meeting(p, q) {
            Meeting::Apart => {}
            Meeting::Crossing => found.push(p.flaw(q, Fault::Crossing, crossing(p, q))),
            Meeting::Overlap(at) => found.push(p.flaw(q, Fault::Overlap, at)),
            Meeting::Touch(at) if p.ring != q.ring => touches.add(p, q, at),
            Meeting::Touch(_) if are_neighbours(p, q, size(p.ring)) => {}
            Meeting::Touch(at) => found.push(p.flaw(q, Fault::SelfTouch, at)),
        }
        true
    });
    if !all {
        let (value, limit) = (edges.len() as u64, PAIRS_PER_EDGE as u64);
        return Err(Error::Limit { what: "comparisons of edges", value, limit });
    }
    found.extend(touches.passages(&shapes));
    if found.iter().all(|f| f.fault == Fault::SelfTouch) {
        found.extend(touches.divisions(&shapes));
        each_misplaced(&shapes, |flaw| {
            found.push(flaw);
            true
        });
    }
    sort(&mut found);
    Ok(found)
}

/// Sorts flaws and leaves each place of each pair of rings once.
fn sort(flaws: &mut Vec<Flaw>) {
    let place = |p: DVec2, q: DVec2| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y));
    flaws.sort_by(|a, b| a.rings.cmp(&b.rings).then(place(a.at, b.at)).then(a.fault.cmp(&b.fault)));
    flaws.dedup_by(|a, b| a == b);
}

/// The shapes without points that come twice in a row, and the rings that are none then.
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

pub(super) struct Edge {
    pub a: DVec2,
    pub b: DVec2,
    pub ring: usize,
    /// Its place in the ring.
    index: usize,
    /// The indices of its ends among all points.
    ends: [usize; 2],
    low: f64,
    high: f64,
}

impl Edge {
    fn flaw(&self, other: &Self, fault: Fault, at: DVec2) -> Flaw {
        let rings = [self.ring.min(other.ring), self.ring.max(other.ring)];
        Flaw { fault, at: at + 0.0, rings }
    }
}

/// All edges, in the order of their left ends.
pub(super) fn edges_of(shapes: &Shapes) -> Vec<Edge> {
    let mut edges = Vec::with_capacity(shapes.points().len());
    for (ring, points) in shapes.rings().enumerate() {
        let start = shapes.ring_range(ring).start;
        for (index, &a) in points.iter().enumerate() {
            let next = (index + 1) % points.len();
            let (b, ends) = (points[next], [start + index, start + next]);
            let (low, high) = (a.x.min(b.x), a.x.max(b.x));
            edges.push(Edge { a, b, ring, index, ends, low, high });
        }
    }
    edges.sort_by(|p, q| p.low.total_cmp(&q.low));
    edges
}

/// Calls for each two edges whose boxes may meet, some of them twice, as long as the answer is yes and `budget` lasts; returns
/// whether that was to the end.
pub(super) fn each_pair(
    edges: &[Edge],
    mut budget: usize,
    mut f: impl FnMut(&Edge, &Edge) -> bool,
) -> bool {
    slabs(edges).iter().all(|slab| {
        let mut active: Vec<&Edge> = Vec::new();
        slab.iter().all(|edge| {
            active.retain(|other| other.high >= edge.low);
            let Some(left) = budget.checked_sub(active.len() + 1) else { return false };
            budget = left;
            let go_on = active.iter().all(|other| f(edge, other));
            active.push(edge);
            go_on
        })
    })
}

/// Returns whether no two edges cross, overlap or, but for what is allowed, touch. `false` too for rings of less than three
/// points, for points that come twice in a row, and where it takes too many comparisons.
pub fn edges_are_apart(shapes: &Shapes, touching: Touching) -> bool {
    each_fault(shapes, touching, |_| false)
}

/// Returns the points, by their indices, at the ends of edges that are not apart, each once; `None` where it
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

/// Calls with the points of each fault, with none where it takes too many comparisons, as long as
/// the answer is yes; returns whether that was to the end.
fn each_fault(shapes: &Shapes, touching: Touching, mut tell: impl FnMut(&[usize]) -> bool) -> bool {
    for ring in 0..shapes.ring_count() {
        let range = shapes.ring_range(ring);
        if range.len() < 3 && !tell(&[range.start]) {
            return false;
        }
    }
    let edges = edges_of(shapes);
    if !edges.iter().filter(|e| e.a == e.b).all(|e| tell(&e.ends)) {
        return false;
    }
    let size = |ring: usize| shapes.ring_range(ring).len();
    let most = edges.len().saturating_mul(PAIRS_PER_EDGE);
    let mut told = true;
    let all = each_pair(&edges, most, |p, q| {
        let apart = match meeting(p, q) {
            Meeting::Apart => true,
            Meeting::Crossing | Meeting::Overlap(_) => false,
            Meeting::Touch(at) => may_touch(p, q, at, size(p.ring), touching),
        };
        told = apart || tell(&[p.ends[0], p.ends[1], q.ends[0], q.ends[1]]);
        told
    });
    // Too many comparisons, unless the answer was no.
    let all = all || told && tell(&[]);
    all && (touching == Touching::No || each_passage(shapes, tell))
}

/// Whether two edges may touch in a point.
fn may_touch(p: &Edge, q: &Edge, at: DVec2, size: usize, touching: Touching) -> bool {
    match touching {
        Touching::No => are_neighbours(p, q, size),
        Touching::AtVertices => [p.a, p.b].contains(&at) && [q.a, q.b].contains(&at),
        Touching::AtPoints => p.ring != q.ring || are_neighbours(p, q, size),
    }
}

/// Whether one edge of a ring of `size` edges follows the other.
fn are_neighbours(p: &Edge, q: &Edge, size: usize) -> bool {
    p.ring == q.ring && ((p.index + 1) % size == q.index || (q.index + 1) % size == p.index)
}

/// A ring at one of its vertices, or at a point of an edge: where it is, comes from, and goes to.
type Way = [DVec2; 3];

/// The ways of a ring through its vertices.
fn ways(ring: &[DVec2]) -> impl Iterator<Item = Way> + '_ {
    let last = ring.len().saturating_sub(1);
    let before = move |i: usize| if i == 0 { last } else { i - 1 };
    let after = move |i: usize| if i == last { 0 } else { i + 1 };
    (0..ring.len()).map(move |i| [ring[i], ring[before(i)], ring[after(i)]])
}

/// Whether two ways through one point only touch there, and do not pass through each other.
fn ways_touch([at, from, to]: Way, [_, a, b]: Way) -> bool {
    let left = |x: DVec2| in_sector(at, to, x, from);
    left(a) == left(b)
}

/// Calls with the vertices in which rings do not only touch but pass through each other, as long as the
/// answer is yes; returns whether that was to the end.
fn each_passage(shapes: &Shapes, mut tell: impl FnMut(&[usize]) -> bool) -> bool {
    let of_ring = |ring| shapes.ring_range(ring).zip(ways(shapes.ring(ring)));
    let mut ways: Vec<(usize, Way)> = (0..shapes.ring_count()).flat_map(of_ring).collect();
    // Zeros of either sign are one place.
    let order = |p: &DVec2, q: &DVec2| {
        (p.x + 0.0).total_cmp(&(q.x + 0.0)).then((p.y + 0.0).total_cmp(&(q.y + 0.0)))
    };
    ways.sort_by(|(_, [p, ..]), (_, [q, ..])| order(p, q));
    ways.chunk_by(|(_, [p, ..]), (_, [q, ..])| p == q).all(|through| {
        through.iter().enumerate().all(|(i, &(index, way))| {
            through[..i].iter().all(|&(other, w)| ways_touch(way, w) || tell(&[index, other]))
        })
    })
}

/// A ring along an edge, or at a vertex, by the bits of the coordinates of a [`Way`].
type RingWay = (usize, [[u64; 2]; 3]);

/// Where different rings touch.
#[derive(Default)]
struct Touches {
    /// For each place, by the bits of its coordinates, the ways through it, by ring.
    places: BTreeMap<[u64; 2], BTreeSet<RingWay>>,
}

/// The bits of a point; zeros of either sign are one place.
fn bits(p: DVec2) -> [u64; 2] {
    (p + 0.0).to_array().map(f64::to_bits)
}

fn of_bits(p: [u64; 2]) -> DVec2 {
    DVec2::from(p.map(f64::from_bits))
}

impl Touches {
    /// Adds two edges of different rings that have just a point in common.
    fn add(&mut self, p: &Edge, q: &Edge, at: DVec2) {
        let ways = self.places.entry(bits(at)).or_default();
        for edge in [p, q] {
            // At vertices the whole way is known by the shapes.
            let way = [at, edge.a, edge.b].map(bits);
            ways.insert((edge.ring, way));
        }
    }

    /// The rings that pass through another one where they touch.
    fn passages(&self, shapes: &Shapes) -> Vec<Flaw> {
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

    /// The places where rings of one polygon close a chain of touching rings, which divides its inside.
    fn divisions(&self, shapes: &Shapes) -> Vec<Flaw> {
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

/// Which rings hang together (disjoint sets).
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

    /// Joins two; `false` where they hung together before.
    fn join(&mut self, i: usize, j: usize) -> bool {
        let (i, j) = (self.root(i), self.root(j));
        self.0[j] = i;
        i != j
    }
}

/// The edges in horizontal slabs of equal height, each edge in all that it touches, in their order.
fn slabs(edges: &[Edge]) -> Vec<Vec<&Edge>> {
    let low = edges.iter().fold(f64::INFINITY, |y, e| y.min(e.a.y));
    let high = edges.iter().fold(f64::NEG_INFINITY, |y, e| y.max(e.a.y));
    let count = libm::sqrt(edges.len() as f64) as usize + 1;
    // Halves, because the height of the whole may overflow; what is not finite goes to slab 0.
    let slab = |y: f64| {
        let part = (y * 0.5 - low * 0.5) / (high * 0.5 - low * 0.5) * count as f64;
        (part.max(0.0) as usize).min(count - 1)
    };
    let mut slabs = vec![Vec::new(); count];
    for edge in edges {
        let (from, to) = (slab(edge.a.y.min(edge.b.y)), slab(edge.a.y.max(edge.b.y)));
        slabs[from..=to].iter_mut().for_each(|slab| slab.push(edge));
    }
    slabs
}

/// What two edges have in common.
pub(super) enum Meeting {
    Apart,
    /// One point within both.
    Crossing,
    /// More than a point; one of them.
    Overlap(DVec2),
    /// One point, which is an end of one or both.
    Touch(DVec2),
}

pub(super) fn meeting(p: &Edge, q: &Edge) -> Meeting {
    let (below, above) = (p.a.y.max(p.b.y) < q.a.y.min(q.b.y), p.a.y.min(p.b.y) > q.a.y.max(q.b.y));
    if below || above || p.high < q.low || q.high < p.low {
        return Meeting::Apart;
    }
    let side = |a, b, c| match orient2d(a, b, c) {
        Orientation::CounterClockwise => 1,
        Orientation::Clockwise => -1,
        Orientation::Collinear => 0,
    };
    let (qa, qb) = (side(p.a, p.b, q.a), side(p.a, p.b, q.b));
    let (pa, pb) = (side(q.a, q.b, p.a), side(q.a, q.b, p.b));
    if qa * qb > 0 || pa * pb > 0 {
        return Meeting::Apart;
    }
    if qa == 0 && qb == 0 {
        return on_one_line(p, q);
    }
    // The signs say that they cross, or that an end of one lies on the other.
    let ends = [(qa, q.a), (qb, q.b), (pa, p.a), (pb, p.b)];
    match ends.into_iter().find(|(side, _)| *side == 0) {
        None => Meeting::Crossing,
        Some((_, at)) => Meeting::Touch(at),
    }
}

/// What edges on one line have in common: nothing, an end, or more.
fn on_one_line(p: &Edge, q: &Edge) -> Meeting {
    let axis = usize::from((p.b.y - p.a.y).abs() > (p.b.x - p.a.x).abs());
    let sorted = |e: &Edge| if e.a[axis] <= e.b[axis] { (e.a, e.b) } else { (e.b, e.a) };
    let ((low, high), (from, to)) = (sorted(p), sorted(q));
    if to[axis] < low[axis] || from[axis] > high[axis] {
        Meeting::Apart
    } else if to[axis] == low[axis] {
        Meeting::Touch(low)
    } else if from[axis] == high[axis] {
        Meeting::Touch(high)
    } else {
        Meeting::Overlap(if from[axis] > low[axis] { from } else { low })
    }
}

/// The point nearest to where two edges cross, as far as f64 goes.
pub(super) fn crossing(p: &Edge, q: &Edge) -> DVec2 {
    let (along, other) = (p.b * 0.5 - p.a * 0.5, q.b * 0.5 - q.a * 0.5);
    let t = (q.a * 0.5 - p.a * 0.5).perp_dot(other) / along.perp_dot(other);
    let t = if t.is_nan() { 0.5 } else { t.clamp(0.0, 1.0) };
    p.a * (1.0 - t) + p.b * t
}

/// Whether holes lie in their outer rings, not in one another, and polygons not in one another;
/// the edges are apart.
fn nests(shapes: &Shapes) -> bool {
    let mut nests = true;
    each_misplaced(shapes, |_| {
        nests = false;
        false
    });
    nests
}

/// Calls for each ring that lies where it must not, as long as the answer is yes; the edges are apart.
fn each_misplaced(shapes: &Shapes, mut tell: impl FnMut(Flaw) -> bool) {
    let numbers = shapes.polygons().map(|polygon| polygon.ring_indices()).enumerate();
    let rings: Vec<Ring<'_>> = numbers
        .flat_map(|(polygon, all)| all.clone().map(move |ring| (polygon, all.start, ring)))
        .filter_map(|(polygon, outer, index)| {
            let points = shapes.ring(index);
            let around = Rect::around(points.iter().copied())?;
            let prepared = OnceCell::new();
            Some(Ring { points, around, polygon, outer, index, prepared })
        })
        .collect();
    let mut at_home = vec![false; rings.len()];
    let mut within = Vec::new();
    let mut go_on = true;
    each_within(&rings, |inner, outer| {
        let (a, b) = (&rings[inner], &rings[outer]);
        match (a.polygon == b.polygon, (a.is_hole(), b.is_hole())) {
            (true, (true, false)) => at_home[inner] = a.lies_in(b),
            (true, (true, true)) if a.lies_in(b) => {
                go_on = tell(a.flaw(Fault::HoleInHole, b.index))
            }
            (false, (false, _)) if a.lies_in(b) => within.push((inner, b.polygon)),
            _ => {}
        }
        go_on
    });
    // In another polygon's ring and hole: in its hole.
    within.sort_unstable();
    let inside = within.chunk_by(|a, b| a == b).filter(|rings| rings.len() % 2 == 1);
    let inside = inside.filter_map(|rings_of| rings_of.first()).map(|&(inner, polygon)| {
        let around = rings.iter().find(|r| r.polygon == polygon).map_or(0, |r| r.outer);
        rings[inner].flaw(Fault::PolygonInPolygon, around)
    });
    let homeless = rings.iter().zip(at_home).filter(|(ring, home)| ring.is_hole() && !home);
    let homeless = homeless.map(|(ring, _)| ring.flaw(Fault::HoleOutside, ring.outer));
    for flaw in inside.chain(homeless) {
        go_on = go_on && tell(flaw);
    }
}

struct Ring<'a> {
    points: &'a [DVec2],
    around: Rect,
    polygon: usize,
    /// The outer ring of its polygon.
    outer: usize,
    index: usize,
    prepared: OnceCell<Option<Prepared>>,
}

impl Ring<'_> {
    fn is_hole(&self) -> bool {
        self.index != self.outer
    }

    fn flaw(&self, fault: Fault, other: usize) -> Flaw {
        let at = self.points.first().copied().unwrap_or_default();
        Flaw { fault, at, rings: [self.index.min(other), self.index.max(other)] }
    }

    /// Whether it lies in another, which it may touch: told by a vertex, or else the middle of an edge,
    /// that is not on its border.
    fn lies_in(&self, outer: &Self) -> bool {
        let prepare = || Prepared::new(Shapes::from_rings([outer.points])).ok();
        let Some(outer) = outer.prepared.get_or_init(prepare) else { return false };
        let inner = self.points;
        let ends = inner.iter().zip(inner.iter().cycle().skip(1));
        let middles = ends.map(|(&a, &b)| a * 0.5 + b * 0.5);
        let free = inner.iter().copied().chain(middles).find(|&p| !outer.has_on_border(p));
        free.is_some_and(|p| outer.contains(p))
    }
}

/// Calls for each ring and each other one whose box holds its box, as long as the answer is yes: in the
/// order of their left ends, each with those that it may lie in or around.
fn each_within(rings: &[Ring<'_>], mut f: impl FnMut(usize, usize) -> bool) {
    let mut order: Vec<usize> = (0..rings.len()).collect();
    order.sort_by(|&i, &j| rings[i].around.min().x.total_cmp(&rings[j].around.min().x));
    let holds = |i: usize, j: usize| {
        let (outer, inner) = (&rings[i].around, &rings[j].around);
        outer.contains(inner.min()) && outer.contains(inner.max())
    };
    let mut active: Vec<usize> = Vec::new();
    for next in order {
        active.retain(|&i| rings[i].around.max().x >= rings[next].around.min().x);
        for &other in &active {
            let go_on =
                (!holds(other, next) || f(next, other)) && (!holds(next, other) || f(other, next));
            if !go_on {
                return;
            }
        }
        active.push(next);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shapes(polygons: &[&[&[(f64, f64)]]]) -> Shapes {
        let mut shapes = Shapes::new();
        for polygon in polygons {
            for ring in *polygon {
                shapes.push_ring(ring.iter().map(|&p| DVec2::from(p)));
            }
            shapes.end_polygon();
        }
        shapes
    }

    const SQUARE: &[(f64, f64)] = &[(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)];
    const SMALL: &[(f64, f64)] = &[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0)];
    const FAR: &[(f64, f64)] = &[(21.0, 1.0), (22.0, 1.0), (22.0, 2.0)];

    #[test]
    fn validity_is_decided_by_edges_and_nesting() {
        let bowtie: &[(f64, f64)] = &[(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)];
        let spike: &[(f64, f64)] = &[(0.0, 0.0), (2.0, 0.0), (2.0, 5.0), (2.0, 2.0), (0.0, 2.0)];
        let touching: &[(f64, f64)] = &[(0.0, 5.0), (2.0, 4.0), (2.0, 6.0)];
        for (polygons, valid) in [
            (&[&[SQUARE, SMALL][..]][..], true),
            (&[&[SQUARE], &[FAR]], true),
            (&[&[SQUARE], &[SMALL]], false),
            (&[&[SQUARE, FAR]], false),
            (&[&[SQUARE, SMALL], &[SMALL]], false),
            (&[&[bowtie]], false),
            (&[&[spike]], false),
            (&[&[SQUARE, touching]], false),
        ] {
            assert_eq!(is_valid(&shapes(polygons), Touching::No), valid, "{polygons:?}");
        }
    }

    fn faults(polygons: &[&[&[(f64, f64)]]]) -> Vec<(Fault, (f64, f64))> {
        let flaws = flaws(&shapes(polygons)).expect("flaws");
        flaws.into_iter().map(|f| (f.fault, f.at.into())).collect()
    }

    #[test]
    fn flaws_have_a_reason_and_a_place() {
        let bowtie: &[(f64, f64)] = &[(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)];
        assert_eq!(faults(&[&[bowtie]]), [(Fault::Crossing, (2.0, 2.0))]);
        let spike: &[(f64, f64)] = &[(0.0, 0.0), (2.0, 0.0), (2.0, 5.0), (2.0, 2.0), (0.0, 2.0)];
        // The way back along itself, and then away from it.
        let both = [Fault::Overlap, Fault::SelfTouch].map(|fault| (fault, (2.0, 2.0)));
        assert_eq!(faults(&[&[spike]]), both);
        let flat: &[(f64, f64)] = &[(1.0, 1.0), (2.0, 2.0), (1.0, 1.0), (1.0, 1.0)];
        assert_eq!(faults(&[&[flat]]), [(Fault::FewPoints, (1.0, 1.0))]);
        let pinched: &[(f64, f64)] =
            &[(0.0, 0.0), (4.0, 0.0), (2.0, 2.0), (4.0, 4.0), (0.0, 4.0), (2.0, 2.0)];
        assert_eq!(faults(&[&[pinched]]), [(Fault::SelfTouch, (2.0, 2.0))]);
        assert_eq!(faults(&[&[SQUARE, FAR]]), [(Fault::HoleOutside, (21.0, 1.0))]);
        assert_eq!(faults(&[&[SQUARE], &[SMALL]]), [(Fault::PolygonInPolygon, (1.0, 1.0))]);
        let inner: &[(f64, f64)] = &[(1.2, 1.2), (1.8, 1.2), (1.8, 1.8)];
        assert_eq!(faults(&[&[SQUARE, SMALL, inner]]), [(Fault::HoleInHole, (1.2, 1.2))]);
        assert_eq!(faults(&[&[SQUARE, SMALL], &[inner]]), []);
        // Points that come twice in a row, and a ring that is closed twice, are no fault.
        let twice: &[(f64, f64)] = &[(0.0, 0.0), (9.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 0.0)];
        assert_eq!(faults(&[&[twice]]), []);
        assert!(flaws(&shapes(&[&[&[(f64::NAN, 0.0), (1.0, 0.0), (1.0, 1.0)]]])).is_err());
    }

    #[test]
    fn rings_touch_but_do_not_pass_or_divide() {
        // With a vertex on an edge: from inside; and through to the outside, at two such places.
        let leaning: &[(f64, f64)] = &[(9.0, 4.0), (7.0, 5.0), (7.0, 3.0)];
        assert_eq!(faults(&[&[SQUARE, leaning]]), []);
        let through: &[(f64, f64)] = &[(7.0, 3.0), (9.0, 4.0), (12.0, 5.0), (9.0, 6.0), (7.0, 7.0)];
        let places = [(Fault::Crossing, (9.0, 4.0)), (Fault::Crossing, (9.0, 6.0))];
        assert_eq!(faults(&[&[SQUARE, through]]), places);
        // A hole across the whole, touching in two points: the inside is in two parts.
        let across: &[(f64, f64)] = &[(0.0, 4.0), (4.0, 3.0), (9.0, 4.0), (4.0, 5.0)];
        assert_eq!(faults(&[&[SQUARE, across]]), [(Fault::Divided, (9.0, 4.0))]);
        // A chain of three, each touching the next, from side to side.
        let left: &[(f64, f64)] = &[(0.0, 4.0), (3.0, 3.0), (3.0, 5.0)];
        let right: &[(f64, f64)] = &[(9.0, 4.0), (3.0, 5.0), (6.0, 6.0)];
        assert_eq!(faults(&[&[SQUARE, left, right]]), [(Fault::Divided, (9.0, 4.0))]);
        // Polygons that share a side overlap along it; corners may meet.
        let next: &[(f64, f64)] = &[(9.0, 0.0), (12.0, 0.0), (12.0, 9.0), (9.0, 9.0)];
        assert_eq!(faults(&[&[SQUARE], &[next]]), [(Fault::Overlap, (9.0, 0.0))]);
        let corner: &[(f64, f64)] = &[(9.0, 9.0), (12.0, 9.0), (12.0, 12.0)];
        assert_eq!(faults(&[&[SQUARE], &[corner]]), []);
    }

    #[test]
    fn rings_may_touch_in_a_vertex_but_not_pass_through_it() {
        let square = |x: f64| [(x, x), (x + 4.0, x), (x + 4.0, x + 4.0), (x, x + 4.0)];
        let corners = shapes(&[&[&square(0.0)], &[&square(4.0)]]);
        assert!(edges_are_apart(&corners, Touching::AtVertices));
        // They cross in the two vertices that they share.
        let left = [(0.0, 0.0), (2.0, 1.0), (4.0, 0.0), (4.0, 4.0), (2.0, 3.0), (0.0, 4.0)];
        let right = [(1.0, 2.0), (2.0, 1.0), (1.5, -3.0), (9.0, 2.0), (1.5, 7.0), (2.0, 3.0)];
        assert!(!edges_are_apart(&shapes(&[&[&left], &[&right]]), Touching::AtVertices));
    }

    #[test]
    fn squares_nest_as_their_sides_say() {
        let mut state = 5_u64;
        let mut random = |range: u64| {
            let step = (6_364_136_223_846_793_005, 1_442_695_040_888_963_407);
            state = state.wrapping_mul(step.0).wrapping_add(step.1);
            (state >> 33) % range
        };
        let mut seen = [0; 2];
        for _ in 0..20_000 {
            let mut shapes = Shapes::new();
            let mut squares: Vec<(usize, [u64; 3])> = Vec::new();
            for polygon in 0..2 + random(2) as usize {
                for _ in 0..1 + random(3) {
                    let [x, y, side] = [random(12), random(12), 1 + 2 * random(6)];
                    squares.push((polygon, [x, y, side]));
                    let corners = [(0, 0), (side, 0), (side, side), (0, side)];
                    shapes.push_ring(
                        corners.map(|(u, v)| DVec2::new((x + u) as f64, (y + v) as f64)),
                    );
                }
                shapes.end_polygon();
            }
            if !edges_are_apart(&shapes, Touching::No) {
                continue;
            }
            let within = |[x, y, s]: [u64; 3], [u, v, t]: [u64; 3]| {
                x > u && y > v && x + s < u + t && y + s < v + t
            };
            let first = |i: usize| i == 0 || squares[i - 1].0 != squares[i].0;
            let expected = (0..squares.len()).all(|i| {
                let (own, square) = squares[i];
                let others = (0..squares.len()).filter(|&j| j != i && within(square, squares[j].1));
                let (mut home, mut nested, mut depths) = (first(i), false, [0; 4]);
                for j in others {
                    home |= squares[j].0 == own && first(j);
                    nested |= squares[j].0 == own && !first(j) && !first(i);
                    depths[squares[j].0] += usize::from(squares[j].0 != own && first(i));
                }
                home && !nested && depths.iter().all(|depth| depth % 2 == 0)
            });
            assert_eq!(is_valid(&shapes, Touching::No), expected, "{squares:?}");
            seen[usize::from(expected)] += 1;
        }
        assert!(seen.iter().all(|&count| count > 100), "{seen:?}");
    }

    #[test]
    fn touching_at_a_vertex_can_be_allowed() {
        let pair = shapes(&[&[SQUARE], &[&[(9.0, 9.0), (12.0, 9.0), (12.0, 12.0)]]]);
        assert!(!edges_are_apart(&pair, Touching::No));
        assert!(edges_are_apart(&pair, Touching::AtVertices));
        // The hole begins on its outer ring: at a vertex, or on an edge.
        let pointed = &[(0.0, 0.0), (3.0, 1.0), (1.0, 3.0)];
        let leaning = &[(9.0, 4.0), (7.0, 5.0), (7.0, 3.0)];
        for (hole, at_vertices) in [(pointed, true), (leaning, false)] {
            let touching = shapes(&[&[SQUARE, hole]]);
            assert!(!is_valid(&touching, Touching::No));
            assert_eq!(is_valid(&touching, Touching::AtVertices), at_vertices);
            assert!(is_valid(&touching, Touching::AtPoints));
            let outside = shapes(&[&[SQUARE], &[hole]]);
            assert!(!is_valid(&outside, Touching::AtPoints));
        }
        let pinched: &[(f64, f64)] =
            &[(0.0, 0.0), (4.0, 0.0), (2.0, 2.0), (4.0, 4.0), (0.0, 4.0), (2.0, 2.0)];
        assert!(!is_valid(&shapes(&[&[pinched]]), Touching::AtPoints));
        let across = shapes(&[&[SQUARE, &[(8.0, 4.0), (10.0, 4.0), (8.0, 5.0)]]]);
        assert!(!is_valid(&across, Touching::AtPoints));
    }
}
