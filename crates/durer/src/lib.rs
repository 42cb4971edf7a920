//! A CPU graphics pipeline: geometry in, pixels or exact vector drawings out.
//!
//! ```
//! use durer::pipeline::{RenderOptions, Shading, render};
//! use durer::scene::{Camera, Mesh, Projection, Scene};
//!
//! // A triangle that fills the lower left half of the camera's view.
//! let mesh = Mesh::from_triangles([[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0]]]);
//! let camera = Camera::look_at([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
//! let camera = Camera { projection: Projection::Orthographic { height: 2.0 }, ..camera };
//! let shading = Some(Shading::Unlit);
//! let options = RenderOptions { width: 64, height: 64, shading, ..RenderOptions::new(camera) };
//!
//! let (picture, report) = render(&Scene::from(mesh), &options)?;
//! assert_eq!(report.drawn, 1);
//! assert_eq!(picture.color.get(10, 50), Some([231, 231, 231, 255])); // the default material
//! assert_eq!(picture.color.get(50, 10), Some([255, 255, 255, 255])); // the background
//! # Ok::<(), durer::Error>(())
//! ```
//!
//! Files are read and written by the crate `durer-formats`, over bytes; this library takes values
//! and gives values, opens no file and prints nothing.
//!
//! # Contents
//!
//! Each published algorithm has its own module, whose documentation names authors, year, class, cost
//! and limits; the same facts are in its `INFO`. Families are enums with `ALL`, `name()`, `info()` and
//! `FromStr`; [`explain::ALGORITHMS`] has the facts of all.
//!
//! **What does a scene look like?** [`pipeline::render`] knows the order of all stages; a [`scene`] has
//! meshes, instances, materials, textures, lights and cameras; the planes of the picture are in
//! [`target`].
//!
//! **From where is it seen?**
//!
//! | question | answer |
//! |---|---|
//! | Where must the eye be to see all of it from the front, or from above? | [`view::projection`] |
//! | Which pixel shows this point of a plane? | [`view::window`]: window to viewport; [`view::mapping`] as it is taught |
//! | Several views in one picture? | [`view::layout`] |
//! | Can this box be seen at all? Which way does this face look? | [`view::cull`] |
//! | What does a near camera see of this picture with depth? | [`view::warp`]: forward warping |
//! | What is behind this point or rectangle of the picture? | [`view::pick`] |
//! | Where does the label of an area go, and which labels have room? | [`view::interior_point`], [`view::label`] |
//! | Is this mesh the surface of a body, and are its faces turned outwards? | [`view::topology`], [`visibility::object::orientation`] |
//! | What is inside, if planes cut it open? | [`view::section`] |
//!
//! **Which part of a line is in the window?** [`clip::line`]
//!
//! | algorithm | window | at home with |
//! |---|---|---|
//! | [Cohen–Sutherland](clip::line::cohen_sutherland) | rectangle, box | most segments wholly inside or outside |
//! | [Midpoint subdivision](clip::line::midpoint) | integer pixels | hardware without division |
//! | [Cyrus–Beck](clip::line::cyrus_beck) | convex polygon, convex polyhedron | windows that are not rectangles |
//! | [Liang–Barsky](clip::line::liang_barsky) | rectangle, box, half-planes | most segments crossing the border |
//! | [Nicholl–Lee–Nicholl](clip::line::nicholl_lee_nicholl) | rectangle | no unnecessary crossing computed |
//! | [Skala](clip::line::skala) | rectangle, convex polygon | signs of the window's corners, no unnecessary crossing |
//! | [Sobkow–Pospisil–Yang](clip::line::sobkow_pospisil_yang) | rectangle | one code for both ends, a case for each |
//! | [Homogeneous](clip::line::homogeneous) | rectangle | points with a w of any sign |
//! | [Batches](clip::line::batch) | rectangle | millions of segments |
//! | [Polylines](clip::polyline) | polygon with holes | chains with attributes, inside or outside part |
//!
//! **Where do many segments cross?** [`clip::crossings`]: Bentley and Ottmann's sweep.
//!
//! **Which part of a polygon?** [`clip::polygon`]
//!
//! | algorithm | takes | gives |
//! |---|---|---|
//! | [Sutherland–Hodgman](clip::polygon::sutherland_hodgman) | any ring, convex window | one ring, bridged |
//! | [Weiler–Atherton](clip::polygon::weiler_atherton) | polygons with holes | valid polygons |
//! | [Greiner–Hormann](clip::polygon::greiner_hormann) | polygons with holes; rings that cross | valid polygons; rings that cross |
//! | [Vatti](clip::polygon::vatti) | anything | valid polygons, swept |
//! | [Overlay](clip::polygon::overlay) | anything | valid polygons: the robust choice |
//! | [Rectangle](clip::polygon::rectangle) | polygons and polylines, a rectangle | the fast path for map tiles |
//!
//! [Overlay](clip::polygon::overlay) and [Vatti](clip::polygon::vatti) take coordinates of f64 or whole numbers;
//! the [tree](clip::polygon::NestingTree) of a result gives the nesting of its rings. [`clip::attribute`] carries
//! heights, colours and other values to new vertices.
//!
//! **And of any geometry?** [`clip::mask`] clips points, lines and polygons to a window or to polygons, makes polygons
//! [valid](clip::mask::Rules::fix) and [joins](clip::mask::Union) them; [`clip::cells`] cuts by many cells at once;
//! [buffers](raster::line::wide::buffer) reach a distance around them.
//!
//! **Which of its points matter?** [`clip::simplify`]: of a line by [Douglas–Peucker](clip::simplify::douglas_peucker)
//! or [Visvalingam–Whyatt](clip::simplify::visvalingam), of lines and areas that share borders
//! [all together](clip::simplify::coverage).
//!
//! **Which part of a circle, or of a text?** [`clip::circle`] finds its arcs, [`clip::text`] keeps whole strings, whole
//! characters, or parts of outlines.
//!
//! **How does a map become tiles?** [`clip::tiles`].
//!
//! **And in three dimensions?** [`clip::volume`] clips in homogeneous coordinates, whatever the sign of w, [many
//! triangles](clip::volume::clip_triangles) at a time; [`clip::outcode`] classifies points by the borders they are
//! beyond; [`clip::place`] clips before the camera transform, in clip space, after the division, in the viewport or per
//! pixel, with the same picture.
//!
//! **Which pixels does it cover?** [`raster`]
//!
//! | shape | ways |
//! |---|---|
//! | point | [squares and smooth discs](raster::point) |
//! | line, one pixel wide | [equation](raster::line::equation), [DDA](raster::line::dda), [Bresenham](raster::line::bresenham), [run-slice](raster::line::run_slice), [double-step](raster::line::double_step), [many of them by tiles](raster::line::tiled) |
//! | smooth line | [Wu, Gupta–Sproull](raster::line::anti_aliased) |
//! | wide line, dashes | [outline of the stroke](raster::line::wide) |
//! | triangle | [edge functions](raster::triangle::edge_function), [edge walking](raster::triangle::edge_walking), [tiles](raster::triangle::tiles) |
//! | polygon | [edge table and active edge table](raster::polygon::edge_table), [ordered edge list](raster::polygon::ordered_edge_list), [edge fill, fence fill](raster::polygon::edge_fill), [edge flags](raster::polygon::edge_flag), [triangulation](raster::triangulate) |
//! | path, anti-aliased | [exact area coverage](raster::coverage), [cover and area in cells](raster::coverage::cell_sums) |
//! | region around a pixel | [seed fills](raster::seed_fill) |
//! | layers of all these | [a canvas](raster::paint) |
//!
//! [`raster::interpolate`] has barycentric and perspective-correct weights, [`curve`] brings Bézier curves,
//! [patches](curve::evaluator), B-splines, NURBS and glyphs to chains of lines; [`curve::knot_insertion`],
//! [`curve::catmull_rom`] and [`curve::forward_difference`] are the textbooks' ways with them.
//!
//! **Which surface is in front?** [`visibility::surface`]: one scene in, the same surfaces found.
//!
//! | algorithm | decides by |
//! |---|---|
//! | [z-buffer](visibility::surface::z_buffer) | a depth per sample, in tiles: the production path |
//! | [A-buffer](visibility::surface::a_buffer) | lists of fragments with masks of samples |
//! | [Scan-line z-buffer](visibility::surface::scan_line_z) | a depth per pixel of one row |
//! | [Spanning scan line](visibility::surface::spanning_scan_line) | spans between edges of a row, no depth per pixel |
//! | [Depth sort](visibility::surface::depth_sort) | painting from back to front, splitting polygons without an order |
//! | [Warnock](visibility::surface::warnock) | dividing the window until it is simple |
//! | [Rays](visibility::surface::ray) | casting a ray through each sample; shadows, mirrors and refraction too |
//!
//! **And as the papers have it?** [`visibility::polygons`]: the z-buffer's loop, Greene's pyramid of depths, Meagher's
//! octree, the painter, depth sort, BSP trees, Warnock's windows, Watkins' tables, Weiler and Atherton's cuts,
//! Carpenter's shares, Luebke and Georges' portals, and Atherton's solids on plane polygons, a file each, to be read
//! beside the paper; [`visibility::line::roberts`], [`visibility::line::appel`],
//! [`visibility::line::galimberti_montanari`], [`visibility::polygons::patch_subdivision`] (Catmull),
//! [`visibility::polygons::shadow_volumes`] (Crow), [`visibility::line::horizon_curves`], [`clip::polygon::scan_beams`],
//! [`clip::polygon::maillot`] and [`clip::polygon::sutherland_hodgman::by_borders`] likewise.
//!
//! **Which part of an edge?** [`visibility::line`]: [hidden lines](visibility::line::hidden_line) by
//! quantitative invisibility, [wireframe](visibility::line::wireframe), as a
//! [drawing](target::drawing). [`visibility::object`] has the welded faces, edges and bodies for solvers
//! in object space.
//!
//! **What of each face can be seen, exactly?** [`visibility::region`]: regions of one colour with exact shadows,
//! by a [planar map](visibility::region::planar_map); [hatching](visibility::region::hatch) for pens.
//!
//! [Back-face removal](visibility::back_face) leaves out faces that look away before any other step;
//! [wireframe](visibility::wireframe) draws all edges, hidden ones too. [`pipeline::status`] tells why nothing of a
//! scene is visible.
//!
//! **How does a drawing come onto paper?** [`paper`]: page, scale, pens, dashes, sheets of four views;
//! letters from the [single-stroke font](curve::stroke_font).
//!
//! **Which lines of a surface y = f(x, z) can be seen?** [The floating horizon](visibility::line::floating_horizon)
//! of a [height field](scene::HeightField); [`plot`] adds colours, axes and paper.
//!
//! **What colour does it have?** [`shade`]: [flat](shade::flat), [Gouraud](shade::gouraud),
//! [Phong](shade::phong), [metallic-roughness](shade::metallic_roughness), [unlit](shade::unlit);
//! [textures](shade::texture); [shadow maps](shade::shadow);
//! [ambient occlusion](visibility::surface::ambient_occlusion) from the depths of a picture.
//!
//! **What happens before a pixel changes?** [`fragment`]: scissor, alpha test, stencil, depth,
//! blending, dithering, logic operation, write masks; colour indices with a
//! [palette](fragment::Palette). [`commands`] drives them: the classic pipeline's
//! state, display lists, evaluators, lights, textures, and rectangles of pixels.
//!
//! **How does an algorithm come to its result?** Algorithms that take a [`trace::Tracer`] as their last argument report
//! every step to it.
//!
//! **What may it cost?** Options hold a [`work::Work`]: a budget of memory that large buffers are charged to, and a way
//! to stop work that takes too long.
//!
//! # Guarantees
//!
//! - The same input gives the same bytes: on every CPU, SIMD level ([`simd`]) and number of threads.
//! - Algorithms on valid values cannot fail. Values are validated once, with a typed [`Error`], and nothing panics on
//!   any input.
//! - World space is right-handed, the camera looks down −z, clip space is −w ≤ x, y, z ≤ w. Pixel (i, j)
//!   covers [i, i + 1) × [j, j + 1), its sample is the centre, row 0 is on top.
//! - Geometry is f64, exact predicates decide topology ([`math`]), coverage is decided with integers of
//!   8 sub-pixel bits ([`raster::fixed`]), light is linear inside and 8-bit sRGB outside.
//!
//! Modules are declared in reading order, which is also the order of dependencies. The feature
//! `parallel` (on by default) works on the current rayon pool.

#![forbid(unsafe_code)]

// The README's library example is compiled and run with the documentation's.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Repository;

mod error;
pub mod info;
pub mod math;
#[doc(hidden)]
pub mod parallel;
pub mod simd;
mod sorting;
mod stopwatch;
pub mod trace;
pub mod work;

pub mod target;

pub mod scene;

#[cfg(test)]
mod testing;

pub mod geometry;

pub mod curve;

pub mod clip;

pub mod view;

pub mod raster;

pub mod paper;

pub mod shade;

pub mod fragment;

pub mod commands;

pub mod visibility;

pub mod annotate;

pub mod plot;

pub mod map;

pub mod explain;

pub mod pipeline;

pub use error::{Error, Result};
