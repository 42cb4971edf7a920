//! Which surfaces and lines can be seen.

pub mod line;
pub mod region;
pub mod surface;
