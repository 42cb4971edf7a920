//! From cells to coverage: a running sum along each row, which clears the cells behind itself.

use std::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{i32x8, u32x8};
use fearless_simd_macros::simd;

use super::FillRule;
use super::cells::Marks;
use super::edge::ONE;
use super::resolve::Resolver;

/// What is done with the coverage of a row, from left to right.
pub(crate) trait Sink<S: Simd> {
    /// Eight pixels from `x` on, each with its coverage 0 … 255. At the end of the row some of them may lie
    /// beyond it.
    fn eight(&mut self, simd: S, row: i32, x: usize, coverage: u32x8<S>);
    /// Pixels that all have the same coverage 1 … 255.
    fn span(&mut self, simd: S, row: i32, x: Range<usize>, coverage: u8);
}

/// Where in the band a row is, and how it is summed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    /// Row of the band.
    pub row: i32,
    /// The pixel of the first cell, a multiple of 8.
    pub first: usize,
    /// The words of marks that are concerned, the last not included.
    pub words: (usize, usize),
    /// Pixels of the row.
    pub width: usize,
    /// What is inside.
    pub rule: FillRule,
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

/// Sums one row and hands its coverage to the sink; shared pixels are looked up in `resolver`, if there is
/// one. Cells and marks are zero afterwards.
#[simd]
pub(crate) fn sweep<S: Simd, K: Sink<S>>(
    simd: S,
    cells: &mut [i32],
    marks: &mut [Marks],
    at: Row,
    mut resolver: Option<&mut Resolver>,
    sink: &mut K,
) {
    let Row { row, first, words: (from, to), width, rule } = at;
    let (mut carry, mut spill) = (0_i32, 0_u64);
    let mut done = first + from * 64;
    let zero = i32x8::splat(simd, 0);
    for word in from..to.min(marks.len()) {
        let Marks { touched, shared } = std::mem::take(&mut marks[word]);
        // An edge also changes the cell after the last pixel it touches.
        let dirty = touched | (touched << 1) | spill;
        spill = touched >> 63;
        let mut bytes = nonzero_bytes(dirty);
        while bytes != 0 {
            let bit = bytes.trailing_zeros() & !7;
            let group = word * 64 + bit as usize;
            bytes &= bytes - 1;
            let x = first + group;
            if done < x {
                constant(simd, sink, row, done..x.min(width), alpha(carry, rule));
            }
            done = x + 8;
            let Some(cells) = cells.get_mut(group..group + 8) else { continue };
            // Sum of eight by three shifted additions.
            let v = i32x8::from_slice(simd, cells);
            zero.store_slice(cells);
            let v = v + zero.slide::<7>(v);
            let v = v + zero.slide::<6>(v);
            let v = v + zero.slide::<4>(v) + i32x8::splat(simd, carry);
            carry = v[7];
            if x >= width {
                continue;
            }
            let mut coverage = lanes(simd, v, rule);
            if let Some(resolver) = &mut resolver
                && (shared >> bit) & 255 != 0
            {
                let (mut sums, mut own) = ([0; 8], [0; 8]);
                v.store_slice(&mut sums);
                coverage.store_slice(&mut own);
                resolver.eight((row, word), shared, bit, rule, &sums, &mut own);
                coverage = u32x8::from_slice(simd, &own);
            }
            sink.eight(simd, row, x, coverage);
        }
    }
    if done < width {
        constant(simd, sink, row, done..width, alpha(carry, rule));
    }
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

#[inline(always)]
fn constant<S: Simd>(simd: S, sink: &mut impl Sink<S>, row: i32, x: Range<usize>, alpha: u8) {
    if alpha != 0 && !x.is_empty() {
        sink.span(simd, row, x, alpha);
    }
}
