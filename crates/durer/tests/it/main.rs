//! The one test binary of the library.

mod conformance_overlay;
mod overlay;
mod tidy;
