//! The targets of pictures and drawings.

mod curve;
pub mod dimension;
pub mod drawing;
mod framebuffer;
pub mod gradient;
pub mod sheet;

pub use curve::{Curve, CurvePiece, EllipticArc};
pub use framebuffer::{Framebuffer, NO_ITEM, Pixels, RowOrigin};
