//! Polygon clipping: one file per algorithm.
