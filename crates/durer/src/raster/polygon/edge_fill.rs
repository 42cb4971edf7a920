//! Polygons by complements: edge fill and fence fill.
//!
//! Edge fill: B. D. Ackland, N. H. Weste, *Real time animation playback on a frame store display system*, SIGGRAPH
//! 1980: for each crossing of an edge with a row, all pixels to the right of it are complemented. Pixels inside have an
//! odd number of edges to their left and are complemented an odd number of times. Fence fill: M. R. Dunlavey,
//! *Efficient polygon-filling algorithms for raster displays*, ACM Transactions on Graphics 2(4), 1983: only the pixels
//! between the edge and a fence, a vertical line through the polygon, are complemented. Class: image space. Cost:
//! O(pixels right of edges), or O(pixels between edges and fence); no list, no sorting, edges in any order.
//!
//! Limits: the even-odd rule; a separate plane, because its contents are complemented; pixels are touched several
//! times. Vertices are snapped to 1/256 of a pixel.

use super::rows::for_each_crossing;
use crate::curve::Contours;
use crate::info::{Class, Info, Occluder};
use crate::target::Pixels;
use crate::trace::{PseudocodeLine, Tracer};

/// The facts of edge fill.
pub const INFO: Info = Info {
    name: "edge-fill",
    title: "Edge fill",
    authors: "B. D. Ackland, N. H. Weste",
    year: 1980,
    source: "Real time animation playback on a frame store display system, SIGGRAPH",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(p): p pixels to the right of all edges, each of them once per edge",
    limits: "the even-odd rule; needs a separate plane; vertices are snapped to 1/256 of a pixel",
    pseudocode: &[
        "clear the plane",
        "for each edge of the polygon, in any order:",
        "    for each row whose centre it crosses:",
        "        x ← first pixel right of the crossing",
        "        for each pixel from x to the end of the row:",
        "            complement it",
        "// pixels complemented an odd number of times are inside:",
        "// they have an odd number of edges to their left",
    ],
};

/// The facts of fence fill.
pub const FENCE: Info = Info {
    name: "fence-fill",
    title: "Fence fill",
    authors: "M. R. Dunlavey",
    year: 1983,
    source: "Efficient polygon-filling algorithms for raster displays, ACM Transactions on Graphics 2(4)",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(p): p pixels between all edges and the fence, each of them once per edge",
    limits: "the even-odd rule; needs a separate plane; vertices are snapped to 1/256 of a pixel",
    pseudocode: &[
        "clear the plane; put the fence through the polygon, before column f",
        "for each edge of the polygon, in any order:",
        "    for each row whose centre it crosses:",
        "        x ← first pixel right of the crossing",
        "        x ≤ f: complement the pixels from x to the fence",
        "        x > f: complement the pixels from the fence to x, exclusive",
        "// each row crosses an even number of edges, so the fence itself has no effect",
        "// pixels complemented an odd number of times are inside",
    ],
};

/// Options for complementing pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Column before which the fence is; `None` = after the last one, which is edge fill.
    pub fence: Option<u32>,
}

/// Step of both algorithms: the pixels between a crossing and the fence are complemented.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    /// Row.
    pub y: u32,
    /// First pixel right of the crossing.
    pub x: u32,
    /// Column before which the fence is.
    pub fence: u32,
}

impl Step {
    /// Returns the pixels that are complemented, as a range of columns.
    pub fn columns(&self) -> std::ops::Range<u32> {
        self.x.min(self.fence)..self.x.max(self.fence)
    }

    fn apply(&self, plane: &mut Pixels<bool>) {
        let row = plane.row_mut(self.y);
        let (from, to) = (self.columns().start as usize, self.columns().end as usize);
        row.get_mut(from..to).into_iter().flatten().for_each(|pixel| *pixel = !*pixel);
    }
}

impl PseudocodeLine for Step {
    /// Returns the line of the pseudocode of fence fill, counted from 1; edge fill has its crossings left of the fence.
    fn line(&self) -> usize {
        if self.x <= self.fence { 5 } else { 6 }
    }
}

/// Complements the pixels of a polygon in a plane, by the even-odd rule; contours count as closed, points that are not
/// finite are left out. Coordinates in pixels.
///
/// ```
/// use durer::curve::Contours;
/// use durer::math::DVec2;
/// use durer::raster::polygon::edge_fill::{Options, fill};
/// use durer::target::Pixels;
/// use durer::trace::NoTrace;
///
/// let triangle = Contours::polygon([(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)].map(DVec2::from));
/// let mut plane = Pixels::new(4, 4, false);
/// fill(&triangle, &mut plane, &Options { fence: Some(2) }, &mut NoTrace);
/// assert_eq!(plane.row(1), [true, true, false, false]);
/// ```
pub fn fill(
    contours: &Contours,
    plane: &mut Pixels<bool>,
    options: &Options,
    t: &mut impl Tracer<Step>,
) {
    let size = (plane.width(), plane.height());
    let fence = options.fence.map_or(size.0, |fence| fence.min(size.0));
    for_each_crossing(contours, size, |y, x| {
        let step = Step { y, x, fence };
        t.step(|| step);
        step.apply(plane);
    });
}

/// Returns a plane with the pixels that a list of steps leads to.
pub fn replay((width, height): (u32, u32), steps: &[Step]) -> Pixels<bool> {
    let mut plane = Pixels::new(width, height, false);
    steps.iter().for_each(|step| step.apply(&mut plane));
    plane
}
