//! From cells to coverage: a running sum along each row of a band, which clears the cells behind itself.

use std::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{i32x8, u32x8};
use fearless_simd_macros::simd;

use super::FillRule;
use super::cells::{Cells, Marks};
use super::edge::ONE;
use super::resolve::Resolver;
use crate::raster::bands::running_sums;

/// Receiver of a row's coverage, from left to right.
pub(crate) trait Sink<S: Simd> {
    /// Takes eight pixels from `x` on, each with its coverage 0 … 255. At the end of the row some of them, or all, may
    /// be beyond it.
    fn eight(&mut self, simd: S, row: i32, x: usize, coverage: u32x8<S>);
    /// Takes four pixels from `x` on, their coverage in the bytes of a number, the first in the lowest.
    #[inline(always)]
    fn four(&mut self, simd: S, row: i32, x: usize, coverage: u32) {
        self.eight(simd, row, x, unpacked(simd, coverage));
    }
    /// Takes pixels that all have the same coverage 1 … 255.
    fn span(&mut self, simd: S, row: i32, x: Range<usize>, coverage: u8);
}

/// Returns the four coverages in the bytes of a number, followed by four zeros.
#[inline(always)]
pub(crate) fn unpacked<S: Simd>(simd: S, coverage: u32) -> u32x8<S> {
    let [a, b, c, d] = coverage.to_le_bytes().map(u32::from);
    u32x8::from_slice(simd, &[a, b, c, d, 0, 0, 0, 0])
}

/// Part of a band to sum, and options for it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rows {
    /// Rows of the band, the last not included.
    pub rows: (i32, i32),
    /// Pixels of the row.
    pub width: usize,
    /// Rule that decides which winding numbers are inside.
    pub rule: FillRule,
}

/// Returns the coverage 0 … 255 of a pixel from its integral of winding numbers.
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

/// Sums rows and hands their coverage to the sink; shared pixels are looked up in `resolver`, if there is
/// one. Cells and marks are zero afterwards.
#[simd]
pub(crate) fn sweep<S: Simd, K: Sink<S>>(
    simd: S,
    cells: &mut Cells,
    at: Rows,
    mut resolver: Option<&mut Resolver>,
    sink: &mut K,
) {
    let Rows { rows, width, rule } = at;
    let (zero, first) = (i32x8::splat(simd, 0), cells.first());
    let (cells, marks, words) = cells.words();
    for row in rows.0..rows.1 {
        let (mut carry, mut spill) = (0_i32, 0_u64);
        let mut done = first;
        let mut base = first;
        let start = row as usize * words;
        for word in start..start + words {
            let (Some(marks), Some(cells)) = (marks.get_mut(word), cells.get_mut(word)) else {
                break;
            };
            let Marks { touched, shared } = std::mem::take(marks);
            // An edge also changes the cell after the last pixel it touches.
            let dirty = touched | (touched << 1) | spill;
            spill = touched >> 63;
            // Only groups of eight cells that an edge has changed need sums.
            let mut bytes = nonzero_bytes(dirty);
            while bytes != 0 {
                let group = bytes.trailing_zeros() as usize >> 3;
                bytes &= bytes - 1;
                let x = base + group * 8;
                // Between them the coverage is constant.
                if done < x {
                    constant(simd, sink, row, done..x.min(width), alpha(carry, rule));
                }
                done = x + 8;
                // Eight running sums, continued from the previous group.
                let Some(cells) = cells.as_chunks_mut::<8>().0.get_mut(group) else { continue };
                let v = i32x8::from_slice(simd, cells);
                zero.store_slice(cells);
                let v = running_sums(simd, v, i32x8::splat(simd, carry));
                carry = v[7];
                let mut coverage = lanes(simd, v, rule);
                // Pixels that several edges share are resolved exactly.
                if let Some(resolver) = &mut resolver
                    && (shared >> (group * 8)) & 255 != 0
                {
                    let (mut sums, mut own) = ([0; 8], [0; 8]);
                    v.store_slice(&mut sums);
                    coverage.store_slice(&mut own);
                    let word = word - start;
                    resolver.eight((row, word), shared, group as u32 * 8, rule, &sums, &mut own);
                    coverage = u32x8::from_slice(simd, &own);
                }
                sink.eight(simd, row, x, coverage);
            }
            base += 64;
        }
        // The rest of the row has a constant coverage, too.
        if carry != 0 && done < width {
            constant(simd, sink, row, done..width, alpha(carry, rule));
        }
    }
}

/// Returns the [`alpha`] of eight pixels at once.
#[inline(always)]
pub(super) fn lanes<S: Simd>(simd: S, v: i32x8<S>, rule: FillRule) -> u32x8<S> {
    let one = i32x8::splat(simd, ONE);
    let area = match rule {
        FillRule::NonZero => v.max(-v).min(one),
        FillRule::EvenOdd => {
            let folded = v & i32x8::splat(simd, 2 * ONE - 1);
            folded.min(one + one - folded)
        }
    };
    // 255 times the area.
    let area = (area << 8) - area;
    ((area + i32x8::splat(simd, ONE / 2)) >> 16).bitcast()
}

/// Returns the top bit of every byte that is not zero.
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
