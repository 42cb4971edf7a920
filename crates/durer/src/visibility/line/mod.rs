//! Visible lines: what of the edges of a scene can be seen, as exact drawings.

pub mod floating_horizon;
