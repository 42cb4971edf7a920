//! The one test binary of the library.

mod raster_coverage;
mod raster_line;
mod raster_paint;
mod raster_polygon;
mod raster_seed_fill;
mod tidy;
