//! Where pictures and drawings go.

pub mod drawing;
mod framebuffer;
pub mod sheet;

pub use framebuffer::{Framebuffer, NO_ITEM, Origin, Pixels};
