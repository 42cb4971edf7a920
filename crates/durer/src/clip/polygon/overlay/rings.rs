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
    /// Of each polygon the outer ring, then its holes.
    pub polygons: Vec<Vec<u32>>,
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
#[derive(Debug, Clone)]
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
        let mut polygon_of = vec![NONE; self.walks.len()];
        for w in order {
            let walk = self.walks[w as usize].clone();
            let polygon = match walk.outer {
                Some(outer) => {
                    self.rings.polygons.push(vec![outer]);
                    self.rings.polygons.len() as u32 - 1
                }
                None => {
                    let on = |e: usize| self.courses[e] != Course::No;
                    let below = search.below(self.graph, walk.first, on);
                    below.map_or(0, |e| polygon_of[self.walk_of[e] as usize])
                }
            };
            polygon_of[w as usize] = polygon;
            if let Some(rings) = self.rings.polygons.get_mut(polygon as usize) {
                rings.extend(walk.rings.filter(|&r| Some(r) != walk.outer));
            }
        }
        self.sort();
    }

    /// The order of polygons and of their holes: by their points.
    fn sort(&mut self) {
        let nodes = self.graph.nodes;
        let mut polygons = std::mem::take(&mut self.rings.polygons);
        let rings = &self.rings;
        let compare = |&a: &u32, &b: &u32| {
            let points = |r: u32| rings.ring(r).iter().map(|&n| nodes[n as usize]);
            points(a).cmp(points(b))
        };
        for polygon in &mut polygons {
            if let Some((_, holes)) = polygon.split_first_mut() {
                holes.sort_unstable_by(compare);
            }
        }
        polygons.sort_unstable_by(|a, b| compare(&a[0], &b[0]));
        self.rings.polygons = polygons;
    }
}
