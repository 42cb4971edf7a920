//! Points of items from anywhere in a picture: lit when there are enough of them, and added to the pixels that show
//! them.

use super::Lit;
use crate::math::Vec4;
use crate::shade::shade_points;
use crate::visibility::surface::gather::Gathered;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4};
use fearless_simd_macros::simd;

/// Number of points that are collected and lit together.
const LANES: usize = 16;

/// A point of an item, seen at the centre of a pixel.
#[derive(Debug, Clone, Copy)]
pub struct ShadingPoint {
    /// The item.
    pub item: u32,
    /// The pixel on the screen.
    pub at: [i32; 2],
    /// The number of the pixel whose sum the colour is added to.
    pub pixel: u32,
    /// Weight of the colour there.
    pub weight: f32,
}

/// The points of one plain run that are to be lit, and the colour sums of pixels so far.
pub struct PointQueue {
    /// The pixels started, for callers that need to find them again.
    pub pixels: Vec<u32>,
    /// Linear, premultiplied; by pixel.
    pub sums: Vec<Vec4>,
    count: usize,
    /// The first item of the run.
    first_item: u32,
    items: [u32; LANES],
    at: [[i32; 2]; LANES],
    /// Destination of each colour, and its weight there.
    shares: [(u32, f32); LANES],
    /// The points whose normals are in `normals`, as bits.
    known: u64,
    normals: Gathered,
}

impl PointQueue {
    /// Makes an empty queue for pixels that are numbered from 0.
    pub fn new(pixels: usize) -> Self {
        Self {
            pixels: Vec::new(),
            sums: vec![Vec4::ZERO; pixels],
            count: 0,
            first_item: 0,
            items: [0; LANES],
            at: [[0; 2]; LANES],
            shares: [(0, 0.0); LANES],
            known: 0,
            normals: Gathered::default(),
        }
    }

    /// Begins a pixel, to which nothing has been added yet.
    #[inline(always)]
    pub fn begin(&mut self, pixel: u32) {
        self.pixels.push(pixel);
        self.sums[pixel as usize] = Vec4::ZERO;
    }

    /// Adds a colour's share of a pixel.
    #[inline(always)]
    pub fn add_color(&mut self, pixel: u32, color: Vec4, weight: f32) {
        self.sums[pixel as usize] += color * weight;
    }

    /// Adds a point of an item, which is lit now or at the latest by [`Self::flush`]; its normal is given if it is
    /// known, settled, and all that lighting needs.
    #[inline(always)]
    pub fn add<S: Simd>(
        &mut self,
        simd: S,
        lit: &mut Lit<'_>,
        point: ShadingPoint,
        normal: Option<&[f32; 4]>,
    ) {
        let info = lit.run_info(point.item);
        if !info.is_plain() {
            let color = lit.color(point.item, point.at[0], point.at[1]);
            return self.add_color(point.pixel, color.truncate().extend(1.0), point.weight);
        }
        if self.count > 0 && self.first_item != info.first_item {
            Self::flush(simd, self, lit);
        }
        self.first_item = info.first_item;
        let lane = self.count % LANES;
        self.items[lane] = point.item;
        self.at[lane] = point.at;
        self.shares[lane] = (point.pixel, point.weight);
        if let Some(normal) = normal {
            self.normals.set(lane, f32x4::from_slice(simd, normal));
            self.known |= 1 << lane;
        }
        self.count += 1;
        if self.count == LANES {
            Self::flush(simd, self, lit);
        }
    }

    /// Lights the points that wait.
    #[simd]
    pub fn flush<S: Simd>(simd: S, this: &mut Self, lit: &mut Lit<'_>) {
        if this.count == 0 {
            return;
        }
        let [r, g, b] = this.shade(simd, lit);
        for (i, (pixel, weight)) in this.shares.into_iter().take(this.count).enumerate() {
            this.add_color(pixel, Vec4::new(r[i], g[i], b[i], 1.0), weight);
        }
        (this.count, this.known) = (0, 0);
    }

    /// Returns linear red, green and blue of the points that wait.
    #[inline(always)]
    fn shade<S: Simd>(&self, simd: S, lit: &mut Lit<'_>) -> [[f32; LANES]; 3] {
        let info = lit.run_info(self.first_item);
        let there = (1 << self.count.min(LANES)) - 1;
        let mut unknown = there & !self.known;
        while unknown != 0 {
            lit.expect(self.items[unknown.trailing_zeros() as usize % LANES]);
            unknown &= unknown - 1;
        }
        lit.make_ready();
        let view = lit.sight.towards_eye_of(simd, &self.at);
        let known = (self.known, self.normals);
        let points =
            lit.points_by_pixel(simd, info.run, &self.items, (there, known), (&self.at, view));
        shade_points(simd, &points, info.material, lit.shared.lights, info.shading)
    }
}
