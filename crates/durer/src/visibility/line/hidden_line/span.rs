//! A part of a line.

/// A part of a line that is hidden by one number of faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HiddenSpan {
    /// Start, 0 … 1 along the line.
    pub from: f64,
    /// End along the line.
    pub to: f64,
    /// Number of faces in front, Appel's quantitative invisibility.
    pub invisibility: u32,
}
