//! The window of a view in tiles, and which of them a triangle touches.

use super::tile::TILE;
use crate::raster::fixed::SUBPIXEL_BITS;
use crate::view::View;
use crate::visibility::surface::setup::ScreenTriangle;

/// The tiles of the screen that a window has a part in, row by row.
#[derive(Debug, Clone, Copy)]
pub struct TileGrid {
    /// Column and row of the first tile, among those of the whole screen.
    first: [i32; 2],
    /// Tiles in a row.
    pub columns: i32,
    /// Rows of tiles.
    pub rows: i32,
}

impl TileGrid {
    /// Creates the tiles for the window of a view.
    pub fn of(view: &View) -> Self {
        let window = view.window();
        let first = [window.x0() / TILE, window.y0() / TILE];
        let end = [window.x1(), window.y1()].map(|v| v.cast_unsigned().div_ceil(TILE as u32));
        let [columns, rows] = [0, 1].map(|axis| end[axis] as i32 - first[axis]);
        Self { first, columns, rows }
    }

    /// Returns the number of the tile in a row and column of the screen's tiles.
    #[inline(always)]
    pub fn index(&self, column: i32, row: i32) -> i32 {
        (row - self.first[1]) * self.columns + (column - self.first[0])
    }

    /// Returns the upper left pixel of a tile.
    pub fn origin(&self, index: u32) -> [i32; 2] {
        let index = index.cast_signed();
        let place = [index % self.columns, index / self.columns];
        [0, 1].map(|axis| (self.first[axis] + place[axis]) * TILE)
    }

    pub fn count(&self) -> u32 {
        (self.columns * self.rows) as u32
    }

    /// Calls `visit` with each tile that the triangle may touch.
    #[inline(always)]
    pub fn touched(&self, t: &ScreenTriangle, reach: i32, mut visit: impl FnMut(u32)) {
        let [column, row] = self.first;
        let (x0, x1) = tile_range(&t.x, reach, [column, column + self.columns]);
        let (y0, y1) = tile_range(&t.y, reach, [row, row + self.rows]);
        if x0 == x1 && y0 == y1 {
            return visit(self.index(x0, y0).cast_unsigned());
        }
        for y in y0..=y1 {
            for x in x0..=x1 {
                if !beyond_an_edge(t, x, y) {
                    visit(self.index(x, y).cast_unsigned());
                }
            }
        }
    }
}

/// Returns the first and last tile that three coordinates, and `reach` around them, touch, of those from the first to
/// before the end.
#[inline(always)]
fn tile_range(v: &[i32; 3], reach: i32, [first, end]: [i32; 2]) -> (i32, i32) {
    const SHIFT: u32 = SUBPIXEL_BITS + TILE.trailing_zeros();
    let (lo, hi) = (v[0].min(v[1]).min(v[2]) - reach, v[0].max(v[1]).max(v[2]) + reach);
    ((lo >> SHIFT).max(first), (hi >> SHIFT).min(end - 1))
}

/// Returns whether a tile is wholly outside one edge of a triangle.
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
