//! FragmentList of a tile's blended triangles that overlap in both area and depth range, sorted pixel by pixel.

use super::super::area::{LANES, place_of};
use super::super::rasterize::{FragmentTest, one_by_one, rasterize};
use super::super::tile::{SamplePlane, TILE_PIXELS};
use super::layers::LitLayers;
use crate::target::NO_ITEM;
use crate::visibility::surface::lit::Lit;
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, u32x16};
use fearless_simd_macros::simd;

/// A fragment of a blended surface.
#[derive(Debug, Clone, Copy, Default)]
struct Fragment {
    /// The place of its pixel: block by block.
    place: u32,
    item: u32,
    /// Depth at the first covered sample.
    depth: f32,
    /// Bit i: sample i is covered and not hidden.
    samples: u32,
}

/// Number of fragments collected before those known to be nearest are lit.
const MANY: usize = if cfg!(test) { 64 } else { 4 * TILE_PIXELS };

/// Number of triangles between tests whether surfaces behind are still visible at any pixel.
const AT_ONCE: usize = 8;

/// Lights the first triangles, at least `at_least`, and those whose depths overlap theirs, sorted pixel by pixel;
/// returns their number.
#[inline(always)]
pub fn light_sorted<S: Simd>(
    simd: S,
    fragments: &mut FragmentList,
    (triangles, at_least): (&[&ScreenTriangle], usize),
    layers: &mut LitLayers,
    planes: &mut [SamplePlane],
    area: [[i32; 2]; 2],
    lit: &mut Lit<'_>,
) -> usize {
    fragments.list.clear();
    fragments.tile = area[0];
    let (mut taken, mut farthest) = (0, f32::NEG_INFINITY);
    let mut limit = MANY;
    while taken < triangles.len() && !layers.hide_all(area[1]) {
        // The next triangles, as far as their depths overlap those collected.
        let mut part = 0;
        for t in triangles[taken..].iter().take(AT_ONCE) {
            if t.depth_min > farthest && taken + part >= at_least {
                break;
            }
            farthest = farthest.max(t.depth_max);
            part += 1;
        }
        if part == 0 {
            break;
        }
        let these = triangles[taken..taken + part].iter().copied();
        let mut open = Open { fragments, closed: &layers.closed };
        rasterize(simd, planes, area, these, Some(&mut open));
        taken += part;
        // If there are many, those nearer than all triangles to come are lit now.
        if let Some(next) = triangles.get(taken)
            && fragments.list.len() >= limit
        {
            light_nearer(simd, fragments, next.depth_min, layers, lit);
            limit = fragments.list.len() * 2 + MANY;
        }
    }
    light_nearer(simd, fragments, f32::INFINITY, layers, lit);
    taken
}

/// FragmentList that nothing opaque hides, before sorting.
pub struct FragmentList {
    list: Vec<Fragment>,
    /// Room for sorting.
    by_place: Vec<Fragment>,
    offsets: &'static [[i32; 2]],
    tile: [i32; 2],
}

impl FragmentList {
    /// Creates an empty list of fragments of pixels with these samples.
    pub fn new(offsets: &'static [[i32; 2]]) -> Self {
        Self { list: Vec::new(), by_place: Vec::new(), offsets, tile: [0; 2] }
    }

    /// Sorts the fragments of each pixel, near ones first; at equal depths the lower item, which is visible, comes
    /// first. Most of them are already in this order.
    fn sort(&mut self) {
        // FragmentList are collected triangle by triangle, so fragments of one item at one pixel are consecutive.
        let mut next = [0; TILE_PIXELS + 1];
        for f in &self.list {
            next[f.place as usize + 1] += 1;
        }
        for place in 0..TILE_PIXELS {
            next[place + 1] += next[place];
        }
        self.by_place.resize(self.list.len(), Fragment::default());
        for f in &self.list {
            let slot = &mut next[f.place as usize];
            self.by_place[*slot] = *f;
            *slot += 1;
        }
        std::mem::swap(&mut self.list, &mut self.by_place);
        // The samples of one item at one pixel become one fragment. Even with one sample there may be several entries,
        // because the rasterizer may visit a pixel of a triangle twice.
        self.list.dedup_by(|next, kept| {
            let same = (next.place, next.item) == (kept.place, kept.item);
            if same {
                kept.samples |= next.samples;
                kept.depth = kept.depth.min(next.depth);
            }
            same
        });
        for of_pixel in self.list.chunk_by_mut(|a, b| a.place == b.place) {
            of_pixel.sort_by(|a, b| a.depth.total_cmp(&b.depth).then(a.item.cmp(&b.item)));
        }
    }
}

/// Pixels in which fragments are collected because surfaces behind still show through.
struct Open<'a> {
    fragments: &'a mut FragmentList,
    /// Same as [`LitLayers::closed`].
    closed: &'a [u32],
}

impl FragmentTest for Open<'_> {
    /// Records the fragments and writes nothing.
    fn pass<S: Simd>(
        &mut self,
        simd: S,
        write: S::i32s,
        t: &ScreenTriangle,
        at: [i32; 2],
        (first, shift): (usize, u32),
    ) -> S::i32s {
        one_by_one(simd, write, at, shift, |x, y, sample| {
            let place = place_of(x, y);
            if self.closed[place] != 0 {
                return false;
            }
            let (origin, tile) = (t.origin(), self.fragments.tile);
            let sample = first + sample;
            let [ox, oy] = self.fragments.offsets[sample].map(|o| o as f32 / 256.0);
            let dx = (tile[0] + x - origin[0]) as f32 + ox;
            let dy = (tile[1] + y - origin[1]) as f32 + oy;
            self.fragments.list.push(Fragment {
                place: place as u32,
                item: t.item,
                depth: t.depth_at(dx, dy),
                samples: 1 << sample,
            });
            false
        })
    }
}

/// Lights the fragments nearer than `bound`, a lower bound of the depths still to come.
#[simd]
fn light_nearer<S: Simd>(
    simd: S,
    fragments: &mut FragmentList,
    bound: f32,
    layers: &mut LitLayers,
    lit: &mut Lit<'_>,
) {
    fragments.sort();
    let list = &mut fragments.list;
    for of_block in list.chunk_by(|a, b| a.place as usize / LANES == b.place as usize / LANES) {
        let block = of_block[0].place as usize / LANES;
        let mut pixels: [&[Fragment]; LANES] = [&[]; LANES];
        for of_pixel in of_block.chunk_by(|a, b| a.place == b.place) {
            let nearer = of_pixel.iter().take_while(|f| f.depth < bound).count();
            pixels[of_pixel[0].place as usize % LANES] = &of_pixel[..nearer];
        }
        for number in 0.. {
            let (mut items, mut samples) = ([NO_ITEM; LANES], [0; LANES]);
            let mut touched = false;
            for (lane, pixel) in pixels.iter().enumerate() {
                let open = layers.closed[block * LANES + lane] == 0;
                if let Some(fragment) = pixel.get(number).filter(|_| open) {
                    (items[lane], samples[lane]) = (fragment.item, fragment.samples);
                    touched = true;
                }
            }
            if !touched {
                break;
            }
            let samples = u32x16::from_slice(simd, &samples);
            layers.light(simd, block, u32x16::from_slice(simd, &items), samples, lit);
        }
    }
    list.retain(|f| f.depth >= bound && layers.closed[f.place as usize] == 0);
}
