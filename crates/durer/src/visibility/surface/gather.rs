//! Points of several triangles side by side, so that they can be shaded in one go.

use crate::math::Vec3;
use crate::shade::Points;
use crate::shade::lane::Vec3Lane;
use crate::visibility::surface::attributes::{Row, VisibleTriangle};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

/// Up to eight points from anywhere; those not set hold what was there before.
#[derive(Debug, Clone, Copy, Default)]
pub struct Gathered {
    rows: [Row; 8],
    face_normals: [[f32; 8]; 3],
}

impl Gathered {
    /// Sets the point `lane` to that of a triangle at a pixel.
    #[inline(always)]
    pub fn set<S: Simd>(&mut self, simd: S, lane: usize, t: &VisibleTriangle, [x, y]: [i32; 2]) {
        let lane = lane % 8;
        t.point(simd, x, y).store_slice(&mut self.rows[lane]);
        self.face_normals[0][lane] = t.face_normal.x;
        self.face_normals[1][lane] = t.face_normal.y;
        self.face_normals[2][lane] = t.face_normal.z;
    }

    /// The points, component by component.
    #[inline(always)]
    pub fn points<S: Simd>(&self, simd: S, parallel_view: Option<Vec3>) -> Points<f32x8<S>> {
        let [px, py, pz, nx, ny, nz, _, _] = transpose(simd, &self.rows);
        let [x, y, z] = &self.face_normals;
        let (x, y) = (f32x8::from_slice(simd, x), f32x8::from_slice(simd, y));
        let face_normal = Vec3Lane::new(x, y, f32x8::from_slice(simd, z));
        points([px, py, pz, nx, ny, nz], face_normal, parallel_view)
    }
}

/// Rows to columns.
#[inline(always)]
fn transpose<S: Simd>(simd: S, rows: &[Row; 8]) -> [f32x8<S>; 8] {
    let mut from = [f32x8::splat(simd, 0.0); 8];
    for (to, row) in from.iter_mut().zip(rows) {
        *to = f32x8::from_slice(simd, row);
    }
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

/// Points of positions and normals, component by component.
#[inline(always)]
pub fn points<S: Simd>(
    [px, py, pz, nx, ny, nz]: [f32x8<S>; 6],
    geometric_normal: Vec3Lane<f32x8<S>>,
    parallel_view: Option<Vec3>,
) -> Points<f32x8<S>> {
    let view = match parallel_view {
        Some(v) => Vec3Lane::splat(px, v),
        None => Vec3Lane::new(-px, -py, -pz),
    };
    let (position, normal) = (Vec3Lane::new(px, py, pz), Vec3Lane::new(nx, ny, nz));
    Points { position, view, normal, geometric_normal }
}
