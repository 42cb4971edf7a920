//! Normals that were computed before items requested them: where triangles were sampled while they were set up.
//!
//! With one sample per pixel, each sample has room for its own normal; with four, the samples of a pixel share the
//! normals found.

use crate::shade::lane::Vec3Lane;
use crate::target::NO_ITEM;
use crate::visibility::surface::gather::columns;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i32x4, mask32x8, mask32x16, u32x4, u32x8, u32x16};

/// Normals at the samples of a tile, of the side that is seen, settled, of any length.
pub struct KnownNormals {
    any: bool,
    /// The item whose normal is stored for each sample; [`NO_ITEM`] if none is.
    items: Vec<u32>,
    /// Index of each sample's normal, for pixels of several samples.
    places: Vec<u32>,
    /// The normals, and an unused number: by pixel where pixels have one sample.
    normals: Vec<[f32; 4]>,
    /// Number of samples of a pixel.
    samples: usize,
}

/// Mask of the pixels among sixteen whose normals are known, and the normals.
pub type Known<S> = (mask32x16<S>, Vec3Lane<f32x16<S>>);

impl KnownNormals {
    /// Makes room for this many pixels of one sample or four, with nothing known; for pixels with other numbers of
    /// samples it makes none.
    pub fn new(pixels: usize, samples: usize) -> Self {
        let (rooms, of_pixels) = match samples {
            1 => (pixels, pixels),
            4 => (4 * pixels, 0),
            _ => (0, 0),
        };
        let (items, normals) = (vec![NO_ITEM; rooms], vec![[0.0; 4]; of_pixels]);
        Self { any: false, items, places: vec![0; rooms - of_pixels], normals, samples }
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        if std::mem::take(&mut self.any) {
            self.items.fill(NO_ITEM);
            if self.samples > 1 {
                self.normals.clear();
            }
        }
    }

    /// Sets the normal of an item at a pixel of one sample; NaN if it is not known.
    #[inline(always)]
    pub fn set(&mut self, pixel: usize, item: u32, [x, y, z]: [f32; 3]) {
        self.any = true;
        self.items[pixel] = if x.is_nan() { NO_ITEM } else { item };
        self.normals[pixel] = [x, y, z, 0.0];
    }

    /// Sets the normal of an item at each of a pixel's four samples where all bits of `seen` are set; NaN if it is not
    /// known.
    #[inline(always)]
    pub fn set_four<S: Simd>(
        &mut self,
        simd: S,
        (pixel, seen): (usize, i32x4<S>),
        item: u32,
        [x, y, z]: [f32; 3],
    ) {
        if x.is_nan() {
            // The stored normals belong to other items, so none of them is taken for this item's normal.
            return;
        }
        self.any = true;
        let (seen, place): (u32x4<S>, u32) = (seen.bitcast(), self.normals.len() as u32);
        self.normals.push([x, y, z, 0.0]);
        for (of_pixel, new) in [(&mut self.items, item), (&mut self.places, place)] {
            let of_pixel = &mut of_pixel[4 * pixel..4 * pixel + 4];
            let old = u32x4::from_slice(simd, of_pixel);
            (old ^ ((old ^ new) & seen)).store_slice(of_pixel);
        }
    }

    /// Returns whether there are any.
    pub fn any(&self) -> bool {
        self.any
    }

    /// Returns the normal of an item at a sample, counted through the pixels, if it is known there.
    #[inline(always)]
    pub fn of_sample(&self, sample: usize, item: u32) -> Option<&[f32; 4]> {
        if !self.any || self.items[sample] != item {
            return None;
        }
        let place = if self.samples == 1 { sample } else { self.places[sample] as usize };
        self.normals.get(place)
    }

    /// Returns which of sixteen samples side by side show an item whose normal is known.
    #[inline(always)]
    pub fn of_sixteen<S: Simd>(&self, simd: S, sample: usize, shown: u32x16<S>) -> mask32x16<S> {
        shown.simd_eq(u32x16::from_slice(simd, &self.items[sample..sample + 16]))
    }

    /// Returns the pixels among eight in a row for which the normals of their items are known.
    #[inline(always)]
    pub fn of_eight<S: Simd>(&self, simd: S, pixel: usize, shown: u32x8<S>) -> mask32x8<S> {
        shown.simd_eq(u32x8::from_slice(simd, &self.items[pixel..pixel + 8]))
    }

    /// Returns the pixels of one sample, among twice eight that show items, whose normals are known; and the normals.
    #[inline(always)]
    pub fn of_patch<S: Simd>(
        &self,
        simd: S,
        [first, second]: [usize; 2],
        shown: u32x16<S>,
    ) -> Option<Known<S>> {
        if !self.any || self.samples > 1 {
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
