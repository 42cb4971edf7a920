//! Clipping in two dimensions and in homogeneous coordinates.

pub mod attribute;
pub(crate) mod exact;
pub mod line;
pub mod outcode;
pub mod place;
pub mod polygon;
mod touch;
pub mod volume;
