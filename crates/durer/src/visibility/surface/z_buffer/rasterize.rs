//! Triangles into the samples of a tile: coverage, depth test, write; as many samples at a time as the
//! machine's registers hold.

mod planes;

use super::tile::{BLOCK, MOST_LANES, SamplePlane, TILE};
use crate::raster::fixed::{HALF_PIXEL, SUBPIXEL_BITS, SUBPIXELS};
use crate::simd::lanes;
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x8};
use fearless_simd_macros::simd;
use planes::{Edges, LaneDepths, top_left};

/// Is requested the fragments that pass the depth test; a fragment is written only if it passes.
pub trait FragmentTest {
    /// Returns which of consecutive samples pass, among those whose bits are all set in `write`: from the first
    /// sample of the tile-local pixel `at` on, of a plane whose pixels have 2^`shift` samples from the number
    /// `first` on.
    fn pass<S: Simd>(
        &mut self,
        simd: S,
        write: S::i32s,
        t: &ScreenTriangle,
        at: [i32; 2],
        place: (usize, u32),
    ) -> S::i32s;
}

/// Test that every fragment passes.
pub struct AllPass;

impl FragmentTest for AllPass {
    #[inline(always)]
    fn pass<S: Simd>(
        &mut self,
        _: S,
        write: S::i32s,
        _: &ScreenTriangle,
        _: [i32; 2],
        _: (usize, u32),
    ) -> S::i32s {
        write
    }
}

/// Edge functions of triangles of less than this extent fit i32, in units of 1/65536 pixel², at all
/// pixels of their bounding box and fifteen beside it: at most 2 · 2¹⁴ · (2¹⁴ + 2¹²) < 2³⁰.
const SMALL_EXTENT: i32 = 64 * SUBPIXELS;

/// Small triangles of at most this many pixels on a side within the tile skip the test of whole blocks.
const SMALL: i32 = 16;

/// Edge functions of consecutive samples, in i32.
#[derive(Clone, Copy)]
struct LaneEdges<S: Simd> {
    row: [S::i32s; 3],
    step_y: [i32; 3],
}

impl<S: Simd> LaneEdges<S> {
    /// Returns numbers whose sign bit is set where the sample is outside an edge.
    #[inline(always)]
    fn outside(&self) -> S::i32s {
        self.row[0] | self.row[1] | self.row[2]
    }

    /// Returns the numbers of [`Self::outside`] `row` rows further down.
    #[inline(always)]
    fn outside_in_row(&self, row: i32) -> S::i32s {
        let [a, b, c] = &self.row;
        let [step_a, step_b, step_c] = self.step_y;
        (*a + step_a.wrapping_mul(row))
            | (*b + step_b.wrapping_mul(row))
            | (*c + step_c.wrapping_mul(row))
    }

    #[inline(always)]
    fn next_row(&mut self) {
        self.row[0] += self.step_y[0];
        self.row[1] += self.step_y[1];
        self.row[2] += self.step_y[2];
    }
}

/// Rasterizes triangles into the planes of the tile whose upper left pixel is `tile`, cut off after
/// `size` pixels; `test` is requested each fragment if it is given.
#[simd]
pub fn rasterize<'a, S: Simd, T: FragmentTest>(
    simd: S,
    planes: &mut [SamplePlane],
    [tile, size]: [[i32; 2]; 2],
    triangles: impl Iterator<Item = &'a ScreenTriangle>,
    mut test: Option<&mut T>,
) {
    for t in triangles {
        let (x_min, x_max) = (t.x[0].min(t.x[1]).min(t.x[2]), t.x[0].max(t.x[1]).max(t.x[2]));
        let (y_min, y_max) = (t.y[0].min(t.y[1]).min(t.y[2]), t.y[0].max(t.y[1]).max(t.y[2]));
        let small = x_max - x_min < SMALL_EXTENT && y_max - y_min < SMALL_EXTENT;
        for plane in planes.iter_mut() {
            // First and last pixel that has a sample between the triangle's extreme coordinates.
            let [[left, right], [up, down]] = plane.reach;
            let x0 = (x_min - HALF_PIXEL - right + SUBPIXELS - 1) >> SUBPIXEL_BITS;
            let x1 = (x_max - HALF_PIXEL - left) >> SUBPIXEL_BITS;
            let y0 = (y_min - HALF_PIXEL - down + SUBPIXELS - 1) >> SUBPIXEL_BITS;
            let y1 = (y_max - HALF_PIXEL - up) >> SUBPIXEL_BITS;
            let (x0, x1) = ((x0 - tile[0]).max(0), (x1 - tile[0]).min(size[0] - 1));
            let (y0, y1) = ((y0 - tile[1]).max(0), (y1 - tile[1]).min(size[1] - 1));
            // Most triangles of a fine mesh are between the samples.
            if x0 > x1 || y0 > y1 {
                continue;
            }
            if plane.hides([x0, y0, x1, y1], t.depth_min.to_bits() as i32) {
                continue;
            }
            if small && x1 - x0 < SMALL && y1 - y0 < SMALL {
                rasterize_box(simd, plane, t, tile, [x0, y0, x1, y1], &mut test);
            } else {
                rasterize_blocks(simd, plane, t, tile, [x0, y0, x1, y1], &mut test);
            }
        }
    }
}

/// Rasterizes a small triangle: all rows of its bounding box.
#[inline(always)]
fn rasterize_box<S: Simd, T: FragmentTest>(
    simd: S,
    plane: &mut SamplePlane,
    t: &ScreenTriangle,
    tile: [i32; 2],
    [x0, y0, x1, y1]: [i32; 4],
    test: &mut Option<&mut T>,
) {
    let columns = lanes::<S>() as i32 >> plane.shift;
    // The start is not aligned to a multiple of the columns, so that fewer steps cover a small box.
    let mut x = x0.min(TILE - columns);
    let px = (tile[0] + x) * SUBPIXELS + HALF_PIXEL;
    let py = (tile[1] + y0) * SUBPIXELS + HALF_PIXEL;
    let lane_x = S::i32s::from_slice(simd, &plane.lanes[0][..lanes::<S>()]);
    let lane_y = S::i32s::from_slice(simd, &plane.lanes[1][..lanes::<S>()]);
    let mut edges = LaneEdges { row: [lane_x; 3], step_y: [0; 3] };
    let mut step_x = [0; 3];
    // Edge functions at each lane, and their steps to the next row and column.
    for (i, step_x) in step_x.iter_mut().enumerate() {
        let j = (i + 1) % 3;
        let (dx, dy) = (t.x[j] - t.x[i], t.y[j] - t.y[i]);
        let at = dx * (py - t.y[i]) - dy * (px - t.x[i]) - i32::from(!top_left(dx, dy));
        edges.row[i] = lane_y * dx - lane_x * dy + at;
        edges.step_y[i] = dx * SUBPIXELS;
        *step_x = -dy * SUBPIXELS;
    }
    loop {
        fill_rows(simd, plane, t, tile, edges, [x, y0, y1], test);
        x += columns;
        if x > x1 {
            return;
        }
        // The last step may not reach beyond the tile.
        let over = (x + columns - TILE).max(0);
        x -= over;
        for (row, step) in edges.row.iter_mut().zip(step_x) {
            *row += step * (columns - over);
        }
    }
}

/// Rasterizes a large triangle: whole blocks of 8 × 8 pixels, or wider ones where more are tested at a time, are
/// rejected or accepted by their corners.
#[inline(always)]
fn rasterize_blocks<S: Simd, T: FragmentTest>(
    simd: S,
    plane: &mut SamplePlane,
    t: &ScreenTriangle,
    tile: [i32; 2],
    [x0, y0, x1, y1]: [i32; 4],
    test: &mut Option<&mut T>,
) {
    let Edges { at, dx, dy } = Edges::new(t, tile);
    let columns = lanes::<S>() as i32 >> plane.shift;
    let width = columns.max(BLOCK);
    let [[left, right], [up, down]] = plane.reach;
    // Edge functions divided by 256 and rounded down keep their signs, because whole pixels change them by multiples of
    // 256. These are their differences between the samples and the pixel's centre.
    let mut at_lanes = [S::i32s::splat(simd, 0); 3];
    // The smallest and the largest change from the centre of a block's first pixel to the block's samples.
    let (mut lowest, mut highest) = ([0; 3], [0; 3]);
    // The largest change to the samples in each row of a block, from the same centre.
    let mut rows = [i32x8::splat(simd, 0); 3];
    let row_numbers = i32x8::from_slice(simd, &[0, 1, 2, 3, 4, 5, 6, 7]);
    for i in 0..3 {
        let (dx, dy) = (i64::from(dx[i]), i64::from(dy[i]));
        let rest = at[i] & i64::from(SUBPIXELS - 1);
        let mut lane = [0; MOST_LANES];
        for (l, lane) in lane.iter_mut().enumerate() {
            let (x, y) = (i64::from(plane.lanes[0][l]), i64::from(plane.lanes[1][l]));
            *lane = ((rest + dx * x + dy * y) >> SUBPIXEL_BITS) as i32;
        }
        at_lanes[i] = S::i32s::from_slice(simd, &lane[..lanes::<S>()]);
        let (last_x, last_y) = ((width - 1) * SUBPIXELS, (BLOCK - 1) * SUBPIXELS);
        let (x_first, x_last) = (dx * i64::from(left), dx * i64::from(last_x + right));
        let (y_first, y_last) = (dy * i64::from(up), dy * i64::from(last_y + down));
        lowest[i] = x_first.min(x_last) + y_first.min(y_last);
        highest[i] = x_first.max(x_last) + y_first.max(y_last);
        let x_last = dx * i64::from((columns - 1) * SUBPIXELS + right);
        let y_last = dy * i64::from(down);
        let most = (rest + x_first.max(x_last) + y_first.max(y_last)) >> SUBPIXEL_BITS;
        rows[i] = row_numbers * dy as i32 + most as i32;
    }
    let (x0, mut y) = (x0 & -width, y0 & -BLOCK);
    let nearest = t.depth_min.to_bits() as i32;
    // Changes from a block to the one beside it, and to the one below.
    let beside = dx.map(|dx| i64::from(dx) * i64::from(width * SUBPIXELS));
    let below = dy.map(|dy| i64::from(dy) * i64::from(BLOCK * SUBPIXELS));
    let mut first = [0; 3];
    for i in 0..3 {
        first[i] = at[i] + i64::from(dx[i]) * i64::from(x0 * SUBPIXELS);
        first[i] += i64::from(dy[i]) * i64::from(y * SUBPIXELS);
    }
    while y <= y1 {
        let (mut x, mut here, mut entered) = (x0, first, false);
        while x <= x1 {
            let outside = (0..3).any(|i| here[i] + highest[i] < 0);
            // Blocks that are not outside are side by side.
            if outside && entered {
                break;
            }
            entered |= !outside;
            if !outside && !plane.hides([x, y, x + width - 1, y], nearest) {
                let mut edges = LaneEdges { row: [S::i32s::splat(simd, 0); 3], step_y: [0; 3] };
                let mut most = [i32x8::splat(simd, 0); 3];
                let mut step_x = [0; 3];
                for i in 0..3 {
                    // An edge with the whole block inside is left out; the values of the others fit i32.
                    if here[i] + lowest[i] < 0 {
                        edges.row[i] = at_lanes[i] + (here[i] >> SUBPIXEL_BITS) as i32;
                        most[i] = rows[i] + (here[i] >> SUBPIXEL_BITS) as i32;
                        edges.step_y[i] = dy[i];
                        step_x[i] = dx[i].wrapping_mul(columns);
                    }
                }
                let in_box = (2u64 << (y1 - y).min(7)) - 1;
                let mut column = 0;
                while column < width {
                    // Rows with a sample that may be inside; thin triangles have few of them.
                    let inside = (most[0] | most[1] | most[2]).simd_ge(i32x8::splat(simd, 0));
                    let found = inside.to_bitmask() & in_box;
                    fill_found(simd, plane, t, tile, &edges, [x + column, y], found, test);
                    for i in 0..3 {
                        edges.row[i] += step_x[i];
                        most[i] += step_x[i];
                    }
                    column += columns;
                }
            }
            for (here, step) in here.iter_mut().zip(beside) {
                *here += step;
            }
            x += width;
        }
        for (first, step) in first.iter_mut().zip(below) {
            *first += step;
        }
        y += BLOCK;
    }
}

/// Fills one step wide from column x, rows y0 … y1: coverage, depth test, write.
#[inline(always)]
fn fill_rows<S: Simd, T: FragmentTest>(
    simd: S,
    plane: &mut SamplePlane,
    t: &ScreenTriangle,
    tile: [i32; 2],
    mut edges: LaneEdges<S>,
    [x, y0, y1]: [i32; 3],
    test: &mut Option<&mut T>,
) {
    let depths = LaneDepths::new(simd, plane, t, [tile[0] + x, tile[1]]);
    for y in y0..=y1 {
        let outside = edges.outside();
        edges.next_row();
        // Thin triangles leave most rows of their boxes empty.
        if outside.simd_ge(S::i32s::splat(simd, 0)).any_true() {
            fill_row(simd, plane, t, &depths, outside, [x, y], test);
        }
    }
}

/// Fills one step wide from column x, the rows from y on whose bits are set in `rows`.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "one call, all of it a block's state")]
fn fill_found<S: Simd, T: FragmentTest>(
    simd: S,
    plane: &mut SamplePlane,
    t: &ScreenTriangle,
    tile: [i32; 2],
    edges: &LaneEdges<S>,
    [x, y]: [i32; 2],
    mut rows: u64,
    test: &mut Option<&mut T>,
) {
    if rows == 0 {
        return;
    }
    let depths = LaneDepths::new(simd, plane, t, [tile[0] + x, tile[1]]);
    while rows != 0 {
        let row = rows.trailing_zeros() as i32;
        rows &= rows - 1;
        let outside = edges.outside_in_row(row);
        if outside.simd_ge(S::i32s::splat(simd, 0)).any_true() {
            fill_row(simd, plane, t, &depths, outside, [x, y + row], test);
        }
    }
}

/// Fills a step's samples of row y from column x, some of which are inside all edges: depth test, write.
#[inline(always)]
fn fill_row<S: Simd, T: FragmentTest>(
    simd: S,
    plane: &mut SamplePlane,
    t: &ScreenTriangle,
    depths: &LaneDepths<S>,
    outside: S::i32s,
    [x, y]: [i32; 2],
    test: &mut Option<&mut T>,
) {
    let index = ((y * TILE + x) << plane.shift) as usize;
    let depth = depths.at(simd, t, y);
    let stored = &mut plane.depth[index..index + lanes::<S>()];
    let old = S::i32s::from_slice(simd, stored);
    // Both are bits of floats ≥ 0, so the difference keeps its sign.
    let mut write = !((old - depth) | outside) >> 31u32;
    if !write.simd_lt(S::i32s::splat(simd, 0)).any_true() {
        return;
    }
    let items = &mut plane.item[index..index + lanes::<S>()];
    let old_item: S::i32s = S::u32s::from_slice(simd, items).bitcast();
    let item = t.item as i32;
    // At equal depths the lower item wins, regardless of the order of drawing.
    let tie_lost = !(depth - old) & ((old_item - item) >> 31u32);
    write &= !(tie_lost >> 31u32);
    if let Some(test) = test.as_mut() {
        write = test.pass(simd, write, t, [x, y], (plane.first, plane.shift));
    }
    // Not a select, which would become a masked store, far slower.
    (old ^ ((old ^ depth) & write)).store_slice(stored);
    let new_item: S::u32s = (old_item ^ ((old_item ^ item) & write)).bitcast();
    new_item.store_slice(items);
}

/// Tests for each of the samples in `write` whether it passes; `passes` gets its pixel and its number within the pixel.
#[inline(never)]
pub fn one_by_one<S: Simd>(
    simd: S,
    write: S::i32s,
    [x, y]: [i32; 2],
    shift: u32,
    mut passes: impl FnMut(i32, i32, usize) -> bool,
) -> S::i32s {
    let mut written = [0i32; MOST_LANES];
    let written = &mut written[..lanes::<S>()];
    write.store_slice(written);
    for (i, lane) in written.iter_mut().enumerate() {
        let (pixel, sample) = (i >> shift, i & ((1 << shift) - 1));
        if *lane != 0 && !passes(x + pixel as i32, y, sample) {
            *lane = 0;
        }
    }
    S::i32s::from_slice(simd, written)
}
