//! Texture coordinates at sixteen pixels.

use super::{Lit, LookedUp};
use crate::math::Vec2;
use crate::shade::TexCoords;
use crate::shade::lane::Lane;
use crate::visibility::surface::points::attributes::VisibleTriangle;
use crate::visibility::surface::points::patch::Patch;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};

impl<'a> Lit<'a> {
    /// Returns the texture coordinates at the pixels of a set, all of one run.
    #[inline(always)]
    pub(super) fn coords_by_pixel<S: Simd>(
        &mut self,
        simd: S,
        (run, LookedUp { coords, changing, .. }): (usize, LookedUp<'a>),
        items: &[u32; 16],
        mut left: u64,
        patch: Patch,
    ) -> TexCoords<f32x16<S>> {
        let mut gathered = GatheredCoords::default();
        while left != 0 {
            let i = left.trailing_zeros() as usize % 16;
            left &= left - 1;
            let t = self.triangles.get(items[i], run);
            gathered.set(i, t, patch.pixel(i), t.corners.map(|c| coords[c as usize]));
        }
        gathered.coordinates(simd, changing)
    }

    /// Returns the texture coordinates at the pixels of a set: computes them at all sixteen pixels for each triangle
    /// and selects the pixels that show it. Pixels not in the set have coordinates close to the others'.
    #[inline(always)]
    pub(super) fn coords_by_triangle<S: Simd>(
        &mut self,
        simd: S,
        (run, LookedUp { coords, changing, .. }): (usize, LookedUp<'a>),
        (shown, items): (u32x16<S>, &[u32; 16]),
        there: u64,
        patch: Patch,
    ) -> TexCoords<f32x16<S>> {
        let first = items[there.trailing_zeros() as usize % 16];
        let t = self.triangles.get(first, run);
        let corners = t.corners.map(|c| coords[c as usize]);
        let mut all = coords_of_one(simd, t, corners, patch, changing);
        let mut left = there & !shown.simd_eq(u32x16::splat(simd, first)).to_bitmask();
        while left != 0 {
            let item = items[left.trailing_zeros() as usize % 16];
            let same = shown.simd_eq(u32x16::splat(simd, item));
            left &= !same.to_bitmask();
            let t = self.triangles.get(item, run);
            let corners = t.corners.map(|c| coords[c as usize]);
            let of_t = coords_of_one(simd, t, corners, patch, changing);
            for k in 0..2 {
                all.uv[k] = same.select(of_t.uv[k], all.uv[k]);
                all.ddx[k] = same.select(of_t.ddx[k], all.ddx[k]);
                all.ddy[k] = same.select(of_t.ddy[k], all.ddy[k]);
            }
        }
        all
    }
}

/// Up to sixteen pixels with the data from which their texture coordinates are computed; pixels not set keep their
/// earlier contents.
#[derive(Debug, Clone, Copy, Default)]
struct GatheredCoords {
    /// Edge functions: constants, changes along x, changes along y, each of the three edges.
    edges: [[[f32; 16]; 3]; 3],
    /// Points at which the edge functions are evaluated.
    at: [[f32; 16]; 2],
    /// u and v of each of the three corners.
    corners: [[[f32; 16]; 3]; 2],
}

/// Three numbers per lane, one for each corner.
type Corners<S> = [f32x16<S>; 3];

impl GatheredCoords {
    /// Sets the pixel `lane` to one of a triangle with these coordinates at its corners.
    #[inline(always)]
    fn set(&mut self, lane: usize, t: &VisibleTriangle, [x, y]: [i32; 2], corners: [Vec2; 3]) {
        let lane = lane % 16;
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

    /// Returns the coordinates and, where `changing` is set, their change to the pixels beside and below, with the same
    /// bits as one by one.
    #[inline(always)]
    fn coordinates<S: Simd>(&self, simd: S, changing: bool) -> TexCoords<f32x16<S>> {
        let [constant, dx, dy] = &self.edges;
        let edges = [three(simd, constant), three(simd, dx), three(simd, dy)];
        let at = [f32x16::from_slice(simd, &self.at[0]), f32x16::from_slice(simd, &self.at[1])];
        let corners = [three(simd, &self.corners[0]), three(simd, &self.corners[1])];
        coordinates(simd, &edges, at, corners, changing)
    }
}

/// Returns the texture coordinates of a triangle, given those at its corners, at the pixels of a patch and, where
/// `changing` is set, their change to the pixels beside and below.
#[inline(always)]
fn coords_of_one<S: Simd>(
    simd: S,
    t: &VisibleTriangle,
    corners: [Vec2; 3],
    patch: Patch,
    changing: bool,
) -> TexCoords<f32x16<S>> {
    let zero = simd.splat_f32x16(0.0);
    let (of_t, at) = t.edge_functions(patch.at[0], patch.at[1]);
    let mut edges = [[zero; 3]; 3];
    for (edges, of_t) in edges.iter_mut().zip(of_t) {
        for (edge, of_t) in edges.iter_mut().zip(of_t) {
            *edge = simd.splat_f32x16(*of_t);
        }
    }
    let (mut u, mut v) = ([zero; 3], [zero; 3]);
    for (i, corner) in corners.iter().enumerate() {
        (u[i], v[i]) = (simd.splat_f32x16(corner.x), simd.splat_f32x16(corner.y));
    }
    coordinates(simd, &edges, patch.places(simd, at), [u, v], changing)
}

#[inline(always)]
fn three<S: Simd>(simd: S, [a, b, c]: &[[f32; 16]; 3]) -> Corners<S> {
    let (a, b) = (f32x16::from_slice(simd, a), f32x16::from_slice(simd, b));
    [a, b, f32x16::from_slice(simd, c)]
}

/// Interpolates texture coordinates from edge functions, by constant and changes, and the coordinates of the corners.
#[inline(always)]
fn coordinates<S: Simd>(
    simd: S,
    edges: &[Corners<S>; 3],
    [x, y]: [f32x16<S>; 2],
    [u, v]: [Corners<S>; 2],
    changing: bool,
) -> TexCoords<f32x16<S>> {
    let here = weights(simd, edges_at(edges, x, y));
    let uv = [blend(u, here), blend(v, here)];
    if !changing {
        let none = [simd.splat_f32x16(0.0); 2];
        return TexCoords { uv, ddx: none, ddy: none };
    }
    let right = weights_beside(simd, edges_at(edges, x + 1.0, y), here);
    let down = weights_beside(simd, edges_at(edges, x, y + 1.0), here);
    let ddx = [blend(u, right) - uv[0], blend(v, right) - uv[1]];
    let ddy = [blend(u, down) - uv[0], blend(v, down) - uv[1]];
    TexCoords { uv, ddx, ddy }
}

#[inline(always)]
fn edges_at<S: Simd>(edges: &[Corners<S>; 3], x: f32x16<S>, y: f32x16<S>) -> Corners<S> {
    let [constant, dx, dy] = edges;
    let mut at = [x; 3];
    for (i, at) in at.iter_mut().enumerate() {
        *at = constant[i] + (dx[i] * x + dy[i] * y);
    }
    at
}

/// Returns the weights of [`VisibleTriangle::weights`].
#[inline(always)]
fn weights<S: Simd>(simd: S, [a, b, c]: Corners<S>) -> Corners<S> {
    let zero = simd.splat_f32x16(0.0);
    let (a, b, c) = (a.max(zero), b.max(zero), c.max(zero));
    let sum = (a + b + c).max(simd.splat_f32x16(f32::MIN_POSITIVE));
    let inverse = simd.splat_f32x16(1.0) / sum;
    [a * inverse, b * inverse, c * inverse]
}

/// Returns the weights of [`VisibleTriangle::weights_beside`]: beyond the horizon those of the
/// pixel itself.
#[inline(always)]
fn weights_beside<S: Simd>(simd: S, edges: Corners<S>, here: Corners<S>) -> Corners<S> {
    let [a, b, c] = edges;
    let sum = a + b + c;
    let seen = simd.simd_gt_f32x16(sum, simd.splat_f32x16(0.0));
    let mut beside = here;
    for (to, edge) in beside.iter_mut().zip(edges) {
        *to = simd.select_f32x16(seen, edge / sum, *to);
    }
    beside
}

/// Returns a weighted sum, in this order of operations.
#[inline(always)]
fn blend<L: Lane>([a, b, c]: [L; 3], w: [L; 3]) -> L {
    a * w[0] + b * w[1] + c * w[2]
}
