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

/// The parts of a triangle's edges in one row.
#[derive(Debug, Clone, Copy)]
pub struct RowEdges([Option<RowEdge>; 3]);

impl RowEdges {
    #[inline(always)]
    pub fn new(t: &ScreenTriangle, slopes: &Slopes, y: i32) -> Self {
        let edge = |i| RowEdge::new(t, slopes, i, y);
        // Not by `map`, which would be a call.
        Self([edge(0), edge(1), edge(2)])
    }

    /// The columns among x0 … x1 − 1 that the triangle may touch, as first and end.
    #[inline(always)]
    pub fn columns(&self, [x0, x1]: [i32; 2]) -> [i32; 2] {
        let (mut lo, mut hi) = (f32::INFINITY, f32::NEG_INFINITY);
        for edge in self.0.iter().flatten() {
            lo = lo.min(edge.left);
            hi = hi.max(edge.right);
        }
        // Where lo is negative, rounding towards zero is as good: x0 is not.
        [(lo as i32).max(x0), (hi as i32).saturating_add(1).min(x1)]
    }
}

impl Areas {
    /// The areas that a triangle covers of pixels first … end − 1, 0 … 1.
    #[inline(always)]
    pub fn of(&mut self, edges: &RowEdges, [first, end]: [i32; 2]) -> &[f32] {
        self.changes.clear();
        self.first = first;
        let count = (end - first) as usize;
        let (from, end) = (first as f32, end as f32);
        self.changes.resize(count + 1, 0.0);
        for edge in edges.0.iter().flatten() {
            self.add(edge, from, end);
        }
        let mut sum = 0.0;
        for area in &mut self.changes[..count] {
            sum += *area;
            *area = sum.clamp(0.0, 1.0);
        }
        &self.changes[..count]
    }

    /// Adds an edge's share; what lies left of `from` covers all pixels, what lies right of `end` none.
    #[inline(always)]
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
            let next = ((x as i32 + 1) as f32).min(right);
            self.add_piece(x, next, per_pixel * (next - x));
            x = next;
        }
    }

    /// Adds a piece of an edge within one pixel, of this signed height.
    #[inline(always)]
    fn add_piece(&mut self, x0: f32, x1: f32, height: f32) {
        let column = x0 as i32;
        let pixel = (column - self.first).max(0) as usize;
        let right_of_it = 0.5 * (x0 + x1) - column as f32;
        if let Some([here, next]) = self.changes.get_mut(pixel..pixel + 2) {
            *here += height * (1.0 - right_of_it);
            *next += height * right_of_it;
        }
    }
}

/// How far each edge goes to the right per step down; 0 where it is horizontal.
pub type Slopes = [f64; 3];

/// The slopes of a triangle's edges.
pub fn slopes(t: &ScreenTriangle) -> Slopes {
    [0, 1, 2].map(|i| {
        let [a, b] = upper_and_lower(t, i);
        let down = t.y[b] - t.y[a];
        if down == 0 { 0.0 } else { f64::from(t.x[b] - t.x[a]) / f64::from(down) }
    })
}

/// The vertices of edge `i`: both triangles at an edge count from its upper end, so that they get
/// the same numbers.
#[inline(always)]
fn upper_and_lower(t: &ScreenTriangle, i: usize) -> [usize; 2] {
    let j = (i + 1) % 3;
    if t.y[j] < t.y[i] { [j, i] } else { [i, j] }
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
    #[inline(always)]
    fn new(t: &ScreenTriangle, slopes: &Slopes, i: usize, y: i32) -> Option<Self> {
        let [a, b] = upper_and_lower(t, i);
        let (top, bottom) = (y * SUBPIXELS, (y + 1) * SUBPIXELS);
        let (y0, y1) = (t.y[a].max(top), t.y[b].min(bottom));
        if y0 >= y1 {
            return None;
        }
        let at = |y: i32| {
            let x = f64::from(t.x[a]) + slopes[i] * f64::from(y - t.y[a]);
            (x / f64::from(SUBPIXELS)) as f32
        };
        let (x0, x1) = (at(y0), at(y1));
        let height = (y1 - y0) as f32 / SUBPIXELS as f32;
        let height = if a != i { height } else { -height };
        Some(Self { left: x0.min(x1), right: x0.max(x1), height })
    }
}
