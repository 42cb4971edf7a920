//! The one test binary of the library.

mod raster_coverage;
mod tidy;
