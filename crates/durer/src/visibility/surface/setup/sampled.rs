//! Triangles that are sampled during set-up: in a mesh as fine as the pixels, each covers only a pixel or two, and
//! finding these costs less than storing the triangle.
//!
//! Source: micropolygons, after R. L. Cook, L. Carpenter, E. Catmull, *The Reyes image rendering architecture*,
//! SIGGRAPH 1987; here they are sampled by the same integers as other triangles, eight side by side, in a few
//! operations each.

use super::corner::{Corner, EIGHT};
use super::rules::Rules;
use crate::raster::fixed::{HALF_PIXEL, SUBPIXEL_BITS, SUBPIXELS};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x8, mask32x8, u32x8};

/// Pixels on a side of the boxes of triangles that are sampled at once.
const SIDE: i32 = 4;

/// Pixels have at most as many samples where triangles are sampled at once.
const MOST_SAMPLES: usize = 4;

/// Pixels in such a box, row by row.
pub const PIXELS: usize = (SIDE * SIDE) as usize;

/// Coverage of the small ones among eight triangles, by pixel of their boxes.
#[derive(Default)]
pub struct Sampled {
    /// Triangles that cover any sample in the window, as bits.
    pub which: u64,
    /// Triangles whose backs are seen, as bits.
    pub from_behind: u64,
    /// Columns and rows of the upper left pixels of their boxes, by triangle.
    pub first: [[i32; EIGHT]; 2],
    /// Pixels of its box that each triangle covers, as bits, by sample.
    pub covered: [[u32; EIGHT]; MOST_SAMPLES],
    /// Columns and rows of the pixels that depths are counted from.
    pub origin: [[i32; EIGHT]; 2],
    /// The depths at the centres of these, their changes per pixel, the least and the largest.
    pub depth: [[f32; EIGHT]; 5],
}

/// Ranges, along one axis, of the screen's pixels whose samples may be within the bounds of eight triangles.
#[derive(Clone, Copy)]
pub struct Span<S: Simd> {
    /// The first.
    pub first: i32x8<S>,
    /// After the last.
    end: i32x8<S>,
}

impl<S: Simd> Span<S> {
    /// Builds the range of three coordinates, for samples up to `reach` from pixels' centres.
    #[inline(always)]
    pub fn new(v: [i32x8<S>; 3], reach: i32) -> Self {
        let (low, high) = (v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2]));
        // The first pixel with its centre at least there, as `first_center` has it.
        let first = (low + (HALF_PIXEL - 1 - reach)) >> SUBPIXEL_BITS;
        Self { first, end: (high + (HALF_PIXEL + reach)) >> SUBPIXEL_BITS }
    }

    /// Returns the boxes that miss a window, as bits; the window is given by its first pixel and the one after its
    /// last.
    #[inline(always)]
    pub fn misses(&self, simd: S, [first, end]: [i32; 2]) -> u64 {
        let nowhere = self.first.simd_ge(self.end) | self.end.simd_le(i32x8::splat(simd, first));
        (nowhere | self.first.simd_ge(i32x8::splat(simd, end))).to_bitmask()
    }

    /// Returns whether the ranges are small enough for sampling during set-up: at most [`SIDE`] pixels with one sample
    /// per pixel, fewer with more, so that the fragments take no more memory than the triangle.
    #[inline(always)]
    pub fn is_small(&self, samples: usize) -> mask32x8<S> {
        let most = if samples > 1 { SIDE - 1 } else { SIDE };
        (self.end - self.first).simd_le(most)
    }
}

/// Returns the column and row of a pixel of a box, counted from its first.
#[inline(always)]
pub fn place_in_box(pixel: usize) -> [i32; 2] {
    [pixel as i32 % SIDE, pixel as i32 / SIDE]
}

/// Finds the pixels of their boxes that triangles, whose corners run clockwise, cover at each of the given samples. The
/// result for triangles with larger boxes is meaningless.
#[inline(always)]
pub fn cover<S: Simd>(
    simd: S,
    corners: [Corner<S>; 3],
    first: [i32x8<S>; 2],
    rules: &Rules,
    sampled: &mut Sampled,
) {
    let x = (first[0] << SUBPIXEL_BITS) + HALF_PIXEL;
    let y = (first[1] << SUBPIXEL_BITS) + HALF_PIXEL;
    let mut edges = [Edge { at: x, dx: x, dy: x }; 3];
    for (i, edge) in edges.iter_mut().enumerate() {
        let (from, to) = (&corners[i], &corners[(i + 1) % 3]);
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        // −1 where the edge is a top or left one, whose points belong to the triangle: dy < 0, or it is 0 and dx > 0. A
        // small triangle's edges are shorter than 2¹¹.
        let top_left = ((dy << 11u32) - dx) >> 31u32;
        *edge = Edge { at: dx * (y - from.y) - dy * (x - from.x) - (top_left + 1), dx, dy };
    }
    let in_window = in_window(simd, first, rules.window);
    let mut any = i32x8::splat(simd, 0);
    for (offset, to) in rules.sampled.iter().zip(&mut sampled.covered) {
        let covered = covered_at(simd, &edges, *offset) & in_window;
        any |= covered;
        covered.bitcast::<u32x8<S>>().store_slice(to);
    }
    sampled.which = any.simd_ne(i32x8::splat(simd, 0)).to_bitmask();
    first[0].store_slice(&mut sampled.first[0]);
    first[1].store_slice(&mut sampled.first[1]);
}

/// An edge function of eight triangles at the centres of the first pixels of their boxes, at least 0 inside, and how
/// the edge runs.
#[derive(Clone, Copy)]
struct Edge<S: Simd> {
    at: i32x8<S>,
    dx: i32x8<S>,
    dy: i32x8<S>,
}

/// Returns the pixels of their boxes that triangles cover at a sample at this offset from pixels'
/// centres, as bits.
#[inline(always)]
fn covered_at<S: Simd>(simd: S, edges: &[Edge<S>; 3], [right, down]: [i32; 2]) -> i32x8<S> {
    let mut outside = [i32x8::splat(simd, 0); PIXELS];
    for Edge { at, dx, dy } in edges {
        let mut row = *at + *dx * down - *dy * right;
        let (beside, below) = (*dy * -SUBPIXELS, *dx * SUBPIXELS);
        for pixels in outside.as_chunks_mut::<{ SIDE as usize }>().0 {
            let mut at = row;
            for pixel in pixels {
                *pixel |= at;
                at += beside;
            }
            row += below;
        }
    }
    let mut covered = i32x8::splat(simd, 0);
    for (pixel, outside) in outside.into_iter().enumerate() {
        covered |= !(outside >> 31u32) & (1 << pixel);
    }
    covered
}

/// Returns the pixels of boxes that are in a window, as bits; other bits may be set too.
#[inline(always)]
fn in_window<S: Simd>(
    simd: S,
    [x, y]: [i32x8<S>; 2],
    [[left, right], [top, bottom]]: [[i32; 2]; 2],
) -> i32x8<S> {
    let zero = i32x8::splat(simd, 0);
    let beyond =
        (x.simd_lt(left) | y.simd_lt(top)) | (x.simd_gt(right - SIDE) | y.simd_gt(bottom - SIDE));
    if !beyond.any_true() {
        return !zero;
    }
    let mut bits = zero;
    for pixel in 0..PIXELS {
        let [column, row] = place_in_box(pixel);
        let (x, y) = (x + column, y + row);
        let here = x.simd_ge(left) & y.simd_ge(top) & x.simd_lt(right) & y.simd_lt(bottom);
        bits |= here.select(i32x8::splat(simd, 1 << pixel), zero);
    }
    bits
}
