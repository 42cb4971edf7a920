//! The place of a tile in the picture, and its pixels before they are copied there.

use super::tile::{TILE, TILE_PIXELS};
use crate::math::Vec4;
use crate::shade::color::premultiply;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};

/// Pixels of a block: eight in a row, and the eight below them.
pub const LANES: usize = 16;

/// Blocks of a tile.
pub const BLOCKS: usize = TILE_PIXELS / LANES;

/// Blocks beside each other.
const BLOCKS_ACROSS: usize = TILE as usize / 8;

/// Rows of a tile.
const ROWS: usize = TILE as usize;

/// Returns the upper left pixel of a block, tile-local.
#[inline(always)]
pub fn block_at(block: usize) -> [i32; 2] {
    [(block % BLOCKS_ACROSS * 8) as i32, (block / BLOCKS_ACROSS * 2) as i32]
}

/// Returns the place of a tile-local pixel: its block times 16 and its lane.
#[inline(always)]
pub fn place_of(x: i32, y: i32) -> usize {
    let block = y / 2 * (TILE / 8) + x / 8;
    (block * LANES as i32 + y % 2 * 8 + x % 8) as usize % TILE_PIXELS
}

/// Position of a tile in the picture, and the background.
pub struct Area {
    /// The upper left pixel.
    pub tile: [i32; 2],
    /// Pixels across and down.
    pub size: [i32; 2],
    /// The background of each row, linear, premultiplied; of rows beyond the picture, nothing.
    behind: [Vec4; ROWS],
}

impl Area {
    /// Creates the area of a tile, given the background by row of the picture, linear with straight alpha.
    pub fn new([tile, size]: [[i32; 2]; 2], background: impl Fn(i32) -> Vec4) -> Self {
        let mut behind = [Vec4::ZERO; ROWS];
        for (y, behind) in (tile[1]..tile[1] + size[1]).zip(&mut behind) {
            *behind = premultiply(background(y));
        }
        Self { tile, size, behind }
    }

    /// Returns the blocks that have pixels in the picture.
    pub fn blocks(&self) -> impl Iterator<Item = usize> {
        let [width, height] = self.size;
        (0..BLOCKS).filter(move |&block| {
            let [x, y] = block_at(block);
            x < width && y < height
        })
    }

    /// Returns the background of a block's pixels, by channel.
    #[inline(always)]
    pub fn behind<S: Simd>(&self, simd: S, block: usize) -> [f32x16<S>; 4] {
        let y = block_at(block)[1] as usize % ROWS;
        let above = self.behind[y].to_array();
        // The last row of the picture may have no row below.
        let below = self.behind[(y + 1) % ROWS].to_array();
        let mut behind = [f32x16::splat(simd, 0.0); 4];
        for (i, behind) in behind.iter_mut().enumerate() {
            *behind = simd.combine_f32x8(simd.splat_f32x8(above[i]), simd.splat_f32x8(below[i]));
        }
        behind
    }
}

/// The pixels of a tile, row by row: the four bytes of each colour, the first one lowest.
///
/// They are written here and copied to the picture when the tile is complete: rows of the picture are far apart in
/// memory, and switching between them would stall each store.
pub type Codes = [u32; TILE_PIXELS];
