//! The accumulation buffer of one band of rows: per pixel, how much the covered area changes from
//! the pixel left of it.
//!
//! An edge adds its signed area to the pixels it crosses and its height to the one after; summing a
//! row from the left gives the integral of the winding number over each pixel. Bits beside the cells
//! tell which pixels an edge has touched, and which more than one chain of edges has: only in those
//! can windings differ by more than one, and the sum alone not decide.

use super::edge::{BITS, Edge, ONE};

/// Rows of a band: small enough for the cells to stay in the second-level cache.
pub(crate) const BAND_ROWS: i32 = 32;
/// Cells to the right of the last pixel that edges on the border may write to.
const SPILL: usize = 64;

/// Which of 64 pixels have been touched, and which by several chains of edges.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Marks {
    pub touched: u64,
    pub shared: u64,
}

/// The cells of a band; area in 1/65,536 of a pixel.
#[derive(Debug, Clone, Default)]
pub(crate) struct Cells {
    cells: Vec<i32>,
    marks: Vec<Marks>,
    words: usize,
    /// Columns an edge may start in.
    columns: i32,
    /// Pixels touched since the last clearing, each time counted.
    pub touches: u64,
}

impl Cells {
    /// Empty cells for rows of `width` pixels.
    pub fn new(width: u32) -> Self {
        let words = (width as usize + SPILL).div_ceil(64);
        let rows = BAND_ROWS as usize;
        Self {
            cells: vec![0; words * 64 * rows],
            marks: vec![Marks::default(); words * rows],
            words,
            columns: width as i32,
            touches: 0,
        }
    }

    /// One row of the band: its cells and its marks, 64 cells to a mark.
    pub fn row(&mut self, row: i32) -> (&mut [i32], &mut [Marks]) {
        let start = row.clamp(0, BAND_ROWS - 1) as usize * self.words;
        let cells = &mut self.cells[start * 64..(start + self.words) * 64];
        (cells, &mut self.marks[start..start + self.words])
    }

    /// The marks of one row of the band.
    pub fn marks_of(&self, row: i32) -> &[Marks] {
        let start = row.clamp(0, BAND_ROWS - 1) as usize * self.words;
        &self.marks[start..start + self.words]
    }

    /// Adds the part of an edge within the band whose first row is `top`.
    #[inline(always)]
    pub fn add(&mut self, edge: &Edge, top: i32) {
        let chained = edge.chained();
        if chained[0].is_none() && chained[1].is_none() {
            self.add_unchained(edge, top);
            return;
        }
        // What the edge shares with its neighbour in the path at their common vertex does not count.
        let saved = chained.map(|c| c.and_then(|(row, x)| self.peek(row - top, x)));
        self.add_unchained(edge, top);
        for (word, bits, before) in saved.into_iter().flatten() {
            if let Some(marks) = self.marks.get_mut(word) {
                marks.shared = (marks.shared & !bits) | before;
            }
        }
    }

    /// The shared bit of a vertex's pixel: index of the word, mask, present value.
    #[inline(always)]
    fn peek(&self, row: i32, x: i32) -> Option<(usize, u64, u64)> {
        if !(0..BAND_ROWS).contains(&row) {
            return None;
        }
        let column = x >> BITS;
        let word = row as usize * self.words + (column >> 6) as usize;
        let bits = 1 << (column & 63);
        self.marks.get(word).map(|m| (word, bits, m.shared & bits))
    }

    #[inline(always)]
    fn add_unchained(&mut self, edge: &Edge, top: i32) {
        let (first, last) = (edge.y0 >> BITS, edge.y1 >> BITS);
        if first == last {
            // Within one row, horizontal edges too: those only leave their mark.
            let height = edge.y1 - edge.y0;
            if (0..BAND_ROWS).contains(&(first - top)) && edge.y0 & (ONE - 1) != 0 || height != 0 {
                self.part(first - top, edge.x0, edge.x1, height, edge.sign());
            }
            return;
        }
        // The first row in part, the whole rows, the last row in part.
        let head = ONE - (edge.y0 & (ONE - 1));
        let whole = if head == ONE { first } else { first + 1 };
        if head != ONE {
            self.part(first - top, edge.x0, edge.crossing, head, edge.sign());
        }
        let from = whole.max(top);
        let to = last.min(top + BAND_ROWS);
        let x = (i64::from(edge.crossing) << BITS)
            + edge.slope.wrapping_mul(i64::from(from.max(whole) - whole));
        if from < to {
            self.whole_rows(edge, x, from - top, to - top);
        }
        let tail = edge.y1 & (ONE - 1);
        if tail != 0 && last >= top && last < top + BAND_ROWS {
            let rows = i64::from(last - whole);
            let x = (i64::from(edge.crossing) << BITS) + edge.slope.wrapping_mul(rows);
            self.part(last - top, (x >> BITS) as i32, edge.x1, tail, edge.sign());
        }
    }

    /// Rows that the edge crosses from top to bottom; x is where it enters the first, 32.32.
    #[inline(always)]
    fn whole_rows(&mut self, edge: &Edge, x: i64, from: i32, to: i32) {
        let slope = edge.slope.unsigned_abs() as i64;
        if slope > 1 << 32 {
            let mut x = x;
            for row in from..to {
                let next = x + edge.slope;
                self.part(row, (x >> BITS) as i32, (next >> BITS) as i32, ONE, edge.sign());
                x = next;
            }
            return;
        }
        // Steep: at most two pixels per row, so three cells, without a branch or a division.
        let inverse = (281_474_976_710_656.0 / slope.max(1 << 16) as f64) as u64;
        let flip = (edge.sign() - 1) >> 1;
        let mut left = x + edge.slope.min(0);
        let limit = i64::from(self.columns) << 32;
        let words = self.words;
        for row in from..to {
            let l = left.clamp(0, limit);
            let a = (l >> BITS) as u32 & 0xffff;
            let column = (l >> 32) as usize;
            let b = a + (slope >> BITS) as u32;
            let deltas = steep_deltas(a, b, |over| ((u64::from(over) * inverse) >> BITS) as u32);
            let word = row as usize * words;
            if let Some(cells) = self.cells.get_mut(word * 64 + column..word * 64 + column + 3) {
                for (cell, delta) in cells.iter_mut().zip(deltas) {
                    *cell = cell.wrapping_add((delta ^ flip) - flip);
                }
            }
            self.mark_two(row, column, b > ONE as u32);
            left += edge.slope;
        }
        self.touches += (to - from) as u64;
    }

    /// Marks a pixel and perhaps the one right of it.
    #[inline(always)]
    fn mark_two(&mut self, row: i32, column: usize, two: bool) {
        let word = row as usize * self.words + (column >> 6);
        let bit = column & 63;
        let bits = (1 | (u64::from(two) << 1)) << bit;
        if let Some(marks) = self.marks.get_mut(word) {
            marks.shared |= marks.touched & bits;
            marks.touched |= bits;
        }
        if two && bit == 63 {
            self.mark(row, column + 1, column + 2);
        }
    }

    /// Marks the pixels of a row from `start` to before `end`.
    #[inline(never)]
    fn mark(&mut self, row: i32, start: usize, end: usize) {
        let base = row as usize * self.words;
        let mut at = start;
        while at < end {
            let stop = end.min((at | 63) + 1);
            let bits = (u64::MAX >> (64 - (stop - at))) << (at & 63);
            if let Some(marks) = self.marks.get_mut(base + (at >> 6)) {
                marks.shared |= marks.touched & bits;
                marks.touched |= bits;
            }
            at = stop;
        }
        self.touches += (end - start) as u64;
    }

    /// An edge within one row, from `x0` at its upper to `x1` at its lower end, 16.16.
    #[inline(always)]
    fn part(&mut self, row: i32, x0: i32, x1: i32, height: i32, sign: i32) {
        if !(0..BAND_ROWS).contains(&row) {
            return;
        }
        let limit = self.columns << BITS;
        let (left, right) = (x0.min(x1).clamp(0, limit), x0.max(x1).clamp(0, limit));
        let column = (left >> BITS) as usize;
        let (a, b) = ((left & (ONE - 1)) as u32, (right - (left & !(ONE - 1))) as u32);
        if b > 2 * ONE as u32 {
            self.wide_part(row, left, right, height, sign);
            return;
        }
        self.mark_two(row, column, b > ONE as u32);
        self.touches += 1;
        let [d0, _, d2] = steep_deltas(a, b, |over| (over << 15) / (b - a).max(1) * 2);
        let scale = |delta: i32| ((i64::from(delta) * i64::from(height)) >> BITS) as i32;
        let deltas = [scale(d0), height - scale(d0) - scale(d2), scale(d2)];
        let start = row as usize * self.words * 64 + column;
        if let Some(cells) = self.cells.get_mut(start..start + 3) {
            for (cell, delta) in cells.iter_mut().zip(deltas) {
                *cell = cell.wrapping_add(delta * sign);
            }
        }
    }

    /// An edge within one row that crosses three pixels or more.
    #[inline(never)]
    fn wide_part(&mut self, row: i32, left: i32, right: i32, height: i32, sign: i32) {
        let (first, last) = ((left >> BITS) as usize, (right >> BITS) as usize);
        self.mark(row, first, last + usize::from(right & (ONE - 1) != 0));
        let start = row as usize * self.words * 64;
        let Some(cells) = self.cells.get_mut(start + first..start + last + 2) else { return };
        // Covered height per pixel of width, with 32 bits below one.
        let per_pixel = (f64::from(height) / f64::from(right - left) * 4_294_967_296.0) as u64;
        let before = (ONE - (left & (ONE - 1))) as u64;
        let after = (right & (ONE - 1)) as u64;
        // Covered area of each pixel in turn; a cell gets its difference from the one before.
        let mut previous = 0_i32;
        let mut put = |cell: &mut i32, area: i32| {
            *cell = cell.wrapping_add((area - previous) * sign);
            previous = area;
        };
        let triangle = |side: u64| ((per_pixel * ((side * side) >> BITS)) >> (2 * BITS + 1)) as i32;
        let inner = cells.len() - 3;
        let mut area = ((per_pixel * before) >> BITS) + per_pixel / 2;
        if let [head, middle @ .., before_last, after_last] = cells {
            put(head, triangle(before));
            for cell in middle.iter_mut().take(inner) {
                put(cell, (area >> BITS) as i32);
                area += per_pixel;
            }
            put(before_last, height - triangle(after));
            put(after_last, height);
        }
    }
}

/// Changes of covered area at the pixel of `a`, the next and the one after, for an edge that crosses
/// a whole row from `a` to `b`, 16.16 relative to the pixel's left border, `a` < 1 and `b` ≤ 2.
///
/// `ratio` is what lies right of the first pixel over the edge's whole width, in 1/65,536. The three
/// add up to one exactly.
#[inline(always)]
fn steep_deltas(a: u32, b: u32, ratio: impl Fn(u32) -> u32) -> [i32; 3] {
    let middle = ((a + b) >> 1) as i32;
    let over = b.saturating_sub(ONE as u32);
    // The triangle right of the border between the pixels: half of its width times its height.
    let d2 = ((u64::from(over) * u64::from(ratio(over))) >> (BITS + 1)) as i32;
    // Rounding can make the first one −1.
    let d0 = (ONE + d2 - middle).max(0);
    [d0, ONE - d0 - d2, d2]
}
