//! One tile of the visibility buffer: which triangle is nearest at each sample.
//!
//! Depths are kept as the bits of non-negative floats, which compare like integers.

use crate::raster::fixed::{HALF_PIXEL, SUBPIXEL_BITS, SUBPIXELS};
use crate::target::NO_ITEM;
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, i32x8, u32x8};
use fearless_simd_macros::simd;

/// Pixels along the side of a tile: depth and item of one sample plane of a tile, 32 kB, fit the
/// first-level cache.
pub const TILE: i32 = 64;

/// Pixels of a tile.
pub const TILE_PIXELS: usize = (TILE * TILE) as usize;

/// Bits of 1.0, the cleared depth.
const FAR: i32 = 0x3f80_0000;

/// Where a sample lies, from the pixel's centre, in 1/256 pixel.
pub type SampleOffset = [i32; 2];

/// A plane of one sample per pixel: the depth bits and the item of the nearest triangle.
pub struct SamplePlane {
    offset: SampleOffset,
    depth: Vec<i32>,
    item: Vec<u32>,
}

impl SamplePlane {
    pub fn new(offset: SampleOffset) -> Self {
        Self { offset, depth: vec![FAR; TILE_PIXELS], item: vec![NO_ITEM; TILE_PIXELS] }
    }

    pub fn clear(&mut self) {
        self.depth.fill(FAR);
        self.item.fill(NO_ITEM);
    }

    pub fn items(&self) -> &[u32] {
        &self.item
    }

    pub fn depth(&self, index: usize) -> f32 {
        f32::from_bits(self.depth[index] as u32)
    }
}

/// Is asked for each fragment that passes the depth test, with its tile-local pixel; a fragment is
/// written only if it passes.
pub trait FragmentTest {
    fn passes(&mut self, t: &ScreenTriangle, x: i32, y: i32, sample: usize) -> bool;
}

/// Lets every fragment pass.
pub struct AllPass;

impl FragmentTest for AllPass {
    fn passes(&mut self, _: &ScreenTriangle, _: i32, _: i32, _: usize) -> bool {
        true
    }
}

/// A triangle prepared for one tile: edge functions and depth, in tile-local pixels.
#[derive(Clone, Copy)]
struct TileTriangle {
    /// Change of the edge functions per pixel to the right and downwards.
    step_x: [i64; 3],
    step_y: [i64; 3],
    /// Edge functions at the sample of tile pixel (0, 0).
    edge: [i64; 3],
    /// Depth at the sample of tile pixel (0, 0) is `depth + depth_dx · from[0] + depth_dy · from[1]`.
    from: [f32; 2],
    /// Which sample plane.
    sample: usize,
    triangle: ScreenTriangle,
}

impl TileTriangle {
    /// At the centre of the pixels.
    #[inline(always)]
    fn new(t: &ScreenTriangle, tile: [i32; 2]) -> Self {
        let sx = i64::from(tile[0] * SUBPIXELS + HALF_PIXEL);
        let sy = i64::from(tile[1] * SUBPIXELS + HALF_PIXEL);
        let (mut step_x, mut step_y, mut edge) = ([0; 3], [0; 3], [0; 3]);
        for i in 0..3 {
            let j = (i + 1) % 3;
            let (dx, dy) = (i64::from(t.x[j] - t.x[i]), i64::from(t.y[j] - t.y[i]));
            // Pixels on a top or left edge belong to the triangle, on others they do not.
            let top_left = dy < 0 || (dy == 0 && dx > 0);
            let value = dx * (sy - i64::from(t.y[i])) - dy * (sx - i64::from(t.x[i]));
            edge[i] = value - i64::from(!top_left);
            step_x[i] = -dy;
            step_y[i] = dx;
        }
        let origin = t.origin();
        let from = [(tile[0] - origin[0]) as f32, (tile[1] - origin[1]) as f32];
        Self { step_x, step_y, edge, from, sample: 0, triangle: *t }
    }

    /// At a sample of the pixels, with edge functions divided by 256 and rounded down: their signs
    /// stay, for whole pixels change them by multiples of 256.
    #[inline(always)]
    fn at_sample(&self, offset: SampleOffset, sample: usize) -> Self {
        let mut moved = *self;
        let (ox, oy) = (i64::from(offset[0]), i64::from(offset[1]));
        for i in 0..3 {
            let edge = self.edge[i] + self.step_x[i] * ox + self.step_y[i] * oy;
            moved.edge[i] = edge >> SUBPIXEL_BITS;
        }
        moved.from[0] += offset[0] as f32 / SUBPIXELS as f32;
        moved.from[1] += offset[1] as f32 / SUBPIXELS as f32;
        moved.sample = sample;
        moved
    }

    /// Whether the edge functions fit i32 in the whole tile.
    #[inline(always)]
    fn fits_i32(&self) -> bool {
        extent(&self.triangle.x) < SMALL_EXTENT && extent(&self.triangle.y) < SMALL_EXTENT
    }

    /// The edge functions at a tile-local pixel.
    #[inline(always)]
    fn edges_at(&self, x: i32, y: i32) -> [i64; 3] {
        let (x, y) = (i64::from(x), i64::from(y));
        [
            self.edge[0] + self.step_x[0] * x + self.step_y[0] * y,
            self.edge[1] + self.step_x[1] * x + self.step_y[1] * y,
            self.edge[2] + self.step_x[2] * x + self.step_y[2] * y,
        ]
    }
}

/// Edge functions of a row of eight pixels, in i32.
struct RowEdges<S: Simd> {
    row: [i32x8<S>; 3],
    step_y: [i32; 3],
}

impl<S: Simd> RowEdges<S> {
    #[inline(always)]
    fn new(simd: S, at: [i32; 3], step_x: [i32; 3], step_y: [i32; 3]) -> Self {
        let lanes = i32x8::from_slice(simd, &[0, 1, 2, 3, 4, 5, 6, 7]);
        // Spelled out: a closure would not be compiled for the SIMD level.
        let row = [lanes * step_x[0] + at[0], lanes * step_x[1] + at[1], lanes * step_x[2] + at[2]];
        Self { row, step_y }
    }

    /// Sign bit set where the pixel is outside an edge.
    #[inline(always)]
    fn outside(&self) -> i32x8<S> {
        self.row[0] | self.row[1] | self.row[2]
    }

    #[inline(always)]
    fn next_row(&mut self) {
        self.row[0] += self.step_y[0];
        self.row[1] += self.step_y[1];
        self.row[2] += self.step_y[2];
    }
}

/// Rasterizes triangles into the planes of the tile whose upper left pixel is `tile`, cut off after
/// `size` pixels; `test` is asked for each fragment where it is given.
#[simd]
pub fn rasterize<'a, S: Simd, T: FragmentTest>(
    simd: S,
    planes: &mut [SamplePlane],
    [tile, size]: [[i32; 2]; 2],
    triangles: impl Iterator<Item = &'a ScreenTriangle>,
    mut test: Option<&mut T>,
) {
    for triangle in triangles {
        let mut at_center = None;
        for (sample, plane) in planes.iter_mut().enumerate() {
            // Most triangles of a fine mesh lie between the samples.
            let Some(bounds) = sample_bounds(triangle, tile, size, plane.offset) else { continue };
            let t = at_center.get_or_insert_with(|| TileTriangle::new(triangle, tile));
            let t = t.at_sample(plane.offset, sample);
            let [x0, y0, x1, y1] = bounds;
            if (x1 - x0 + 1) * (y1 - y0 + 1) <= TINY {
                rasterize_tiny(plane, &t, bounds, &mut test);
            } else if x1 - x0 < SMALL && y1 - y0 < SMALL && t.fits_i32() {
                rasterize_box(simd, plane, &t, bounds, &mut test);
            } else {
                rasterize_blocks(simd, plane, &t, bounds, &mut test);
            }
        }
    }
}

/// Triangles of at most this many pixels on a side within the tile skip the test of whole blocks.
const SMALL: i32 = 16;

/// Edge functions of triangles of less than this extent fit i32 in the whole tile: at most
/// 2 · 2¹⁷ · (512 + 64) < 2²⁸.
const SMALL_EXTENT: i32 = 512 * SUBPIXELS;

/// Boxes of at most this many pixels are worked off one by one.
const TINY: i32 = 4;

/// Tiny triangles: each pixel of their bounding box, with the same arithmetic as eight at a time.
#[inline(always)]
fn rasterize_tiny<T: FragmentTest>(
    plane: &mut SamplePlane,
    t: &TileTriangle,
    [x0, y0, x1, y1]: [i32; 4],
    test: &mut Option<&mut T>,
) {
    for y in y0..=y1 {
        let depth_y = t.triangle.depth_dy * (t.from[1] + y as f32);
        for x in x0..=x1 {
            let [a, b, c] = t.edges_at(x, y);
            if (a | b | c) < 0 {
                continue;
            }
            let depth_x = (x as f32 + t.from[0]) * t.triangle.depth_dx;
            let depth = ((depth_x + depth_y) + t.triangle.depth)
                .max(t.triangle.depth_min)
                .min(t.triangle.depth_max);
            let depth = depth.to_bits() as i32;
            let index = (y * TILE + x) as usize;
            let (old, old_item) = (plane.depth[index], plane.item[index]);
            let wins = depth < old || (depth == old && (t.triangle.item as i32) <= old_item as i32);
            if wins && test.as_mut().is_none_or(|p| p.passes(&t.triangle, x, y, t.sample)) {
                (plane.depth[index], plane.item[index]) = (depth, t.triangle.item);
            }
        }
    }
}

/// Small triangles: all rows of their bounding box, eight pixels at a time.
#[inline(always)]
fn rasterize_box<S: Simd, T: FragmentTest>(
    simd: S,
    plane: &mut SamplePlane,
    t: &TileTriangle,
    [x0, y0, x1, y1]: [i32; 4],
    test: &mut Option<&mut T>,
) {
    let mut x = x0 & !7;
    while x <= x1 {
        let at = low_bits(t.edges_at(x, y0));
        let edges = RowEdges::new(simd, at, low_bits(t.step_x), low_bits(t.step_y));
        fill_rows(simd, plane, t, edges, [x, y0, y1], test);
        x += 8;
    }
}

#[inline(always)]
fn extent(v: &[i32; 3]) -> i32 {
    v[0].max(v[1]).max(v[2]) - v[0].min(v[1]).min(v[2])
}

#[inline(always)]
fn low_bits(v: [i64; 3]) -> [i32; 3] {
    [v[0] as i32, v[1] as i32, v[2] as i32]
}

/// Tile-local bounds of the pixels whose samples may be covered; `None` where there are none.
#[inline(always)]
fn sample_bounds(
    t: &ScreenTriangle,
    tile: [i32; 2],
    size: [i32; 2],
    offset: SampleOffset,
) -> Option<[i32; 4]> {
    let (x0, x1) = sample_range(&t.x, HALF_PIXEL + offset[0]);
    let (y0, y1) = sample_range(&t.y, HALF_PIXEL + offset[1]);
    let (x0, x1) = ((x0 - tile[0]).max(0), (x1 - tile[0]).min(size[0] - 1));
    let (y0, y1) = ((y0 - tile[1]).max(0), (y1 - tile[1]).min(size[1] - 1));
    (x0 <= x1 && y0 <= y1).then_some([x0, y0, x1, y1])
}

/// First and last pixel whose sample, `shift` after its corner, lies between the coordinates.
#[inline(always)]
fn sample_range(v: &[i32; 3], shift: i32) -> (i32, i32) {
    let (lo, hi) = (v[0].min(v[1]).min(v[2]) - shift, v[0].max(v[1]).max(v[2]) - shift);
    ((lo + SUBPIXELS - 1) >> SUBPIXEL_BITS, hi >> SUBPIXEL_BITS)
}

/// Large triangles: whole blocks of 8 × 8 pixels are rejected or accepted by their corners.
#[inline(always)]
fn rasterize_blocks<S: Simd, T: FragmentTest>(
    simd: S,
    plane: &mut SamplePlane,
    t: &TileTriangle,
    [x0, y0, x1, y1]: [i32; 4],
    test: &mut Option<&mut T>,
) {
    // What the edge functions change at most from a block's first pixel to its others.
    let (mut lowest, mut highest) = ([0; 3], [0; 3]);
    for i in 0..3 {
        lowest[i] = 7 * (t.step_x[i].min(0) + t.step_y[i].min(0));
        highest[i] = 7 * (t.step_x[i].max(0) + t.step_y[i].max(0));
    }
    let (x0, mut y) = (x0 & !7, y0 & !7);
    while y <= y1 {
        let mut x = x0;
        while x <= x1 {
            let at = t.edges_at(x, y);
            if at[0] + highest[0] >= 0 && at[1] + highest[1] >= 0 && at[2] + highest[2] >= 0 {
                // An edge that the whole block lies inside of is left out; the others fit i32.
                let (mut edge, mut step_x, mut step_y) = ([0; 3], [0; 3], [0; 3]);
                for i in 0..3 {
                    if at[i] + lowest[i] < 0 {
                        edge[i] = at[i] as i32;
                        step_x[i] = t.step_x[i] as i32;
                        step_y[i] = t.step_y[i] as i32;
                    }
                }
                let edges = RowEdges::new(simd, edge, step_x, step_y);
                fill_rows(simd, plane, t, edges, [x, y, y1.min(y + 7)], test);
            }
            x += 8;
        }
        y += 8;
    }
}

/// Eight pixels wide from column x, rows y0 … y1: coverage, depth test, write.
#[inline(always)]
fn fill_rows<S: Simd, T: FragmentTest>(
    simd: S,
    plane: &mut SamplePlane,
    t: &TileTriangle,
    mut edges: RowEdges<S>,
    [x, y0, y1]: [i32; 3],
    test: &mut Option<&mut T>,
) {
    let lanes = f32x8::from_slice(simd, &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
    let depth_x = (lanes + (t.from[0] + x as f32)) * t.triangle.depth_dx;
    for y in y0..=y1 {
        let outside = edges.outside();
        edges.next_row();
        // Thin triangles leave most rows of their boxes and blocks empty.
        if !outside.simd_ge(i32x8::splat(simd, 0)).any_true() {
            continue;
        }
        let index = (y * TILE + x) as usize;
        let depth_y = t.triangle.depth_dy * (t.from[1] + y as f32);
        let depth = (depth_x + depth_y) + t.triangle.depth;
        let depth = depth
            .max(f32x8::splat(simd, t.triangle.depth_min))
            .min(f32x8::splat(simd, t.triangle.depth_max));
        let depth: i32x8<S> = depth.bitcast();
        let stored = &mut plane.depth[index..index + 8];
        let old = i32x8::from_slice(simd, stored);
        // Both are bits of floats ≥ 0, so the difference keeps its sign.
        let mut write = !((old - depth) | outside) >> 31u32;
        if !write.simd_lt(i32x8::splat(simd, 0)).any_true() {
            continue;
        }
        let items = &mut plane.item[index..index + 8];
        let old_item: i32x8<S> = u32x8::from_slice(simd, items).bitcast();
        let item = t.triangle.item as i32;
        // At equal depths the lower item wins, whatever the order of drawing.
        let tie_lost = !(depth - old) & ((old_item - item) >> 31u32);
        write &= !(tie_lost >> 31u32);
        if let Some(test) = test.as_mut() {
            write = tested(simd, write, t, [x, y], *test);
        }
        // Not a select: that would become a masked store, which is far slower.
        (old ^ ((old ^ depth) & write)).store_slice(stored);
        let new_item: u32x8<S> = (old_item ^ ((old_item ^ item) & write)).bitcast();
        new_item.store_slice(items);
    }
}

#[inline(never)]
fn tested<S: Simd, T: FragmentTest>(
    simd: S,
    write: i32x8<S>,
    t: &TileTriangle,
    [x, y]: [i32; 2],
    test: &mut T,
) -> i32x8<S> {
    let mut lanes = [0i32; 8];
    write.store_slice(&mut lanes);
    for (i, lane) in lanes.iter_mut().enumerate() {
        if *lane != 0 && !test.passes(&t.triangle, x + i as i32, y, t.sample) {
            *lane = 0;
        }
    }
    i32x8::from_slice(simd, &lanes)
}
