//! One tile of the visibility buffer: which triangle is nearest at each sample.
//!
//! Depths are kept as the bits of non-negative floats, which compare like integers. The samples of a pixel, up to four,
//! are adjacent, so that one vector operation tests a triangle at all of them.

use crate::raster::fixed::SUBPIXELS;
use crate::target::NO_ITEM;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x8, u32x8, u32x16};
use fearless_simd_macros::simd;

/// Pixels along the side of a tile: depth and item of one sample of each of its pixels, 32 kB, fit
/// the first-level cache.
pub const TILE: i32 = 64;

/// Pixels of a tile.
pub const TILE_PIXELS: usize = (TILE * TILE) as usize;

/// Pixels along the side of a block.
pub const BLOCK: i32 = 8;

/// Blocks of a tile.
const BLOCKS: usize = (TILE * TILE / (BLOCK * BLOCK)) as usize;

/// Samples that are tested at a time where registers are widest.
pub const MOST_LANES: usize = 16;

/// Bits of 1.0, the cleared depth.
const FAR: i32 = 0x3f80_0000;

/// Position of a sample, from the pixel's centre, in 1/256 pixel.
pub type SampleOffset = [i32; 2];

/// One or four samples per pixel: the depth bits and the item of the nearest triangle of each,
/// samples of a pixel side by side, pixels row by row.
pub struct SamplePlane {
    /// Number of the first sample here among all samples of a pixel.
    pub first: usize,
    /// Binary logarithm of the number of samples per pixel.
    pub shift: u32,
    /// The least and the largest offset of a sample, x and y.
    pub reach: [[i32; 2]; 2],
    /// Positions of consecutive samples, the largest number that a SIMD level tests at once, relative to the first
    /// sample's pixel centre, in 1/256 pixel.
    pub lanes: [[i32; MOST_LANES]; 2],
    /// The same in pixels.
    pub lanes_in_pixels: [[f32; MOST_LANES]; 2],
    /// For each block of 8 × 8 pixels, row by row, the bits of a depth beyond which nothing is visible there.
    pub farthest: [i32; BLOCKS],
    /// Bits of the depths.
    pub depth: Vec<i32>,
    /// Items.
    pub item: Vec<u32>,
}

impl SamplePlane {
    /// Creates planes for this many samples, each for one of them or for four.
    pub fn of(offsets: &[SampleOffset]) -> Vec<Self> {
        let chunk = if offsets.len().is_multiple_of(4) { 4 } else { 1 };
        let chunks = offsets.chunks(chunk).enumerate();
        chunks.map(|(i, offsets)| Self::new(chunk * i, offsets)).collect()
    }

    fn new(first: usize, offsets: &[SampleOffset]) -> Self {
        let count = offsets.len();
        let lane = |axis: usize| {
            std::array::from_fn(|lane| {
                let pixels = if axis == 0 { (lane / count) as i32 } else { 0 };
                pixels * SUBPIXELS + offsets[lane % count][axis]
            })
        };
        let lanes: [[i32; MOST_LANES]; 2] = [lane(0), lane(1)];
        let least = |axis: usize| offsets.iter().map(|o| o[axis]).min().unwrap_or(0);
        let largest = |axis: usize| offsets.iter().map(|o| o[axis]).max().unwrap_or(0);
        Self {
            first,
            shift: count.trailing_zeros(),
            reach: [[least(0), largest(0)], [least(1), largest(1)]],
            lanes,
            lanes_in_pixels: lanes.map(|axis| axis.map(|v| v as f32 / SUBPIXELS as f32)),
            farthest: [FAR; BLOCKS],
            depth: vec![FAR; count * TILE_PIXELS],
            item: vec![NO_ITEM; count * TILE_PIXELS],
        }
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.farthest.fill(FAR);
        self.depth.fill(FAR);
        self.item.fill(NO_ITEM);
    }

    /// Updates [`Self::farthest`]; values that were right stay right, because depths only shrink.
    pub fn find_farthest<S: Simd>(&mut self, simd: S) {
        find_farthest(simd, &self.depth, self.shift, &mut self.farthest);
    }

    /// Returns the bits of a depth beyond which nothing is visible in the whole tile.
    pub fn farthest_of_all(&self) -> i32 {
        self.farthest.iter().copied().fold(0, i32::max)
    }

    /// Returns whether everything at `depth` (bits) or farther is hidden in a box of pixels.
    #[inline(always)]
    pub fn hides(&self, [x0, y0, x1, y1]: [i32; 4], depth: i32) -> bool {
        const COLUMNS: i32 = TILE / BLOCK;
        (y0 / BLOCK..=y1 / BLOCK).all(|y| {
            let blocks = (y * COLUMNS + x0 / BLOCK) as usize..=(y * COLUMNS + x1 / BLOCK) as usize;
            self.farthest[blocks].iter().all(|&farthest| depth > farthest)
        })
    }

    /// Returns the items at the samples of a pixel.
    #[inline(always)]
    pub fn items(&self, pixel: usize) -> &[u32] {
        &self.item[pixel << self.shift..(pixel + 1) << self.shift]
    }

    /// Returns the items at the samples of eight pixels in a row.
    #[inline(always)]
    pub fn items_of_eight(&self, pixel: usize) -> &[u32] {
        &self.item[pixel << self.shift..(pixel + 8) << self.shift]
    }

    /// Returns the depth at the first sample of a pixel.
    pub fn depth(&self, pixel: usize) -> f32 {
        f32::from_bits(self.depth[pixel << self.shift] as u32)
    }
}

/// Returns the items at the samples of a block, by sample: of eight pixels in a row from the given one on, and of the
/// eight below them. `room` is overwritten.
#[inline(always)]
pub fn samples_of_block<'r, S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    pixel: usize,
    room: &'r mut [u32x16<S>],
) -> &'r [u32x16<S>] {
    let mut count = 0;
    for plane in planes {
        let of_plane = 1 << plane.shift;
        block_of(simd, &plane.item, pixel, &mut room[count..count + of_plane]);
        count += of_plane;
    }
    &room[..count]
}

/// Sets `samples` to the items, by sample, of a block of a plane: of eight pixels in a row from the given one on, and
/// of the eight below them.
#[inline(always)]
pub fn block_of<S: Simd>(simd: S, items: &[u32], pixel: usize, samples: &mut [u32x16<S>]) {
    let below = pixel + TILE as usize;
    if let [one] = samples {
        let above = u32x8::from_slice(simd, &items[pixel..pixel + 8]);
        *one = simd.combine_u32x8(above, u32x8::from_slice(simd, &items[below..below + 8]));
    } else if let Ok(samples) = <&mut [u32x16<S>; 4]>::try_from(samples) {
        let above = four_of_eight(simd, items, pixel);
        let below = four_of_eight(simd, items, below);
        for i in 0..4 {
            samples[i] = simd.combine_u32x8(above[i], below[i]);
        }
    }
}

/// Returns the items at the samples of eight pixels in a row, four each, by sample.
#[inline(always)]
fn four_of_eight<S: Simd>(simd: S, items: &[u32], pixel: usize) -> [u32x8<S>; 4] {
    let items = &items[4 * pixel..4 * pixel + 32];
    let a = u32x8::from_slice(simd, &items[..8]);
    let b = u32x8::from_slice(simd, &items[8..16]);
    let c = u32x8::from_slice(simd, &items[16..24]);
    let d = u32x8::from_slice(simd, &items[24..]);
    // For all pixels: samples 0 and 2, then 1 and 3.
    let (even_ab, even_cd) = (simd.unzip_low_u32x8(a, b), simd.unzip_low_u32x8(c, d));
    let (odd_ab, odd_cd) = (simd.unzip_high_u32x8(a, b), simd.unzip_high_u32x8(c, d));
    let first = simd.unzip_low_u32x8(even_ab, even_cd);
    let third = simd.unzip_high_u32x8(even_ab, even_cd);
    let second = simd.unzip_low_u32x8(odd_ab, odd_cd);
    let fourth = simd.unzip_high_u32x8(odd_ab, odd_cd);
    [first, second, third, fourth]
}

/// Finds the largest depth of each block.
#[simd]
fn find_farthest<S: Simd>(simd: S, depth: &[i32], shift: u32, farthest: &mut [i32; BLOCKS]) {
    const COLUMNS: usize = (TILE / BLOCK) as usize;
    let rows_of_blocks = depth.chunks_exact(((TILE * BLOCK) as usize) << shift);
    for (rows, farthest) in rows_of_blocks.zip(farthest.as_chunks_mut::<COLUMNS>().0) {
        let mut most = [i32x8::splat(simd, 0); COLUMNS];
        for row in rows.chunks_exact((TILE as usize) << shift) {
            for (block, most) in row.chunks_exact((BLOCK as usize) << shift).zip(&mut most) {
                for samples in block.as_chunks::<8>().0 {
                    *most = most.max(i32x8::from_slice(simd, samples));
                }
            }
        }
        for (to, most) in farthest.iter_mut().zip(most) {
            let lanes: [i32; 8] = most.into();
            *to = lanes.into_iter().fold(0, i32::max);
        }
    }
}
