//! From visible items back to their triangles, and to points on them: positions, normals, texture coordinates, and the
//! directions to the eye.

pub mod attributes;
pub mod normal_plane;
pub mod patch;
pub mod sight;
pub mod triangles;
