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
pub struct PixelItem(u32);

impl PixelItem {
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

/// The samples of a pixel that a small triangle covers.
#[derive(Debug, Clone, Copy)]
pub struct Sample<const N: usize> {
    pub at: PixelItem,
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

/// Depth test of the samples of a pixel.
trait DepthTest {
    /// The samples at which an item is visible.
    type Visible<S: Simd>;

    /// Tests and writes the depths of an item at a pixel; returns where it is visible, if anywhere. At equal depths the
    /// lower item wins, as in rasterization.
    fn test<S: Simd>(
        &self,
        simd: S,
        plane: &mut SamplePlane,
        pixel: usize,
        item: u32,
    ) -> Option<Self::Visible<S>>;

    /// Stores the normal of an item at a pixel for the samples at which it is visible.
    fn set_normal<S: Simd>(
        simd: S,
        known: &mut KnownNormals,
        at: (usize, Self::Visible<S>),
        item: u32,
        normal: [f32; 3],
    );
}

impl DepthTest for Sample<1> {
    type Visible<S: Simd> = ();

    #[inline(always)]
    fn test<S: Simd>(&self, _: S, plane: &mut SamplePlane, pixel: usize, item: u32) -> Option<()> {
        let [depth] = self.depth;
        let (nearest, of_nearest) = (&mut plane.depth[pixel], &mut plane.item[pixel]);
        let wins_ties = of_nearest.cast_signed().wrapping_sub(item.cast_signed()) >= 0;
        if depth < *nearest || depth == *nearest && wins_ties {
            (*nearest, *of_nearest) = (depth, item);
            return Some(());
        }
        None
    }

    #[inline(always)]
    fn set_normal<S: Simd>(
        _: S,
        known: &mut KnownNormals,
        (pixel, ()): (usize, ()),
        item: u32,
        normal: [f32; 3],
    ) {
        known.set(pixel, item, normal);
    }
}

impl DepthTest for Sample<4> {
    /// All bits set where it is visible.
    type Visible<S: Simd> = i32x4<S>;

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
        let tie_lost = !(depth - old) & ((old_item - item) >> 31u32);
        let write = !((old - depth) | tie_lost) >> 31u32;
        (old ^ ((old ^ depth) & write)).store_slice(stored);
        let new: u32x4<S> = (old_item ^ ((old_item ^ item) & write)).bitcast();
        new.store_slice(items);
        Some(write)
    }

    #[inline(always)]
    fn set_normal<S: Simd>(
        simd: S,
        known: &mut KnownNormals,
        at: (usize, i32x4<S>),
        item: u32,
        normal: [f32; 3],
    ) {
        known.set_four(simd, at, item, normal);
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
        draw_all(simd, &this.one, plane, known.as_deref_mut(), tile);
        draw_all(simd, &this.four, plane, known, tile);
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
fn draw_all<S: Simd, const N: usize>(
    simd: S,
    store: &Store<N>,
    plane: &mut SamplePlane,
    mut known: Option<&mut KnownNormals>,
    tile: u32,
) where
    Sample<N>: DepthTest,
{
    for (upper, block) in store.with_normals.of(tile) {
        for Fragment { normal, sample } in block {
            let (pixel, item) = sample.at.pixel_and_item(upper);
            if let Some(visible) = sample.test(simd, plane, pixel, item)
                && let Some(known) = known.as_deref_mut()
            {
                Sample::<N>::set_normal(simd, known, (pixel, visible), item, *normal);
            }
        }
    }
    for (upper, block) in store.samples.of(tile) {
        for sample in block {
            let (pixel, item) = sample.at.pixel_and_item(upper);
            sample.test(simd, plane, pixel, item);
        }
    }
}
