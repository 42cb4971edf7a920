//! Triangles that are sampled while they are set up: what is left of each, a fragment or two with its depth and
//! normal, is kept instead of the triangle.
//!
//! That a normal is found for what may turn out to be hidden costs less than to read the triangle again where it shows:
//! here its vertices have just been read.
//!
//! Source: see [`Sampled`]. Cost: O(1) for each triangle.

use super::bins::TileGrid;
use super::tile::{SamplePlane, TILE};
use crate::visibility::surface::lit::KnownNormals;
use crate::visibility::surface::setup::{EIGHT, PIXELS, Sampled, depths, place_in_box};
use crate::visibility::surface::triangles::RunNormals;
use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x8, i32x8, u32x8};
use fearless_simd_macros::simd;

/// Bits of a pixel's place in its tile.
const PIXEL_BITS: u32 = 2 * TILE.trailing_zeros();

/// Screens of more tiles have places that do not fit 32 bits; nothing is sampled there before its time.
pub const MOST_TILES: u32 = 1 << (32 - PIXEL_BITS);

/// A sample that a small triangle covers.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// The pixel in its tile.
    pixel: u32,
    /// Bits of the depth.
    depth: i32,
    item: u32,
}

impl Sample {
    /// Depth test and write; whether it is seen.
    #[inline(always)]
    pub fn draw(&self, plane: &mut SamplePlane) -> bool {
        let pixel = self.pixel as usize;
        let (depth, item) = (&mut plane.depth[pixel], &mut plane.item[pixel]);
        // At equal depths the lower item wins, as where triangles are rasterized.
        let wins_ties = item.cast_signed().wrapping_sub(self.item.cast_signed()) >= 0;
        let seen = self.depth < *depth || self.depth == *depth && wins_ties;
        if seen {
            (*depth, *item) = (self.depth, self.item);
        }
        seen
    }
}

/// A sample with its normal.
#[derive(Debug, Clone, Copy)]
pub struct Fragment {
    /// Where it is.
    pub sample: Sample,
    /// Of the side that is seen, of any length; NaN where it is to be found when it is asked for.
    normal: [f32; 3],
}

impl Fragment {
    /// Depth test and write; in `known` its normal.
    #[inline(always)]
    pub fn draw(&self, plane: &mut SamplePlane, known: &mut KnownNormals) {
        if self.sample.draw(plane) {
            known.set(self.sample.pixel as usize, self.sample.item, self.normal);
        }
    }
}

/// Things by the tiles that they are in.
pub struct Tiles<T> {
    by_tile: Vec<Vec<T>>,
    /// Tiles with something in them.
    tiles: Vec<u32>,
}

impl<T> Default for Tiles<T> {
    fn default() -> Self {
        Self { by_tile: Vec::new(), tiles: Vec::new() }
    }
}

impl<T> Tiles<T> {
    #[inline(always)]
    fn push(&mut self, place: u32, thing: T) {
        let tile = place >> PIXEL_BITS;
        let of_tile = &mut self.by_tile[tile as usize];
        if of_tile.is_empty() {
            self.tiles.push(tile);
        }
        of_tile.push(thing);
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.tiles.iter().map(|&tile| self.by_tile[tile as usize].len()).sum()
    }

    /// Hands on what there is, tile by tile in ascending order, and is empty then.
    pub fn drain(&mut self, mut take: impl FnMut(u32, &[T])) {
        self.tiles.sort_unstable();
        for tile in self.tiles.drain(..) {
            let of_tile = &mut self.by_tile[tile as usize];
            take(tile, of_tile);
            of_tile.clear();
        }
    }
}

/// What small triangles leave.
#[derive(Default)]
pub struct Fragments {
    /// Where normals were made.
    pub with_normals: Tiles<Fragment>,
    /// The others.
    pub samples: Tiles<Sample>,
}

/// Small triangles that wait until there are eight.
#[derive(Default)]
struct Queue {
    count: usize,
    items: [u32; EIGHT],
    /// Their vertices in the mesh.
    corners: [[u32; 3]; EIGHT],
    /// As in [`Sampled`].
    first: [[i32; EIGHT]; 2],
    covered: [u32; EIGHT],
    origin: [[i32; EIGHT]; 2],
    depth: [[f32; EIGHT]; 5],
}

impl Queue {
    /// Adds one of eight triangles where there is room.
    #[inline(always)]
    fn push(&mut self, sampled: &Sampled, lane: usize, (item, corners): (u32, [u32; 3])) {
        let to = self.count % EIGHT;
        (self.items[to], self.corners[to]) = (item, corners);
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
        for lane in this.count..EIGHT {
            // Nothing is made of these, but their vertices are read.
            (this.covered[lane], this.corners[lane]) = (0, this.corners[0]);
        }
        this.count = 0;
        // No closures, in which the SIMD level may be lost.
        let planes = match normals {
            Some(normals) => Some(normals.planes(simd, &this.corners)),
            None => None,
        };
        let covered = u32x8::from_slice(simd, &this.covered);
        let [first_x, first_y] = &this.first;
        let first = [i32x8::from_slice(simd, first_x), i32x8::from_slice(simd, first_y)];
        let none = f32x8::splat(simd, f32::NAN);
        for pixel in 0..PIXELS {
            let covers = (covered & (1 << pixel)).simd_ne(u32x8::splat(simd, 0));
            let mut left = covers.to_bitmask();
            if left == 0 {
                continue;
            }
            let [column, row] = place_in_box(pixel);
            let (x, y) = (first[0] + column, first[1] + row);
            let place: [u32; EIGHT] = place(simd, x, y, columns).into();
            let depth = depths(simd, [x, y], &this.origin, &this.depth);
            let depth: [i32; EIGHT] = depth.bitcast::<i32x8<S>>().into();
            let mut normal = [[0.0; EIGHT]; 3];
            if let Some(planes) = &planes {
                let [nx, ny, nz] = planes.at(simd, x, y);
                planes.settled.select(nx, none).store_slice(&mut normal[0]);
                ny.store_slice(&mut normal[1]);
                nz.store_slice(&mut normal[2]);
            }
            while left != 0 {
                let lane = left.trailing_zeros() as usize % EIGHT;
                left &= left - 1;
                let (place, depth, item) = (place[lane], depth[lane], this.items[lane]);
                let sample = Sample { pixel: place % (1 << PIXEL_BITS), depth, item };
                if planes.is_some() {
                    let normal = [normal[0][lane], normal[1][lane], normal[2][lane]];
                    fragments.with_normals.push(place, Fragment { sample, normal });
                } else {
                    fragments.samples.push(place, sample);
                }
            }
        }
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
        fragments.with_normals.by_tile.resize_with(tiles, Vec::new);
        fragments.samples.by_tile.resize_with(tiles, Vec::new);
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
            let queue = if back { &mut self.backs } else { &mut self.fronts };
            queue.push(sampled, lane, primitive(lane));
            if queue.count == EIGHT {
                let normals = if back { None } else { normals };
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

/// Where pixels of the screen are: the tile, and in the lower bits the pixel in it.
#[inline(always)]
fn place<S: Simd>(simd: S, x: i32x8<S>, y: i32x8<S>, columns: i32) -> u32x8<S> {
    const SHIFT: u32 = TILE.trailing_zeros();
    let within = i32x8::splat(simd, TILE - 1);
    let tile = (y >> SHIFT) * columns + (x >> SHIFT);
    let pixel = ((y & within) << SHIFT) | (x & within);
    ((tile << PIXEL_BITS) | pixel).bitcast()
}
