//! One test binary for the formats.

mod conformance_gltf;
