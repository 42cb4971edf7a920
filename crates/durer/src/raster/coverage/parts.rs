//! The contributions of edges to single rows, queued and turned into areas eight at a time.

use fearless_simd::prelude::*;
use fearless_simd::{i32x8, u32x8};
use fearless_simd_macros::simd;

use super::edge::{BITS, Edge, ONE};
use super::ramp::{Stepped, eight_deltas};
use crate::raster::bands::BAND_ROWS;

/// Parts that fit in the queue.
pub(super) const ROOM: usize = 128;
/// An edge adds one for each row of a band at most.
const FULL: usize = ROOM - BAND_ROWS as usize;
/// Places of a list: eight are written at a time, whether this many are meant or not.
const PLACES: usize = ROOM + 8;

/// The edge goes upwards in its path.
const UP: u32 = 1;
/// The first, the last pixel that it touches in this row is also its neighbour's in the path.
const OWN_LEFT: u32 = 2;
const OWN_RIGHT: u32 = 4;

/// Flags in the result of a part: bits of the pixels it touches, from its first on, and of the pixels that become
/// shared if they have been touched before.
pub(super) const TOUCHED: u32 = 3;
pub(super) const COUNTED: u32 = 2;
/// It touches more than two pixels, or the second one's mark is in the next word.
pub(super) const LONG: u32 = 1 << 4;

/// The queue: each part in the same place of all lists.
#[derive(Debug, Clone)]
pub(super) struct Parts {
    pub count: usize,
    /// The first cell of the row; later the cell of the first pixel.
    pub cells: [u32; PLACES],
    /// The two ends, 16.16; later the one on the left, moved into the target, and the one on the right as seen from
    /// the pixel that the left one is in.
    pub left: [i32; PLACES],
    pub right: [i32; PLACES],
    /// 16.16 rows.
    pub height: [i32; PLACES],
    /// [`UP`], [`OWN_LEFT`], [`OWN_RIGHT`].
    flags: [u32; PLACES],
    /// See [`TOUCHED`], [`COUNTED`] and [`LONG`].
    pub marks: [u32; PLACES],
    /// Changes of covered area at the first pixel, the next and the one after, with the edge's sign, for parts that
    /// touch at most two.
    pub deltas: [[i32; PLACES]; 3],
}

impl Default for Parts {
    fn default() -> Self {
        Self {
            count: 0,
            cells: [0; PLACES],
            left: [0; PLACES],
            right: [0; PLACES],
            height: [0; PLACES],
            flags: [0; PLACES],
            marks: [0; PLACES],
            deltas: [[0; PLACES]; 3],
        }
    }
}

impl Parts {
    /// Returns whether it has to be emptied before the next edge.
    #[inline(always)]
    pub fn is_full(&self) -> bool {
        self.count > FULL
    }

    /// Adds the contribution of an edge to the rows of the band whose first row is `top`; a row has `cells` cells.
    ///
    /// Edges of several rows are added eight rows at a time, the first and the last among them: to guess how long an
    /// edge is costs more than rows that are not meant.
    #[inline(always)]
    pub fn add<S: Simd>(&mut self, simd: S, edge: &Edge, top: i32, cells: u32) {
        let (first, last) = (edge.y0 >> BITS, edge.y1 >> BITS);
        // Horizontal edges leave their mark, but not on the border of two rows.
        let end = (edge.y1 + ONE - 1) >> BITS;
        let (from, to) = (first.max(top), end.min(top + BAND_ROWS));
        // Paths with few edges pass all of them to each band.
        if from >= to {
            return;
        }
        // The pixel that the edge shares with its neighbour in the path at their common vertex does not count.
        let (upper, lower) = edge.chained();
        let rightwards = edge.x0 <= edge.x1;
        let own = |at: bool, left: bool| match (at, left) {
            (false, _) => 0,
            (true, true) => OWN_LEFT,
            (true, false) => OWN_RIGHT,
        };
        let (upper, lower) = (own(upper, rightwards), own(lower, !rightwards));
        let up = u32::from(edge.sign() < 0) * UP;
        if first == last {
            let i = self.count & (ROOM - 1);
            self.cells[i] = (first - top) as u32 * cells;
            (self.left[i], self.right[i]) = (edge.x0, edge.x1);
            self.height[i] = edge.y1 - edge.y0;
            self.flags[i] = up | upper | lower;
            self.count += 1;
            return;
        }
        let splat = |v: i32| i32x8::splat(simd, v);
        let bits = |v: u32| u32x8::splat(simd, v);
        let up = bits(up);
        let lane = i32x8::from_slice(simd, &[0, 1, 2, 3, 4, 5, 6, 7]);
        let lane_bits: u32x8<S> = lane.bitcast();
        let steps = edge.steps();
        // The row below the first border that the edge crosses.
        let whole = (edge.y0 + ONE - 1) >> BITS;
        let across = (steps.slope.unsigned_abs() >> BITS) as i32;
        // Edges that cross at most two pixels of a row are equally wide in all whole rows.
        let steep = if steps.slope.unsigned_abs() <= 1 << 32 { ONE } else { i32::MIN };
        let stepped = Stepped::new(simd, steps.slope);
        let mut row = from;
        while row < to {
            let first_x = steps.at(row - whole);
            let x = stepped.from(simd, first_x);
            let next = stepped.from(simd, first_x + steps.slope);
            let rows = splat(row) + lane;
            let (is_first, is_last) = (rows.simd_eq(splat(first)), rows.simd_eq(splat(last)));
            let border = rows << BITS;
            let height = (border + splat(ONE)).min(splat(edge.y1)) - border.max(splat(edge.y0));
            let is_steep = height.simd_eq(splat(steep));
            let left = if steps.slope < 0 { next } else { x };
            let right = is_steep.select(left + splat(across), is_last.select(splat(edge.x1), next));
            let left = is_steep.select(left, is_first.select(splat(edge.x0), x));
            let flags = is_first.select(bits(upper), bits(0)) | is_last.select(bits(lower), up);
            let cell = bits((row - top) as u32 * cells) + lane_bits * bits(cells);
            let at = self.count.min(ROOM);
            cell.store_slice(&mut self.cells[at..at + 8]);
            left.store_slice(&mut self.left[at..at + 8]);
            right.store_slice(&mut self.right[at..at + 8]);
            height.store_slice(&mut self.height[at..at + 8]);
            (flags | up).store_slice(&mut self.flags[at..at + 8]);
            self.count += (to - row).min(8) as usize;
            row += 8;
        }
    }

    /// Makes areas of the edges in the queue; x is moved between 0 and the limit, 16.16.
    #[simd]
    pub fn make<S: Simd>(simd: S, this: &mut Self, limit: i32) {
        let splat = |v: i32| i32x8::splat(simd, v);
        let (zero, one) = (splat(0), splat(ONE));
        let (limit, below) = (splat(limit), splat(ONE - 1));
        let (one_bit, two_bits) = (u32x8::splat(simd, 1), u32x8::splat(simd, 3));
        let (none, all) = (u32x8::splat(simd, 0), u32x8::splat(simd, 63));
        let Self { cells, left, right, height, flags, marks, deltas: [d0, d1, d2], .. } = this;
        // Columns of the queue, eight parts at a time.
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
            // Extent in x within the target; `a` and `b` are counted from the left border of the first pixel.
            let from = x0.min(x1).max(zero).min(limit);
            let across = x0.max(x1).max(zero).min(limit) - from;
            let a = from & below;
            let b = a + across;
            // Changes of the area in up to three cells; parts that go up count negatively.
            let [c0, c1, c2] = eight_deltas(simd, a, across, height);
            let up: i32x8<S> = (flags & one_bit).bitcast();
            let flip = zero - up;
            // The cell of the first pixel, and the pixels touched: the second one if the part extends beyond the first.
            let column: u32x8<S> = (from >> BITS).bitcast();
            let at = u32x8::from_slice(simd, cell) + column;
            let two = b.simd_gt(one);
            let touched = two.select(two_bits, one_bit);
            // A pixel that the neighbour in the path touches as well does not become shared by that.
            let own_left = (flags >> 1) & one_bit;
            let own_right = (flags >> 2) & one_bit;
            let own = own_left | two.select(own_right << 1, own_right);
            // Parts of more than two pixels, or across two words of marks, are completed one by one.
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

    /// Returns whether its first and its last pixel are also its neighbours' in the path.
    pub fn own(&self, i: usize) -> (bool, bool) {
        let flags = self.flags[i & (ROOM - 1)];
        (flags & OWN_LEFT != 0, flags & OWN_RIGHT != 0)
    }

    /// Returns +1 for a part's edge that goes down, −1 for one that goes up.
    #[inline(always)]
    pub fn sign(&self, i: usize) -> i32 {
        1 - 2 * (self.flags[i & (ROOM - 1)] & UP) as i32
    }
}
