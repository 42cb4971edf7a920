//! The exact area of a triangle in each pixel of a row, eight pixels at a time.
//!
//! Each edge adds, for every pixel that it crosses, the signed area to its right; the sum along the
//! row is the covered area, as in analytic anti-aliasing of glyphs (FreeType's and AGG's cells).

use super::edges::RowEdges;
use super::mask::EIGHT;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4, f32x8};

/// Offset of each of eight pixels to the right of the first.
pub const COLUMNS: [f32; EIGHT] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

/// Position of an edge part that covers no column.
const NOWHERE: f32 = -2.0;

/// Numbers of the three edges; the fourth lane has no edge.
type Lanes = [f32; 4];

/// Coverage of the pixels of a part of a row by a triangle.
#[derive(Debug, Clone, Copy)]
pub struct Areas {
    /// The edges' parts in these pixels, from left to right.
    left: Lanes,
    right: Lanes,
    /// Height over width; 0 of upright edges.
    per_pixel: Lanes,
    /// The height of upright edges, else 0.
    upright: Lanes,
    /// Area left of the first pixel, if any edge crosses there; it covers all pixels.
    outside: Option<Lanes>,
}

impl Areas {
    /// Creates the coverage of a triangle's edges in pixels first … end − 1.
    #[inline(always)]
    pub fn new<S: Simd>(simd: S, edges: &RowEdges<S>, [first, end]: [i32; 2]) -> Self {
        let (zero, nowhere) = (f32x4::splat(simd, 0.0), f32x4::splat(simd, NOWHERE));
        let (from, end) = (f32x4::splat(simd, first as f32), f32x4::splat(simd, end as f32));
        let width = edges.right - edges.left;
        let slanted = width.simd_gt(zero);
        let per_pixel = slanted.select(edges.height / width, zero);
        let upright = slanted.select(zero, edges.height);
        let (left, right) = (edges.left.max(from), edges.right.min(end));
        // Edges that are not in the row, or are wholly beside the pixels, count as nowhere, too.
        let here = left.simd_le(right);
        let is_cut = edges.left.simd_lt(from).to_bitmask() != 0;
        let outside = is_cut.then(|| {
            let part = (edges.right.min(from) - edges.left) / width;
            let part = slanted.select(part, f32x4::splat(simd, 1.0)).min(f32x4::splat(simd, 1.0));
            edges.left.simd_lt(from).select(edges.height * part, zero).into()
        });
        Self {
            left: here.select(left, nowhere).into(),
            right: here.select(right, nowhere).into(),
            per_pixel: per_pixel.into(),
            upright: upright.into(),
            outside,
        }
    }

    /// Returns the changes of the area by the edges in eight pixels from column x on: from each on, and
    /// from the pixel after each on. `is_first` says that the first pixel of the row's part is the
    /// first of them.
    #[inline(always)]
    pub fn changes<S: Simd>(&self, simd: S, x: i32, is_first: bool) -> [[f32; EIGHT]; 2] {
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let column = f32x8::from_slice(simd, &COLUMNS) + x as f32;
        let after = column + one;
        let (mut here, mut next) = (zero, zero);
        for i in 0..3 {
            if let Some(outside) = self.outside.filter(|_| is_first) {
                let mut first = [0.0; EIGHT];
                first[0] = outside[i];
                here += f32x8::from_slice(simd, &first);
            }
            let (left, right) =
                (f32x8::splat(simd, self.left[i]), f32x8::splat(simd, self.right[i]));
            // The edge's part within each pixel; none is of negative width.
            let (x0, x1) = (left.max(column), right.min(after));
            let mut height = (x1 - x0).max(zero) * self.per_pixel[i];
            if self.upright[i] != 0.0 {
                let there = column.simd_le(left) & left.simd_lt(after);
                height += there.select(f32x8::splat(simd, self.upright[i]), zero);
            }
            let right_of_it = (x0 + x1) * 0.5 - column;
            here += height * (one - right_of_it);
            next += height * right_of_it;
        }
        [here.into(), next.into()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::dispatch;
    use crate::simd::levels;

    /// Edges such that the inside is right of the first and left of the second.
    const LEFT: Lanes = [2.25, 21.0, f32::INFINITY, f32::INFINITY];
    const RIGHT: Lanes = [11.5, 21.0, f32::NEG_INFINITY, f32::NEG_INFINITY];
    const HEIGHT: Lanes = [0.75, -0.75, 0.0, 0.0];

    fn areas<S: Simd>(simd: S, [first, end]: [i32; 2]) -> Vec<f32> {
        let [left, right, height] =
            [LEFT, RIGHT, HEIGHT].map(|lanes| f32x4::simd_from(simd, lanes));
        let areas = Areas::new(simd, &RowEdges { left, right, height }, [first, end]);
        let (mut found, mut sum) = (Vec::new(), 0.0);
        for x in (first..end).step_by(EIGHT) {
            let [here, next] = areas.changes(simd, x, x == first);
            for (here, next) in here.into_iter().zip(next) {
                found.push(sum + here);
                sum += here + next;
            }
        }
        found.truncate((end - first) as usize);
        found
    }

    /// Returns the area right of the slanted edge and left of the upright one.
    fn expected(x: i32) -> f32 {
        let right_of = |x: f32| {
            let t = ((x - LEFT[0]) / (RIGHT[0] - LEFT[0])).clamp(0.0, 1.0);
            0.5 * t * t * (RIGHT[0] - LEFT[0]) + (x - RIGHT[0]).max(0.0)
        };
        let x = x as f32;
        if x < 21.0 { 0.75 * (right_of(x + 1.0) - right_of(x)) } else { 0.0 }
    }

    #[test]
    fn areas_are_those_of_the_shape_wherever_a_part_of_the_row_begins_and_ends() {
        for level in levels() {
            for (first, end) in [(0, 30), (2, 9), (3, 25), (5, 6), (12, 22), (0, 4), (21, 30)] {
                let found = dispatch!(level, simd => areas(simd, [first, end]));
                for (x, found) in (first..end).zip(found) {
                    let expected = expected(x);
                    assert!((found - expected).abs() < 1e-5, "{first} {x}: {found} {expected}");
                }
            }
        }
    }
}
