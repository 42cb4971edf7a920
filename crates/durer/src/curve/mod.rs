//! Bézier, B-spline and NURBS curves, and their flattening into lines.
