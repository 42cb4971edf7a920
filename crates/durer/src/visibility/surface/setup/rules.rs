//! The rules by which triangles are left out.

use super::TriangleFilter;
use super::vertex::Behind;

/// Limits that triangles are tested against.
#[derive(Debug, Clone, Copy)]
pub struct Rules {
    pub filter: TriangleFilter,
    /// The pixels of the view's window, along x and y: the first, and the one after the last.
    pub window: [[i32; 2]; 2],
    /// The sign of the area of triangles seen from behind.
    pub behind: Behind,
    /// True if these are left out.
    pub cull_back: bool,
    /// The samples, as offsets from pixels' centres, at which small ones are sampled at once; none if they are not.
    pub sampled: &'static [[i32; 2]],
}
