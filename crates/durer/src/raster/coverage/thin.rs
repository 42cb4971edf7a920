//! Thin straight strips, as most lines are: coverage without cells.
//!
//! A convex quadrilateral has at most four edges in a row, and of a thin one every row has few pixels. So its rows are
//! summed as they are found, from the same integers that [`super::cells`] would add up: eight rows at a time where
//! just the two long edges cross them and cross them steeply, eight pixels at a time elsewhere.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8, u32x8};
use fearless_simd_macros::simd;

use super::FillRule;
use super::band::is_convex;
use super::cells::{Ramp, half_inverse};
use super::edge::{BITS, Edge, ONE, Steps, snap};
use super::sweep::{Sink, lanes};
use crate::math::DVec2;
use crate::raster::bands::BAND_ROWS;

/// Wider ones, in pixels, are filled as other paths are.
const THIN: f64 = 4.0;

/// A thin convex quadrilateral inside the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Strip {
    /// 16.16 pixels, around.
    corners: [(i32, i32); 4],
}

impl Strip {
    /// The strip with these corners; `None` where it is not thin, not convex or not inside a target of the given size.
    pub fn new(corners: [DVec2; 4], width: u32, height: u32) -> Option<Self> {
        let size = DVec2::new(f64::from(width), f64::from(height));
        let inside = |p: &DVec2| p.cmpge(DVec2::ZERO).all() && p.cmple(size).all();
        let sides =
            (corners[0].distance_squared(corners[1]), corners[1].distance_squared(corners[2]));
        let thin = sides.0.min(sides.1) <= THIN * THIN;
        (thin && corners.iter().all(inside) && is_convex(&corners))
            .then(|| Self { corners: corners.map(snap) })
    }

    /// First row touched and one past the last.
    pub fn rows(&self) -> (i32, i32) {
        let ys = self.corners.map(|c| c.1);
        let (low, high) = ys.iter().fold((i32::MAX, 0), |(l, h), y| (l.min(*y), h.max(*y)));
        (low >> BITS, (high + ONE - 1) >> BITS)
    }

    #[inline(always)]
    fn sides(&self) -> [Side; 4] {
        let [a, b, c, d] = self.corners;
        [Side::new(a, b), Side::new(b, c), Side::new(c, d), Side::new(d, a)]
    }
}

/// One edge and how it goes from row to row.
#[derive(Debug, Clone, Copy)]
struct Side {
    edge: Edge,
    steps: Steps,
    /// The rows it touches, and the first and one past the last that it crosses from top to bottom.
    rows: (i32, i32),
    whole: (i32, i32),
}

impl Side {
    #[inline(always)]
    fn new(from: (i32, i32), to: (i32, i32)) -> Self {
        let edge = Edge::new(from, to);
        let whole = ((edge.y0 + ONE - 1) >> BITS, edge.y1 >> BITS);
        Self { edge, steps: edge.steps(), rows: edge.rows(), whole }
    }

    /// What it covers of a row's pixels; nothing where it does not touch it.
    #[inline(always)]
    fn ramp(&self, row: i32, limit: i32) -> Option<Ramp> {
        let Edge { x0, x1, y0, y1, .. } = self.edge;
        if row < self.rows.0 || row >= self.rows.1 || y0 == y1 {
            return None;
        }
        let (first, end) = self.whole;
        let at = |row: i32| self.steps.at(row - first);
        let x = |row: i32| (at(row) >> BITS) as i32;
        Some(if first > end {
            Ramp::new(x0, x1, y1 - y0, limit)
        } else if row < first {
            Ramp::new(x0, self.steps.crossing, ONE - (y0 & (ONE - 1)), limit)
        } else if row >= end {
            Ramp::new(x(row), x1, y1 & (ONE - 1), limit)
        } else {
            self.whole_ramp(row, limit)
        })
    }

    /// That of a row that it crosses from top to bottom.
    #[inline(always)]
    fn whole_ramp(&self, row: i32, limit: i32) -> Ramp {
        let slope = self.steps.slope;
        if self.is_steep() {
            let across = (slope.unsigned_abs() >> BITS) as i32;
            return Ramp::steep((self.left(row) >> BITS) as i32, across, limit);
        }
        let x = self.steps.at(row - self.whole.0);
        Ramp::new((x >> BITS) as i32, ((x + slope) >> BITS) as i32, ONE, limit)
    }

    /// The left end of what it crosses of a row as a whole, 32.32.
    #[inline(always)]
    fn left(&self, row: i32) -> i64 {
        self.steps.at(row - self.whole.0) + self.steps.slope.min(0)
    }

    /// Whether it crosses at most two pixels of a row.
    #[inline(always)]
    fn is_steep(&self) -> bool {
        self.steps.slope.unsigned_abs() <= 1 << 32
    }
}

/// Fills the strip in the band at row `top` of a target with rows of `width` pixels.
#[simd]
pub(crate) fn fill<S: Simd, K: Sink<S>>(
    simd: S,
    strip: &Strip,
    top: i32,
    width: usize,
    sink: &mut K,
) {
    let (sides, rows) = (strip.sides(), strip.rows());
    let (first, end) = (rows.0.max(top), rows.1.min(top + BAND_ROWS));
    let mut row = first;
    if let Some(between) = between(&sides) {
        while row < between.rows.0.min(end) {
            one_row(simd, &sides, (row, top), width, sink);
            row += 1;
        }
        let to = between.rows.1.min(end);
        if row < to {
            if between.narrow {
                steep_rows(simd, &between, (row, to), top, width, sink);
            } else {
                wide_rows(simd, &between, (row, to), top, width, sink);
            }
            row = to;
        }
    }
    while row < end {
        one_row(simd, &sides, (row, top), width, sink);
        row += 1;
    }
}

/// Two opposite edges and the rows that both cross from top to bottom, and nothing else does.
struct Between {
    left: Side,
    right: Side,
    rows: (i32, i32),
    /// Whether both are steep and never more than two pixels apart.
    narrow: bool,
}

/// The rows between two opposite edges.
#[inline(always)]
fn between(sides: &[Side; 4]) -> Option<Between> {
    let [a, b, c, d] = sides;
    pair(a, c, [b, d]).or_else(|| pair(b, d, [a, c]))
}

#[inline(always)]
fn pair(p: &Side, q: &Side, others: [&Side; 2]) -> Option<Between> {
    let rows = (p.whole.0.max(q.whole.0), p.whole.1.min(q.whole.1));
    let apart = |o: &Side| o.rows.1 <= rows.0 || o.rows.0 >= rows.1 || o.edge.y0 == o.edge.y1;
    if rows.0 >= rows.1 || !apart(others[0]) || !apart(others[1]) {
        return None;
    }
    let gap = |row: i32| q.left(row) - p.left(row);
    let (upper, lower) = (gap(rows.0), gap(rows.1 - 1));
    let swapped = upper < 0;
    let (upper, lower) = if swapped { (-upper, -lower) } else { (upper, lower) };
    let (left, right) = if swapped { (*q, *p) } else { (*p, *q) };
    // Some slack for what rounding does between.
    let fits = |gap: i64| (1 << BITS..(2 << 32) - (1 << BITS)).contains(&gap);
    let narrow = p.is_steep() && q.is_steep() && fits(upper) && fits(lower);
    Some(Between { left, right, rows, narrow })
}

/// Rows between two edges, eight pixels at a time.
#[simd]
fn wide_rows<S: Simd, K: Sink<S>>(
    simd: S,
    between: &Between,
    rows: (i32, i32),
    top: i32,
    width: usize,
    sink: &mut K,
) {
    let limit = (width as i32) << BITS;
    for row in rows.0..rows.1 {
        let (left, right) =
            (between.left.whole_ramp(row, limit), between.right.whole_ramp(row, limit));
        let high = left.last.max(right.last).min(width as i32 - 1);
        let mut x = left.first.min(right.first);
        while x <= high {
            let sum = area(simd, &left, x) - area(simd, &right, x);
            sink.eight(simd, row - top, x as usize, lanes(simd, sum, FillRule::NonZero));
            x += 8;
        }
    }
}

/// What an edge covers of eight pixels.
#[inline(always)]
fn area<S: Simd>(simd: S, ramp: &Ramp, x: i32) -> i32x8<S> {
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

/// Rows between two steep edges, eight at a time.
#[simd]
fn steep_rows<S: Simd, K: Sink<S>>(
    simd: S,
    between: &Between,
    rows: (i32, i32),
    top: i32,
    width: usize,
    sink: &mut K,
) {
    let (one, zero) = (i32x8::splat(simd, ONE), i32x8::splat(simd, 0));
    let limit = (width as i32) << BITS;
    let mut left = Eight::new(simd, &between.left, rows.0, limit);
    let mut right = Eight::new(simd, &between.right, rows.0, limit);
    let (mut packed, mut columns) = ([0_u32; 8], [0_i32; 8]);
    let mut row = rows.0;
    while row < rows.1 {
        let (l, l0, l1) = left.next(simd);
        let (r, r0, r1) = right.next(simd);
        // What the right edge takes of the four pixels from the left one's first on.
        let apart = r - l;
        let (same, next) = (apart.simd_eq(zero), apart.simd_eq(i32x8::splat(simd, 1)));
        let c0 = lanes(simd, l0 - same.select(r0, zero), FillRule::NonZero);
        let c1 = lanes(simd, l1 - same.select(r1, next.select(r0, zero)), FillRule::NonZero);
        let c2 = lanes(simd, one - same.select(one, next.select(r1, r0)), FillRule::NonZero);
        let after = same.select(one, next.select(one, r1));
        let c3 = lanes(simd, one - after, FillRule::NonZero);
        (c0 | (c1 << 8) | (c2 << 16) | (c3 << 24)).store_slice(&mut packed);
        l.store_slice(&mut columns);
        for ((row, column), packed) in (row..rows.1).zip(&columns).zip(&packed) {
            sink.four(simd, row - top, *column as usize, *packed);
        }
        row += 8;
    }
}

/// A steep edge in the next eight rows.
struct Eight<S: Simd> {
    /// The left end in the first of them, 32.32, and its change in eight rows.
    left: i64,
    step: i64,
    /// What that is more in each of the rows, 16.16, and the bits below.
    whole: i32x8<S>,
    below: i32x8<S>,
    across: i32x8<S>,
    half_inverse: f32,
    limit: i32x8<S>,
}

impl<S: Simd> Eight<S> {
    /// From a row on.
    #[inline(always)]
    fn new(simd: S, side: &Side, row: i32, limit: i32) -> Self {
        let lane = i32x8::from_slice(simd, &[0, 1, 2, 3, 4, 5, 6, 7]);
        let slope = side.steps.slope;
        let across = (slope.unsigned_abs() >> BITS) as i32;
        Self {
            left: side.left(row),
            step: 8 * slope,
            whole: lane * i32x8::splat(simd, (slope >> BITS) as i32),
            below: lane * i32x8::splat(simd, slope as i32 & (ONE - 1)),
            across: i32x8::splat(simd, across),
            half_inverse: half_inverse(across),
            limit: i32x8::splat(simd, limit),
        }
    }

    /// The first pixel touched in each of the rows, and what is covered of it and the next; then eight rows on.
    #[inline(always)]
    fn next(&mut self, simd: S) -> (i32x8<S>, i32x8<S>, i32x8<S>) {
        let (one, zero) = (i32x8::splat(simd, ONE), i32x8::splat(simd, 0));
        let below = self.below + i32x8::splat(simd, self.left as i32 & (ONE - 1));
        let x = self.whole + i32x8::splat(simd, (self.left >> BITS) as i32) + (below >> BITS);
        self.left += self.step;
        let x = x.max(zero).min(self.limit);
        let a = x & i32x8::splat(simd, ONE - 1);
        let b = a + self.across;
        let over = simd.cvt_f32_i32x8((b - one).max(zero));
        let d2 = simd.cvt_i32_f32x8(over * over * f32x8::splat(simd, self.half_inverse));
        let d0 = (one + d2 - ((a + b) >> 1)).max(zero);
        (x >> BITS, d0, one - d2)
    }
}

/// One row, eight pixels at a time.
#[simd]
fn one_row<S: Simd, K: Sink<S>>(
    simd: S,
    sides: &[Side; 4],
    (row, top): (i32, i32),
    width: usize,
    sink: &mut K,
) {
    let limit = (width as i32) << BITS;
    let mut ramps = [(Ramp::default(), 0); 4];
    let (mut low, mut high, mut count) = (i32::MAX, 0, 0);
    for side in sides {
        if let Some(ramp) = side.ramp(row, limit) {
            (low, high) = (low.min(ramp.first), high.max(ramp.last));
            ramps[count & 3] = (ramp, (side.edge.sign() - 1) >> 1);
            count += 1;
        }
    }
    let mut x = low;
    while x <= high && (x as usize) < width {
        let mut sum = i32x8::splat(simd, 0);
        for (ramp, flip) in ramps.iter().take(count) {
            let flip = i32x8::splat(simd, *flip);
            sum = sum + (area(simd, ramp, x) ^ flip) - flip;
        }
        sink.eight(simd, row - top, x as usize, lanes(simd, sum, FillRule::NonZero));
        x += 8;
    }
}
