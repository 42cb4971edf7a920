//! The winding numbers of subject and clip on both sides of every edge of the graph.

use super::arrangement::{Arrangement, Half, NONE, Patch, Winding};
use super::lattice::{Coord, Point, cross};
use super::parallel;
use super::search::Search;

/// A connected part of the graph, or of what one patch has of it.
#[derive(Debug, Clone, Copy)]
struct Part<C> {
    /// Its smallest point.
    first: Point<C>,
    node: u32,
    /// The relative winding to the left of that.
    outside: Winding,
    /// The part that it belongs to; itself until they are joined.
    parent: u32,
    /// What is added to its windings to make them relative to its parent's.
    offset: Winding,
}

/// What the walk through a patch finds.
struct Walked<C> {
    parts: Vec<Part<C>>,
    /// Edges that come from other patches, the part that each meets here, and the winding to its
    /// right relative to that part.
    links: Vec<(u32, u32, Winding)>,
}

impl<C: Coord> Arrangement<'_, C> {
    /// Finds the winding numbers: relative ones within each connected part by walking its nodes,
    /// then for each part, from left to right, those around it from the edge below its first node.
    ///
    /// Each patch is walked on its own; where parts of patches meet, their windings tell by how
    /// much one is to be raised.
    #[inline(never)]
    pub fn wind(&mut self, search: &Search<C>) {
        let (mut part_of, walked, mut right) = self.walk();
        let part_ends = parallel::ends(walked.iter().map(|w| w.parts.len()));
        let first_part = |patch: usize| parallel::range(&part_ends, patch).start as u32;
        let mut parts = Vec::with_capacity(part_ends.last().copied().unwrap_or(0) as usize);
        for (patch, walked) in walked.iter().enumerate() {
            let first = first_part(patch);
            parts.extend(walked.parts.iter().map(|p| Part { parent: first + p.parent, ..*p }));
        }
        for (patch, walked) in walked.iter().enumerate() {
            for &(e, part, winding) in &walked.links {
                let low = self.edges[e as usize].low;
                let other = first_part(self.patch_of(low)) + part_of[low as usize];
                let raise = right[e as usize].minus(winding);
                unite(&mut parts, other, first_part(patch) + part, raise);
            }
        }
        (0..parts.len() as u32).for_each(|p| {
            let (parent, offset) = find(&parts, p);
            let part = &mut parts[p as usize];
            (part.parent, part.offset) = (parent, offset);
        });
        self.right = std::mem::take(&mut right);
        let around = self.surround(search, &parts, |node| {
            first_part(self.patch_of(node)) + part_of[node as usize]
        });
        self.raise(&parts, &around, &part_ends, &mut part_of);
    }

    /// The windings relative to each joined part.
    fn surround(
        &self,
        search: &Search<C>,
        parts: &[Part<C>],
        part_of: impl Fn(u32) -> u32,
    ) -> Vec<Winding> {
        let mut firsts: Vec<Option<Part<C>>> = vec![None; parts.len()];
        for part in parts {
            let first = &mut firsts[part.parent as usize];
            if first.is_none_or(|first| part.first < first.first) {
                *first = Some(*part);
            }
        }
        let mut order: Vec<Part<C>> = firsts.into_iter().flatten().collect();
        order.sort_unstable_by_key(|part| part.first);
        let tasks = order.chunks(SEARCHES).collect();
        let below = parallel::map(tasks, |some: &[Part<C>]| {
            some.iter().map(|part| search.below(self, part.node, |_| true)).collect::<Vec<_>>()
        });
        let mut around = vec![Winding::default(); parts.len()];
        for (part, below) in order.iter().zip(below.into_iter().flatten()) {
            let outer = below.map_or(Winding::default(), |half| {
                // Windings beside an edge are relative to the part of its low node.
                let other = &parts[part_of(self.edges[half.edge()].low) as usize];
                self.left_of(half).plus(other.offset).plus(around[other.parent as usize])
            });
            around[part.parent as usize] = outer.minus(part.outside.plus(part.offset));
        }
        around
    }

    /// Makes the windings of all edges absolute.
    fn raise(
        &mut self,
        parts: &[Part<C>],
        around: &[Winding],
        part_ends: &[u32],
        part_of: &mut [u32],
    ) {
        let mut right = std::mem::take(&mut self.right);
        let edge_ends = self.edge_ends();
        let tasks = parallel::cut(&mut right, &edge_ends).into_iter().enumerate().collect();
        parallel::map(tasks, |(k, right): (usize, &mut [Winding])| {
            let parts = &parts[parallel::range(part_ends, k)];
            for (right, edge) in right.iter_mut().zip(&self.edges[self.patches[k].edges.clone()]) {
                let part = &parts[part_of[edge.low as usize] as usize];
                *right = right.plus(part.offset).plus(around[part.parent as usize]);
            }
        });
        self.right = right;
    }

    /// Finds the winding numbers by a sweep from left to right with a list of the edges it cuts,
    /// from low to high; `f` is told the list's length at each node. All edges must be straight.
    pub fn sweep(&mut self, mut f: impl FnMut(Point<C>, usize)) {
        let nodes = self.nodes;
        self.right = vec![Winding::default(); self.edges.len()];
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
                Some(&below) => self.left(below as usize),
                None => Winding::default(),
            };
            for &e in &outs {
                self.right[e as usize] = winding;
                winding = self.left(e as usize);
            }
            active.splice(start..end.min(active.len()), outs.iter().copied());
            f(p, active.len());
        }
    }

    /// Sets windings relative to some face of each patch's part. Gives for each node its part of
    /// its patch, what was found in each patch, and for each edge the winding on its right.
    #[inline(never)]
    fn walk(&self) -> (Vec<u32>, Vec<Walked<C>>, Vec<Winding>) {
        let mut part_of = vec![NONE; self.nodes.len()];
        let mut right = vec![Winding::default(); self.edges.len()];
        let node_ends = self.node_ends();
        let edge_ends = self.edge_ends();
        let parts = parallel::cut(&mut part_of, &node_ends).into_iter();
        let rights = parallel::cut(&mut right, &edge_ends).into_iter();
        let tasks = self.patches.iter().zip(parts.zip(rights));
        let walked = parallel::map(tasks.collect(), |(patch, (part_of, right))| {
            let walked = Walked { parts: Vec::new(), links: Vec::new() };
            Walk { graph: self, patch, part_of, right, walked }.run()
        });
        (part_of, walked, right)
    }
}

/// How many searches one task does.
const SEARCHES: usize = if cfg!(test) { 2 } else { 64 };

/// The part that a part belongs to, and what makes its windings relative to that one's.
fn find<C: Copy>(parts: &[Part<C>], mut part: u32) -> (u32, Winding) {
    let mut offset = Winding::default();
    while parts[part as usize].parent != part {
        offset = offset.plus(parts[part as usize].offset);
        part = parts[part as usize].parent;
    }
    (part, offset)
}

/// Joins two parts: `raise` makes windings relative to `second` relative to `first`.
fn unite<C: Copy>(parts: &mut [Part<C>], first: u32, second: u32, raise: Winding) {
    let ((a, to_a), (b, to_b)) = (find(parts, first), find(parts, second));
    // w + raise + to_a = (w + to_b) + offset of b
    let offset = raise.plus(to_a).minus(to_b);
    let (child, parent, offset) = match a.cmp(&b) {
        std::cmp::Ordering::Equal => return,
        std::cmp::Ordering::Less => (b, a, offset),
        std::cmp::Ordering::Greater => (a, b, Winding::default().minus(offset)),
    };
    (parts[child as usize].parent, parts[child as usize].offset) = (parent, offset);
    // Short ways for those that are looked for often.
    for (part, root) in [(first, a), (second, b)] {
        if part != root && part != child {
            let (parent, offset) = find(parts, part);
            (parts[part as usize].parent, parts[part as usize].offset) = (parent, offset);
        }
    }
}

/// The walk through one patch.
struct Walk<'a, 'b, C> {
    graph: &'a Arrangement<'b, C>,
    patch: &'a Patch,
    /// Of the patch's nodes.
    part_of: &'a mut [u32],
    /// Of the patch's edges.
    right: &'a mut [Winding],
    walked: Walked<C>,
}

impl<C: Coord> Walk<'_, '_, C> {
    fn run(mut self) -> Walked<C> {
        let graph = self.graph;
        // In waves, not in depth: what a wave touches, the next one finds in the cache.
        let (mut wave, mut next) = (Vec::new(), Vec::new());
        for root in self.patch.nodes.clone() {
            let known = self.part_of[root - self.patch.nodes.start] != NONE;
            let root = root as u32;
            if known || graph.around(root).is_empty() {
                continue;
            }
            let name = self.walked.parts.len() as u32;
            let (outside, offset) = (Winding::default(), Winding::default());
            let first = graph.nodes[root as usize];
            self.walked.parts.push(Part { first, node: root, outside, parent: name, offset });
            self.part_of[root as usize - self.patch.nodes.start] = name;
            self.go_on(graph.around(root), Winding::default(), &mut wave);
            while !wave.is_empty() {
                for half in wave.drain(..) {
                    self.turn(half, &mut next);
                }
                std::mem::swap(&mut wave, &mut next);
            }
        }
        self.walked
    }

    /// Goes around the node that a half-edge leaves, whose edge's windings are known.
    #[inline(always)]
    fn turn(&mut self, known: Half, next: &mut Vec<Half>) {
        let (graph, e) = (self.graph, known.edge());
        let node = graph.start(known);
        let around = graph.around(node);
        let at = around.iter().position(|&half| half == known).unwrap_or(0);
        let right = self.right[e - self.patch.edges.start];
        let left = right.plus(graph.edges[e].step);
        let after = if known.is_back() { right } else { left };
        if !known.is_back() {
            self.first_within(e, right, left);
        }
        let below = self.go_on(&around[at + 1..], after, next);
        let point = graph.nodes[node as usize];
        if let Some(part) = self.walked.parts.last_mut()
            && point < part.first
        {
            (part.first, part.node, part.outside) = (point, node, below);
        }
        self.go_on(&around[..at], below, next);
    }

    /// Goes on counter-clockwise around a node, sets the windings of the edges there, and takes
    /// their other ends for the next wave. Gives the winding behind the last one.
    #[inline(always)]
    fn go_on(&mut self, around: &[Half], before: Winding, next: &mut Vec<Half>) -> Winding {
        let graph = self.graph;
        let name = self.walked.parts.len() as u32 - 1;
        let mut winding = before;
        for &half in around {
            let e = half.edge();
            let edge = &graph.edges[e];
            let end = if half.is_back() {
                winding = winding.minus(edge.step);
                if !self.patch.has_edge(e) {
                    self.walked.links.push((e as u32, name, winding));
                    continue;
                }
                self.right[e - self.patch.edges.start] = winding;
                edge.low
            } else {
                let right = winding;
                self.right[e - self.patch.edges.start] = right;
                winding = winding.plus(edge.step);
                self.first_within(e, right, winding);
                edge.high
            };
            let place = (end as usize).wrapping_sub(self.patch.nodes.start);
            if let Some(part) = self.part_of.get_mut(place)
                && *part == NONE
            {
                *part = name;
                next.push(half.reversed());
            }
        }
        winding
    }

    /// Looks for the part's smallest point among an edge's inner nodes.
    fn first_within(&mut self, e: usize, right: Winding, left: Winding) {
        let (nodes, inner) = (self.graph.nodes, self.graph.inner(e));
        let Some(k) = (0..inner.len()).min_by_key(|&k| nodes[inner[k] as usize]) else { return };
        let first = nodes[inner[k] as usize];
        let Some(part) = self.walked.parts.last_mut() else { return };
        if first < part.first {
            let edge = &self.graph.edges[e];
            let before = k.checked_sub(1).map_or(edge.low, |k| inner[k]);
            let after = inner.get(k + 1).copied().unwrap_or(edge.high);
            // Both neighbours lie to the right; outside is on the other side of the wedge.
            let turn = cross(nodes[before as usize], first, nodes[after as usize]);
            let outside = if turn > C::Wide::default() { right } else { left };
            (part.first, part.node, part.outside) = (first, inner[k], outside);
        }
    }
}
