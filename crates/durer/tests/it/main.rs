//! The one test binary of the library.

mod clip_place;
mod clip_volume;
mod conformance_overlay;
mod conformance_visible_surface;
mod data;
mod determinism;
mod golden;
mod overlay;
mod raster_coverage;
mod raster_interpolate;
mod raster_line;
mod raster_paint;
mod raster_polygon;
mod raster_seed_fill;
mod raster_triangle;
mod scenes;
mod shading;
mod tidy;
mod view_cull;
mod view_projection;
mod view_window;
mod z_buffer;
