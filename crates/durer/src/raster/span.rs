//! A run of pixels in one row.

/// Pixels x0 … x1 − 1 of row y; never empty if an algorithm emits it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Span {
    /// Row, growing downwards.
    pub y: i32,
    /// First column, inclusive.
    pub x0: i32,
    /// Last column, exclusive.
    pub x1: i32,
}

impl Span {
    /// Calls `emit` with the columns of row `y`, unless they are empty.
    #[inline]
    pub(crate) fn emit_unless_empty(y: i32, x0: i32, x1: i32, emit: &mut impl FnMut(Self)) {
        if x0 < x1 {
            emit(Self { y, x0, x1 });
        }
    }
}
