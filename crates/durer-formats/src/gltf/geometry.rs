//! A primitive before it is posed.

use durer::scene::Mesh;

/// Geometry of a primitive before it is posed.
#[derive(Debug, Clone, Default)]
pub struct Geometry {
    /// Attributes in mesh space and indices; no name, and no parts yet.
    pub mesh: Mesh,
    /// Joints and their weights, four and four.
    pub influences: Vec<Influences>,
    /// Repairs.
    pub notes: Vec<String>,
}

/// A set of four joints that each vertex follows.
#[derive(Debug, Clone)]
pub struct Influences {
    /// Numbers of joints in the skin.
    pub joints: Vec<[u32; 4]>,
    /// Weights of the joints; their sum need not be 1.
    pub weights: Vec<[f32; 4]>,
}
