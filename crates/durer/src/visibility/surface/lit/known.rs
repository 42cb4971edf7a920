//! Normals that were found before anybody asked for them by items: where triangles were sampled while they were set up.

use crate::shade::lane::Vec3Lane;
use crate::target::NO_ITEM;
use crate::visibility::surface::gather::columns;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x8, mask32x16, u32x8, u32x16};

/// Normals at the pixels of a tile, of the side that is seen, settled, of any length.
pub struct KnownNormals {
    any: bool,
    /// Whose normal each pixel has here; [`NO_ITEM`] where there is none.
    items: Vec<u32>,
    /// The normals, and a number that means nothing.
    normals: Vec<[f32; 4]>,
}

/// Which of sixteen pixels' normals are known, and the normals.
pub type Known<S> = (mask32x16<S>, Vec3Lane<f32x16<S>>);

impl KnownNormals {
    /// Room for so many pixels.
    pub fn new(pixels: usize) -> Self {
        Self { any: false, items: vec![NO_ITEM; pixels], normals: vec![[0.0; 4]; pixels] }
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        if std::mem::take(&mut self.any) {
            self.items.fill(NO_ITEM);
        }
    }

    /// Sets the normal of an item at a pixel, and a number that means nothing; NaN where it is not known.
    #[inline(always)]
    pub fn set(&mut self, pixel: usize, item: u32, normal: [f32; 4]) {
        self.any = true;
        self.items[pixel] = if normal[0].is_nan() { NO_ITEM } else { item };
        self.normals[pixel] = normal;
    }

    /// Whether there are any.
    pub fn any(&self) -> bool {
        self.any
    }

    /// Of eight pixels in a row those whose normals of the items that they show are known.
    #[inline(always)]
    pub fn of_eight<S: Simd>(&self, simd: S, pixel: usize, shown: u32x8<S>) -> mask32x8<S> {
        shown.simd_eq(u32x8::from_slice(simd, &self.items[pixel..pixel + 8]))
    }

    /// Of twice eight pixels that all or in part show items those whose normals are known; and the normals.
    #[inline(always)]
    pub fn of_patch<S: Simd>(
        &self,
        simd: S,
        [first, second]: [usize; 2],
        shown: u32x16<S>,
    ) -> Option<Known<S>> {
        if !self.any {
            return None;
        }
        let above = u32x8::from_slice(simd, &self.items[first..first + 8]);
        let below = u32x8::from_slice(simd, &self.items[second..second + 8]);
        let none = u32x16::splat(simd, NO_ITEM);
        let known = shown.simd_eq(simd.combine_u32x8(above, below)) & shown.simd_ne(none);
        if !known.any_true() {
            return None;
        }
        let (above, below) = (&self.normals[first..first + 8], &self.normals[second..second + 8]);
        let [x, y, z, _] = columns(simd, above.as_flattened(), below.as_flattened());
        Some((known, Vec3Lane::new(x, y, z)))
    }
}
