//! The one test binary of the library.

mod raster_interpolate;
mod raster_triangle;
mod conformance_visible_surface;
mod data;
mod tidy;
mod view_window;
