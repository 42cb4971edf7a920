//! Visible lines: the visible parts of the edges of a scene, as exact drawings.

pub mod appel;
mod arrange;
mod bend;
mod chain;
mod crease_chain;
mod crossing;
pub(crate) mod edge_lines;
pub mod face_net;
mod facing;
mod fading;
pub mod floating_horizon;
pub mod galimberti_montanari;
pub mod hidden_line;
pub mod horizon_curves;
mod intersection;
mod marks;
mod method;
mod overlap;
mod page;
mod piece;
mod planes;
pub mod roberts;
mod roundness;
mod simplify;
mod smooth_silhouette;
mod smooth_surface;
mod steps;
mod stubs;
mod table;
mod tangent;
mod vertex_normals;
pub mod wireframe;
mod zigzag;

pub use edge_lines::{ClassSet, Intersections};
pub use method::LineMethod;
pub use roundness::Smooth;
