//! The one test binary of the library.

mod clip_place;
mod clip_volume;
mod conformance_visible_surface;
mod data;
mod determinism;
mod raster_interpolate;
mod raster_triangle;
mod scenes;
mod shading;
mod surface_depth_sort;
mod surface_methods;
mod surface_ray;
mod surface_scenes;
mod surface_warnock;
mod tidy;
mod view_cull;
mod view_pick;
mod view_projection;
mod view_window;
