//! Which surfaces and lines can be seen.

pub mod surface;
pub mod wireframe;
