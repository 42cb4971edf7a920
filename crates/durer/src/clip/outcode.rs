//! Outcodes: on which sides of a window or volume a point lies, one bit per border.
