//! A part of a line.

/// A part of a line that is hidden by one number of faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Span {
    pub from: f64,
    pub to: f64,
    pub invisibility: u32,
}
