//! Polygon scan conversion with an edge table and an active edge table.
//!
//! C. Wylie, G. Romney, D. Evans, A. Erdahl, *Half-tone perspective drawings by computer*, AFIPS FJCC 1967; the
//! integer form of the edge step after Foley, van Dam, *Computer Graphics* (1990), 3.6. Class: image space.
//! Cost: O(e log e + crossings + spans); an edge costs one division when it starts and none per row.
//! Limits: vertices are snapped to 1/256 of a pixel.
//!
//! The simple method, against which [`super::ordered_edge_list`] is checked.

pub use super::Options;
use super::{is_inside, snapped_edges};
use crate::curve::Contours;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::raster::coverage::FillRule;
use crate::raster::fixed::{HALF_PIXEL, SUBPIXELS, first_center};
use crate::raster::span::Span;
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "edge-table",
    title: "Edge table and active edge table",
    authors: "C. Wylie, G. Romney, D. Evans, A. Erdahl",
    year: 1967,
    source: "Half-tone perspective drawings by computer, AFIPS FJCC",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge, Coherence::ScanLine, Coherence::Span],
    cost: "O(e log e + c): e edges, c crossings of edges with rows",
    limits: "vertices are snapped to 1/256 of a pixel",
    pseudocode: &[
        "ET ← for each row the edges that begin there: y_max, x, Δx/Δy",
        "AET ← ∅, y ← first row with an edge",
        "while ET or AET is not empty:",
        "    move the edges of row y from the ET to the AET",
        "    sort the AET by x",
        "    for each pair of neighbours in the AET:",
        "        fill from the x of the first to that of the second, exclusive",
        "    y ← y + 1",
        "    remove the edges with y_max = y from the AET",
        "    for each edge in the AET:",
        "        x ← x + ⌊Δx/Δy⌋, acc ← acc + Δx mod Δy",
        "        if acc ≥ Δy: x ← x + 1, acc ← acc − Δy",
    ],
};

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// An entry of the edge table, row by row (bucket by bucket), before anything is filled.
    Table(TableEdge),
    /// An edge enters the active edge table at this row and pixel.
    Enter {
        /// Row.
        y: i32,
        /// First pixel right of the edge.
        x: i64,
    },
    /// An entry of the active edge table in this row; they come in the order of x, before the row's spans.
    Active {
        /// Row.
        y: i32,
        /// Edge as it is in this row.
        edge: TableEdge,
    },
    /// Edges that end above this row leave the table; this many stay.
    Leave {
        /// Row.
        y: i32,
        /// Edges still active.
        active: usize,
    },
    /// A span is emitted.
    Span(Span),
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Table(_) => 1,
            Self::Enter { .. } => 4,
            Self::Active { .. } => 5,
            Self::Span(_) => 7,
            Self::Leave { .. } => 9,
        }
    }
}

/// An edge in the tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TableEdge {
    /// First row whose centres the edge crosses, and one past the last: y_min and y_max.
    pub rows: (i32, i32),
    /// First pixel of the current row whose centre is not left of the edge.
    pub x: i64,
    /// The accumulator: the distance of the edge to the right of the centre of that pixel's left neighbour, in
    /// 1/`whole` of a pixel, minus one.
    pub error: i64,
    /// Increment of `x` from row to row without the accumulator: the whole pixels of Δx/Δy.
    pub step: i64,
    /// Increment of the accumulator from row to row: the rest of Δx/Δy, in 1/`whole` of a pixel.
    pub remainder: i64,
    /// Amount in the accumulator that is one pixel: when it is reached, `x` grows by one.
    pub whole: i64,
    /// 1 for an edge that goes down in the contour, −1 for one that goes up.
    pub winding: i32,
}

impl TableEdge {
    /// Creates the edge between two snapped points, set up for row `top` or its first one below; `None`
    /// if it crosses no row's centres.
    fn new(a: (i32, i32), b: (i32, i32), top: i32) -> Option<Self> {
        let (upper, lower, winding) = if a.1 <= b.1 { (a, b, 1) } else { (b, a, -1) };
        let first = first_center(upper.1).max(top);
        let last = first_center(lower.1);
        if first >= last {
            return None;
        }
        let (dx, dy) =
            (i64::from(lower.0) - i64::from(upper.0), i64::from(lower.1) - i64::from(upper.1));
        let below = i128::from(first) * i128::from(SUBPIXELS) + i128::from(HALF_PIXEL)
            - i128::from(upper.1);
        let whole = dy * i64::from(SUBPIXELS);
        // x of the edge minus half a pixel, in 1/(256 · dy): rounded up it is the first pixel.
        let x = i128::from(upper.0 - HALF_PIXEL) * i128::from(dy) + i128::from(dx) * below;
        let up = x + i128::from(whole) - 1;
        Some(Self {
            rows: (first, last),
            x: up.div_euclid(i128::from(whole)) as i64,
            error: up.rem_euclid(i128::from(whole)) as i64,
            step: dx.div_euclid(dy),
            remainder: dx.rem_euclid(dy) * i64::from(SUBPIXELS),
            whole,
            winding,
        })
    }

    /// Returns the crossing of the edge with the centre of the current row, in pixels from the
    /// centre of column 0; filling never computes it.
    pub fn crossing(&self) -> f64 {
        (self.x - 1) as f64 + (self.error + 1) as f64 / self.whole as f64
    }

    /// Goes on to the next row.
    pub(crate) fn advance(&mut self) {
        self.x += self.step;
        self.error += self.remainder;
        if self.error >= self.whole {
            self.error -= self.whole;
            self.x += 1;
        }
    }
}

/// Calls `emit` for the spans of the polygon within a `width` × `height` target, row by row and from left
/// to right; contours count as closed, points that are not finite are left out. Coordinates in pixels.
///
/// ```
/// use durer::curve::{Path, flatten};
/// use durer::raster::polygon::edge_table::{Options, fill};
/// use durer::trace::NoTrace;
///
/// let square = flatten(&Path::rectangle(0.5, 0.5, 2.0, 2.0), 0.1);
/// let mut spans = Vec::new();
/// fill(&square, 8, 8, &Options::default(), |s| spans.push((s.y, s.x0, s.x1)), &mut NoTrace);
/// assert_eq!(spans, [(0, 0, 2), (1, 0, 2)]);
/// ```
pub fn fill(
    contours: &Contours,
    width: u32,
    height: u32,
    options: &Options,
    mut emit: impl FnMut(Span),
    t: &mut impl Tracer<Step>,
) {
    let mut table = table(contours, height);
    table.sort_by_key(|e| std::cmp::Reverse(e.rows.0));
    table.iter().rev().for_each(|edge| t.step(|| Step::Table(*edge)));
    let mut active: Vec<TableEdge> = Vec::new();
    let mut y = table.last().map_or(0, |e| e.rows.0);
    while (y as u32) < height && !(table.is_empty() && active.is_empty()) {
        while let Some(edge) = table.pop_if(|e| e.rows.0 == y) {
            t.step(|| Step::Enter { y, x: edge.x });
            active.push(edge);
        }
        active.sort_by_key(|e| e.x);
        active.iter().for_each(|&edge| t.step(|| Step::Active { y, edge }));
        row(&active, y, width, options.rule, |span| {
            t.step(|| Step::Span(span));
            emit(span);
        });
        y += 1;
        active.retain(|e| e.rows.1 > y);
        t.step(|| Step::Leave { y, active: active.len() });
        active.iter_mut().for_each(TableEdge::advance);
        if active.is_empty() {
            y = table.last().map_or(y, |e| e.rows.0);
        }
    }
}

/// Returns the edges of a polygon that cross rows of the target.
pub(crate) fn table(contours: &Contours, height: u32) -> Vec<TableEdge> {
    let mut table = Vec::new();
    snapped_edges(contours, 0..contours.points().len(), |a, b| {
        table.extend(TableEdge::new(a, b, 0).filter(|e| i64::from(e.rows.0) < i64::from(height)));
    });
    table
}

/// Emits the spans of one row from its edges in order of x; touching spans are joined.
pub(crate) fn row(
    active: &[TableEdge],
    y: i32,
    width: u32,
    rule: FillRule,
    mut emit: impl FnMut(Span),
) {
    let width = i64::from(width.min(i32::MAX as u32));
    let (mut winding, mut span) = (0, Span { y, x0: 0, x1: 0 });
    for edge in active {
        let before = is_inside(winding, rule);
        winding += edge.winding;
        let x = edge.x.clamp(0, width) as i32;
        if before {
            span.x1 = x;
        } else if x > span.x1 {
            Span::emit_unless_empty(y, span.x0, span.x1, &mut emit);
            span = Span { y, x0: x, x1: x };
        }
    }
    Span::emit_unless_empty(y, span.x0, span.x1, &mut emit);
}
