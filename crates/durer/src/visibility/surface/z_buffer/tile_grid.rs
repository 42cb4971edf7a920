//! The screen in tiles, and which of them a triangle touches.

use super::tile::TILE;
use crate::raster::fixed::SUBPIXEL_BITS;
use crate::visibility::surface::setup::ScreenTriangle;

/// The screen divided into tiles, row by row.
#[derive(Debug, Clone, Copy)]
pub struct TileGrid {
    /// Tiles in a row.
    pub columns: i32,
    /// Rows of tiles.
    pub rows: i32,
}

impl TileGrid {
    /// Creates the tiles that cover a screen of this many pixels.
    pub fn new(width: u32, height: u32) -> Self {
        let tiles = |pixels: u32| pixels.div_ceil(TILE as u32) as i32;
        Self { columns: tiles(width), rows: tiles(height) }
    }

    pub fn count(&self) -> u32 {
        (self.columns * self.rows) as u32
    }

    /// Calls `visit` with each tile that the triangle may touch.
    #[inline(always)]
    pub fn touched(&self, t: &ScreenTriangle, reach: i32, mut visit: impl FnMut(u32)) {
        let (x0, x1) = tile_range(&t.x, reach, self.columns);
        let (y0, y1) = tile_range(&t.y, reach, self.rows);
        if x0 == x1 && y0 == y1 {
            return visit((y0 * self.columns + x0) as u32);
        }
        for y in y0..=y1 {
            for x in x0..=x1 {
                if !beyond_an_edge(t, x, y) {
                    visit((y * self.columns + x) as u32);
                }
            }
        }
    }
}

/// Returns the first and last tile that three coordinates, and `reach` around them, touch.
#[inline(always)]
fn tile_range(v: &[i32; 3], reach: i32, count: i32) -> (i32, i32) {
    const SHIFT: u32 = SUBPIXEL_BITS + TILE.trailing_zeros();
    let (lo, hi) = (v[0].min(v[1]).min(v[2]) - reach, v[0].max(v[1]).max(v[2]) + reach);
    ((lo >> SHIFT).max(0), (hi >> SHIFT).min(count - 1))
}

/// Returns whether a tile lies wholly outside one edge of a triangle.
fn beyond_an_edge(t: &ScreenTriangle, x: i32, y: i32) -> bool {
    let size = i64::from(TILE) << SUBPIXEL_BITS;
    let (left, top) = (i64::from(x) * size, i64::from(y) * size);
    (0..3).any(|i| {
        let j = (i + 1) % 3;
        let (dx, dy) = (i64::from(t.x[j] - t.x[i]), i64::from(t.y[j] - t.y[i]));
        // The corner of the tile that lies furthest inside the edge.
        let far_x = if dy < 0 { left + size } else { left };
        let far_y = if dx > 0 { top + size } else { top };
        dx * (far_y - i64::from(t.y[i])) - dy * (far_x - i64::from(t.x[i])) < 0
    })
}
