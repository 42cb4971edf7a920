//! The fragments of small triangles: depths at the samples of a pixel that they cover, mostly with
//! a normal.

use super::tiles::{ITEM_BITS, LOW_BITS, Tiles};
use crate::visibility::surface::lit::KnownNormals;
use crate::visibility::surface::z_buffer::tile::SamplePlane;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x4, u32x4};
use fearless_simd_macros::simd;

/// Bits of a depth where a sample is not covered: no depth is farther.
pub const UNCOVERED: i32 = i32::MAX;

/// A pixel of a tile, with the lower bits of an item.
#[derive(Debug, Clone, Copy)]
pub struct Seen(u32);

impl Seen {
    /// Creates the entry of an item at a place on the screen, as returned by [`super::place`].
    #[inline(always)]
    pub fn new(place: u32, item: u32) -> Self {
        Self((place << ITEM_BITS) | (item & LOW_BITS))
    }

    /// Returns the pixel in its tile, and the item, whose upper bits its block knows.
    #[inline(always)]
    pub fn pixel_and_item(self, upper: u32) -> (usize, u32) {
        ((self.0 >> ITEM_BITS) as usize, upper | (self.0 & LOW_BITS))
    }
}

/// Fragment that can be drawn into a tile.
trait Draw {
    /// Tests and writes depths, and in `known` the normal where the fragment is visible. `upper` has the upper bits of
    /// the block's items.
    fn draw<S: Simd>(
        &self,
        simd: S,
        plane: &mut SamplePlane,
        upper: u32,
        known: Option<&mut KnownNormals>,
    );
}

/// The samples of a pixel that a small triangle covers.
#[derive(Debug, Clone, Copy)]
pub struct Sample<const N: usize> {
    pub seen: Seen,
    /// The bits of its depths, by sample.
    pub depth: [i32; N],
}

/// The same with a normal.
#[derive(Debug, Clone, Copy)]
pub struct Fragment<const N: usize> {
    /// The normal of the visible side, of any length; NaN if it is computed on demand.
    pub normal: [f32; 3],
    pub sample: Sample<N>,
}

impl Sample<1> {
    /// Tests and writes the depth of an item at a pixel of one sample; returns whether it is seen.
    #[inline(always)]
    fn test(&self, plane: &mut SamplePlane, pixel: usize, item: u32) -> bool {
        let [depth] = self.depth;
        let (nearest, of_nearest) = (&mut plane.depth[pixel], &mut plane.item[pixel]);
        // At equal depths the lower item wins, as in rasterization.
        let wins_ties = of_nearest.cast_signed().wrapping_sub(item.cast_signed()) >= 0;
        let seen = depth < *nearest || depth == *nearest && wins_ties;
        if seen {
            (*nearest, *of_nearest) = (depth, item);
        }
        seen
    }
}

impl Sample<4> {
    /// Tests and writes the depths of an item at a pixel of four samples; returns all bits set where it is visible.
    #[inline(always)]
    fn test<S: Simd>(
        &self,
        simd: S,
        plane: &mut SamplePlane,
        pixel: usize,
        item: u32,
    ) -> Option<i32x4<S>> {
        let first = 4 * pixel;
        let stored = &mut plane.depth[first..first + 4];
        let (old, depth) = (i32x4::from_slice(simd, stored), i32x4::from_slice(simd, &self.depth));
        if !depth.simd_le(old).any_true() {
            return None;
        }
        let items = &mut plane.item[first..first + 4];
        let old_item: i32x4<S> = u32x4::from_slice(simd, items).bitcast();
        let item = item.cast_signed();
        // As in rasterization, the lower item wins at equal depths.
        let tie_lost = !(depth - old) & ((old_item - item) >> 31u32);
        let write = !((old - depth) | tie_lost) >> 31u32;
        (old ^ ((old ^ depth) & write)).store_slice(stored);
        let new: u32x4<S> = (old_item ^ ((old_item ^ item) & write)).bitcast();
        new.store_slice(items);
        Some(write)
    }
}

impl Draw for Sample<1> {
    #[inline(always)]
    fn draw<S: Simd>(
        &self,
        _: S,
        plane: &mut SamplePlane,
        upper: u32,
        _: Option<&mut KnownNormals>,
    ) {
        let (pixel, item) = self.seen.pixel_and_item(upper);
        self.test(plane, pixel, item);
    }
}

impl Draw for Sample<4> {
    #[inline(always)]
    fn draw<S: Simd>(
        &self,
        simd: S,
        plane: &mut SamplePlane,
        upper: u32,
        _: Option<&mut KnownNormals>,
    ) {
        let (pixel, item) = self.seen.pixel_and_item(upper);
        self.test(simd, plane, pixel, item);
    }
}

impl Draw for Fragment<1> {
    #[inline(always)]
    fn draw<S: Simd>(
        &self,
        _: S,
        plane: &mut SamplePlane,
        upper: u32,
        known: Option<&mut KnownNormals>,
    ) {
        let (pixel, item) = self.sample.seen.pixel_and_item(upper);
        if self.sample.test(plane, pixel, item)
            && let Some(known) = known
        {
            known.set(pixel, item, self.normal);
        }
    }
}

impl Draw for Fragment<4> {
    #[inline(always)]
    fn draw<S: Simd>(
        &self,
        simd: S,
        plane: &mut SamplePlane,
        upper: u32,
        known: Option<&mut KnownNormals>,
    ) {
        let (pixel, item) = self.sample.seen.pixel_and_item(upper);
        if let Some(seen) = self.sample.test(simd, plane, pixel, item)
            && let Some(known) = known
        {
            known.set_four(simd, (pixel, seen), item, self.normal);
        }
    }
}

/// Fragments of small triangles in pixels of this number of samples.
#[derive(Default)]
pub struct Store<const N: usize> {
    /// Fragments with normals.
    pub with_normals: Tiles<Fragment<N>>,
    /// The others.
    pub samples: Tiles<Sample<N>>,
}

impl<const N: usize> Store<N> {
    fn have(&mut self, tiles: usize) {
        self.with_normals.have(tiles);
        self.samples.have(tiles);
    }

    fn bytes(&self) -> u64 {
        self.with_normals.bytes() + self.samples.bytes()
    }

    fn nothing_in(&self, tile: u32) -> bool {
        self.with_normals.nothing_in(tile) && self.samples.nothing_in(tile)
    }
}

/// Fragments of small triangles.
#[derive(Default)]
pub struct Fragments {
    /// Fragments in pixels of one sample.
    pub one: Store<1>,
    /// Fragments in pixels of four samples.
    pub four: Store<4>,
}

impl Fragments {
    /// Makes room for this many tiles, of pixels with one or four samples.
    pub fn have(&mut self, tiles: usize, samples: usize) {
        if samples == 1 { self.one.have(tiles) } else { self.four.have(tiles) }
    }

    /// Draws the fragments of a tile; stores the normals of visible ones in `known`.
    #[simd]
    pub fn draw<S: Simd>(
        simd: S,
        this: &Self,
        plane: &mut SamplePlane,
        mut known: Option<&mut KnownNormals>,
        tile: u32,
    ) {
        draw_all(simd, &this.one.with_normals, plane, known.as_deref_mut(), tile);
        draw_all(simd, &this.one.samples, plane, None, tile);
        draw_all(simd, &this.four.with_normals, plane, known, tile);
        draw_all(simd, &this.four.samples, plane, None, tile);
    }

    /// Returns the memory of the fragments in bytes.
    pub fn bytes(&self) -> u64 {
        self.one.bytes() + self.four.bytes()
    }

    /// Returns whether a tile has no fragments.
    pub fn nothing_in(&self, tile: u32) -> bool {
        self.one.nothing_in(tile) && self.four.nothing_in(tile)
    }
}

#[inline(always)]
fn draw_all<S: Simd, T: Draw>(
    simd: S,
    tiles: &Tiles<T>,
    plane: &mut SamplePlane,
    mut known: Option<&mut KnownNormals>,
    tile: u32,
) {
    for (upper, block) in tiles.of(tile) {
        for thing in block {
            thing.draw(simd, plane, upper, known.as_deref_mut());
        }
    }
}
