//! Points of several triangles side by side, so that they can be shaded in one go.

use crate::shade::lane::Vec3Lane;
use crate::visibility::surface::attributes::{USUAL_SUMS, VisibleTriangle};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, f32x16, f64x8};

/// Up to sixteen points from anywhere; those not set hold what was there before.
#[derive(Debug, Clone, Copy)]
pub struct Gathered {
    /// Of each point its normal and the sum of its weights.
    normals: [[f32; 4]; 16],
    /// Of each its position.
    positions: [[f32; 4]; 16],
    /// Unit normals of the sides that are seen, by axis.
    faces: [[f32; 16]; 3],
    /// Whether all triangles are settled.
    settled: bool,
}

impl Default for Gathered {
    /// No points.
    fn default() -> Self {
        Self {
            normals: [[0.0, 0.0, 0.0, 1.0]; 16],
            positions: [[0.0; 4]; 16],
            faces: [[0.0; 16]; 3],
            settled: true,
        }
    }
}

impl Gathered {
    /// Sets the point `lane` to that of a triangle at a pixel, with its position where that is asked for.
    #[inline(always)]
    pub fn set<S: Simd>(
        &mut self,
        simd: S,
        lane: usize,
        t: &VisibleTriangle,
        pixel: [i32; 2],
        with_position: bool,
    ) {
        let lane = lane % 16;
        t.normal_and_sum(simd, pixel).store_slice(&mut self.normals[lane]);
        if with_position {
            t.position(simd, pixel).store_slice(&mut self.positions[lane]);
        }
        for (to, from) in self.faces.iter_mut().zip(t.seen_face_normal.to_array()) {
            to[lane] = from;
        }
        self.settled &= t.settled;
    }

    /// The normals, of any length; and whether all points are settled.
    #[inline(always)]
    pub fn normals<S: Simd>(&self, simd: S) -> ([f32x16<S>; 3], bool) {
        let [x, y, z, sum] = columns(simd, &self.normals);
        let [least, most] = USUAL_SUMS;
        let usual = sum.simd_gt(f32x16::splat(simd, least));
        let usual = usual & sum.simd_lt(f32x16::splat(simd, most));
        ([x, y, z], self.settled && usual.all_true())
    }

    /// The positions that were asked for.
    #[inline(always)]
    pub fn positions<S: Simd>(&self, simd: S) -> Vec3Lane<f32x16<S>> {
        let [x, y, z, _] = columns(simd, &self.positions);
        Vec3Lane::new(x, y, z)
    }

    /// Unit normals of the sides that are seen.
    #[inline(always)]
    pub fn faces<S: Simd>(&self, simd: S) -> Vec3Lane<f32x16<S>> {
        let [x, y, z] = &self.faces;
        let (x, y) = (f32x16::from_slice(simd, x), f32x16::from_slice(simd, y));
        Vec3Lane::new(x, y, f32x16::from_slice(simd, z))
    }
}

/// Four numbers of each of sixteen, apart.
#[inline(always)]
fn columns<S: Simd>(simd: S, rows: &[[f32; 4]; 16]) -> [f32x16<S>; 4] {
    let rows = rows.as_flattened();
    let a = f32x16::from_slice(simd, &rows[..16]);
    let b = f32x16::from_slice(simd, &rows[16..32]);
    let c = f32x16::from_slice(simd, &rows[32..48]);
    let d = f32x16::from_slice(simd, &rows[48..]);
    let (even_ab, even_cd) = (simd.unzip_low_f32x16(a, b), simd.unzip_low_f32x16(c, d));
    let (odd_ab, odd_cd) = (simd.unzip_high_f32x16(a, b), simd.unzip_high_f32x16(c, d));
    let first = simd.unzip_low_f32x16(even_ab, even_cd);
    let third = simd.unzip_high_f32x16(even_ab, even_cd);
    let second = simd.unzip_low_f32x16(odd_ab, odd_cd);
    [first, second, third, simd.unzip_high_f32x16(odd_ab, odd_cd)]
}

/// Rows to columns.
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

/// In double precision.
#[inline(always)]
pub fn widened<S: Simd>(simd: S, v: f32x8<S>) -> f64x8<S> {
    let (a, b) = simd.widen_f32x8(v);
    simd.combine_f64x4(a, b)
}

/// Rounded to single precision.
#[inline(always)]
pub fn narrowed<S: Simd>(simd: S, v: f64x8<S>) -> f32x8<S> {
    let (a, b) = simd.split_f64x8(v);
    simd.narrow_f64x4(a, b)
}
