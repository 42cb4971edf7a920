//! Which surfaces and lines can be seen.

pub mod back_face;
pub mod line;
pub mod object;
pub mod polygons;
pub mod region;
pub mod surface;
pub mod wireframe;
