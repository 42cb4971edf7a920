//! The planar graph of the snapped segments: unique edges, their order around each node, and the
//! winding numbers of subject and clip on both sides of each edge.
//!
//! Most points of a coast are passed by one ring and touched by nothing else. Such points are no
//! nodes of the graph that winding numbers and rings are found on, but lie within an edge of it.

use super::lattice::{Coord, Point, cross};
use super::noding::Noding;

pub(super) const NONE: u32 = u32::MAX;

/// How often subject and clip wind around a point, or by how much that changes across an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Winding {
    pub subject: i32,
    pub clip: i32,
}

impl Winding {
    pub(super) fn plus(self, other: Self) -> Self {
        Self { subject: self.subject + other.subject, clip: self.clip + other.clip }
    }

    pub(super) fn minus(self, other: Self) -> Self {
        Self { subject: self.subject - other.subject, clip: self.clip - other.clip }
    }
}

/// An edge between two nodes; one without inner nodes runs from the lexicographically smaller node
/// to the larger.
#[derive(Debug, Clone, Copy, Default)]
pub struct Edge {
    pub low: u32,
    pub high: u32,
    /// Winding on the left less winding on the right, seen from `low` to `high`.
    pub step: Winding,
    /// Winding on the right; of an edge without inner nodes that is below, or to the right of a
    /// vertical one.
    pub right: Winding,
}

impl Edge {
    /// Winding on the left.
    pub fn left(&self) -> Winding {
        self.right.plus(self.step)
    }
}

/// An edge in one of its directions: 2e runs from the low node of edge e to its high node, 2e + 1
/// back.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Half(pub u32);

impl Half {
    /// The edge in the direction from `low` to `high`.
    pub fn forward(edge: usize) -> Self {
        Self((edge as u32) << 1)
    }

    /// Its edge.
    #[inline(always)]
    pub fn edge(self) -> usize {
        (self.0 >> 1) as usize
    }

    /// Whether it runs from `high` to `low`.
    #[inline(always)]
    pub fn is_back(self) -> bool {
        self.0 & 1 == 1
    }

    /// The same edge in the other direction.
    #[inline(always)]
    pub fn reversed(self) -> Self {
        Self(self.0 ^ 1)
    }
}

/// See the module.
#[derive(Debug)]
pub struct Arrangement<'a, C> {
    pub nodes: &'a [Point<C>],
    pub edges: Vec<Edge>,
    /// The inner nodes of edge e, from low to high, are `inner[inner_starts[e]..inner_starts[e + 1]]`.
    inner_starts: Vec<u32>,
    inner: Vec<u32>,
    /// Of an inner node its index in `inner`, of the others `NONE`; empty where there are none.
    place: Vec<u32>,
    /// What leaves node n is `around[starts[n]..starts[n + 1]]`, counter-clockwise from straight
    /// down.
    starts: Vec<u32>,
    around: Vec<Half>,
}

impl<'a, C: Coord> Arrangement<'a, C> {
    /// Builds the graph of rings, with inner nodes; `step` gives the change of winding across a
    /// segment, right to left.
    pub fn of_rings(noding: &'a Noding<C>, step: impl Fn(usize) -> Winding) -> Self {
        let joints = Joints::new(noding);
        Self::build(noding, joints, step, |edge| edge.step != Winding::default())
    }

    /// Builds the graph of rings, every point a node, so that all edges are straight.
    pub fn of_straight(noding: &'a Noding<C>, step: impl Fn(usize) -> Winding) -> Self {
        let joints = Joints::default();
        Self::build(noding, joints, step, |edge| edge.step != Winding::default())
    }

    /// Builds the graph of segments that bound nothing; it keeps them all, as straight edges.
    pub fn of_lines(noding: &'a Noding<C>) -> Self {
        Self::build(noding, Joints::default(), |_| Winding::default(), |_| true)
    }

    fn build(
        noding: &'a Noding<C>,
        joints: Joints,
        step: impl Fn(usize) -> Winding,
        keeps: impl Fn(&Edge) -> bool,
    ) -> Self {
        let nodes = &noding.nodes[..];
        let pieces = noding.hits.len() + 1 - noding.starts.len();
        let mut graph = Self {
            nodes,
            edges: Vec::with_capacity(pieces),
            inner_starts: Vec::with_capacity(pieces + 1),
            inner: Vec::new(),
            place: Vec::new(),
            starts: vec![0; nodes.len() + 2],
            around: Vec::new(),
        };
        graph.inner_starts.push(0);
        graph.collect(noding, joints, step);
        let joined = graph.arrange();
        if !joined.is_empty() {
            graph.drop_unkept(&joined, keeps);
        }
        graph
    }

    /// What leaves a node, counter-clockwise from straight down: first what goes to the right or
    /// straight up, then what goes to the left or straight down.
    #[inline(always)]
    pub fn around(&self, node: u32) -> &[Half] {
        &self.around[self.range(node)]
    }

    /// The indices, for [`Self::half`], of what leaves a node.
    #[inline(always)]
    pub(super) fn range(&self, node: u32) -> std::ops::Range<usize> {
        self.starts[node as usize] as usize..self.starts[node as usize + 1] as usize
    }

    #[inline(always)]
    pub(super) fn half(&self, index: usize) -> Half {
        self.around[index]
    }

    /// The nodes within an edge, from low to high.
    #[inline(always)]
    pub fn inner(&self, edge: usize) -> &[u32] {
        &self.inner[self.inner_starts[edge] as usize..self.inner_starts[edge + 1] as usize]
    }

    /// The node a half-edge comes from.
    #[inline(always)]
    pub fn start(&self, half: Half) -> u32 {
        let edge = &self.edges[half.edge()];
        if half.is_back() { edge.high } else { edge.low }
    }

    /// The node or inner node a half-edge comes to first.
    #[inline(always)]
    fn toward(&self, half: Half) -> u32 {
        let (edge, inner) = (&self.edges[half.edge()], self.inner(half.edge()));
        if half.is_back() {
            *inner.last().unwrap_or(&edge.low)
        } else {
            *inner.first().unwrap_or(&edge.high)
        }
    }

    /// The winding on the left of a half-edge.
    #[inline(always)]
    pub fn left_of(&self, half: Half) -> Winding {
        let edge = &self.edges[half.edge()];
        if half.is_back() { edge.right } else { edge.left() }
    }

    /// The half-edge that goes from a node straight on to another one; `None` where those edges
    /// have cancelled.
    pub fn between(&self, from: u32, to: u32) -> Option<Half> {
        if let Some(place) = self.place_of(from) {
            let forward = Half::forward(self.edge_at(place));
            let next = self.beside(place, forward);
            return Some(if next == to { forward } else { forward.reversed() });
        }
        if self.place_of(to).is_some() {
            return self.between(to, from).map(Half::reversed);
        }
        self.around(from).iter().copied().find(|&half| self.toward(half) == to)
    }

    fn place_of(&self, node: u32) -> Option<u32> {
        self.place.get(node as usize).copied().filter(|&place| place != NONE)
    }

    /// The edge that has this place in `inner`.
    fn edge_at(&self, place: u32) -> usize {
        self.inner_starts.partition_point(|&start| start <= place) - 1
    }

    /// The node that follows an inner node of an edge.
    fn beside(&self, place: u32, forward: Half) -> u32 {
        let end = self.inner_starts[forward.edge() + 1];
        if place + 1 < end {
            self.inner[place as usize + 1]
        } else {
            self.edges[forward.edge()].high
        }
    }

    /// Cuts the segments into edges, and counts the edges of each node.
    #[inline(never)]
    fn collect(&mut self, noding: &Noding<C>, joints: Joints, step: impl Fn(usize) -> Winding) {
        let mut joints = joints;
        if !joints.neighbours.is_empty() {
            self.place = vec![NONE; self.nodes.len()];
        }
        let nodes = self.nodes;
        for i in 0..noding.starts.len() - 1 {
            let plus = step(i);
            let minus = Winding::default().minus(plus);
            for pair in noding.chain(i).windows(2) {
                let (a, b) = (pair[0], pair[1]);
                match (joints.is_passed(a), joints.is_passed(b)) {
                    (false, false) if nodes[a as usize] < nodes[b as usize] => {
                        self.push(a, b, plus)
                    }
                    (false, false) => self.push(b, a, minus),
                    (false, true) => self.follow(&joints, a, b, plus),
                    (true, false) => self.follow(&joints, b, a, minus),
                    (true, true) => {}
                }
            }
        }
        // What is left are rings that nothing touches: one point of each becomes a node.
        if !joints.neighbours.is_empty() {
            for i in 0..noding.starts.len() - 1 {
                for pair in noding.chain(i).windows(2) {
                    if joints.is_passed(pair[0]) && self.place[pair[0] as usize] == NONE {
                        joints.neighbours[pair[0] as usize] = Joints::NODE;
                        self.follow(&joints, pair[0], pair[1], step(i));
                    }
                }
            }
        }
    }

    fn push(&mut self, low: u32, high: u32, step: Winding) {
        self.edges.push(Edge { low, high, step, right: Winding::default() });
        self.inner_starts.push(self.inner.len() as u32);
        self.starts[low as usize + 2] += 1;
        self.starts[high as usize + 2] += 1;
    }

    /// Makes an edge of all pieces from a node to the next one, unless it came from the other side.
    fn follow(&mut self, joints: &Joints, from: u32, first: u32, step: Winding) {
        if self.place[first as usize] != NONE {
            return;
        }
        let (mut before, mut at) = (from, first);
        while joints.is_passed(at) {
            self.place[at as usize] = self.inner.len() as u32;
            self.inner.push(at);
            (before, at) = (at, joints.opposite(at, before));
        }
        self.push(from, at, step);
    }

    /// Sorts the edges around every node, and joins those that coincide in the first of them.
    /// Gives the others, which have no meaning any more.
    #[inline(never)]
    fn arrange(&mut self) -> Vec<u32> {
        for i in 2..self.starts.len() {
            self.starts[i] += self.starts[i - 1];
        }
        self.around = vec![Half::default(); self.edges.len() * 2];
        for (e, edge) in self.edges.iter().enumerate() {
            for (node, half) in
                [(edge.low, Half::forward(e)), (edge.high, Half::forward(e).reversed())]
            {
                let next = &mut self.starts[node as usize + 1];
                self.around[*next as usize] = half;
                *next += 1;
            }
        }
        self.starts.pop();
        let mut joined = Vec::new();
        let mut star: Vec<Ray<C>> = Vec::new();
        for node in 0..self.nodes.len() {
            let range = self.starts[node] as usize..self.starts[node + 1] as usize;
            if range.len() < 2 {
                continue;
            }
            star.clear();
            star.extend(self.around[range.clone()].iter().map(|&half| self.ray(node, half)));
            sort_around(self.nodes[node], &mut star);
            for (half, ray) in self.around[range].iter_mut().zip(&star) {
                *half = ray.half;
            }
            self.join(&star, &mut joined);
        }
        joined
    }

    fn ray(&self, node: usize, half: Half) -> Ray<C> {
        let toward = self.toward(half);
        let point = self.nodes[toward as usize];
        Ray { half, toward, point, left: point < self.nodes[node] }
    }

    fn join(&mut self, star: &[Ray<C>], joined: &mut Vec<u32>) {
        let mut first = 0;
        for k in 1..star.len() {
            if star[k].toward != star[first].toward {
                first = k;
                continue;
            }
            // The high node finds the same edges side by side; one of the two is enough.
            if !star[k].half.is_back() {
                let other = star[k].half.edge();
                let step = self.edges[other].step;
                let edge = &mut self.edges[star[first].half.edge()];
                edge.step = edge.step.plus(step);
                joined.push(other as u32);
            }
        }
    }

    /// Drops the edges that were joined with others, and those that are not to be kept: that cancel.
    #[inline(never)]
    fn drop_unkept(&mut self, joined: &[u32], keeps: impl Fn(&Edge) -> bool) {
        let mut kept = 0;
        let mut renamed = vec![0; self.edges.len()];
        joined.iter().for_each(|&e| renamed[e as usize] = NONE);
        for (e, name) in renamed.iter_mut().enumerate() {
            let edge = self.edges[e];
            let drops = *name == NONE || !keeps(&edge);
            *name = if drops { NONE } else { kept as u32 };
            if !drops {
                self.edges[kept] = edge;
                kept += 1;
                self.inner_starts[kept] = self.inner_starts[e + 1];
            }
        }
        self.edges.truncate(kept);
        self.inner_starts.truncate(kept + 1);
        let mut filled = 0;
        for node in 0..self.nodes.len() {
            let range = self.starts[node] as usize..self.starts[node + 1] as usize;
            self.starts[node] = filled as u32;
            for k in range {
                let half = self.around[k];
                let name = renamed[half.edge()];
                if name != NONE {
                    self.around[filled] = Half(name << 1 | (half.0 & 1));
                    filled += 1;
                }
            }
        }
        self.around.truncate(filled);
        self.starts[self.nodes.len()] = filled as u32;
    }
}

/// A half-edge on its way out of a node.
#[derive(Debug, Clone, Copy)]
struct Ray<C> {
    half: Half,
    toward: u32,
    point: Point<C>,
    /// Whether it goes to the left or straight down.
    left: bool,
}

/// Sorts counter-clockwise from straight down. Nodes have few edges, and those are mostly in order.
fn sort_around<C: Coord>(node: Point<C>, star: &mut [Ray<C>]) {
    let zero = C::Wide::default();
    star.sort_unstable_by(|r, s| {
        r.left.cmp(&s.left).then_with(|| zero.cmp(&cross(node, r.point, s.point)))
    });
}

/// Which points one ring passes and nothing else touches: they have two neighbours, not the same.
#[derive(Debug, Default)]
struct Joints {
    /// Of each node its two neighbours, or `NODE`; empty where every point is to be a node.
    neighbours: Vec<[u32; 2]>,
}

impl Joints {
    const NODE: [u32; 2] = [NONE - 1, NONE - 1];

    #[inline(never)]
    fn new<C>(noding: &Noding<C>) -> Self {
        let mut joints = Self { neighbours: vec![[NONE; 2]; noding.nodes.len()] };
        for i in 0..noding.starts.len() - 1 {
            for pair in noding.chain(i).windows(2) {
                joints.link(pair[0], pair[1]);
                joints.link(pair[1], pair[0]);
            }
        }
        joints
    }

    fn link(&mut self, node: u32, to: u32) {
        let list = &mut self.neighbours[node as usize];
        match *list {
            [NONE, _] => list[0] = to,
            [other, NONE] if other != to => list[1] = to,
            _ => *list = Self::NODE,
        }
    }

    #[inline(always)]
    fn is_passed(&self, node: u32) -> bool {
        self.neighbours.get(node as usize).is_some_and(|list| list[1] < Self::NODE[1])
    }

    fn opposite(&self, node: u32, from: u32) -> u32 {
        let [a, b] = self.neighbours[node as usize];
        if a == from { b } else { a }
    }
}
