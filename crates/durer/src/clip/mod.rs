//! Clipping in two dimensions and in homogeneous coordinates.

pub mod attribute;
pub mod cells;
pub mod circle;
pub mod crossings;
pub(crate) mod exact;
pub mod hilbert;
pub mod line;
pub mod mask;
pub mod outcode;
pub mod place;
pub mod polygon;
pub mod polyline;
pub mod simplify;
mod status;
pub mod text;
pub mod tiles;
mod touch;
pub mod volume;
