//! The planar graph of the snapped segments: unique edges, their order around each node, and the
//! winding numbers of subject and clip on both sides of each edge.

use std::cmp::Ordering;

use super::grid::Grid;
use super::lattice::{Coord, Point, Segment, cross};
use super::noding::Noding;

/// How often subject and clip wind around a point, or by how much that changes across an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Winding {
    pub subject: i32,
    pub clip: i32,
}

impl Winding {
    fn plus(self, other: Self) -> Self {
        Self { subject: self.subject + other.subject, clip: self.clip + other.clip }
    }

    fn minus(self, other: Self) -> Self {
        Self { subject: self.subject - other.subject, clip: self.clip - other.clip }
    }
}

/// An edge between two nodes, from the lexicographically smaller to the larger.
#[derive(Debug, Clone, Copy, Default)]
pub struct Edge {
    pub low: u32,
    pub high: u32,
    /// Winding on the left less winding on the right, seen from `low` to `high`.
    pub step: Winding,
    /// Winding on the right, which is below, or to the right of a vertical edge.
    pub right: Winding,
}

impl Edge {
    /// Winding on the left.
    pub fn left(&self) -> Winding {
        self.right.plus(self.step)
    }
}

/// See the module.
#[derive(Debug)]
pub struct Arrangement<'a, C> {
    pub nodes: &'a [Point<C>],
    /// Sorted by `low`, then counter-clockwise from straight down.
    pub edges: Vec<Edge>,
    /// The edges with `low == n` are `edges[out_starts[n]..out_starts[n + 1]]`.
    out_starts: Vec<u32>,
    /// The edges with `high == n` are `ins[in_starts[n]..in_starts[n + 1]]`, counter-clockwise
    /// from straight up.
    in_starts: Vec<u32>,
    ins: Vec<u32>,
}

impl<'a, C: Coord> Arrangement<'a, C> {
    /// Builds the graph; `step` gives the change of winding across a segment, right to left.
    pub fn new(noding: &'a Noding<C>, step: impl Fn(usize) -> Winding) -> Self {
        Self::build(noding, step, |edge| edge.step != Winding::default())
    }

    /// Builds the graph of segments that bound nothing; it keeps them all.
    pub fn of_lines(noding: &'a Noding<C>) -> Self {
        Self::build(noding, |_| Winding::default(), |_| true)
    }

    fn build(
        noding: &'a Noding<C>,
        step: impl Fn(usize) -> Winding,
        keeps: impl Fn(&Edge) -> bool,
    ) -> Self {
        let nodes = &noding.nodes[..];
        let mut graph = Self {
            nodes,
            edges: Vec::new(),
            out_starts: Vec::new(),
            in_starts: Vec::new(),
            ins: Vec::new(),
        };
        graph.collect(noding, step);
        graph.merge(keeps);
        graph.index_ins();
        graph
    }

    /// Edges that start at a node; they lead to the right, or straight up.
    pub fn outs(&self, node: u32) -> std::ops::Range<usize> {
        self.out_starts[node as usize] as usize..self.out_starts[node as usize + 1] as usize
    }

    /// Edges that end at a node; they come from the left, or from straight below.
    pub fn ins(&self, node: u32) -> &[u32] {
        &self.ins
            [self.in_starts[node as usize] as usize..self.in_starts[node as usize + 1] as usize]
    }

    /// Cuts the segments into edges, sorted by their lower node.
    fn collect(&mut self, noding: &Noding<C>, step: impl Fn(usize) -> Winding) {
        let segments = noding.starts.len() - 1;
        let nodes = self.nodes;
        let pieces = |i: usize| noding.chain(i).windows(2).map(|pair| (pair[0], pair[1]));
        let upwards = |a: u32, b: u32| nodes[a as usize] < nodes[b as usize];
        let mut starts = vec![0u32; nodes.len() + 2];
        for (a, b) in (0..segments).flat_map(pieces) {
            let low = if upwards(a, b) { a } else { b };
            starts[low as usize + 2] += 1;
        }
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        self.edges = vec![Edge::default(); starts[starts.len() - 1] as usize];
        for i in 0..segments {
            let plus = step(i);
            let minus = Winding::default().minus(plus);
            for (a, b) in pieces(i) {
                let (low, high, step) = if upwards(a, b) { (a, b, plus) } else { (b, a, minus) };
                let next = &mut starts[low as usize + 1];
                self.edges[*next as usize] = Edge { low, high, step, right: Winding::default() };
                *next += 1;
            }
        }
        starts.pop();
        self.out_starts = starts;
    }

    /// Makes one edge of all that coincide, and drops those that are not to be kept: that cancel.
    fn merge(&mut self, keeps: impl Fn(&Edge) -> bool) {
        let nodes = self.nodes;
        let mut kept = 0;
        for n in 0..nodes.len() {
            let (start, end) = (self.out_starts[n] as usize, self.out_starts[n + 1] as usize);
            let at = |e: &Edge| nodes[e.high as usize];
            let outs = &mut self.edges[start..end];
            if outs.len() > 1 {
                let turn =
                    |e: &Edge, f: &Edge| C::Wide::default().cmp(&cross(nodes[n], at(e), at(f)));
                outs.sort_unstable_by(turn);
            }
            self.out_starts[n] = kept as u32;
            let mut i = start;
            while i < end {
                let mut edge = self.edges[i];
                i += 1;
                while i < end && self.edges[i].high == edge.high {
                    edge.step = edge.step.plus(self.edges[i].step);
                    i += 1;
                }
                if keeps(&edge) {
                    self.edges[kept] = edge;
                    kept += 1;
                }
            }
        }
        self.edges.truncate(kept);
        if let Some(last) = self.out_starts.last_mut() {
            *last = kept as u32;
        }
    }

    fn index_ins(&mut self) {
        let nodes = self.nodes;
        let mut starts = vec![0u32; nodes.len() + 2];
        for e in &self.edges {
            starts[e.high as usize + 2] += 1;
        }
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        self.ins = vec![0; self.edges.len()];
        for (i, e) in self.edges.iter().enumerate() {
            let next = &mut starts[e.high as usize + 1];
            self.ins[*next as usize] = i as u32;
            *next += 1;
        }
        starts.pop();
        let edges = &self.edges;
        for n in 0..nodes.len() {
            let list = &mut self.ins[starts[n] as usize..starts[n + 1] as usize];
            if list.len() > 1 {
                let at = |e: u32| nodes[edges[e as usize].low as usize];
                list.sort_unstable_by(|&e, &f| {
                    C::Wide::default().cmp(&cross(nodes[n], at(e), at(f)))
                });
            }
        }
        self.in_starts = starts;
    }

    /// Finds the winding numbers: relative ones within each connected part by walking its nodes,
    /// then for each part, from left to right, those around it from the edge below its first node.
    pub fn wind(&mut self, search: &Search<C>) {
        let (parts, part_of) = self.walk();
        let mut order: Vec<u32> = (0..parts.len() as u32).collect();
        order.sort_unstable_by_key(|&p| self.nodes[parts[p as usize].0 as usize]);
        let mut around = vec![Winding::default(); parts.len()];
        for part in order {
            let (first, inner) = parts[part as usize];
            let below = search.below(self, first, |_| true);
            let outer = below.map_or(Winding::default(), |e| {
                let edge = &self.edges[e];
                edge.left().plus(around[part_of[edge.low as usize] as usize])
            });
            around[part as usize] = outer.minus(inner);
        }
        for e in &mut self.edges {
            e.right = e.right.plus(around[part_of[e.low as usize] as usize]);
        }
    }

    /// Finds the winding numbers by a sweep from left to right with a list of the edges it cuts,
    /// from low to high; `f` is told the list's length at each node.
    pub fn sweep(&mut self, mut f: impl FnMut(Point<C>, usize)) {
        let nodes = self.nodes;
        let mut order: Vec<u32> = (0..nodes.len() as u32).collect();
        order.sort_unstable_by_key(|&n| nodes[n as usize]);
        let mut active: Vec<u32> = Vec::new();
        for n in order {
            let p = nodes[n as usize];
            let side = |e: u32| {
                let edge = &self.edges[e as usize];
                cross(nodes[edge.low as usize], nodes[edge.high as usize], p)
            };
            // Edges strictly below the node come first, then those that end at it.
            let start = active.partition_point(|&e| side(e) > C::Wide::default());
            let end = start + self.ins(n).len();
            let mut winding = match start.checked_sub(1).and_then(|i| active.get(i)) {
                Some(&below) => self.edges[below as usize].left(),
                None => Winding::default(),
            };
            for e in self.outs(n) {
                self.edges[e].right = winding;
                winding = self.edges[e].left();
            }
            active.splice(start..end.min(active.len()), self.outs(n).map(|e| e as u32));
            f(p, active.len());
        }
    }

    /// Sets windings relative to some face of each connected part. Of each part: its first node
    /// and the relative winding to the left of that; and the part of each node.
    fn walk(&mut self) -> (Vec<(u32, Winding)>, Vec<u32>) {
        const UNSEEN: u32 = u32::MAX;
        let mut part_of = vec![UNSEEN; self.nodes.len()];
        let mut parts = Vec::new();
        let mut stack: Vec<(u32, Winding)> = Vec::new();
        for root in 0..self.nodes.len() as u32 {
            if part_of[root as usize] != UNSEEN
                || (self.outs(root).is_empty() && self.ins(root).is_empty())
            {
                continue;
            }
            let part = parts.len() as u32;
            let mut first = (root, Winding::default());
            part_of[root as usize] = part;
            stack.push(first);
            while let Some((node, below)) = stack.pop() {
                if self.nodes[node as usize] < self.nodes[first.0 as usize] {
                    first = (node, below);
                }
                self.turn(node, below, |next, winding| {
                    if part_of[next as usize] == UNSEEN {
                        part_of[next as usize] = part;
                        stack.push((next, winding));
                    }
                });
            }
            parts.push(first);
        }
        (parts, part_of)
    }

    /// Goes around a node counter-clockwise, from straight down, sets the windings of its edges, and
    /// tells `f` every neighbour with the winding straight below that.
    fn turn(&mut self, node: u32, below: Winding, mut f: impl FnMut(u32, Winding)) {
        let mut winding = below;
        for e in self.outs(node) {
            let edge = &mut self.edges[e];
            edge.right = winding;
            winding = winding.plus(edge.step);
        }
        for k in self.in_starts[node as usize]..self.in_starts[node as usize + 1] {
            let edge = &mut self.edges[self.ins[k as usize] as usize];
            winding = winding.minus(edge.step);
            edge.right = winding;
        }
        for e in self.outs(node) {
            let high = self.edges[e].high;
            let below = self.below_high(e, high);
            f(high, below);
        }
        for k in self.in_starts[node as usize]..self.in_starts[node as usize + 1] {
            let edge = self.edges[self.ins[k as usize] as usize];
            let first = self.outs(edge.low);
            // Straight below the lower node is what lies right of its first edge.
            let mut winding = edge.right;
            for other in first {
                if self.edges[other].high == edge.high {
                    break;
                }
                winding = winding.minus(self.edges[other].step);
            }
            f(edge.low, winding);
        }
    }

    /// The winding straight below the upper node of an edge whose own winding is known.
    fn below_high(&self, edge: usize, high: u32) -> Winding {
        // Counter-clockwise after an incoming edge is its right side; the edges after it follow.
        let ins = self.ins(high);
        let at = ins.iter().position(|&e| e as usize == edge).unwrap_or(0);
        let start = self.edges[edge].right;
        ins[at + 1..].iter().fold(start, |w, &e| w.minus(self.edges[e as usize].step))
    }
}

/// Finds the edge below a node by walking down the grid.
#[derive(Debug)]
pub struct Search<'a, C> {
    pub grid: &'a Grid,
    pub segments: &'a [Segment<C>],
    pub noding: &'a Noding<C>,
}

impl<C: Coord> Search<'_, C> {
    /// Of the edges that pass just left of a node, strictly below it, and that `take` accepts, the
    /// highest one.
    pub fn below(
        &self,
        graph: &Arrangement<C>,
        node: u32,
        take: impl Fn(usize) -> bool,
    ) -> Option<usize> {
        let p = graph.nodes[node as usize];
        let (x, mut y) = (p.x.i64(), p.y.i64());
        let mut best = None;
        while let Some((block, items)) = self.grid.locate(x, y) {
            self.highest(graph, items, p, &take, &mut best);
            let reached = best.is_some_and(|e: usize| {
                let edge = graph.edges[e];
                let floor = Point { x: p.x, y: C::from_i64(block.min.1) };
                let (a, b) = (graph.nodes[edge.low as usize], graph.nodes[edge.high as usize]);
                cross(a, b, floor) <= C::Wide::default()
            });
            if reached {
                break;
            }
            y = block.min.1 - 1;
        }
        best
    }

    fn highest(
        &self,
        graph: &Arrangement<C>,
        items: &[u32],
        p: Point<C>,
        take: &impl Fn(usize) -> bool,
        best: &mut Option<usize>,
    ) {
        for &i in items {
            let s = &self.segments[i as usize];
            if s.a.x >= p.x || s.b.x < p.x || s.y_range().0 > p.y {
                continue;
            }
            let Some(e) = self.edge_before(graph, i as usize, p.x) else { continue };
            let edge = &graph.edges[e];
            let (a, b) = (graph.nodes[edge.low as usize], graph.nodes[edge.high as usize]);
            if cross(a, b, p) > C::Wide::default()
                && take(e)
                && best.is_none_or(|top| graph.above(e, top))
            {
                *best = Some(e);
            }
        }
    }

    /// The edge of a segment that passes just left of x, if it has not cancelled.
    fn edge_before(&self, graph: &Arrangement<C>, segment: usize, x: C) -> Option<usize> {
        let chain = self.noding.chain(segment);
        let k = chain.partition_point(|&n| graph.nodes[n as usize].x < x);
        let (low, high) = (*chain.get(k.checked_sub(1)?)?, *chain.get(k)?);
        graph.outs(low).find(|&e| graph.edges[e].high == high)
    }
}

impl<C: Coord> Arrangement<'_, C> {
    /// Whether edge e is above edge f, where both pass one x and neither is vertical.
    fn above(&self, e: usize, f: usize) -> bool {
        let ends = |i: usize| {
            let edge = &self.edges[i];
            (self.nodes[edge.low as usize], self.nodes[edge.high as usize])
        };
        let ((a, b), (c, d)) = (ends(e), ends(f));
        let zero = C::Wide::default();
        if a >= c {
            let side = cross(c, d, a).cmp(&zero).then_with(|| cross(c, d, b).cmp(&zero));
            side == Ordering::Greater
        } else {
            let side = cross(a, b, c).cmp(&zero).then_with(|| cross(a, b, d).cmp(&zero));
            side == Ordering::Less
        }
    }
}
