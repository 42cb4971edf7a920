//! Visible surfaces.

pub mod z_buffer;
