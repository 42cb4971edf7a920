//! The planar graph of the snapped segments: unique edges, their order around each node, and the
//! winding numbers of subject and clip on both sides of each edge.
//!
//! Most points of a coastline are on one ring and touched by nothing else. Such points are not nodes of the graph on
//! which winding numbers and rings are found, but inner points of its edges.

use std::ops::Range;

use super::edge::{Edge, Half, Winding};
use super::edges::{Edges, Rings};
use super::lattice::{Coord, Point, cross};
use super::noding::Noding;
use super::{Source, parallel};

pub(super) const NONE: u32 = u32::MAX;

/// The planar graph of the snapped segments.
///
/// Nodes are grouped into patches, and edges belong to the patch of their low node, so that each patch can be processed
/// alone except for the few edges that lead to other patches.
#[derive(Debug)]
pub struct Arrangement<'a, C> {
    pub nodes: &'a [Point<C>],
    pub edges: Vec<Edge>,
    /// Winding on the right of each edge; for an edge without inner nodes that is below, or to the
    /// right of a vertical one. Empty before it is found.
    pub right: Vec<Winding>,
    pub(super) patches: Vec<Patch>,
    inner: Vec<u32>,
    /// Range of each edge's inner nodes; empty if no edge has any.
    inner_of: Vec<[u32; 2]>,
    /// Index in `inner` of each inner node, `NONE` for the others; empty if there are no inner
    /// nodes.
    place: Vec<u32>,
    /// The edge of an inner node is that of the last start that is not above its place.
    inner_starts: Vec<(u32, u32)>,
    /// Starts of lists: the half-edges that leave node n are `around[starts[n]..starts[n + 1]]`,
    /// counter-clockwise from straight down.
    starts: Vec<u32>,
    around: Vec<Half>,
}

/// Nodes and edges that lie close together.
#[derive(Debug, Clone)]
pub struct Patch {
    pub nodes: Range<usize>,
    pub edges: Range<usize>,
}

impl Patch {
    #[inline(always)]
    pub fn has_node(&self, node: u32) -> bool {
        self.nodes.contains(&(node as usize))
    }

    #[inline(always)]
    pub fn has_edge(&self, edge: usize) -> bool {
        self.edges.contains(&edge)
    }
}

impl<'a, C: Coord> Arrangement<'a, C> {
    /// Builds the graph of rings, with inner nodes.
    pub fn of_rings(noding: &'a Noding<C>, rings: Rings) -> Self {
        let edges = Edges::of_rings(noding, rings);
        Self::build(noding, edges, |edge| edge.step != Winding::default())
    }

    /// Builds the graph of rings, every point a node, so that all edges are straight.
    pub fn of_straight(noding: &'a Noding<C>, sources: &[Source]) -> Self {
        let none = Winding::default();
        let step = |i: usize| {
            let across = sources[i].across();
            if sources[i].reversed() { none.minus(across) } else { across }
        };
        Self::build(noding, Edges::of_straight(noding, step), |edge| edge.step != none)
    }

    /// Builds the graph of segments that bound nothing; it keeps them all, as straight edges.
    pub fn of_lines(noding: &'a Noding<C>) -> Self {
        Self::build(noding, Edges::of_straight(noding, |_| Winding::default()), |_| true)
    }

    fn build(noding: &'a Noding<C>, edges: Edges, keeps: impl Fn(&Edge) -> bool) -> Self {
        let patches = (0..noding.patch_ends.len()).map(|k| Patch {
            nodes: parallel::range(&noding.patch_ends, k),
            edges: parallel::range(&edges.ends, k),
        });
        let mut graph = Self {
            nodes: &noding.nodes,
            edges: edges.list,
            right: Vec::new(),
            patches: patches.collect(),
            inner: edges.inner,
            inner_of: edges.inner_of,
            place: Vec::new(),
            inner_starts: Vec::new(),
            starts: Vec::new(),
            around: Vec::new(),
        };
        let joined = graph.arrange(&edges.arrivals);
        if !joined.is_empty() {
            graph.drop_unkept(&joined, keeps);
        }
        graph.find_places();
        graph
    }

    /// Returns the half-edges that leave a node, counter-clockwise from straight down: first those
    /// to the right or straight up, then those to the left or straight down.
    #[inline(always)]
    pub fn around(&self, node: u32) -> &[Half] {
        &self.around[self.range(node)]
    }

    /// Returns the indices, for [`Self::half`], of the half-edges that leave a node.
    #[inline(always)]
    pub(super) fn range(&self, node: u32) -> std::ops::Range<usize> {
        self.starts[node as usize] as usize..self.starts[node as usize + 1] as usize
    }

    /// Returns the nodes within an edge, from low to high.
    #[inline(always)]
    pub fn inner(&self, edge: usize) -> &[u32] {
        let [start, end] = self.inner_of.get(edge).copied().unwrap_or_default();
        &self.inner[start as usize..end as usize]
    }

    /// Returns the node a half-edge comes from.
    #[inline(always)]
    pub fn start(&self, half: Half) -> u32 {
        let edge = &self.edges[half.edge()];
        if half.is_back() { edge.high } else { edge.low }
    }

    /// Returns the first node or inner node along a half-edge.
    #[inline(always)]
    fn toward(&self, half: Half) -> u32 {
        let (edge, inner) = (&self.edges[half.edge()], self.inner(half.edge()));
        if half.is_back() {
            *inner.last().unwrap_or(&edge.low)
        } else {
            *inner.first().unwrap_or(&edge.high)
        }
    }

    /// Returns the winding on the left of an edge.
    #[inline(always)]
    pub fn left(&self, edge: usize) -> Winding {
        self.right[edge].plus(self.edges[edge].step)
    }

    /// Returns the winding on the left of a half-edge.
    #[inline(always)]
    pub fn left_of(&self, half: Half) -> Winding {
        if half.is_back() { self.right[half.edge()] } else { self.left(half.edge()) }
    }

    /// Returns the end of each patch's nodes.
    pub(super) fn node_ends(&self) -> Vec<u32> {
        self.patches.iter().map(|patch| patch.nodes.end as u32).collect()
    }

    /// Returns the end of each patch's edges.
    pub(super) fn edge_ends(&self) -> Vec<u32> {
        self.patches.iter().map(|patch| patch.edges.end as u32).collect()
    }

    /// Returns the patch of a node.
    pub(super) fn patch_of(&self, node: u32) -> usize {
        self.patches.partition_point(|patch| patch.nodes.end <= node as usize)
    }

    /// Returns the half-edge that goes from a node straight on to another one; `None` if those
    /// edges have cancelled.
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

    /// Returns the edge that has this place in `inner`.
    fn edge_at(&self, place: u32) -> usize {
        let next = self.inner_starts.partition_point(|&(start, _)| start <= place);
        self.inner_starts[next - 1].1 as usize
    }

    /// Returns the node that follows an inner node of an edge.
    fn beside(&self, place: u32, forward: Half) -> u32 {
        let [_, end] = self.inner_of[forward.edge()];
        let high = self.edges[forward.edge()].high;
        if place + 1 < end { self.inner[place as usize + 1] } else { high }
    }

    #[inline(never)]
    fn find_places(&mut self) {
        if self.inner.is_empty() {
            return;
        }
        self.place = parallel::filled(NONE, self.nodes.len());
        for (&node, place) in self.inner.iter().zip(0..) {
            self.place[node as usize] = place;
        }
        let with_inner = self.inner_of.iter().zip(0..).filter(|(inner, _)| inner[0] < inner[1]);
        self.inner_starts = with_inner.map(|(inner, e)| (inner[0], e)).collect();
        self.inner_starts.sort_unstable();
    }

    /// Sorts the edges around every node, and joins those that coincide in the first of them. Returns the others, which
    /// are no longer valid. `arrivals` are, for each patch, the edges of other patches that end there.
    #[inline(never)]
    fn arrange(&mut self, arrivals: &[Vec<u32>]) -> Vec<u32> {
        let leaving = |edge: &Edge, patch: &Patch| usize::from(!patch.has_node(edge.high));
        let counts =
            parallel::map(self.patches.iter().zip(arrivals).collect(), |(patch, arrivals)| {
                let edges = &self.edges[patch.edges.clone()];
                let leaving: usize = edges.iter().map(|edge| leaving(edge, patch)).sum();
                edges.len() * 2 - leaving + arrivals.len()
            });
        let ends = parallel::ends(counts.into_iter());
        let mut starts = vec![0u32; self.nodes.len() + 1];
        let mut around = parallel::filled(Half::default(), self.edges.len() * 2);
        starts[self.nodes.len()] = around.len() as u32;
        let node_ends = self.node_ends();
        let tasks = parallel::cut(&mut starts, &node_ends).into_iter();
        let tasks = tasks.zip(parallel::cut(&mut around, &ends)).zip(arrivals).enumerate();
        let joins = parallel::map(tasks.collect(), |(k, ((starts, around), arrivals))| {
            let first = parallel::range(&ends, k).start as u32;
            self.stars(&self.patches[k], arrivals, starts, around, first)
        });
        (self.starts, self.around) = (starts, around);
        let mut joined = Vec::new();
        for (first, other) in joins.into_iter().flatten() {
            let step = self.edges[other as usize].step;
            let edge = &mut self.edges[first as usize];
            edge.step = edge.step.plus(step);
            joined.push(other);
        }
        joined
    }

    /// Sorts the edges around the nodes of a patch; returns pairs of edges that coincide. The lists start at index
    /// `first` of all.
    fn stars(
        &self,
        patch: &Patch,
        arrivals: &[u32],
        starts: &mut [u32],
        around: &mut [Half],
        first: u32,
    ) -> Vec<(u32, u32)> {
        let place = |node: u32| node as usize - patch.nodes.start;
        let edges = || patch.edges.clone().zip(&self.edges[patch.edges.clone()]);
        for (_, edge) in edges() {
            starts[place(edge.low)] += 1;
            if patch.has_node(edge.high) {
                starts[place(edge.high)] += 1;
            }
        }
        arrivals.iter().for_each(|&e| starts[place(self.edges[e as usize].high)] += 1);
        let mut end = 0;
        for start in starts.iter_mut() {
            end += *start;
            *start = end;
        }
        let mut put = |node: u32, half: Half| {
            let next = &mut starts[place(node)];
            *next -= 1;
            around[*next as usize] = half;
        };
        // From the end of each list: mostly edges to the left first.
        for &e in arrivals {
            put(self.edges[e as usize].high, Half::forward(e as usize).reversed());
        }
        for (e, edge) in edges().filter(|(_, edge)| patch.has_node(edge.high)) {
            put(edge.high, Half::forward(e).reversed());
        }
        for (e, edge) in edges() {
            put(edge.low, Half::forward(e));
        }
        let mut joins = Vec::new();
        let mut star: Vec<Ray<C>> = Vec::new();
        for k in 0..starts.len() {
            let end = starts.get(k + 1).map_or(around.len(), |&end| end as usize);
            let halves = &mut around[starts[k] as usize..end];
            if halves.len() > 1 {
                let node = patch.nodes.start + k;
                star.clear();
                star.extend(halves.iter().map(|&half| self.ray(node, half)));
                sort_around(self.nodes[node], &mut star);
                halves.iter_mut().zip(&star).for_each(|(half, ray)| *half = ray.half);
                join(&star, &mut joins);
            }
        }
        starts.iter_mut().for_each(|start| *start += first);
        joins
    }

    #[inline(always)]
    fn ray(&self, node: usize, half: Half) -> Ray<C> {
        let toward = self.toward(half);
        let point = self.nodes[toward as usize];
        Ray { half, toward, point, left: point < self.nodes[node] }
    }

    /// Drops the edges that were joined with others, and those that cancel each other.
    #[inline(never)]
    fn drop_unkept(&mut self, joined: &[u32], keeps: impl Fn(&Edge) -> bool) {
        let mut kept = 0;
        let mut renamed = vec![0; self.edges.len()];
        joined.iter().for_each(|&e| renamed[e as usize] = NONE);
        for patch in &mut self.patches {
            let start = kept;
            for e in patch.edges.clone() {
                let edge = self.edges[e];
                let drops = renamed[e] == NONE || !keeps(&edge);
                renamed[e] = if drops { NONE } else { kept as u32 };
                if !drops {
                    self.edges[kept] = edge;
                    if let Some(&inner) = self.inner_of.get(e) {
                        self.inner_of[kept] = inner;
                    }
                    kept += 1;
                }
            }
            patch.edges = start..kept;
        }
        self.edges.truncate(kept);
        self.inner_of.truncate(kept);
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

/// A half-edge that leaves a node.
#[derive(Debug, Clone, Copy)]
struct Ray<C> {
    half: Half,
    toward: u32,
    point: Point<C>,
    /// True if it goes to the left or straight down.
    left: bool,
}

/// More edges than nodes have on usual data.
const MANY: usize = 8;

/// Sorts counter-clockwise from straight down. Nodes have few edges, and those are mostly in order.
#[inline(always)]
fn sort_around<C: Coord>(node: Point<C>, star: &mut [Ray<C>]) {
    let zero = C::Wide::default();
    let after = |r: &Ray<C>, s: &Ray<C>| match r.left == s.left {
        true => cross(node, r.point, s.point) < zero,
        false => r.left,
    };
    if star.len() > MANY {
        return star.sort_unstable_by(|r, s| {
            r.left.cmp(&s.left).then_with(|| zero.cmp(&cross(node, r.point, s.point)))
        });
    }
    for k in 1..star.len() {
        let ray = star[k];
        let mut place = k;
        while place > 0 && after(&star[place - 1], &ray) {
            star[place] = star[place - 1];
            place -= 1;
        }
        star[place] = ray;
    }
}

/// Finds the pairs of a sorted star that coincide. The other node finds the same pairs side by
/// side; one of the two is enough.
fn join<C: Coord>(star: &[Ray<C>], joins: &mut Vec<(u32, u32)>) {
    let mut first = 0;
    for k in 1..star.len() {
        if star[k].toward != star[first].toward {
            first = k;
        } else if !star[k].half.is_back() {
            joins.push((star[first].half.edge() as u32, star[k].half.edge() as u32));
        }
    }
}
