//! The crossings of edges with the centres of rows, band by band.
//!
//! The pixel of a crossing is exact although x is kept in binary fractions: crossings are
//! multiples of 1/(256 · height) of a pixel, heights in 1/256 of a pixel, so x may come out too small by less than
//! that, and never too large.

use std::ops::Range;

use fearless_simd::i32x8;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

use super::{is_inside, snapped_edges};
use crate::curve::Contours;
use crate::raster::bands::{BAND_ROWS, CHUNK, Chunk, Edges, FEW_EDGES, by_chunks, running_sums};
use crate::raster::coverage::FillRule;
use crate::raster::coverage::sweep::Sink;
use crate::raster::fixed::{HALF_PIXEL, SUBPIXELS, first_center};

/// Bits of x below the pixel, of 64: 2¹⁷ pixels to each side are twice the range of edges.
const BITS: u32 = 46;
/// One pixel.
const ONE: i64 = 1 << BITS;
/// Amount by which x is reduced, 2⁻³⁵ pixel. Four roundings in f64 of numbers up to 2¹⁷ (start, slope, their product
/// and sum) are at most 2⁻³⁵ off together, 32 steps of the cut off slope 2⁻⁴¹, while edges up to 2²⁵ high allow 2⁻³³.
const SLACK: i64 = ONE >> 35;
/// Crossings of a row that are kept in a list; with more the band counts them per pixel.
const LISTED: usize = 32;

/// An edge that crosses the centre of at least one row of the target.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Edge {
    /// Crossing with the first row's centre, in pixels from the centre of column 0.
    x: f64,
    /// Change of x per row.
    slope: f64,
    /// First row and one past the last.
    rows: (i32, i32),
    /// True if it goes down in the path.
    down: bool,
}

impl Edge {
    fn new(a: (i32, i32), b: (i32, i32), height: i32) -> Option<Self> {
        let (upper, lower, down) = if a.1 <= b.1 { (a, b, true) } else { (b, a, false) };
        let first = first_center(upper.1).max(0);
        let last = first_center(lower.1).min(height);
        if first >= last {
            return None;
        }
        let (dx, dy) = (i64::from(lower.0) - i64::from(upper.0), i64::from(lower.1 - upper.1));
        let below = i64::from(first * SUBPIXELS + HALF_PIXEL) - i64::from(upper.1);
        // Below 2⁵²: exact in f64.
        let numerator = i64::from(upper.0 - HALF_PIXEL) * dy + dx * below;
        let x = numerator as f64 / (dy * i64::from(SUBPIXELS)) as f64;
        Some(Self { x, slope: dx as f64 / dy as f64, rows: (first, last), down })
    }

    /// Returns the rows of the band at `top` whose centres it crosses, seen from there, x at the first of
    /// them such that cutting it off gives the first pixel not left of the edge, and the change of x per row.
    #[inline(always)]
    fn within(&self, top: i32) -> (i32, i32, i64, i64) {
        let first = self.rows.0.max(top);
        let x = self.x + self.slope * f64::from(first - self.rows.0);
        let fixed = |v: f64| (v * ONE as f64) as i64;
        let x = fixed(x).wrapping_add(ONE - 1 - SLACK);
        (first - top, self.rows.1.min(top + BAND_ROWS) - top, x, fixed(self.slope))
    }
}

/// The edges of one path and which of them each band needs.
#[derive(Debug)]
pub(crate) struct CrossingEdges {
    edges: Edges<Edge>,
    /// First row and one past the last whose centres are crossed.
    pub rows: (i32, i32),
    /// First and last pixel at which edges begin or end.
    columns: (i32, i32),
}

/// Extent of the edges made so far.
#[derive(Debug, Clone, Copy)]
struct Extent {
    rows: (i32, i32),
    columns: (i32, i32),
}

impl Extent {
    const NONE: Self = Self { rows: (i32::MAX, 0), columns: (i32::MAX, 0) };

    fn join(&mut self, other: Self) {
        let join = |a: (i32, i32), b: (i32, i32)| (a.0.min(b.0), a.1.max(b.1));
        self.rows = join(self.rows, other.rows);
        self.columns = join(self.columns, other.columns);
    }
}

/// Adds the edges that begin in a range of all points to the list.
fn add(contours: &Contours, range: Range<usize>, height: i32, list: &mut Vec<Edge>) -> Extent {
    let mut extent = Extent::NONE;
    snapped_edges(contours, range, |a, b| {
        if let Some(edge) = Edge::new(a, b, height) {
            let columns = (first_center(a.0.min(b.0)), first_center(a.0.max(b.0)));
            extent.join(Extent { rows: edge.rows, columns });
            list.push(edge);
        }
    });
    extent
}

impl CrossingEdges {
    /// Returns the size of the edges that are not in the list, in bytes.
    pub fn bytes(&self) -> u64 {
        self.edges.bytes()
    }

    /// Creates the edges of contours within a target of the given size, at most 32,767 in each direction; few edges are
    /// added to the list.
    pub fn new(contours: &Contours, width: u32, height: u32, list: &mut Vec<Edge>) -> Self {
        let (width, height) = (width as i32, height as i32);
        let (count, rows) = (contours.points().len(), |edge: &Edge| edge.rows);
        let mut extent = Extent::NONE;
        let edges = if count <= FEW_EDGES {
            let first = list.len();
            extent = add(contours, 0..count, height, list);
            Edges::from_list(list, first, rows)
        } else {
            let made = by_chunks(contours, CHUNK, |range| {
                let mut edges = Vec::with_capacity(range.len());
                let extent = add(contours, range, height, &mut edges);
                (Chunk::new(edges, rows), extent)
            });
            made.iter().for_each(|(_, own)| extent.join(*own));
            let chunks = made.into_iter().map(|(chunk, _)| chunk).collect();
            Edges::from_chunks(chunks, list, rows)
        };
        let Extent { rows, columns } = extent;
        let columns = (columns.0.clamp(0, width), columns.1.clamp(0, width));
        Self { edges, rows, columns }
    }

    /// Returns whether the path crosses no row of the band that starts at row `top`.
    pub fn misses(&self, top: i32) -> bool {
        self.rows.0 >= top + BAND_ROWS || self.rows.1 <= top
    }

    /// Returns the path with the list it was made with.
    pub fn with<'a>(&'a self, list: &'a [Edge]) -> Path<'a> {
        Path { path: self, list }
    }
}

/// A path and the list that its edges may be in.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Path<'a> {
    path: &'a CrossingEdges,
    list: &'a [Edge],
}

impl Path<'_> {
    /// Returns the first row and one past the last.
    pub fn rows(&self) -> (i32, i32) {
        self.path.rows
    }

    /// Calls `f(row of the band, first pixel not left of the edge, whether it goes down)` for all crossings of a band,
    /// edge by edge, until it returns false. The pixel is 0 … `width`.
    #[inline(always)]
    pub fn for_each(&self, top: i32, width: usize, mut f: impl FnMut(usize, usize, bool) -> bool) {
        let width = width as i64;
        for some in self.path.edges.of_band(self.list, top) {
            for edge in some {
                let (first, last, mut x, slope) = edge.within(top);
                for row in first..last {
                    if !f(row as usize, (x >> BITS).clamp(0, width) as usize, edge.down) {
                        return;
                    }
                    x = x.wrapping_add(slope);
                }
            }
        }
    }
}

/// The buffers for filling paths in a band; used again for the next path and band.
#[derive(Debug, Default)]
pub(crate) struct CrossingFiller {
    width: usize,
    /// Number of listed crossings of each row.
    counts: [u32; BAND_ROWS as usize],
    /// Twice the pixel of each, and one where the edge goes down.
    lists: Vec<[u32; LISTED]>,
    /// Change of the winding number from the pixel to the left, for bands with more crossings.
    cells: Vec<i32>,
    /// Cells of a row: room for the one after the last pixel, a multiple of eight.
    stride: usize,
}

impl CrossingFiller {
    /// Creates buffers for rows of `width` pixels.
    pub fn new(width: u32) -> Self {
        Self {
            width: width as usize,
            counts: [0; BAND_ROWS as usize],
            lists: vec![[0; LISTED]; BAND_ROWS as usize],
            cells: Vec::new(),
            stride: (width as usize + 8) & !7,
        }
    }

    /// Fills one path: hands its pixels, row by row from the top, to the sink with coverage 255.
    #[simd]
    pub fn fill<S: Simd, K: Sink<S>>(
        simd: S,
        this: &mut Self,
        path: Path<'_>,
        top: i32,
        rule: FillRule,
        sink: &mut K,
    ) {
        if this.list(path, top) {
            this.spans(simd, (path.rows().0 - top, path.rows().1 - top), rule, sink);
        } else {
            this.count(path, top);
            Self::sweep(simd, this, path, top, rule, sink);
        }
    }

    /// Lists the crossings of each row; `false` if there are too many.
    #[inline(never)]
    fn list(&mut self, path: Path<'_>, top: i32) -> bool {
        let Self { counts, lists, width, .. } = self;
        *counts = [0; BAND_ROWS as usize];
        let mut fits = true;
        path.for_each(top, *width, |row, x, down| {
            let (Some(count), Some(list)) = (counts.get_mut(row), lists.get_mut(row)) else {
                return false;
            };
            let Some(item) = list.get_mut(*count as usize) else {
                fits = false;
                return false;
            };
            *item = (x as u32) << 1 | u32::from(down);
            *count += 1;
            true
        });
        fits
    }

    /// Sorts each row's list and passes on its spans.
    #[inline(always)]
    fn spans<S: Simd>(
        &mut self,
        simd: S,
        rows: (i32, i32),
        rule: FillRule,
        sink: &mut impl Sink<S>,
    ) {
        let rows = rows.0.max(0)..rows.1.min(BAND_ROWS);
        for ((row, count), list) in (0..).zip(&self.counts).zip(&mut self.lists) {
            let Some(list) = list.get_mut(..*count as usize).filter(|_| rows.contains(&row)) else {
                continue;
            };
            sort(list);
            let (mut winding, mut start) = (0, 0);
            for item in list {
                let before = is_inside(winding, rule);
                winding += (*item & 1) as i32 * 2 - 1;
                let x = (*item >> 1) as usize;
                if !before {
                    start = x;
                } else if start < x && !is_inside(winding, rule) {
                    sink.span(simd, row, start..x, 255);
                }
            }
        }
    }

    /// Adds each crossing to the cell of its pixel.
    #[inline(never)]
    fn count(&mut self, path: Path<'_>, top: i32) {
        let Self { cells, stride, width, .. } = self;
        cells.resize(*stride * BAND_ROWS as usize, 0);
        path.for_each(top, *width, |row, x, down| {
            if let Some(cell) = cells.get_mut(row * *stride + x) {
                *cell += i32::from(down) * 2 - 1;
            }
            true
        });
    }

    /// Sums the cells of each row, which are zero afterwards.
    #[simd]
    fn sweep<S: Simd, K: Sink<S>>(
        simd: S,
        this: &mut Self,
        path: Path<'_>,
        top: i32,
        rule: FillRule,
        sink: &mut K,
    ) {
        let (first, last) = (path.path.columns.0 as usize & !7, path.path.columns.1 as usize);
        let zero = i32x8::splat(simd, 0);
        let full = i32x8::splat(simd, 255);
        for row in (path.rows().0 - top).max(0)..(path.rows().1 - top).min(BAND_ROWS) {
            let start = row as usize * this.stride;
            let cells = this.cells.get_mut(start + first..=(start + last) | 7).unwrap_or_default();
            let mut carry = zero;
            for (x, cells) in (first..).step_by(8).zip(cells.as_chunks_mut::<8>().0) {
                let v = i32x8::from_slice(simd, cells);
                zero.store_slice(cells);
                let v = running_sums(simd, v, carry);
                carry = i32x8::splat(simd, v[7]);
                let outside = match rule {
                    FillRule::NonZero => v.simd_eq(zero),
                    FillRule::EvenOdd => (v & i32x8::splat(simd, 1)).simd_eq(zero),
                };
                if x < this.width {
                    let coverage = outside.select(zero, full);
                    sink.eight(simd, row, x, coverage.bitcast());
                }
            }
        }
    }
}

/// Puts a short list in order.
#[inline(always)]
fn sort(list: &mut [u32]) {
    if let [a, b] = list {
        (*a, *b) = ((*a).min(*b), (*a).max(*b));
        return;
    }
    for end in 1..list.len() {
        let item = list[end];
        let mut at = end;
        while at > 0 && list[at - 1] > item {
            list[at] = list[at - 1];
            at -= 1;
        }
        list[at] = item;
    }
}
