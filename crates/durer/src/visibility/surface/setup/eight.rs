//! Set-up of eight triangles side by side: which are seen, and the planes of their depths.

use super::vertex::{Hidden, ScreenVertex, code};
use super::{Filter, ScreenTriangle};
use crate::raster::fixed::{HALF_PIXEL, SUBPIXEL_BITS, SUBPIXELS};
use crate::visibility::surface::gather::{narrowed, transpose, widened};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, f64x8, i32x8, mask32x8, u32x8};

/// Triangles that are set up at a time.
pub const EIGHT: usize = 8;

/// What triangles are measured against.
#[derive(Debug, Clone, Copy)]
pub struct Rules {
    pub filter: Filter,
    /// The screen in pixels.
    pub size: [u32; 2],
    /// The sign of the area of those that are left out.
    pub hidden: Option<Hidden>,
}

/// Eight triangles after set-up. Bit i of a mask is triangle i's.
#[derive(Default)]
pub struct Eight {
    /// Those with a vertex that is not finite.
    pub non_finite: u64,
    /// Of the finite ones, those that reach beyond the near plane or the guard band, so that they must be
    /// cut first; there is nothing of them here.
    pub uncut: u64,
    /// Those of the others that may be seen.
    pub seen: u64,
    rows: [[[u32; EIGHT]; EIGHT]; 2],
}

impl Eight {
    /// Triangle `i`, which is among those seen.
    #[inline(always)]
    pub fn triangle(&self, i: usize, item: u32) -> ScreenTriangle {
        let [first, second] = &self.rows;
        let [x0, x1, x2, y0, y1, y2, depth, depth_dx] = first[i % EIGHT];
        let [depth_dy, depth_min, depth_max, ..] = second[i % EIGHT];
        ScreenTriangle {
            x: [x0, x1, x2].map(u32::cast_signed),
            y: [y0, y1, y2].map(u32::cast_signed),
            depth: f32::from_bits(depth),
            depth_dx: f32::from_bits(depth_dx),
            depth_dy: f32::from_bits(depth_dy),
            depth_min: f32::from_bits(depth_min),
            depth_max: f32::from_bits(depth_max),
            item,
        }
    }
}

/// One corner of eight triangles.
#[derive(Clone, Copy)]
struct Corner<S: Simd> {
    x: i32x8<S>,
    y: i32x8<S>,
    rest_x: f32x8<S>,
    rest_y: f32x8<S>,
    depth: f32x8<S>,
    code: u32x8<S>,
}

impl<S: Simd> Corner<S> {
    #[inline(always)]
    fn new(simd: S, of: [&ScreenVertex; EIGHT]) -> Self {
        let mut rows = [simd.splat_f32x8(0.0); EIGHT];
        for (row, vertex) in rows.iter_mut().zip(of) {
            *row = u32x8::from_slice(simd, &vertex.0).bitcast();
        }
        let [x, y, rest_x, rest_y, depth, code, ..] = transpose(simd, rows);
        let (x, y, code) = (x.bitcast(), y.bitcast(), code.bitcast());
        Self { x, y, rest_x, rest_y, depth, code }
    }

    /// This corner where `mask` is set, the other elsewhere.
    #[inline(always)]
    fn where_set(self, mask: mask32x8<S>, other: Self) -> Self {
        Self {
            x: mask.select(self.x, other.x),
            y: mask.select(self.y, other.y),
            rest_x: mask.select(self.rest_x, other.rest_x),
            rest_y: mask.select(self.rest_y, other.rest_y),
            depth: mask.select(self.depth, other.depth),
            code: self.code,
        }
    }
}

/// Back-face and area test, bounding box test, depth plane.
#[inline(always)]
pub fn set_up<S: Simd>(
    simd: S,
    rules: &Rules,
    corners: [[&ScreenVertex; EIGHT]; 3],
    eight: &mut Eight,
) {
    let [a, b, c] = corners;
    let (a, b, c) = (Corner::new(simd, a), Corner::new(simd, b), Corner::new(simd, c));
    let (all, any) = (a.code & b.code & c.code, a.code | b.code | c.code);
    let non_finite = with_bits(simd, any, code::NON_FINITE);
    let outside = with_bits(simd, all, code::OUTSIDE);
    let uncut = with_bits(simd, any, code::NEAR | code::GUARD) & !non_finite & !outside;
    (eight.non_finite, eight.uncut) = (non_finite, uncut);

    // Twice the area in grid units: products of less than 2²⁷ each, so without rounding.
    let (right, down) = (to_f64(simd, b.x - a.x), to_f64(simd, b.y - a.y));
    let area = right * to_f64(simd, c.y - a.y) - to_f64(simd, c.x - a.x) * down;
    let zero = simd.splat_f64x8(0.0);
    let turned_away = match rules.hidden {
        None => area.simd_eq(zero),
        Some(Hidden::Positive) => area.simd_ge(zero),
        Some(Hidden::Negative) => area.simd_le(zero),
    };
    let ([width, height], reach) = (rules.size, rules.filter.sample_reach);
    let misses = misses_all_samples(simd, [a.x, b.x, c.x], reach, width)
        | misses_all_samples(simd, [a.y, b.y, c.y], reach, height);
    eight.seen = !(non_finite | outside | uncut | turned_away.to_bitmask() | misses) & 0xff;
    if eight.seen == 0 {
        return;
    }

    let negative = narrowed(simd, area).simd_lt(simd.splat_f32x8(0.0));
    let (b, c) = (c.where_set(negative, b), b.where_set(negative, c));
    let [depth, depth_dx, depth_dy] = depth_planes(simd, [a, b, c], area.abs());
    let nothing = simd.splat_f32x8(0.0);
    // Adding 0 makes a 0 of −0, whose bits are another order.
    let depth_min = a.depth.min(b.depth).min(c.depth).max(nothing) + nothing;
    let depth_max = a.depth.max(b.depth).max(c.depth).max(nothing) + nothing;
    let (x0, x1, x2) = (a.x.bitcast(), b.x.bitcast(), c.x.bitcast());
    let (y0, y1, y2) = (a.y.bitcast(), b.y.bitcast(), c.y.bitcast());
    let first = transpose(simd, [x0, x1, x2, y0, y1, y2, depth, depth_dx]);
    let second = transpose(
        simd,
        [depth_dy, depth_min, depth_max, nothing, nothing, nothing, nothing, nothing],
    );
    store(&first, &mut eight.rows[0]);
    store(&second, &mut eight.rows[1]);
}

#[inline(always)]
fn store<S: Simd>(from: &[f32x8<S>; EIGHT], to: &mut [[u32; EIGHT]; EIGHT]) {
    for i in 0..EIGHT {
        from[i].bitcast::<u32x8<S>>().store_slice(&mut to[i]);
    }
}

/// The numbers that have any of some bits set, as bits.
#[inline(always)]
fn with_bits<S: Simd>(simd: S, codes: u32x8<S>, bits: u32) -> u64 {
    (codes & bits).simd_ne(u32x8::splat(simd, 0)).to_bitmask()
}

/// Whether no sample of a pixel on the screen lies between three coordinates, as bits.
#[inline(always)]
fn misses_all_samples<S: Simd>(simd: S, v: [i32x8<S>; 3], reach: i32, pixels: u32) -> u64 {
    let (low, high) = (v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2]));
    // The first pixel with its centre at least there, as `first_center` has it.
    let first = (low + (HALF_PIXEL - 1 - reach)) >> SUBPIXEL_BITS;
    let end = (high + (HALF_PIXEL + reach)) >> SUBPIXEL_BITS;
    let pixels = i32::try_from(pixels).unwrap_or(i32::MAX);
    let nowhere = first.simd_ge(end) | end.simd_le(i32x8::splat(simd, 0));
    (nowhere | first.simd_ge(i32x8::splat(simd, pixels))).to_bitmask()
}

/// The planes of depth through three vertices: the value at the centre of the pixel that holds the
/// first, and the change per pixel.
#[inline(always)]
fn depth_planes<S: Simd>(
    simd: S,
    [a, b, c]: [Corner<S>; 3],
    snapped_area: f64x8<S>,
) -> [f32x8<S>; 3] {
    let zero = simd.splat_f64x8(0.0);
    let (mut rest_x, mut rest_y) = (widened(simd, a.rest_x), widened(simd, a.rest_y));
    let (snapped_x1, snapped_y1) = (to_f64(simd, b.x - a.x), to_f64(simd, b.y - a.y));
    let (snapped_x2, snapped_y2) = (to_f64(simd, c.x - a.x), to_f64(simd, c.y - a.y));
    // Through the places before snapping, which are exact.
    let mut x1 = snapped_x1 + (widened(simd, b.rest_x) - rest_x);
    let mut y1 = snapped_y1 + (widened(simd, b.rest_y) - rest_y);
    let mut x2 = snapped_x2 + (widened(simd, c.rest_x) - rest_x);
    let mut y2 = snapped_y2 + (widened(simd, c.rest_y) - rest_y);
    let mut area = x1 * y2 - x2 * y1;
    // A sliver that only snapping gives its area: its plane is that of the snapped triangle.
    let sliver = area.simd_lt(snapped_area * 0.25);
    (x1, y1) = (sliver.select(snapped_x1, x1), sliver.select(snapped_y1, y1));
    (x2, y2) = (sliver.select(snapped_x2, x2), sliver.select(snapped_y2, y2));
    (rest_x, rest_y) = (sliver.select(zero, rest_x), sliver.select(zero, rest_y));
    area = sliver.select(snapped_area, area);
    let scale = simd.splat_f64x8(f64::from(SUBPIXELS)) / area;
    let z = widened(simd, a.depth);
    let (z1, z2) = (widened(simd, b.depth) - z, widened(simd, c.depth) - z);
    let depth_dx = (z1 * y2 - z2 * y1) * scale;
    let depth_dy = (z2 * x1 - z1 * x2) * scale;
    let center_x = to_center(simd, a.x, rest_x);
    let depth = z + depth_dx * center_x + depth_dy * to_center(simd, a.y, rest_y);
    [narrowed(simd, depth), narrowed(simd, depth_dx), narrowed(simd, depth_dy)]
}

/// From coordinates to the centres of the pixels that hold their snapped places, in pixels.
#[inline(always)]
fn to_center<S: Simd>(simd: S, v: i32x8<S>, rest: f64x8<S>) -> f64x8<S> {
    const PIXELS: f64 = 1.0 / SUBPIXELS as f64;
    let in_pixel = v & i32x8::splat(simd, SUBPIXELS - 1);
    (to_f64(simd, i32x8::splat(simd, HALF_PIXEL) - in_pixel) - rest) * PIXELS
}

/// Integers of at most 31 bits as they are.
#[inline(always)]
fn to_f64<S: Simd>(simd: S, v: i32x8<S>) -> f64x8<S> {
    // Added to the bits of 1.5 · 2⁵², an integer is added to the number.
    const MAGIC: f64 = 6_755_399_441_055_744.0;
    let (low, high) = simd.widen_i32x8(v);
    let bits = MAGIC.to_bits().cast_signed();
    let (low, high) = (low + bits, high + bits);
    simd.combine_f64x4(low.bitcast(), high.bitcast()) - MAGIC
}
