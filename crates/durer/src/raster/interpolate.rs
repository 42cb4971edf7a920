//! Interpolation: barycentric coordinates, areas, perspective-correct attributes.
