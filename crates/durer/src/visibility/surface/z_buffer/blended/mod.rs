//! Blended surfaces of a tile: lit from near to far until almost nothing shows through, and laid over the opaque
//! surfaces from far to near.
//!
//! Triangles that do not overlap are lit in any order ([`Sheet`]). From the first ones on that overlap in both area and
//! depth range, fragments are collected and sorted pixel by pixel; if there are many, those that are nearer than all
//! triangles to come are lit.

mod fragments;
mod layers;
mod sheet;
#[cfg(test)]
mod tests;

use super::area::{Area, BLOCKS, LANES, block_at};
use super::rasterize::rasterize;
use super::tile::{SamplePlane, TILE, TILE_PIXELS, samples_of_block};
use crate::raster::fixed::HALF_PIXEL;
use crate::target::NO_ITEM;
use crate::visibility::surface::lit::{BlockSums, Lit, MOST_SAMPLES};
use crate::visibility::surface::points::patch::Patch;
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16, u32x16};
use fearless_simd_macros::simd;
use fragments::{FragmentList, light_nearer};
use layers::LitLayers;
use sheet::Sheet;

/// A sheet with more blocks is likely to be covered by the next large triangle.
const MANY_BLOCKS: usize = BLOCKS / 2;

/// Number of fragments collected before those nearer than all to come are lit.
const MANY: usize = if cfg!(test) { 64 } else { TILE_PIXELS };

/// The blended surfaces of a tile.
pub struct Blended {
    sheet: Sheet,
    fragments: FragmentList,
    layers: LitLayers,
}

impl Blended {
    /// Creates the state for pixels with these samples.
    pub fn new(offsets: &'static [[i32; 2]]) -> Self {
        Self {
            sheet: Sheet::new(offsets.len()),
            fragments: FragmentList::new(offsets),
            layers: LitLayers::new(offsets.len()),
        }
    }

    /// Begins another tile, with nothing lit.
    pub fn clear(&mut self) {
        self.layers.clear();
    }

    /// Returns whether anything is lit.
    pub fn any(&self) -> bool {
        self.layers.any()
    }
}

/// Lights the blended triangles of a tile, which come with the nearest first, until next to nothing comes through.
#[simd]
pub fn light_blended<S: Simd>(
    simd: S,
    blended: &mut Blended,
    mut triangles: &[&ScreenTriangle],
    planes: &mut [SamplePlane],
    area: [[i32; 2]; 2],
    lit: &mut Lit<'_>,
) {
    let Blended { sheet, fragments, layers } = blended;
    layers.open(area);
    while !triangles.is_empty() && !layers.hide_all(area[1]) {
        match light_sheet(simd, sheet, triangles, layers, planes, area, lit) {
            Some(taken) => triangles = &triangles[taken..],
            // If some overlap in depth, more of those behind do.
            None => return light_sorted(simd, fragments, triangles, layers, planes, area, lit),
        }
    }
}

/// Lights the first triangles up to the first overlap, if all others are behind them, and returns their number; otherwise
/// lights none.
#[inline(always)]
fn light_sheet<S: Simd>(
    simd: S,
    sheet: &mut Sheet,
    triangles: &[&ScreenTriangle],
    layers: &mut LitLayers,
    planes: &mut [SamplePlane],
    area: [[i32; 2]; 2],
    lit: &mut Lit<'_>,
) -> Option<usize> {
    sheet.clear();
    let (mut taken, mut farthest) = (0, f32::NEG_INFINITY);
    // The item that covers others; the rest of it is in the sheet.
    let mut over = NO_ITEM;
    for t in triangles {
        // A surface behind all of the sheet may begin another one: it does if it is likely to cover much of it.
        if t.depth_min > farthest && sheet.begun().len() > MANY_BLOCKS && is_large(t, area) {
            break;
        }
        rasterize(simd, planes, area, std::iter::once(*t), Some(&mut *sheet));
        if sheet.covers_another {
            // A part of an item that was cut may be among the others.
            let in_parts = || triangles[..taken].iter().any(|other| other.item == t.item);
            if t.depth_min <= farthest || in_parts() {
                return None;
            }
            over = t.item;
            break;
        }
        farthest = farthest.max(t.depth_max);
        taken += 1;
    }
    let over = u32x16::splat(simd, over);
    let none = u32x16::splat(simd, NO_ITEM);
    let mut samples = [none; MOST_SAMPLES];
    let samples = &mut samples[..layers.count];
    for &block in sheet.begun() {
        let block = block as usize;
        sheet.block(simd, block, samples);
        for items in samples.iter_mut() {
            *items = items.simd_eq(over).select(none, *items);
        }
        // One of the pixel's items at a time; there are at most as many items as samples.
        for _ in 0..layers.count {
            let mut items = none;
            for of_sample in samples.iter() {
                items = items.simd_eq(none).select(*of_sample, items);
            }
            if items.simd_eq(none).all_true() {
                break;
            }
            let mut covered = u32x16::splat(simd, 0);
            for (i, of_sample) in samples.iter_mut().enumerate() {
                let same = of_sample.simd_eq(items);
                covered |= same.select(u32x16::splat(simd, 1 << i), u32x16::splat(simd, 0));
                *of_sample = same.select(none, *of_sample);
            }
            layers.light(simd, block, items, covered, lit);
        }
    }
    Some(taken)
}

/// Returns whether the box of a triangle takes more than a quarter of a tile.
fn is_large(t: &ScreenTriangle, [tile, size]: [[i32; 2]; 2]) -> bool {
    let reach = HALF_PIXEL;
    t.pixel_bounds(reach).is_some_and(|[x0, y0, x1, y1]| {
        let across = (x1 - tile[0]).min(size[0] - 1) - (x0 - tile[0]).max(0);
        let down = (y1 - tile[1]).min(size[1] - 1) - (y0 - tile[1]).max(0);
        across.max(0) * down.max(0) > TILE_PIXELS as i32 / 4
    })
}

/// Lights all triangles, sorted pixel by pixel.
#[inline(always)]
fn light_sorted<S: Simd>(
    simd: S,
    fragments: &mut FragmentList,
    triangles: &[&ScreenTriangle],
    layers: &mut LitLayers,
    planes: &mut [SamplePlane],
    area: [[i32; 2]; 2],
    lit: &mut Lit<'_>,
) {
    fragments.open(area[0]);
    let mut limit = MANY;
    for t in triangles {
        if fragments.list.len() >= limit {
            light_nearer(simd, fragments, t.depth_min, layers, lit);
            if layers.hide_all(area[1]) {
                return;
            }
            // Those left overlap many others in depth.
            limit = fragments.list.len() * 2 + MANY;
        }
        fragments.add(simd, t, layers, planes, area);
    }
    light_nearer(simd, fragments, f32::INFINITY, layers, lit);
}

/// Lays the lit surfaces over the opaque ones and the background, and puts the colours of pixels that have any into
/// `sums`.
#[simd]
pub fn lay_over<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    blended: &Blended,
    lit: &mut Lit<'_>,
    area: &Area,
    sums: &mut [BlockSums],
) {
    let layers = &blended.layers;
    let mut under = [[f32x16::splat(simd, 0.0); 4]; MOST_SAMPLES];
    let under = &mut under[..layers.count];
    for (block, &(_, touched)) in layers.farthest.iter().enumerate() {
        // Blocks without blended surfaces keep their colours.
        if touched == 0 {
            continue;
        }
        behind_block(simd, planes, block, lit, area, under);
        layers.lay_over(simd, block, under);
        // The pixel is the mean of its samples.
        let mut means = [f32x16::splat(simd, 0.0); 4];
        for colors in under.iter() {
            for (sum, color) in means.iter_mut().zip(colors) {
                *sum += *color;
            }
        }
        // The number of samples is a power of two, so this is exact.
        let share = 1.0 / layers.count as f32;
        let touched = mask32x16::from_bitmask(simd, touched.into());
        for (to, mean) in sums[block].0.iter_mut().zip(means) {
            touched.select(mean * share, f32x16::from_slice(simd, to)).store_slice(to);
        }
    }
}

/// Finds the colours behind the blended surfaces at each sample of a block; each item is lit once.
#[inline(always)]
fn behind_block<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    block: usize,
    lit: &mut Lit<'_>,
    area: &Area,
    colors: &mut [[f32x16<S>; 4]],
) {
    let [x, y] = block_at(block);
    let patch = Patch::block([area.tile[0] + x, area.tile[1] + y]);
    let (none, behind) = (u32x16::splat(simd, NO_ITEM), area.behind(simd, block));
    let mut shown = [none; MOST_SAMPLES];
    // The items at each sample of the block.
    let shown = samples_of_block(simd, planes, (y * TILE + x) as usize, &mut shown);
    // Samples that show the same item at the same pixel as an earlier one copy its colour.
    for i in 0..colors.len() {
        colors[i] = behind;
        let items = shown[i];
        let mut left = items;
        let (earlier, here) = colors.split_at_mut(i);
        for (earlier, shown) in earlier.iter().zip(shown) {
            let same = items.simd_eq(*shown);
            left = same.select(none, left);
            for (to, from) in here[0].iter_mut().zip(earlier) {
                *to = same.select(*from, *to);
            }
        }
        // The remaining ones are lit.
        let unlit = left.simd_ne(none);
        if unlit.any_true() {
            let mut shaded = [[0.0; LANES]; 4];
            Lit::colors_x16(simd, lit, left, patch, &mut shaded);
            shaded[3] = [1.0; LANES];
            for (to, shaded) in colors[i].iter_mut().zip(&shaded) {
                *to = unlit.select(f32x16::from_slice(simd, shaded), *to);
            }
        }
    }
}
