//! Set-up of eight triangles side by side: which are seen, and the planes of their depths.

use super::ScreenTriangle;
use super::corner::{Corner, EIGHT};
use super::rules::Rules;
use super::sampled::{Sampled, Span, cover};
use super::vertex::{Behind, ScreenVertex, code};
use crate::raster::fixed::{HALF_PIXEL, SUBPIXEL_BITS, SUBPIXELS};
use crate::visibility::surface::gather::{self, integers_widened, narrowed, transpose, widened};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4, f32x8, f64x8, i32x8, mask32x8, u32x4, u32x8};

/// Eight triangles after set-up. Bit i of a mask is triangle i's.
#[derive(Default)]
pub struct Eight {
    /// Triangles with a vertex that is not finite.
    pub non_finite: u64,
    /// Finite triangles that extend beyond the near plane or the guard band, so that they must be cut
    /// first; they are left out here.
    pub uncut: u64,
    /// Other triangles that may be seen.
    pub seen: u64,
    /// Triangles that are seen and were sampled at once; the others may be requested by [`Self::triangle`].
    pub sampled: Sampled,
    rows: [[[u32; EIGHT]; EIGHT]; 2],
}

impl Eight {
    /// Returns triangle `i`, which is among those seen and not sampled.
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

impl<S: Simd> Corner<S> {
    #[inline(always)]
    fn new(simd: S, of: &[&ScreenVertex; EIGHT]) -> Self {
        let [x, y, code, depth] = four_columns(simd, of, 0);
        Self { x: x.bitcast(), y: y.bitcast(), code: code.bitcast(), depth }
    }

    /// Returns this corner where `mask` is set, the other elsewhere.
    #[inline(always)]
    fn where_set(self, mask: mask32x8<S>, other: Self) -> Self {
        Self {
            x: mask.select(self.x, other.x),
            y: mask.select(self.y, other.y),
            code: self.code,
            depth: mask.select(self.depth, other.depth),
        }
    }
}

/// Distance that snapping moved the corners of eight triangles, in grid steps.
struct Rest<S: Simd> {
    x: [f64x8<S>; 3],
    y: [f64x8<S>; 3],
}

impl<S: Simd> Rest<S> {
    /// Builds the corners; if `swapped` is set, the second and the third one change places.
    #[inline(always)]
    fn new(simd: S, [a, b, c]: [&[&ScreenVertex; EIGHT]; 3], swapped: mask32x8<S>) -> Self {
        let [ax, ay, ..] = four_columns(simd, a, 4);
        let [bx, by, ..] = four_columns(simd, b, 4);
        let [cx, cy, ..] = four_columns(simd, c, 4);
        let (bx, cx) = (swapped.select(cx, bx), swapped.select(bx, cx));
        let (by, cy) = (swapped.select(cy, by), swapped.select(by, cy));
        let x = [widened(simd, ax), widened(simd, bx), widened(simd, cx)];
        Self { x, y: [widened(simd, ay), widened(simd, by), widened(simd, cy)] }
    }
}

/// Returns four numbers of eight vertices, from the given one on, apart.
#[inline(always)]
fn four_columns<S: Simd>(simd: S, of: &[&ScreenVertex; EIGHT], from: usize) -> [f32x8<S>; 4] {
    let mut rows = [f32x4::splat(simd, 0.0); EIGHT];
    for (row, vertex) in rows.iter_mut().zip(of) {
        *row = u32x4::from_slice(simd, &vertex.0[from..from + 4]).bitcast();
    }
    gather::four_columns(simd, rows)
}

/// Sets up eight triangles: back-face and area test, bounding box test, depth plane; if requested, also the pixels
/// covered by small triangles.
#[inline(always)]
pub fn set_up<S: Simd>(
    simd: S,
    rules: &Rules,
    corners: [[&ScreenVertex; EIGHT]; 3],
    eight: &mut Eight,
) {
    let [of_a, of_b, of_c] = &corners;
    let (a, b, c) = (Corner::new(simd, of_a), Corner::new(simd, of_b), Corner::new(simd, of_c));
    // Triangles that must be cut first are left to the caller; those outside or not finite are left out.
    let (all, any) = (a.code & b.code & c.code, a.code | b.code | c.code);
    let non_finite = with_bits(simd, any, code::NON_FINITE);
    let outside = with_bits(simd, all, code::OUTSIDE);
    let uncut = with_bits(simd, any, code::NEAR | code::GUARD) & !non_finite & !outside;
    (eight.non_finite, eight.uncut) = (non_finite, uncut);

    // Twice the area in grid units: products of less than 2²⁷ each, so without rounding.
    let right = integers_widened(simd, b.x - a.x);
    let down = integers_widened(simd, b.y - a.y);
    let area = right * integers_widened(simd, c.y - a.y);
    let area = area - integers_widened(simd, c.x - a.x) * down;
    let zero = simd.splat_f64x8(0.0);
    let turned_away = match (rules.cull_back, rules.behind) {
        (false, _) => area.simd_eq(zero),
        (true, Behind::Positive) => area.simd_ge(zero),
        (true, Behind::Negative) => area.simd_le(zero),
    };
    // Bounding boxes that contain no sample of the window are left out.
    let ([of_columns, of_rows], reach) = (rules.window, rules.filter.sample_reach);
    let columns = Span::new([a.x, b.x, c.x], reach);
    let rows = Span::new([a.y, b.y, c.y], reach);
    let misses = columns.misses(simd, of_columns) | rows.misses(simd, of_rows);
    eight.seen = !(non_finite | outside | uncut | turned_away.to_bitmask() | misses) & 0xff;
    eight.sampled.which = 0;
    if eight.seen == 0 {
        return;
    }

    // From here on the corners are ordered so that the area is positive.
    let negative = narrowed(simd, area).simd_lt(simd.splat_f32x8(0.0));
    let (b, c) = (c.where_set(negative, b), b.where_set(negative, c));
    // Small triangles are sampled at once; those that cover no sample are left out.
    if !rules.sampled.is_empty() {
        let samples = rules.sampled.len();
        let small = (columns.is_small(samples) & rows.is_small(samples)).to_bitmask() & eight.seen;
        if small != 0 {
            cover(simd, [a, b, c], [columns.first, rows.first], rules, &mut eight.sampled);
            eight.sampled.which &= small;
            eight.seen &= !small | eight.sampled.which;
            if eight.seen == 0 {
                return;
            }
        }
    }
    // Depth planes, and the range of depths at the vertices.
    let rest = Rest::new(simd, [of_a, of_b, of_c], negative);
    let [depth, depth_dx, depth_dy] = depth_planes(simd, [a, b, c], rest, area.abs());
    let nothing = simd.splat_f32x8(0.0);
    // Adding 0 turns −0, whose bits have another order, into 0.
    let depth_min = a.depth.min(b.depth).min(c.depth).max(nothing) + nothing;
    let depth_max = a.depth.max(b.depth).max(c.depth).max(nothing) + nothing;
    // Sampled triangles need the data for their fragments.
    if eight.sampled.which != 0 {
        let negative = negative.to_bitmask();
        eight.sampled.from_behind =
            if rules.behind == Behind::Negative { negative } else { !negative };
        for (to, v) in eight.sampled.origin.iter_mut().zip([a.x, a.y]) {
            (v >> SUBPIXEL_BITS).store_slice(to);
        }
        let numbers = [depth, depth_dx, depth_dy, depth_min, depth_max];
        for (to, number) in eight.sampled.depth.iter_mut().zip(numbers) {
            number.store_slice(to);
        }
        if eight.sampled.which == eight.seen {
            return;
        }
    }
    // The others are stored as rows, one triangle each.
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

/// Returns the numbers that have any of some bits set, as bits.
#[inline(always)]
fn with_bits<S: Simd>(simd: S, codes: u32x8<S>, bits: u32) -> u64 {
    (codes & bits).simd_ne(u32x8::splat(simd, 0)).to_bitmask()
}

/// Returns the planes of depth through three vertices: the value at the centre of the pixel that
/// holds the first, and the change per pixel.
#[inline(always)]
fn depth_planes<S: Simd>(
    simd: S,
    [a, b, c]: [Corner<S>; 3],
    rest: Rest<S>,
    snapped_area: f64x8<S>,
) -> [f32x8<S>; 3] {
    let zero = simd.splat_f64x8(0.0);
    let [mut rest_x, rest_x1, rest_x2] = rest.x;
    let [mut rest_y, rest_y1, rest_y2] = rest.y;
    let (snapped_x1, snapped_y1) =
        (integers_widened(simd, b.x - a.x), integers_widened(simd, b.y - a.y));
    let (snapped_x2, snapped_y2) =
        (integers_widened(simd, c.x - a.x), integers_widened(simd, c.y - a.y));
    // The plane goes through the places before snapping, which are exact.
    let mut x1 = snapped_x1 + (rest_x1 - rest_x);
    let mut y1 = snapped_y1 + (rest_y1 - rest_y);
    let mut x2 = snapped_x2 + (rest_x2 - rest_x);
    let mut y2 = snapped_y2 + (rest_y2 - rest_y);
    let mut area = x1 * y2 - x2 * y1;
    // A sliver that owes most of its area to snapping takes the plane of the snapped triangle.
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

/// Returns the offsets from coordinates to the centres of the pixels that hold their snapped places, in pixels.
#[inline(always)]
fn to_center<S: Simd>(simd: S, v: i32x8<S>, rest: f64x8<S>) -> f64x8<S> {
    const PIXELS: f64 = 1.0 / SUBPIXELS as f64;
    let in_pixel = v & i32x8::splat(simd, SUBPIXELS - 1);
    (integers_widened(simd, i32x8::splat(simd, HALF_PIXEL) - in_pixel) - rest) * PIXELS
}
