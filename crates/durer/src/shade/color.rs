//! Colours: sRGB's transfer curve in both directions by table, luminance, premultiplication.
//!
//! The tables are made when the crate is compiled, from IEEE basic operations alone, so they are the
//! same bits on every machine. Curve: IEC 61966-2-1 (1999).

use crate::math::{Vec3, Vec4};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16, u64x8};

/// Linear value of each 8-bit sRGB code, correctly rounded from double precision.
pub static LINEAR_FROM_SRGB: [f32; 256] = linear_table();

/// Binary exponent below which everything rounds to code 0: the first threshold is 2^-12.7.
const LOWEST_EXPONENT: u32 = 127 - 13;
/// Mantissa bits that choose a bucket; with 7 no bucket holds two thresholds (tested).
const BUCKET_BITS: u32 = 7;
/// Buckets from 2^-13 up to 1.
const BUCKETS: usize = 13 << BUCKET_BITS;
/// Bits of an f32 below the bucket number.
const BUCKET_SHIFT: u32 = 23 - BUCKET_BITS;
/// The first bucket's number in the bits of an f32.
const FIRST_BUCKET: u32 = LOWEST_EXPONENT << BUCKET_BITS;

/// Table of buckets. The upper half of an entry is the code at the bucket's lower end. The lower half, added to a
/// value's bits below the bucket number, carries into the code if the value reaches the next threshold. Entries use the
/// upper half of a word, because [`encode_opaque_x16`] packs two into one. The length is a power of two, so that no
/// index is out of range.
static BUCKET_STEP: [u64; 1 << INDEX_BITS] = step_table();

/// Bits of a bucket's number.
const INDEX_BITS: u32 = 11;

/// Values are held to those from the first bucket's lower end to the largest number below 1.
const HELD: [f32; 2] = [f32::from_bits(FIRST_BUCKET << BUCKET_SHIFT), 1.0 - f32::EPSILON / 2.0];

const fn step_table() -> [u64; 1 << INDEX_BITS] {
    let (threshold, code) = (threshold_table(), bucket_table());
    let mut table = [255 << (32 + BUCKET_SHIFT); 1 << INDEX_BITS];
    let mut bucket = 0;
    while bucket < BUCKETS {
        let next = threshold[code[bucket] as usize].to_bits();
        let within = next >> BUCKET_SHIFT == bucket as u32 + FIRST_BUCKET;
        let carry =
            if within { (1 << BUCKET_SHIFT) - (next & ((1 << BUCKET_SHIFT) - 1)) } else { 0 };
        table[bucket] = (((code[bucket] as u64) << BUCKET_SHIFT) + carry as u64) << 32;
        bucket += 1;
    }
    table
}

/// Returns the fifth root of x in 0…1 by Newton's iteration from above.
const fn fifth_root(x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    let mut y: f64 = 1.0;
    let mut i = 0;
    while i < 60 {
        let y4 = y * y * y * y;
        y = (4.0 * y + x / y4) / 5.0;
        i += 1;
    }
    y
}

/// Converts sRGB 0…1 to linear 0…1: x^2.4 = x² · (x²)^(1/5).
const fn linear_from_srgb(s: f64) -> f64 {
    if s <= 0.04045 {
        return s / 12.92;
    }
    let x = (s + 0.055) / 1.055;
    x * x * fifth_root(x * x)
}

const fn linear_table() -> [f32; 256] {
    let mut table = [0.0; 256];
    let mut code = 0;
    while code < 256 {
        table[code] = linear_from_srgb(code as f64 / 255.0) as f32;
        code += 1;
    }
    table
}

/// Returns the linear value half a code step above each code but the last: where rounding changes.
const fn threshold_table() -> [f32; 256] {
    let mut table = [f32::INFINITY; 256];
    let mut code = 0;
    while code < 255 {
        table[code] = linear_from_srgb((code as f64 + 0.5) / 255.0) as f32;
        code += 1;
    }
    table
}

/// Returns the code of each bucket's lower end.
const fn bucket_table() -> [u8; BUCKETS] {
    let threshold = threshold_table();
    let mut table = [0; BUCKETS];
    let (mut bucket, mut code) = (0, 0);
    while bucket < BUCKETS {
        let lower = f32::from_bits((bucket as u32 + FIRST_BUCKET) << BUCKET_SHIFT);
        while threshold[code] <= lower {
            code += 1;
        }
        table[bucket] = code as u8;
        bucket += 1;
    }
    table
}

/// Returns the linear value of an 8-bit sRGB code.
#[inline(always)]
pub fn decode_srgb8(code: u8) -> f32 {
    LINEAR_FROM_SRGB[usize::from(code)]
}

/// Returns the 8-bit sRGB code nearest to a linear value, halves upwards; NaN and all below 0 give
/// 0, all above 1 give 255.
///
/// Monotone, never more than half a step off, and the inverse of [`decode_srgb8`] on all 256 codes.
/// Cost: one look-up.
#[inline(always)]
pub fn encode_srgb8(linear: f32) -> u8 {
    let [least, most] = HELD;
    // NaN is not above the least.
    let linear = if linear > least { linear } else { least };
    let bits = if linear < most { linear } else { most }.to_bits();
    let bucket = (bits >> BUCKET_SHIFT) - FIRST_BUCKET;
    let step = (BUCKET_STEP[bucket as usize % BUCKET_STEP.len()] >> 32) as u32;
    ((step + (bits & ((1 << BUCKET_SHIFT) - 1))) >> BUCKET_SHIFT) as u8
}

/// Converts sixteen opaque linear colours, by channel, to 8-bit sRGB, each channel as [`encode_srgb8`] does: of each
/// pixel the four bytes, the first one lowest.
///
/// Cost: one look-up per channel.
#[inline(always)]
pub(crate) fn encode_opaque_x16<S: Simd>(simd: S, colors: [f32x16<S>; 3]) -> u32x16<S> {
    let [r, g, b] = colors;
    let ([r, below_r], [g, below_g]) = (buckets_x16(simd, r), buckets_x16(simd, g));
    let [b, below_b] = buckets_x16(simd, b);
    // Two buckets share a word, which halves the reads and writes; each is replaced by its step.
    let mut steps: [[u64; 8]; 3] = [
        r.bitcast::<u64x8<S>>().into(),
        g.bitcast::<u64x8<S>>().into(),
        b.bitcast::<u64x8<S>>().into(),
    ];
    for two in steps.as_flattened_mut() {
        let first = *two as u32 >> (32 - INDEX_BITS);
        let second = *two >> (64 - INDEX_BITS);
        *two = BUCKET_STEP[first as usize] >> 32 | BUCKET_STEP[second as usize];
    }
    let r = u64x8::from_slice(simd, &steps[0]).bitcast::<u32x16<S>>() + below_r;
    let g = u64x8::from_slice(simd, &steps[1]).bitcast::<u32x16<S>>() + below_g;
    let b = u64x8::from_slice(simd, &steps[2]).bitcast::<u32x16<S>>() + below_b;
    let (r, g, b) = (r >> BUCKET_SHIFT, g >> BUCKET_SHIFT, b >> BUCKET_SHIFT);
    r | (g << 8u32) | (b << 16u32) | (255 << 24)
}

/// Returns the buckets of linear values, each in the highest bits, and the values' remaining lower bits.
#[inline(always)]
fn buckets_x16<S: Simd>(simd: S, linear: f32x16<S>) -> [u32x16<S>; 2] {
    // NaN is not above the least.
    let (least, most) = (f32x16::splat(simd, HELD[0]), f32x16::splat(simd, HELD[1]));
    let linear = linear.simd_gt(least).select(linear, least);
    let linear = linear.simd_lt(most).select(linear, most);
    let bits: u32x16<S> = linear.bitcast();
    let bucket = (bits - (FIRST_BUCKET << BUCKET_SHIFT)) << (32 - INDEX_BITS - BUCKET_SHIFT);
    [bucket, bits & ((1 << BUCKET_SHIFT) - 1)]
}

/// Encodes linear RGBA as 8-bit sRGB with 8-bit linear alpha.
#[inline(always)]
pub fn encode_rgba8(color: Vec4) -> [u8; 4] {
    [encode_srgb8(color.x), encode_srgb8(color.y), encode_srgb8(color.z), encode_unorm8(color.w)]
}

/// Encodes linear RGBA, premultiplied, as 8-bit sRGB with straight 8-bit alpha.
#[inline(always)]
pub(crate) fn encode_premultiplied(color: Vec4) -> [u8; 4] {
    encode_rgba8(if color.w >= 1.0 { color } else { unpremultiply(color) })
}

/// Converts sixteen linear, premultiplied colours, by channel, as [`encode_premultiplied`] does; of each code the first
/// byte is the lowest.
#[inline(always)]
pub(crate) fn encode_premultiplied_x16<S: Simd>(simd: S, colors: &[[f32; 16]; 4]) -> [u32; 16] {
    let [r, g, b, alpha] = colors;
    let (red, green) = (f32x16::from_slice(simd, r), f32x16::from_slice(simd, g));
    let opaque = encode_opaque_x16(simd, [red, green, f32x16::from_slice(simd, b)]);
    let is_opaque = f32x16::from_slice(simd, alpha).simd_ge(f32x16::splat(simd, 1.0));
    let (mut codes, mut left): ([u32; 16], _) = (opaque.into(), (!is_opaque).to_bitmask());
    // Neighbours are often alike: the background, if one colour fills it.
    let (mut last, mut code) = (Vec4::NAN, 0);
    while left != 0 {
        let lane = left.trailing_zeros() as usize % 16;
        left &= left - 1;
        let color = Vec4::new(r[lane], g[lane], b[lane], alpha[lane]);
        if color != last {
            (last, code) = (color, u32::from_le_bytes(encode_premultiplied(color)));
        }
        codes[lane] = code;
    }
    codes
}

/// Converts 8-bit sRGB with 8-bit alpha to linear RGBA.
#[inline(always)]
pub fn decode_rgba8(code: [u8; 4]) -> Vec4 {
    Vec4::new(
        decode_srgb8(code[0]),
        decode_srgb8(code[1]),
        decode_srgb8(code[2]),
        decode_unorm8(code[3]),
    )
}

/// Returns the nearest of 256 equal steps over 0…1; NaN gives 0.
#[inline(always)]
pub fn encode_unorm8(value: f32) -> u8 {
    // `as` saturates and takes NaN to 0.
    (value * 255.0 + 0.5) as u8
}

/// The value of each of 256 equal steps over 0…1.
static UNORM: [f32; 256] = unorm_table();

const fn unorm_table() -> [f32; 256] {
    let mut table = [0.0; 256];
    let mut code = 0;
    while code < 256 {
        table[code] = code as f32 * (1.0 / 255.0);
        code += 1;
    }
    table
}

/// Returns the value of one of 256 equal steps over 0…1.
#[inline(always)]
pub fn decode_unorm8(code: u8) -> f32 {
    UNORM[usize::from(code)]
}

/// Returns the relative luminance of a linear colour with sRGB's primaries (ITU-R BT.709).
#[inline(always)]
pub fn luminance(color: Vec3) -> f32 {
    0.2126 * color.x + 0.7152 * color.y + 0.0722 * color.z
}

/// Returns straight alpha to premultiplied alpha (Porter and Duff 1984).
#[inline(always)]
pub fn premultiply(color: Vec4) -> Vec4 {
    Vec4::new(color.x * color.w, color.y * color.w, color.z * color.w, color.w)
}

/// Converts premultiplied alpha to straight alpha; where alpha is not above 0, to transparent black.
#[inline(always)]
pub fn unpremultiply(color: Vec4) -> Vec4 {
    if color.w > 0.0 {
        Vec4::new(color.x / color.w, color.y / color.w, color.z / color.w, color.w)
    } else {
        Vec4::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact_linear(s: f64) -> f64 {
        if s <= 0.04045 { s / 12.92 } else { libm::pow((s + 0.055) / 1.055, 2.4) }
    }

    fn exact_srgb(l: f64) -> f64 {
        if l <= 0.003_130_8 { l * 12.92 } else { 1.055 * libm::pow(l, 1.0 / 2.4) - 0.055 }
    }

    #[test]
    fn decoding_is_the_published_curve() {
        for code in 0..=255_u8 {
            let exact = exact_linear(f64::from(code) / 255.0);
            let error = (f64::from(decode_srgb8(code)) - exact).abs();
            assert!(error <= exact * 6e-8, "{code}: {error}");
        }
    }

    #[test]
    fn all_codes_come_back() {
        for code in 0..=255_u8 {
            assert_eq!(encode_srgb8(decode_srgb8(code)), code);
            assert_eq!(encode_unorm8(decode_unorm8(code)), code);
        }
    }

    #[test]
    fn encoding_is_never_more_than_half_a_step_off_and_monotone() {
        let mut last = 0;
        // Every 61st float from 2^-20 to 1: over two million of them.
        for bits in (0x3580_0000..=0x3f80_0000_u32).step_by(61) {
            let x = f32::from_bits(bits);
            let code = encode_srgb8(x);
            assert!(code >= last, "{x}");
            last = code;
            let off = (exact_srgb(f64::from(x)) * 255.0 - f64::from(code)).abs();
            // The standard's two parts differ by 1e-8 at their joint.
            assert!(off <= 0.5 + 1e-4, "{x}: {off}");
        }
        assert_eq!(last, 255);
    }

    #[test]
    fn rounding_changes_exactly_at_the_thresholds() {
        let thresholds = threshold_table();
        for code in 0..255_u8 {
            let t = thresholds[usize::from(code)];
            assert_eq!(encode_srgb8(t), code + 1);
            assert_eq!(encode_srgb8(f32::from_bits(t.to_bits() - 1)), code);
        }
    }

    #[test]
    fn sixteen_at_a_time_have_the_codes_of_one() {
        let strange = [f32::NAN, f32::NEG_INFINITY, f32::INFINITY, -1.0, 0.0, 1e-40, 1.0, 7.0];
        let around = |t: f32| [t, f32::from_bits(t.to_bits() - 1), f32::from_bits(t.to_bits() + 1)];
        let mut values: Vec<f32> =
            threshold_table()[..255].iter().flat_map(|t| around(*t)).collect();
        values.extend(strange);
        values.extend((0..=1000).map(|i| i as f32 * 1e-3));
        for level in crate::simd::levels() {
            for &r in values.as_chunks::<16>().0 {
                let g = r.map(|v| v * 0.5);
                let codes: [u32; 16] = crate::simd::dispatch!(level, simd => {
                    let half = f32x16::splat(simd, 0.5);
                    let (r, g) = (f32x16::from_slice(simd, &r), f32x16::from_slice(simd, &g));
                    encode_opaque_x16(simd, [r, g, half]).into()
                });
                let codes = codes.map(u32::to_le_bytes);
                let half = encode_srgb8(0.5);
                let one = |i: usize| [encode_srgb8(r[i]), encode_srgb8(g[i]), half, 255];
                assert_eq!(codes, std::array::from_fn(one), "{r:?}");
            }
        }
    }

    #[test]
    fn strange_numbers_have_a_code() {
        for (x, code) in [
            (f32::NAN, 0),
            (-f32::NAN, 0),
            (-1.0, 0),
            (-0.0, 0),
            (0.0, 0),
            (1e-40, 0),
            (f32::NEG_INFINITY, 0),
            (f32::INFINITY, 255),
            (1.0, 255),
            (7.0, 255),
        ] {
            assert_eq!(encode_srgb8(x), code, "{x}");
        }
        assert_eq!([f32::NAN, -1.0, 0.5, 2.0].map(encode_unorm8), [0, 0, 128, 255]);
    }

    #[test]
    fn premultiplication_turns_back() {
        let c = Vec4::new(0.25, 0.5, 1.0, 0.5);
        assert_eq!(unpremultiply(premultiply(c)), c);
        assert_eq!(unpremultiply(Vec4::ZERO), Vec4::ZERO);
        assert_eq!(luminance(Vec3::ONE), 1.0);
    }
}
