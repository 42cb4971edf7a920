//! The samples that a triangle covers, and its depths there: exactly as the z-buffer decides.

use crate::raster::fixed::SUBPIXELS;
use crate::raster::span::Span;
use crate::visibility::surface::setup::ScreenTriangle;
use crate::visibility::surface::window::{SampleRect, WindowRelation};

/// Samples in rows and columns, 2^`shift` a pixel on each axis, at the centres of their squares.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SampleGrid {
    /// 0 … [`SampleGrid::MAX_SHIFT`].
    shift: u32,
}

impl SampleGrid {
    /// One sample a pixel, at its centre.
    pub const PIXELS: Self = Self { shift: 0 };

    /// 256 samples per pixel; with more, intermediate depths would be rounded.
    pub const MAX_SHIFT: u32 = 4;

    /// Creates a grid of 4^`levels` samples per pixel, at most as many as [`Self::MAX_SHIFT`] allows.
    pub fn below_pixel(levels: u32) -> Self {
        Self { shift: levels.min(Self::MAX_SHIFT) }
    }

    /// Returns the number of samples along the side of a pixel.
    pub fn per_pixel(self) -> i32 {
        1 << self.shift
    }

    /// Returns the distance of two neighbours in 1/256 pixel.
    fn step(self) -> i32 {
        SUBPIXELS >> self.shift
    }

    /// Returns the position of a column's or row's sample, in 1/256 pixel.
    fn place(self, index: i32) -> i64 {
        i64::from(index) * i64::from(self.step()) + i64::from(self.step() / 2)
    }

    /// Returns the first column or row whose sample is not before a coordinate in 1/256 pixel.
    pub fn first_at(self, fixed: i32) -> i32 {
        let step = self.step();
        (fixed - step / 2 + step - 1).div_euclid(step)
    }

    /// Returns the depth of a triangle's plane at a sample, kept to the range of its vertices'
    /// depths.
    #[inline]
    pub fn depth(self, t: &ScreenTriangle, x: i32, y: i32) -> f32 {
        let [dx, dy] = self.offset(t, x, y);
        t.depth_at(dx, dy)
    }

    /// Returns the vector from the centre of a triangle's origin pixel to a sample, in pixels; exact.
    #[inline]
    pub fn offset(self, t: &ScreenTriangle, x: i32, y: i32) -> [f32; 2] {
        let [ox, oy] = t.origin();
        if self.shift == 0 {
            return [(x - ox) as f32, (y - oy) as f32];
        }
        let away = |index: i32, origin: i32| {
            (self.place(index) - Self::PIXELS.place(origin)) as f32 / SUBPIXELS as f32
        };
        [away(x, ox), away(y, oy)]
    }
}

/// The edge functions of a triangle over a grid of samples, with the top-left rule.
#[derive(Debug, Clone, Copy)]
pub struct Cover {
    /// At sample (0, 0); ≥ 0 inside.
    edge: [i64; 3],
    step_x: [i64; 3],
    step_y: [i64; 3],
    /// The samples of the bounding box.
    pub bounds: SampleRect,
}

impl Cover {
    /// Prepares a triangle.
    pub fn new(t: &ScreenTriangle, grid: SampleGrid) -> Self {
        let (mut edge, mut step_x, mut step_y) = ([0; 3], [0; 3], [0; 3]);
        let (s, step) = (grid.place(0), i64::from(grid.step()));
        for i in 0..3 {
            let j = (i + 1) % 3;
            let (dx, dy) = (i64::from(t.x[j] - t.x[i]), i64::from(t.y[j] - t.y[i]));
            let top_left = dy < 0 || (dy == 0 && dx > 0);
            let value = dx * (s - i64::from(t.y[i])) - dy * (s - i64::from(t.x[i]));
            edge[i] = value - i64::from(!top_left);
            (step_x[i], step_y[i]) = (-dy * step, dx * step);
        }
        let range = |v: &[i32; 3]| {
            let (lo, hi) = (v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2]));
            (grid.first_at(lo), grid.first_at(hi + 1))
        };
        let ((x0, x1), (y0, y1)) = (range(&t.x), range(&t.y));
        Self { edge, step_x, step_y, bounds: SampleRect { x0, y0, x1, y1 } }
    }

    /// Returns the function of edge `i`, from vertex `i` to the next, at a sample.
    #[inline]
    pub fn edge_at(&self, i: usize, x: i32, y: i32) -> i64 {
        self.edge[i] + self.step_x[i] * i64::from(x) + self.step_y[i] * i64::from(y)
    }

    /// Returns whether a sample is covered.
    #[inline]
    pub fn covers(&self, x: i32, y: i32) -> bool {
        (self.edge_at(0, x, y) | self.edge_at(1, x, y) | self.edge_at(2, x, y)) >= 0
    }

    /// Returns the relation of the triangle to a window that is not empty; `Outside` is certain,
    /// and so is `Surrounding`.
    pub fn relation(&self, w: &SampleRect) -> WindowRelation {
        if self.bounds.and(w).is_empty() {
            return WindowRelation::Outside;
        }
        if self.bounds.within(w) {
            return WindowRelation::Inside;
        }
        let (across, down) = (i64::from(w.x1 - 1 - w.x0), i64::from(w.y1 - 1 - w.y0));
        let mut surrounds = true;
        for i in 0..3 {
            let at = self.edge_at(i, w.x0, w.y0);
            let (dx, dy) = (self.step_x[i] * across, self.step_y[i] * down);
            if at + dx.max(0) + dy.max(0) < 0 {
                return WindowRelation::Outside;
            }
            surrounds &= at + dx.min(0) + dy.min(0) >= 0;
        }
        if surrounds { WindowRelation::Surrounding } else { WindowRelation::Crossing }
    }

    /// Emits the covered samples of a window, row by row.
    pub fn spans(&self, w: &SampleRect, mut emit: impl FnMut(Span)) {
        let w = self.bounds.and(w);
        for y in w.y0..w.y1 {
            let (mut x0, mut x1) = (i64::from(w.x0), i64::from(w.x1));
            for i in 0..3 {
                let (at, step) = (self.edge_at(i, 0, y), self.step_x[i]);
                match step.signum() {
                    1 => x0 = x0.max(-at.div_euclid(step)),
                    -1 => x1 = x1.min(at.div_euclid(-step) + 1),
                    _ if at < 0 => x1 = x0,
                    _ => {}
                }
            }
            Span::emit_unless_empty(y, x0 as i32, x1.max(x0) as i32, &mut emit);
        }
    }
}
