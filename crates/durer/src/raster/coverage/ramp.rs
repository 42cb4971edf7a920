//! The coverage of an edge in the pixels of a row: one row after the other, or eight rows that it crosses
//! steeply.
//!
//! Both give the same integers.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8, u32x8};

use super::edge::{BITS, ONE};

/// Coverage to the right of an edge within one row, by pixel.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Ramp {
    /// The first pixel that it touches, and the area that it covers of that.
    pub first: i32,
    pub head: i32,
    /// The last one, at least the one after the first.
    pub last: i32,
    pub tail: i32,
    /// The pixel after the last one touched, for ramps that cross three or more.
    pub end: i32,
    /// Coverage of all pixels after the last: its height.
    pub height: i32,
    /// Coverage of the pixels between, with 16 more bits: the first pixel's coverage, and the increase for each further
    /// pixel.
    pub start: u32,
    pub per_pixel: u32,
}

impl Ramp {
    /// Creates an edge from `x0` to `x1`, 16.16, which are moved between 0 and the limit.
    #[inline(always)]
    pub fn new(x0: i32, x1: i32, height: i32, limit: i32) -> Self {
        let (left, right) = (x0.min(x1).clamp(0, limit), x0.max(x1).clamp(0, limit));
        let first = left >> BITS;
        let (a, b) = (left & (ONE - 1), right - (left & !(ONE - 1)));
        if b > 2 * ONE {
            return Self::wide(left, right, height);
        }
        let [head, _, after] = narrow_deltas(a, b, height);
        Self { first, head, last: first + 1, tail: height - after, height, ..Self::default() }
    }

    /// Creates an edge that crosses a whole row and at most two pixels, by its left end and its
    /// width.
    #[inline(always)]
    pub fn steep(left: i32, across: i32, half_inverse: f32, limit: i32) -> Self {
        let left = left.clamp(0, limit);
        let (first, a) = (left >> BITS, left & (ONE - 1));
        let [head, _, after] = steep_deltas(a, a + across, half_inverse);
        let (last, tail, height) = (first + 1, ONE - after, ONE);
        Self { first, head, last, tail, height, ..Self::default() }
    }

    /// Creates an edge that crosses three pixels or more.
    #[inline(always)]
    pub fn wide(left: i32, right: i32, height: i32) -> Self {
        // Covered height per pixel of width, with 32 bits below one; less than a half.
        let per_pixel = (f64::from(height) / f64::from(right - left) * 4_294_967_296.0) as u64;
        let before = (ONE - (left & (ONE - 1))) as u64;
        let after = (right & (ONE - 1)) as u64;
        let triangle = |side: u64| ((per_pixel * ((side * side) >> BITS)) >> (2 * BITS + 1)) as i32;
        let start = ((per_pixel * before) >> BITS) + per_pixel / 2;
        let (first, last) = (left >> BITS, right >> BITS);
        Self {
            first,
            head: triangle(before),
            last,
            tail: height - triangle(after),
            end: last + i32::from(after != 0),
            height,
            start: (start as u32).wrapping_sub(per_pixel as u32),
            per_pixel: per_pixel as u32,
        }
    }
}

/// Returns half of one over the width of an edge, 16.16, as [`steep_deltas`] needs it.
#[inline(always)]
pub(super) fn half_inverse(across: i32) -> f32 {
    0.5 / across.max(1) as f32
}

/// Changes of covered area at the pixel of `a`, the next and the one after, for an edge that crosses
/// a whole row from `a` to `b`, 16.16 relative to the pixel's left border, `a` < 1 and `b` ≤ 2.
///
/// The three add up to one exactly.
#[inline(always)]
pub(super) fn steep_deltas(a: i32, b: i32, half_inverse: f32) -> [i32; 3] {
    let middle = (a + b) >> 1;
    // The triangle right of the border between the pixels: half of its width times its height.
    let over = (b - ONE).max(0) as f32;
    let d2 = (over * over * half_inverse) as i32;
    // Rounding can make the first one −1.
    let d0 = (ONE + d2 - middle).max(0);
    [d0, ONE - d0 - d2, d2]
}

/// Returns the [`steep_deltas`] of an edge that crosses part of a row's height.
#[inline(always)]
pub(super) fn narrow_deltas(a: i32, b: i32, height: i32) -> [i32; 3] {
    let scale = |delta: i32| ((i64::from(delta) * i64::from(height)) >> BITS) as i32;
    // One pixel: no division.
    let inverse = if b > ONE { half_inverse(b - a) } else { 0.0 };
    let [d0, _, d2] = steep_deltas(a, b, inverse);
    let (d0, d2) = (scale(d0), scale(d2));
    [d0, height - d0 - d2, d2]
}

/// Returns the [`narrow_deltas`] of eight parts at once, which begin at `a` and extend `across`; for a height of one
/// the [`steep_deltas`].
#[inline(always)]
pub(super) fn eight_deltas<S: Simd>(
    simd: S,
    a: i32x8<S>,
    across: i32x8<S>,
    height: i32x8<S>,
) -> [i32x8<S>; 3] {
    let (zero, bit, one) = (i32x8::splat(simd, 0), i32x8::splat(simd, 1), i32x8::splat(simd, ONE));
    let b = a + across;
    let over = simd.cvt_f32_i32x8((b - one).max(zero));
    let half_inverse = f32x8::splat(simd, 0.5) / simd.cvt_f32_i32x8(across.max(bit));
    let d2 = simd.cvt_i32_f32x8(over * over * half_inverse);
    let d0 = (one + d2 - ((a + b) >> 1)).max(zero);
    // Less than one times one, so 32 bits are enough.
    let (u0, u2): (u32x8<S>, u32x8<S>) = (d0.bitcast(), d2.bitcast());
    let part: u32x8<S> = height.bitcast();
    let (part0, part2): (i32x8<S>, i32x8<S>) =
        (((u0 * part) >> BITS).bitcast(), ((u2 * part) >> BITS).bitcast());
    let is_whole = height.simd_eq(one);
    let (d0, d2) = (is_whole.select(d0, part0), is_whole.select(d2, part2));
    [d0, height - d0 - d2, d2]
}

/// Returns the coverage of eight pixels by an edge.
#[inline(always)]
pub(super) fn area<S: Simd>(simd: S, ramp: &Ramp, x: i32) -> i32x8<S> {
    let lane = i32x8::from_slice(simd, &[0, 1, 2, 3, 4, 5, 6, 7]);
    let (zero, last) = (i32x8::splat(simd, 0), i32x8::splat(simd, ramp.last - ramp.first));
    let i = lane + i32x8::splat(simd, x - ramp.first);
    let u: u32x8<S> = i.bitcast();
    let area = u32x8::splat(simd, ramp.start) + u * u32x8::splat(simd, ramp.per_pixel);
    let area: i32x8<S> = (area >> BITS).bitcast();
    let area = i.simd_eq(zero).select(i32x8::splat(simd, ramp.head), area);
    let area = i.simd_eq(last).select(i32x8::splat(simd, ramp.tail), area);
    let area = i.simd_gt(last).select(i32x8::splat(simd, ramp.height), area);
    i.simd_lt(zero).select(zero, area)
}

/// Movement of an edge to the right in eight rows one below the other.
#[derive(Clone, Copy)]
pub(super) struct Stepped<S: Simd> {
    /// From the first of them on, 16.16, and the 16 bits below, not carried over.
    whole: i32x8<S>,
    below: i32x8<S>,
}

impl<S: Simd> Stepped<S> {
    /// Creates the movement of an edge with a slope, 32.32.
    #[inline(always)]
    pub fn new(simd: S, slope: i64) -> Self {
        let lane = i32x8::from_slice(simd, &[0, 1, 2, 3, 4, 5, 6, 7]);
        Self {
            whole: lane * i32x8::splat(simd, (slope >> BITS) as i32),
            below: lane * i32x8::splat(simd, slope as i32 & (ONE - 1)),
        }
    }

    /// Returns x in each of the rows, 16.16, from x in the first, 32.32.
    #[inline(always)]
    pub fn from(&self, simd: S, x: i64) -> i32x8<S> {
        let below = self.below + i32x8::splat(simd, x as i32 & (ONE - 1));
        self.whole + i32x8::splat(simd, (x >> BITS) as i32) + (below >> BITS)
    }
}

/// A steep edge in the next eight rows.
pub(super) struct Eight<S: Simd> {
    /// The left end in the first of them, 32.32, and its change in eight rows.
    left: i64,
    step: i64,
    stepped: Stepped<S>,
    across: i32x8<S>,
    half_inverse: f32,
    limit: i32x8<S>,
}

impl<S: Simd> Eight<S> {
    /// Creates an edge by its left end in the first of the rows and its slope, 32.32; moved between 0 and the
    /// limit, 16.16.
    #[inline(always)]
    pub fn new(simd: S, left: i64, slope: i64, limit: i32) -> Self {
        let across = (slope.unsigned_abs() >> BITS) as i32;
        Self {
            left,
            step: 8 * slope,
            stepped: Stepped::new(simd, slope),
            across: i32x8::splat(simd, across),
            half_inverse: half_inverse(across),
            limit: i32x8::splat(simd, limit),
        }
    }

    /// Returns, for each of the rows, the first pixel touched, the coverage of it and of the next one, and how far the
    /// next one is touched; then moves eight rows on.
    #[inline(always)]
    pub fn next(&mut self, simd: S) -> [i32x8<S>; 4] {
        let (one, zero) = (i32x8::splat(simd, ONE), i32x8::splat(simd, 0));
        let x = self.stepped.from(simd, self.left);
        self.left += self.step;
        let x = x.max(zero).min(self.limit);
        let a = x & i32x8::splat(simd, ONE - 1);
        let b = a + self.across;
        let beyond = (b - one).max(zero);
        let over = simd.cvt_f32_i32x8(beyond);
        let d2 = simd.cvt_i32_f32x8(over * over * f32x8::splat(simd, self.half_inverse));
        let d0 = (one + d2 - ((a + b) >> 1)).max(zero);
        [x >> BITS, d0, one - d2, beyond]
    }
}
