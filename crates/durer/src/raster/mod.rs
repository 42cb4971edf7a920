//! Scan conversion: from geometry in pixel coordinates to covered pixels.
//!
//! Pixel (i, j) covers [i, i + 1) × [j, j + 1) with y growing downwards; its sample is the centre.

pub(crate) mod bands;
pub(crate) mod clipped;
pub mod conic;
pub mod coverage;
pub mod ear_clipping;
pub mod fixed;
pub mod interpolate;
pub mod line;
pub mod paint;
pub mod point;
pub mod polygon;
pub mod seed_fill;
pub(crate) mod span;
pub mod stipple;
pub mod triangle;
pub mod triangulate;

pub use span::Span;
