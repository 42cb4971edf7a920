//! Texels around points of which eight at a time lie between the same two rows of an image, as where it stands upright
//! before the viewer: they are kept by row and channel, so that those of eight points are taken from a row in one go.

use super::lookup::mean;
use crate::math::Vec4;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, f32x16, i32x8, i32x16, u8x32};

/// Rows at most.
const MOST_ROWS: usize = 128;

/// Texels of a row at most: eight, and the one after the last.
const MOST_COLUMNS: usize = 9;

/// Texels by row and channel.
pub struct TexelRows {
    /// One more than there may be, so that each has one below it.
    rows: [[[f32; 16]; 4]; MOST_ROWS + 1],
}

/// Of eight points side by side the bytes of the number that each takes from a register of eight.
type Places<S> = u8x32<S>;

impl Default for TexelRows {
    fn default() -> Self {
        Self { rows: [[[0.0; 16]; 4]; MOST_ROWS + 1] }
    }
}

impl TexelRows {
    /// Whether there is room for so many columns and rows.
    pub fn have_room([columns, rows]: [usize; 2]) -> bool {
        columns <= MOST_COLUMNS && rows <= MOST_ROWS
    }

    /// Puts a texel into its place.
    #[inline(always)]
    pub fn set(&mut self, [x, y]: [usize; 2], texel: Vec4) {
        for (channel, value) in self.rows[y % MOST_ROWS].iter_mut().zip(texel.to_array()) {
            channel[x % 16] = value;
        }
    }

    /// The bilinear means of four texels each at sixteen points, by channel. Of the first texels, `x` are the columns, and
    /// `y` are the rows of the first eight points and of the others; `weights` are those of the second ones. Where alpha
    /// has no say it is 1.
    #[inline(always)]
    pub fn means<S: Simd>(
        &self,
        simd: S,
        (x, y): (i32x16<S>, [i32; 2]),
        weights: [f32x16<S>; 2],
        with_alpha: bool,
    ) -> [f32x16<S>; 4] {
        let (above, below) = simd.split_i32x16(x);
        let places = [places(simd, above), places(simd, below)];
        let rows = [y[0] as usize % MOST_ROWS, y[1] as usize % MOST_ROWS];
        // Not in a loop, in which they would be stored and read again.
        [
            self.mean_of_channel(simd, 0, (places, rows), weights),
            self.mean_of_channel(simd, 1, (places, rows), weights),
            self.mean_of_channel(simd, 2, (places, rows), weights),
            if with_alpha {
                self.mean_of_channel(simd, 3, (places, rows), weights)
            } else {
                f32x16::splat(simd, 1.0)
            },
        ]
    }

    #[inline(always)]
    fn mean_of_channel<S: Simd>(
        &self,
        simd: S,
        channel: usize,
        at: ([Places<S>; 2], [usize; 2]),
        weights: [f32x16<S>; 2],
    ) -> f32x16<S> {
        let a = self.sixteen(simd, channel, at, [0, 0]);
        let b = self.sixteen(simd, channel, at, [1, 0]);
        let c = self.sixteen(simd, channel, at, [0, 1]);
        let d = self.sixteen(simd, channel, at, [1, 1]);
        mean([a, b, c, d], weights)
    }

    /// Of sixteen points a channel of the texels so far to the right of the first ones and below them.
    #[inline(always)]
    fn sixteen<S: Simd>(
        &self,
        simd: S,
        channel: usize,
        (places, rows): ([Places<S>; 2], [usize; 2]),
        [right, down]: [usize; 2],
    ) -> f32x16<S> {
        let above = &self.rows[rows[0] + down][channel][right..right + 8];
        let below = &self.rows[rows[1] + down][channel][right..right + 8];
        let above = simd.swizzle_dyn_f32x8(f32x8::from_slice(simd, above), places[0]);
        let below = simd.swizzle_dyn_f32x8(f32x8::from_slice(simd, below), places[1]);
        simd.combine_f32x8(above, below)
    }
}

#[inline(always)]
fn places<S: Simd>(simd: S, numbers: i32x8<S>) -> Places<S> {
    // All bytes of a number's own place times four, and which of its bytes each is.
    let numbers = numbers & 7;
    let bytes = (numbers << 2u32) | (numbers << 10u32) | (numbers << 18u32) | (numbers << 26u32);
    (bytes | i32x8::splat(simd, 0x0302_0100)).bitcast()
}
