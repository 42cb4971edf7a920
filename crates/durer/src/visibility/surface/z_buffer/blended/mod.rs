//! Blended surfaces of a tile: lit from near to far until almost nothing shows through, and laid over the opaque
//! surfaces from far to near.
//!
//! Triangles that do not overlap are lit in any order ([`Sheet`]); if they overlap and their depth ranges do too, their
//! fragments are collected and sorted pixel by pixel.

mod fragments;
mod layers;
mod sheet;
#[cfg(test)]
mod tests;

use super::area::{Area, Codes};
use super::rasterize::rasterize;
use super::tile::{SamplePlane, TILE, TILE_PIXELS, block_of};
use crate::math::Vec4;
use crate::raster::fixed::HALF_PIXEL;
use crate::shade::color::{encode_opaque_x16, encode_premultiplied, premultiply};
use crate::target::NO_ITEM;
use crate::visibility::surface::lit::{Lit, MOST_SAMPLES, opaque};
use crate::visibility::surface::points::patch::Patch;
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};
use fearless_simd_macros::simd;
use fragments::{FragmentList, light_sorted};
use layers::LitLayers;
use sheet::Sheet;

/// Pixels of a block: eight in a row, and the eight below them.
const LANES: usize = 16;

/// Blocks of a tile.
const BLOCKS: usize = TILE_PIXELS / LANES;

/// Blocks beside each other.
const BLOCKS_ACROSS: usize = TILE as usize / 8;

/// A sheet with more blocks is likely to be covered by the next large triangle.
const MANY_BLOCKS: usize = BLOCKS / 2;

/// Returns the upper left pixel of a block, tile-local.
#[inline(always)]
fn block_at(block: usize) -> [i32; 2] {
    [(block % BLOCKS_ACROSS * 8) as i32, (block / BLOCKS_ACROSS * 2) as i32]
}

/// Returns the place of a tile-local pixel: its block times 16 and its lane.
#[inline(always)]
fn place_of(x: i32, y: i32) -> usize {
    let block = y / 2 * (TILE / 8) + x / 8;
    (block * LANES as i32 + y % 2 * 8 + x % 8) as usize % TILE_PIXELS
}

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
        let taken = match light_sheet(simd, sheet, triangles, layers, planes, area, lit) {
            Ok(taken) => taken,
            Err(tried) => {
                light_sorted(simd, fragments, (triangles, tried), layers, planes, area, lit)
            }
        };
        triangles = &triangles[taken..];
    }
}

/// Lights the first triangles up to the first overlap if all others are behind them, and returns their number;
/// otherwise lights none and returns the number of triangles examined.
#[inline(always)]
fn light_sheet<S: Simd>(
    simd: S,
    sheet: &mut Sheet,
    triangles: &[&ScreenTriangle],
    layers: &mut LitLayers,
    planes: &mut [SamplePlane],
    area: [[i32; 2]; 2],
    lit: &mut Lit<'_>,
) -> Result<usize, usize> {
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
                return Err(taken + 1);
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
    Ok(taken)
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

/// Composes the lit surfaces over the background, block by block.
#[simd]
pub fn resolve_blended<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    blended: &Blended,
    lit: &mut Lit<'_>,
    area: &Area<'_>,
    codes: &mut Codes,
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
        let mut sums = [f32x16::splat(simd, 0.0); 4];
        for colors in under.iter() {
            for (sum, color) in sums.iter_mut().zip(colors) {
                *sum += *color;
            }
        }
        // The number of samples is a power of two, so this is exact.
        let mut mean = [[0.0; LANES]; 4];
        for (to, sum) in mean.iter_mut().zip(sums) {
            (sum * (1.0 / layers.count as f32)).store_slice(to);
        }
        // Opaque pixels are encoded together, the others one by one.
        let opaque: [u32; LANES] = encode_opaque_x16(simd, opaque(simd, &mean)).into();
        let [x, y] = block_at(block);
        for lane in (0..LANES).filter(|lane| touched >> lane & 1 == 1) {
            let [r, g, b, a] = &mean;
            let code = if a[lane] >= 1.0 {
                opaque[lane]
            } else {
                u32::from_le_bytes(encode_premultiplied(Vec4::new(
                    r[lane], g[lane], b[lane], a[lane],
                )))
            };
            let (x, y) = (x as usize + lane % 8, y as usize + lane / 8);
            codes[y * TILE as usize + x] = code;
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
    area: &Area<'_>,
    colors: &mut [[f32x16<S>; 4]],
) {
    let [x, y] = block_at(block);
    let at = [area.tile[0] + x, area.tile[1] + y];
    let patch = Patch::block(at);
    // The last row may have no row below.
    let below = (y + 1).min(area.size[1] - 1) + area.tile[1];
    let above = premultiply((area.background)(at[1])).to_array();
    let below = premultiply((area.background)(below)).to_array();
    let mut behind = [f32x16::splat(simd, 0.0); 4];
    for (i, behind) in behind.iter_mut().enumerate() {
        *behind = simd.combine_f32x8(simd.splat_f32x8(above[i]), simd.splat_f32x8(below[i]));
    }
    let none = u32x16::splat(simd, NO_ITEM);
    let mut shown = [none; MOST_SAMPLES];
    // The items at each sample of the block.
    for plane in planes {
        let samples = &mut shown[plane.first..plane.first + (1 << plane.shift)];
        block_of(simd, &plane.item, (y * TILE + x) as usize, samples);
    }
    // Samples that show the same item at the same pixel as an earlier one copy its colour.
    for i in 0..colors.len() {
        colors[i] = behind;
        let items = shown[i];
        let mut left = items;
        let (earlier, here) = colors.split_at_mut(i);
        for (earlier, shown) in earlier.iter().zip(&shown) {
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
