//! The scene as solvers in object space take it: faces with shared vertices, their edges, the bodies
//! they bound, and the plane of the picture.

pub mod bodies;
pub mod edges;
pub mod faces;
pub mod picture_plane;
pub(crate) mod weld;

pub use bodies::{Bodies, Body};
pub use edges::{Edges, Side};
pub use faces::{FaceRun, Faces};
pub use picture_plane::{Borders, PicturePlane, PlanePoint};
