//! The winding numbers of subject and clip on both sides of every edge of the graph.

use super::arrangement::{Arrangement, NONE, Patch};
use super::edge::{Half, Winding};
use super::lattice::{Coord, Point, cross};
use super::parallel;
use super::search::Search;

/// A connected part of the graph, or of its portion in one patch.
#[derive(Debug, Clone, Copy)]
struct Part<C> {
    /// Its smallest point.
    first: Point<C>,
    node: u32,
    /// The relative winding to the left of that.
    outside: Winding,
    /// The part that it belongs to; itself until they are joined.
    parent: u32,
    /// Offset that makes its windings relative to its parent's.
    offset: Winding,
}

/// Result of the walk through a patch.
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
    /// Each patch is walked on its own; where parts of patches meet, the difference of their winding numbers is added
    /// to one of them.
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
            let (parent, offset) = find(&mut parts, p);
            let part = &mut parts[p as usize];
            (part.parent, part.offset) = (parent, offset);
        });
        self.right = std::mem::take(&mut right);
        let around = self.surround(search, &parts, |node| {
            first_part(self.patch_of(node)) + part_of[node as usize]
        });
        self.raise(&parts, &around, &part_ends, &mut part_of);
    }

    /// Returns the windings relative to each joined part.
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
            search.below_each(self, some.iter().map(|part| part.node), |_| true)
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
            let raise = |part: &Part<C>| part.offset.plus(around[part.parent as usize]);
            if parts.iter().all(|part| raise(part) == Winding::default()) {
                return;
            }
            for (right, edge) in right.iter_mut().zip(&self.edges[self.patches[k].edges.clone()]) {
                let part = &parts[part_of[edge.low as usize] as usize];
                *right = right.plus(raise(part));
            }
        });
        self.right = right;
    }

    /// Finds the winding numbers by a sweep from left to right with a list of the edges it cuts,
    /// from low to high; `f` is called with the length of the list at each node. All edges must be
    /// straight.
    pub fn sweep(&mut self, f: &mut dyn FnMut(Point<C>, usize)) {
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

    /// Sets windings relative to some face of each patch's part. Returns for each node its part of its patch, the
    /// results of the walks through the patches, and for each edge the winding on its right.
    #[inline(never)]
    fn walk(&self) -> (Vec<u32>, Vec<Walked<C>>, Vec<Winding>) {
        let mut part_of = parallel::filled(NONE, self.nodes.len());
        let mut right = parallel::filled(Winding::default(), self.edges.len());
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

/// Number of searches in one task.
const SEARCHES: usize = if cfg!(test) { 2 } else { 64 };

/// Returns the part that a part belongs to, and the difference of their winding numbers. Halves the path there.
fn find<C: Copy>(parts: &mut [Part<C>], mut part: u32) -> (u32, Winding) {
    let mut offset = Winding::default();
    while parts[part as usize].parent != part {
        let parent = parts[parts[part as usize].parent as usize];
        let here = &mut parts[part as usize];
        if parent.parent != here.parent {
            (here.parent, here.offset) = (parent.parent, here.offset.plus(parent.offset));
        }
        offset = offset.plus(here.offset);
        part = here.parent;
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
}

/// The walk through one patch, node by node in the order of storage: mostly from left to right, so that nearly every
/// node has neighbours before it from which its winding number follows.
struct Walk<'a, 'b, C> {
    graph: &'a Arrangement<'b, C>,
    patch: &'a Patch,
    /// Part of each of the patch's nodes.
    part_of: &'a mut [u32],
    /// Winding on the right of each of the patch's edges, relative to the part of the end that
    /// comes first.
    right: &'a mut [Winding],
    walked: Walked<C>,
}

impl<C: Coord> Walk<'_, '_, C> {
    fn run(mut self) -> Walked<C> {
        for node in self.patch.nodes.clone() {
            let around = self.graph.around(node as u32);
            if !around.is_empty() {
                self.turn(node as u32, around);
            }
        }
        self.walked
    }

    /// Goes around a node and sets the windings of the edges there that are not known yet.
    #[inline(always)]
    fn turn(&mut self, node: u32, around: &[Half]) {
        let (name, below) = self.known(node, around).unwrap_or_else(|| self.new_part(node));
        self.part_of[node as usize - self.patch.nodes.start] = name;
        self.first_at(name, node, below);
        let mut winding = below;
        for &half in around.iter().rev() {
            let step = self.step(half, winding);
            let (e, inside) = (half.edge(), self.patch.has_edge(half.edge()));
            if self.is_before(step.end, node) {
                let other = self.part_of[step.end as usize - self.patch.nodes.start];
                let right = &mut self.right[e - self.patch.edges.start];
                if other != name {
                    unite(&mut self.walked.parts, name, other, step.right.minus(*right));
                }
                if !half.is_back() {
                    *right = step.right;
                }
            } else if !inside {
                self.walked.links.push((e as u32, name, step.right));
            } else if !half.is_back() || step.end != node {
                self.right[e - self.patch.edges.start] = step.right;
                self.first_within(name, e, step.right);
            }
            winding = step.next;
        }
    }

    /// Returns the part of a neighbour that was there before, and the winding straight below the
    /// node relative to that part.
    #[inline(always)]
    fn known(&self, node: u32, around: &[Half]) -> Option<(u32, Winding)> {
        let mut winding = Winding::default();
        for &half in around.iter().rev() {
            let step = self.step(half, winding);
            if self.is_before(step.end, node) {
                let name = self.part_of[step.end as usize - self.patch.nodes.start];
                let right = self.right[half.edge() - self.patch.edges.start];
                return Some((name, right.minus(step.right)));
            }
            winding = step.next;
        }
        None
    }

    /// Starts a part at a node; windings are relative to that below the node.
    fn new_part(&mut self, node: u32) -> (u32, Winding) {
        let parent = self.walked.parts.len() as u32;
        let (outside, offset) = (Winding::default(), Winding::default());
        let first = self.graph.nodes[node as usize];
        self.walked.parts.push(Part { first, node, outside, parent, offset });
        (parent, outside)
    }

    /// Returns whether the walk was at this node of the patch before it came to the other one.
    #[inline(always)]
    fn is_before(&self, node: u32, other: u32) -> bool {
        node < other && node as usize >= self.patch.nodes.start
    }

    /// Passes a half-edge clockwise, from the winding on its counter-clockwise side.
    #[inline(always)]
    fn step(&self, half: Half, winding: Winding) -> Step {
        let edge = &self.graph.edges[half.edge()];
        if half.is_back() {
            Step { right: winding, next: winding.plus(edge.step), end: edge.low }
        } else {
            let right = winding.minus(edge.step);
            Step { right, next: right, end: edge.high }
        }
    }

    /// Records a node as the part's smallest point if it is.
    #[inline(always)]
    fn first_at(&mut self, name: u32, node: u32, outside: Winding) {
        let (point, part) =
            (self.graph.nodes[node as usize], &mut self.walked.parts[name as usize]);
        if point < part.first {
            (part.first, part.node, part.outside) = (point, node, outside);
        }
    }

    /// Searches for the part's smallest point among an edge's inner nodes.
    #[inline(always)]
    fn first_within(&mut self, name: u32, e: usize, right: Winding) {
        let (nodes, inner) = (self.graph.nodes, self.graph.inner(e));
        let Some(k) = (0..inner.len()).min_by_key(|&k| nodes[inner[k] as usize]) else { return };
        let first = nodes[inner[k] as usize];
        if first < self.walked.parts[name as usize].first {
            let edge = &self.graph.edges[e];
            let before = k.checked_sub(1).map_or(edge.low, |k| inner[k]);
            let after = inner.get(k + 1).copied().unwrap_or(edge.high);
            // Both neighbours lie to the right; outside is on the other side of the wedge.
            let turn = cross(nodes[before as usize], first, nodes[after as usize]);
            let outside = if turn > C::Wide::default() { right } else { right.plus(edge.step) };
            self.first_at(name, inner[k], outside);
        }
    }
}

/// Result of passing a half-edge.
struct Step {
    /// The winding on the right of its edge.
    right: Winding,
    /// The winding on the clockwise side.
    next: Winding,
    /// The node it goes to.
    end: u32,
}
