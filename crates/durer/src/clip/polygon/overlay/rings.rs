//! From the edges that bound the result to simple rings, and from rings to polygons.

use super::arrangement::{Arrangement, Half, NONE, Winding};
use super::lattice::{Coord, Point, cross};
use super::search::Search;
use crate::clip::polygon::Shapes;

/// Which way an edge bounds the result, whose inside is on its left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Course {
    No,
    Up,
    Down,
}

/// Simple rings of nodes, grouped into polygons; canonical, whatever order the input had.
#[derive(Debug, Default)]
pub struct Rings {
    /// Ring after ring, each starting with its smallest node.
    pub nodes: Vec<u32>,
    pub ring_ends: Vec<u32>,
    /// Which rings, in their order: of each polygon the outer ring, then its holes.
    pub order: Vec<u32>,
    /// Where each polygon ends in `order`.
    pub polygon_ends: Vec<u32>,
}

impl Rings {
    /// Shapes with room for all these rings.
    pub fn room(&self) -> Shapes {
        Shapes::with_capacity(self.nodes.len(), self.ring_ends.len(), self.polygon_ends.len())
    }

    /// The nodes of a ring.
    pub fn ring(&self, index: u32) -> &[u32] {
        let index = index as usize;
        let start = if index == 0 { 0 } else { self.ring_ends[index - 1] };
        &self.nodes[start as usize..self.ring_ends[index] as usize]
    }
}

/// A closed walk along the border of one connected piece of the result.
#[derive(Debug)]
struct Walk {
    first: u32,
    rings: std::ops::Range<u32>,
    outer: Option<u32>,
}

struct Linker<'a, 'b, C> {
    graph: &'a Arrangement<'b, C>,
    courses: Vec<Course>,
    /// The edge that follows an edge on the result's border.
    next: Vec<u32>,
    /// The walk that an edge belongs to.
    walk_of: Vec<u32>,
    walks: Vec<Walk>,
    rings: Rings,
}

/// Links the edges where `inside` differs between the two sides.
#[inline(never)]
pub fn link<C: Coord>(
    graph: &Arrangement<C>,
    search: &Search<C>,
    inside: impl Fn(Winding) -> bool,
) -> Rings {
    let course = |left: bool, right: bool| match (left, right) {
        (true, false) => Course::Up,
        (false, true) => Course::Down,
        _ => Course::No,
    };
    let courses = graph.edges.iter().map(|e| course(inside(e.left()), inside(e.right))).collect();
    let mut linker = Linker {
        graph,
        courses,
        next: vec![NONE; graph.edges.len()],
        walk_of: vec![NONE; graph.edges.len()],
        walks: Vec::new(),
        rings: Rings::default(),
    };
    linker.pair();
    linker.trace();
    linker.nest(search);
    linker.rings
}

impl<C: Coord> Linker<'_, '_, C> {
    /// At each node, an edge that arrives goes on with the edge that leaves on the other side of
    /// the piece of inside to its left, so that pieces that only touch stay apart.
    #[inline(never)]
    fn pair(&mut self) {
        for node in 0..self.graph.nodes.len() as u32 {
            // The one before in the sense of the clock; around the first one, that is the last.
            let on = |half: &&Half| self.courses[half.edge()] != Course::No;
            let around = self.graph.around(node);
            let Some(&last) = around.iter().rev().find(on) else { continue };
            let mut before = last;
            for &half in around.iter().filter(on) {
                if self.arrives(half) {
                    self.next[half.edge()] = before.edge() as u32;
                }
                before = half;
            }
        }
    }

    /// Whether the border runs against a half-edge that leaves a node.
    fn arrives(&self, half: Half) -> bool {
        let arriving = if half.is_back() { Course::Up } else { Course::Down };
        self.courses[half.edge()] == arriving
    }

    /// Walks along the border of every piece and cuts each walk into simple rings where it comes
    /// back to a node.
    #[inline(never)]
    fn trace(&mut self) {
        let mut path: Vec<u32> = Vec::new();
        let mut position = vec![NONE; self.graph.nodes.len()];
        for start in 0..self.courses.len() as u32 {
            if self.courses[start as usize] == Course::No || self.walk_of[start as usize] != NONE {
                continue;
            }
            let id = self.walks.len() as u32;
            let first_ring = self.rings.ring_ends.len() as u32;
            let mut walk = Walk { first: NONE, rings: first_ring..first_ring, outer: None };
            let mut edge = start;
            loop {
                let up = self.courses[edge as usize] == Course::Up;
                let ends = &self.graph.edges[edge as usize];
                let node = if up { ends.low } else { ends.high };
                let at = position[node as usize];
                if at != NONE {
                    self.close(&path[at as usize..], &mut position, &mut walk);
                    path.truncate(at as usize);
                }
                if self.walk_of[edge as usize] != NONE {
                    break;
                }
                position[node as usize] = path.len() as u32;
                path.push(node);
                let inner = self.graph.inner(edge as usize).iter();
                if up {
                    path.extend(inner)
                } else {
                    path.extend(inner.rev())
                }
                self.walk_of[edge as usize] = id;
                edge = self.next[edge as usize];
            }
            walk.rings.end = self.rings.ring_ends.len() as u32;
            self.walks.push(walk);
        }
    }

    /// Stores a simple ring, from its smallest node on, without nodes on straight edges.
    fn close(&mut self, path: &[u32], position: &mut [u32], walk: &mut Walk) {
        let nodes = self.graph.nodes;
        let point = |n: u32| nodes[n as usize];
        let mut smallest = 0;
        for (i, &n) in path.iter().enumerate() {
            position[n as usize] = NONE;
            if point(n) < point(path[smallest]) {
                smallest = i;
            }
        }
        let first = path[smallest];
        if walk.first == NONE || point(first) < point(walk.first) {
            walk.first = first;
        }
        let (tail, head) = path.split_at(smallest);
        let mut before = *tail.last().or(path.last()).unwrap_or(&first);
        let after = *path.get(smallest + 1).or(path.first()).unwrap_or(&first);
        // The smallest node is a corner, and the turn there tells the orientation.
        if cross(point(before), point(first), point(after)) > C::Wide::default() {
            walk.outer = Some(self.rings.ring_ends.len() as u32);
        }
        let mut at = first;
        for &after in head[1..].iter().chain(tail).chain([&first]) {
            let straight = cross(point(before), point(at), point(after)) == C::Wide::default();
            if !straight || self.touched(at) {
                self.rings.nodes.push(at);
            }
            (before, at) = (at, after);
        }
        self.rings.ring_ends.push(self.rings.nodes.len() as u32);
    }

    /// Whether more than one ring passes the node: then it stays, so that the touch is a vertex.
    fn touched(&self, node: u32) -> bool {
        let on = |half: &&Half| self.courses[half.edge()] != Course::No;
        self.graph.around(node).iter().filter(on).count() > 2
    }

    /// Gives every walk without an outer ring to the piece it is a hole of: that of the edge below
    /// its first node. Such walks that start further left are done before.
    #[inline(never)]
    fn nest(&mut self, search: &Search<C>) {
        let nodes = self.graph.nodes;
        // The outer ring of each walk's polygon, and of each ring.
        let mut outer_of: Vec<u32> = self.walks.iter().map(|w| w.outer.unwrap_or(NONE)).collect();
        let mut holes: Vec<(Point<C>, u32)> = (self.walks.iter().zip(0..))
            .filter(|(walk, _)| walk.outer.is_none() && walk.first != NONE)
            .map(|(walk, id)| (nodes[walk.first as usize], id))
            .collect();
        holes.sort_unstable();
        for (_, id) in holes {
            let on = |e: usize| self.courses[e] != Course::No;
            let below = search.below(self.graph, self.walks[id as usize].first, on);
            let walk = below.map_or(NONE, |half| self.walk_of[half.edge()]);
            outer_of[id as usize] = outer_of.get(walk as usize).copied().unwrap_or(NONE);
        }
        let mut owners = vec![NONE; self.rings.ring_ends.len()];
        for (walk, outer) in self.walks.iter().zip(outer_of) {
            owners[walk.rings.start as usize..walk.rings.end as usize].fill(outer);
        }
        self.sort(&owners);
    }

    /// Puts polygons in the order of their outer rings' points, and the holes of each likewise.
    #[inline(never)]
    fn sort(&mut self, owners: &[u32]) {
        let nodes = self.graph.nodes;
        let rings = &self.rings;
        let points = |r: u32| rings.ring(r).iter().map(|&n| nodes[n as usize]);
        let first = |r: u32| points(r).next().unwrap_or_default();
        // The first points differ, but for rings that touch there.
        let compare = |a: &(Point<C>, u32), b: &(Point<C>, u32)| {
            a.0.cmp(&b.0).then_with(|| points(a.1).cmp(points(b.1)))
        };
        let all = 0..rings.ring_ends.len() as u32;
        let of = |keeps: &dyn Fn(u32) -> bool| -> Vec<(Point<C>, u32)> {
            all.clone().filter(|&r| keeps(r)).map(|r| (first(r), r)).collect()
        };
        let mut outers = of(&|r| owners[r as usize] == r);
        let mut holes = of(&|r| owners[r as usize] != r && owners[r as usize] != NONE);
        outers.sort_unstable_by(compare);
        let mut rank = vec![NONE; owners.len()];
        for (&(_, outer), i) in outers.iter().zip(0..) {
            rank[outer as usize] = i;
        }
        let rank_of = |hole: u32| rank[owners[hole as usize] as usize];
        holes.sort_unstable_by(|a, b| rank_of(a.1).cmp(&rank_of(b.1)).then_with(|| compare(a, b)));
        let mut holes = holes.into_iter().map(|(_, hole)| hole).peekable();
        let (mut order, mut ends) =
            (Vec::with_capacity(owners.len()), Vec::with_capacity(outers.len()));
        for (&(_, outer), i) in outers.iter().zip(0..) {
            order.push(outer);
            while let Some(hole) = holes.next_if(|&h| rank_of(h) == i) {
                order.push(hole);
            }
            ends.push(order.len() as u32);
        }
        (self.rings.order, self.rings.polygon_ends) = (order, ends);
    }
}
