//! The scene in the form of object-space solvers: faces with shared vertices, their edges, the bodies that they bound.

pub(crate) mod bodies;
pub(crate) mod edges;
pub(crate) mod faces;
pub mod orientation;
pub(crate) mod round;
mod stitch;
pub(crate) mod weld;

pub use bodies::{Bodies, Body};
pub use edges::{EdgeSide, Edges};
pub(crate) use faces::FaceRun;
pub use faces::Faces;
pub use orientation::scene::SceneOrientation;
pub use round::{Cylinder, cylinders};
pub use weld::Weld;
