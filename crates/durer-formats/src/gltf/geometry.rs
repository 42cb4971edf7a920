//! A primitive before it is posed.

use durer::math::{Vec2, Vec3, Vec4};
use durer::scene::Topology;

/// Geometry of a primitive before it is posed.
#[derive(Debug, Clone, Default)]
pub struct Geometry {
    /// Primitives that the indices form.
    pub topology: Topology,
    /// Mesh space.
    pub positions: Vec<Vec3>,
    /// Normals of unit length, or empty.
    pub normals: Vec<Vec3>,
    /// Unit vectors with the sign of the bitangent, or empty.
    pub tangents: Vec<Vec4>,
    /// Set by set.
    pub tex_coords: Vec<Vec<Vec2>>,
    /// Linear RGBA, or empty.
    pub colors: Vec<Vec4>,
    /// `None` if vertex i is index i.
    pub indices: Option<Vec<u32>>,
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
