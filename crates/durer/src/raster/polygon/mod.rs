//! Polygons by their pixels' centres: scan conversion without smoothing, by two methods.
//!
//! Both snap vertices to 1/256 of a pixel, decide with exact arithmetic from there on, and emit the same spans:
//! row by row from the top, from left to right; spans of a row do not touch. A pixel belongs to the polygon
//! if its centre does; a centre on the border belongs to a left and an upper edge (y down), not to a right or
//! lower one, so faces that share edges light each pixel once.
//!
//! [`edge_fill`] (with or without a fence) and [`edge_flag`] find the same pixels by the even-odd rule without any list
//! or sorting, in a plane of their own.
//!
//! ```
//! use durer::curve::{Path, flatten};
//! use durer::raster::polygon::{Options, PolygonRasterizer};
//!
//! let square = flatten(&Path::rectangle(0.5, 0.5, 2.0, 2.0), 0.1);
//! let mut spans = Vec::new();
//! let keep = |s: durer::raster::Span| spans.push((s.y, s.x0, s.x1));
//! PolygonRasterizer::OrderedEdgeList.fill(&square, 8, 8, &Options::default(), keep);
//! assert_eq!(spans, [(0, 0, 2), (1, 0, 2)]);
//! ```

pub(crate) mod crossings;
pub mod edge_fill;
pub mod edge_flag;
pub mod edge_table;
pub mod ordered_edge_list;
mod rows;

use std::ops::Range;

use super::coverage::FillRule;
use super::fixed::snap;
use super::span::Span;
use crate::curve::Contours;
use crate::math::DVec2;
use crate::raster::clipped::{Lines, lines, pieces};
use crate::trace::NoTrace;

crate::info::family! {
    /// Methods to scan convert a polygon.
    pub enum PolygonRasterizer {
        /// Edges in order of their first row, the active ones followed from row to row.
        EdgeTable => edge_table::INFO,
        /// Crossings with all rows first, sorted by row and column; the fast one.
        OrderedEdgeList => ordered_edge_list::INFO,
    }
}

impl PolygonRasterizer {
    /// Emits the spans of the polygon within a `width` × `height` target, row by row and from left to right;
    /// contours count as closed, points that are not finite are left out. Coordinates in pixels.
    pub fn fill(
        self,
        contours: &Contours,
        width: u32,
        height: u32,
        options: &Options,
        emit: impl FnMut(Span),
    ) {
        match self {
            Self::EdgeTable => {
                edge_table::fill(contours, width, height, options, emit, &mut NoTrace);
            }
            Self::OrderedEdgeList => {
                ordered_edge_list::fill(contours, width, height, options, emit, &mut NoTrace);
            }
        }
    }
}

/// Options for filling a polygon.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Rule that decides which winding numbers are inside.
    pub rule: FillRule,
}

/// Edges reach from the first to the second of these, in pixels, across and down; beyond they are cut. With
/// [`super::coverage`]'s largest target in the middle, x of an edge is exact enough in f64.
const REACH: (f64, f64) = (-32_768.0, 65_536.0);

/// Calls `f` with the edges of the contours, each closed, that begin in a range of all points, snapped to the grid of
/// [`super::fixed`] and directed as in the contour. Both faces of a shared edge get the same points.
fn snapped_edges(
    contours: &Contours,
    range: Range<usize>,
    mut f: impl FnMut((i32, i32), (i32, i32)),
) {
    let grid = |p: DVec2| (snap(p.x), snap(p.y));
    let (low, high) = (DVec2::splat(REACH.0), DVec2::splat(REACH.1));
    let within = |p: DVec2| p.cmpge(low).all() && p.cmple(high).all();
    for (points, mut own) in contours.within(range) {
        while let Some(some) = Lines::next(points, &mut own, low, high) {
            match some {
                Lines::Inside(from, rest, next) => {
                    let mut from = grid(*from);
                    for i in 0..=rest.len() {
                        let to = grid(*rest.get(i).unwrap_or(next));
                        f(from, to);
                        from = to;
                    }
                }
                Lines::Any(points, own) => {
                    for (a, b) in lines(points, own) {
                        if within(a) && within(b) {
                            f(grid(a), grid(b));
                            continue;
                        }
                        for (p, q) in pieces(a, b, low, high).into_iter().flatten() {
                            f(grid(p), grid(q));
                        }
                    }
                }
            }
        }
    }
}

fn is_inside(winding: i32, rule: FillRule) -> bool {
    match rule {
        FillRule::NonZero => winding != 0,
        FillRule::EvenOdd => winding & 1 != 0,
    }
}
