//! Vectors at points of several triangles side by side, so that they can be shaded together.

use crate::math::Vec3;
use crate::shade::lane::Vec3Lane;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4, f32x8, f32x16, f64x8, i32x8};

/// Vectors at up to sixteen points from anywhere; those not set are 0.
#[derive(Debug, Clone, Copy, Default)]
pub struct Gathered([[f32; 4]; 16]);

impl Gathered {
    /// Sets the vector of a point; the fourth number does not matter.
    #[inline(always)]
    pub fn set<S: Simd>(&mut self, lane: usize, vector: f32x4<S>) {
        vector.store_slice(&mut self.0[lane % 16]);
    }

    /// Sets the vector of a point from three numbers.
    #[inline(always)]
    pub fn set_vector(&mut self, lane: usize, v: Vec3) {
        self.0[lane % 16] = [v.x, v.y, v.z, 0.0];
    }

    /// Copies the vector of a point from another set.
    #[inline(always)]
    pub fn copy(&mut self, lane: usize, from: &Self) {
        self.0[lane % 16] = from.0[lane % 16];
    }

    /// Returns the vectors side by side.
    #[inline(always)]
    pub fn vectors<S: Simd>(&self, simd: S) -> Vec3Lane<f32x16<S>> {
        let (first, last) = self.0.as_flattened().split_at(32);
        let [x, y, z, _] = columns(simd, first, last);
        Vec3Lane::new(x, y, z)
    }
}

/// Returns four numbers of each of sixteen, which are given one after the other in two halves,
/// apart.
#[inline(always)]
pub fn columns<S: Simd>(simd: S, first: &[f32], last: &[f32]) -> [f32x16<S>; 4] {
    let a = f32x16::from_slice(simd, &first[..16]);
    let b = f32x16::from_slice(simd, &first[16..32]);
    let c = f32x16::from_slice(simd, &last[..16]);
    let d = f32x16::from_slice(simd, &last[16..32]);
    let (even_ab, even_cd) = (simd.unzip_low_f32x16(a, b), simd.unzip_low_f32x16(c, d));
    let (odd_ab, odd_cd) = (simd.unzip_high_f32x16(a, b), simd.unzip_high_f32x16(c, d));
    let first = simd.unzip_low_f32x16(even_ab, even_cd);
    let third = simd.unzip_high_f32x16(even_ab, even_cd);
    let second = simd.unzip_low_f32x16(odd_ab, odd_cd);
    [first, second, third, simd.unzip_high_f32x16(odd_ab, odd_cd)]
}

/// Returns four numbers of each of eight, apart.
#[inline(always)]
pub fn four_columns<S: Simd>(simd: S, [a, b, c, d, e, f, g, h]: [f32x4<S>; 8]) -> [f32x8<S>; 4] {
    let (ab, cd) = (simd.combine_f32x4(a, b), simd.combine_f32x4(c, d));
    let (ef, gh) = (simd.combine_f32x4(e, f), simd.combine_f32x4(g, h));
    let (even_ad, even_eh) = (simd.unzip_low_f32x8(ab, cd), simd.unzip_low_f32x8(ef, gh));
    let (odd_ad, odd_eh) = (simd.unzip_high_f32x8(ab, cd), simd.unzip_high_f32x8(ef, gh));
    let first = simd.unzip_low_f32x8(even_ad, even_eh);
    let third = simd.unzip_high_f32x8(even_ad, even_eh);
    let second = simd.unzip_low_f32x8(odd_ad, odd_eh);
    [first, second, third, simd.unzip_high_f32x8(odd_ad, odd_eh)]
}

/// Returns four numbers of each of eight side by side: undoes [`four_columns`].
#[inline(always)]
pub fn four_rows<S: Simd>(simd: S, [a, b, c, d]: [f32x8<S>; 4]) -> [[f32; 4]; 8] {
    let (ac, bd) = (simd.zip_low_f32x8(a, c), simd.zip_low_f32x8(b, d));
    let (ac_high, bd_high) = (simd.zip_high_f32x8(a, c), simd.zip_high_f32x8(b, d));
    let mut rows = [[0.0; 4]; 8];
    let [first, second, third, last] = rows.as_flattened_mut().as_chunks_mut::<8>().0 else {
        return rows;
    };
    simd.zip_low_f32x8(ac, bd).store_slice(first);
    simd.zip_high_f32x8(ac, bd).store_slice(second);
    simd.zip_low_f32x8(ac_high, bd_high).store_slice(third);
    simd.zip_high_f32x8(ac_high, bd_high).store_slice(last);
    rows
}

/// Turns rows into columns.
#[inline(always)]
pub fn transpose<S: Simd>(simd: S, mut from: [f32x8<S>; 8]) -> [f32x8<S>; 8] {
    // Each shuffle rotates the six bits of a number's row and lane by one; three exchange them.
    for _ in 0..3 {
        let mut to = from;
        for i in 0..4 {
            to[2 * i] = simd.zip_low_f32x8(from[i], from[i + 4]);
            to[2 * i + 1] = simd.zip_high_f32x8(from[i], from[i + 4]);
        }
        from = to;
    }
    from
}

/// Converts to double precision.
#[inline(always)]
pub fn widened<S: Simd>(simd: S, v: f32x8<S>) -> f64x8<S> {
    let (a, b) = simd.widen_f32x8(v);
    simd.combine_f64x4(a, b)
}

/// Rounds to single precision.
#[inline(always)]
pub fn narrowed<S: Simd>(simd: S, v: f64x8<S>) -> f32x8<S> {
    let (a, b) = simd.split_f64x8(v);
    simd.narrow_f64x4(a, b)
}

/// 1.5 · 2⁵²: adding it rounds a number to the nearest integer, ties to even, and puts that into the low bits.
pub const MAGIC: f64 = 6_755_399_441_055_744.0;

/// Returns the lower 32 bits of eight doubles.
#[inline(always)]
pub fn low_bits<S: Simd>(simd: S, v: f64x8<S>) -> i32x8<S> {
    let (a, b) = simd.split_f64x8(v);
    simd.narrow_i64x4(a.bitcast(), b.bitcast())
}

/// Converts integers of at most 31 bits exactly.
#[inline(always)]
pub fn integers_widened<S: Simd>(simd: S, v: i32x8<S>) -> f64x8<S> {
    // Added to the bits of this, an integer is added to the number.
    let (low, high) = simd.widen_i32x8(v);
    let bits = MAGIC.to_bits().cast_signed();
    let (low, high) = (low + bits, high + bits);
    simd.combine_f64x4(low.bitcast(), high.bitcast()) - MAGIC
}
