//! Curves, and how they become chains of straight lines.

mod flatten;
mod path;

pub use flatten::{Contours, flatten, segments_for};
pub use path::{Path, PathElement};
