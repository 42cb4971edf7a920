//! From a visible item back to its triangle, and from a pixel to a point on it.
//!
//! Perspective-correct coordinates come from the edge functions in homogeneous screen space
//! (M. Olano, T. Greer, *Triangle scan conversion using 2D homogeneous coordinates*, 1997), so
//! triangles that were cut at the near plane need no special care.

use crate::math::{Vec3, Vec4};
use crate::scene::Mesh;
use crate::target::NO_ITEM;
use crate::visibility::surface::setup::Run;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4, f32x8, f32x16};

/// A visible triangle, ready to be interpolated.
#[derive(Debug, Clone, Copy)]
pub struct VisibleTriangle {
    /// Its item.
    pub item: u32,
    /// Its vertices in the mesh.
    pub corners: [u32; 3],
    /// Of each vertex its position, x to z, and its normal, in one row to be blended in one go.
    pub(super) rows: [Row; 3],
    /// Unit normal of the face's front, world axes.
    pub face_normal: Vec3,
    /// Whether it is seen from its front and has normals of a length on its front's side, both by a
    /// margin, so that rounding changes nothing of it at any of its points.
    pub settled: bool,
    /// The pixel from whose centre x and y are counted.
    pub(super) origin: [i32; 2],
    /// Edge function i at (x, y) is `edges[0][i] + (edges[1][i]·x + edges[2][i]·y)`; the fourth is not used.
    pub(super) edges: [[f32; 4]; 3],
}

/// A point of a triangle: position relative to the eye and normal, world axes, and two zeros.
pub type Row = [f32; 8];

impl Default for VisibleTriangle {
    /// No triangle.
    fn default() -> Self {
        Self {
            item: NO_ITEM,
            corners: [0; 3],
            rows: [[0.0; 8]; 3],
            face_normal: Vec3::ZERO,
            settled: false,
            origin: [0; 2],
            edges: [[0.0; 4]; 3],
        }
    }
}

/// The run that holds an item that was drawn.
pub fn run_of(runs: &[Run], item: u32) -> usize {
    runs.partition_point(|run| run.first_item <= item).saturating_sub(1)
}

/// Of sixteen pixels, eight in each of two rows, how far to the right and how far down they are.
pub(super) const COLUMNS: [f32; 16] =
    [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
pub(super) const ROWS: [f32; 16] =
    [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0];

/// Barycentric coordinates of one pixel.
pub type Weights = [f32; 3];

impl VisibleTriangle {
    /// Of the vertices; world axes, relative to the eye.
    #[inline(always)]
    pub fn positions(&self) -> [Vec3; 3] {
        self.rows.map(|[x, y, z, ..]| Vec3::new(x, y, z))
    }

    /// Of the vertices; world axes, not of unit length; all three the face normal where the mesh has
    /// none.
    #[inline(always)]
    pub fn normals(&self) -> [Vec3; 3] {
        self.rows.map(|[_, _, _, x, y, z, ..]| Vec3::new(x, y, z))
    }

    /// Edge functions at a point counted from the origin, in this order of operations.
    #[inline(always)]
    fn edges_at(&self, x: f32, y: f32) -> Weights {
        let [constant, dx, dy] = &self.edges;
        [0, 1, 2].map(|i| constant[i] + (dx[i] * x + dy[i] * y))
    }

    /// The edge functions, by constant and changes along x and y, and where a pixel's centre lies for
    /// them: what [`Self::weights`] and [`Self::weights_beside`] start from.
    #[inline(always)]
    pub fn edge_functions(&self, x: i32, y: i32) -> (&[[f32; 4]; 3], [f32; 2]) {
        (&self.edges, [(x - self.origin[0]) as f32, (y - self.origin[1]) as f32])
    }

    /// Perspective-correct barycentric coordinates at a pixel's centre moved by `shift` pixels; kept
    /// within the triangle where the point lies outside, as it may at edges.
    #[inline(always)]
    pub fn weights(&self, x: i32, y: i32, shift: [f32; 2]) -> Weights {
        let fx = (x - self.origin[0]) as f32 + shift[0];
        let fy = (y - self.origin[1]) as f32 + shift[1];
        let [a, b, c] = self.edges_at(fx, fy).map(|e| e.max(0.0));
        let inverse = 1.0 / (a + b + c).max(f32::MIN_POSITIVE);
        [a * inverse, b * inverse, c * inverse]
    }

    /// Coordinates at the centres of the pixels to the right and below, also outside the triangle.
    pub fn weights_beside(&self, x: i32, y: i32) -> (Weights, Weights) {
        let at = |x: i32, y: i32| {
            let (fx, fy) = ((x - self.origin[0]) as f32, (y - self.origin[1]) as f32);
            let [a, b, c] = self.edges_at(fx, fy);
            let sum = a + b + c;
            // Beyond the horizon there is no such point: the derivative is that of the border.
            if sum > 0.0 { Some([a / sum, b / sum, c / sum]) } else { None }
        };
        let here = || self.weights(x, y, [0.0; 2]);
        (at(x + 1, y).unwrap_or_else(here), at(x, y + 1).unwrap_or_else(here))
    }

    /// The interpolated tangent, mesh axes, where the mesh has tangents.
    pub fn tangent(&self, mesh: &Mesh, w: Weights) -> Option<Vec4> {
        let [a, b, c] = match mesh.tangents.as_slice() {
            [] => return None,
            tangents => self.corners.map(|c| tangents[c as usize]),
        };
        let tangent = a * w[0] + b * w[1] + c * w[2];
        Some(tangent.truncate().extend(a.w))
    }

    /// [`Self::weights`] of eight pixels in a row, without shift.
    #[inline(always)]
    pub fn weights_x8<S: Simd>(&self, simd: S, x: i32, y: i32) -> [f32x8<S>; 3] {
        let lanes = f32x8::from_slice(simd, &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        let zero = f32x8::splat(simd, 0.0);
        let fx = lanes + (x - self.origin[0]) as f32;
        let fy = (y - self.origin[1]) as f32;
        let [constant, dx, dy] = &self.edges;
        let a = (fx * dx[0] + dy[0] * fy + constant[0]).max(zero);
        let b = (fx * dx[1] + dy[1] * fy + constant[1]).max(zero);
        let c = (fx * dx[2] + dy[2] * fy + constant[2]).max(zero);
        let sum = (a + b + c).max(f32x8::splat(simd, f32::MIN_POSITIVE));
        let inverse = f32x8::splat(simd, 1.0) / sum;
        [a * inverse, b * inverse, c * inverse]
    }

    /// Position and normal at eight pixels in a row, component by component.
    #[inline(always)]
    pub fn points_x8<S: Simd>(&self, simd: S, x: i32, y: i32) -> [f32x8<S>; 6] {
        let w = self.weights_x8(simd, x, y);
        let [a, b, c] = &self.rows;
        let mut points = [w[0]; 6];
        for (i, to) in points.iter_mut().enumerate() {
            *to = w[0] * a[i] + w[1] * b[i] + w[2] * c[i];
        }
        points
    }

    /// Position and normal at eight pixels in a row and at the eight below them, component by
    /// component, bit for bit what [`Self::points_x8`] gives there; and a mask of the pixels that have
    /// coordinates, which is to say that rounding has not left all of them at 0.
    #[inline(always)]
    pub fn points_x16<S: Simd>(&self, simd: S, x: i32, y: i32) -> ([f32x16<S>; 6], u64) {
        let column = (x - self.origin[0]) as f32;
        let row = (y - self.origin[1]) as f32;
        let fx = f32x16::from_slice(simd, &COLUMNS) + column;
        let fy = f32x16::from_slice(simd, &ROWS) + row;
        let zero = f32x16::splat(simd, 0.0);
        let [constant, dx, dy] = &self.edges;
        let a = (fx * dx[0] + fy * dy[0] + constant[0]).max(zero);
        let b = (fx * dx[1] + fy * dy[1] + constant[1]).max(zero);
        let c = (fx * dx[2] + fy * dy[2] + constant[2]).max(zero);
        let sum = a + b + c;
        let has_some = sum.simd_gt(zero).to_bitmask();
        let sum = sum.max(f32x16::splat(simd, f32::MIN_POSITIVE));
        let inverse = f32x16::splat(simd, 1.0) / sum;
        let w = [a * inverse, b * inverse, c * inverse];
        let [a, b, c] = &self.rows;
        let mut points = [zero; 6];
        for (i, to) in points.iter_mut().enumerate() {
            *to = w[0] * a[i] + w[1] * b[i] + w[2] * c[i];
        }
        (points, has_some)
    }

    /// Position and normal at one pixel, bit for bit what [`Self::points_x8`] gives.
    #[inline(always)]
    pub fn point<S: Simd>(&self, simd: S, x: i32, y: i32) -> f32x8<S> {
        let (fx, fy) = ((x - self.origin[0]) as f32, (y - self.origin[1]) as f32);
        let [constant, dx, dy] = &self.edges;
        let (dx, dy) = (f32x4::from_slice(simd, dx), f32x4::from_slice(simd, dy));
        let edges = dx * fx + dy * fy + f32x4::from_slice(simd, constant);
        let edges = edges.max(f32x4::splat(simd, 0.0));
        let [a, b, c, _]: [f32; 4] = edges.into();
        let inverse = 1.0 / (a + b + c).max(f32::MIN_POSITIVE);
        let [row_a, row_b, row_c] = &self.rows;
        let row_a = f32x8::from_slice(simd, row_a) * (a * inverse);
        let row_b = f32x8::from_slice(simd, row_b) * (b * inverse);
        let row_c = f32x8::from_slice(simd, row_c) * (c * inverse);
        row_a + row_b + row_c
    }
}

/// A weighted sum of three vectors, in this order of operations.
#[inline(always)]
pub fn blend(values: &[Vec3; 3], w: Weights) -> Vec3 {
    let [a, b, c] = values;
    Vec3::new(
        a.x * w[0] + b.x * w[1] + c.x * w[2],
        a.y * w[0] + b.y * w[1] + c.y * w[2],
        a.z * w[0] + b.z * w[1] + c.z * w[2],
    )
}
