//! Small convex outlines: all pixels around them are summed, so touched pixels need not be remembered.
//!
//! The same integers as in [`super::cells`], added up almost without branches: a steep edge in eight rows at once, a
//! flat one row by row, eight pixels at once.

use fearless_simd::i32x8;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

use super::FillRule;
use super::edge::{BITS, Edge, ONE, Steps};
use super::ramp::{Ramp, area, eight_deltas};
use super::sweep::{Sink, lanes};
use crate::raster::bands::{BAND_ROWS, running_sums};

/// Pixels between the first and the last one of a row, at most.
pub(super) const WIDEST: i32 = 31;
/// Number of cells in a row: the pixels, and room for one vector addition at the end.
const CELLS: usize = WIDEST as usize + 9;
/// Rows that are added at once.
const AT_ONCE: usize = 8;
/// Largest x of an edge, 16.16.
const LIMIT: i32 = ((WIDEST + 1) << BITS) - 1;

/// A row of cells, as in [`super::cells`].
type Row = [i32; CELLS];

/// The cells of a band, and some rows more than it has, because they are added several at a time.
#[derive(Debug)]
pub(super) struct SmallCells {
    rows: Vec<Row>,
}

impl Default for SmallCells {
    fn default() -> Self {
        Self { rows: vec![[0; CELLS]; BAND_ROWS as usize + AT_ONCE] }
    }
}

/// Part of a band that an outline touches.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touched {
    /// First row and one past the last.
    pub rows: (i32, i32),
    /// First and last pixel, not more than [`WIDEST`] apart.
    pub columns: (i32, i32),
}

/// Fills a convex outline within the target in the band at row `top`.
#[simd]
pub(super) fn fill<S: Simd, K: Sink<S>>(
    simd: S,
    cells: &mut SmallCells,
    edges: &[Edge],
    touched: Touched,
    top: i32,
    sink: &mut K,
) {
    let Touched { rows, columns } = touched;
    let (first, end) = (rows.0.max(top), rows.1.min(top + BAND_ROWS));
    // Each edge adds its area and height to the cells of its rows.
    for edge in edges {
        let edge = edge.moved(columns.0 << BITS);
        let (from, to) = edge.rows();
        let (from, to) = (from.max(first), to.min(end));
        if from >= to || edge.y0 == edge.y1 {
            continue;
        }
        let steps = edge.steps();
        let rows = cells.rows.get_mut((from - top) as usize..).unwrap_or_default();
        // A steep edge touches few pixels per row, so several rows are computed at once.
        if steps.slope.unsigned_abs() <= 1 << 32 {
            let mut row = from;
            for rows in rows.as_chunks_mut::<AT_ONCE>().0 {
                steep(simd, rows, &edge, &steps, row);
                row += AT_ONCE as i32;
                if row >= to {
                    break;
                }
            }
        } else {
            for (row, cells) in (from..to).zip(rows) {
                flat(simd, cells, &edge, &steps, row);
            }
        }
    }
    // Running sums along the rows turn cells into coverage.
    let groups = (columns.1 - columns.0) as usize / 8 + 1;
    let rows = cells.rows.get_mut((first - top) as usize..(end - top) as usize);
    for (row, cells) in (first - top..).zip(rows.unwrap_or_default()) {
        sweep(simd, cells, groups, (row, columns.0 as usize), sink);
    }
}

/// Sums a row, whose cells are zero afterwards.
#[inline(always)]
fn sweep<S: Simd, K: Sink<S>>(
    simd: S,
    cells: &mut Row,
    groups: usize,
    (row, x): (i32, usize),
    sink: &mut K,
) {
    let zero = i32x8::splat(simd, 0);
    let mut carry = zero;
    let mut x = x;
    let (now, after) = cells.as_chunks_mut::<8>().0.split_at_mut(groups.min(CELLS / 8));
    for cells in now {
        let v = i32x8::from_slice(simd, cells);
        zero.store_slice(cells);
        let v = running_sums(simd, v, carry);
        carry = i32x8::splat(simd, v[7]);
        sink.eight(simd, row, x, lanes(simd, v, FillRule::NonZero));
        x += 8;
    }
    // Edges also change the two cells after the last pixel they touch.
    if let Some(cells) = after.first_mut() {
        zero.store_slice(cells);
    }
}

/// Adds an edge that crosses at most two pixels in every row to eight rows, of which `row` is the first.
#[inline(always)]
fn steep<S: Simd>(simd: S, rows: &mut [Row; AT_ONCE], edge: &Edge, steps: &Steps, row: i32) {
    let &Edge { x0, y0, x1, y1, .. } = edge;
    let splat = |v: i32| i32x8::splat(simd, v);
    let (zero, one) = (splat(0), splat(ONE));
    // The row that it crosses in part before whole ones, and the one after those.
    let whole = (y0 + ONE - 1) >> BITS;
    let (head, tail) = (whole - 1, y1 >> BITS);
    let single = y0 >> BITS == tail;
    let end = (steps.at(tail - whole) >> BITS) as i32;
    let head_x = clamped(x0, steps.crossing);
    let tail_x = if single { clamped(x0, x1) } else { clamped(end, x1) };
    let tail_height = if single { y1 - y0 } else { y1 & (ONE - 1) };
    let head_height = (whole << BITS) - y0;
    // The left end of the edge in each row, and its extent.
    let lane = i32x8::from_slice(simd, &[0, 1, 2, 3, 4, 5, 6, 7]);
    let left = steps.at(row - whole) + steps.slope.min(0);
    let fraction = lane * splat(steps.slope as i32 & (ONE - 1)) + splat(left as i32 & (ONE - 1));
    let left = lane * splat((steps.slope >> BITS) as i32) + splat((left >> BITS) as i32);
    let left = (left + (fraction >> BITS)).max(zero).min(splat(LIMIT));
    let across = splat((steps.slope.unsigned_abs() >> BITS) as i32);
    let number = lane + splat(row);
    let (is_head, is_tail) = (number.simd_eq(splat(head)), number.simd_eq(splat(tail)));
    let is_whole = number.simd_gt(splat(head)) & number.simd_lt(splat(tail));
    let left = is_tail.select(splat(tail_x.0), is_head.select(splat(head_x.0), left));
    let across = is_tail.select(splat(tail_x.1), is_head.select(splat(head_x.1), across));
    let height = is_head.select(splat(head_height), is_whole.select(one, zero));
    let height = is_tail.select(splat(tail_height), height);
    let [d0, d1, d2] = eight_deltas(simd, left & splat(ONE - 1), across, height);
    let flip = splat((edge.sign() - 1) >> 1);
    let deltas = [(d0 ^ flip) - flip, (d1 ^ flip) - flip, (d2 ^ flip) - flip];
    add(rows, left >> BITS, deltas);
}

/// Returns the left one of two points moved into the row, and how far it is to the other.
#[inline(always)]
fn clamped(a: i32, b: i32) -> (i32, i32) {
    let (left, right) = (a.min(b).clamp(0, LIMIT), a.max(b).clamp(0, LIMIT));
    (left, right - left)
}

/// Adds three numbers to each row from a column on.
#[inline(always)]
fn add<S: Simd>(rows: &mut [Row; AT_ONCE], columns: i32x8<S>, deltas: [i32x8<S>; 3]) {
    let (mut at, mut own) = ([0; 8], [[0; 8]; 3]);
    columns.store_slice(&mut at);
    let [d0, d1, d2] = deltas;
    d0.store_slice(&mut own[0]);
    d1.store_slice(&mut own[1]);
    d2.store_slice(&mut own[2]);
    for i in 0..AT_ONCE {
        let at = at[i] as usize & WIDEST as usize;
        rows[i][at] += own[0][i];
        rows[i][at + 1] += own[1][i];
        rows[i][at + 2] += own[2][i];
    }
}

/// Adds the contribution, in one row, of an edge that crosses more than a pixel in each whole row.
#[inline(always)]
fn flat<S: Simd>(simd: S, cells: &mut Row, edge: &Edge, steps: &Steps, row: i32) {
    let whole = (edge.y0 + ONE - 1) >> BITS;
    let (upper, lower) = (edge.y0.max(row << BITS), edge.y1.min((row + 1) << BITS));
    let x = |row: i32| (steps.at(row - whole) >> BITS) as i32;
    let x0 = if row == edge.y0 >> BITS { edge.x0 } else { x(row) };
    let x1 = if row == edge.y1 >> BITS { edge.x1 } else { x(row + 1) };
    let ramp = Ramp::new(x0, x1, lower - upper, LIMIT);
    let zero = i32x8::splat(simd, 0);
    let flip = i32x8::splat(simd, (edge.sign() - 1) >> 1);
    let (mut before, mut at) = (zero, ramp.first);
    while at <= ramp.last + 1 {
        let area = area(simd, &ramp, at);
        let delta = area - before.slide::<7>(area);
        before = area;
        if let Some(cells) = cells.get_mut(at as usize..).and_then(<[i32]>::first_chunk_mut::<8>) {
            let sum = i32x8::from_slice(simd, cells) + (delta ^ flip) - flip;
            sum.store_slice(cells);
        }
        at += 8;
    }
}
