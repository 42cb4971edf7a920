//! The place of a tile in the picture, and its pixels before they are copied there.

use super::tile::TILE_PIXELS;
use crate::math::Vec4;

/// Position of a tile in the picture, and the background.
pub struct Area<'b> {
    /// The upper left pixel.
    pub tile: [i32; 2],
    /// Pixels across and down.
    pub size: [i32; 2],
    /// Linear with straight alpha, by row of the picture.
    pub background: &'b (dyn Fn(i32) -> Vec4 + Sync),
}

/// The pixels of a tile, row by row: the four bytes of each colour, the first one lowest.
///
/// They are written here and copied to the picture when the tile is complete: rows of the picture are far apart in
/// memory, and switching between them would stall each store.
pub type Codes = [u32; TILE_PIXELS];
