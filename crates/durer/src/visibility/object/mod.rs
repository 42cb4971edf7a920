//! The scene in the form of object-space solvers: faces with shared vertices, their edges, the bodies that they bound.

pub mod bodies;
pub mod edges;
pub mod faces;
pub mod orientation;
pub mod round;
mod stitch;
pub mod weld;

pub use bodies::{Bodies, Body};
pub use edges::{Edges, Side};
pub use faces::{FaceRun, Faces};
pub use orientation::SceneOrientation;
pub use round::{Cylinder, cylinders};
pub use weld::Weld;
