//! The lit layers of a tile's blended surfaces, block by block.

use super::super::area::{BLOCKS, LANES, block_at, place_of};
use super::super::tile::{TILE, TILE_PIXELS};
use crate::target::NO_ITEM;
use crate::visibility::surface::LEAST_THROUGH;
use crate::visibility::surface::lit::{Lit, opaque};
use crate::visibility::surface::points::patch::Patch;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16, u32x16};

/// No layer.
const NONE: u32 = u32::MAX;

/// Lit layers of a tile's blended surfaces.
pub struct LitLayers {
    /// One layer of a block each; 0 at pixels that it does not cover.
    all: Vec<Colors>,
    /// Next nearer layer of each layer's block, in a separate list, so that reads of distant layers need not wait for
    /// one another.
    nearer: Vec<u32>,
    /// The samples that each layer covers of each pixel, as bits; not kept if pixels have only one.
    covered: Vec<[u32; LANES]>,
    /// Farthest lit layer of each block, and the pixels that have some, as bits.
    pub farthest: Vec<(u32, u16)>,
    /// Transmittance of the lit layers: sample after sample the pixels, by place.
    through: Vec<f32>,
    /// All bits are set where next to nothing comes through, and beyond the picture; by place.
    pub closed: Vec<u32>,
    /// Number of closed samples in the picture.
    closed_count: usize,
    /// Number of samples of a pixel.
    pub count: usize,
    tile: [i32; 2],
}

/// Premultiplied red, green, blue and alpha of the pixels of a block.
type Colors = [[f32; LANES]; 4];

impl LitLayers {
    /// Creates empty layers for pixels of this many samples.
    pub fn new(count: usize) -> Self {
        Self {
            all: Vec::new(),
            nearer: Vec::new(),
            covered: Vec::new(),
            farthest: Vec::new(),
            through: Vec::new(),
            closed: Vec::new(),
            closed_count: 0,
            count,
            tile: [0; 2],
        }
    }

    /// Forgets all that was lit.
    pub fn clear(&mut self) {
        self.all.clear();
    }

    /// Returns whether anything is lit.
    pub fn any(&self) -> bool {
        !self.all.is_empty()
    }

    /// Begins with a tile of this place and size.
    pub fn open(&mut self, [tile, size]: [[i32; 2]; 2]) {
        self.all.clear();
        self.nearer.clear();
        self.covered.clear();
        self.farthest.clear();
        self.farthest.resize(BLOCKS, (NONE, 0));
        self.through.clear();
        self.through.resize(TILE_PIXELS * self.count, 1.0);
        self.closed.clear();
        self.closed.resize(TILE_PIXELS, 0);
        if size != [TILE; 2] {
            // The rasterizer writes beyond the picture's border.
            for (x, y) in (0..TILE).flat_map(|y| (0..TILE).map(move |x| (x, y))) {
                if x >= size[0] || y >= size[1] {
                    self.closed[place_of(x, y)] = u32::MAX;
                }
            }
        }
        self.closed_count = 0;
        self.tile = tile;
    }

    /// Returns whether nothing comes through at any pixel of a tile of this size.
    pub fn hide_all(&self, size: [i32; 2]) -> bool {
        self.closed_count >= (size[0] * size[1]) as usize
    }

    /// Lights an item at each pixel of a block where there is one and surfaces still show through; `covered` has its
    /// samples as bits.
    #[inline(always)]
    pub fn light<S: Simd>(
        &mut self,
        simd: S,
        block: usize,
        items: u32x16<S>,
        covered: u32x16<S>,
        lit: &mut Lit<'_>,
    ) {
        // All bits of NO_ITEM are set.
        let items = items | u32x16::from_slice(simd, &self.closed[block * LANES..][..LANES]);
        let there = items.simd_ne(u32x16::splat(simd, NO_ITEM));
        if there.to_bitmask() == 0 {
            return;
        }
        let mut colors = [[0.0; LANES]; 4];
        Lit::colors_x16(simd, lit, items, Patch::block(self.place(block)), &mut colors);
        let [r, g, b] = opaque(simd, &colors);
        self.add(simd, block, (there, covered), [r, g, b, f32x16::from_slice(simd, &colors[3])]);
    }

    /// Returns the upper left pixel of a block in the picture.
    pub fn place(&self, block: usize) -> [i32; 2] {
        let [x, y] = block_at(block);
        [self.tile[0] + x, self.tile[1] + y]
    }

    /// Adds a layer of a block: straight colours, valid at the pixels in `there`, and the samples that it covers.
    #[inline(always)]
    fn add<S: Simd>(
        &mut self,
        simd: S,
        block: usize,
        (there, covered): (mask32x16<S>, u32x16<S>),
        [r, g, b, alpha]: [f32x16<S>; 4],
    ) {
        let touched = there.to_bitmask();
        let first = block * LANES;
        let closed = &mut self.closed[first..first + LANES];
        // Pixels without a surface may have been shaded as well.
        let zero = f32x16::splat(simd, 0.0);
        let alpha = there.select(alpha, zero);
        let mut colors = [[0.0; LANES]; 4];
        for (to, straight) in colors.iter_mut().zip([r, g, b]) {
            (there.select(straight, zero) * alpha).store_slice(to);
        }
        alpha.store_slice(&mut colors[3]);
        // Less light passes through the samples covered.
        let rest = 1.0 - alpha;
        let mut most = zero;
        for i in 0..self.count {
            let start = i * TILE_PIXELS + first;
            let through = &mut self.through[start..start + LANES];
            let before = f32x16::from_slice(simd, through);
            let bit = covered & (1 << i);
            let is_covered = there & bit.simd_ne(u32x16::splat(simd, 0));
            let after = is_covered.select(before * rest, before);
            after.store_slice(through);
            most = most.max(after);
        }
        // Pixels with next to nothing passing through any sample are closed.
        let closes = there & most.simd_le(f32x16::splat(simd, LEAST_THROUGH));
        self.closed_count += closes.to_bitmask().count_ones() as usize;
        let all = u32x16::splat(simd, u32::MAX);
        closes.select(all, u32x16::from_slice(simd, closed)).store_slice(closed);
        // The layer becomes the farthest of its block, linked to the one in front of it.
        let (farthest, all_touched) = &mut self.farthest[block];
        let nearer = std::mem::replace(farthest, self.all.len() as u32);
        *all_touched |= touched as u16;
        self.nearer.push(nearer);
        self.all.push(colors);
        if self.count > 1 {
            self.covered.push(covered.into());
        }
    }

    /// Lays the layers of a block over the opaque colour at each sample, the farthest first.
    #[inline(always)]
    pub fn lay_over<S: Simd>(&self, simd: S, block: usize, under: &mut [[f32x16<S>; 4]]) {
        let mut next = self.farthest[block].0;
        while let Some(layer) = self.all.get(next as usize) {
            let covered = self.covered.get(next as usize);
            let alpha = f32x16::from_slice(simd, &layer[3]);
            for (i, under) in under.iter_mut().enumerate() {
                for (over, under) in layer.iter().zip(under) {
                    let sum = f32x16::from_slice(simd, over) + *under * (1.0 - alpha);
                    // Without coverage bits, the layer is 0 where there is no surface, which changes nothing.
                    *under = match covered {
                        Some(covered) => {
                            let bit = u32x16::from_slice(simd, covered) & (1 << i);
                            bit.simd_ne(u32x16::splat(simd, 0)).select(sum, *under)
                        }
                        None => sum,
                    };
                }
            }
            next = self.nearer[next as usize];
        }
    }
}
