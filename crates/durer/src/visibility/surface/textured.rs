//! Texture coordinates of pixels of several triangles side by side.

use crate::math::Vec2;
use crate::shade::TexCoords;
use crate::shade::lane::Lane;
use crate::visibility::surface::attributes::VisibleTriangle;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

/// Up to eight pixels with what their texture coordinates follow from; those not set hold what was
/// there before.
#[derive(Debug, Clone, Copy, Default)]
pub struct GatheredCoords {
    /// Edge functions: constants, changes along x, changes along y, each of the three edges.
    edges: [[[f32; 8]; 3]; 3],
    /// Where the edge functions are asked.
    at: [[f32; 8]; 2],
    /// u and v of each of the three corners.
    corners: [[[f32; 8]; 3]; 2],
}

/// Three numbers per lane, one for each corner.
type Corners<S> = [f32x8<S>; 3];

impl GatheredCoords {
    /// Sets the pixel `lane` to one of a triangle with these coordinates at its corners.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, t: &VisibleTriangle, [x, y]: [i32; 2], corners: [Vec2; 3]) {
        let lane = lane % 8;
        let (edges, [x, y]) = t.edge_functions(x, y);
        for (to, from) in self.edges.iter_mut().zip(edges) {
            for (to, from) in to.iter_mut().zip(from) {
                to[lane] = *from;
            }
        }
        (self.at[0][lane], self.at[1][lane]) = (x, y);
        for (i, corner) in corners.iter().enumerate() {
            (self.corners[0][i][lane], self.corners[1][i][lane]) = (corner.x, corner.y);
        }
    }

    /// The coordinates and their change to the pixels beside and below, bit for bit as one by one.
    #[inline(always)]
    pub fn coordinates<S: Simd>(&self, simd: S) -> TexCoords<f32x8<S>> {
        let (x, y) = (f32x8::from_slice(simd, &self.at[0]), f32x8::from_slice(simd, &self.at[1]));
        let here = weights(simd, self.edges_at(simd, x, y));
        let right = weights_beside(simd, self.edges_at(simd, x + 1.0, y), here);
        let down = weights_beside(simd, self.edges_at(simd, x, y + 1.0), here);
        let [u, v] = [self.corners_of(simd, 0), self.corners_of(simd, 1)];
        let uv = [blend(u, here), blend(v, here)];
        let ddx = [blend(u, right) - uv[0], blend(v, right) - uv[1]];
        let ddy = [blend(u, down) - uv[0], blend(v, down) - uv[1]];
        TexCoords { uv, ddx, ddy }
    }

    #[inline(always)]
    fn corners_of<S: Simd>(&self, simd: S, axis: usize) -> Corners<S> {
        let [a, b, c] = &self.corners[axis];
        let (a, b) = (f32x8::from_slice(simd, a), f32x8::from_slice(simd, b));
        [a, b, f32x8::from_slice(simd, c)]
    }

    #[inline(always)]
    fn edges_at<S: Simd>(&self, simd: S, x: f32x8<S>, y: f32x8<S>) -> Corners<S> {
        let mut edges = [x; 3];
        for (i, edge) in edges.iter_mut().enumerate() {
            let lane = |k: usize| f32x8::from_slice(simd, &self.edges[k][i]);
            *edge = lane(0) + (lane(1) * x + lane(2) * y);
        }
        edges
    }
}

/// As [`VisibleTriangle::weights`].
#[inline(always)]
fn weights<S: Simd>(simd: S, [a, b, c]: Corners<S>) -> Corners<S> {
    let zero = simd.splat_f32x8(0.0);
    let (a, b, c) = (a.max(zero), b.max(zero), c.max(zero));
    let sum = (a + b + c).max(simd.splat_f32x8(f32::MIN_POSITIVE));
    let inverse = simd.splat_f32x8(1.0) / sum;
    [a * inverse, b * inverse, c * inverse]
}

/// As [`VisibleTriangle::weights_beside`]: beyond the horizon those of the pixel itself.
#[inline(always)]
fn weights_beside<S: Simd>(simd: S, edges: Corners<S>, here: Corners<S>) -> Corners<S> {
    let [a, b, c] = edges;
    let sum = a + b + c;
    let seen = simd.simd_gt_f32x8(sum, simd.splat_f32x8(0.0));
    let mut beside = here;
    for (to, edge) in beside.iter_mut().zip(edges) {
        *to = simd.select_f32x8(seen, edge / sum, *to);
    }
    beside
}

/// A weighted sum, in this order of operations.
#[inline(always)]
fn blend<L: Lane>([a, b, c]: [L; 3], w: [L; 3]) -> L {
    a * w[0] + b * w[1] + c * w[2]
}
