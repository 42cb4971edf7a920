//! Ordered dithering: fewer levels than colours, at the price of a fine pattern.
//!
//! B. E. Bayer, *An Optimum Method for Two-Level Rendition of Continuous-Tone Pictures*, IEEE
//! International Conference on Communications, 1973. Levels are chosen so that the mean over 8 × 8
//! pixels is right in linear light. Cost: O(1) per channel. Limits: the pattern repeats every 8 pixels.

use crate::fragment::color_index::whole_index;
use crate::math::Vec4;
use crate::shade::color::{LINEAR_FROM_SRGB, encode_srgb8, encode_unorm8};

/// Bayer's matrix of order 8: the thresholds 0…63.
pub const BAYER8: [[u8; 8]; 8] = bayer();

/// Returns each doubling puts 4 M, 4 M + 2, 4 M + 3, 4 M + 1 into the quarters: bits of x ^ y and
/// y, woven.
const fn bayer() -> [[u8; 8]; 8] {
    let mut m = [[0; 8]; 8];
    let mut i = 0;
    while i < 64 {
        let (x, y) = (i % 8, i / 8);
        let (a, b) = (x ^ y, y);
        let mut value = 0;
        let mut bit = 0;
        while bit < 3 {
            value |= ((a >> bit & 1) << (5 - 2 * bit)) | ((b >> bit & 1) << (4 - 2 * bit));
            bit += 1;
        }
        m[y][x] = value as u8;
        i += 1;
    }
    m
}

/// Returns the threshold of a pixel for a value between two levels, 1/128 … 127/128.
fn threshold(x: u32, y: u32) -> f32 {
    (f32::from(BAYER8[y as usize % 8][x as usize % 8]) + 0.5) / 64.0
}

/// Dithering to some number of levels per channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Dither {
    /// Equal steps of the sRGB code per channel, 2…256; held to that. Colour indices have their own.
    pub levels: u16,
}

impl Default for Dither {
    /// Returns all 256 levels: only hides the steps of 8-bit colour.
    fn default() -> Self {
        Self { levels: 256 }
    }
}

impl Dither {
    /// Returns the 8-bit sRGB colour of a pixel at column x, row y; alpha is rounded, not dithered.
    pub fn apply(&self, color: Vec4, x: u32, y: u32) -> [u8; 4] {
        let threshold = threshold(x, y);
        let channel = |v: f32| self.channel(v, threshold);
        [channel(color.x), channel(color.y), channel(color.z), encode_unorm8(color.w)]
    }

    /// Returns a colour index with a fraction: the whole number above or below it, which is higher
    /// where the fraction is above the threshold (OpenGL 2.1, 4.1.9). Of the result the lowest eight
    /// bits count.
    pub fn index(&self, index: f32, x: u32, y: u32) -> u8 {
        let low = index.floor();
        let fraction = index - low;
        whole_index(low + if fraction > threshold(x, y) { 1.0 } else { 0.0 })
    }

    /// Returns the higher of the two levels around a value where its place between them is above the
    /// threshold.
    fn channel(&self, value: f32, threshold: f32) -> u8 {
        let steps = u32::from(self.levels.clamp(2, 256)) - 1;
        let code = |step: u32| ((step * 255 + steps / 2) / steps) as u8;
        let light = |step: u32| LINEAR_FROM_SRGB[usize::from(code(step))];
        // Rounding puts the nearest level at most one step too high or low.
        let near = (u32::from(encode_srgb8(value)) * steps + 127) / 255;
        let low = if light(near) > value { near.saturating_sub(1) } else { near };
        if low >= steps {
            return code(steps);
        }
        let place = (value - light(low)) / (light(low + 1) - light(low));
        code(low + u32::from(place > threshold))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_matrix_is_bayers() {
        assert_eq!(BAYER8[0], [0, 32, 8, 40, 2, 34, 10, 42]);
        assert_eq!(BAYER8[1], [48, 16, 56, 24, 50, 18, 58, 26]);
        assert_eq!(BAYER8[7], [63, 31, 55, 23, 61, 29, 53, 21]);
        let mut seen: Vec<u8> = BAYER8.concat();
        seen.sort_unstable();
        assert!(seen.into_iter().eq(0..64));
    }

    #[test]
    fn the_mean_over_a_cell_is_the_colour() {
        for levels in [2, 3, 5, 16, 17, 100, 256] {
            let dither = Dither { levels };
            for i in 0..=200 {
                let v = i as f32 / 200.0;
                let mut used = std::collections::BTreeSet::new();
                let mut sum = 0.0;
                for (x, y) in (0..8).flat_map(|y| (0..8).map(move |x| (x, y))) {
                    let code = dither.apply(Vec4::splat(v), x, y)[0];
                    used.insert(code);
                    sum += LINEAR_FROM_SRGB[usize::from(code)];
                }
                let (low, high) = (used.first().copied(), used.last().copied());
                let gap = |c: Option<u8>| LINEAR_FROM_SRGB[usize::from(c.unwrap_or(0))];
                assert!(used.len() <= 2, "{levels} {v}: {used:?}");
                // If only one level is used, the next level above bounds the gap.
                let step = (gap(high) - gap(low)).max(2.5 / f32::from(levels - 1));
                assert!((sum / 64.0 - v).abs() <= step / 64.0 + 1e-5, "{levels} {v}");
            }
        }
    }

    #[test]
    fn levels_themselves_and_strange_values_stay() {
        for code in 0..=255_u8 {
            let v = Vec4::splat(LINEAR_FROM_SRGB[usize::from(code)]);
            assert_eq!(Dither::default().apply(v, u32::from(code), 3)[0], code);
        }
        for levels in [0, 2, 256, 9999] {
            let at = |v: f32| Dither { levels }.apply(Vec4::splat(v), 5, 2)[0];
            let strange = [f32::NAN, -1.0, 0.0, 1.0, 9.0, f32::INFINITY].map(at);
            assert_eq!(strange, [0, 0, 0, 255, 255, 255]);
        }
    }
}
