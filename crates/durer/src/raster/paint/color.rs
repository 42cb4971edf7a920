//! The two spaces in which colours are mixed: sRGB bytes, and linear light in 16 bits.

use std::sync::OnceLock;

use fearless_simd::prelude::*;
use fearless_simd::{u8x16, u8x32, u16x8, u16x16, u32x4, u32x8};

use crate::math::powf;

/// A premultiplied pixel in which source-over can be computed.
pub(crate) trait Space: Copy + Send + Sync + PartialEq + 'static {
    /// The transparent pixel.
    const CLEAR: Self;
    /// Creates a pixel from straight sRGB 0 … 1 and an opacity.
    fn from_srgb(color: [f32; 4], opacity: f32) -> Self;
    /// Returns the memory as pixels of this space, where they look alike; to be premultiplied.
    fn in_place(_rows: &mut [[u8; 4]]) -> Option<&mut [Self]> {
        None
    }
    /// Creates a pixel from straight 8-bit sRGB.
    fn load(color: [u8; 4]) -> Self;
    /// Returns the pixel in straight 8-bit sRGB.
    fn store(self) -> [u8; 4];
    /// Returns straight colour and opacity 0 … 1, mixed as this space mixes.
    fn to_unit(self) -> [f32; 4];
    /// Creates a pixel from straight colour and opacity 0 … 1 of this space.
    fn from_unit(color: [f32; 4]) -> Self;
    /// Premultiplies a pixel in place, as [`Space::load`] does.
    fn premultiplied(self) -> Self {
        self
    }
    /// Converts a pixel in place to straight alpha, as [`Space::store`] does.
    fn straight(self) -> Self {
        self
    }
    /// Returns whether nothing behind shines through.
    fn is_opaque(self) -> bool;
    /// Returns its opacity, 0 … 255.
    fn alpha(self) -> u8;
    /// Returns its luminance over black, 0 … 255 (ITU-R BT.709).
    fn luminance(self) -> u8;
    /// Returns whether that holds for all pixels.
    fn all_opaque(pixels: &[Self]) -> bool {
        pixels.iter().all(|p| p.is_opaque())
    }
    /// Returns the pixel scaled by a coverage 0 … 255.
    fn scaled(self, coverage: u8) -> Self;
    /// Returns `self` over `below`, after `self` has been scaled by the coverage.
    fn over(self, coverage: u8, below: Self) -> Self;
    /// Returns the sum of both, at most opaque white.
    fn plus(self, other: Self) -> Self;
    /// Paints one colour over eight pixels, each with its coverage 0 … 255.
    fn color_over<S: Simd>(simd: S, color: Self, coverage: u32x8<S>, below: &mut [Self; 8]);
    /// Paints one colour over four pixels, their coverage in the bytes of a number, the first in the lowest.
    #[inline(always)]
    fn color_over_four<S: Simd>(_: S, color: Self, coverage: u32, below: &mut [Self; 4]) {
        for (pixel, coverage) in below.iter_mut().zip(coverage.to_le_bytes()) {
            *pixel = color.over(coverage, *pixel);
        }
    }
    /// Paints colours over eight pixels, each with its coverage 0 … 255.
    fn colors_over<S: Simd>(simd: S, colors: &[Self; 8], coverage: u32x8<S>, below: &mut [Self; 8]);
}

/// Returns straight 8-bit sRGB with an opacity.
pub(crate) fn premultiply<P: Space>(color: [u8; 4], opacity: f32) -> P {
    P::from_srgb(color.map(|c| f32::from(c) / 255.0), opacity)
}

/// Returns `x / 255`, rounded, for x up to 255².
#[inline(always)]
fn div255(x: u32) -> u32 {
    (x + 128 + ((x + 128) >> 8)) >> 8
}

/// Returns the brightness of red, green and blue 0 … 255 (ITU-R BT.709), times 2¹⁶, with a half for rounding.
fn luminance([r, g, b]: [u32; 3]) -> u32 {
    r * 13_933 + g * 46_871 + b * 4_732 + (1 << 15)
}

/// Returns the straight colour 0 … 1 of a premultiplied one whose channels are at most `full`.
fn unit([r, g, b, alpha]: [f32; 4], full: f32) -> [f32; 4] {
    let straight = |c: f32| if alpha > 0.0 { (c / alpha).min(1.0) } else { 0.0 };
    [straight(r), straight(g), straight(b), alpha / full]
}

/// Returns the premultiplied channels, half a step up, of a straight colour 0 … 1.
fn scaled_unit([r, g, b, alpha]: [f32; 4], full: f32) -> [f32; 4] {
    let part = |c: f32| c * alpha * full + 0.5;
    [part(r), part(g), part(b), alpha * full + 0.5]
}

/// A pixel of sRGB bytes, premultiplied.
pub(crate) type Srgb = [u8; 4];

impl Space for Srgb {
    const CLEAR: Self = [0; 4];

    fn in_place(rows: &mut [[u8; 4]]) -> Option<&mut [Self]> {
        Some(rows)
    }

    fn from_srgb(color: [f32; 4], opacity: f32) -> Self {
        let alpha = color[3] * opacity;
        let byte = |v: f32| (v * 255.0 + 0.5) as u8;
        [byte(color[0] * alpha), byte(color[1] * alpha), byte(color[2] * alpha), byte(alpha)]
    }

    #[inline(always)]
    fn load(color: [u8; 4]) -> Self {
        let alpha = u32::from(color[3]);
        if alpha == 255 {
            return color;
        }
        let part = |c: u8| div255(u32::from(c) * alpha) as u8;
        [part(color[0]), part(color[1]), part(color[2]), color[3]]
    }

    #[inline(always)]
    fn store(self) -> [u8; 4] {
        let alpha = u32::from(self[3]);
        if alpha == 255 || alpha == 0 {
            return self;
        }
        let whole = |c: u8| ((u32::from(c) * 255 + alpha / 2) / alpha).min(255) as u8;
        [whole(self[0]), whole(self[1]), whole(self[2]), self[3]]
    }

    fn to_unit(self) -> [f32; 4] {
        unit(self.map(f32::from), 255.0)
    }

    fn from_unit(color: [f32; 4]) -> Self {
        scaled_unit(color, 255.0).map(|c| c as u8)
    }

    #[inline(always)]
    fn premultiplied(self) -> Self {
        Self::load(self)
    }

    #[inline(always)]
    fn straight(self) -> Self {
        self.store()
    }

    #[inline(always)]
    fn is_opaque(self) -> bool {
        self[3] == 255
    }

    fn alpha(self) -> u8 {
        self[3]
    }

    fn luminance(self) -> u8 {
        (luminance([self[0], self[1], self[2]].map(u32::from)) >> 16) as u8
    }

    fn all_opaque(pixels: &[Self]) -> bool {
        pixels.iter().fold(u32::MAX, |all, p| all & u32::from_le_bytes(*p)) >> 24 == 255
    }

    #[inline(always)]
    fn scaled(self, coverage: u8) -> Self {
        self.map(|c| div255(u32::from(c) * u32::from(coverage)) as u8)
    }

    #[inline(always)]
    fn over(self, coverage: u8, below: Self) -> Self {
        let coverage = u32::from(coverage);
        let through = 255 - div255(u32::from(self[3]) * coverage);
        std::array::from_fn(|i| {
            div255(u32::from(self[i]) * coverage + u32::from(below[i]) * through).min(255) as u8
        })
    }

    fn plus(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i].saturating_add(other[i]))
    }

    #[inline(always)]
    fn color_over<S: Simd>(simd: S, color: Self, coverage: u32x8<S>, below: &mut [Self; 8]) {
        let source: u16x16<S> = u32x8::splat(simd, u32::from_le_bytes(color)).bitcast();
        let coverage = twice(coverage);
        let full = u16x16::splat(simd, 255);
        let through = if color.is_opaque() {
            full - coverage
        } else {
            full - div255_lanes(simd, u16x16::splat(simd, u16::from(color[3])) * coverage)
        };
        over_eight(simd, source, coverage, through, below);
    }

    #[inline(always)]
    fn color_over_four<S: Simd>(simd: S, color: Self, coverage: u32, below: &mut [Self; 4]) {
        let pixels = below.as_flattened_mut();
        let source: u16x8<S> = u32x4::splat(simd, u32::from_le_bytes(color)).bitcast();
        // Each coverage in both halves of its pixel.
        let both: u8x16<S> = u32x4::splat(simd, coverage).bitcast();
        let both = both.zip_low(u8x16::splat(simd, 0));
        let both: u16x8<S> = both.bitcast();
        let coverage = both.zip_low(both);
        let full = u16x8::splat(simd, 255);
        let through = if color.is_opaque() {
            full - coverage
        } else {
            full - div255_half(simd, u16x8::splat(simd, u16::from(color[3])) * coverage)
        };
        let below: u8x16<S> = u8x16::from_slice(simd, pixels);
        let below: u16x8<S> = below.bitcast();
        let (even, half) = (u16x8::splat(simd, 255), u16x8::splat(simd, 128));
        let d0 = (source & even) * coverage + (below & even) * through + half;
        let d1 = (source >> 8) * coverage + (below >> 8) * through + half;
        let (d0, d1) = ((d0 + (d0 >> 8)) >> 8, d1 + (d1 >> 8));
        let over: u8x16<S> = (d0 | (d1 & !even)).bitcast();
        over.store_slice(pixels);
    }

    #[inline(always)]
    fn colors_over<S: Simd>(
        simd: S,
        colors: &[Self; 8],
        coverage: u32x8<S>,
        below: &mut [Self; 8],
    ) {
        let source: u8x32<S> = u8x32::from_slice(simd, colors.as_flattened());
        let words: u32x8<S> = source.bitcast();
        let coverage = twice(coverage);
        let alpha = twice(words >> 24);
        let through = u16x16::splat(simd, 255) - div255_lanes(simd, alpha * coverage);
        over_eight(simd, source.bitcast(), coverage, through, below);
    }
}

/// Copies numbers below 2¹⁶ into both halves of their pixels.
#[inline(always)]
fn twice<S: Simd>(v: u32x8<S>) -> u16x16<S> {
    (v | (v << 16)).bitcast()
}

/// Composes eight pixels by source-over: (source · coverage + below · through) / 255, where `through`, the part that
/// shines through, is 255 − alpha · coverage / 255. The source is no brighter than opaque, so nothing exceeds 255.
///
/// Bytes are taken apart by their places in pairs, for which nothing has to be moved across.
#[inline(always)]
fn over_eight<S: Simd>(
    simd: S,
    source: u16x16<S>,
    coverage: u16x16<S>,
    through: u16x16<S>,
    pixels: &mut [Srgb; 8],
) {
    let pixels = pixels.as_flattened_mut();
    let below: u8x32<S> = u8x32::from_slice(simd, pixels);
    let below: u16x16<S> = below.bitcast();
    let (even, half) = (u16x16::splat(simd, 255), u16x16::splat(simd, 128));
    let d0 = (source & even) * coverage + (below & even) * through + half;
    let d1 = (source >> 8) * coverage + (below >> 8) * through + half;
    let (d0, d1) = ((d0 + (d0 >> 8)) >> 8, d1 + (d1 >> 8));
    let over: u8x32<S> = (d0 | (d1 & !even)).bitcast();
    over.store_slice(pixels);
}

#[inline(always)]
fn div255_lanes<S: Simd>(simd: S, x: u16x16<S>) -> u16x16<S> {
    let x = x + u16x16::splat(simd, 128);
    (x + (x >> 8)) >> 8
}

/// Divides as [`div255_lanes`] does, for half as many numbers.
#[inline(always)]
fn div255_half<S: Simd>(simd: S, x: u16x8<S>) -> u16x8<S> {
    let x = x + u16x8::splat(simd, 128);
    (x + (x >> 8)) >> 8
}

/// A pixel of linear light in 16 bits, premultiplied; a separate type, because it is not sRGB.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Linear([u16; 4]);

impl Linear {
    fn map(self, f: impl Fn(u32) -> u32) -> Self {
        Self(self.0.map(|c| f(u32::from(c)).min(65_535) as u16))
    }
}

/// Returns linear 0 … 1 of an sRGB value 0 … 1 (IEC 61966-2-1).
fn linear_from_srgb(v: f32) -> f32 {
    if v <= 0.040_45 { v / 12.92 } else { powf((v + 0.055) / 1.055, 2.4) }
}

/// Returns linear 16-bit values of the 256 sRGB bytes.
fn linear_table() -> &'static [u16; 256] {
    static TABLE: OnceLock<[u16; 256]> = OnceLock::new();
    TABLE.get_or_init(|| {
        std::array::from_fn(|i| (linear_from_srgb(i as f32 / 255.0) * 65_535.0 + 0.5) as u16)
    })
}

/// Returns the sRGB byte nearest to a linear 16-bit value.
fn srgb_from_linear(v: u16) -> u8 {
    let table = linear_table();
    let above = table.partition_point(|t| *t < v).min(255);
    let below = above.saturating_sub(1);
    if table[above] - v.min(table[above]) <= v - table[below].min(v) {
        above as u8
    } else {
        below as u8
    }
}

impl Space for Linear {
    const CLEAR: Self = Self([0; 4]);

    fn from_srgb(color: [f32; 4], opacity: f32) -> Self {
        let alpha = color[3] * opacity;
        let part = |v: f32| (linear_from_srgb(v) * alpha * 65_535.0 + 0.5) as u16;
        Self([part(color[0]), part(color[1]), part(color[2]), (alpha * 65_535.0 + 0.5) as u16])
    }

    fn load(color: [u8; 4]) -> Self {
        let (table, alpha) = (linear_table(), u32::from(color[3]) * 257);
        let part = |c: u8| (u32::from(table[usize::from(c)]) * alpha / 65_535) as u16;
        Self([part(color[0]), part(color[1]), part(color[2]), alpha as u16])
    }

    fn store(self) -> [u8; 4] {
        let alpha = u32::from(self.0[3]);
        if alpha == 0 {
            return [0; 4];
        }
        let whole = |c: u16| {
            srgb_from_linear(((u32::from(c) * 65_535 + alpha / 2) / alpha).min(65_535) as u16)
        };
        let [r, g, b, _] = self.0;
        [whole(r), whole(g), whole(b), ((alpha + 128) / 257) as u8]
    }

    fn to_unit(self) -> [f32; 4] {
        unit(self.0.map(f32::from), 65_535.0)
    }

    fn from_unit(color: [f32; 4]) -> Self {
        Self(scaled_unit(color, 65_535.0).map(|c| c as u16))
    }

    fn is_opaque(self) -> bool {
        self.0[3] == 65_535
    }

    fn alpha(self) -> u8 {
        ((u32::from(self.0[3]) + 128) / 257) as u8
    }

    fn luminance(self) -> u8 {
        let [r, g, b, _] = self.0.map(|c| (u32::from(c) + 128) / 257);
        (luminance([r, g, b]) >> 16) as u8
    }

    fn scaled(self, coverage: u8) -> Self {
        self.map(|c| (c * u32::from(coverage) + 127) / 255)
    }

    fn over(self, coverage: u8, below: Self) -> Self {
        let source = self.scaled(coverage);
        let through = 65_535 - u32::from(source.0[3]);
        Self(std::array::from_fn(|i| {
            let behind = (u32::from(below.0[i]) * through + 32_767) / 65_535;
            (u32::from(source.0[i]) + behind).min(65_535) as u16
        }))
    }

    fn plus(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].saturating_add(other.0[i])))
    }

    #[inline(always)]
    fn color_over<S: Simd>(simd: S, color: Self, coverage: u32x8<S>, below: &mut [Self; 8]) {
        Self::colors_over(simd, &[color; 8], coverage, below);
    }

    #[inline(always)]
    fn colors_over<S: Simd>(_: S, colors: &[Self; 8], coverage: u32x8<S>, below: &mut [Self; 8]) {
        let mut masks = [0; 8];
        coverage.store_slice(&mut masks);
        for ((color, mask), pixel) in colors.iter().zip(masks).zip(below) {
            *pixel = color.over(mask as u8, *pixel);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_survive_the_way_through_linear_light() {
        for v in 0..=255 {
            assert_eq!(Linear::load([v, 255 - v, 7, 255]).store(), [v, 255 - v, 7, 255]);
        }
    }

    #[test]
    fn opaque_bytes_are_untouched_and_thin_ones_nearly() {
        for alpha in 1..=255_u8 {
            let color = [200, 100, 0, alpha];
            let back = Srgb::load(color).store();
            let slack = 255 / u32::from(alpha) / 2 + 1;
            assert!(back.iter().zip(color).all(|(a, b)| u32::from(a.abs_diff(b)) <= slack));
        }
    }
}
