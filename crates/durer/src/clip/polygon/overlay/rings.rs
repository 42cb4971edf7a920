//! From the edges that bound the result to simple rings, and from rings to polygons.

use super::arrangement::{Arrangement, Search, Winding};
use super::lattice::{Coord, cross};

const NONE: u32 = u32::MAX;

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
    fn pair(&mut self) {
        // Counter-clockwise around a node: does the border arrive by this edge, or leave?
        let mut around: Vec<(u32, bool)> = Vec::new();
        for node in 0..self.graph.nodes.len() as u32 {
            around.clear();
            for e in self.graph.outs(node) {
                self.push(&mut around, e as u32, Course::Down);
            }
            for &e in self.graph.ins(node) {
                self.push(&mut around, e, Course::Up);
            }
            for (k, &(e, arrives)) in around.iter().enumerate() {
                if arrives {
                    let before = if k == 0 { around.len() - 1 } else { k - 1 };
                    self.next[e as usize] = around[before].0;
                }
            }
        }
    }

    fn push(&self, around: &mut Vec<(u32, bool)>, edge: u32, arriving: Course) {
        let course = self.courses[edge as usize];
        if course != Course::No {
            around.push((edge, course == arriving));
        }
    }

    fn start(&self, edge: u32) -> u32 {
        let e = &self.graph.edges[edge as usize];
        if self.courses[edge as usize] == Course::Up { e.low } else { e.high }
    }

    /// Walks along the border of every piece and cuts each walk into simple rings where it comes
    /// back to a node.
    fn trace(&mut self) {
        let mut path: Vec<u32> = Vec::new();
        let mut position = vec![NONE; self.graph.nodes.len()];
        for start in 0..self.courses.len() as u32 {
            if self.courses[start as usize] == Course::No || self.walk_of[start as usize] != NONE {
                continue;
            }
            let id = self.walks.len() as u32;
            let first_ring = self.rings.ring_ends.len() as u32;
            let mut walk =
                Walk { first: self.start(start), rings: first_ring..first_ring, outer: None };
            let mut edge = start;
            loop {
                let node = self.start(edge);
                if self.graph.nodes[node as usize] < self.graph.nodes[walk.first as usize] {
                    walk.first = node;
                }
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
        for &n in path {
            position[n as usize] = NONE;
        }
        let smallest = (0..path.len()).min_by_key(|&i| nodes[path[i] as usize]).unwrap_or(0);
        let at = |i: usize| path[(smallest + i) % path.len()];
        let point = |i: usize| nodes[at(i) as usize];
        // The smallest node is a corner, and the turn there tells the orientation.
        let turn = cross(point(path.len() - 1), point(0), point(1));
        if turn > C::Wide::default() {
            walk.outer = Some(self.rings.ring_ends.len() as u32);
        }
        for i in 0..path.len() {
            let before = if i == 0 { path.len() - 1 } else { i - 1 };
            let straight = cross(point(before), point(i), point(i + 1)) == C::Wide::default();
            if !straight || self.touched(at(i)) {
                self.rings.nodes.push(at(i));
            }
        }
        self.rings.ring_ends.push(self.rings.nodes.len() as u32);
    }

    /// Whether more than one ring passes the node: then it stays, so that the touch is a vertex.
    fn touched(&self, node: u32) -> bool {
        let on = |e: u32| self.courses[e as usize] != Course::No;
        let outs = self.graph.outs(node).filter(|&e| on(e as u32)).count();
        outs + self.graph.ins(node).iter().filter(|&&e| on(e)).count() > 2
    }

    /// Gives every walk without an outer ring to the piece it is a hole of: that of the edge below
    /// its first node. Walks that start further left are done before.
    fn nest(&mut self, search: &Search<C>) {
        let nodes = self.graph.nodes;
        let mut order: Vec<u32> = (0..self.walks.len() as u32).collect();
        order.sort_unstable_by_key(|&w| nodes[self.walks[w as usize].first as usize]);
        // The outer ring of each walk's polygon, and of each ring.
        let mut outer_of = vec![NONE; self.walks.len()];
        let mut owners = vec![NONE; self.rings.ring_ends.len()];
        for w in order {
            let walk = &self.walks[w as usize];
            let outer = walk.outer.or_else(|| {
                let on = |e: usize| self.courses[e] != Course::No;
                let below = search.below(self.graph, walk.first, on)?;
                Some(outer_of[self.walk_of[below] as usize])
            });
            let outer = outer.unwrap_or(NONE);
            outer_of[w as usize] = outer;
            walk.rings.clone().for_each(|r| owners[r as usize] = outer);
        }
        self.sort(&owners);
    }

    /// Puts polygons in the order of their outer rings' points, and the holes of each likewise.
    fn sort(&mut self, owners: &[u32]) {
        let nodes = self.graph.nodes;
        let rings = &self.rings;
        let points = |r: u32| rings.ring(r).iter().map(|&n| nodes[n as usize]);
        let compare = |a: &u32, b: &u32| points(*a).cmp(points(*b));
        let is_outer = |&r: &u32| owners[r as usize] == r;
        let all = 0..rings.ring_ends.len() as u32;
        let (mut outers, mut holes): (Vec<u32>, Vec<u32>) = all.partition(is_outer);
        outers.sort_unstable_by(compare);
        holes.retain(|&h| owners[h as usize] != NONE);
        let mut rank = vec![NONE; owners.len()];
        for (i, &outer) in outers.iter().enumerate() {
            rank[outer as usize] = i as u32;
        }
        let rank_of = |hole: u32| rank[owners[hole as usize] as usize];
        holes.sort_unstable_by(|a, b| rank_of(*a).cmp(&rank_of(*b)).then_with(|| compare(a, b)));
        let mut holes = holes.into_iter().peekable();
        let (mut order, mut ends) =
            (Vec::with_capacity(owners.len()), Vec::with_capacity(outers.len()));
        for (i, &outer) in outers.iter().enumerate() {
            order.push(outer);
            while let Some(hole) = holes.next_if(|&h| rank_of(h) == i as u32) {
                order.push(hole);
            }
            ends.push(order.len() as u32);
        }
        (self.rings.order, self.rings.polygon_ends) = (order, ends);
    }
}
