//! polyline
