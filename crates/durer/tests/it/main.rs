//! The one test binary of the library.

mod tidy;
