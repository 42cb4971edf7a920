//! The one test binary of the library.

mod shading;
mod tidy;
