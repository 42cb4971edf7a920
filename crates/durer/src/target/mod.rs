//! The targets of pictures and drawings.

mod curve;
pub mod dimension;
pub mod drawing;
mod framebuffer;
pub mod gradient;
pub mod sheet;

pub use curve::{Arc, Curve, Piece};
pub use framebuffer::{Framebuffer, NO_ITEM, Origin, Pixels};
