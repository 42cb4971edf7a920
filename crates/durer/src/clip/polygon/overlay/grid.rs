//! A hierarchical grid: squares of pixels, crowded ones divided again, each with the segments that
//! come near it.
//!
//! Every pixel lies in exactly one leaf, and a segment is listed in every leaf it comes within one
//! pixel of, before and after snap rounding. So leaves can be processed alone.

use std::ops::Range;

use super::lattice::{Coord, Point, Segment, whole};
use super::parallel;

/// Largest number of segments of a leaf that is not divided.
const SMALL_LEAF: usize = 24;

/// A crowded leaf is divided only where its parts hold at most this many times its segments, in
/// sixteenths; long parallel segments do not come apart in squares.
const GROWTH: usize = 40;

/// Largest factor by which all divisions of a square together may multiply its segments: overlapping edges never come
/// apart, and each division would double them, down to single pixels.
const MOST_GROWTH: f64 = 16.0;

/// Segments per square if they were spread evenly; curves leave most squares empty, and the full
/// ones are divided again.
const PER_SQUARE: f64 = 8.0;

/// The first division has at most this many times more squares than segments call for, so that
/// empty squares cost little.
const SPARSEST: f64 = 1.0 / 16.0;

/// Curves that go on in the next square all but once in this many segments are in order as they
/// come.
const FEW_JUMPS: usize = 64;

/// Segments that start in one band of rows, and that one task handles: their data fit the cache.
const PER_BAND: usize = if cfg!(test) { 16 } else { 1 << 15 };

/// Number of segments in one task: large enough to hide the cost of a task.
const TASK: usize = if cfg!(test) { 8 } else { 1 << 14 };

/// The sides of a cell are at least 2³ pixels, so that the margin of a pixel stays a margin.
const SMALLEST_SHIFT: u32 = 3;

/// A rectangle of pixels; both corners belong to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Block {
    pub min: (i64, i64),
    pub max: (i64, i64),
}

impl Block {
    /// Returns the block around all segments; `None` if there is none.
    pub fn around<C: Coord>(segments: &[Segment<C>]) -> Option<Self> {
        let blocks = parallel::map(segments.chunks(TASK).collect(), |some| {
            let start = (some[0].a.x, some[0].b.x, some[0].a.y, some[0].a.y);
            some.iter().fold(start, |(l, r, b, t), s| {
                let (low, high) = s.y_range();
                (l.min(s.a.x), r.max(s.b.x), b.min(low), t.max(high))
            })
        });
        let all = |m: (C, C, C, C), n: (C, C, C, C)| {
            (m.0.min(n.0), m.1.max(n.1), m.2.min(n.2), m.3.max(n.3))
        };
        let (l, r, b, t) = blocks.into_iter().reduce(all)?;
        Some(Self { min: (l.i64(), b.i64()), max: (r.i64(), t.i64()) })
    }

    /// Returns whether the pixel lies in the block.
    #[inline(always)]
    pub fn contains<C: Coord>(&self, p: Point<C>) -> bool {
        self.holds(p.x.i64(), p.y.i64())
    }

    /// Returns its width and height in pixels.
    fn size(&self) -> (f64, f64) {
        ((self.max.0 - self.min.0 + 1) as f64, (self.max.1 - self.min.1 + 1) as f64)
    }

    #[inline(always)]
    fn holds(&self, x: i64, y: i64) -> bool {
        self.min.0 <= x && x <= self.max.0 && self.min.1 <= y && y <= self.max.1
    }
}

/// Statistics of the segments in a block.
#[derive(Debug, Clone, Copy)]
pub struct Spread {
    /// The share of squares of a rough grid in which a segment starts: small for curves.
    occupied: f64,
    /// The sum of all widths and heights.
    length: f64,
}

impl<C: Coord> Segment<C> {
    /// Returns the sum of its width and its height, each limited to the given size.
    fn length(&self, width: f64, height: f64) -> f64 {
        let (low, high) = self.y_range();
        (self.b.x.f64() - self.a.x.f64()).min(width) + (high.f64() - low.f64()).min(height)
    }
}

/// A block that is not divided further.
#[derive(Debug, Clone, Copy)]
pub struct Leaf {
    /// Its pixels.
    pub block: Block,
    start: u32,
    end: u32,
}

/// A square, in one word, as most of them may be empty: a leaf, a division, or nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Node(u32);

impl Node {
    /// No segment comes near.
    const EMPTY: Self = Self(u32::MAX);
    /// Smallest word that is the index of a division; smaller words are indices of leaves.
    const FIRST_SPLIT: u32 = 1 << 31;
}

/// Division of a block into squares.
#[derive(Debug, Clone, Copy)]
struct Frame {
    block: Block,
    shift: u32,
    columns: usize,
    rows: usize,
}

/// See the module. Its first division is made in bands of rows, each on its own.
#[derive(Debug)]
pub struct Grid {
    frame: Frame,
    bands: Vec<Band>,
    /// Band of each row of the first division.
    band_of_row: Vec<u32>,
}

/// Rows of the first division.
#[derive(Debug, Default)]
pub struct Band {
    rows: Range<usize>,
    /// First the squares of the rows.
    nodes: Vec<Node>,
    /// Divided squares, and where the nodes of their squares start.
    splits: Vec<(Frame, u32)>,
    leaves: Vec<Leaf>,
    items: Vec<u32>,
}

impl Frame {
    fn new<C: Coord>(block: Block, segments: &[Segment<C>], items: &[u32]) -> Option<Self> {
        let (width, height) = block.size();
        let length = |i: &u32| segments[*i as usize].length(width, height);
        let spread = Spread { occupied: 1.0, length: items.iter().map(length).sum() };
        Self::of(block, items.len(), spread)
    }

    fn of(block: Block, count: usize, spread: Spread) -> Option<Self> {
        let ((width, height), count) = (block.size(), count as f64);
        let Spread { occupied, length: total } = spread;
        // A few segments per square, none much shorter than a mean segment.
        let side = (width * height * occupied / count * PER_SQUARE).sqrt().max(total / count * 0.8);
        let side = side.max(width.max(height) / count);
        let shift = (side.log2_floor()).max(SMALLEST_SHIFT);
        let columns = ((block.max.0 - block.min.0) >> shift) as usize + 1;
        let rows = ((block.max.1 - block.min.1) >> shift) as usize + 1;
        (columns * rows > 1).then_some(Self { block, shift, columns, rows })
    }

    /// Returns the block as one square.
    fn whole(block: Block) -> Self {
        Self { block, shift: 62, columns: 1, rows: 1 }
    }

    #[inline(always)]
    fn column(&self, x: i64) -> usize {
        ((x.clamp(self.block.min.0, self.block.max.0) - self.block.min.0) >> self.shift) as usize
    }

    #[inline(always)]
    fn row(&self, y: i64) -> usize {
        ((y.clamp(self.block.min.1, self.block.max.1) - self.block.min.1) >> self.shift) as usize
    }

    /// Returns the first and the last row that hold squares the segment comes within a pixel of.
    #[inline(always)]
    fn rows_of<C: Coord>(&self, s: &Segment<C>) -> (usize, usize) {
        let (low, high) = s.y_range();
        (self.row(low.i64() - 1), self.row(high.i64() + 1))
    }

    /// Calls `f` with the index of every square in some rows the segment comes within a pixel of.
    #[inline]
    fn visit<C: Coord>(&self, s: &Segment<C>, rows: &Range<usize>, mut f: impl FnMut(usize)) {
        let (min, max) = (self.block.min, self.block.max);
        let (column, row) = (|x| self.column(x), |y| self.row(y));
        let (low, high) = s.y_range();
        let (low, high) = (low.i64() - 1, high.i64() + 1);
        let (mut left, mut right) = (column(s.a.x.i64() - 1), column(s.b.x.i64() + 1));
        let (bottom, top) = (row(low), row(high));
        if left == right || bottom == top || s.a.x == s.b.x {
            for r in bottom.max(rows.start)..=top.min(rows.end - 1) {
                for c in left..=right {
                    f(r * self.columns + c);
                }
            }
            return;
        }
        let (ax, ay) = (s.a.x.f64(), s.a.y.f64());
        let slope = (s.b.y.f64() - ay) / (s.b.x.f64() - ax);
        if bottom < rows.start || rows.end <= top {
            // Of a long segment only the columns around these rows, with room for roundings.
            let border = |r: usize| (min.1 + ((r as i64) << self.shift)) as f64;
            let x = |y: f64| whole((ax + (y - ay) / slope).clamp(ax, s.b.x.f64()));
            let (x0, x1) = (x(border(rows.start) - 4.0), x(border(rows.end) + 4.0));
            left = left.max(column(x0.min(x1) - 2));
            right = right.min(column(x0.max(x1) + 3));
        }
        for c in left..=right {
            let start = min.0 + ((c as i64) << self.shift);
            let x0 = (start as f64 - 1.5).max(ax);
            let x1 = ((start + (1 << self.shift)) as f64 + 0.5).min(s.b.x.f64());
            let (y0, y1) = (ay + (x0 - ax) * slope, ay + (x1 - ax) * slope);
            let (y0, y1) = if y0 <= y1 { (y0, y1) } else { (y1, y0) };
            let (y0, y1) = (whole(y0 - 1.6), whole(y1 + 1.6) + 1);
            if y1 < min.1 || y0 > max.1 {
                continue;
            }
            let (bottom, top) = (row(y0.max(low)), row(y1.min(high)));
            for r in bottom.max(rows.start)..=top.min(rows.end - 1) {
                f(r * self.columns + c);
            }
        }
    }

    /// Returns the square of a pixel of the block.
    fn index(&self, x: i64, y: i64) -> usize {
        let (c, r) = ((x - self.block.min.0) >> self.shift, (y - self.block.min.1) >> self.shift);
        r as usize * self.columns + c as usize
    }

    fn square(&self, index: usize) -> Block {
        let (r, c) = ((index / self.columns) as i64, (index % self.columns) as i64);
        let min = (self.block.min.0 + (c << self.shift), self.block.min.1 + (r << self.shift));
        let last = (1 << self.shift) - 1;
        let max = ((min.0 + last).min(self.block.max.0), (min.1 + last).min(self.block.max.1));
        Block { min, max }
    }

    /// Returns the segments of every square of some rows, one after the other, and where each
    /// square's list starts.
    #[inline(never)]
    fn distribute<'a, C: Coord>(
        &self,
        segments: &[Segment<C>],
        rows: &Range<usize>,
        items: impl Iterator<Item = &'a u32>,
        scratch: &mut Vec<(u32, u32)>,
    ) -> (Vec<u32>, Vec<u32>) {
        let first = rows.start * self.columns;
        let mut starts = vec![0u32; self.columns * rows.len() + 1];
        scratch.clear();
        for &i in items {
            self.visit(&segments[i as usize], rows, |square| {
                starts[square - first + 1] += 1;
                scratch.push(((square - first) as u32, i));
            });
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut lists = vec![0u32; scratch.len()];
        // Backwards, from the end of each list, so that afterwards its start is at hand.
        starts.rotate_left(1);
        for &(square, i) in scratch.iter().rev() {
            let next = &mut starts[square as usize];
            *next -= 1;
            lists[*next as usize] = i;
        }
        if let Some(last) = starts.last_mut() {
            *last = lists.len() as u32;
        }
        (starts, lists)
    }
}

/// ⌊log2⌋ of numbers from 1 up.
trait Log2Floor {
    fn log2_floor(self) -> u32;
}

impl Log2Floor for f64 {
    fn log2_floor(self) -> u32 {
        (self.clamp(1.0, (1u64 << 50) as f64) as u64).ilog2()
    }
}

/// Returns the order in which segments that start close together have close indices, so that later steps find their
/// data in the cache; `None` if they are in such an order.
#[inline(never)]
pub fn spatial_order<C: Coord>(segments: &[Segment<C>], block: Block) -> Option<Vec<u32>> {
    let (width, height) = block.size();
    let length = segments.iter().map(|s| s.length(width, height)).sum();
    let frame = Frame::of(block, segments.len(), Spread { occupied: 1.0, length })?;
    let square = |i: usize| frame.index(segments[i].a.x.i64(), segments[i].a.y.i64());
    let size = [frame.columns, frame.rows];
    order_by_squares(segments.len(), size, square, FEW_JUMPS)
}

/// Returns the order of items by the squares of a grid, column by column along each row; `None` if
/// at most one in `few_jumps` is not in or beside the square of the one before.
pub fn order_by_squares(
    count: usize,
    [columns, rows]: [usize; 2],
    square: impl Fn(usize) -> usize,
    few_jumps: usize,
) -> Option<Vec<u32>> {
    let mut starts = vec![0u32; columns * rows + 1];
    let (mut jumps, mut last) = (0, 0);
    for i in 0..count {
        let index = square(i);
        starts[index + 1] += 1;
        let apart = index.abs_diff(last);
        jumps += usize::from(apart > 1 && apart.abs_diff(columns) > 1);
        last = index;
    }
    if jumps * few_jumps < count {
        return None;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut order = vec![0; count];
    for i in 0..count {
        let next = &mut starts[square(i)];
        order[*next as usize] = i as u32;
        *next += 1;
    }
    Some(order)
}

impl Spread {
    /// Computes the statistics of the segments in a block.
    #[inline(never)]
    pub fn of<C: Coord>(segments: &[Segment<C>], block: Block) -> Self {
        let (width, height) = block.size();
        let lengths = parallel::map(segments.chunks(TASK).collect(), |some| {
            some.iter().map(|s| s.length(width, height)).sum::<f64>()
        });
        let mut spread = Self { occupied: 1.0, length: lengths.iter().sum() };
        let Some(frame) = Frame::of(block, segments.len(), spread) else { return spread };
        let squares = frame.columns * frame.rows;
        let filled = parallel::map(segments.chunks(TASK).collect(), |some| {
            let mut filled = vec![0u64; squares.div_ceil(64)];
            for s in some {
                let square = frame.index(s.a.x.i64(), s.a.y.i64());
                filled[square / 64] |= 1 << (square % 64);
            }
            filled
        });
        let word = |i| filled.iter().fold(0u64, |all, filled| all | filled[i]);
        let filled: u32 = (0..squares.div_ceil(64)).map(|i| word(i).count_ones()).sum();
        spread.occupied = (f64::from(filled) / squares as f64).max(SPARSEST);
        spread
    }
}

impl Grid {
    /// Distributes the segments; `block` must hold them all. Segments of zero length are in no list.
    #[inline(never)]
    pub fn new<C: Coord>(segments: &[Segment<C>], block: Block, spread: Spread) -> Self {
        let frame = match segments.len() {
            0..=SMALL_LEAF => None,
            count => Frame::of(block, count, spread),
        };
        let frame = frame.unwrap_or(Frame::whole(block));
        let ends = bands(&frame, segments);
        let mut band_of_row = Vec::with_capacity(frame.rows);
        for (band, &end) in (0..).zip(&ends) {
            band_of_row.resize(end as usize, band);
        }
        let lists = parallel::map(parallel::ranges(segments.len(), TASK), |range| {
            let mut lists = vec![Vec::new(); ends.len()];
            for (s, i) in segments[range.clone()].iter().zip(range.start as u32..) {
                if s.a == s.b {
                    continue;
                }
                let (bottom, top) = frame.rows_of(s);
                for band in band_of_row[bottom]..=band_of_row[top] {
                    lists[band as usize].push(i);
                }
            }
            lists
        });
        let bands = parallel::map((0..ends.len()).collect(), |k| {
            Band::new(segments, &frame, parallel::range(&ends, k), || {
                lists.iter().flat_map(move |lists: &Vec<Vec<u32>>| &lists[k])
            })
        });
        Self { frame, bands, band_of_row }
    }

    /// Returns all leaves, band by band; they cover the block without overlap.
    pub fn bands(&self) -> &[Band] {
        &self.bands
    }

    /// Returns the smallest block around a pixel, and the segments that come within a pixel of it;
    /// `None` outside the grid.
    pub fn locate(&self, x: i64, y: i64) -> Option<(Block, &[u32])> {
        let mut frame = &self.frame;
        if !frame.block.holds(x, y) {
            return None;
        }
        let band = &self.bands[*self.band_of_row.get(frame.row(y))? as usize];
        let mut square = frame.index(x, y);
        let mut node = *band.nodes.get(square - band.rows.start * frame.columns)?;
        loop {
            if node == Node::EMPTY {
                return Some((frame.square(square), &[][..]));
            }
            if node.0 < Node::FIRST_SPLIT {
                let leaf = band.leaves.get(node.0 as usize)?;
                return leaf.block.holds(x, y).then(|| (leaf.block, band.items(leaf)));
            }
            let (inner, first) = band.splits.get((node.0 - Node::FIRST_SPLIT) as usize)?;
            if !inner.block.holds(x, y) {
                return None;
            }
            frame = inner;
            square = frame.index(x, y);
            node = band.nodes[*first as usize + square];
        }
    }
}

/// Returns the last row of each band: about as many segments start in one as in another.
fn bands<C: Coord>(frame: &Frame, segments: &[Segment<C>]) -> Vec<u32> {
    let most = segments.len().div_ceil(PER_BAND).min(frame.rows);
    if most == 1 {
        return vec![frame.rows as u32];
    }
    let counts = parallel::map(segments.chunks(TASK).collect(), |some| {
        let mut counts = vec![0u32; frame.rows];
        for s in some {
            counts[frame.row(s.a.y.i64())] += 1;
        }
        counts
    });
    let mut ends = Vec::new();
    let mut load = 0;
    for row in 0..frame.rows {
        load += counts.iter().map(|counts| counts[row] as usize).sum::<usize>();
        if load * most >= segments.len() * (ends.len() + 1) || row + 1 == frame.rows {
            ends.push(row as u32 + 1);
        }
    }
    ends
}

impl Band {
    fn new<'a, C: Coord, I: Iterator<Item = &'a u32>>(
        segments: &[Segment<C>],
        frame: &Frame,
        rows: Range<usize>,
        items: impl Fn() -> I,
    ) -> Self {
        let mut scratch = Vec::new();
        let (starts, lists) = frame.distribute(segments, &rows, items(), &mut scratch);
        let squares = starts.len() - 1;
        let mut band = Self { nodes: vec![Node::EMPTY; squares], rows, ..Self::default() };
        band.items.reserve(lists.len());
        for square in 0..squares {
            let list = &lists[starts[square] as usize..starts[square + 1] as usize];
            if list.is_empty() {
                continue;
            }
            let block = frame.square(band.rows.start * frame.columns + square);
            band.divide(segments, (square, block), list, MOST_GROWTH, &mut scratch);
        }
        band
    }

    /// Divides a square if that separates its segments; `most` is the factor by which the divisions may still multiply
    /// them.
    fn divide<C: Coord>(
        &mut self,
        segments: &[Segment<C>],
        (node, block): (usize, Block),
        items: &[u32],
        most: f64,
        scratch: &mut Vec<(u32, u32)>,
    ) {
        let frame = match items.len() {
            ..=SMALL_LEAF => None,
            _ => Frame::new(block, segments, items),
        };
        let parts = frame.map(|frame| {
            (frame, frame.distribute(segments, &(0..frame.rows), items.iter(), scratch))
        });
        let growth = |lists: &[u32]| lists.len() as f64 / items.len() as f64;
        match parts {
            Some((frame, (starts, lists)))
                if lists.len() * 16 <= items.len() * GROWTH && growth(&lists) <= most =>
            {
                let most = most / growth(&lists).max(1.0);
                let first = self.nodes.len();
                self.nodes[node] = Node(Node::FIRST_SPLIT + self.splits.len() as u32);
                self.splits.push((frame, first as u32));
                self.nodes.resize(first + starts.len() - 1, Node::EMPTY);
                for square in 0..starts.len() - 1 {
                    let list = &lists[starts[square] as usize..starts[square + 1] as usize];
                    if !list.is_empty() {
                        let part = (first + square, frame.square(square));
                        self.divide(segments, part, list, most, scratch);
                    }
                }
            }
            _ => {
                self.nodes[node] = Node(self.leaves.len() as u32);
                let start = self.items.len() as u32;
                self.items.extend_from_slice(items);
                self.leaves.push(Leaf { block, start, end: self.items.len() as u32 });
            }
        }
    }

    /// Returns the leaves of these rows that hold segments.
    pub fn leaves(&self) -> &[Leaf] {
        &self.leaves
    }

    /// Returns the segments that come within a pixel of a leaf, in the order of their indices.
    pub fn items(&self, leaf: &Leaf) -> &[u32] {
        &self.items[leaf.start as usize..leaf.end as usize]
    }
}
