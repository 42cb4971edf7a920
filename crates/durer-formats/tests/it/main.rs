//! One test binary for the formats.

mod conformance_gltf;
mod conformance_meshes;
mod shared;
