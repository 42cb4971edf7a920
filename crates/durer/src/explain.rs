//! Steps of algorithms as captions and small drawings; the facts of all algorithms.

use crate::info::Info;
use crate::{clip, curve, raster, shade, view, visibility};

/// The facts of every algorithm of this library, in the order of the pipeline.
///
/// ```
/// use durer::explain::ALGORITHMS;
/// let bresenham = ALGORITHMS.iter().find(|info| info.name == "bresenham");
/// assert_eq!(bresenham.map(|info| info.year), Some(1965));
/// ```
pub const ALGORITHMS: &[&Info] = &[
    &curve::bezier::INFO,
    &curve::b_spline::INFO,
    &curve::FLATTEN,
    &clip::line::cohen_sutherland::INFO,
    &clip::line::midpoint::INFO,
    &clip::line::cyrus_beck::INFO,
    &clip::line::liang_barsky::INFO,
    &clip::line::nicholl_lee_nicholl::INFO,
    &clip::line::homogeneous::INFO,
    &clip::line::batch::INFO,
    &clip::line::polyline::INFO,
    &clip::polygon::sutherland_hodgman::INFO,
    &clip::polygon::weiler_atherton::INFO,
    &clip::polygon::greiner_hormann::INFO,
    &clip::polygon::vatti::INFO,
    &clip::polygon::overlay::INFO,
    &clip::polygon::rectangle::INFO,
    &clip::volume::INFO,
    &clip::place::WORLD,
    &clip::place::CLIP_SPACE,
    &clip::place::AFTER_DIVISION,
    &clip::place::VIEWPORT,
    &clip::place::PER_PIXEL,
    &view::interior_point::INFO,
    &view::warp::INFO,
    &raster::line::equation::INFO,
    &raster::line::dda::INFO,
    &raster::line::bresenham::INFO,
    &raster::line::anti_aliased::WU,
    &raster::line::anti_aliased::INFO,
    &raster::line::wide::INFO,
    &raster::triangle::edge_function::INFO,
    &raster::triangle::edge_walking::INFO,
    &raster::triangle::tiles::INFO,
    &raster::polygon::edge_table::INFO,
    &raster::polygon::ordered_edge_list::INFO,
    &raster::coverage::INFO,
    &raster::triangulate::INFO,
    &raster::seed_fill::NAIVE,
    &raster::seed_fill::INFO,
    &shade::unlit::INFO,
    &shade::flat::INFO,
    &shade::gouraud::INFO,
    &shade::phong::INFO,
    &shade::metallic_roughness::INFO,
    &shade::shadow::INFO,
    &visibility::back_face::INFO,
    &visibility::surface::z_buffer::INFO,
    &visibility::surface::a_buffer::INFO,
    &visibility::surface::scan_line_z::INFO,
    &visibility::surface::spanning_scan_line::INFO,
    &visibility::surface::depth_sort::INFO,
    &visibility::surface::warnock::INFO,
    &visibility::surface::ray::INFO,
    &visibility::region::weiler_atherton::INFO,
    &visibility::line::hidden_line::INFO,
    &visibility::line::wireframe::INFO,
    &visibility::line::floating_horizon::INFO,
    &visibility::wireframe::INFO,
];
