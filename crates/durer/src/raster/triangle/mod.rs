//! Triangles by three methods, with 8 sub-pixel bits and the top-left rule.
//!
//! All three decide with integers on the grid of [`super::fixed`] and emit the same spans in the same
//! order: rows downwards, one span a row. A sample exactly on an edge belongs to the triangle where
//! the edge is a left edge, or a horizontal edge above the triangle (y down); so two triangles with
//! a common edge light each pixel exactly once.
//!
//! ```
//! use durer::math::DVec2;
//! use durer::raster::triangle::{Options, SnappedTriangle, TriangleRasterizer};
//! let corners = [DVec2::new(0.5, 0.5), DVec2::new(4.5, 0.5), DVec2::new(0.5, 4.5)];
//! let triangle = SnappedTriangle::snap(corners).unwrap();
//! let mut pixels = 0;
//! let count = |s: durer::raster::Span| pixels += s.x1 - s.x0;
//! TriangleRasterizer::Tiles.rasterize(&triangle, &Options::default(), count);
//! assert_eq!(pixels, 10);
//! ```

pub mod edge_function;
pub mod edge_walking;
pub mod tiles;

use super::fixed::{self, HALF_PIXEL, SUBPIXEL_BITS, SUBPIXELS};
use super::span::Span;
use crate::math::DVec2;
use crate::trace::NoTrace;
use crate::view::window::PixelRect;
use crate::{Error, Result};

crate::info::family! {
    /// Methods to scan convert a triangle.
    pub enum TriangleRasterizer {
        /// Edge functions over the bounding box.
        EdgeFunction => edge_function::INFO,
        /// Two edges followed from scan line to scan line.
        EdgeWalking => edge_walking::INFO,
        /// Edge functions over tiles, with trivial accept and reject.
        Tiles => tiles::INFO,
    }
}

impl TriangleRasterizer {
    /// Emits the covered pixels, row by row from the top, one span a row.
    pub fn rasterize(self, triangle: &SnappedTriangle, options: &Options, emit: impl FnMut(Span)) {
        match self {
            Self::EdgeFunction => edge_function::rasterize(triangle, options, emit, &mut NoTrace),
            Self::EdgeWalking => edge_walking::rasterize(triangle, options, emit, &mut NoTrace),
            Self::Tiles => tiles::rasterize(triangle, options, emit, &mut NoTrace),
        }
    }
}

/// Options of all three.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Pixels outside are left out; those inside are the same with any clip.
    pub clip: PixelRect,
}

impl Default for Options {
    /// Returns the default: no clip but the guard band.
    fn default() -> Self {
        Self { clip: PixelRect::EVERYTHING }
    }
}

/// A triangle on the grid of 1/256 pixel, of either winding.
///
/// # Guarantees
/// All coordinates are within the guard band, so that edge functions fit into i64.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct SnappedTriangle([[i32; 2]; 3]);

/// The guard band on the grid.
const GUARD_BAND_FIXED: i32 = (fixed::GUARD_BAND as i32) << SUBPIXEL_BITS;

impl SnappedTriangle {
    /// Creates a triangle from grid coordinates, [x, y] in 1/256 pixel, y down.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a coordinate beyond the guard band.
    pub fn new(vertices: [[i32; 2]; 3]) -> Result<Self> {
        match vertices.iter().flatten().find(|c| c.unsigned_abs() > GUARD_BAND_FIXED as u32) {
            None => Ok(Self(vertices)),
            Some(&c) => Err(outside_guard_band(fixed::unsnap(c))),
        }
    }

    /// Creates a triangle from screen coordinates in pixels, snapped to the nearest grid points.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a coordinate that is NaN or beyond the guard band.
    pub fn snap(vertices: [DVec2; 3]) -> Result<Self> {
        let bad = |c: &f64| c.is_nan() || c.abs() > fixed::GUARD_BAND;
        match vertices.iter().flat_map(|v| [v.x, v.y]).find(bad) {
            None => Ok(Self(vertices.map(|v| [fixed::snap(v.x), fixed::snap(v.y)]))),
            Some(c) => Err(outside_guard_band(c)),
        }
    }

    /// Creates a triangle whose coordinates are known to be within the guard band.
    #[inline]
    pub(crate) fn within_guard_band(vertices: [[i32; 2]; 3]) -> Self {
        debug_assert!(Self::new(vertices).is_ok());
        Self(vertices)
    }

    /// Returns the corners, [x, y] in 1/256 pixel, y down.
    pub fn vertices(&self) -> [[i32; 2]; 3] {
        self.0
    }

    /// Returns twice the signed area in 1/256² pixel²; positive where the corners turn clockwise on
    /// the screen, which has y down. Exact.
    pub fn doubled_area(&self) -> i64 {
        let [a, b, c] = self.0;
        // Both products are below 2⁶², the area of the box around all three.
        let d = |p: [i32; 2], k: usize| i64::from(p[k]) - i64::from(a[k]);
        d(b, 0) * d(c, 1) - d(b, 1) * d(c, 0)
    }

    /// Returns the three edges in a sense that makes the inside positive; `None` for no area.
    fn edges(&self) -> Option<[Edge; 3]> {
        let [a, b, c] = self.0;
        match self.doubled_area() {
            0 => None,
            1.. => Some([Edge::new(a, b), Edge::new(b, c), Edge::new(c, a)]),
            _ => Some([Edge::new(a, c), Edge::new(c, b), Edge::new(b, a)]),
        }
    }

    /// Returns the pixels whose centres are in the closed bounding box, within `clip`.
    fn pixels(&self, clip: &PixelRect) -> PixelRect {
        let range = |k: usize| {
            let c = self.0.map(|v| v[k]);
            let (lo, hi) = (c[0].min(c[1]).min(c[2]), c[0].max(c[1]).max(c[2]));
            (fixed::first_center(lo), fixed::first_center(hi + 1))
        };
        let ((x0, x1), (y0, y1)) = (range(0), range(1));
        PixelRect::spanning(x0, y0, x1, y1).intersection(clip)
    }
}

fn outside_guard_band(pixels: f64) -> Error {
    Error::parameter("screen coordinate", pixels, "within ± 131072 pixels")
}

/// The edge function E(p) = (b − a) × (p − a) of one directed edge, on the grid.
///
/// Positive right of a → b seen with y down, which is the inside. `bias` is 0 for an edge whose points
/// belong to the triangle and −1 for the others, so that `E + bias ≥ 0` is the whole test.
#[derive(Debug, Clone, Copy)]
struct Edge {
    a: [i64; 2],
    d: [i64; 2],
    bias: i64,
}

impl Edge {
    fn new(a: [i32; 2], b: [i32; 2]) -> Self {
        let d = [i64::from(b[0]) - i64::from(a[0]), i64::from(b[1]) - i64::from(a[1])];
        // Left edges go up, top edges go to the right.
        let owned = d[1] < 0 || (d[1] == 0 && d[0] > 0);
        Self { a: a.map(i64::from), d, bias: if owned { 0 } else { -1 } }
    }

    /// Returns `E + bias` at the centre of pixel (x, y), which must be in the triangle's bounding box or a tile's
    /// width from it.
    fn at_center(&self, x: i32, y: i32) -> i64 {
        let center = |i: i32| i64::from(i) * i64::from(SUBPIXELS) + i64::from(HALF_PIXEL);
        self.d[0] * (center(y) - self.a[1]) - self.d[1] * (center(x) - self.a[0]) + self.bias
    }

    /// Returns the increase of E from one pixel to the next on the right.
    fn step_x(&self) -> i64 {
        -self.d[1] * i64::from(SUBPIXELS)
    }

    /// Returns the increase of E from one pixel to the next below.
    fn step_y(&self) -> i64 {
        self.d[0] * i64::from(SUBPIXELS)
    }
}
