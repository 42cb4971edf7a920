//! Rings on a grid that neither cross nor touch: these are valid polygons already, and the check costs a fraction of an
//! overlay.
//!
//! Edges are compared within horizontal slabs, in the order of their left ends. The nesting of rings is found by the
//! edges on the left of its leftmost point. Object space, exact; O(n √n) for n edges of usual data, slower cases are
//! left to the overlay.

use crate::clip::polygon::{Shapes, Vertex, WindingRule};
use crate::math::{I64Vec2, IVec2, Orientation};
use crate::sorting::CompactSort;

/// Coordinates have this many bits at most, so that products of their differences fit 64.
const BITS: u32 = 29;

/// Limit on the ratio of entries in slabs to edges.
const ENTRIES_PER_EDGE: usize = 4;

/// Limit on the pairs of edges compared per edge; more of them take longer than the overlay.
const PAIRS_PER_EDGE: usize = 64;

/// An edge, from its left end to its right one.
#[derive(Debug, Clone, Copy)]
struct Edge {
    left: IVec2,
    right: IVec2,
    /// The numbers of its ends among all points, in the direction of the ring.
    ends: [u32; 2],
    ring: u32,
}

/// Returns the points of a ring without repeated points, points on straight lines, and tips of spikes, none of which
/// changes the enclosed region. Empty if nothing is left.
pub fn cleaned(points: impl IntoIterator<Item = I64Vec2>) -> Vec<I64Vec2> {
    let mut ring: Vec<I64Vec2> = Vec::new();
    for p in points {
        while let [.., a, b] = ring[..]
            && is_idle(a, b, p)
        {
            ring.pop();
        }
        if ring.last() != Some(&p) {
            ring.push(p);
        }
    }
    // Around the end.
    let mut start = 0;
    while let [first, second, ..] = ring[start..]
        && let [.., before, last] = ring[start..]
        && ring.len() - start > 2
    {
        if is_idle(before, last, first) {
            ring.pop();
        } else if is_idle(last, first, second) {
            start += 1;
        } else {
            ring.drain(..start);
            return ring;
        }
    }
    Vec::new()
}

/// Returns whether a ring encloses the same without the middle of three points.
fn is_idle(a: I64Vec2, b: I64Vec2, c: I64Vec2) -> bool {
    a == b || b == c || Vertex::turn(a, b, c) == Orientation::Collinear
}

/// Returns the polygons that rings enclose by a rule, if no two of their edges have more in common than the vertex
/// between them; `None` if some have, or it takes long to see. Outer rings have positive areas, holes negative ones.
///
/// The rings are [`cleaned`].
pub fn polygons(rings: &Shapes<I64Vec2>, fill: WindingRule) -> Option<Shapes<I64Vec2>> {
    if rings.is_empty() {
        return Some(Shapes::new());
    }
    let points = in_few_bits(rings.points())?;
    let slabs = Slabs::new(edges(rings, &points))?;
    if !slabs.are_apart() {
        return None;
    }
    let mut nest = Nest::new(rings, &points);
    if rings.ring_count() > 1 {
        nest.find_parents(&slabs);
    }
    Some(nest.polygons(rings, fill))
}

/// Returns the points relative to the corner of the box around them.
fn in_few_bits(points: &[I64Vec2]) -> Option<Vec<IVec2>> {
    let first = *points.first()?;
    let (low, high) = points.iter().fold((first, first), |(l, h), p| (l.min(*p), h.max(*p)));
    let small = |low: i64, high: i64| high.checked_sub(low).is_some_and(|side| side < 1 << BITS);
    let fit = small(low.x, high.x) && small(low.y, high.y) && u32::try_from(points.len()).is_ok();
    fit.then(|| points.iter().map(|p| (*p - low).as_ivec2()).collect())
}

fn edges(rings: &Shapes<I64Vec2>, points: &[IVec2]) -> Vec<Edge> {
    let mut edges = Vec::with_capacity(points.len());
    for ring in 0..rings.ring_count() {
        let range = rings.ring_range(ring);
        for i in range.clone() {
            let next = if i + 1 < range.end { i + 1 } else { range.start };
            let (a, b) = (points[i], points[next]);
            let (left, right) = if a.x <= b.x { (a, b) } else { (b, a) };
            edges.push(Edge { left, right, ends: [i as u32, next as u32], ring: ring as u32 });
        }
    }
    edges
}

impl Edge {
    fn low(&self) -> i32 {
        self.left.y.min(self.right.y)
    }

    fn high(&self) -> i32 {
        self.left.y.max(self.right.y)
    }

    /// Returns the side of a point: positive on the left of the edge from its left end to its right one, 0 on its
    /// line.
    fn side(&self, p: IVec2) -> i64 {
        let (along, to) = ((self.right - self.left).as_i64vec2(), (p - self.left).as_i64vec2());
        (along.x * to.y - along.y * to.x).signum()
    }

    /// Returns whether it has nothing in common with another one whose range of x meets its own, beside the vertex
    /// between them.
    fn is_apart(&self, other: &Self) -> bool {
        if self.high() < other.low() || other.high() < self.low() {
            return true;
        }
        let follows = self.ends[1] == other.ends[0] || other.ends[1] == self.ends[0];
        follows
            || self.side(other.left) * self.side(other.right) > 0
            || other.side(self.left) * other.side(self.right) > 0
    }

    /// Returns whether it crosses the horizontal line through a point on the left of that.
    fn is_left_of(&self, p: IVec2) -> bool {
        if self.low() > p.y || self.high() <= p.y || self.left.x > p.x {
            return false;
        }
        // East of a rising edge is below it, east of a falling one above it.
        let side = self.side(p);
        if self.left.y < self.right.y { side < 0 } else { side > 0 }
    }
}

/// Edges by heights: each is in all slabs that it touches, in the order of their left ends.
struct Slabs {
    edges: Vec<Edge>,
    /// End of each slab among the edges.
    ends: Vec<usize>,
    /// The height of a slab.
    height: i32,
}

impl Slabs {
    /// Creates the slabs; `None` if the edges are too high and too many.
    fn new(edges: Vec<Edge>) -> Option<Self> {
        let top = edges.iter().map(Edge::high).max()?;
        let mut count = (edges.len() / 16).isqrt() as i32 + 1;
        // The sum of the heights is the number of entries.
        let sum: i64 = edges.iter().map(|edge| i64::from(edge.high() - edge.low())).sum();
        let room = (edges.len() * (ENTRIES_PER_EDGE - 1)) as i64;
        let most = (i64::from(top) + 1) * room / sum.max(1);
        count = count.min(i32::try_from(most.max(1)).unwrap_or(count));
        if count == 1 {
            let mut slabs = Self { ends: vec![edges.len()], edges, height: i32::MAX };
            slabs.sort();
            return Some(slabs);
        }
        let height = top / count + 1;
        let slabs = |edge: &Edge| (edge.low() / height) as usize..=(edge.high() / height) as usize;
        let mut ends = vec![0; count as usize];
        edges.iter().flat_map(slabs).for_each(|slab| ends[slab] += 1);
        let mut sum = 0;
        for end in &mut ends {
            sum += std::mem::replace(end, sum);
        }
        // The starts advance to the ends as entries are filled in.
        let mut entries = vec![*edges.first()?; sum];
        for edge in &edges {
            for slab in slabs(edge) {
                entries[ends[slab]] = *edge;
                ends[slab] += 1;
            }
        }
        let mut slabs = Self { edges: entries, ends, height };
        slabs.sort();
        Some(slabs)
    }

    fn sort(&mut self) {
        let mut start = 0;
        for &end in &self.ends {
            self.edges[start..end].sort_unstable_by_key(|edge| (edge.left.x, edge.ends[0]));
            start = end;
        }
    }

    fn slab(&self, number: usize) -> &[Edge] {
        let start = number.checked_sub(1).and_then(|before| self.ends.get(before)).copied();
        let end = self.ends.get(number).copied().unwrap_or(0);
        self.edges.get(start.unwrap_or(0)..end).unwrap_or_default()
    }

    /// Returns whether no two edges have more in common than the vertex between them.
    fn are_apart(&self) -> bool {
        let mut budget = self.edges.len() * PAIRS_PER_EDGE;
        (0..self.ends.len()).all(|number| {
            let slab = self.slab(number);
            slab.iter().enumerate().all(|(i, edge)| {
                let reach = edge.right.x;
                let others = slab[i + 1..].iter().take_while(|other| other.left.x <= reach);
                others.into_iter().all(|other| {
                    budget = budget.saturating_sub(1);
                    budget > 0 && edge.is_apart(other)
                })
            })
        })
    }

    /// Returns the rings of the edges that cross the horizontal line through a point on its left,
    /// sorted.
    fn on_the_left(&self, p: IVec2) -> Vec<u32> {
        let slab = self.slab((p.y / self.height) as usize);
        let before = slab.partition_point(|edge| edge.left.x <= p.x);
        let crossing = slab[..before].iter().filter(|edge| edge.is_left_of(p));
        let mut rings: Vec<u32> = crossing.map(|edge| edge.ring).collect();
        rings.sort_unstable();
        rings
    }
}

/// Nesting of rings.
struct Nest {
    /// The leftmost point of each ring.
    first: Vec<IVec2>,
    /// 1 where a ring has a positive area, −1 if it has a negative one.
    turns: Vec<i32>,
    /// The rings around each, the innermost one last.
    around: Vec<Vec<u32>>,
}

impl Nest {
    fn new(rings: &Shapes<I64Vec2>, points: &[IVec2]) -> Self {
        let count = rings.ring_count();
        let mut nest =
            Self { first: Vec::new(), turns: Vec::new(), around: vec![Vec::new(); count] };
        for ring in 0..count {
            let points = &points[rings.ring_range(ring)];
            let first = (0..points.len()).min_by_key(|&i| (points[i].x, points[i].y)).unwrap_or(0);
            let [a, b, c] =
                [points.len() - 1, 0, 1].map(|step| points[(first + step) % points.len()]);
            let turn = Vertex::turn(a.as_i64vec2(), b.as_i64vec2(), c.as_i64vec2());
            nest.first.push(b);
            nest.turns.push(if turn == Orientation::CounterClockwise { 1 } else { -1 });
        }
        nest
    }

    fn find_parents(&mut self, slabs: &Slabs) {
        for (ring, &p) in self.first.iter().enumerate() {
            let rings = slabs.on_the_left(p);
            let odd = rings.chunk_by(|a, b| a == b).filter(|edges| edges.len() % 2 == 1);
            // Its own edges are not among them: they begin at its leftmost point or further right.
            let odd = odd.filter_map(|edges| edges.first().copied());
            self.around[ring].extend(odd.filter(|&other| other as usize != ring));
        }
        let depths: Vec<usize> = self.around.iter().map(Vec::len).collect();
        for around in &mut self.around {
            around.compact_sort_by_key(|&ring| (depths[ring as usize], ring));
        }
    }

    /// Returns whether the inside and the outside of a ring are filled.
    fn filled(&self, ring: usize, fill: WindingRule) -> [bool; 2] {
        let outside: i32 = self.around[ring].iter().map(|&other| self.turns[other as usize]).sum();
        [outside + self.turns[ring], outside].map(|winding| fill.fills(winding))
    }

    fn polygons(&self, rings: &Shapes<I64Vec2>, fill: WindingRule) -> Shapes<I64Vec2> {
        let count = rings.ring_count();
        let filled: Vec<[bool; 2]> = (0..count).map(|ring| self.filled(ring, fill)).collect();
        let mut holes: Vec<Vec<usize>> = vec![Vec::new(); count];
        for ring in (0..count).filter(|&ring| filled[ring] == [false, true]) {
            let outer =
                self.around[ring].iter().rev().find(|&&o| filled[o as usize] == [true, false]);
            if let Some(&outer) = outer {
                holes[outer as usize].push(ring);
            }
        }
        let mut shapes = Shapes::new();
        for outer in (0..count).filter(|&ring| filled[ring] == [true, false]) {
            self.push(&mut shapes, rings, outer, 1);
            holes[outer].iter().for_each(|&hole| self.push(&mut shapes, rings, hole, -1));
            shapes.end_polygon();
        }
        shapes
    }

    /// Adds a ring, in the direction of `turn`.
    fn push(&self, to: &mut Shapes<I64Vec2>, rings: &Shapes<I64Vec2>, ring: usize, turn: i32) {
        let points = rings.ring(ring).iter().copied();
        if self.turns[ring] == turn { to.push_ring(points) } else { to.push_ring(points.rev()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::polygon::{BooleanOp, overlay, signed_area};
    use crate::trace::NoTrace;
    use proptest::prelude::*;

    fn ring(points: &[(i64, i64)]) -> Vec<I64Vec2> {
        points.iter().map(|&p| p.into()).collect()
    }

    fn shapes(rings: &[Vec<I64Vec2>]) -> Shapes<I64Vec2> {
        let mut shapes = Shapes::new();
        for ring in rings.iter().map(|ring| cleaned(ring.iter().copied())) {
            if !ring.is_empty() {
                shapes.push_ring(ring);
            }
        }
        shapes.end_polygon();
        shapes
    }

    fn square(x: i64, y: i64, side: i64) -> Vec<I64Vec2> {
        ring(&[(x, y), (x + side, y), (x + side, y + side), (x, y + side)])
    }

    #[test]
    fn idle_points_go() {
        let spiked =
            ring(&[(4, 0), (4, 0), (4, 4), (2, 4), (2, 9), (2, 4), (0, 4), (0, 0), (2, 0), (7, 0)]);
        assert_eq!(cleaned(spiked), ring(&[(4, 0), (4, 4), (0, 4), (0, 0)]));
        assert_eq!(cleaned(ring(&[(0, 0), (5, 5), (2, 2), (9, 9)])), []);
        assert_eq!(cleaned(ring(&[(0, 0), (5, 5)])), []);
        assert_eq!(cleaned([]), []);
        // The start is on a straight line, which ends in a spike.
        assert_eq!(
            cleaned(ring(&[(2, 0), (4, 0), (4, 4), (0, 4), (0, 0), (-3, 0), (0, 0)])),
            ring(&[(4, 0), (4, 4), (0, 4), (0, 0)])
        );
    }

    #[test]
    fn rings_within_rings_become_polygons_by_all_rules() {
        let mut rings =
            [square(0, 0, 100), square(10, 10, 50), square(20, 20, 10), square(70, 70, 9)];
        rings[1].reverse();
        let counts = |fill| {
            let shapes = polygons(&shapes(&rings), fill).expect("they are apart");
            assert!(shapes.polygons().all(|p| signed_area(p.outer()) > 0.0));
            assert!(shapes.polygons().all(|p| p.holes().all(|hole| signed_area(hole) < 0.0)));
            (shapes.polygon_count(), shapes.ring_count(), shapes.area())
        };
        assert_eq!(counts(WindingRule::EvenOdd), (2, 4, 10_000.0 - 2500.0 + 100.0 - 81.0));
        assert_eq!(counts(WindingRule::NonZero), (2, 3, 10_000.0 - 2500.0 + 100.0));
        assert_eq!(counts(WindingRule::Positive), (2, 3, 10_000.0 - 2500.0 + 100.0));
        assert_eq!(counts(WindingRule::Negative), (0, 0, 0.0));
    }

    #[test]
    fn what_touches_or_is_far_away_is_left_to_the_overlay() {
        let touching = [square(0, 0, 4), square(4, 4, 4)];
        assert_eq!(polygons(&shapes(&touching), WindingRule::EvenOdd), None);
        let on_an_edge = [square(0, 0, 4), ring(&[(4, 2), (9, 0), (9, 4)])];
        assert_eq!(polygons(&shapes(&on_an_edge), WindingRule::EvenOdd), None);
        let along = [square(0, 0, 4), square(4, 1, 2)];
        assert_eq!(polygons(&shapes(&along), WindingRule::EvenOdd), None);
        assert_eq!(polygons(&shapes(&[square(i64::MIN, 0, i64::MAX)]), WindingRule::EvenOdd), None);
        assert_eq!(polygons(&Shapes::new(), WindingRule::EvenOdd), Some(Shapes::new()));
    }

    /// Returns a set of rings, normalized so that their starting points do not matter.
    fn sorted(shapes: &Shapes<I64Vec2>) -> Vec<Vec<Vec<I64Vec2>>> {
        let of_ring = |ring: &[I64Vec2]| {
            let first = (0..ring.len()).min_by_key(|&i| (ring[i].x, ring[i].y)).unwrap_or(0);
            let mut ring = ring.to_vec();
            ring.rotate_left(first);
            ring
        };
        let key = |ring: &Vec<I64Vec2>| ring.iter().map(|p| (p.x, p.y)).collect::<Vec<_>>();
        let of_polygon = |rings: Vec<&[I64Vec2]>| {
            let mut rings: Vec<_> = rings.into_iter().map(of_ring).collect();
            rings[1..].sort_by_key(key);
            rings
        };
        let mut polygons: Vec<_> =
            shapes.polygons().map(|p| of_polygon(p.rings().collect())).collect();
        polygons.sort_by_key(|polygon| key(&polygon[0]));
        polygons
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn rings_that_are_apart_are_what_the_overlay_makes_of_them(
            bases in prop::collection::vec((0i64..60, 0i64..60, 1i64..30, any::<bool>()), 1..9),
            bends in prop::collection::vec((0i64..4, 0i64..4), 32),
            rule in 0..4usize,
        ) {
            let ring = |(k, &(x, y, side, turned)): (usize, &(i64, i64, i64, bool))| {
                let mut ring = square(2 * x, 2 * y, 2 * side);
                ring.iter_mut().zip(&bends[(4 * k) % 28..]).for_each(|(p, &bend)| *p += I64Vec2::from(bend));
                if turned { ring.reverse() }
                ring
            };
            let rings = shapes(&bases.iter().enumerate().map(ring).collect::<Vec<_>>());
            let fill = WindingRule::ALL[rule];
            // The overlay leads edges through vertices within half a cell; edges of larger rings do not come so near.
            let large = |shapes: &Shapes<I64Vec2>| {
                let mut shapes = shapes.clone();
                shapes.points_mut().iter_mut().for_each(|p| *p *= 1024);
                shapes
            };
            let options = overlay::Options { drop_collinear: true, ..overlay::Options::with_rule(fill) };
            let whole = overlay::overlay(&large(&rings), &Shapes::new(), BooleanOp::Union, &options, &mut NoTrace).unwrap();
            if let Some(found) = polygons(&rings, fill) {
                prop_assert_eq!(sorted(&large(&found)), sorted(&whole.shapes));
            }
            // A single ring is nearly always apart from itself.
            if bases.len() == 1 && rings.ring_count() == 1 && bases[0].2 > 4 {
                prop_assert!(polygons(&rings, fill).is_some());
            }
        }
    }
}
