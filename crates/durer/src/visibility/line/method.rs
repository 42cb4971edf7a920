//! The methods of drawing lines.

use super::{floating_horizon, hidden_line, wireframe};

crate::info::family! {
    /// The algorithms that draw lines: those of scenes, and that of height fields.
    pub enum LineMethod {
        /// All edges, hidden or not.
        Wireframe => wireframe::INFO,
        /// Visible parts of edges, and how many surfaces hide the rest.
        HiddenLine => hidden_line::INFO,
        /// The lines of a surface y = f(x, z) that rise above or sink below those in front of them.
        FloatingHorizon => floating_horizon::INFO,
    }
}
