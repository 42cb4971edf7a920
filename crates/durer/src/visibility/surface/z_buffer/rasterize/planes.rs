//! The linear functions over a triangle: its edge functions and its depth.

use crate::raster::fixed::{HALF_PIXEL, SUBPIXELS};
use crate::simd::lanes;
use crate::visibility::surface::setup::ScreenTriangle;
use crate::visibility::surface::z_buffer::tile::SamplePlane;
use fearless_simd::Simd;
use fearless_simd::prelude::*;

/// The edge functions of a triangle at the centre of a pixel, in units of 1/65536 pixel², above or
/// equal 0 inside; and their change per step of the grid.
pub struct Edges {
    pub at: [i64; 3],
    pub dx: [i32; 3],
    pub dy: [i32; 3],
}

impl Edges {
    /// Creates the edge functions at the centre of tile pixel (0, 0).
    #[inline(always)]
    pub fn new(t: &ScreenTriangle, tile: [i32; 2]) -> Self {
        let x = i64::from(tile[0] * SUBPIXELS + HALF_PIXEL);
        let y = i64::from(tile[1] * SUBPIXELS + HALF_PIXEL);
        let (mut at, mut step_x, mut step_y) = ([0; 3], [0; 3], [0; 3]);
        for i in 0..3 {
            let j = (i + 1) % 3;
            let (dx, dy) = (t.x[j] - t.x[i], t.y[j] - t.y[i]);
            let value =
                i64::from(dx) * (y - i64::from(t.y[i])) - i64::from(dy) * (x - i64::from(t.x[i]));
            at[i] = value - i64::from(!top_left(dx, dy));
            (step_x[i], step_y[i]) = (-dy, dx);
        }
        Self { at, dx: step_x, dy: step_y }
    }
}

/// Returns whether an edge is a top or left one: pixels on those belong to the triangle, on others they do not.
#[inline(always)]
pub fn top_left(dx: i32, dy: i32) -> bool {
    // dy < 0, or it is 0 and dx > 0; as one sign, because branches on edges would be mispredicted.
    (i64::from(dy) << 33) - i64::from(dx) < 0
}

/// The depth of a triangle at samples side by side.
pub struct LaneDepths<S: Simd> {
    /// Increase of the depth with x.
    from_x: S::f32s,
    /// Positions of the samples in their row.
    lanes_y: S::f32s,
    /// From row 0 of the tile to the row that depths are counted from.
    rows: i32,
}

impl<S: Simd> LaneDepths<S> {
    /// Creates the depths from column `x` on, with the first row of the tile.
    #[inline(always)]
    pub fn new(simd: S, plane: &SamplePlane, t: &ScreenTriangle, [x, tile_y]: [i32; 2]) -> Self {
        let origin = t.origin();
        let [lanes_x, lanes_y] = &plane.lanes_in_pixels;
        let from_x = S::f32s::from_slice(simd, &lanes_x[..lanes::<S>()]) + (x - origin[0]) as f32;
        let lanes_y = S::f32s::from_slice(simd, &lanes_y[..lanes::<S>()]);
        Self { from_x: from_x * t.depth_dx, lanes_y, rows: tile_y - origin[1] }
    }

    /// Returns the bits of the depths in a row of the tile.
    #[inline(always)]
    pub fn at(&self, simd: S, t: &ScreenTriangle, y: i32) -> S::i32s {
        let from_y = (self.lanes_y + (y + self.rows) as f32) * t.depth_dy;
        let depth = (self.from_x + from_y) + t.depth;
        let depth = depth.max(S::f32s::splat(simd, t.depth_min));
        let depth = depth.min(S::f32s::splat(simd, t.depth_max));
        depth.bitcast()
    }
}
