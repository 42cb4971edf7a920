//! Blended surfaces of a tile: lit from near to far until almost nothing shows through, and laid over the opaque
//! surfaces from far to near.
//!
//! Fragments are collected until there are many, and sorted pixel by pixel; those that are nearer than all triangles to
//! come are lit.

mod fragments;
mod layers;
#[cfg(test)]
mod tests;

use super::area::{Area, LANES, block_at};
use super::tile::{SamplePlane, TILE, TILE_PIXELS, samples_of_block};
use crate::target::NO_ITEM;
use crate::visibility::surface::lit::{BlockSums, Lit, MOST_SAMPLES};
use crate::visibility::surface::points::patch::Patch;
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16, u32x16};
use fearless_simd_macros::simd;
use fragments::{FragmentList, light_nearer};
use layers::LitLayers;

/// Number of fragments collected before those nearer than all to come are lit.
const MANY: usize = if cfg!(test) { 64 } else { TILE_PIXELS };

/// The blended surfaces of a tile.
pub struct Blended {
    fragments: FragmentList,
    layers: LitLayers,
}

impl Blended {
    /// Creates the state for pixels with these samples.
    pub fn new(offsets: &'static [[i32; 2]]) -> Self {
        Self { fragments: FragmentList::new(offsets), layers: LitLayers::new(offsets.len()) }
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
    triangles: &[&ScreenTriangle],
    planes: &mut [SamplePlane],
    area: [[i32; 2]; 2],
    lit: &mut Lit<'_>,
) {
    let Blended { fragments, layers } = blended;
    layers.open(area);
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
