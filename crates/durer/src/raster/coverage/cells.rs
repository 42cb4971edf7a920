//! The accumulation buffer of one band of rows: per pixel, how much the covered area changes from
//! the pixel left of it.
//!
//! An edge adds its signed area to the pixels it crosses and its height to the one after; summing a
//! row from the left gives the integral of the winding number over each pixel. Bits beside the cells
//! tell which pixels an edge has touched, and which more than one chain of edges has: only in those
//! can windings differ by more than one, and the sum alone not decide.

use super::edge::{BITS, Edge, ONE};
use super::ramp::{Ramp, half_inverse, narrow_deltas, steep_deltas};
use crate::raster::bands::BAND_ROWS;

/// Cells to the right of the last pixel that edges on the border may write to.
const SPILL: usize = 64;

/// Which of 64 pixels have been touched, and which by several chains of edges.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Marks {
    pub touched: u64,
    pub shared: u64,
}

/// What an edge does within one row: from `x0` at its upper to `x1` at its lower end, 16.16.
struct Part {
    x0: i32,
    x1: i32,
    /// 16.16 rows.
    height: i32,
    /// Whether the pixel of the upper, of the lower end is also its neighbour's in the path.
    upper: bool,
    lower: bool,
}

/// The cells of a band; area in 1/65,536 of a pixel.
#[derive(Debug, Clone, Default)]
pub(crate) struct Cells {
    cells: Vec<i32>,
    marks: Vec<Marks>,
    words: usize,
    /// Columns an edge may start in.
    columns: i32,
    /// Not 0 once a pixel has become shared.
    pub any_shared: u64,
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
            any_shared: 0,
        }
    }

    /// One row of the band, between two words: its cells and its marks, 64 cells to a mark.
    #[inline(always)]
    pub fn row(&mut self, row: i32, words: (usize, usize)) -> (&mut [i32], &mut [Marks]) {
        let start = row as usize * self.words;
        let (from, to) = (start + words.0, start + words.1.min(self.words));
        let cells = self.cells.get_mut(from * 64..to * 64).unwrap_or_default();
        (cells, self.marks.get_mut(from..to).unwrap_or_default())
    }

    /// All cells, 64 of them for each mark, all marks, row by row, and how many marks a row has.
    #[inline(always)]
    pub fn words(&mut self) -> (&mut [[i32; 64]], &mut [Marks], usize) {
        (self.cells.as_chunks_mut::<64>().0, &mut self.marks, self.words)
    }

    /// The marks of one row of the band.
    pub fn marks_of(&self, row: i32) -> &[Marks] {
        let start = row.clamp(0, BAND_ROWS - 1) as usize * self.words;
        &self.marks[start..start + self.words]
    }

    /// Adds the part of an edge within the band whose first row is `top`; with `SHARED`, keeps account of
    /// the pixels that several chains touch.
    #[inline(always)]
    pub fn add<const SHARED: bool>(&mut self, edge: &Edge, top: i32) {
        let (first, last) = (edge.y0 >> BITS, edge.y1 >> BITS);
        // Of paths with few edges all come by in each band.
        if last < top || first >= top + BAND_ROWS {
            return;
        }
        // What the edge shares with its neighbour in the path at their common vertex does not count.
        let (upper, lower) = if SHARED { edge.chained() } else { (false, false) };
        if first == last {
            // Within one row, horizontal edges too: those only leave their mark.
            let height = edge.y1 - edge.y0;
            if edge.y0 & (ONE - 1) != 0 || height != 0 {
                let part = Part { x0: edge.x0, x1: edge.x1, height, upper, lower };
                self.part::<SHARED>(first - top, &part, edge.sign());
            }
            return;
        }
        // The first row in part, the whole rows, the last row in part.
        let steps = edge.steps();
        let sign = edge.sign();
        let head = ONE - (edge.y0 & (ONE - 1));
        let whole = if head == ONE { first } else { first + 1 };
        if head != ONE && first >= top {
            let part = Part { x0: edge.x0, x1: steps.crossing, height: head, upper, lower: false };
            self.part::<SHARED>(first - top, &part, sign);
        }
        let from = whole.max(top);
        let to = last.min(top + BAND_ROWS);
        if from < to {
            self.whole_rows::<SHARED>(
                steps.slope,
                steps.at(from - whole),
                (from - top, to - top),
                sign,
            );
        }
        let tail = edge.y1 & (ONE - 1);
        if tail != 0 && last < top + BAND_ROWS {
            let x = (steps.at(last - whole) >> BITS) as i32;
            let part = Part { x0: x, x1: edge.x1, height: tail, upper: false, lower };
            self.part::<SHARED>(last - top, &part, sign);
        }
    }

    /// Rows that the edge crosses from top to bottom; x is where it enters the first, 32.32.
    #[inline(always)]
    fn whole_rows<const SHARED: bool>(
        &mut self,
        slope: i64,
        x: i64,
        (from, to): (i32, i32),
        sign: i32,
    ) {
        let across = slope.unsigned_abs() as i64;
        if across > 1 << 32 {
            let mut x = x;
            for row in from..to {
                let (x0, x1) = ((x >> BITS) as i32, ((x + slope) >> BITS) as i32);
                let part = Part { x0, x1, height: ONE, upper: false, lower: false };
                self.part::<SHARED>(row, &part, sign);
                x += slope;
            }
            return;
        }
        // Steep: at most two pixels per row, so three cells, without a branch or a division.
        let flip = (sign - 1) >> 1;
        let mut left = x + slope.min(0);
        let limit = i64::from(self.columns) << 32;
        let across = (across >> BITS) as i32;
        let half_inverse = half_inverse(across);
        let mut base = from as u32 * self.words as u32;
        for _ in from..to {
            let l = left.clamp(0, limit) as u64;
            let a = (l >> BITS) as i32 & (ONE - 1);
            let column = (l >> 32) as u32;
            let b = a + across;
            let deltas = steep_deltas(a, b, half_inverse);
            let at = base.wrapping_mul(64).wrapping_add(column) as usize;
            if let Some(cells) = self.cells.get_mut(at..at + 3) {
                for (cell, delta) in cells.iter_mut().zip(deltas) {
                    *cell = cell.wrapping_add((delta ^ flip) - flip);
                }
            }
            self.mark_two::<SHARED>(base as usize, column as usize, b > ONE, 0);
            base += self.words as u32;
            left += slope;
        }
    }

    /// Marks a pixel and perhaps the one right of it; `base` is the row's first word. What is set in `own`
    /// is not taken for shared.
    #[inline(always)]
    fn mark_two<const SHARED: bool>(&mut self, base: usize, column: usize, two: bool, own: u64) {
        let bit = column & 63;
        let bits = 1 | (u64::from(two) << 1);
        if let Some(marks) = self.marks.get_mut(base + (column >> 6)) {
            if SHARED {
                let again = marks.touched & ((bits & !own) << bit);
                marks.shared |= again;
                self.any_shared |= again;
            }
            marks.touched |= bits << bit;
        }
        if two && bit == 63 {
            self.mark::<SHARED>(base, (column + 1, column + 2), (own & 2 != 0, false));
        }
    }

    /// Marks the pixels of a row from the first to before the second column, of which the first and the
    /// last may not be taken for shared.
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

    /// An edge within one row.
    #[inline(always)]
    fn part<const SHARED: bool>(&mut self, row: i32, part: &Part, sign: i32) {
        if !(0..BAND_ROWS).contains(&row) {
            return;
        }
        let base = row as usize * self.words;
        let limit = self.columns << BITS;
        let &Part { x0, x1, height, upper, lower } = part;
        let (own_left, own_right) = if x0 <= x1 { (upper, lower) } else { (lower, upper) };
        let (left, right) = (x0.min(x1).clamp(0, limit), x0.max(x1).clamp(0, limit));
        let column = (left >> BITS) as usize;
        let (a, b) = (left & (ONE - 1), right - (left & !(ONE - 1)));
        if b > 2 * ONE {
            let ramp = Ramp::wide(left, right, height);
            self.mark::<SHARED>(base, (column, ramp.end as usize), (own_left, own_right));
            self.wide_part(base, &ramp, sign);
            return;
        }
        let two = b > ONE;
        let own = u64::from(own_left) | (u64::from(own_right) << u32::from(two));
        self.mark_two::<SHARED>(base, column, two, own);
        let deltas = narrow_deltas(a, b, height);
        if let Some(cells) = self.cells.get_mut(base * 64 + column..base * 64 + column + 3) {
            for (cell, delta) in cells.iter_mut().zip(deltas) {
                *cell = cell.wrapping_add(delta * sign);
            }
        }
    }

    /// An edge within one row that crosses three pixels or more; its marks are set.
    #[inline(never)]
    fn wide_part(&mut self, base: usize, ramp: &Ramp, sign: i32) {
        let (first, last) = (ramp.first as usize, ramp.last as usize);
        let Some(cells) = self.cells.get_mut(base * 64 + first..base * 64 + last + 2) else {
            return;
        };
        // A cell gets the difference of its pixel's area from the one before.
        let mut previous = 0_i32;
        let mut put = |cell: &mut i32, area: i32| {
            *cell = cell.wrapping_add((area - previous) * sign);
            previous = area;
        };
        let mut area = ramp.start;
        if let [head, middle @ .., before_last, after_last] = cells {
            put(head, ramp.head);
            for cell in middle {
                area = area.wrapping_add(ramp.per_pixel);
                put(cell, (area >> BITS) as i32);
            }
            put(before_last, ramp.tail);
            put(after_last, ramp.height);
        }
    }
}
