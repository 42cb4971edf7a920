//! The fragments of a tile's blended triangles, sorted pixel by pixel.

use super::super::area::{LANES, place_of};
use super::super::rasterize::{FragmentTest, rasterize};
use super::super::tile::{MOST_LANES, SamplePlane, TILE_PIXELS};
use super::layers::LitLayers;
use crate::simd::lanes;
use crate::target::NO_ITEM;
use crate::visibility::surface::lit::Lit;
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, u32x16};
use fearless_simd_macros::simd;

/// A fragment of a blended surface.
#[derive(Debug, Clone, Copy, Default)]
pub struct Fragment {
    /// The place of its pixel: block by block.
    place: u32,
    item: u32,
    /// The least depth at its samples.
    depth: f32,
    /// Bit i: sample i is covered and not hidden.
    samples: u32,
}

/// Fragments that nothing opaque hides, before sorting.
pub struct FragmentList {
    pub list: Vec<Fragment>,
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

    /// Begins a tile at this place, without fragments.
    pub fn open(&mut self, tile: [i32; 2]) {
        self.list.clear();
        self.tile = tile;
    }

    /// Adds the fragments of a triangle, except where `layers` hide them.
    #[inline(always)]
    pub fn add<S: Simd>(
        &mut self,
        simd: S,
        t: &ScreenTriangle,
        layers: &LitLayers,
        planes: &mut [SamplePlane],
        area: [[i32; 2]; 2],
    ) {
        let mut open = Open { fragments: self, closed: &layers.closed };
        rasterize(simd, planes, area, std::iter::once(t), Some(&mut open));
    }

    /// Sorts the fragments of each pixel, near ones first; at equal depths the lower item, which is visible, comes
    /// first. Most of them are already in this order.
    fn sort(&mut self) {
        // Fragments are collected triangle by triangle, so fragments of one item at one pixel are consecutive.
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
        // The samples of one item at one pixel become one fragment. There may be several, because planes of samples are
        // rasterized one by one, and a pixel of a triangle may be visited twice.
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
    /// Records the fragments and lets nothing be written.
    #[inline(always)]
    fn pass<S: Simd>(
        &mut self,
        simd: S,
        write: S::i32s,
        t: &ScreenTriangle,
        [x, y]: [i32; 2],
        (first, shift): (usize, u32),
    ) -> S::i32s {
        let mut written = [0; MOST_LANES];
        let written = &mut written[..lanes::<S>()];
        write.store_slice(written);
        for (of_pixel, x) in written.chunks(1 << shift).zip(x..) {
            let mut samples = 0;
            for (i, sample) in of_pixel.iter().enumerate() {
                samples |= u32::from(*sample != 0) << (first + i);
            }
            if samples != 0 {
                self.add(t, [x, y], samples);
            }
        }
        S::i32s::splat(simd, 0)
    }
}

impl Open<'_> {
    /// Adds the fragment of a triangle at a pixel if the pixel is open.
    #[inline(always)]
    fn add(&mut self, t: &ScreenTriangle, [x, y]: [i32; 2], samples: u32) {
        let place = place_of(x, y);
        if self.closed[place] != 0 {
            return;
        }
        let (origin, tile) = (t.origin(), self.fragments.tile);
        let [dx, dy] = [(tile[0] + x - origin[0]) as f32, (tile[1] + y - origin[1]) as f32];
        let (mut depth, mut left) = (f32::INFINITY, samples);
        while left != 0 {
            let [ox, oy] = self.fragments.offsets[left.trailing_zeros() as usize];
            left &= left - 1;
            depth = depth.min(t.depth_at(dx + ox as f32 / 256.0, dy + oy as f32 / 256.0));
        }
        let (place, item) = (place as u32, t.item);
        self.fragments.list.push(Fragment { place, item, depth, samples });
    }
}

/// Lights the fragments nearer than `bound`, a lower bound of the depths still to come.
#[simd]
pub fn light_nearer<S: Simd>(
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
