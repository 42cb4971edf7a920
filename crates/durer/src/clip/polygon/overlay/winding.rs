//! The winding numbers of subject and clip on both sides of every edge of the graph.

use super::arrangement::{Arrangement, Half, NONE, Winding};
use super::lattice::{Coord, Point, cross};
use super::search::Search;

/// A connected part of the graph.
#[derive(Debug, Clone, Copy)]
struct Part<C> {
    /// Its smallest point.
    first: Point<C>,
    node: u32,
    /// The relative winding to the left of that.
    outside: Winding,
}

impl<C: Coord> Arrangement<'_, C> {
    /// Finds the winding numbers: relative ones within each connected part by walking its nodes,
    /// then for each part, from left to right, those around it from the edge below its first node.
    #[inline(never)]
    pub fn wind(&mut self, search: &Search<C>) {
        let (parts, part_of) = self.walk();
        let mut order: Vec<u32> = (0..parts.len() as u32).collect();
        order.sort_unstable_by_key(|&p| parts[p as usize].first);
        let mut around = vec![Winding::default(); parts.len()];
        for p in order {
            let part = &parts[p as usize];
            let below = search.below(self, part.node, |_| true);
            let outer = below.map_or(Winding::default(), |half| {
                let other = part_of[self.start(half) as usize];
                self.left_of(half).plus(around[other as usize])
            });
            around[p as usize] = outer.minus(part.outside);
        }
        for e in &mut self.edges {
            e.right = e.right.plus(around[part_of[e.low as usize] as usize]);
        }
    }

    /// Finds the winding numbers by a sweep from left to right with a list of the edges it cuts,
    /// from low to high; `f` is told the list's length at each node. All edges must be straight.
    pub fn sweep(&mut self, mut f: impl FnMut(Point<C>, usize)) {
        let nodes = self.nodes;
        let mut order: Vec<u32> = (0..nodes.len() as u32).collect();
        order.sort_unstable_by_key(|&n| nodes[n as usize]);
        let mut active: Vec<u32> = Vec::new();
        let mut outs: Vec<u32> = Vec::new();
        for n in order {
            let p = nodes[n as usize];
            let side = |e: u32| {
                let edge = &self.edges[e as usize];
                cross(nodes[edge.low as usize], nodes[edge.high as usize], p)
            };
            // Edges strictly below the node come first, then those that end at it.
            let start = active.partition_point(|&e| side(e) > C::Wide::default());
            let around = self.around(n);
            let end = start + around.iter().filter(|half| half.is_back()).count();
            outs.clear();
            outs.extend(
                around.iter().filter(|half| !half.is_back()).map(|half| half.edge() as u32),
            );
            let mut winding = match start.checked_sub(1).and_then(|i| active.get(i)) {
                Some(&below) => self.edges[below as usize].left(),
                None => Winding::default(),
            };
            for &e in &outs {
                self.edges[e as usize].right = winding;
                winding = self.edges[e as usize].left();
            }
            active.splice(start..end.min(active.len()), outs.iter().copied());
            f(p, active.len());
        }
    }

    /// Sets windings relative to some face of each connected part. Gives the parts, and the part
    /// of each node.
    #[inline(never)]
    fn walk(&mut self) -> (Vec<Part<C>>, Vec<u32>) {
        let mut part_of = vec![NONE; self.nodes.len()];
        let mut parts = Vec::new();
        // In waves, not in depth: what a wave touches, the next one finds in the cache.
        let (mut wave, mut next) = (Vec::new(), Vec::new());
        for root in 0..self.nodes.len() as u32 {
            if part_of[root as usize] != NONE || self.around(root).is_empty() {
                continue;
            }
            let name = parts.len() as u32;
            let outside = Winding::default();
            let mut part = Part { first: self.nodes[root as usize], node: root, outside };
            part_of[root as usize] = name;
            wave.push((root, outside));
            while !wave.is_empty() {
                for (node, below) in wave.drain(..) {
                    if self.nodes[node as usize] < part.first {
                        part = Part { first: self.nodes[node as usize], node, outside: below };
                    }
                    self.turn(node, below, &mut part);
                    for &half in self.around(node) {
                        let end = self.start(half.reversed());
                        if part_of[end as usize] == NONE {
                            part_of[end as usize] = name;
                            next.push((end, self.below(end, half.reversed())));
                        }
                    }
                }
                std::mem::swap(&mut wave, &mut next);
            }
            parts.push(part);
        }
        (parts, part_of)
    }

    /// Goes around a node counter-clockwise, from straight down, and sets the windings of its edges.
    fn turn(&mut self, node: u32, below: Winding, part: &mut Part<C>) {
        let mut winding = below;
        for k in self.range(node) {
            let half = self.half(k);
            let edge = &mut self.edges[half.edge()];
            if half.is_back() {
                winding = winding.minus(edge.step);
                edge.right = winding;
            } else {
                edge.right = winding;
                winding = winding.plus(edge.step);
                self.first_within(half.edge(), part);
            }
        }
    }

    /// Looks for the part's smallest point among an edge's inner nodes.
    fn first_within(&self, e: usize, part: &mut Part<C>) {
        let (nodes, inner, edge) = (self.nodes, self.inner(e), &self.edges[e]);
        let Some(k) = (0..inner.len()).min_by_key(|&k| nodes[inner[k] as usize]) else { return };
        let first = nodes[inner[k] as usize];
        if first < part.first {
            let before = k.checked_sub(1).map_or(edge.low, |k| inner[k]);
            let after = inner.get(k + 1).copied().unwrap_or(edge.high);
            // Both neighbours lie to the right; outside is on the other side of the wedge.
            let turn = cross(nodes[before as usize], first, nodes[after as usize]);
            let outside = if turn > C::Wide::default() { edge.right } else { edge.left() };
            *part = Part { first, node: inner[k], outside };
        }
    }

    /// The winding straight below a node, from the known windings beside one of its half-edges.
    fn below(&self, node: u32, known: Half) -> Winding {
        let edge = &self.edges[known.edge()];
        let mut winding = if known.is_back() { edge.left() } else { edge.right };
        for &half in self.around(node).iter().take_while(|&&half| half != known) {
            let step = self.edges[half.edge()].step;
            winding = if half.is_back() { winding.plus(step) } else { winding.minus(step) };
        }
        winding
    }
}
