//! Steps of algorithms as captions and small drawings; the facts of all algorithms.
//!
//! Each algorithm has its own `Step` type, for code that knows it. Here is the door without types: [`run`] runs an
//! algorithm by its name on an example or on data of one's own, and returns a [`Frame`] for each step: the line of the
//! pseudocode, a sentence with the step's values in English and German, the state as a table, and a picture.
//! [`svg()`] draws one frame, [`sheet`] all of them side by side.
//!
//! ```
//! use durer::explain::{self, Input, Language};
//!
//! let frames = explain::run("cohen-sutherland", &Input::Example(String::new()), &Default::default(), 100)?;
//! assert_eq!(frames[0].kind, "codes");
//! println!("{}", frames[0].text(Language::German));
//! let drawing = explain::sheet(&frames, 3, Language::English);
//! assert!(drawing.starts_with("<svg"));
//! # Ok::<(), durer::Error>(())
//! ```

mod air;
mod barycentric;
mod clip_lines;
mod clip_polygons;
mod clip_shapes;
mod clip_volume;
mod crossings;
mod culling;
mod curves;
mod faces;
mod faults;
mod fills;
mod fragments;
mod frame;
mod grid;
mod input;
mod interior;
mod json;
mod labels;
mod lesson;
mod letters;
mod lines;
mod lists;
mod microfacets;
mod names;
mod new_vertices;
mod operations;
mod picking;
mod picture;
mod replay;
mod screens;
mod section;
mod shades;
mod shadow;
mod simplify;
mod svg;
mod table;
mod textures;
mod tones;
mod validity;
mod viewing;
mod warping;
mod wedges;
mod without;
mod words;

pub use faults::{LessonFault, faults, record_with_fault};
pub use input::{Figure, Grid, Input, MAX_POINTS, Options};
pub use json::{frame_json, json, string as json_string};
pub use lesson::{Example, Lesson};
pub use names::title;
pub use operations::{Operations, Tally};
pub use picture::{Look, Mark, MarkShape, Picture};
pub use replay::{Frame, Frames};
pub use svg::{picture, picture_of_size, sheet, svg};
pub use table::{Row, Table, TableCell};
pub use without::WITHOUT_LESSON;
pub use words::{Caption, Language, Template, Value, Word};

use crate::info::Info;
use crate::{Result, clip, commands, curve, fragment, raster, shade, view, visibility};

/// Lessons of one family with their title.
#[derive(Debug, Clone, Copy)]
pub struct LessonFamily {
    /// Title.
    pub title: Word,
    /// Lessons, the simplest first.
    pub lessons: &'static [Lesson],
}

const fn family(en: &'static str, de: &'static str, lessons: &'static [Lesson]) -> LessonFamily {
    LessonFamily { title: Word::new(en, de), lessons }
}

/// Families of lessons in the plane, in the order of the pipeline.
pub const PLANE: &[LessonFamily] = &[
    family("Curves", "Kurven", curves::LESSONS),
    family("Clipping lines", "Linien clippen", clip_lines::LESSONS),
    family("Crossings of segments", "Schnittpunkte von Strecken", &[crossings::LESSON]),
    family("Clipping polygons", "Polygone clippen", clip_polygons::LESSONS),
    family("Valid polygons", "Gültige Polygone", &[validity::LESSON]),
    family("Clipping circles and text", "Kreise und Text clippen", clip_shapes::LESSONS),
    family("Simplifying borders", "Grenzen vereinfachen", simplify::LESSONS),
    family("Window and viewport", "Fenster und Viewport", viewing::LESSONS),
    family("Points for labels", "Punkte für Beschriftungen", &[interior::LESSON, labels::LESSON]),
    family("Points, lines and circles", "Punkte, Linien und Kreise", lines::LESSONS),
    family("Filling areas", "Flächen füllen", fills::LESSONS),
    family("Halftones", "Halbtöne", tones::LESSONS),
];

/// Families of lessons in space, in the order of the pipeline, up to visible surfaces and lines.
pub const SPACE: &[LessonFamily] = &[
    family("Clipping in space", "Clippen im Raum", clip_volume::LESSONS),
    family(
        "Culling, picking and warping",
        "Culling, Picking und Warping",
        &[culling::LESSON, picking::LESSON, warping::LESSON],
    ),
    family("Shading", "Schattierung", shades::LESSONS),
    family("Textures", "Texturen", textures::LESSONS),
    family("Shadows", "Schatten", &[shadow::LESSON, faces::SHADOW_VOLUMES]),
    family("Display lists", "Displaylisten", &[lists::LESSON]),
    family("Fragments", "Fragmente", &[fragments::LESSON, air::LESSON]),
];

/// Families of lessons about visible surfaces and lines.
pub const VISIBILITY: &[LessonFamily] =
    &[family("Hidden surfaces", "Verdeckte Flächen", faces::LESSONS)];

/// All lessons by families: those of [`PLANE`], then those of [`SPACE`] and of [`VISIBILITY`].
pub const FAMILIES: &[LessonFamily] = &joined::<{ PLANE.len() + SPACE.len() + VISIBILITY.len() }>();

const fn joined<const N: usize>() -> [LessonFamily; N] {
    let mut all = [PLANE[0]; N];
    let parts = [PLANE, SPACE, VISIBILITY];
    let (mut part, mut i) = (0, 0);
    while part < parts.len() {
        let mut k = 0;
        while k < parts[part].len() {
            all[i] = parts[part][k];
            (i, k) = (i + 1, k + 1);
        }
        part += 1;
    }
    assert!(i == N);
    all
}

/// Returns every lesson, in the order of [`FAMILIES`].
pub fn lessons() -> impl Iterator<Item = &'static Lesson> {
    FAMILIES.iter().flat_map(|family| family.lessons)
}

/// Returns the lesson of an algorithm.
///
/// # Errors
/// [`crate::Error::Unknown`] where no lesson has this name; the error lists those that are like it.
pub fn lesson(name: &str) -> Result<&'static Lesson> {
    find(FAMILIES.iter(), name)
}

/// Finds the lesson of an algorithm in some families: a binary that asks for no others need not contain them.
///
/// # Errors
/// As [`lesson()`].
pub fn find(
    families: impl Iterator<Item = &'static LessonFamily> + Clone,
    name: &str,
) -> Result<&'static Lesson> {
    let lessons = families.flat_map(|family| family.lessons);
    let names = lessons.clone().map(|lesson| lesson.name);
    let mut found = lessons.filter(|lesson| lesson.name == name);
    found.next().ok_or_else(|| lesson::unknown("algorithm to explain", name, names))
}

/// Runs an algorithm and returns a frame for each of its steps, at most `cap`, and one more with the number of missing
/// ones if there are more.
///
/// # Errors
/// Those of [`lesson()`] and [`Lesson::run`].
pub fn run(name: &str, input: &Input, options: &Options, cap: usize) -> Result<Vec<Frame>> {
    lesson(name)?.run(input, options, cap)
}

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
    &curve::knot_insertion::INFO,
    &curve::knot_insertion::OSLO,
    &curve::catmull_rom::INFO,
    &curve::forward_difference::INFO,
    &curve::FLATTEN,
    &curve::evaluator::INFO,
    &clip::line::cohen_sutherland::INFO,
    &clip::line::midpoint::INFO,
    &clip::line::cyrus_beck::INFO,
    &clip::line::liang_barsky::INFO,
    &clip::line::nicholl_lee_nicholl::INFO,
    &clip::line::skala::INFO,
    &clip::line::sobkow_pospisil_yang::INFO,
    &clip::line::homogeneous::INFO,
    &clip::line::batch::INFO,
    &clip::polyline::INFO,
    &clip::circle::INFO,
    &clip::text::STRING,
    &clip::text::CHARACTER,
    &clip::text::OUTLINE,
    &clip::crossings::bentley_ottmann::INFO,
    &clip::polygon::sutherland_hodgman::INFO,
    &clip::polygon::liang_barsky::INFO,
    &clip::polygon::maillot::INFO,
    &clip::polygon::weiler_atherton::INFO,
    &clip::polygon::greiner_hormann::INFO,
    &clip::polygon::vatti::INFO,
    &clip::polygon::scan_beams::INFO,
    &clip::polygon::point::INFO,
    &clip::polygon::validity::INFO,
    &clip::polygon::mismatch::INFO,
    &clip::polygon::overlay::INFO,
    &clip::polygon::rectangle::INFO,
    &clip::simplify::douglas_peucker::INFO,
    &clip::simplify::visvalingam::INFO,
    &clip::simplify::coverage::INFO,
    &clip::volume::INFO,
    &clip::volume::ATTRIBUTES,
    &clip::place::WORLD,
    &clip::place::CLIP_SPACE,
    &clip::place::AFTER_DIVISION,
    &clip::place::VIEWPORT,
    &clip::place::PER_PIXEL,
    &view::mapping::INFO,
    &view::layout::INFO,
    &view::cull::INFO,
    &view::pick::INFO,
    &view::section::INFO,
    &view::label::INFO,
    &view::interior_point::INFO,
    &view::warp::INFO,
    &raster::point::INFO,
    &raster::point::DISC,
    &raster::line::equation::INFO,
    &raster::line::dda::INFO,
    &raster::line::bresenham::INFO,
    &raster::line::run_slice::INFO,
    &raster::line::double_step::INFO,
    &raster::line::anti_aliased::WU,
    &raster::line::anti_aliased::INFO,
    &raster::line::wide::INFO,
    &raster::line::wide::buffer::INFO,
    &raster::line::tiled::INFO,
    &raster::line::pattern::INFO,
    &raster::conic::CIRCLE,
    &raster::conic::INFO,
    &raster::triangle::edge_function::INFO,
    &raster::triangle::edge_walking::INFO,
    &raster::triangle::tiles::INFO,
    &raster::polygon::edge_table::INFO,
    &raster::polygon::ordered_edge_list::INFO,
    &raster::polygon::edge_fill::INFO,
    &raster::polygon::edge_fill::FENCE,
    &raster::polygon::edge_flag::INFO,
    &raster::coverage::cell_sums::INFO,
    &raster::coverage::INFO,
    &raster::coverage::PARTITION,
    &raster::triangulate::INFO,
    &raster::seed_fill::NAIVE,
    &raster::seed_fill::INFO,
    &raster::interpolate::BARYCENTRIC,
    &raster::interpolate::INFO,
    &shade::unlit::INFO,
    &shade::flat::INFO,
    &shade::gouraud::INFO,
    &shade::phong::INFO,
    &shade::metallic_roughness::INFO,
    &shade::texture::INFO,
    &shade::texture::MIP_MAP,
    &shade::shadow::INFO,
    &fragment::INFO,
    &fragment::halftone::error_diffusion::INFO,
    &fragment::halftone::clustered_dot::INFO,
    &fragment::fog::INFO,
    &commands::INFO,
    &visibility::back_face::INFO,
    &visibility::object::orientation::INFO,
    &visibility::surface::z_buffer::INFO,
    &visibility::surface::a_buffer::INFO,
    &visibility::surface::ambient_occlusion::INFO,
    &visibility::surface::scan_line_z::INFO,
    &visibility::surface::spanning_scan_line::INFO,
    &visibility::surface::depth_sort::INFO,
    &visibility::surface::warnock::INFO,
    &visibility::surface::ray::INFO,
    &visibility::polygons::z_buffer::INFO,
    &visibility::polygons::hierarchical_z::INFO,
    &visibility::polygons::octree::INFO,
    &visibility::polygons::a_buffer::INFO,
    &visibility::polygons::painter::INFO,
    &visibility::polygons::depth_sort::INFO,
    &visibility::polygons::bsp::INFO,
    &visibility::polygons::warnock::INFO,
    &visibility::polygons::watkins::INFO,
    &visibility::polygons::patch_subdivision::INFO,
    &visibility::polygons::shadow_volumes::INFO,
    &visibility::polygons::regions::INFO,
    &visibility::polygons::portals::INFO,
    &visibility::polygons::csg::INFO,
    &visibility::region::planar_map::INFO,
    &visibility::region::SHADOWS,
    &visibility::line::roberts::INFO,
    &visibility::line::appel::INFO,
    &visibility::line::galimberti_montanari::INFO,
    &visibility::line::hidden_line::INFO,
    &visibility::line::wireframe::INFO,
    &visibility::line::floating_horizon::INFO,
    &visibility::line::horizon_curves::INFO,
    &visibility::wireframe::INFO,
];
