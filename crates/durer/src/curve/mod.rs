//! Curves, and how they become chains of straight lines.

pub mod b_spline;
pub mod bezier;
pub mod catmull_rom;
pub mod evaluator;
pub mod fit;
mod flatten;
pub mod forward_difference;
pub mod knot_insertion;
mod path;
pub mod pieces;
pub mod streamlines;
pub mod stroke_font;
pub mod text;

pub(crate) use flatten::chain;
pub use flatten::{
    Contours, INFO as FLATTEN, Step as FlattenStep, flatten, flatten_traced, segments_for,
};
pub use path::{Path, PathElement};
