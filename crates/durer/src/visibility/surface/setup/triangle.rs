//! A triangle on the screen.

use crate::raster::fixed::{SUBPIXEL_BITS, first_center};
use crate::raster::triangle::SnappedTriangle;

/// A triangle on the screen: snapped vertices and the plane of its depth.
///
/// # Guarantees
/// In the order of the vertices (clockwise on the screen, whether the face is seen from the front or from behind) twice
/// the area in grid units is above 0; all numbers are finite; coordinates are inside the guard band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScreenTriangle {
    /// x of the vertices, 24.8 fixed point, pixels.
    pub x: [i32; 3],
    /// y of the vertices, 24.8 fixed point, pixels, downwards.
    pub y: [i32; 3],
    /// Depth at the centre of the pixel that holds vertex 0.
    pub depth: f32,
    /// Change of depth per pixel to the right.
    pub depth_dx: f32,
    /// Change of depth per pixel downwards.
    pub depth_dy: f32,
    /// Smallest depth of a vertex, at least 0.
    pub depth_min: f32,
    /// Largest depth of a vertex.
    pub depth_max: f32,
    /// Item index: the place of the triangle in the scene.
    pub item: u32,
}

impl ScreenTriangle {
    /// Returns the pixel that holds vertex 0; depths are counted from its centre.
    #[inline]
    pub fn origin(&self) -> [i32; 2] {
        [self.x[0] >> SUBPIXEL_BITS, self.y[0] >> SUBPIXEL_BITS]
    }

    /// Returns the corners alone, for the rasterizers of triangles.
    #[inline]
    pub fn snapped(&self) -> SnappedTriangle {
        let ([x0, x1, x2], [y0, y1, y2]) = (self.x, self.y);
        SnappedTriangle::within_guard_band([[x0, y0], [x1, y1], [x2, y2]])
    }

    /// Returns the depth at a point of the screen, `dx, dy` pixels from the centre of
    /// [`Self::origin`].
    ///
    /// Everyone who compares depths computes them by this formula, in this order of operations.
    #[inline]
    pub fn depth_at(&self, dx: f32, dy: f32) -> f32 {
        let depth = self.depth + (self.depth_dx * dx + self.depth_dy * dy);
        depth.max(self.depth_min).min(self.depth_max)
    }

    /// Returns the first and last column and row of pixels whose centres lie in the bounding box;
    /// `None` if there are none.
    #[inline]
    pub(crate) fn pixel_bounds(&self, margin: i32) -> Option<[i32; 4]> {
        let min = |v: &[i32; 3]| first_center(v[0].min(v[1]).min(v[2]) - margin);
        let max = |v: &[i32; 3]| first_center(v[0].max(v[1]).max(v[2]) + margin + 1) - 1;
        let bounds = [min(&self.x), min(&self.y), max(&self.x), max(&self.y)];
        (bounds[0] <= bounds[2] && bounds[1] <= bounds[3]).then_some(bounds)
    }
}
