//! The parts of short lines within a tile, several of them set up at once.

use crate::simd::dispatch;
use fearless_simd::prelude::*;
use fearless_simd::{Level, f32x8, i32x8};
use fearless_simd_macros::simd;

/// Lines that are set up at once.
pub(super) const AT_ONCE: usize = 8;
/// Pixels of a tile's side, as a power of two.
pub(super) const TILE_BITS: u32 = 7;
/// Pixels of a tile.
pub(super) const PIXELS: usize = 1 << (2 * TILE_BITS);
/// Short lines have at most this many steps.
pub(super) const SHORT: u32 = 511;
/// Bits of the distance across below the pixel: as 8 · steps · (steps + 1) < 2²¹ it comes out exact.
const BITS: u32 = 21;
/// One pixel.
const ONE: i32 = 1 << BITS;

/// Short lines as seen from the corner of a tile.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Ends {
    /// First pixels.
    pub x0: [i32; AT_ONCE],
    pub y0: [i32; AT_ONCE],
    /// Last pixels.
    pub x1: [i32; AT_ONCE],
    pub y1: [i32; AT_ONCE],
}

/// The parts of lines within a tile: at which place of it they begin, and how they go on.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pieces {
    /// The place of the first pixel, were it not for the distance across.
    base: [i32; AT_ONCE],
    /// Change of the place by a step along, and by a step across.
    step: [i32; AT_ONCE],
    stride: [i32; AT_ONCE],
    /// The distance across, and how much a step adds to it.
    sum: [i32; AT_ONCE],
    slope: [i32; AT_ONCE],
    /// Steps to take.
    count: [i32; AT_ONCE],
}

impl Pieces {
    /// Finds the parts of the lines between the corner and `size` pixels from there.
    #[inline(always)]
    pub fn set_up(&mut self, level: Level, ends: &Ends, size: (i32, i32)) {
        dispatch!(level, simd => set_up(simd, ends, size, self));
    }

    /// Draws one of them.
    #[inline(always)]
    pub fn draw<T: Copy>(&self, i: usize, value: T, tile: &mut [T; PIXELS]) {
        let i = i & (AT_ONCE - 1);
        let (mut base, mut sum) = (self.base[i], self.sum[i]);
        for _ in 0..self.count[i] {
            // The place is within the tile; the mask is for the compiler.
            tile[(base + (sum >> BITS) * self.stride[i]) as usize & (PIXELS - 1)] = value;
            base += self.step[i];
            sum += self.slope[i];
        }
    }
}

/// Sets up the parts of the lines as [`super::Course`] does, but without branches.
#[simd]
fn set_up<S: Simd>(simd: S, ends: &Ends, size: (i32, i32), out: &mut Pieces) {
    let (zero, unit) = (i32x8::splat(simd, 0), i32x8::splat(simd, 1));
    let x = (i32x8::from_slice(simd, &ends.x0), i32x8::from_slice(simd, &ends.x1));
    let y = (i32x8::from_slice(simd, &ends.y0), i32x8::from_slice(simd, &ends.y1));
    let (dx, dy) = (x.1 - x.0, y.1 - y.0);
    let (dx, dy) = (dx.max(-dx), dy.max(-dy));
    let (steps, rise) = (dx.max(dy), dx.min(dy));
    // Along the longer axis, in the direction of rising coordinates.
    let steep = dy.simd_gt(dx);
    let a = (steep.select(y.0, x.0), steep.select(y.1, x.1));
    let c = (steep.select(x.0, y.0), steep.select(x.1, y.1));
    let swap = a.0.simd_gt(a.1);
    let along = a.0.min(a.1);
    let (across, end) = (swap.select(c.1, c.0), swap.select(c.0, c.1));
    let falls = end.simd_lt(across);
    // After k steps the distance across is the whole part of start + k · slope. The slope is too large by less than
    // four units and the start by less than one: together less than the distance to the next multiple of 1/(2 · steps).
    let length = simd.cvt_f32_i32x8(steps.max(unit));
    let one = f32x8::splat(simd, ONE as f32);
    let slope = simd.cvt_i32_f32x8(simd.cvt_f32_i32x8(rise) / length * one) + i32x8::splat(simd, 2);
    let half = f32x8::splat(simd, (ONE / 2) as f32);
    let tie = falls.select(zero, simd.cvt_i32_f32x8(half / length));
    let start = i32x8::splat(simd, ONE / 2) - tie;
    // Where the borders of the tile cut it.
    let (width, height) = (i32x8::splat(simd, size.0), i32x8::splat(simd, size.1));
    let (size_along, size_across) = (steep.select(height, width), steep.select(width, height));
    let above = across - (size_across - unit);
    let near = falls.select(above, -across);
    let far = falls.select(across, -above);
    let course = (rise, start, slope);
    let first = (-along).max(zero).max(reaches(simd, course, near));
    let last = reaches(simd, course, far + unit) - unit;
    let last = steps.min(size_along - unit - along).min(last);
    let (down, right) = (i32x8::splat(simd, 1 << TILE_BITS), unit);
    let (step, stride) = (steep.select(down, right), steep.select(right, down));
    ((along + first) * step + across * stride).store_slice(&mut out.base);
    step.store_slice(&mut out.step);
    falls.select(-stride, stride).store_slice(&mut out.stride);
    (start + first * slope).store_slice(&mut out.sum);
    slope.store_slice(&mut out.slope);
    (last + unit - first).store_slice(&mut out.count);
}

/// Returns the first step with a distance across; beyond the last for one more than the line has.
#[inline(always)]
fn reaches<S: Simd>(
    simd: S,
    (rise, start, slope): (i32x8<S>, i32x8<S>, i32x8<S>),
    distance: i32x8<S>,
) -> i32x8<S> {
    let (zero, unit) = (i32x8::splat(simd, 0), i32x8::splat(simd, 1));
    let distance = distance.max(zero).min(rise + unit);
    let wanted = ((distance << BITS) - start).max(zero);
    // The nearest whole number is the one wanted or the one below.
    let steps = simd.cvt_f32_i32x8(wanted) / simd.cvt_f32_i32x8(slope);
    let steps = simd.cvt_i32_f32x8(steps + f32x8::splat(simd, 0.5));
    (steps * slope).simd_lt(wanted).select(steps + unit, steps)
}
