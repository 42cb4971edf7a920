//! Triangles that are sampled while they are set up: what is left of each, a fragment or two with its depth and
//! normal, is kept instead of the triangle.
//!
//! That a normal is found for what may turn out to be hidden costs less than to read the triangle again where it shows:
//! here its vertices have just been read.
//!
//! Source: see [`Sampled`]. Cost: O(1) for each triangle.

#[cfg(test)]
mod tests;

use super::bins::TileGrid;
use super::tile::{SamplePlane, TILE};
use crate::visibility::surface::gather::four_rows;
use crate::visibility::surface::lit::KnownNormals;
use crate::visibility::surface::setup::{EIGHT, PIXELS, Sampled, place_in_box};
use crate::visibility::surface::triangles::{Read, RunNormals};
use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x4, f32x8, i32x8, u32x4, u32x8};
use fearless_simd_macros::simd;

/// Bits of a pixel's place in its tile.
const PIXEL_BITS: u32 = 2 * TILE.trailing_zeros();

/// Screens of more tiles have places that do not fit 32 bits; nothing is sampled there before its time.
pub const MOST_TILES: u32 = 1 << (32 - PIXEL_BITS);

/// Bits of an item's number that are kept with a sample of it; the items of a block have the others in common.
const ITEM_BITS: u32 = 32 - PIXEL_BITS;

/// The bits of an item's number that are kept with its samples.
const LOW_BITS: u32 = (1 << ITEM_BITS) - 1;

/// A pixel of a tile, and in the lower bits those of an item.
#[derive(Debug, Clone, Copy)]
struct Seen(u32);

impl Seen {
    /// An item at a place on the screen, as of [`place`].
    #[inline(always)]
    fn new(place: u32, item: u32) -> Self {
        Self((place << ITEM_BITS) | (item & LOW_BITS))
    }

    /// The pixel in its tile, and the item; its block knows the upper bits.
    #[inline(always)]
    fn pixel_and_item(self, upper: u32) -> (usize, u32) {
        ((self.0 >> ITEM_BITS) as usize, upper | (self.0 & LOW_BITS))
    }
}

/// Depth test and write of an item at a pixel of a tile; whether it is seen.
#[inline(always)]
fn draw(plane: &mut SamplePlane, pixel: usize, depth: f32, item: u32) -> bool {
    let depth = depth.to_bits().cast_signed();
    let (nearest, of_nearest) = (&mut plane.depth[pixel], &mut plane.item[pixel]);
    // At equal depths the lower item wins, as where triangles are rasterized.
    let wins_ties = of_nearest.cast_signed().wrapping_sub(item.cast_signed()) >= 0;
    let seen = depth < *nearest || depth == *nearest && wins_ties;
    if seen {
        (*nearest, *of_nearest) = (depth, item);
    }
    seen
}

/// A sample that a small triangle covers.
#[derive(Debug, Clone, Copy)]
struct Sample {
    seen: Seen,
    depth: f32,
}

impl Sample {
    /// Depth test and write; the block's items have these upper bits.
    #[inline(always)]
    fn draw(&self, plane: &mut SamplePlane, upper: u32) {
        let (pixel, item) = self.seen.pixel_and_item(upper);
        draw(plane, pixel, self.depth, item);
    }
}

/// A sample with its normal.
#[derive(Debug, Clone, Copy)]
struct Fragment {
    /// The normal of the side that is seen, of any length, NaN where it is to be found when it is asked for; and the depth.
    found: [f32; 4],
    seen: Seen,
}

impl Fragment {
    /// Depth test and write; in `known` its normal. The block's items have these upper bits.
    #[inline(always)]
    fn draw(&self, plane: &mut SamplePlane, upper: u32, known: Option<&mut KnownNormals>) {
        let (pixel, item) = self.seen.pixel_and_item(upper);
        if draw(plane, pixel, self.found[3], item)
            && let Some(known) = known
        {
            known.set(pixel, item, self.found);
        }
    }
}

/// Things by the tiles that they are in, in blocks that stay where they are.
struct Tiles<T> {
    by_tile: Vec<Blocks<T>>,
    /// Things that the blocks have room for.
    room: usize,
}

/// What is in one tile.
struct Blocks<T> {
    /// Where the next comes to; full or without room when there is none.
    open: Vec<T>,
    /// The upper bits of items there.
    upper: u32,
    /// Those before, with the upper bits of their items.
    full: Vec<(u32, Vec<T>)>,
}

/// The least and the most that a block holds: each next one four times as much.
const BLOCK: [usize; 2] = [32, 2048];

impl<T> Default for Tiles<T> {
    fn default() -> Self {
        Self { by_tile: Vec::new(), room: 0 }
    }
}

impl<T> Tiles<T> {
    #[inline(always)]
    fn push(&mut self, place: u32, item: u32, thing: T) {
        let tile = &mut self.by_tile[(place >> PIXEL_BITS) as usize];
        let upper = item & !LOW_BITS;
        if tile.open.len() == tile.open.capacity() || tile.upper != upper {
            self.room += tile.open_next(upper);
        }
        tile.open.push(thing);
    }

    /// What all blocks take, bytes.
    fn bytes(&self) -> u64 {
        (self.room * size_of::<T>() + self.by_tile.capacity() * size_of::<Blocks<T>>()) as u64
    }

    /// What is in a tile, block by block, with the upper bits of its items.
    fn of(&self, tile: u32) -> impl Iterator<Item = (u32, &[T])> + '_ {
        self.by_tile.get(tile as usize).into_iter().flat_map(|Blocks { full, open, upper }| {
            let full = full.iter().map(|(upper, block)| (*upper, block.as_slice()));
            full.chain([(*upper, open.as_slice())])
        })
    }

    /// Whether there is nothing in a tile.
    fn nothing_in(&self, tile: u32) -> bool {
        self.by_tile.get(tile as usize).is_none_or(|of_tile| of_tile.open.is_empty())
    }
}

impl<T> Default for Blocks<T> {
    fn default() -> Self {
        Self { open: Vec::new(), upper: 0, full: Vec::new() }
    }
}

impl<T> Blocks<T> {
    /// Opens a block, and returns how much room it has.
    #[cold]
    fn open_next(&mut self, upper: u32) -> usize {
        let [least, most] = BLOCK;
        let size = (4 * self.open.len()).clamp(least, most);
        let full = std::mem::replace(&mut self.open, Vec::with_capacity(size));
        let of_full = std::mem::replace(&mut self.upper, upper);
        if !full.is_empty() {
            self.full.push((of_full, full));
        }
        size
    }
}

/// What small triangles leave.
#[derive(Default)]
pub struct Fragments {
    /// Where normals were made.
    with_normals: Tiles<Fragment>,
    /// The others.
    samples: Tiles<Sample>,
}

impl Fragments {
    /// Draws those in a tile; in `known` the normals of what is seen.
    pub fn draw(&self, plane: &mut SamplePlane, mut known: Option<&mut KnownNormals>, tile: u32) {
        for (upper, block) in self.with_normals.of(tile) {
            for fragment in block {
                fragment.draw(plane, upper, known.as_deref_mut());
            }
        }
        for (upper, block) in self.samples.of(tile) {
            block.iter().for_each(|sample| sample.draw(plane, upper));
        }
    }

    /// What they take, bytes.
    pub fn bytes(&self) -> u64 {
        self.with_normals.bytes() + self.samples.bytes()
    }

    /// Whether there are none in a tile.
    pub fn nothing_in(&self, tile: u32) -> bool {
        self.with_normals.nothing_in(tile) && self.samples.nothing_in(tile)
    }
}

/// Small triangles that wait until there are eight.
#[derive(Default)]
struct Queue {
    count: usize,
    items: [u32; EIGHT],
    /// What their normals are found from, where they are asked for.
    read: Read,
    /// As in [`Sampled`].
    first: [[i32; EIGHT]; 2],
    covered: [u32; EIGHT],
    origin: [[i32; EIGHT]; 2],
    depth: [[f32; EIGHT]; 5],
}

impl Queue {
    /// Adds one of eight triangles where there is room.
    #[inline(always)]
    fn push(
        &mut self,
        normals: Option<&RunNormals<'_>>,
        (sampled, lane): (&Sampled, usize),
        (item, corners): (u32, [u32; 3]),
    ) {
        let to = self.count % EIGHT;
        self.items[to] = item;
        if let Some(normals) = normals {
            normals.read(to, corners, &mut self.read);
        }
        self.covered[to] = sampled.covered[lane];
        for axis in 0..2 {
            self.first[axis][to] = sampled.first[axis][lane];
            self.origin[axis][to] = sampled.origin[axis][lane];
        }
        for (of_all, of_eight) in self.depth.iter_mut().zip(&sampled.depth) {
            of_all[to] = of_eight[lane];
        }
        self.count += 1;
    }

    /// Makes fragments of all.
    #[simd]
    fn make<S: Simd>(
        simd: S,
        this: &mut Self,
        normals: Option<&RunNormals<'_>>,
        columns: i32,
        fragments: &mut Fragments,
    ) {
        let count = std::mem::take(&mut this.count);
        this.covered[count..].fill(0);
        let lines = this.lines(simd, normals);
        let (halves, _) = this.covered.as_chunks::<{ EIGHT / 2 }>();
        for (half, covered) in halves.iter().enumerate() {
            // Which pixels of which triangles, one after the other: so many in one loop, for where it ends is not foreseen.
            let mut left = 0;
            for (i, &covered) in covered.iter().enumerate() {
                left |= u64::from(covered) << (PIXELS * i);
            }
            while left != 0 {
                let at = left.trailing_zeros() as usize;
                left &= left - 1;
                let (lane, pixel) = (EIGHT / 2 * half + at / PIXELS, at % PIXELS);
                let lane = lane % EIGHT;
                let found = lines.at(simd, lane, pixel);
                let [column, row] = place_in_box(pixel);
                let place = place(this.first[0][lane] + column, this.first[1][lane] + row, columns);
                let item = this.items[lane];
                let seen = Seen::new(place, item);
                if normals.is_some() {
                    fragments.with_normals.push(place, item, Fragment { found, seen });
                } else {
                    fragments.samples.push(place, item, Sample { seen, depth: found[3] });
                }
            }
        }
    }

    /// What the normals of eight triangles and their depths are found by.
    #[inline(always)]
    fn lines<S: Simd>(&self, simd: S, normals: Option<&RunNormals<'_>>) -> Lines {
        let [first_x, first_y] = &self.first;
        let first = [i32x8::from_slice(simd, first_x), i32x8::from_slice(simd, first_y)];
        let none = f32x8::splat(simd, 0.0);
        let [depth, depth_dx, depth_dy, least, largest] = &self.depth;
        let depths = [depth, depth_dx, depth_dy].map(|of| f32x8::from_slice(simd, of));
        let mut from = [[none; 2]; 2];
        for (axis, from) in from.iter_mut().enumerate() {
            from[1] = simd.cvt_f32_i32x8(first[axis] - i32x8::from_slice(simd, &self.origin[axis]));
        }
        let (mut planes, mut unknown) = ([[none; 3]; 3], [0; EIGHT]);
        if let Some(normals) = normals {
            let of_normals = normals.planes(simd, &self.read);
            for (axis, from) in from.iter_mut().enumerate() {
                from[0] = simd.cvt_f32_i32x8(first[axis] - of_normals.origins[axis]);
            }
            planes = of_normals.planes;
            let nan = u32x8::splat(simd, f32::NAN.to_bits());
            of_normals.settled.select(u32x8::splat(simd, 0), nan).store_slice(&mut unknown);
        }
        let [[x, x_of_depth], [y, y_of_depth]] = from;
        let [[a, b, c], [d, e, f], [g, h, i]] = planes;
        Lines {
            from: [four_rows(simd, [x, x, x, x_of_depth]), four_rows(simd, [y, y, y, y_of_depth])],
            planes: [
                four_rows(simd, [a, b, c, depths[0]]),
                four_rows(simd, [d, e, f, depths[1]]),
                four_rows(simd, [g, h, i, depths[2]]),
            ],
            within: [*least, *largest],
            unknown,
        }
    }
}

/// By what the normals of eight triangles and their depths are found, row by row; the fourth number of each is the depth's.
struct Lines {
    /// Where the boxes begin, counted from where the planes' constants are.
    from: [[[f32; 4]; EIGHT]; 2],
    /// Constants, changes along x and along y.
    planes: [[[f32; 4]; EIGHT]; 3],
    /// The least and the largest depths.
    within: [[f32; EIGHT]; 2],
    /// Bits that are set in normals that are not settled.
    unknown: [u32; EIGHT],
}

impl Lines {
    /// The normal and the depth of a triangle at a pixel of its box: bit for bit as they are found elsewhere.
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, lane: usize, pixel: usize) -> [f32; 4] {
        let [column, row] = place_in_box(pixel);
        let x = f32x4::from_slice(simd, &self.from[0][lane]) + column as f32;
        let y = f32x4::from_slice(simd, &self.from[1][lane]) + row as f32;
        let [constant, dx, dy] = &self.planes;
        let (dx, dy) = (f32x4::from_slice(simd, &dx[lane]), f32x4::from_slice(simd, &dy[lane]));
        let found = dx * x + dy * y + f32x4::from_slice(simd, &constant[lane]);
        let [least, largest] = &self.within;
        let (low, high) = (f32::NEG_INFINITY, f32::INFINITY);
        let least: f32x4<S> = [low, low, low, least[lane]].simd_into(simd);
        let largest: f32x4<S> = [high, high, high, largest[lane]].simd_into(simd);
        let unknown: u32x4<S> = [self.unknown[lane], 0, 0, 0].simd_into(simd);
        let found = found.max(least).min(largest).bitcast::<u32x4<S>>() | unknown;
        found.bitcast::<f32x4<S>>().into()
    }
}

/// Makes fragments of small triangles.
pub struct Micropolygons<'f> {
    /// Those whose fronts are seen.
    fronts: Queue,
    /// The others: mostly hidden, so nobody asks for their normals.
    backs: Queue,
    fragments: &'f mut Fragments,
    /// Tiles in a row of the screen.
    columns: i32,
}

impl<'f> Micropolygons<'f> {
    /// For a screen.
    pub fn new(screen: TileGrid, fragments: &'f mut Fragments) -> Self {
        let tiles = screen.count() as usize;
        fragments.with_normals.by_tile.resize_with(tiles, Blocks::default);
        fragments.samples.by_tile.resize_with(tiles, Blocks::default);
        let (fronts, backs) = (Queue::default(), Queue::default());
        Self { fronts, backs, fragments, columns: screen.columns }
    }

    /// Adds those of eight triangles whose bits are set; where they are given, the normals are made of those whose
    /// fronts are seen.
    #[inline(always)]
    pub fn add<S: Simd>(
        &mut self,
        simd: S,
        normals: Option<&RunNormals<'_>>,
        (sampled, mut which): (&Sampled, u64),
        primitive: impl Fn(usize) -> (u32, [u32; 3]),
    ) {
        while which != 0 {
            let lane = which.trailing_zeros() as usize % EIGHT;
            which &= which - 1;
            let back = sampled.from_behind >> lane & 1 == 1;
            let (queue, normals) =
                if back { (&mut self.backs, None) } else { (&mut self.fronts, normals) };
            queue.push(normals, (sampled, lane), primitive(lane));
            if queue.count == EIGHT {
                Queue::make(simd, queue, normals, self.columns, self.fragments);
            }
        }
    }

    /// Makes fragments of what waits.
    pub fn finish(&mut self, level: Level, normals: Option<&RunNormals<'_>>) {
        for (queue, normals) in [(&mut self.fronts, normals), (&mut self.backs, None)] {
            if queue.count > 0 {
                let (columns, fragments) = (self.columns, &mut *self.fragments);
                dispatch!(level, simd => Queue::make(simd, queue, normals, columns, fragments));
            }
        }
    }
}

/// Where a pixel of the screen is: the tile, and in the lower bits the pixel in it.
#[inline(always)]
fn place(x: i32, y: i32, columns: i32) -> u32 {
    const SHIFT: u32 = TILE.trailing_zeros();
    let within = TILE - 1;
    let tile = (y >> SHIFT) * columns + (x >> SHIFT);
    let pixel = ((y & within) << SHIFT) | (x & within);
    ((tile << PIXEL_BITS) | pixel).cast_unsigned()
}
