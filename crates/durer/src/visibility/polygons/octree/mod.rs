//! Octree: faces in cells of space, whose pixels are filled from front to back.
//!
//! D. Meagher, *Geometric modeling using octree encoding*, Computer Graphics and Image Processing 19(2), 1982. Class:
//! image space, with an order of cells that is the same for all scenes: of the eight children of a cell the four near
//! ones come before the four far ones, and none of the four hides another. Each pixel is filled once, by the first cell
//! that has a face in it; a cell all of whose pixels are filled is left out with everything in it. Cost: O(cells and
//! parts of faces in them, and pixels of these); memory O(4/3 pixels + parts of faces in cells).
//!
//! Deviations: the paper's cells are full or empty, here the smallest ones hold faces, which are compared by their
//! depths; the eye looks along z in parallel. A pyramid, the paper's quadtree, records filled pixels. Cells do not
//! include their upper borders, so that among equally near faces the first one is visible, as in the family.

pub(super) mod tree;

use super::pyramid::{Entry, Pyramid};
use super::{Face, Screen};
use crate::Result;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec3;
use crate::raster::span::Span;
use crate::sorting::CompactSort;
use crate::target::{NO_ITEM, Pixels};
use crate::trace::{PseudocodeLine, Tracer};
use std::collections::BTreeMap;
use tree::{Cell, Division, Holding, Octree};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "octree",
    title: "Octree from front to back",
    authors: "D. Meagher",
    year: 1982,
    source: "Geometric modeling using octree encoding, Computer Graphics and Image Processing 19(2)",
    class: Class::ImageSpace,
    occluder: Occluder::Area,
    coherence: &[Coherence::Object, Coherence::Area],
    cost: "O(visited cells, parts of faces in them, and their pixels) time, O(pixels + parts of faces) memory",
    limits: "one sample per pixel; plane polygons; faces that pass through many cells are in all of them",
    pseudocode: &[
        "the root ← the box around all faces",
        "divide a cell into eight while it has many faces; a face goes into each cell that it meets",
        "visit(cell): begin with the root",
        "    all pixels of the cell are filled: it is hidden, return",
        "    if it has children:",
        "        visit the near four, then the far four",
        "    else: for each pixel of the cell that is not filled:",
        "        of the faces of the cell, those whose depth there is within the cell",
        "        the nearest of them fills the pixel, for good",
    ],
};

/// Options for the octree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// A cell with more faces than this is divided.
    pub capacity: usize,
    /// Divisions of a cell by a cell at most.
    pub depth: u32,
    /// Largest total number of faces in all cells; a face counts in each of its cells.
    pub max_parts: usize,
}

impl Default for Options {
    /// Returns the default: cells of at most two faces, six divisions deep, four million parts of faces.
    fn default() -> Self {
        Self { capacity: 2, depth: 6, max_parts: 1 << 22 }
    }
}

/// Step of the algorithm. Cells are numbered in the order in which they are made, from the root.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// A cell of the octree, once it is complete.
    Cell {
        /// Its number.
        cell: usize,
        /// Its corners: x, y in pixels, z from the eye.
        corners: [DVec3; 2],
        /// Its children, from front to back; none for the smallest cells.
        children: Vec<usize>,
    },
    /// A cell with children is visited.
    Visit {
        /// Its number.
        cell: usize,
    },
    /// A cell has no pixels in the picture that are not filled.
    LeaveOut {
        /// Its number.
        cell: usize,
        /// Number of cells in it, itself one of them.
        cells: usize,
    },
    /// One of the smallest cells: its faces are compared with each other.
    Leaf {
        /// Its number.
        cell: usize,
        /// Its faces.
        faces: Vec<u32>,
    },
    /// A pixel is filled.
    Store {
        /// Column and row.
        pixel: [u32; 2],
        /// The face.
        face: u32,
        /// Its depth.
        depth: f64,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Cell { .. } => 2,
            Self::LeaveOut { .. } => 4,
            Self::Visit { .. } => 6,
            Self::Leaf { .. } => 8,
            Self::Store { .. } => 9,
        }
    }
}

/// Returns the picture that a list of steps leads to.
///
/// # Errors
/// [`Memory`](crate::Error::Memory) if the screen's budget does not suffice.
pub fn replay(screen: &Screen, steps: &[Step]) -> Result<Pixels<u32>> {
    screen.painted(steps.iter().filter_map(|step| match *step {
        Step::Store { pixel, face, .. } => Some((pixel, face)),
        _ => None,
    }))
}

/// Returns the index of the nearest face at each pixel's centre, of equally near ones the first.
///
/// # Errors
/// [`Memory`](crate::Error::Memory) if the screen's budget does not suffice; [`Limit`](crate::Error::Limit) for
/// more parts of faces than the options allow.
pub fn items(
    faces: &[Face],
    screen: &Screen,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Pixels<u32>> {
    let Options { capacity, depth, max_parts: most } = *options;
    let division = Division { holding: Holding::Parts, capacity, depth, most };
    let octree = Octree::new(faces, &division, &screen.work)?;
    for (cell, own) in octree.cells.iter().enumerate() {
        let corners = [own.low, own.high];
        t.step(|| Step::Cell { cell, corners, children: own.children.clone() });
    }
    let _table = screen.edge_table(faces)?;
    let mut charge = screen.work.charge("runs of pixels", 0)?;
    let mut spans = |face: &Face| {
        let mut spans = Vec::new();
        face.spans(screen, |span| spans.push(span));
        charge.grow((spans.len() * size_of::<Span>()) as u64)?;
        spans.compact_sort_by_key(|span| (span.y, span.x0));
        Ok(spans)
    };
    let mut picture = Picture {
        faces,
        spans: faces.iter().map(&mut spans).collect::<Result<_>>()?,
        pyramid: Pyramid::new(screen)?,
        items: screen.plane(NO_ITEM)?,
    };
    let Some(root) = octree.cells.first() else { return Ok(picture.items) };
    let mut waiting = vec![0];
    while let Some(cell) = waiting.pop() {
        let own = &octree.cells[cell];
        if picture.is_filled(own) {
            t.step(|| Step::LeaveOut { cell, cells: octree.cells_in(cell) });
        } else if own.children.is_empty() {
            t.step(|| Step::Leaf { cell, faces: own.faces.clone() });
            let _nearest = screen
                .work
                .charge_for::<[Nearest; 2]>("pixels of a cell", pixels_in(own, screen))?;
            picture.fill(own, root, t);
        } else {
            t.step(|| Step::Visit { cell });
            // The last one put there is the first to be visited.
            waiting.extend(own.children.iter().rev());
        }
    }
    Ok(picture.items)
}

/// Returns the most pixels of the screen that a cell has.
fn pixels_in(cell: &Cell, screen: &Screen) -> u64 {
    let along = |low: f64, high: f64, size: u32| {
        (high.ceil().min(size.into()) - low.floor().max(0.0)).max(0.0) as u64 + 1
    };
    let columns = along(cell.low.x, cell.high.x, screen.width);
    columns.saturating_mul(along(cell.low.y, cell.high.y, screen.height))
}

/// A pixel of a cell, with the depth and the number of its nearest face.
type Nearest = ([u32; 2], (f64, u32));

/// The picture as it becomes.
struct Picture<'a> {
    faces: &'a [Face],
    /// Runs of pixels of each face, row by row.
    spans: Vec<Vec<Span>>,
    /// Depths of filled pixels; infinite where one is not filled.
    pyramid: Pyramid,
    items: Pixels<u32>,
}

impl Picture<'_> {
    /// Returns whether all pixels of a cell are filled, or outside of the picture.
    fn is_filled(&self, cell: &Cell) -> bool {
        let entry = self.pyramid.covering(cell.low.truncate(), cell.high.truncate());
        entry.is_none_or(|Entry { level, at }| self.pyramid.get(level, at) < f64::INFINITY)
    }

    /// Fills the pixels of a smallest cell that are not filled by the nearest of its faces.
    fn fill(&mut self, cell: &Cell, root: &Cell, t: &mut impl Tracer<Step>) {
        // Borders of the root are ignored, because rounding may place a face just beyond them.
        let is_in = |p: DVec3| {
            let above = p.cmpge(cell.low) | cell.low.cmpeq(root.low);
            (above & (p.cmplt(cell.high) | cell.high.cmpeq(root.high))).all()
        };
        let mut nearest = BTreeMap::<[u32; 2], (f64, u32)>::new();
        for &face in &cell.faces {
            let spans = &self.spans[face as usize];
            let first = spans.partition_point(|span| f64::from(span.y) + 1.0 <= cell.low.y);
            let rows = spans[first..].iter().take_while(|s| f64::from(s.y) <= cell.high.y);
            for span in rows {
                let from = span.x0.max(cell.low.x.floor() as i32);
                let to = span.x1.min(cell.high.x.ceil() as i32);
                for x in from..to {
                    let point = self.faces[face as usize].at(x, span.y);
                    let [column, row] = [x as u32, span.y as u32];
                    if !is_in(point) || self.items.get(column, row) != Some(NO_ITEM) {
                        continue;
                    }
                    let best = nearest.entry([row, column]).or_insert((point.z, face));
                    // Faces of a cell are in order.
                    if point.z < best.0 {
                        *best = (point.z, face);
                    }
                }
            }
        }
        for ([y, x], (depth, face)) in nearest {
            t.step(|| Step::Store { pixel: [x, y], face, depth });
            self.items.set(x, y, face);
            self.pyramid.lower([x, y], depth, |_, _, _| {});
        }
    }
}
