//! Algorithms for visible surfaces and lines.

pub mod back_face;
pub mod line;
pub mod object;
pub mod polygons;
pub mod region;
pub mod surface;
pub mod wireframe;
