//! The exact area of a triangle in each pixel of a row.
//!
//! Each edge adds, for every pixel that it crosses, the signed area to its right; the sum along the
//! row is the covered area, as in analytic anti-aliasing of glyphs (FreeType's and AGG's cells).

use super::edges::RowEdges;

/// The covered area of each pixel of a part of a row, for one triangle at a time.
#[derive(Debug)]
pub struct Areas {
    /// How edges in each pixel change the area from there on, and how from the next pixel on; one more
    /// than there are pixels. Zero between triangles.
    changes: Vec<[f32; 2]>,
    /// The first pixel that the triangle may touch, and the one after the last.
    columns: [i32; 2],
    /// The area before the next pixel's own edges.
    sum: f32,
}

impl Areas {
    /// For rows of this width.
    pub fn new(width: u32) -> Self {
        Self { changes: vec![[0.0; 2]; width as usize + 1], columns: [0; 2], sum: 0.0 }
    }

    /// Takes a triangle's edges in pixels first … end − 1.
    #[inline(always)]
    pub fn begin(&mut self, edges: &RowEdges, columns: [i32; 2]) {
        (self.columns, self.sum) = (columns, 0.0);
        for i in 0..3 {
            if edges.height[i] != 0.0 {
                self.add(edges.left[i], edges.right[i], edges.height[i]);
            }
        }
    }

    /// The area that the triangle covers, 0 … 1, of the next pixel, so many columns after the first.
    #[inline(always)]
    pub fn next(&mut self, column: usize) -> f32 {
        let Some(changes) = self.changes.get_mut(column) else { return 0.0 };
        let [here, next] = std::mem::take(changes);
        let area = self.sum + here;
        self.sum = area + next;
        area.clamp(0.0, 1.0)
    }

    /// Forgets what pixels from this one on were to get; to be called after the last one.
    #[inline(always)]
    pub fn end(&mut self, column: usize) {
        let count = (self.columns[1] - self.columns[0]) as usize;
        if let Some(rest) = self.changes.get_mut(column..=count) {
            // One, but for a row left half-way.
            rest.fill([0.0; 2]);
        }
    }

    /// Adds an edge's share; what lies left of the columns covers all pixels, what lies right of them
    /// none.
    #[inline(always)]
    fn add(&mut self, edge_left: f32, edge_right: f32, height: f32) {
        let [from, end] = self.columns.map(|column| column as f32);
        let (left, right) = (edge_left.max(from), edge_right.min(end));
        let width = edge_right - edge_left;
        let per_pixel = if width > 0.0 { height / width } else { 0.0 };
        if edge_left < from {
            let outside =
                if width > 0.0 { (edge_right.min(from) - edge_left) / width } else { 1.0 };
            self.changes[0][0] += height * outside.min(1.0);
        }
        if left > right || left >= end {
            return;
        }
        // In one pixel for the most part.
        let next = ((left as i32 + 1) as f32).min(right);
        let first = if width > 0.0 { per_pixel * (next - left) } else { height };
        self.add_piece(left, next, first);
        let mut x = next;
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
        let pixel = (column - self.columns[0]).max(0) as usize;
        let right_of_it = 0.5 * (x0 + x1) - column as f32;
        if let Some([here, next]) = self.changes.get_mut(pixel) {
            *here += height * (1.0 - right_of_it);
            *next += height * right_of_it;
        }
    }
}
