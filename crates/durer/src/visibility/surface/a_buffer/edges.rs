//! The three edges of a face, side by side: their parts in a row of pixels, and the sub-pixels of a
//! pixel that lie inside them.

use super::mask::{Common, Direction, EIGHT, MaskTable};
use crate::raster::fixed::{HALF_PIXEL, SUBPIXELS};
use crate::visibility::surface::gather::narrowed;
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::{Simd, f32x4, f32x8, f64x4, f64x8, mask64x4, prelude::*};

/// Numbers of the three edges; the fourth lane has no edge.
type Lanes<T> = [T; 4];

/// Edge functions have slopes per grid step; masks want them per pixel.
const PER_GRID_STEP: f32 = 1.0 / SUBPIXELS as f32;

/// Values of a face's edges that need a division.
#[derive(Debug, Clone, Copy)]
pub struct Slopes {
    /// Grid steps to the right per step down; 0 where the edge is horizontal.
    right_per_down: Lanes<f64>,
    directions: [Direction; 3],
}

impl Slopes {
    /// Values of no edges.
    pub const NONE: Self = Self { right_per_down: [0.0; 4], directions: [Direction::NONE; 3] };

    #[inline(always)]
    pub fn new<S: Simd>(simd: S, t: &ScreenTriangle) -> Self {
        let edges = Edges::new(simd, t);
        let zero = f64x4::splat(simd, 0.0);
        let ([upper_x, upper_y], [lower_x, lower_y]) = (edges.upper(), edges.lower());
        let down = lower_y - upper_y;
        let right_per_down = down.simd_eq(zero).select(zero, (lower_x - upper_x) / down);
        let [a, b]: [Lanes<f64>; 2] = edges.gain().map(|gain| gain.into());
        let direction = |i: usize| Direction::new(a[i] as f32, b[i] as f32);
        // No `map`, which would be a call.
        let directions = [direction(0), direction(1), direction(2)];
        Self { right_per_down: right_per_down.into(), directions }
    }

    /// Returns the divisor of each direction's function, with its sign.
    #[inline(always)]
    fn scale<S: Simd>(&self, simd: S) -> f32x4<S> {
        let [p, q, r] = &self.directions;
        [p.scale, q.scale, r.scale, 0.0].simd_into(simd)
    }
}

/// The three edges of a face, in grid steps.
#[derive(Clone, Copy)]
pub struct Edges<S: Simd> {
    from: [f64x4<S>; 2],
    to: [f64x4<S>; 2],
    /// True for edges that go up. Both triangles at an edge start from its upper end, so that they get the same
    /// numbers.
    up: mask64x4<S>,
}

impl<S: Simd> Edges<S> {
    #[inline(always)]
    pub fn new(simd: S, t: &ScreenTriangle) -> Self {
        let lanes = |[a, b, c]: [i32; 3]| -> f64x4<S> {
            [f64::from(a), f64::from(b), f64::from(c), 0.0].simd_into(simd)
        };
        let ([x0, x1, x2], [y0, y1, y2]) = (t.x, t.y);
        let from = [lanes(t.x), lanes(t.y)];
        let to = [lanes([x1, x2, x0]), lanes([y1, y2, y0])];
        Self { from, to, up: to[1].simd_lt(from[1]) }
    }

    #[inline(always)]
    fn upper(&self) -> [f64x4<S>; 2] {
        let ([x0, y0], [x1, y1]) = (self.from, self.to);
        [self.up.select(x1, x0), self.up.select(y1, y0)]
    }

    #[inline(always)]
    fn lower(&self) -> [f64x4<S>; 2] {
        let ([x0, y0], [x1, y1]) = (self.from, self.to);
        [self.up.select(x0, x1), self.up.select(y0, y1)]
    }

    /// Returns the increase of the edge functions per grid step to the right and downwards;
    /// positive is inside.
    #[inline(always)]
    fn gain(&self) -> [f64x4<S>; 2] {
        let ([x0, y0], [x1, y1]) = (self.from, self.to);
        [y0 - y1, x1 - x0]
    }

    /// Returns the parts of the edges in row `y`.
    #[inline(always)]
    pub fn row(&self, simd: S, slopes: &Slopes, y: i32) -> RowEdges<S> {
        let ([x, top], [_, bottom]) = (self.upper(), self.lower());
        let slope = f64x4::simd_from(simd, slopes.right_per_down);
        let row = f64::from(y) * f64::from(SUBPIXELS);
        let y0 = top.max(f64x4::splat(simd, row));
        let y1 = bottom.min(f64x4::splat(simd, row + f64::from(SUBPIXELS)));
        let there = y0.simd_lt(y1);
        let per_step = f64x4::splat(simd, 1.0 / f64::from(SUBPIXELS));
        let x0 = (x + slope * (y0 - top)) * per_step;
        let x1 = (x + slope * (y1 - top)) * per_step;
        let (none, infinity) = (f64x4::splat(simd, 0.0), f64x4::splat(simd, f64::INFINITY));
        let left = there.select(x0.min(x1), infinity);
        let right = there.select(x0.max(x1), -infinity);
        // Positive where the inside is to the right.
        let height = there.select((y1 - y0) * self.up.select(per_step, -per_step), none);
        let (left, right) = simd.split_f32x8(simd.narrow_f64x4(left, right));
        let (height, _) = simd.split_f32x8(simd.narrow_f64x4(height, none));
        RowEdges { left, right, height }
    }

    /// Returns the edge functions along a row of pixels.
    #[inline(always)]
    pub fn functions(&self, simd: S, x: i32, y: i32) -> Functions<S> {
        let center = |i: i32| {
            let steps = f64::from(i) * f64::from(SUBPIXELS) + f64::from(HALF_PIXEL);
            f64x4::splat(simd, steps)
        };
        // Exact: the guard band leaves room for products and sums.
        let ([a, b], [x0, y0]) = (self.gain(), self.from);
        let first = a * (center(x) - x0) + b * (center(y) - y0);
        let step = a * f64::from(SUBPIXELS);
        Functions { first: first.into(), step: step.into(), gain: [a, b] }
    }
}

/// The edge functions along a row of pixels, in grid steps squared.
pub struct Functions<S: Simd> {
    first: Lanes<f64>,
    step: Lanes<f64>,
    gain: [f64x4<S>; 2],
}

/// Offset of each of eight pixels to the right of the first.
const COLUMNS_F64: [f64; EIGHT] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

impl<S: Simd> Functions<S> {
    /// Returns the edge functions at the centres of eight pixels; the first is this many columns after the first of the
    /// row.
    #[inline(always)]
    pub fn at(&self, simd: S, columns: usize) -> [f32x8<S>; 3] {
        let columns = f64x8::from_slice(simd, &COLUMNS_F64) + columns as f64;
        let mut at = [f32x8::splat(simd, 0.0); 3];
        for (i, at) in at.iter_mut().enumerate() {
            let exact = columns * self.step[i] + self.first[i];
            *at = narrowed(simd, exact);
        }
        at
    }

    /// Returns the sub-pixel deepest inside a triangle that is too small for its mask, given its edge functions at the
    /// pixel's centre.
    #[inline(always)]
    pub fn nearest(&self, simd: S, slopes: &Slopes, table: &MaskTable, at: Lanes<f32>) -> u64 {
        let scale = slopes.scale(simd).abs();
        let [a, b] = self.gain;
        let (a, b) = simd.split_f32x8(simd.narrow_f64x4(a, b));
        let at = f32x4::simd_from(simd, at) * PER_GRID_STEP;
        let (at, a, b): (Lanes<f32>, Lanes<f32>, Lanes<f32>) =
            ((at * scale).into(), (a * scale).into(), (b * scale).into());
        let nowhere = f32x8::splat(simd, f32::NEG_INFINITY);
        let (mut depths, mut greatest) = ([nowhere; 8], nowhere);
        let centers = table.centers_x8();
        for (depth, [u, v]) in depths.iter_mut().zip(centers) {
            let (u, v) = (f32x8::simd_from(simd, *u), f32x8::simd_from(simd, *v));
            let d0 = (u * a[0] + v * b[0]) + at[0];
            let d1 = (u * a[1] + v * b[1]) + at[1];
            let d2 = (u * a[2] + v * b[2]) + at[2];
            *depth = d0.min(d1).min(d2);
            greatest = greatest.max(*depth);
        }
        let (low, high) = simd.split_f32x8(greatest);
        let greatest = f32x8::splat(simd, simd.reduce_max_f32x4(low.max(high)));
        for (i, depth) in depths[..centers.len()].iter().enumerate() {
            let found = depth.simd_ge(greatest).to_bitmask();
            if found != 0 {
                return 1 << (8 * i as u32 + found.trailing_zeros());
            }
        }
        0
    }
}

impl Slopes {
    /// Returns the sub-pixels inside all three edges in eight pixels, whose functions at the centres
    /// are these.
    #[inline(always)]
    pub fn masks<S: Simd>(&self, simd: S, table: &MaskTable, [p, q, r]: [f32x8<S>; 3]) -> Common {
        let [a, b, c] = &self.directions;
        table.common(simd, SUBPIXELS as f32, [(a, p), (b, q), (c, r)])
    }
}

/// The parts of a triangle's edges in one row, each from left to right.
///
/// An edge that is horizontal or outside the row has a part of zero height that covers no column.
#[derive(Clone, Copy)]
pub struct RowEdges<S: Simd> {
    pub left: f32x4<S>,
    pub right: f32x4<S>,
    /// Pixels downwards; positive where the inside is to the right.
    pub height: f32x4<S>,
}

impl<S: Simd> RowEdges<S> {
    /// Returns the columns among x0 … x1 − 1 that the triangle may touch, as first and end.
    #[inline(always)]
    pub fn columns(&self, simd: S, [x0, x1]: [i32; 2]) -> [i32; 2] {
        let (lo, hi) = (simd.reduce_min_f32x4(self.left), simd.reduce_max_f32x4(self.right));
        // If lo is negative, rounding towards zero is as good: x0 is not negative.
        [(lo as i32).max(x0), (hi as i32).saturating_add(1).min(x1)]
    }
}
