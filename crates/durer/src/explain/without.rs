//! Algorithms that have no lesson, each with the reason.

use crate::info::Info;
use crate::{clip, raster, visibility};

const PRODUCTION: &str = "a fast form of an algorithm that has a lesson, with the same result";
const COARSE: &str = "its steps are too coarse to be drawn one by one";
const UNTRACED: &str = "it reports no steps";

/// Algorithms without a lesson and why, in the order of [`super::ALGORITHMS`]; a new lesson removes its entry.
pub const WITHOUT_LESSON: &[(&Info, &str)] = &[
    (&clip::line::batch::INFO, PRODUCTION),
    (&clip::polygon::mismatch::INFO, UNTRACED),
    (&raster::line::wide::buffer::INFO, UNTRACED),
    (&raster::line::tiled::INFO, PRODUCTION),
    (&raster::coverage::INFO, PRODUCTION),
    (&visibility::surface::z_buffer::INFO, PRODUCTION),
    (&visibility::surface::a_buffer::INFO, PRODUCTION),
    (&visibility::surface::ambient_occlusion::INFO, UNTRACED),
    (&visibility::surface::spanning_scan_line::INFO, PRODUCTION),
    (&visibility::surface::depth_sort::INFO, PRODUCTION),
    (&visibility::surface::warnock::INFO, PRODUCTION),
    (&visibility::region::planar_map::INFO, COARSE),
    (&visibility::region::SHADOWS, UNTRACED),
    (&visibility::line::wireframe::INFO, COARSE),
    (&visibility::line::floating_horizon::INFO, PRODUCTION),
    (&visibility::wireframe::INFO, COARSE),
];
