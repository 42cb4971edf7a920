//! Points of several triangles side by side, so that they can be shaded in one go.

use crate::math::Vec3;
use crate::shade::lane::{Lane, Vec3Lane};
use crate::shade::{Faces, Points};
use crate::visibility::surface::attributes::{Row, VisibleTriangle};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, f32x16, f64x8};

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
        let (rows, [x, y, z]) = self.columns(simd);
        points(rows, Faces::Normals(Vec3Lane::new(x, y, z)), parallel_view)
    }

    /// The points of two, one after the other.
    #[inline(always)]
    pub fn both<S: Simd>(
        simd: S,
        [a, b]: &[Self; 2],
        parallel_view: Option<Vec3>,
    ) -> Points<f32x16<S>> {
        let ((a, a_face), (b, b_face)) = (a.columns(simd), b.columns(simd));
        let [x, y, z] = combine(simd, a_face, b_face);
        points(combine(simd, a, b), Faces::Normals(Vec3Lane::new(x, y, z)), parallel_view)
    }

    /// Positions and normals, and the faces' normals.
    #[inline(always)]
    fn columns<S: Simd>(&self, simd: S) -> ([f32x8<S>; 6], [f32x8<S>; 3]) {
        let mut rows = [simd.splat_f32x8(0.0); 8];
        for (to, row) in rows.iter_mut().zip(&self.rows) {
            *to = f32x8::from_slice(simd, row);
        }
        let [px, py, pz, nx, ny, nz, _, _] = transpose(simd, rows);
        let [x, y, z] = &self.face_normals;
        let (x, y) = (f32x8::from_slice(simd, x), f32x8::from_slice(simd, y));
        ([px, py, pz, nx, ny, nz], [x, y, f32x8::from_slice(simd, z)])
    }
}

/// The numbers of eight lanes, and of eight more.
#[inline(always)]
fn combine<S: Simd, const N: usize>(simd: S, a: [f32x8<S>; N], b: [f32x8<S>; N]) -> [f32x16<S>; N] {
    let mut both = [simd.splat_f32x16(0.0); N];
    for i in 0..N {
        both[i] = simd.combine_f32x8(a[i], b[i]);
    }
    both
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

/// Points of positions and normals, component by component.
#[inline(always)]
pub fn points<L: Lane>(
    [px, py, pz, nx, ny, nz]: [L; 6],
    faces: Faces<L>,
    parallel_view: Option<Vec3>,
) -> Points<L> {
    let view = match parallel_view {
        Some(v) => Vec3Lane::splat(px, v),
        None => Vec3Lane::new(px, py, pz).reversed(),
    };
    let (position, normal) = (Vec3Lane::new(px, py, pz), Vec3Lane::new(nx, ny, nz));
    Points { position, view, normal, faces }
}
