//! Triangles by edge functions over the bounding box.
//!
//! Juan Pineda, *A Parallel Algorithm for Polygon Rasterization*, SIGGRAPH 1988. Image space. Three
//! linear functions, one an edge, are positive inside; from pixel to pixel each costs one addition.
//! Time is proportional to the bounding box, which for a sliver is far more than its pixels.

pub use super::Options;
use super::{Edge, SnappedTriangle, Span};
use crate::info::{Class, Coherence, Info, Occluder};
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "edge-function",
    title: "Edge functions over the bounding box",
    authors: "Juan Pineda",
    year: 1988,
    source: "A Parallel Algorithm for Polygon Rasterization, SIGGRAPH",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge],
    cost: "O(pixels of the bounding box) time, O(1) memory",
    limits: "coordinates within the guard band",
    pseudocode: &[
        "E_i(x, y) ← Δx_i · (y − y_i) − Δy_i · (x − x_i), one for each edge",
        "if the edge is neither a left one nor a top one: E_i ← E_i − 1",
        "for each row y of the bounding box:",
        "    for each pixel x of the row:",
        "        // from pixel to pixel E_i grows by −Δy_i, from row to row by Δx_i",
        "        evaluate E_1, E_2 and E_3 at the pixel's centre",
        "        if all three are ≥ 0:",
        "            set pixel (x, y)",
    ],
};

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// The functions were evaluated at a pixel's centre.
    Sample {
        /// Column.
        x: i32,
        /// Row.
        y: i32,
        /// The three functions, biased so that ≥ 0 is inside, in 1/256² pixel².
        edges: [i64; 3],
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Sample { .. } => 6,
        }
    }
}

/// Emits the covered pixels, row by row from the top, one span a row.
pub fn rasterize(
    triangle: &SnappedTriangle,
    options: &Options,
    mut emit: impl FnMut(Span),
    t: &mut impl Tracer<Step>,
) {
    let Some(edges) = triangle.edges() else { return };
    let pixels = triangle.pixels(&options.clip);
    if pixels.is_empty() {
        return;
    }
    let mut at_row = edges.map(|e| e.at_center(pixels.x0(), pixels.y0()));
    for y in pixels.y0()..pixels.y1() {
        if let Some((x0, x1)) = covered(&edges, at_row, y, pixels.x0()..pixels.x1(), t) {
            emit(Span { y, x0, x1 });
        }
        for (value, edge) in at_row.iter_mut().zip(&edges) {
            *value += edge.step_y();
        }
    }
}

/// Returns the run of covered columns of one row; a triangle is convex, so there is at most one.
fn covered(
    edges: &[Edge; 3],
    mut at: [i64; 3],
    y: i32,
    columns: std::ops::Range<i32>,
    t: &mut impl Tracer<Step>,
) -> Option<(i32, i32)> {
    let steps = edges.map(|e| e.step_x());
    let mut start = None;
    for x in columns.clone() {
        t.step(|| Step::Sample { x, y, edges: at });
        let inside = (at[0] | at[1] | at[2]) >= 0;
        match (start, inside) {
            (None, true) => start = Some(x),
            (Some(x0), false) => return Some((x0, x)),
            _ => {}
        }
        at = [at[0] + steps[0], at[1] + steps[1], at[2] + steps[2]];
    }
    start.map(|x0| (x0, columns.end))
}
