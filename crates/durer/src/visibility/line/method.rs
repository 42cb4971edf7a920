//! All ways to draw the lines of a scene.

use super::{hidden_line, wireframe};

crate::info::family! {
    /// The algorithms that draw lines.
    pub enum LineMethod {
        /// All edges, whatever lies in front.
        Wireframe => wireframe::INFO,
        /// What can be seen of the edges, and how many surfaces hide the rest.
        HiddenLine => hidden_line::INFO,
    }
}
