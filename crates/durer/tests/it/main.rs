//! The one test binary of the library.

mod conformance_visible_surface;
mod data;
mod tidy;
