//! Line clipping: one file per algorithm.
