//! Where pictures and drawings go.

mod framebuffer;

pub use framebuffer::{Framebuffer, NO_ITEM, Origin, Pixels};
