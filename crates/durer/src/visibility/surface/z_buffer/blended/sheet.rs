//! Blended triangles of a tile that do not overlap, whose colours need no sorting.

use super::super::area::{BLOCKS, block_at};
use super::super::rasterize::FragmentTest;
use super::super::tile::{TILE, TILE_PIXELS, block_of};
use crate::simd::lanes;
use crate::target::NO_ITEM;
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, u32x16};

/// The item of each sample of a tile that a triangle covers and nothing opaque hides.
///
/// Pixels covered twice keep their first item.
pub struct Sheet {
    /// Laid out as [`super::super::tile::SamplePlane::item`], plane after plane.
    items: Vec<u32>,
    /// Number of samples of a pixel.
    count: usize,
    /// The blocks with an item, and for each whether it is among them.
    begun: Vec<u32>,
    is_begun: Vec<bool>,
    /// True if a triangle covers a sample that another covers too.
    pub covers_another: bool,
}

impl Sheet {
    /// Creates an empty sheet with this number of samples per pixel.
    pub fn new(count: usize) -> Self {
        Self {
            items: vec![NO_ITEM; count * TILE_PIXELS],
            count,
            begun: Vec::new(),
            is_begun: vec![false; BLOCKS],
            covers_another: false,
        }
    }

    /// Forgets all that was covered.
    pub fn clear(&mut self) {
        self.covers_another = false;
        for block in self.begun.drain(..) {
            self.is_begun[block as usize] = false;
            let [x, y] = block_at(block as usize);
            for row in [y, y + 1] {
                let start = (row * TILE + x) as usize;
                for (first, shift) in planes(self.count) {
                    let start = first * TILE_PIXELS + (start << shift);
                    self.items[start..start + (8 << shift)].fill(NO_ITEM);
                }
            }
        }
    }

    /// Returns the blocks with an item.
    pub fn begun(&self) -> &[u32] {
        &self.begun
    }

    /// Sets `samples` to the items of a block by sample.
    #[inline(always)]
    pub fn block<S: Simd>(&self, simd: S, block: usize, samples: &mut [u32x16<S>]) {
        let [x, y] = block_at(block);
        for (first, shift) in planes(self.count) {
            let items = &self.items[first * TILE_PIXELS..];
            let samples = &mut samples[first..first + (1 << shift)];
            block_of(simd, items, (y * TILE + x) as usize, samples);
        }
    }
}

/// Returns the first sample of each plane and the logarithm of how many it has.
fn planes(count: usize) -> impl Iterator<Item = (usize, u32)> {
    let shift = if count.is_multiple_of(4) { 2 } else { 0 };
    (0..count).step_by(1 << shift).map(move |first| (first, shift))
}

impl FragmentTest for Sheet {
    /// Records the samples and lets nothing be written.
    #[inline(always)]
    fn pass<S: Simd>(
        &mut self,
        simd: S,
        write: S::i32s,
        t: &ScreenTriangle,
        [x, y]: [i32; 2],
        (first, shift): (usize, u32),
    ) -> S::i32s {
        let start = first * TILE_PIXELS + (((y * TILE + x) as usize) << shift);
        let items = &mut self.items[start..start + lanes::<S>()];
        let old: S::i32s = S::u32s::from_slice(simd, items).bitcast();
        let (none, item) = (S::i32s::splat(simd, NO_ITEM as i32), t.item as i32);
        let zero = S::i32s::splat(simd, 0);
        let is_free = old.simd_eq(none);
        let others = is_free.select(zero, write) & (old ^ item);
        self.covers_another |= !others.simd_eq(zero).all_true();
        let write = is_free.select(write, zero);
        let new: S::u32s = (old ^ ((old ^ item) & write)).bitcast();
        new.store_slice(items);
        let last = x + (lanes::<S>() as i32 >> shift) - 1;
        for column in x / 8..=last / 8 {
            let block = (y / 2 * (TILE / 8) + column) as usize % BLOCKS;
            if !std::mem::replace(&mut self.is_begun[block], true) {
                self.begun.push(block as u32);
            }
        }
        zero
    }
}
