//! Texture coordinates at sixteen pixels.

use super::{Lit, LookedUp};
use crate::shade::TexCoords;
use crate::visibility::surface::lit::textured::{CoordsOfOne, GatheredCoords};
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
        let mut all = CoordsOfOne::new(simd, t, corners).at(simd, patch, changing);
        let mut left = there & !shown.simd_eq(u32x16::splat(simd, first)).to_bitmask();
        while left != 0 {
            let item = items[left.trailing_zeros() as usize % 16];
            let same = shown.simd_eq(u32x16::splat(simd, item));
            left &= !same.to_bitmask();
            let t = self.triangles.get(item, run);
            let corners = t.corners.map(|c| coords[c as usize]);
            let of_t = CoordsOfOne::new(simd, t, corners).at(simd, patch, changing);
            for k in 0..2 {
                all.uv[k] = same.select(of_t.uv[k], all.uv[k]);
                all.ddx[k] = same.select(of_t.ddx[k], all.ddx[k]);
                all.ddy[k] = same.select(of_t.ddy[k], all.ddy[k]);
            }
        }
        all
    }
}
