//! Sixteen pixels that are lit together.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};

/// Patches whose neighbours differ at most as often are interpolated triangle by triangle, others pixel by
/// pixel.
const FEW_CHANGES: u32 = 9;

/// Sixteen pixels: eight in a row and the eight below them, or sixteen in a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Patch {
    /// The first pixel.
    pub at: [i32; 2],
    layout: &'static Layout,
}

#[derive(Debug, PartialEq)]
struct Layout {
    /// Offset of each pixel to the right of the first and below it.
    offsets: [[f32; 16]; 2],
    /// Binary logarithm of the pixels in a row.
    shift: usize,
    /// All but the last pixel of each row, as bits.
    beside: u64,
}

impl Eq for Layout {}

static BLOCK: Layout = Layout {
    offsets: [
        [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0],
    ],
    shift: 3,
    beside: 0x7f7f,
};

static ROW: Layout = Layout {
    offsets: [
        [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0],
        [0.0; 16],
    ],
    shift: 4,
    beside: 0x7fff,
};

impl Patch {
    /// Returns two rows of eight pixels.
    #[inline(always)]
    pub fn block(at: [i32; 2]) -> Self {
        Self { at, layout: &BLOCK }
    }

    /// Returns one row of sixteen pixels.
    #[inline(always)]
    pub fn row(at: [i32; 2]) -> Self {
        Self { at, layout: &ROW }
    }

    /// Returns the pixel of a lane, 0 … 15.
    #[inline(always)]
    pub fn pixel(self, lane: usize) -> [i32; 2] {
        let Layout { shift, .. } = self.layout;
        let column = lane & ((1 << shift) - 1);
        [self.at[0] + column as i32, self.at[1] + (lane >> shift) as i32]
    }

    /// Returns all pixels.
    #[inline(always)]
    pub fn pixels(self) -> [[i32; 2]; 16] {
        let mut pixels = [self.at; 16];
        for (lane, pixel) in pixels.iter_mut().enumerate() {
            *pixel = self.pixel(lane);
        }
        pixels
    }

    /// Returns the columns and rows of the pixels; `x` and `y` are those of the first one.
    #[inline(always)]
    pub fn places<S: Simd>(self, simd: S, [x, y]: [f32; 2]) -> [f32x16<S>; 2] {
        let [columns, rows] = &self.layout.offsets;
        [f32x16::from_slice(simd, columns) + x, f32x16::from_slice(simd, rows) + y]
    }

    /// Returns whether few triangles are shown.
    #[inline(always)]
    pub fn shows_few<S: Simd>(self, simd: S, shown: u32x16<S>) -> bool {
        let beside = simd.slide_u32x16::<1>(shown, shown);
        let changes = shown.simd_ne(beside).to_bitmask() & self.layout.beside;
        changes.count_ones() <= FEW_CHANGES
    }
}
