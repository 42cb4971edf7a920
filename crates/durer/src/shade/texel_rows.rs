//! Texels around points of which eight at a time lie between the same two rows of an image, as where it stands upright
//! before the viewer: they are kept by row and channel, so that those of eight points are taken from a row in one go.

use super::lookup::mean;
use crate::math::Vec4;
use crate::simd::lanes;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, f32x16, i32x8, i32x16, u8x32, u8x64};

/// Rows at most.
const MOST_ROWS: usize = 128;

/// Texels of a row at most: eight, and the one after the last.
const MOST_COLUMNS: usize = 9;

/// Texels by row and channel.
pub struct TexelRows {
    /// One more than there may be, so that each has one below it.
    rows: [[[f32; 16]; 4]; MOST_ROWS + 1],
}

/// Of sixteen points side by side the bytes of the number that each takes: of a register of sixteen, or eight from each of two
/// registers of eight.
#[derive(Clone, Copy)]
enum Places<S: Simd> {
    Sixteen(u8x64<S>),
    Eights([u8x32<S>; 2]),
}

impl<S: Simd> Places<S> {
    /// Of points that take the numbers of these places, the first eight from one row, the others from another.
    #[inline(always)]
    fn new(simd: S, numbers: i32x16<S>) -> Self {
        // All bytes of a number's own place times four, and which of its bytes each is.
        let numbers = numbers & 7;
        let bytes =
            (numbers << 2u32) | (numbers << 10u32) | (numbers << 18u32) | (numbers << 26u32);
        let bytes = bytes | i32x16::splat(simd, 0x0302_0100);
        if lanes::<S>() >= 16 {
            let (none, eight) = (i32x8::splat(simd, 0), i32x8::splat(simd, 0x2020_2020));
            Self::Sixteen((bytes | simd.combine_i32x8(none, eight)).bitcast())
        } else {
            let (above, below) = simd.split_i32x16(bytes);
            Self::Eights([above.bitcast(), below.bitcast()])
        }
    }

    /// What the points take from a row each.
    #[inline(always)]
    fn take(&self, simd: S, [above, below]: [&[f32]; 2]) -> f32x16<S> {
        let (above, below) = (f32x8::from_slice(simd, above), f32x8::from_slice(simd, below));
        match self {
            Self::Sixteen(places) => {
                simd.swizzle_dyn_f32x16(simd.combine_f32x8(above, below), *places)
            }
            Self::Eights([first, last]) => simd.combine_f32x8(
                simd.swizzle_dyn_f32x8(above, *first),
                simd.swizzle_dyn_f32x8(below, *last),
            ),
        }
    }
}

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
        let places = Places::new(simd, x);
        let rows = [y[0] as usize % MOST_ROWS, y[1] as usize % MOST_ROWS];
        // Not in a loop, in which they would be stored and read again.
        [
            self.mean_of_channel(simd, 0, (&places, rows), weights),
            self.mean_of_channel(simd, 1, (&places, rows), weights),
            self.mean_of_channel(simd, 2, (&places, rows), weights),
            if with_alpha {
                self.mean_of_channel(simd, 3, (&places, rows), weights)
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
        at: (&Places<S>, [usize; 2]),
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
        (places, [above, below]): (&Places<S>, [usize; 2]),
        [right, down]: [usize; 2],
    ) -> f32x16<S> {
        let above = &self.rows[above + down][channel][right..right + 8];
        places.take(simd, [above, &self.rows[below + down][channel][right..right + 8]])
    }
}
