//! Cuts the segments at their nodes into edges of the graph, ring by ring, and sorts the edges by
//! the patch of their first node.

use std::ops::Range;

use super::edge::{Edge, Winding};
use super::lattice::Coord;
use super::noding::Noding;
use super::{Source, parallel};

/// Number of segments in one task: large enough to hide the cost of a task.
const TASK: usize = if cfg!(test) { 8 } else { 1 << 14 };

/// Segments that form rings.
#[derive(Debug, Clone, Copy)]
pub struct Rings<'a> {
    /// End of each ring among the segments.
    pub ends: &'a [u32],
    /// Source of each segment.
    pub sources: &'a [Source],
}

/// The edges of the graph, patch by patch.
#[derive(Debug)]
pub struct Edges {
    pub list: Vec<Edge>,
    /// End of each patch's edges.
    pub ends: Vec<u32>,
    /// The nodes within edges.
    pub inner: Vec<u32>,
    /// Range of each edge's inner nodes; empty if no edge has any.
    pub inner_of: Vec<[u32; 2]>,
    /// Edges of other patches whose high node is in the patch, by patch.
    pub arrivals: Vec<Vec<u32>>,
}

/// The edges that one task finds.
struct Batch<'a, C> {
    noding: &'a Noding<C>,
    edges: Vec<Edge>,
    /// Runs of edges in the same patch, each with its last edge: the next edge is likely to be in the same patch as the
    /// last one.
    runs: Vec<(u32, u32)>,
    /// The patch of the last edge, and its nodes.
    patch: (usize, Range<usize>),
    inner: Vec<u32>,
    /// Edges that have inner nodes, with the ranges of those.
    inner_of: Vec<(u32, [u32; 2])>,
}

/// Edges of one batch that follow one another and lie in one patch.
#[derive(Debug, Clone, Copy)]
struct Piece {
    batch: u32,
    start: u32,
    end: u32,
}

impl Piece {
    fn range(self) -> Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// Parts of a ring's ends that are joined with other parts.
#[derive(Debug)]
struct Loose {
    ring: usize,
    /// The first node that is not only passed, if there is one.
    first: Option<u32>,
    /// Edges before it.
    head: Vec<u32>,
    /// The last such node and the nodes after it.
    tail: Vec<u32>,
}

impl Edges {
    /// Returns the edges of rings; points on only one ring that nothing else touches are inner points of an edge.
    #[inline(never)]
    pub fn of_rings<C: Coord>(noding: &Noding<C>, rings: Rings) -> Self {
        let count = rings.sources.len();
        let (mut batches, loose): (Vec<_>, Vec<_>) =
            parallel::map(parallel::ranges(count, TASK), |range| {
                let mut batch = Batch::new(noding);
                batch.edges.reserve(noding.edges_of(&range));
                let loose = batch.rings(rings, range);
                batch.end_run();
                (batch, loose)
            })
            .into_iter()
            .unzip();
        let mut batch = Batch::new(noding);
        batch.join(rings, loose);
        batch.end_run();
        batches.push(batch);
        Self::merge(noding, batches)
    }

    /// Returns the straight edges of segments.
    pub fn of_straight<C: Coord>(
        noding: &Noding<C>,
        step: impl Fn(usize) -> Winding + Sync + Send,
    ) -> Self {
        let tasks = parallel::ranges(noding.starts.len() - 1, TASK);
        let batches = parallel::map(tasks, |range| {
            let mut batch = Batch::new(noding);
            batch.edges.reserve(noding.edges_of(&range));
            for i in range {
                for pair in noding.chain(i).windows(2) {
                    batch.straight(pair[0], pair[1], step(i));
                }
            }
            batch.end_run();
            batch
        });
        Self::merge(noding, batches)
    }

    fn merge<C: Coord>(noding: &Noding<C>, batches: Vec<Batch<C>>) -> Self {
        let mut pieces: Vec<Vec<Piece>> = vec![Vec::new(); noding.patch_ends.len()];
        for (batch, k) in batches.iter().zip(0..) {
            let mut start = 0;
            for &(patch, end) in &batch.runs {
                pieces[patch as usize].push(Piece { batch: k, start, end });
                start = end;
            }
        }
        let length = |pieces: &Vec<Piece>| pieces.iter().map(|p| p.range().len()).sum();
        let ends = parallel::ends(pieces.iter().map(length));
        let mut list =
            parallel::filled(Edge::default(), ends.last().copied().unwrap_or(0) as usize);
        let tasks = parallel::cut(&mut list, &ends).into_iter().zip(&pieces).enumerate();
        let leaving = parallel::map(tasks.collect(), |(patch, (list, pieces))| {
            place(list, pieces, |piece, list| {
                list.copy_from_slice(&batches[piece.batch as usize].edges[piece.range()]);
            });
            let first = parallel::range(&ends, patch).start;
            leaving(&list[..], first, &noding.patch_ends, patch)
        });
        let mut arrivals = vec![Vec::new(); pieces.len()];
        for (patch, edge) in leaving.into_iter().flatten() {
            arrivals[patch].push(edge);
        }
        let inner = parallel::concat(&batches.iter().map(|b| &b.inner[..]).collect::<Vec<_>>());
        let inner_of = match inner.is_empty() {
            true => Vec::new(),
            false => merge_inner(&batches, &pieces, &ends),
        };
        Self { list, ends, inner, inner_of, arrivals }
    }
}

/// Merges the ranges of each edge's inner nodes.
fn merge_inner<C: Coord>(
    batches: &[Batch<C>],
    pieces: &[Vec<Piece>],
    ends: &[u32],
) -> Vec<[u32; 2]> {
    let inner_ends = parallel::ends(batches.iter().map(|batch| batch.inner.len()));
    let mut inner_of = vec![[0; 2]; ends.last().copied().unwrap_or(0) as usize];
    let tasks = parallel::cut(&mut inner_of, ends).into_iter().zip(pieces);
    parallel::map(tasks.collect(), |(list, pieces): (&mut [[u32; 2]], &Vec<Piece>)| {
        place(list, pieces, |piece, list| {
            let offset = parallel::range(&inner_ends, piece.batch as usize).start as u32;
            let all = &batches[piece.batch as usize].inner_of;
            let first = all.partition_point(|&(edge, _)| edge < piece.start);
            for &(edge, inner) in all[first..].iter().take_while(|(edge, _)| *edge < piece.end) {
                list[(edge - piece.start) as usize] = inner.map(|place| place + offset);
            }
        });
    });
    inner_of
}

/// Fills a list piece by piece.
fn place<T>(mut list: &mut [T], pieces: &[Piece], fill: impl Fn(&Piece, &mut [T])) {
    for piece in pieces {
        let (here, rest) = list.split_at_mut(piece.range().len());
        fill(piece, here);
        list = rest;
    }
}

/// Returns the edges of a patch whose high node lies in another one, with the name of that one.
fn leaving(edges: &[Edge], first: usize, patch_ends: &[u32], patch: usize) -> Vec<(usize, u32)> {
    let nodes = parallel::range(patch_ends, patch);
    let far = (first as u32..).zip(edges).filter(|(_, e)| !nodes.contains(&(e.high as usize)));
    far.map(|(e, edge)| (patch_ends.partition_point(|&end| end <= edge.high), e)).collect()
}

impl<'a, C: Coord> Batch<'a, C> {
    fn new(noding: &'a Noding<C>) -> Self {
        let (edges, runs) = (Vec::new(), Vec::new());
        let (inner, inner_of) = (Vec::new(), Vec::new());
        Self { noding, edges, runs, patch: (0, 0..0), inner, inner_of }
    }

    /// Adds the edges of some segments; returns the parts of edges that go on in other ranges.
    fn rings(&mut self, rings: Rings, range: Range<usize>) -> Vec<Loose> {
        let mut loose = Vec::new();
        let mut path = Vec::new();
        let mut index = rings.ends.partition_point(|&end| end as usize <= range.start);
        let mut start = range.start;
        while start < range.end {
            let ring = parallel::range(rings.ends, index);
            let end = ring.end.min(range.end);
            path.clear();
            self.collect(rings, start..end, &mut path);
            let across = rings.sources[ring.start].across();
            if (start, end) == (ring.start, ring.end) {
                self.closed(&path, across);
            } else {
                let backward = (ring.start..start).rev().chain((start..ring.end).rev());
                let before = self.neighbour(rings, backward, true);
                let forward = (end..ring.end).chain(ring.start..end);
                let after = self.neighbour(rings, forward, false);
                loose.push(self.open(index, &path, before, after, across));
            }
            start = end;
            index += 1;
        }
        loose
    }

    /// Adds the nodes of consecutive segments of a ring in its direction, without the last one's end.
    fn collect(&self, rings: Rings, segments: Range<usize>, path: &mut Vec<u32>) {
        for i in segments {
            let chain = self.noding.chain(i);
            if rings.sources[i].reversed() {
                path.extend(chain.iter().skip(1).rev());
            } else {
                path.extend(&chain[..chain.len().saturating_sub(1)]);
            }
        }
    }

    /// Returns a node of the first of some segments that has nodes: its first one, or with `last` the one before its
    /// end.
    fn neighbour(
        &self,
        rings: Rings,
        mut segments: impl Iterator<Item = usize>,
        last: bool,
    ) -> Option<u32> {
        let i = segments.find(|&i| self.noding.chain(i).len() > 1)?;
        let chain = self.noding.chain(i);
        let k = match (last, rings.sources[i].reversed()) {
            (true, true) => 1,
            (true, false) => chain.len() - 2,
            (false, true) => chain.len() - 1,
            (false, false) => 0,
        };
        Some(chain[k])
    }

    /// Adds the edges of a whole ring.
    fn closed(&mut self, path: &[u32], across: Winding) {
        let count = path.len();
        if count < 2 {
            return;
        }
        let passed = &self.noding.passed;
        // A spike's tip is a node, so that its sides meet.
        let node = |k: usize| {
            let before = path[if k == 0 { count - 1 } else { k - 1 }];
            let after = path[if k + 1 == count { 0 } else { k + 1 }];
            !passed[path[k] as usize] || before == after
        };
        // A ring that nothing touches has any one of its points for a node.
        let first = (0..count).find(|&k| node(k)).unwrap_or(0);
        let mut from = first;
        for k in (first + 1..count).filter(|&k| node(k)) {
            self.edge(path[from], &path[from + 1..k], &[], path[k], across);
            from = k;
        }
        self.edge(path[from], &path[from + 1..], &path[..first], path[first], across);
    }

    /// Adds the edges between the nodes of a part of a ring; returns the nodes that belong to edges which continue in
    /// other parts.
    fn open(
        &mut self,
        ring: usize,
        path: &[u32],
        before: Option<u32>,
        after: Option<u32>,
        across: Winding,
    ) -> Loose {
        let node = |k: usize| {
            let before = if k == 0 { before } else { Some(path[k - 1]) };
            let after = path.get(k + 1).copied().or(after);
            !self.noding.passed[path[k] as usize] || before == after
        };
        let nodes: Vec<usize> = (0..path.len()).filter(|&k| node(k)).collect();
        for pair in nodes.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            self.edge(path[from], &path[from + 1..to], &[], path[to], across);
        }
        let (first, last) = (nodes.first().copied(), nodes.last().copied());
        let end = path.len();
        Loose {
            ring,
            first: first.map(|k| path[k]),
            head: path[..first.unwrap_or(end)].to_vec(),
            tail: path[last.unwrap_or(end)..].to_vec(),
        }
    }

    /// Joins the parts of rings that several tasks share.
    fn join(&mut self, rings: Rings, loose: Vec<Vec<Loose>>) {
        let loose: Vec<Loose> = loose.into_iter().flatten().collect();
        for parts in loose.chunk_by(|a, b| a.ring == b.ring) {
            let across = rings.sources[parallel::range(rings.ends, parts[0].ring).start].across();
            // From the last node on; before the first one from the ring's start on.
            let mut run: Vec<u32> = Vec::new();
            let mut start: Option<(Vec<u32>, u32)> = None;
            for part in parts {
                run.extend_from_slice(&part.head);
                let Some(first) = part.first else { continue };
                match start {
                    None => start = Some((std::mem::take(&mut run), first)),
                    Some(_) => self.edge(run[0], &run[1..], &[], first, across),
                }
                run.clone_from(&part.tail);
            }
            match start {
                Some((head, first)) => self.edge(run[0], &run[1..], &head, first, across),
                None if run.len() > 1 => self.edge(run[0], &run[1..], &[], run[0], across),
                None => {}
            }
        }
    }

    fn edge(&mut self, from: u32, inner: &[u32], more: &[u32], to: u32, across: Winding) {
        if inner.is_empty() && more.is_empty() {
            return self.straight(from, to, across);
        }
        let start = self.inner.len() as u32;
        self.inner.extend_from_slice(inner);
        self.inner.extend_from_slice(more);
        let inner = [start, self.inner.len() as u32];
        self.inner_of.push((self.edges.len() as u32, inner));
        self.push(Edge { low: from, high: to, step: across });
    }

    #[inline(always)]
    fn straight(&mut self, from: u32, to: u32, across: Winding) {
        let nodes = &self.noding.nodes;
        let edge = if nodes[from as usize] < nodes[to as usize] {
            Edge { low: from, high: to, step: across }
        } else {
            Edge { low: to, high: from, step: Winding::default().minus(across) }
        };
        self.push(edge);
    }

    #[inline(always)]
    fn push(&mut self, edge: Edge) {
        if !self.patch.1.contains(&(edge.low as usize)) {
            self.end_run();
            let ends = &self.noding.patch_ends;
            let patch = ends.partition_point(|&end| end <= edge.low);
            self.patch = (patch, parallel::range(ends, patch));
        }
        self.edges.push(edge);
    }

    fn end_run(&mut self) {
        let end = self.edges.len() as u32;
        if self.runs.last().map_or(0, |&(_, end)| end) < end {
            self.runs.push((self.patch.0 as u32, end));
        }
    }
}
