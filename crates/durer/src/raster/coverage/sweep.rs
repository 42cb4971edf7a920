//! From cells to coverage: a running sum along each row, which clears the cells behind itself.

use fearless_simd::prelude::*;
use fearless_simd::{i32x8, u32x8};
use fearless_simd_macros::simd;

use super::FillRule;
use super::cells::Marks;
use super::edge::ONE;

/// Pixels of one row with the same or with individual coverage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Run {
    /// First pixel.
    pub start: usize,
    /// One past the last pixel.
    pub end: usize,
    /// The coverage 1 … 255 of all of them; `None` where each has its own.
    pub constant: Option<u8>,
}

/// Coverage 0 … 255 of a pixel from its integral of winding numbers.
#[inline(always)]
pub(crate) fn alpha(sum: i32, rule: FillRule) -> u8 {
    let area = match rule {
        FillRule::NonZero => sum.saturating_abs().min(ONE),
        FillRule::EvenOdd => {
            let folded = sum & (2 * ONE - 1);
            folded.min(2 * ONE - folded)
        }
    };
    ((area * 255 + ONE / 2) >> 16) as u8
}

/// Sums one row over the words `from..to` of its marks; coverage goes to `out`, one lane per pixel,
/// where it is not constant, and `runs` tells where it is what. Cells and marks are zero afterwards.
#[simd]
#[allow(clippy::too_many_arguments)]
pub(crate) fn sweep<S: Simd>(
    simd: S,
    cells: &mut [i32],
    marks: &mut [Marks],
    (from, to): (usize, usize),
    width: usize,
    rule: FillRule,
    out: &mut [u32],
    runs: &mut Vec<Run>,
) {
    runs.clear();
    let (mut carry, mut spill) = (0_i32, 0_u64);
    let mut done = from * 64;
    let mut masked = None;
    let zero = i32x8::splat(simd, 0);
    for word in from..to.min(marks.len()) {
        let touched = marks[word].touched;
        marks[word] = Marks::default();
        // An edge also changes the cell after the last pixel it touches.
        let dirty = touched | (touched << 1) | spill;
        spill = touched >> 63;
        let mut bytes = nonzero_bytes(dirty);
        while bytes != 0 {
            let group = word * 64 + (bytes.trailing_zeros() as usize & !7);
            bytes &= bytes - 1;
            if group != done || masked.is_none() {
                close(runs, masked.take(), done.min(width));
                constant(runs, done, group.min(width), alpha(carry, rule));
                masked = Some(group);
            }
            done = group + 8;
            let (Some(cells), Some(out)) =
                (cells.get_mut(group..group + 8), out.get_mut(group..group + 8))
            else {
                continue;
            };
            // Sum of eight by three shifted additions.
            let v = i32x8::from_slice(simd, cells);
            zero.store_slice(cells);
            let v = v + zero.slide::<7>(v);
            let v = v + zero.slide::<6>(v);
            let v = v + zero.slide::<4>(v) + i32x8::splat(simd, carry);
            carry = v[7];
            lanes(simd, v, rule).store_slice(out);
        }
    }
    close(runs, masked, done.min(width));
    constant(runs, done, width, alpha(carry, rule));
}

/// [`alpha`] of eight pixels at once.
#[inline(always)]
fn lanes<S: Simd>(simd: S, v: i32x8<S>, rule: FillRule) -> u32x8<S> {
    let one = i32x8::splat(simd, ONE);
    let area = match rule {
        FillRule::NonZero => v.max(-v).min(one),
        FillRule::EvenOdd => {
            let folded = v & i32x8::splat(simd, 2 * ONE - 1);
            folded.min(one + one - folded)
        }
    };
    ((area * 255 + i32x8::splat(simd, ONE / 2)) >> 16).bitcast()
}

/// The top bit of every byte that is not zero.
fn nonzero_bytes(word: u64) -> u64 {
    const LOW: u64 = 0x7f7f_7f7f_7f7f_7f7f;
    (((word & LOW) + LOW) | word) & !LOW
}

fn close(runs: &mut Vec<Run>, start: Option<usize>, end: usize) {
    if let Some(start) = start
        && start < end
    {
        runs.push(Run { start, end, constant: None });
    }
}

fn constant(runs: &mut Vec<Run>, start: usize, end: usize, alpha: u8) {
    if start < end && alpha != 0 {
        runs.push(Run { start, end, constant: Some(alpha) });
    }
}
