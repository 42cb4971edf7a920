//! The exact area of a triangle in each pixel of a row.
//!
//! Each edge adds, for every pixel that it crosses, the signed area to its right; the sum along the
//! row is the covered area, as in analytic anti-aliasing of glyphs (FreeType's and AGG's cells).

use crate::raster::fixed::SUBPIXELS;
use crate::visibility::surface::setup::ScreenTriangle;

/// The covered area of each pixel of a part of a row, for one triangle at a time.
#[derive(Debug, Default)]
pub struct Areas {
    /// Changes of the area along the row; one more than there are pixels.
    changes: Vec<f32>,
    /// The first pixel that the triangle may touch.
    first: i32,
}

impl Areas {
    /// The first column of the pixels x0 … x1 − 1 of row y that a triangle touches, and the areas
    /// from there on, 0 … 1.
    pub fn of(&mut self, t: &ScreenTriangle, y: i32, [x0, x1]: [i32; 2]) -> (i32, &[f32]) {
        let edges = [0, 1, 2].map(|i| RowEdge::new(t, i, y));
        let (mut lo, mut hi) = (f32::INFINITY, f32::NEG_INFINITY);
        for edge in edges.iter().flatten() {
            lo = lo.min(edge.left);
            hi = hi.max(edge.right);
        }
        self.changes.clear();
        let (from, end) = (lo.floor().max(x0 as f32), hi.ceil().min(x1 as f32));
        if from >= end {
            return (x0, &[]);
        }
        self.first = from as i32;
        let count = (end - from) as usize;
        self.changes.resize(count + 1, 0.0);
        for edge in edges.iter().flatten() {
            self.add(edge, from, end);
        }
        let mut sum = 0.0;
        for area in &mut self.changes[..count] {
            sum += *area;
            *area = sum.clamp(0.0, 1.0);
        }
        (self.first, &self.changes[..count])
    }

    /// Adds an edge's share; what lies left of `from` covers all pixels, what lies right of `end` none.
    fn add(&mut self, edge: &RowEdge, from: f32, end: f32) {
        let (left, right) = (edge.left.clamp(from, end), edge.right.clamp(from, end));
        let width = edge.right - edge.left;
        if edge.left < from {
            let outside =
                if width > 0.0 { (left.min(edge.right) - edge.left) / width } else { 1.0 };
            self.changes[0] += edge.height * outside.min(1.0);
        }
        if right <= left {
            if width == 0.0 && edge.left >= from && edge.left < end {
                self.add_piece(edge.left, edge.left, edge.height);
            }
            return;
        }
        let per_pixel = edge.height / width;
        let mut x = left;
        while x < right {
            let next = (x.floor() + 1.0).min(right);
            self.add_piece(x, next, per_pixel * (next - x));
            x = next;
        }
    }

    /// Adds a piece of an edge within one pixel, of this signed height.
    #[inline]
    fn add_piece(&mut self, x0: f32, x1: f32, height: f32) {
        let pixel = (x0 as i32 - self.first).max(0) as usize;
        let right_of_it = 0.5 * (x0 + x1) - x0.floor();
        if let Some([here, next]) = self.changes.get_mut(pixel..pixel + 2) {
            *here += height * (1.0 - right_of_it);
            *next += height * right_of_it;
        }
    }
}

/// The part of an edge within a row, from left to right.
#[derive(Debug, Clone, Copy)]
struct RowEdge {
    left: f32,
    right: f32,
    /// Pixels downwards; positive where the inside is to the right.
    height: f32,
}

impl RowEdge {
    /// Edge `i` of a triangle in row `y`; `None` where it is horizontal or elsewhere.
    fn new(t: &ScreenTriangle, i: usize, y: i32) -> Option<Self> {
        let j = (i + 1) % 3;
        // From the upper end, so that both triangles at an edge get the same numbers.
        let upwards = t.y[j] < t.y[i];
        let (a, b) = if upwards { (j, i) } else { (i, j) };
        let (top, bottom) = (y * SUBPIXELS, (y + 1) * SUBPIXELS);
        let (y0, y1) = (t.y[a].max(top), t.y[b].min(bottom));
        if y0 >= y1 {
            return None;
        }
        let slope = f64::from(t.x[b] - t.x[a]) / f64::from(t.y[b] - t.y[a]);
        let at = |y: i32| {
            let x = f64::from(t.x[a]) + slope * f64::from(y - t.y[a]);
            (x / f64::from(SUBPIXELS)) as f32
        };
        let (x0, x1) = (at(y0), at(y1));
        let height = (y1 - y0) as f32 / SUBPIXELS as f32;
        let height = if upwards { height } else { -height };
        Some(Self { left: x0.min(x1), right: x0.max(x1), height })
    }
}
