//! Rows of pixels: the triangles that a scan line crosses, and the nearest of them at each pixel.

pub mod active;
pub mod nearest;
