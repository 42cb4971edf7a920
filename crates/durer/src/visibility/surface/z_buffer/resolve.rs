//! From the visible items of a tile to colours: each triangle is lit once per pixel, the samples of
//! a pixel are averaged in linear light, blended surfaces are laid over from far to near.

use super::blended::{Fragments, resolve_blended};
use super::rasterize::FragmentTest;
use super::tile::{SamplePlane, TILE};
use crate::math::Vec4;
use crate::shade::color::{encode_opaque_x8, premultiply};
use crate::target::NO_ITEM;
use crate::visibility::surface::lit::Lit;
use crate::visibility::surface::mixed::{Mixed, encode};
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, u32x8};
use fearless_simd_macros::simd;

/// Samples that a pixel has at most.
pub(super) const MOST_SAMPLES: usize = 16;

/// Lets the fragments of masked surfaces pass where they are.
pub struct MaskTest<'t, 'a> {
    pub lit: &'t mut Lit<'a>,
    pub tile: [i32; 2],
}

impl FragmentTest for MaskTest<'_, '_> {
    fn passes(&mut self, t: &ScreenTriangle, x: i32, y: i32, _sample: usize) -> bool {
        self.lit.passes_mask(t.item, self.tile[0] + x, self.tile[1] + y)
    }
}

/// Where a tile lies in the picture, and what is behind everything.
pub struct Area<'b> {
    /// The upper left pixel.
    pub tile: [i32; 2],
    /// Pixels across and down.
    pub size: [i32; 2],
    /// Linear with straight alpha, by row of the picture.
    pub background: &'b (dyn Fn(i32) -> Vec4 + Sync),
}

/// A tile's part of the colour plane.
pub struct Output<'o> {
    /// Rows of the picture, from the tile's first.
    pub color: &'o mut [[u8; 4]],
    /// Pixels of a row.
    pub stride: usize,
}

/// Lights everything that is visible in a tile.
pub fn resolve<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    fragments: &mut Fragments,
    mixed: &mut Mixed,
    lit: &mut Lit<'_>,
    area: &Area<'_>,
    output: &mut Output<'_>,
) {
    resolve_opaque(simd, planes, mixed, lit, area, output);
    if fragments.any() {
        resolve_blended(simd, planes, fragments, lit, area, output);
    }
}

/// All pixels of a tile without blended surfaces.
#[simd]
fn resolve_opaque<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    mixed: &mut Mixed,
    lit: &mut Lit<'_>,
    area: &Area<'_>,
    output: &mut Output<'_>,
) {
    let mut rows = [(Vec4::ZERO, [0; 4]); TILE as usize];
    for (y, row) in (0..area.size[1]).zip(&mut rows) {
        let behind = premultiply((area.background)(area.tile[1] + y));
        *row = (behind, encode(behind));
    }
    // Column by column of eight pixels: the next row shows mostly the same triangles.
    for x in (0..area.size[0]).step_by(8) {
        let width = 8.min(area.size[0] - x) as usize;
        for (y, &(behind, encoded)) in (0..area.size[1]).zip(&rows) {
            let index = (y * TILE + x) as usize;
            let at = [area.tile[0] + x, area.tile[1] + y];
            let start = y as usize * output.stride + x as usize;
            let out = &mut output.color[start..start + width];
            let (whole, differs) = whole_pixels(simd, planes, index);
            resolve_eight(simd, out, &whole, lit, encoded, at);
            if differs != [0; 8] {
                add_mixed(simd, planes, index, &differs[..width], mixed, lit, behind, at);
            }
        }
    }
    Mixed::flush(simd, mixed, lit);
    for pixel in mixed.pixels.drain(..) {
        let (x, y) = (pixel as usize % TILE as usize, pixel as usize / TILE as usize);
        output.color[y * output.stride + x] = encode(mixed.sums[pixel as usize]);
    }
}

/// Of eight pixels in a row the item that they show at all samples, [`NO_ITEM`] where there is none;
/// and a number that is 0 only where all samples show the same.
#[inline(always)]
fn whole_pixels<S: Simd>(simd: S, planes: &[SamplePlane], index: usize) -> ([u32; 8], [u32; 8]) {
    let [first, mut differs] = planes[0].eight(simd, index);
    for plane in &planes[1..] {
        let [other, differs_there] = plane.eight(simd, index);
        differs |= differs_there | (first ^ other);
    }
    // All bits of NO_ITEM are set.
    let mixed: u32x8<S> = {
        let same = differs.simd_eq(u32x8::splat(simd, 0));
        same.select(first, u32x8::splat(simd, NO_ITEM))
    };
    (mixed.into(), differs.into())
}

/// Of eight pixels in a row, those that show one item at all samples.
#[inline(always)]
fn resolve_eight<S: Simd>(
    simd: S,
    out: &mut [[u8; 4]],
    whole: &[u32; 8],
    lit: &mut Lit<'_>,
    behind: [u8; 4],
    [x, y]: [i32; 2],
) {
    if *whole == [NO_ITEM; 8] {
        return out.fill(behind);
    }
    let mut colors = [[0.0; 8]; 4];
    Lit::colors_x8(simd, lit, whole, x, y, &mut colors);
    let encoded = encode_opaque_x8(simd, &colors);
    if whole.iter().all(|&item| item != NO_ITEM) {
        out.copy_from_slice(&encoded[..out.len()]);
        return;
    }
    for (i, out) in out.iter_mut().enumerate() {
        *out = if whole[i] != NO_ITEM { encoded[i] } else { behind };
    }
}

/// Of eight pixels in a row, those that show several items, or one and the background: each item is
/// lit once and weighted by its samples.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "one call, all of it a tile's state")]
fn add_mixed<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    index: usize,
    differs: &[u32],
    mixed: &mut Mixed,
    lit: &mut Lit<'_>,
    behind: Vec4,
    [x, y]: [i32; 2],
) {
    for i in (0..differs.len()).filter(|&i| differs[i] != 0) {
        let (pixel, at) = ((index + i) as u32, [x + i as i32, y]);
        mixed.begin(pixel);
        if let [plane] = planes
            && let Ok(items) = <&[u32; 4]>::try_from(plane.items(index + i))
        {
            add_shares(simd, items, mixed, lit, behind, pixel, at);
        } else {
            let (items, _) = sample_items(planes, index + i);
            add_shares(simd, &items, mixed, lit, behind, pixel, at);
        }
    }
}

/// Adds what each item, and the background, has of the samples of a pixel.
#[inline(always)]
fn add_shares<S: Simd, const N: usize>(
    simd: S,
    items: &[u32; N],
    mixed: &mut Mixed,
    lit: &mut Lit<'_>,
    behind: Vec4,
    pixel: u32,
    at: [i32; 2],
) {
    let mut left = (1u32 << N) - 1;
    while left != 0 {
        let item = items[left.trailing_zeros() as usize % N];
        let mut same = 0u32;
        for (i, other) in items.iter().enumerate() {
            same |= u32::from(*other == item) << i;
        }
        left &= !same;
        let weight = same.count_ones() as f32 * (1.0 / N as f32);
        if item == NO_ITEM {
            mixed.add_color(pixel, behind, weight);
        } else {
            mixed.add(simd, lit, item, pixel, weight, at);
        }
    }
}

/// The items at all samples of a pixel, and how many samples there are.
#[inline(always)]
pub(super) fn sample_items(planes: &[SamplePlane], pixel: usize) -> ([u32; MOST_SAMPLES], usize) {
    let (mut items, mut count) = ([NO_ITEM; MOST_SAMPLES], 0);
    for plane in planes {
        for &item in plane.items(pixel) {
            items[count] = item;
            count += 1;
        }
    }
    (items, count)
}
