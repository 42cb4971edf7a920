//! The hierarchical z-buffer: an octree of faces from front to back, and a pyramid of depths that hides whole cells.
//!
//! N. Greene, M. Kass, G. Miller, *Hierarchical Z-buffer visibility*, SIGGRAPH 1993. Each entry of the pyramid's level
//! k is the farthest depth of 2 × 2 entries of level k − 1, and level 0 is the z-buffer: everything farther than an
//! entry is hidden in all of the entry's pixels. A cell of the octree whose front is hidden is left out with its
//! contents. Class: image space, with object-space coherence by the octree and image-space coherence by the pyramid.
//! Cost: O(visible cells and faces, and pixels of these); memory O(4/3 pixels + faces).
//!
//! Deviations: the eye looks along z in parallel, so that cells are seen as rectangles, the front of a cell is its
//! lowest z, and children come in the order of z. A face belongs to the smallest cell that holds it. The paper's
//! temporal coherence (the faces visible in the previous picture first) is left out. Among equally near faces the first
//! wins, as in the family.

use super::octree::tree::{self, Division, Holding, Octree};
use super::pyramid::{Entry, Pyramid};
use super::{Face, Screen};
use crate::Result;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec3;
use crate::target::{NO_ITEM, Pixels};
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "hierarchical-z-buffer",
    title: "Hierarchical z-buffer",
    authors: "N. Greene, M. Kass, G. Miller",
    year: 1993,
    source: "Hierarchical Z-buffer visibility, SIGGRAPH",
    class: Class::ImageSpace,
    occluder: Occluder::Area,
    coherence: &[Coherence::Object, Coherence::Area, Coherence::Depth],
    cost: "O(visible cells and faces, and their pixels) time, 4/3 depths per pixel and O(faces) memory",
    limits: "one sample per pixel; plane polygons; what is hidden by several faces is found only where their depths are \
             already in one entry of the pyramid",
    pseudocode: &[
        "put each face into the smallest cell of an octree that holds it",
        "all entries of the pyramid ← ∞",
        "visit(cell): begin with the root",
        "    // the finest entry that covers all pixels of the cell",
        "    z of the cell's front > farthest depth of that entry: the cell is hidden, return",
        "    for each face of the cell itself:",
        "        z of its nearest corner > farthest depth of its entry: it is hidden, next face",
        "        for each pixel where it is nearer than the depth of level 0:",
        "            store depth and face",
        "            level by level: entry ← farthest of its four, until one stays as it was",
        "    for each child of the cell, front to back: visit(child)",
    ],
};

/// Options for the octree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// A cell with more faces than this is divided.
    pub capacity: usize,
    /// Divisions of a cell by a cell at most.
    pub depth: u32,
}

impl Default for Options {
    /// Returns the default: cells of at most two faces, eight divisions deep.
    fn default() -> Self {
        Self { capacity: 2, depth: 8 }
    }
}

/// Comparison of a cell or face with an entry of the pyramid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PyramidTest {
    /// Lowest z of the cell or face.
    pub nearest: f64,
    /// Level of the pyramid; 0 is the z-buffer.
    pub level: u32,
    /// Column and row in that level.
    pub entry: [u32; 2],
    /// Farthest depth of the entry's pixels.
    pub farthest: f64,
}

impl PyramidTest {
    /// Returns whether the cell or face is hidden.
    pub(crate) fn is_hidden(&self) -> bool {
        self.nearest > self.farthest
    }
}

/// Step of the algorithm. Cells are numbered in the order in which they are made, from the root.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A cell of the octree, once it is complete.
    Cell {
        /// Number of the cell.
        cell: usize,
        /// Its corners: x, y in pixels, z from the eye.
        corners: [DVec3; 2],
        /// Number of the faces that belong to it and to none of its children.
        faces: usize,
    },
    /// A cell is compared with the pyramid.
    Visit {
        /// Number of the cell.
        cell: usize,
        /// The comparison.
        test: PyramidTest,
    },
    /// A cell is hidden or outside the picture, and left out with its contents.
    LeaveOut {
        /// Number of the cell.
        cell: usize,
        /// Number of faces in it and its children.
        faces: usize,
    },
    /// A face of a cell is compared with the pyramid; it is drawn unless it is hidden.
    Face {
        /// Its index.
        face: u32,
        /// The comparison.
        test: PyramidTest,
    },
    /// A nearer face is stored for a pixel.
    Store {
        /// Column and row.
        pixel: [u32; 2],
        /// The face.
        face: u32,
        /// Its depth.
        depth: f64,
    },
    /// A nearer depth is stored in an entry of the pyramid.
    Lower {
        /// Level, 1 or more.
        level: u32,
        /// Column and row in that level.
        entry: [u32; 2],
        /// Farthest depth of its pixels now.
        farthest: f64,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Cell { .. } => 1,
            Self::Visit { .. } => 4,
            Self::LeaveOut { .. } => 5,
            Self::Face { test, .. } => {
                if test.is_hidden() {
                    7
                } else {
                    8
                }
            }
            Self::Store { .. } => 9,
            Self::Lower { .. } => 10,
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
/// [`Memory`](crate::Error::Memory) if the screen's budget does not suffice.
pub fn items(
    faces: &[Face],
    screen: &Screen,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Pixels<u32>> {
    let Options { capacity, depth } = *options;
    // Each face is in one cell.
    let division = Division { holding: Holding::Whole, capacity, depth, most: faces.len() };
    let octree = Octree::new(faces, &division, &screen.work)?;
    for (cell, own) in octree.cells.iter().enumerate() {
        t.step(|| Step::Cell { cell, corners: [own.low, own.high], faces: own.faces.len() });
    }
    let _table = screen.edge_table(faces)?;
    let mut picture =
        Picture { faces, screen, pyramid: Pyramid::new(screen)?, items: screen.plane(NO_ITEM)? };
    let mut waiting: Vec<usize> = if octree.cells.is_empty() { Vec::new() } else { vec![0] };
    while let Some(cell) = waiting.pop() {
        let own = &octree.cells[cell];
        let test = picture.test(own.low, own.high);
        if let Some(test) = test {
            t.step(|| Step::Visit { cell, test });
        }
        if test.is_none_or(|test| test.is_hidden()) {
            t.step(|| Step::LeaveOut { cell, faces: octree.count(cell) });
            continue;
        }
        own.faces.iter().for_each(|face| picture.draw(*face, t));
        // The last one put there is the first to be visited.
        waiting.extend(own.children.iter().rev());
    }
    Ok(picture.items)
}

/// The picture as it becomes.
struct Picture<'a> {
    faces: &'a [Face],
    screen: &'a Screen,
    pyramid: Pyramid,
    items: Pixels<u32>,
}

impl Picture<'_> {
    /// Compares a box with the finest entry of the pyramid that covers it; `None` outside of the picture.
    fn test(&self, low: DVec3, high: DVec3) -> Option<PyramidTest> {
        let Entry { level, at: entry } = self.pyramid.covering(low.truncate(), high.truncate())?;
        let farthest = self.pyramid.get(level, entry);
        Some(PyramidTest { nearest: low.z, level, entry, farthest })
    }

    fn draw(&mut self, number: u32, t: &mut impl Tracer<Step>) {
        let face = &self.faces[number as usize];
        let [low, high] = tree::bounds(face);
        let Some(test) = self.test(low, high) else { return };
        t.step(|| Step::Face { face: number, test });
        if test.is_hidden() {
            return;
        }
        let (pyramid, items) = (&mut self.pyramid, &mut self.items);
        face.pixels(self.screen, |pixel @ [x, y], point| {
            let (depth, stored) = (point.z, pyramid.get(0, pixel));
            let first = || items.get(x, y).is_some_and(|item| number < item);
            if depth < stored || depth == stored && first() {
                t.step(|| Step::Store { pixel, face: number, depth });
                items.set(x, y, number);
                pyramid.lower(pixel, depth, |level, entry, farthest| {
                    t.step(|| Step::Lower { level, entry, farthest });
                });
            }
        });
    }
}
