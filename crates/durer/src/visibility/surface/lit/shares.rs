//! The shares of items in the samples of sixteen pixels.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};

/// Samples that a pixel has at most.
pub const MOST_SAMPLES: usize = 16;

/// The items that the samples of sixteen pixels show, one after the other.
pub struct Shares<'s, S: Simd> {
    /// By sample, four at a time.
    samples: &'s [[u32x16<S>; 4]],
    /// Pixels of each four samples whose item has not yet come, sixteen bits each.
    left: [u64; MOST_SAMPLES / 4],
    /// Weight of one sample.
    share: f32x16<S>,
}

impl<'s, S: Simd> Shares<'s, S> {
    /// Creates the shares of pixels with these samples, four or a multiple.
    #[inline(always)]
    pub fn new(simd: S, samples: &'s [u32x16<S>]) -> Self {
        let share = f32x16::splat(simd, 1.0 / samples.len() as f32);
        Self { samples: samples.as_chunks().0, left: [u64::MAX; MOST_SAMPLES / 4], share }
    }

    /// Returns the next item, which may be none, and how much it weighs in each pixel.
    #[inline(always)]
    pub fn next(&mut self, simd: S) -> Option<(u32, f32x16<S>)> {
        let (four, left) = self.samples.iter().zip(&self.left).find(|(_, left)| **left != 0)?;
        let first = left.trailing_zeros() as usize;
        let items: [u32; 16] = four[first / 16 % 4].into();
        let (item, zero) = (items[first % 16], f32x16::splat(simd, 0.0));
        let mut weight = zero;
        for (four, left) in self.samples.iter().zip(&mut self.left) {
            let mut come = 0;
            for (i, sample) in four.iter().enumerate() {
                let same = sample.simd_eq(u32x16::splat(simd, item));
                weight += same.select(self.share, zero);
                come |= same.to_bitmask() << (16 * i);
            }
            *left &= !come;
        }
        Some((item, weight))
    }
}
