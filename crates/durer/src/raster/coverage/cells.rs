//! The accumulation buffer of one band of rows: per pixel, how much the covered area changes from
//! the pixel left of it.
//!
//! An edge adds its signed area to the pixels it crosses and its height to the one after; summing a row from the left
//! gives the integral of the winding number over each pixel. Bits beside the cells mark the pixels that an edge has
//! touched, and those that more than one chain of edges has touched: only in the latter can winding numbers differ by
//! more than one, so that the sum alone does not decide.

use fearless_simd::i32x8;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

use super::edge::{BITS, Edge, ONE};
use super::parts::{COUNTED, LONG, Parts, ROOM, TOUCHED};
use super::ramp::{Ramp, area};
use crate::raster::bands::BAND_ROWS;

/// Cells after the last pixel that edges on the border may write to.
const SPILL: usize = 64;

/// Bits of 64 pixels: those touched, and those touched by several chains of edges.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Marks {
    pub touched: u64,
    pub shared: u64,
}

/// The cells of a band; area in 1/65,536 of a pixel.
///
/// Rows are consecutive and as long as the filled path is wide, so that all but the widest paths use the same few
/// kilobytes, wherever they are on the target.
#[derive(Debug, Clone, Default)]
pub(crate) struct Cells {
    cells: Vec<i32>,
    marks: Vec<Marks>,
    /// The pixels of a row of the target.
    width: usize,
    /// The pixel that rows begin at.
    first: usize,
    /// Marks of a row.
    words: usize,
    /// Number that is not 0 once a pixel has become shared.
    pub any_shared: u64,
    /// Parts that have yet to be added.
    parts: Box<Parts>,
}

impl Cells {
    /// Creates empty cells for rows of up to `width` pixels.
    pub fn new(width: u32) -> Self {
        let words = (width as usize + SPILL).div_ceil(64);
        let rows = BAND_ROWS as usize;
        Self {
            cells: vec![0; words * 64 * rows + SPILL],
            marks: vec![Marks::default(); words * rows],
            width: width as usize,
            first: 0,
            words,
            any_shared: 0,
            parts: Box::default(),
        }
    }

    /// Makes room for a path between two columns of pixels; the cells have to be empty.
    pub fn lay_out(&mut self, columns: (i32, i32)) {
        // Rounding may move an edge by less than a pixel; groups of eight pixels are aligned with the target's.
        self.first = (columns.0 - 1).max(0) as usize & !7;
        // Edges also change the two cells after the last pixel they touch.
        let last = (columns.1.max(0) as usize).min(self.width) + 2;
        self.words = (last.max(self.first) - self.first) / 64 + 1;
    }

    /// Returns the pixel that rows begin at.
    #[inline(always)]
    pub fn first(&self) -> usize {
        self.first
    }

    /// Returns one row of the band: its cells and its marks, 64 cells to a mark.
    #[inline(always)]
    pub fn row(&mut self, row: i32) -> (&mut [i32], &mut [Marks]) {
        let (from, to) = (row as usize * self.words, (row as usize + 1) * self.words);
        let cells = self.cells.get_mut(from * 64..to * 64).unwrap_or_default();
        (cells, self.marks.get_mut(from..to).unwrap_or_default())
    }

    /// Returns all cells, 64 of them for each mark, all marks, row by row, and how many marks a row
    /// has.
    #[inline(always)]
    pub fn words(&mut self) -> (&mut [[i32; 64]], &mut [Marks], usize) {
        (self.cells.as_chunks_mut::<64>().0, &mut self.marks, self.words)
    }

    /// Returns the marks of one row of the band.
    pub fn marks_of(&self, row: i32) -> &[Marks] {
        let start = row.clamp(0, BAND_ROWS - 1) as usize * self.words;
        self.marks.get(start..start + self.words).unwrap_or_default()
    }

    /// Adds the part of an edge within the band whose first row is `top`, at the latest when they are flushed; with
    /// `shared`, keeps account of the pixels that several chains touch.
    #[inline(always)]
    pub fn add<S: Simd>(&mut self, simd: S, edge: &Edge, top: i32, shared: bool) {
        self.parts.add(simd, edge, top, (self.words * 64) as u32);
        if self.parts.is_full() {
            Self::flush(simd, self, shared);
        }
    }

    /// Adds the edges that are still in the queue.
    #[simd]
    pub fn flush<S: Simd>(simd: S, this: &mut Self, shared: bool) {
        let columns = (this.width - this.first.min(this.width)) as i32;
        Parts::make(simd, &mut this.parts, columns << BITS);
        if shared {
            this.add_parts::<S, true>(simd);
        } else {
            this.add_parts::<S, false>(simd);
        }
        this.parts.count = 0;
    }

    #[inline(always)]
    fn add_parts<S: Simd, const SHARED: bool>(&mut self, simd: S) {
        let mut any = 0;
        for i in 0..self.parts.count.min(ROOM) {
            let Parts { cells, marks, deltas, .. } = &*self.parts;
            let (at, bits) = (cells[i] as usize, marks[i]);
            if bits & LONG != 0 {
                self.long_part::<S, SHARED>(simd, i);
                continue;
            }
            if let Some([c0, c1, c2]) = self.cells.get_mut(at..at + 3) {
                *c0 = c0.wrapping_add(deltas[0][i]);
                *c1 = c1.wrapping_add(deltas[1][i]);
                *c2 = c2.wrapping_add(deltas[2][i]);
            }
            if let Some(marks) = self.marks.get_mut(at >> 6) {
                if SHARED {
                    let again = marks.touched & (u64::from(bits >> COUNTED) << (at & 63));
                    marks.shared |= again;
                    any |= again;
                }
                marks.touched |= u64::from(bits & TOUCHED) << (at & 63);
            }
        }
        self.any_shared |= any;
    }

    /// Adds a part that touches more than two pixels, or two in different words.
    #[inline(always)]
    fn long_part<S: Simd, const SHARED: bool>(&mut self, simd: S, i: usize) {
        let Parts { cells, left, right, height, .. } = &*self.parts;
        let (at, left, right) = (cells[i] as usize, left[i], right[i]);
        let column = (left >> BITS) as usize;
        let first = at - column;
        let ramp = Ramp::new(left, (left & !(ONE - 1)) + right, height[i], i32::MAX);
        let end = if right > 2 * ONE { ramp.end as usize } else { column + 2 };
        self.mark::<SHARED>(first >> 6, (column, end), self.parts.own(i));
        self.wide_part(simd, first, &ramp, self.parts.sign(i));
    }

    /// Marks the pixels of a row from `start` to before `end`. `own` tells whether the first and the last one are also
    /// the neighbours' in the path, and so do not become shared.
    #[inline(never)]
    fn mark<const SHARED: bool>(
        &mut self,
        base: usize,
        (start, end): (usize, usize),
        own: (bool, bool),
    ) {
        let mut at = start;
        while at < end {
            let stop = end.min((at | 63) + 1);
            let bits = (u64::MAX >> (64 - (stop - at))) << (at & 63);
            if let Some(marks) = self.marks.get_mut(base + (at >> 6)) {
                if SHARED {
                    let first = u64::from(own.0 && at == start) << (at & 63);
                    let last = u64::from(own.1 && stop == end) << ((stop - 1) & 63);
                    let again = marks.touched & bits & !first & !last;
                    marks.shared |= again;
                    self.any_shared |= again;
                }
                marks.touched |= bits;
            }
            at = stop;
        }
    }

    /// Adds an edge within one row that crosses three pixels or more; its marks are set already.
    #[inline(always)]
    fn wide_part<S: Simd>(&mut self, simd: S, first: usize, ramp: &Ramp, sign: i32) {
        let flip = i32x8::splat(simd, (sign - 1) >> 1);
        let (mut before, mut x) = (i32x8::splat(simd, 0), ramp.first);
        while x <= ramp.last + 1 {
            let at = first + x as usize;
            let Some(cells) = self.cells.get_mut(at..at + 8) else { return };
            // A cell stores the difference of its pixel's area from the previous one.
            let area = area(simd, ramp, x);
            let delta = area - before.slide::<7>(area);
            before = area;
            let sum = i32x8::from_slice(simd, cells) + (delta ^ flip) - flip;
            sum.store_slice(cells);
            x += 8;
        }
    }
}
