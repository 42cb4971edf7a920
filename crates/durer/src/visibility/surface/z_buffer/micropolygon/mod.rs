//! Triangles that are sampled during set-up: a few fragments with depths and normals are kept in place of each
//! triangle.
//!
//! Computing normals for fragments that may turn out hidden costs less than reading the visible triangles again: during
//! set-up their vertices are in the cache.
//!
//! Source: see [`Sampled`]. Cost: O(1) for each triangle.

mod fragment;
#[cfg(test)]
mod tests;
mod tiles;

pub use fragment::Fragments;

use super::tile::TILE;
use super::tile_grid::TileGrid;
use crate::raster::fixed::SUBPIXELS;
use crate::simd::dispatch;
use crate::visibility::surface::gather::four_rows;
use crate::visibility::surface::points::triangles::{Read, RunNormals};
use crate::visibility::surface::setup::{EIGHT, PIXELS, Sampled, place_in_box};
use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, f32x4, f32x8, i32x4, i32x8, u32x4, u32x8};
use fearless_simd_macros::simd;
use fragment::{Fragment, PixelItem, Sample, Store, UNCOVERED};
use tiles::PIXEL_BITS;

/// Number of tiles above which places do not fit into 32 bits; on larger screens no triangle is sampled during set-up.
pub const MOST_TILES: u32 = 1 << (32 - PIXEL_BITS);

/// Small triangles that wait until there are eight.
#[derive(Default)]
struct Queue {
    count: usize,
    items: [u32; EIGHT],
    /// Source of their normals, if they are needed.
    read: Read,
    /// First pixels, as in [`Sampled`].
    first: [[i32; EIGHT]; 2],
    /// Pixels of its box that each covers at any sample, as bits, and those at each sample.
    touched: [u32; EIGHT],
    covered: [[u32; 4]; EIGHT],
    origin: [[i32; EIGHT]; 2],
    depth: [[f32; EIGHT]; 5],
}

impl Queue {
    /// Adds one of eight triangles if there is room.
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
        self.covered[to] = sampled.covered.map(|of_sample| of_sample[lane]);
        self.touched[to] = self.covered[to].into_iter().fold(0, |any, of_sample| any | of_sample);
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
    fn make<S: Simd, const N: usize>(
        simd: S,
        this: &mut Self,
        normals: Option<&RunNormals<'_>>,
        screen: &Screen,
        store: &mut Store<N>,
    ) {
        let count = std::mem::take(&mut this.count);
        this.touched[count..].fill(0);
        let lines = this.lines(simd, normals);
        let (halves, _) = this.touched.as_chunks::<{ EIGHT / 2 }>();
        for (half, touched) in halves.iter().enumerate() {
            // The pixels of the triangles, one after the other; this many in one loop, because the end of a loop is not
            // predicted.
            let mut left = 0;
            for (i, &touched) in touched.iter().enumerate() {
                left |= u64::from(touched) << (PIXELS * i);
            }
            while left != 0 {
                let at = left.trailing_zeros() as usize;
                left &= left - 1;
                let (lane, pixel) = ((EIGHT / 2 * half + at / PIXELS) % EIGHT, at % PIXELS);
                let [column, row] = place_in_box(pixel);
                let place = screen.place(this.first[0][lane] + column, this.first[1][lane] + row);
                let (item, [x, y, z, at_center]) = (this.items[lane], lines.at(simd, lane, pixel));
                let depth = if N == 1 {
                    [at_center.to_bits().cast_signed(); N]
                } else {
                    let four = lines.depths(simd, lane, pixel, &screen.lanes);
                    let covered = this.covered[lane].map(|of_sample| of_sample >> pixel & 1 != 0);
                    std::array::from_fn(|i| if covered[i % 4] { four[i % 4] } else { UNCOVERED })
                };
                let sample = Sample { at: PixelItem::new(place, item), depth };
                if normals.is_some() {
                    store.with_normals.push(place, item, Fragment { normal: [x, y, z], sample });
                } else {
                    store.samples.push(place, item, sample);
                }
            }
        }
    }

    /// Returns the linear functions for the normals of eight triangles and their depths.
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

/// Data that determine the normals and depths of eight triangles, row by row; the fourth number of each is the depth's.
struct Lines {
    /// Start of the boxes, counted from where the planes' constants are.
    from: [[[f32; 4]; EIGHT]; 2],
    /// Constants, changes along x and along y.
    planes: [[[f32; 4]; EIGHT]; 3],
    /// The least and the largest depths.
    within: [[f32; EIGHT]; 2],
    /// Bits that are set in normals that are not settled.
    unknown: [u32; EIGHT],
}

impl Lines {
    /// Returns the normal and the depth of a triangle at a pixel of its box: bit for bit as in rasterization.
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

    /// Returns the bits of the depths at the four samples of a pixel, given their offsets from its centre; bit for bit
    /// the depths of rasterization.
    #[inline(always)]
    fn depths<S: Simd>(
        &self,
        simd: S,
        lane: usize,
        pixel: usize,
        [lanes_x, lanes_y]: &[[f32; 4]; 2],
    ) -> [i32; 4] {
        let [column, row] = place_in_box(pixel);
        let (x, y) = (self.from[0][lane][3] + column as f32, self.from[1][lane][3] + row as f32);
        let (x, y) = (f32x4::from_slice(simd, lanes_x) + x, f32x4::from_slice(simd, lanes_y) + y);
        let [constant, dx, dy] = &self.planes;
        let depth = (x * dx[lane][3] + y * dy[lane][3]) + constant[lane][3];
        let depth = depth.max(f32x4::splat(simd, self.within[0][lane]));
        let depth = depth.min(f32x4::splat(simd, self.within[1][lane]));
        depth.bitcast::<i32x4<S>>().into()
    }
}

/// The screen in tiles, and the samples of its pixels.
struct Screen {
    grid: TileGrid,
    /// One or four.
    samples: usize,
    /// Positions of four samples from pixels' centres, in pixels; nothing for one sample.
    lanes: [[f32; 4]; 2],
}

impl Screen {
    fn new(grid: TileGrid, offsets: &[[i32; 2]]) -> Self {
        let lane = |axis: usize| {
            let at = |i: usize| offsets.get(i).map_or(0.0, |o| o[axis] as f32 / SUBPIXELS as f32);
            std::array::from_fn(at)
        };
        Self { grid, samples: offsets.len(), lanes: [lane(0), lane(1)] }
    }

    /// Returns where a pixel of the screen is: the tile, and in the lower bits the pixel in it.
    #[inline(always)]
    fn place(&self, x: i32, y: i32) -> u32 {
        const SHIFT: u32 = TILE.trailing_zeros();
        let within = TILE - 1;
        let tile = self.grid.index(x >> SHIFT, y >> SHIFT);
        let pixel = ((y & within) << SHIFT) | (x & within);
        ((tile << PIXEL_BITS) | pixel).cast_unsigned()
    }
}

/// Maker of fragments from small triangles.
pub struct Micropolygons<'f> {
    /// Triangles whose fronts are seen.
    fronts: Queue,
    /// The others: mostly hidden, so their normals are not needed.
    backs: Queue,
    fragments: &'f mut Fragments,
    screen: Screen,
}

impl<'f> Micropolygons<'f> {
    /// Creates the state for a screen whose pixels have samples at `offsets`, which is empty if no triangle is sampled
    /// during set-up.
    pub fn new(grid: TileGrid, offsets: &[[i32; 2]], fragments: &'f mut Fragments) -> Self {
        if !offsets.is_empty() {
            fragments.have(grid.count() as usize, offsets.len());
        }
        let (fronts, backs) = (Queue::default(), Queue::default());
        Self { fronts, backs, fragments, screen: Screen::new(grid, offsets) }
    }

    /// Adds the triangles, of eight, whose bits are set in `which`. If `normals` is given, normals are computed for the
    /// triangles seen from the front.
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
                make(simd, queue, normals, &self.screen, self.fragments);
            }
        }
    }

    /// Turns the triangles waiting in both queues into fragments.
    pub fn finish(&mut self, level: Level, normals: Option<&RunNormals<'_>>) {
        for (queue, normals) in [(&mut self.fronts, normals), (&mut self.backs, None)] {
            if queue.count > 0 {
                let (screen, fragments) = (&self.screen, &mut *self.fragments);
                dispatch!(level, simd => make(simd, queue, normals, screen, fragments));
            }
        }
    }
}

/// Turns the triangles waiting in a queue into fragments.
#[inline(always)]
fn make<S: Simd>(
    simd: S,
    queue: &mut Queue,
    normals: Option<&RunNormals<'_>>,
    screen: &Screen,
    fragments: &mut Fragments,
) {
    if screen.samples == 1 {
        Queue::make(simd, queue, normals, screen, &mut fragments.one);
    } else {
        Queue::make(simd, queue, normals, screen, &mut fragments.four);
    }
}
