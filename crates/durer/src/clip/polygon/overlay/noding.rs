//! Finds the hot pixels, which contain an end or a crossing of segments, and the segments that pass through each: snap
//! rounding after Hobby (1999), leaf by leaf of the grid.

use std::ops::Range;

use super::grid::{Band, Grid, Leaf};
use super::lattice::{Coord, Point, Segment};
use super::strips::Strips;
use super::{Source, parallel};
use crate::Result;
use crate::work::{Charge, Work};

/// Largest number of segments of a leaf in which all pairs are compared; larger leaves are divided into strips.
const CROWD: usize = 96;

/// Number of pixels of a crowded leaf that one task searches for.
const SEARCHES: usize = if cfg!(test) { 8 } else { 1 << 11 };

/// Stage of the hot pixels in errors about memory.
const STAGE: &str = "crossings of the overlay";

/// Upper bound of the temporary bytes for each pair of crossing segments: the pair, its pixel,
/// and which segments pass there, each in a list that grows.
const PER_CROSSING: u64 = 128;

/// Cause of a hot pixel, in one word; if there are several causes, the smallest is kept, so that an end comes
/// before a crossing, and small indices first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct CauseWord(u64);

/// Cause of a hot pixel.
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

    /// Counts a segment that passes, if the cause is an end: above its index there is room.
    #[inline(always)]
    fn count(&mut self) {
        self.0 += (!self.0 >> 63) << 32;
    }

    /// Returns whether a segment ends there.
    fn is_end(self) -> bool {
        self.0 & Self::CROSSING == 0
    }

    /// Returns whether two segments were counted, at an end.
    fn is_end_of_two(self) -> bool {
        self.0 >> 32 == 2
    }

    /// Returns the cause itself.
    pub fn get(self) -> Cause {
        if self.is_end() {
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
    /// End of the nodes of each patch; leaves are processed in patches.
    pub patch_ends: Vec<u32>,
    /// True for each node that is a ring's point which only its two edges touch.
    pub passed: Vec<bool>,
    /// True for each node at which a segment ends.
    pub ends: Vec<bool>,
    /// Cause of each hot pixel, by patch; empty if not requested.
    causes: Vec<Vec<CauseWord>>,
    /// The nodes of segment i, in its direction, are `hits[starts[i]..starts[i + 1]]`.
    pub starts: Vec<u32>,
    /// Indices into `nodes`.
    pub hits: Vec<u32>,
    /// Charges of the fields above to the budget.
    _charges: Vec<Charge>,
}

impl<C> Noding<C> {
    /// Returns the nodes that a segment passes, from its first to its second end.
    pub fn chain(&self, segment: usize) -> &[u32] {
        &self.hits[self.starts[segment] as usize..self.starts[segment + 1] as usize]
    }

    /// Returns the number of edges that some segments are cut into, or fewer if some are only
    /// points.
    pub fn edges_of(&self, segments: &Range<usize>) -> usize {
        let hits = self.starts[segments.end] - self.starts[segments.start];
        (hits as usize).saturating_sub(segments.len())
    }

    /// Returns the causes of the nodes.
    pub fn causes(&self) -> impl Iterator<Item = &CauseWord> {
        self.causes.iter().flatten()
    }

    /// Returns the cause of a node.
    pub fn cause(&self, node: u32) -> Cause {
        let patch = self.patch_ends.partition_point(|&end| end <= node);
        let first = parallel::range(&self.patch_ends, patch).start;
        self.causes[patch][node as usize - first].get()
    }
}

/// Contribution of some leaves, with nodes counted from zero.
#[derive(Debug)]
struct Part<C> {
    nodes: Vec<Point<C>>,
    causes: Vec<CauseWord>,
    passed: Vec<bool>,
    ends: Vec<bool>,
    /// Segments and nodes that they pass, by the segments' indices over [`SHELF`].
    hits: Vec<Vec<(u32, u32)>>,
    charge: Charge,
}

impl<C> Part<C> {
    /// Returns its size in bytes.
    fn bytes(&self) -> u64 {
        let hits: usize = self.hits.iter().map(Vec::capacity).sum();
        let nodes = self.nodes.capacity() * (size_of::<Point<C>>() + 2);
        (nodes + self.causes.capacity() * size_of::<CauseWord>() + hits * 8) as u64
    }
}

/// Number of segments in a shelf, by which hits are sorted: the lists of a shelf fit the cache.
const SHELF: usize = if cfg!(test) { 8 } else { 1 << 14 };

/// Scratch space for one leaf.
struct Workbench<'a, C> {
    segments: Vec<Segment<C>>,
    /// The smallest and largest y of each segment.
    spans: Vec<(C, C)>,
    near: Vec<u32>,
    pixels: Vec<(Point<C>, CauseWord)>,
    strips: Strips<C>,
    /// True to keep the cause of each node.
    causes: bool,
    work: &'a Work,
}

/// Nodes all segments: edges of rings with their `sources`, or lines that belong to no ring. `causes` tells whether to keep
/// the causes of each node.
///
/// # Errors
/// Those of the work: where crossings take more memory than it may have.
pub fn node<C: Coord>(
    segments: &[Segment<C>],
    grid: &Grid,
    sources: Option<&[Source]>,
    causes: bool,
    work: &Work,
) -> Result<Noding<C>> {
    let mut parts = parts(segments, grid, sources, causes, work)?;
    let patch_ends = parallel::ends(parts.iter().map(|part| part.nodes.len()));
    let nodes = parallel::concat(&parts.iter().map(|part| &part.nodes[..]).collect::<Vec<_>>());
    let passed = parallel::concat(&parts.iter().map(|part| &part.passed[..]).collect::<Vec<_>>());
    let ends = parallel::concat(&parts.iter().map(|part| &part.ends[..]).collect::<Vec<_>>());
    let causes = parts.iter_mut().map(|part| std::mem::take(&mut part.causes)).collect();
    let (starts, hits) = gather(segments, &parts, &patch_ends, &nodes);
    let _charges = parts.into_iter().map(|part| part.charge).collect();
    Ok(Noding { nodes, patch_ends, passed, ends, causes, starts, hits, _charges })
}

/// Number of segment entries in one task: large enough to hide the cost of a task.
const TASK: usize = if cfg!(test) { 32 } else { 1 << 15 };

fn tasks(grid: &Grid) -> Vec<(&Band, &[Leaf])> {
    let mut tasks = Vec::new();
    for band in grid.bands() {
        let mut rest = band.leaves();
        while !rest.is_empty() {
            let mut load = 0;
            let full = |leaf: &Leaf| {
                load += band.items(leaf).len() + 1;
                load > TASK
            };
            let count = rest.iter().position(full).map_or(rest.len(), |i| i + 1);
            let (task, others) = rest.split_at(count);
            tasks.push((band, task));
            rest = others;
        }
    }
    tasks
}

fn parts<C: Coord>(
    segments: &[Segment<C>],
    grid: &Grid,
    sources: Option<&[Source]>,
    causes: bool,
    work: &Work,
) -> Result<Vec<Part<C>>> {
    let run = |(band, leaves): (&Band, &[Leaf])| {
        let mut part = Part {
            nodes: Vec::new(),
            causes: Vec::new(),
            passed: Vec::new(),
            ends: Vec::new(),
            hits: vec![Vec::new(); segments.len().div_ceil(SHELF)],
            charge: work.charge(STAGE, 0)?,
        };
        let mut bench = Workbench {
            segments: Vec::new(),
            spans: Vec::new(),
            near: Vec::new(),
            pixels: Vec::new(),
            strips: Strips::default(),
            causes,
            work,
        };
        // The number of nodes is about proportional to the number of entries.
        let load = leaves.iter().map(|leaf| band.items(leaf).len()).sum::<usize>() * 5 / 8;
        part.nodes.reserve(load);
        if causes {
            part.causes.reserve(load);
        }
        part.passed.reserve(load);
        part.ends.reserve(load);
        for leaf in leaves {
            bench.leaf(segments, band.items(leaf), leaf, sources, &mut part)?;
        }
        part.charge.grow_to(part.bytes())?;
        Ok(part)
    };
    parallel::map(tasks(grid), run).into_iter().collect()
}

impl<C: Coord> Workbench<'_, C> {
    fn leaf(
        &mut self,
        all: &[Segment<C>],
        items: &[u32],
        leaf: &Leaf,
        sources: Option<&[Source]>,
        part: &mut Part<C>,
    ) -> Result<()> {
        if items.is_empty() {
            return Ok(());
        }
        self.segments.clear();
        self.segments.extend(items.iter().map(|&i| all[i as usize]));
        self.pixels.clear();
        self.ends(items, leaf, sources);
        if items.len() > CROWD {
            self.build_strips(leaf, part)?;
            let pixels = &mut self.pixels;
            self.strips.crossings(|i, j, p| push(pixels, leaf, items, (i, j), p));
        } else {
            self.crossings(items, leaf);
        }
        self.pixels.sort_unstable();
        self.pixels.dedup_by_key(|p| p.0);
        let first = part.nodes.len() as u32;
        part.nodes.extend(self.pixels.iter().map(|p| p.0));
        if self.causes {
            part.causes.extend(self.pixels.iter().map(|p| p.1));
        }
        if items.len() > CROWD {
            self.crowd_hits(items, first, part);
            part.charge.grow_to(part.bytes())?;
        } else {
            self.hits(items, first, part);
        }
        part.passed.extend(self.pixels.iter().map(|p| p.1.is_end_of_two()));
        part.ends.extend(self.pixels.iter().map(|p| p.1.is_end()));
        Ok(())
    }

    /// Finds the crossings of a crowded leaf, within the memory available.
    fn build_strips(&mut self, leaf: &Leaf, part: &mut Part<C>) -> Result<()> {
        let left = self.work.budget().saturating_sub(self.work.used());
        let room = left / PER_CROSSING / parallel::threads() as u64;
        self.strips.room = usize::try_from(room).ok().filter(|_| self.work.budget() < u64::MAX);
        self.strips.build(&self.segments, leaf.block.min.0, leaf.block.max.0);
        if self.strips.is_full() {
            return part.charge.grow(left.saturating_add(1));
        }
        Ok(())
    }

    /// Adds the pixels of the ends in a leaf. Every point of a ring is the start of one edge, so only starts are
    /// examined there.
    #[inline(never)]
    fn ends(&mut self, items: &[u32], leaf: &Leaf, sources: Option<&[Source]>) {
        for (s, &i) in self.segments.iter().zip(items) {
            let source = sources.map(|sources| sources[i as usize]);
            if source.is_none_or(|source| !source.reversed()) && leaf.block.contains(s.a) {
                self.pixels.push((s.a, CauseWord::end(2 * i)));
            }
            if source.is_none_or(Source::reversed) && leaf.block.contains(s.b) {
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
            // Which ones come near is hard to predict, so a list is built without branches and processed afterwards.
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

    #[inline(never)]
    fn crowd_hits(&mut self, items: &[u32], first: u32, part: &mut Part<C>) {
        let (strips, segments, pixels) = (&self.strips, &self.segments, &self.pixels);
        let mut list: Vec<(Point<C>, u32)> = (pixels.iter().map(|p| p.0)).zip(0..).collect();
        // In the order of the segments that end there, because those mostly follow one another.
        list.sort_by_key(|&(_, k)| pixels[k as usize].1);
        if parallel::threads() == 1 || list.len() <= SEARCHES {
            strips.hits(segments, &list, |i, k| {
                part.hits[items[i] as usize / SHELF].push((items[i], first + k));
                self.pixels[k as usize].1.count();
            });
            return;
        }
        let hits = parallel::map(list.chunks(SEARCHES).collect(), |some| {
            let mut hits = Vec::new();
            strips.hits(segments, some, |i, k| hits.push((i, k)));
            hits
        });
        for (i, k) in hits.into_iter().flatten() {
            part.hits[items[i] as usize / SHELF].push((items[i], first + k));
            self.pixels[k as usize].1.count();
        }
    }

    /// Finds the pixels that segments hit. Pixels are in the order of x: of each segment only those in its range of x
    /// are examined.
    #[inline(never)]
    fn hits(&mut self, items: &[u32], first: u32, part: &mut Part<C>) {
        for (s, &i) in self.segments.iter().zip(items) {
            let (low, high) = s.y_range();
            let start = self.pixels.partition_point(|(p, _)| p.x < s.a.x);
            let shelf = &mut part.hits[i as usize / SHELF];
            let pixels = &mut self.pixels[start..];
            for (k, (p, cause)) in (first + start as u32..).zip(pixels) {
                if p.x > s.b.x {
                    break;
                }
                if (p.y >= low) & (p.y <= high) && s.side_of_pixel(*p).is_eq() {
                    shelf.push((i, k));
                    cause.count();
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
    patch_ends: &[u32],
    nodes: &[Point<C>],
) -> (Vec<u32>, Vec<u32>) {
    let shelves = segments.len().div_ceil(SHELF);
    let length = |shelf: usize| parts.iter().map(|part| part.hits[shelf].len()).sum();
    let ends = parallel::ends((0..shelves).map(length));
    let total = ends.last().copied().unwrap_or(0);
    let mut hits = vec![0u32; total as usize];
    let mut starts = vec![0u32; segments.len() + 1];
    starts[segments.len()] = total;
    let tasks = parallel::cut(&mut hits, &ends).into_iter().zip(starts.chunks_mut(SHELF));
    let tasks: Vec<_> = tasks.zip(segments.chunks(SHELF)).enumerate().collect();
    parallel::map(tasks, |(shelf, ((hits, starts), segments))| {
        let lists = || {
            parts.iter().enumerate().map(move |(patch, part)| {
                (parallel::range(patch_ends, patch).start as u32, &part.hits[shelf])
            })
        };
        let first = parallel::range(&ends, shelf).start as u32;
        let starts = &mut starts[..segments.len()];
        sort_hits(lists, (shelf * SHELF) as u32, starts, hits);
        let mut chains = starts.iter().map(|&start| start as usize).chain([hits.len()]);
        let mut start = chains.next().unwrap_or(0);
        for (s, end) in segments.iter().zip(chains) {
            let chain = &mut hits[start..end];
            let in_order = chain.len() == 2 && s.a == nodes[chain[0] as usize];
            if chain.len() > 1 && !in_order {
                sort_along(s, chain, nodes);
            }
            start = end;
        }
        starts.iter_mut().for_each(|start| *start += first);
    });
    (starts, hits)
}

/// Puts hits in the order of their segments, whose indices count from `first`; fills in where the
/// hits of each segment start.
fn sort_hits<'a, I: Iterator<Item = (u32, &'a Vec<(u32, u32)>)>>(
    lists: impl Fn() -> I,
    first: u32,
    starts: &mut [u32],
    hits: &mut [u32],
) {
    for (_, list) in lists() {
        for &(i, _) in list {
            starts[(i - first) as usize] += 1;
        }
    }
    let mut end = 0;
    for start in starts.iter_mut() {
        end += *start;
        *start = end;
    }
    for (offset, list) in lists() {
        for &(i, node) in list {
            let next = &mut starts[(i - first) as usize];
            *next -= 1;
            hits[*next as usize] = node + offset;
        }
    }
}

/// Sorts nodes along a segment. Snapped segments keep their direction on both axes, so x, then y in that direction,
/// orders them.
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
