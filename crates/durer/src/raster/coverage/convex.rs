//! Triangles and thin strips, as most lines are: coverage without cells.
//!
//! Few edges cross a row, mostly two. So each row is summed immediately, from the same integers that [`super::cells`]
//! would add up: eight pixels at a time, or eight rows at a time between two steep edges less than two pixels apart, as
//! in thin lines.

use fearless_simd::i32x8;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

use super::FillRule;
use super::edge::{BITS, Edge, ONE, Steps, snap};
use super::ramp::{Eight, Ramp, area, half_inverse};
use super::sweep::{Sink, lanes};
use super::turns::is_convex;
use crate::math::DVec2;
use crate::raster::bands::BAND_ROWS;

/// Edges of an outline at most.
const MOST_EDGES: usize = 4;
/// Number of fully covered pixels from which a separate span pays off.
const FULL: i32 = 8;
/// Wider strips, in pixels, are filled as other paths are.
const THIN: f64 = 4.0;

/// A thin convex quadrilateral inside the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Strip {
    /// 16.16 pixels, around.
    corners: [(i32, i32); 4],
}

impl Strip {
    /// Creates the strip with these corners; `None` if it is not thin, not convex or not inside a target of
    /// the given size.
    pub fn new(corners: [DVec2; 4], width: u32, height: u32) -> Option<Self> {
        let size = DVec2::new(f64::from(width), f64::from(height));
        let inside = |p: &DVec2| p.cmpge(DVec2::ZERO).all() && p.cmple(size).all();
        let sides =
            (corners[0].distance_squared(corners[1]), corners[1].distance_squared(corners[2]));
        let thin = sides.0.min(sides.1) <= THIN * THIN;
        (thin && corners.iter().all(inside) && is_convex(&corners))
            .then(|| Self { corners: corners.map(snap) })
    }

    /// Returns the first row touched and one past the last.
    pub fn rows(&self) -> (i32, i32) {
        let ys = self.corners.map(|c| c.1);
        let (low, high) = ys.iter().fold((i32::MAX, 0), |(l, h), y| (l.min(*y), h.max(*y)));
        (low >> BITS, (high + ONE - 1) >> BITS)
    }

    /// Returns its edges, around.
    #[inline(always)]
    pub fn edges(&self) -> [Edge; 4] {
        let [a, b, c, d] = self.corners;
        [Edge::new(a, b), Edge::new(b, c), Edge::new(c, d), Edge::new(d, a)]
    }
}

/// One edge and its steps from row to row.
#[derive(Debug, Clone, Copy, Default)]
struct Side {
    edge: Edge,
    steps: Steps,
    half_inverse: f32,
    /// The rows it touches, and the first and one past the last that it crosses from top to bottom.
    rows: (i32, i32),
    whole: (i32, i32),
}

impl Side {
    #[inline(always)]
    fn new(edge: &Edge) -> Self {
        let whole = ((edge.y0 + ONE - 1) >> BITS, edge.y1 >> BITS);
        let steps = edge.steps();
        let half_inverse = half_inverse((steps.slope.unsigned_abs() >> BITS) as i32);
        Self { edge: *edge, steps, half_inverse, rows: edge.rows(), whole }
    }

    /// Returns the coverage of a row's pixels; nothing if it does not touch the row.
    #[inline(always)]
    fn ramp(&self, row: i32, limit: i32) -> Option<Ramp> {
        let Edge { x0, x1, y0, y1, .. } = self.edge;
        if row < self.rows.0 || row >= self.rows.1 {
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

    /// Returns the coverage of a row that it crosses from top to bottom.
    #[inline(always)]
    fn whole_ramp(&self, row: i32, limit: i32) -> Ramp {
        let slope = self.steps.slope;
        if self.is_steep() {
            let across = (slope.unsigned_abs() >> BITS) as i32;
            return Ramp::steep((self.left(row) >> BITS) as i32, across, self.half_inverse, limit);
        }
        let x = self.steps.at(row - self.whole.0);
        Ramp::new((x >> BITS) as i32, ((x + slope) >> BITS) as i32, ONE, limit)
    }

    /// Returns the left end of its crossing of a whole row, 32.32.
    #[inline(always)]
    fn left(&self, row: i32) -> i64 {
        self.steps.at(row - self.whole.0) + self.steps.slope.min(0)
    }

    /// Returns whether it crosses at most two pixels of a row.
    #[inline(always)]
    fn is_steep(&self) -> bool {
        self.steps.slope.unsigned_abs() <= 1 << 32
    }
}

/// Fills a convex outline inside the target, in the band at row `top`; the outline's rows are `rows`, and the target's
/// rows have `width` pixels.
#[simd]
pub(crate) fn fill<S: Simd, K: Sink<S>>(
    simd: S,
    edges: &[Edge],
    rows: (i32, i32),
    top: i32,
    width: usize,
    sink: &mut K,
) {
    let (mut row, end) = (rows.0.max(top), rows.1.min(top + BAND_ROWS));
    let (mut sides, mut count) = ([Side::default(); MOST_EDGES], 0);
    for edge in edges.iter().take(MOST_EDGES) {
        let (first, last) = edge.rows();
        if first < end && last > row && edge.y0 < edge.y1 {
            sides[count] = Side::new(edge);
            count += 1;
        }
    }
    let sides = sides.get(..count).unwrap_or_default();
    while row < end {
        if let Some(pair) = pair(sides, row, end) {
            if pair.narrow(row) {
                steep_rows(simd, &pair, (row, pair.end), top, width, sink);
            } else {
                wide_rows(simd, &pair, (row, pair.end), top, width, sink);
            }
            row = pair.end;
        } else {
            one_row(simd, sides, (row, top), width, sink);
            row += 1;
        }
    }
}

/// Two edges that alone cross rows, from top to bottom.
struct Pair {
    left: Side,
    right: Side,
    /// One past the last of the rows.
    end: i32,
}

impl Pair {
    /// Returns whether both are steep and never more than two pixels apart from a row on.
    #[inline(always)]
    fn narrow(&self, row: i32) -> bool {
        let gap = |row: i32| self.right.left(row) - self.left.left(row);
        // Some slack, because rounding separately moves the edges of the pair.
        let fits = |gap: i64| (1 << BITS..(2 << 32) - (1 << BITS)).contains(&gap);
        self.left.is_steep() && self.right.is_steep() && fits(gap(row)) && fits(gap(self.end - 1))
    }
}

/// Returns the two edges that alone cross the rows from one on, if there are just two.
#[inline(always)]
fn pair(sides: &[Side], row: i32, end: i32) -> Option<Pair> {
    let (mut count, mut end) = (0, end);
    let mut found = [Side::default(); 2];
    for side in sides {
        if side.rows.0 > row {
            end = end.min(side.rows.0);
        } else if side.rows.1 > row {
            if row < side.whole.0 || row >= side.whole.1 || count == 2 {
                return None;
            }
            found[count] = *side;
            count += 1;
            end = end.min(side.whole.1);
        }
    }
    let [p, q] = found;
    let (left, right) = if p.left(row) <= q.left(row) { (p, q) } else { (q, p) };
    (count == 2).then_some(Pair { left, right, end })
}

/// Fills rows between two edges, eight pixels at a time.
#[simd]
fn wide_rows<S: Simd, K: Sink<S>>(
    simd: S,
    pair: &Pair,
    rows: (i32, i32),
    top: i32,
    width: usize,
    sink: &mut K,
) {
    let limit = (width as i32) << BITS;
    for row in rows.0..rows.1 {
        let (left, right) = (pair.left.whole_ramp(row, limit), pair.right.whole_ramp(row, limit));
        let high = left.last.max(right.last).min(width as i32 - 1);
        let mut x = left.first.min(right.first);
        while x <= high {
            if x > left.last && x + FULL <= right.first {
                // All of these are inside.
                sink.span(simd, row - top, x as usize..right.first as usize, 255);
                x = right.first;
                continue;
            }
            let sum = area(simd, &left, x) - area(simd, &right, x);
            sink.eight(simd, row - top, x as usize, lanes(simd, sum, FillRule::NonZero));
            x += 8;
        }
    }
}

/// Fills rows between two steep edges, eight rows at a time.
#[simd]
fn steep_rows<S: Simd, K: Sink<S>>(
    simd: S,
    pair: &Pair,
    rows: (i32, i32),
    top: i32,
    width: usize,
    sink: &mut K,
) {
    let (one, zero) = (i32x8::splat(simd, ONE), i32x8::splat(simd, 0));
    let limit = (width as i32) << BITS;
    let mut left = Eight::new(simd, pair.left.left(rows.0), pair.left.steps.slope, limit);
    let mut right = Eight::new(simd, pair.right.left(rows.0), pair.right.steps.slope, limit);
    let (mut packed, mut columns) = ([0_u32; 8], [0_i32; 8]);
    let mut row = rows.0;
    while row < rows.1 {
        let [l, l0, l1, _] = left.next(simd);
        let [r, r0, r1, _] = right.next(simd);
        // The coverage that the right edge subtracts from the four pixels beginning at the left edge's first one.
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

/// Fills one row, eight pixels at a time.
#[simd]
fn one_row<S: Simd, K: Sink<S>>(
    simd: S,
    sides: &[Side],
    (row, top): (i32, i32),
    width: usize,
    sink: &mut K,
) {
    let limit = (width as i32) << BITS;
    let mut ramps = [(Ramp::default(), 0); MOST_EDGES];
    let (mut low, mut high, mut count) = (i32::MAX, 0, 0);
    for side in sides {
        if let Some(ramp) = side.ramp(row, limit) {
            (low, high) = (low.min(ramp.first), high.max(ramp.last));
            ramps[count & (MOST_EDGES - 1)] = (ramp, (side.edge.sign() - 1) >> 1);
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
