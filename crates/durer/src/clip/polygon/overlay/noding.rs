//! Finds the hot pixels, those that hold an end or a crossing of segments, and which segments pass
//! through each: snap rounding after Hobby (1999), leaf by leaf of the grid.

use super::grid::{Grid, Leaf};
use super::lattice::{Coord, Point, Segment};
use super::strips::Strips;

/// Leaves with more segments than this are divided into strips, smaller ones compare all pairs.
const CROWD: usize = 96;

/// What made a pixel hot, in one word; of several causes the smallest counts, so that an end comes
/// before a crossing, and small indices first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct CauseWord(u64);

/// What made a pixel hot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cause {
    /// The first (even) or second (odd) end of segment index / 2.
    End(u32),
    /// Two segments cross here; the smaller index comes first.
    Crossing(u32, u32),
}

impl CauseWord {
    const CROSSING: u64 = 1 << 63;

    fn end(end: u32) -> Self {
        Self(u64::from(end))
    }

    fn crossing(i: u32, j: u32) -> Self {
        Self(Self::CROSSING | u64::from(i) << 32 | u64::from(j))
    }

    /// The cause itself.
    pub fn get(self) -> Cause {
        if self.0 & Self::CROSSING == 0 {
            Cause::End(self.0 as u32)
        } else {
            Cause::Crossing((self.0 >> 32) as u32 & !(1 << 31), self.0 as u32)
        }
    }
}

/// The hot pixels and which segment passes through which of them.
#[derive(Debug)]
pub struct Noding<C> {
    /// The hot pixels, each once, leaf by leaf.
    pub nodes: Vec<Point<C>>,
    /// What made each hot.
    pub causes: Vec<CauseWord>,
    /// The nodes of segment i, in its direction, are `hits[starts[i]..starts[i + 1]]`.
    pub starts: Vec<u32>,
    /// Indices into `nodes`.
    pub hits: Vec<u32>,
}

impl<C> Noding<C> {
    /// The nodes that a segment passes, from its first to its second end.
    pub fn chain(&self, segment: usize) -> &[u32] {
        &self.hits[self.starts[segment] as usize..self.starts[segment + 1] as usize]
    }
}

/// What some leaves contribute, with nodes counted from zero.
#[derive(Debug)]
struct Part<C> {
    nodes: Vec<Point<C>>,
    causes: Vec<CauseWord>,
    hits: Vec<(u32, u32)>,
}

/// Scratch space for one leaf.
struct Workbench<C> {
    segments: Vec<Segment<C>>,
    /// The smallest and largest y of each segment.
    spans: Vec<(C, C)>,
    near: Vec<u32>,
    pixels: Vec<(Point<C>, CauseWord)>,
    strips: Strips<C>,
}

/// Which ends of a segment have to be made nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ends {
    /// The first: the second is the first of the next edge of its ring.
    First,
    /// The second: the segment runs against its edge of a ring.
    Second,
    /// Both: the segment belongs to no ring.
    Both,
}

/// Nodes all segments; `ends` tells which ends of each no other segment accounts for.
pub fn node<C: Coord>(
    segments: &[Segment<C>],
    grid: &Grid,
    ends: impl Fn(u32) -> Ends + Sync + Send,
) -> Noding<C> {
    let parts = work(segments, grid, ends);
    let mut noding =
        Noding { nodes: Vec::new(), causes: Vec::new(), starts: Vec::new(), hits: Vec::new() };
    noding.nodes.reserve_exact(parts.iter().map(|p| p.nodes.len()).sum());
    noding.causes.reserve_exact(parts.iter().map(|p| p.nodes.len()).sum());
    let mut offsets = Vec::with_capacity(parts.len());
    for part in &parts {
        offsets.push(noding.nodes.len() as u32);
        noding.nodes.extend_from_slice(&part.nodes);
        noding.causes.extend_from_slice(&part.causes);
    }
    gather(segments, &parts, &offsets, &mut noding);
    noding
}

/// How many segment entries one task handles: large enough to hide the cost of a task.
const TASK: usize = 1 << 15;

fn tasks(grid: &Grid) -> Vec<&[Leaf]> {
    let mut rest = grid.leaves();
    let mut tasks = Vec::new();
    while !rest.is_empty() {
        let mut load = 0;
        let full = |leaf: &Leaf| {
            load += grid.items(leaf).len() + 1;
            load > TASK
        };
        let count = rest.iter().position(full).map_or(rest.len(), |i| i + 1);
        let (task, others) = rest.split_at(count);
        tasks.push(task);
        rest = others;
    }
    tasks
}

fn work<C: Coord>(
    segments: &[Segment<C>],
    grid: &Grid,
    ends: impl Fn(u32) -> Ends + Sync + Send,
) -> Vec<Part<C>> {
    let run = |leaves: &[Leaf]| {
        let mut part = Part { nodes: Vec::new(), causes: Vec::new(), hits: Vec::new() };
        let mut bench = Workbench {
            segments: Vec::new(),
            spans: Vec::new(),
            near: Vec::new(),
            pixels: Vec::new(),
            strips: Strips::default(),
        };
        for leaf in leaves {
            bench.leaf(segments, grid.items(leaf), leaf, &ends, &mut part);
        }
        part
    };
    super::parallel::map(tasks(grid), run)
}

impl<C: Coord> Workbench<C> {
    fn leaf(
        &mut self,
        all: &[Segment<C>],
        items: &[u32],
        leaf: &Leaf,
        ends: &impl Fn(u32) -> Ends,
        part: &mut Part<C>,
    ) {
        if items.is_empty() {
            return;
        }
        self.segments.clear();
        self.segments.extend(items.iter().map(|&i| all[i as usize]));
        self.pixels.clear();
        self.ends(items, leaf, ends);
        if items.len() > CROWD {
            self.strips.build(&self.segments, leaf.block.min.0, leaf.block.max.0);
            let pixels = &mut self.pixels;
            self.strips.crossings(|i, j, p| push(pixels, leaf, items, (i, j), p));
        } else {
            self.crossings(items, leaf);
        }
        self.pixels.sort_unstable();
        self.pixels.dedup_by_key(|p| p.0);
        let first = part.nodes.len() as u32;
        part.nodes.extend(self.pixels.iter().map(|p| p.0));
        part.causes.extend(self.pixels.iter().map(|p| p.1));
        if items.len() > CROWD {
            for (k, &(p, _)) in self.pixels.iter().enumerate() {
                let hits = &mut part.hits;
                self.strips.hits(&self.segments, p, |i| hits.push((items[i], first + k as u32)));
            }
        } else {
            self.hits(items, first, part);
        }
    }

    /// Every point of a ring is the start of one edge, so only starts are looked at there.
    #[inline(never)]
    fn ends(&mut self, items: &[u32], leaf: &Leaf, ends: &impl Fn(u32) -> Ends) {
        for (s, &i) in self.segments.iter().zip(items) {
            let which = ends(i);
            if which != Ends::Second && leaf.block.contains(s.a) {
                self.pixels.push((s.a, CauseWord::end(2 * i)));
            }
            if which != Ends::First && leaf.block.contains(s.b) {
                self.pixels.push((s.b, CauseWord::end(2 * i + 1)));
            }
        }
    }

    #[inline(never)]
    fn crossings(&mut self, items: &[u32], leaf: &Leaf) {
        self.spans.clear();
        self.spans.extend(self.segments.iter().map(Segment::y_range));
        self.near.clear();
        self.near.resize(items.len(), 0);
        for (j, t) in self.segments.iter().enumerate() {
            let (low, high) = self.spans[j];
            // Which ones come near is hard to foretell: a list without a branch, then the list.
            let mut count = 0;
            let earlier = self.segments[..j].iter().zip(&self.spans[..j]);
            for (i, (s, span)) in (0..).zip(earlier) {
                let apart = (s.b.x < t.a.x) | (t.b.x < s.a.x) | (span.1 < low) | (high < span.0);
                self.near[count] = i;
                count += usize::from(!apart);
            }
            for &i in &self.near[..count] {
                let i = i as usize;
                if let Some(p) = self.segments[i].crossing(t) {
                    push(&mut self.pixels, leaf, items, (i, j), p);
                }
            }
        }
    }

    /// Pixels are in the order of x: of each segment only those in its range of x are looked at.
    #[inline(never)]
    fn hits(&self, items: &[u32], first: u32, part: &mut Part<C>) {
        for (s, &i) in self.segments.iter().zip(items) {
            let (low, high) = s.y_range();
            let start = self.pixels.partition_point(|(p, _)| p.x < s.a.x);
            for (&(p, _), k) in self.pixels[start..].iter().zip(start as u32..) {
                if p.x > s.b.x {
                    break;
                }
                if (p.y >= low) & (p.y <= high) && s.side_of_pixel(p).is_eq() {
                    part.hits.push((i, first + k));
                }
            }
        }
    }
}

/// Keeps a crossing if its pixel belongs to the leaf; otherwise another leaf finds it.
fn push<C: Coord>(
    pixels: &mut Vec<(Point<C>, CauseWord)>,
    leaf: &Leaf,
    items: &[u32],
    (i, j): (usize, usize),
    p: Point<C>,
) {
    if leaf.block.contains(p) {
        let (i, j) = (items[i].min(items[j]), items[i].max(items[j]));
        pixels.push((p, CauseWord::crossing(i, j)));
    }
}

/// Sorts the hits by segment and along each segment.
#[inline(never)]
fn gather<C: Coord>(
    segments: &[Segment<C>],
    parts: &[Part<C>],
    offsets: &[u32],
    noding: &mut Noding<C>,
) {
    let mut starts = vec![0u32; segments.len() + 2];
    for part in parts {
        for &(i, _) in &part.hits {
            starts[i as usize + 2] += 1;
        }
    }
    for i in 2..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut hits = vec![0u32; starts[starts.len() - 1] as usize];
    for (part, offset) in parts.iter().zip(offsets) {
        for &(i, node) in &part.hits {
            let next = &mut starts[i as usize + 1];
            hits[*next as usize] = node + offset;
            *next += 1;
        }
    }
    starts.pop();
    for (i, s) in segments.iter().enumerate() {
        let chain = &mut hits[starts[i] as usize..starts[i + 1] as usize];
        if chain.len() > 2 || s.a != noding.nodes[chain[0] as usize] {
            sort_along(s, chain, &noding.nodes);
        }
    }
    (noding.starts, noding.hits) = (starts, hits);
}

/// Snapped segments keep their direction on both axes, so x, then y in that direction, orders them.
fn sort_along<C: Coord>(s: &Segment<C>, chain: &mut [u32], nodes: &[Point<C>]) {
    let key = |n: &u32| nodes[*n as usize];
    if s.a.y <= s.b.y {
        chain.sort_unstable_by_key(key);
    } else {
        chain.sort_unstable_by(|m, n| {
            let (p, q) = (key(m), key(n));
            p.x.cmp(&q.x).then(q.y.cmp(&p.y))
        });
    }
}
