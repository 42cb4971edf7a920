//! What edges do in single rows, put in a queue and made into areas many at a time, eight at once.

use fearless_simd::prelude::*;
use fearless_simd::{i32x8, u32x8};
use fearless_simd_macros::simd;

use super::edge::{BITS, Edge, ONE};
use super::ramp::eight_deltas;
use crate::raster::bands::BAND_ROWS;

/// Parts that fit in the queue.
pub(super) const ROOM: usize = 128;
/// An edge adds one for each row of a band at most.
const FULL: usize = ROOM - BAND_ROWS as usize;

/// The edge goes upwards in its path.
const UP: u32 = 1;
/// The first, the last pixel that it touches in this row is also its neighbour's in the path.
const OWN_LEFT: u32 = 2;
const OWN_RIGHT: u32 = 4;

/// What is made of a part: bits of the pixels it touches, from its first on, and of those that count if they have been
/// touched before.
pub(super) const TOUCHED: u32 = 3;
pub(super) const COUNTED: u32 = 2;
/// It touches more than two pixels, or the second one's mark is in the next word.
pub(super) const LONG: u32 = 1 << 4;

/// The queue: each part in the same place of all lists.
#[derive(Debug, Clone)]
pub(super) struct Parts {
    pub count: usize,
    /// The first cell of the row; later the cell of the first pixel.
    pub cells: [u32; ROOM],
    /// The two ends, 16.16; later the one on the left, moved into the target, and the one on the right as seen from
    /// the pixel that the left one is in.
    pub left: [i32; ROOM],
    pub right: [i32; ROOM],
    /// 16.16 rows.
    pub height: [i32; ROOM],
    /// [`UP`], [`OWN_LEFT`], [`OWN_RIGHT`].
    flags: [u32; ROOM],
    /// See [`TOUCHED`], [`COUNTED`] and [`LONG`].
    pub marks: [u32; ROOM],
    /// Changes of covered area at the first pixel, the next and the one after, with the edge's sign, for parts that
    /// touch at most two.
    pub deltas: [[i32; ROOM]; 3],
}

impl Default for Parts {
    fn default() -> Self {
        Self {
            count: 0,
            cells: [0; ROOM],
            left: [0; ROOM],
            right: [0; ROOM],
            height: [0; ROOM],
            flags: [0; ROOM],
            marks: [0; ROOM],
            deltas: [[0; ROOM]; 3],
        }
    }
}

impl Parts {
    /// Whether it has to be emptied before the next edge.
    #[inline(always)]
    pub fn is_full(&self) -> bool {
        self.count > FULL
    }

    #[inline(always)]
    fn push(&mut self, cell: u32, x: (i32, i32), height: i32, flags: u32) {
        let i = self.count & (ROOM - 1);
        self.cells[i] = cell;
        self.left[i] = x.0;
        self.right[i] = x.1;
        self.height[i] = height;
        self.flags[i] = flags;
        self.count += 1;
    }

    /// Adds what an edge does in the rows of the band whose first row is `top`; a row has so many cells.
    #[inline(always)]
    pub fn add(&mut self, edge: &Edge, top: i32, cells: u32) {
        let (first, last) = (edge.y0 >> BITS, edge.y1 >> BITS);
        // Of paths with few edges all come by in each band.
        if last < top || first >= top + BAND_ROWS {
            return;
        }
        let flags = u32::from(edge.sign() < 0) * UP;
        // What the edge shares with its neighbour in the path at their common vertex does not count.
        let (upper, lower) = edge.chained();
        let rightwards = edge.x0 <= edge.x1;
        let own = |at: bool, left: bool| match (at, left) {
            (false, _) => 0,
            (true, true) => OWN_LEFT,
            (true, false) => OWN_RIGHT,
        };
        let (upper, lower) = (own(upper, rightwards), own(lower, !rightwards));
        if first == last {
            // Within one row, horizontal edges too: those only leave their mark.
            let height = edge.y1 - edge.y0;
            if edge.y0 & (ONE - 1) != 0 || height != 0 {
                self.push(
                    (first - top) as u32 * cells,
                    (edge.x0, edge.x1),
                    height,
                    flags | upper | lower,
                );
            }
            return;
        }
        // The first row in part, the whole rows, the last row in part.
        let steps = edge.steps();
        let head = ONE - (edge.y0 & (ONE - 1));
        let whole = if head == ONE { first } else { first + 1 };
        if head != ONE && first >= top {
            self.push((first - top) as u32 * cells, (edge.x0, steps.crossing), head, flags | upper);
        }
        let (from, to) = (whole.max(top), last.min(top + BAND_ROWS));
        let mut x = steps.at(from - whole);
        let mut cell = (from - top) as u32 * cells;
        if steps.slope.unsigned_abs() > 1 << 32 {
            for _ in from..to {
                let ends = ((x >> BITS) as i32, ((x + steps.slope) >> BITS) as i32);
                self.push(cell, ends, ONE, flags);
                x += steps.slope;
                cell += cells;
            }
        } else {
            let across = (steps.slope.unsigned_abs() >> BITS) as i32;
            x += steps.slope.min(0);
            for _ in from..to {
                let left = (x >> BITS) as i32;
                self.push(cell, (left, left + across), ONE, flags);
                x += steps.slope;
                cell += cells;
            }
        }
        let tail = edge.y1 & (ONE - 1);
        if tail != 0 && last < top + BAND_ROWS {
            let x = (steps.at(last - whole) >> BITS) as i32;
            self.push((last - top) as u32 * cells, (x, edge.x1), tail, flags | lower);
        }
    }

    /// Makes areas of what is in the queue; x is moved between 0 and the limit, 16.16.
    #[simd]
    pub fn make<S: Simd>(simd: S, this: &mut Self, limit: i32) {
        let splat = |v: i32| i32x8::splat(simd, v);
        let (zero, one) = (splat(0), splat(ONE));
        let (limit, below) = (splat(limit), splat(ONE - 1));
        let (one_bit, two_bits) = (u32x8::splat(simd, 1), u32x8::splat(simd, 3));
        let (none, all) = (u32x8::splat(simd, 0), u32x8::splat(simd, 63));
        let Self { cells, left, right, height, flags, marks, deltas: [d0, d1, d2], .. } = this;
        let groups = cells.as_chunks_mut::<8>().0.iter_mut();
        let groups = groups.zip(left.as_chunks_mut::<8>().0).zip(right.as_chunks_mut::<8>().0);
        let groups = groups.zip(height.as_chunks::<8>().0).zip(flags.as_chunks::<8>().0);
        let groups = groups.zip(marks.as_chunks_mut::<8>().0);
        let groups = groups.zip(d0.as_chunks_mut::<8>().0).zip(d1.as_chunks_mut::<8>().0);
        let groups = groups.zip(d2.as_chunks_mut::<8>().0).take(this.count.div_ceil(8));
        for ((((((((cell, left), right), height), flags), marks), out0), out1), out2) in groups {
            let (x0, x1) = (i32x8::from_slice(simd, left), i32x8::from_slice(simd, right));
            let height = i32x8::from_slice(simd, height);
            let flags = u32x8::from_slice(simd, flags);
            let from = x0.min(x1).max(zero).min(limit);
            let across = x0.max(x1).max(zero).min(limit) - from;
            let a = from & below;
            let b = a + across;
            let [c0, c1, c2] = eight_deltas(simd, a, across, height);
            let up: i32x8<S> = (flags & one_bit).bitcast();
            let flip = zero - up;
            let column: u32x8<S> = (from >> BITS).bitcast();
            let at = u32x8::from_slice(simd, cell) + column;
            let two = b.simd_gt(one);
            let touched = two.select(two_bits, one_bit);
            let own_left = (flags >> 1) & one_bit;
            let own_right = (flags >> 2) & one_bit;
            let own = own_left | two.select(own_right << 1, own_right);
            let long = b.simd_gt(one + one) | (two & (at & all).simd_eq(all));
            let long = long.select(u32x8::splat(simd, LONG), none);
            at.store_slice(cell);
            from.store_slice(left);
            b.store_slice(right);
            (touched | ((touched & (own ^ two_bits)) << COUNTED) | long).store_slice(marks);
            ((c0 ^ flip) - flip).store_slice(out0);
            ((c1 ^ flip) - flip).store_slice(out1);
            ((c2 ^ flip) - flip).store_slice(out2);
        }
    }

    /// Whether its first and its last pixel are also its neighbours' in the path.
    pub fn own(&self, i: usize) -> (bool, bool) {
        let flags = self.flags[i & (ROOM - 1)];
        (flags & OWN_LEFT != 0, flags & OWN_RIGHT != 0)
    }

    /// +1 or −1, for a part's edge that goes down or up.
    #[inline(always)]
    pub fn sign(&self, i: usize) -> i32 {
        1 - 2 * (self.flags[i & (ROOM - 1)] & UP) as i32
    }
}
