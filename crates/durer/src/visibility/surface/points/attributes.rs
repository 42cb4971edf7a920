//! From a visible item back to its triangle, and from a pixel to a point on it.
//!
//! Perspective-correct coordinates come from the edge functions in homogeneous screen space
//! (M. Olano, T. Greer, *Triangle scan conversion using 2D homogeneous coordinates*, 1997), so
//! triangles that were cut at the near plane need no special care.

use crate::math::{Vec3, Vec4};
use crate::scene::Mesh;
use crate::visibility::surface::points::normal_plane::NormalPlane;
use crate::visibility::surface::points::patch::Patch;
use crate::visibility::surface::setup::Run;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4, f32x16};

/// A visible triangle, ready to be interpolated.
#[derive(Debug, Clone, Copy, Default)]
pub struct VisibleTriangle {
    /// Its item, and its normals if they are settled.
    pub normals: NormalPlane,
    /// Its vertices in the mesh.
    pub corners: [u32; 3],
    /// Normal of each vertex, turned if the triangle is seen from behind, and 0, then its position and 0, in
    /// rows to be interpolated together.
    pub(super) rows: [Row; 3],
    /// Unit normal of the side of the face that is seen, world axes; zero for lines and faces without area.
    pub seen_face_normal: Vec3,
    /// True if the back is visible. All points of a plane show the same side.
    pub from_behind: bool,
    /// Edge function i at (x, y), counted from the origin of the normals, is
    /// `edges[0][i] + (edges[1][i]·x + edges[2][i]·y)`; the fourth is not used.
    pub(super) edges: [[f32; 4]; 3],
}

/// Interpolated values of a vertex.
pub type Row = [f32; 8];

/// Returns the run that holds an item that was drawn.
pub fn run_of(runs: &[Run], item: u32) -> usize {
    runs.partition_point(|run| run.first_item <= item).saturating_sub(1)
}

/// Barycentric coordinates of one pixel.
pub type Weights = [f32; 3];

impl VisibleTriangle {
    /// Returns the positions of the vertices; world axes, relative to the eye.
    #[inline(always)]
    pub fn positions(&self) -> [Vec3; 3] {
        self.rows.map(|[_, _, _, _, x, y, z, _]| Vec3::new(x, y, z))
    }

    /// Returns the normals of the vertices; world axes, not of unit length; all three are the face
    /// normal if the mesh has none.
    #[inline(always)]
    pub fn corner_normals(&self) -> [Vec3; 3] {
        self.rows.map(|[x, y, z, ..]| self.turned(Vec3::new(x, y, z)))
    }

    /// Returns unit normal of the face's front, world axes.
    #[inline(always)]
    pub fn face_normal(&self) -> Vec3 {
        self.turned(self.seen_face_normal)
    }

    /// Turns a normal from the side that is seen to the front, and back.
    #[inline(always)]
    fn turned(&self, normal: Vec3) -> Vec3 {
        if self.from_behind { -normal } else { normal }
    }

    /// Returns the edge functions at a pixel's centre, in this order of operations.
    #[inline(always)]
    fn edges_at(&self, [x, y]: [i32; 2]) -> Weights {
        let ([constant, dx, dy], [x, y]) = self.edge_functions(x, y);
        [0, 1, 2].map(|i| constant[i] + (dx[i] * x + dy[i] * y))
    }

    /// Returns the edge functions and a pixel's centre in their coordinates, from which [`Self::weights`] and
    /// [`Self::weights_beside`] are computed.
    #[inline(always)]
    pub fn edge_functions(&self, x: i32, y: i32) -> (&[[f32; 4]; 3], [f32; 2]) {
        (&self.edges, [(x - self.normals.origin[0]) as f32, (y - self.normals.origin[1]) as f32])
    }

    /// Returns the perspective-correct barycentric coordinates at a pixel's centre; kept within the triangle where the
    /// point is outside, as it may be at edges.
    #[inline(always)]
    pub fn weights(&self, x: i32, y: i32) -> Weights {
        let [a, b, c] = self.edges_at([x, y]).map(|e| e.max(0.0));
        let inverse = 1.0 / (a + b + c).max(f32::MIN_POSITIVE);
        [a * inverse, b * inverse, c * inverse]
    }

    /// Returns the barycentric coordinates at the centres of the pixels to the right and below, also outside the
    /// triangle.
    pub fn weights_beside(&self, x: i32, y: i32) -> (Weights, Weights) {
        let at = |x: i32, y: i32| {
            let [a, b, c] = self.edges_at([x, y]);
            let sum = a + b + c;
            // Beyond the horizon there is no such point, so the derivative at the border is used.
            if sum > 0.0 { Some([a / sum, b / sum, c / sum]) } else { None }
        };
        let here = || self.weights(x, y);
        (at(x + 1, y).unwrap_or_else(here), at(x, y + 1).unwrap_or_else(here))
    }

    /// Returns the interpolated tangent, mesh axes, where the mesh has tangents.
    pub fn tangent(&self, mesh: &Mesh, w: Weights) -> Option<Vec4> {
        let [a, b, c] = match mesh.tangents.as_slice() {
            [] => return None,
            tangents => self.corners.map(|c| tangents[c as usize]),
        };
        let tangent = a * w[0] + b * w[1] + c * w[2];
        Some(tangent.truncate().extend(a.w))
    }

    /// Returns the normal at a pixel's centre, of any length: weighted without a division, for only its
    /// direction matters.
    #[inline(always)]
    pub fn normal(&self, x: i32, y: i32) -> Vec3 {
        if self.normals.settled {
            return self.turned(self.normals.at([x, y]));
        }
        self.normal_within(x, y)
    }

    /// Returns the normal with weights kept within the triangle.
    #[inline(always)]
    pub fn normal_within(&self, x: i32, y: i32) -> Vec3 {
        blend(&self.corner_normals(), self.edges_at([x, y]).map(|e| e.max(0.0)))
    }

    /// Returns the edge functions, at least 0, at the pixels of a patch.
    #[inline(always)]
    fn edges_x16<S: Simd>(&self, simd: S, patch: Patch) -> [f32x16<S>; 3] {
        let ([constant, dx, dy], at) = self.edge_functions(patch.at[0], patch.at[1]);
        let [x, y] = patch.places(simd, at);
        let zero = f32x16::splat(simd, 0.0);
        let mut edges = [zero; 3];
        for (i, to) in edges.iter_mut().enumerate() {
            *to = (x * dx[i] + y * dy[i] + constant[i]).max(zero);
        }
        edges
    }

    /// Returns the normals of the visible side at the pixels of a patch: except for the side, the same as
    /// [`Self::normal`], bit for bit.
    #[inline(always)]
    pub fn normals_x16<S: Simd>(&self, simd: S, patch: Patch) -> [f32x16<S>; 3] {
        if self.normals.settled {
            return self.normals.of_patch(simd, patch);
        }
        let [a, b, c] = self.edges_x16(simd, patch);
        let mut normal = [a; 3];
        for (i, to) in normal.iter_mut().enumerate() {
            *to = a * self.rows[0][i] + b * self.rows[1][i] + c * self.rows[2][i];
        }
        normal
    }

    /// Returns the positions at the pixels of a patch, bit for bit the vertices' blended by [`Self::weights`].
    #[inline(always)]
    pub fn positions_x16<S: Simd>(&self, simd: S, patch: Patch) -> [f32x16<S>; 3] {
        let [a, b, c] = self.edges_x16(simd, patch);
        let sum = (a + b + c).max(f32x16::splat(simd, f32::MIN_POSITIVE));
        let inverse = f32x16::splat(simd, 1.0) / sum;
        let (a, b, c) = (a * inverse, b * inverse, c * inverse);
        let mut position = [sum; 3];
        for (i, to) in position.iter_mut().enumerate() {
            *to = a * self.rows[0][4 + i] + b * self.rows[1][4 + i] + c * self.rows[2][4 + i];
        }
        position
    }

    /// Returns the edge functions, at least 0, at one pixel.
    #[inline(always)]
    fn edges_at_pixel<S: Simd>(&self, simd: S, [x, y]: [i32; 2]) -> [f32; 3] {
        let ([constant, dx, dy], [x, y]) = self.edge_functions(x, y);
        let (dx, dy) = (f32x4::from_slice(simd, dx), f32x4::from_slice(simd, dy));
        let edges = dx * x + dy * y + f32x4::from_slice(simd, constant);
        let [a, b, c, _]: [f32; 4] = edges.max(f32x4::splat(simd, 0.0)).into();
        [a, b, c]
    }

    /// Returns the normal of [`Self::normals_x16`] at one pixel, bit for bit, and any number.
    #[inline(always)]
    pub fn normal_x4<S: Simd>(&self, simd: S, pixel: [i32; 2]) -> f32x4<S> {
        if self.normals.settled {
            return self.normals.at_x4(simd, pixel);
        }
        let [a, b, c] = self.edges_at_pixel(simd, pixel);
        let [row_a, row_b, row_c] = &self.rows;
        let row_a = f32x4::from_slice(simd, &row_a[..4]) * a;
        let row_b = f32x4::from_slice(simd, &row_b[..4]) * b;
        let row_c = f32x4::from_slice(simd, &row_c[..4]) * c;
        row_a + row_b + row_c
    }

    /// Returns the position of [`Self::positions_x16`] at one pixel, bit for bit, and 0.
    #[inline(always)]
    pub fn position<S: Simd>(&self, simd: S, pixel: [i32; 2]) -> f32x4<S> {
        let [a, b, c] = self.edges_at_pixel(simd, pixel);
        let inverse = 1.0 / (a + b + c).max(f32::MIN_POSITIVE);
        let [row_a, row_b, row_c] = &self.rows;
        let row_a = f32x4::from_slice(simd, &row_a[4..]) * (a * inverse);
        let row_b = f32x4::from_slice(simd, &row_b[4..]) * (b * inverse);
        let row_c = f32x4::from_slice(simd, &row_c[4..]) * (c * inverse);
        row_a + row_b + row_c
    }
}

/// Returns a weighted sum of three vectors, in this order of operations.
#[inline(always)]
pub fn blend(values: &[Vec3; 3], w: Weights) -> Vec3 {
    let [a, b, c] = values;
    Vec3::new(
        a.x * w[0] + b.x * w[1] + c.x * w[2],
        a.y * w[0] + b.y * w[1] + c.y * w[2],
        a.z * w[0] + b.z * w[1] + c.z * w[2],
    )
}
