//! The one test binary of the library.

mod raster_interpolate;
mod raster_triangle;
mod tidy;
mod view_window;
