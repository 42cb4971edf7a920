//! The z-buffer as a plain loop.
//!
//! E. Catmull, *A Subdivision Algorithm for Computer Display of Curved Surfaces*, dissertation, University of Utah,
//! 1974. Class: image space. Cost: O(covered pixels) time, two numbers per pixel.
//! [`crate::visibility::surface::z_buffer`] renders models with the same result.

use super::{Face, Screen};
use crate::Result;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::target::{NO_ITEM, Pixels};
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "z-buffer-loop",
    title: "z-buffer, the plain loop",
    authors: "E. Catmull; W. Strasser",
    year: 1974,
    source: "A Subdivision Algorithm for Computer Display of Curved Surfaces, University of Utah",
    class: Class::ImageSpace,
    occluder: Occluder::Point,
    coherence: &[Coherence::Edge, Coherence::Depth],
    cost: "O(covered pixels) time, a depth and an item per pixel",
    limits: "one sample per pixel; plane polygons",
    pseudocode: &[
        "for each pixel: depth[x, y] ← ∞, item[x, y] ← none",
        "for each face:",
        "    for each pixel (x, y) that it covers:",
        "        z ← depth of the face's plane at (x, y)",
        "        // the only question: is it nearer than the stored depth?",
        "        if z < depth[x, y]:",
        "            depth[x, y] ← z",
        "            item[x, y] ← face",
    ],
};

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// All pixels are cleared: depth infinite, no face.
    Clear,
    /// The next face's turn.
    Face {
        /// Its index.
        face: u32,
    },
    /// A pixel that the face covers: its depth is compared with the stored one.
    Compare {
        /// Column and row.
        pixel: [u32; 2],
        /// The face's depth.
        depth: f64,
        /// The depth stored so far.
        stored: f64,
    },
    /// It was nearer: depth and face are stored.
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
            Self::Clear => 1,
            Self::Face { .. } => 2,
            Self::Compare { .. } => 6,
            Self::Store { .. } => 8,
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
pub fn items(faces: &[Face], screen: &Screen, t: &mut impl Tracer<Step>) -> Result<Pixels<u32>> {
    let mut depths = screen.plane(f64::INFINITY)?;
    let mut items = screen.plane(NO_ITEM)?;
    let _table = screen.edge_table(faces)?;
    t.step(|| Step::Clear);
    for (number, face) in (0..).zip(faces) {
        t.step(|| Step::Face { face: number });
        face.pixels(screen, |pixel @ [x, y], point| {
            let (depth, stored) = (point.z, depths.get(x, y).unwrap_or(f64::INFINITY));
            t.step(|| Step::Compare { pixel, depth, stored });
            if depth < stored {
                t.step(|| Step::Store { pixel, face: number, depth });
                depths.set(x, y, depth);
                items.set(x, y, number);
            }
        });
    }
    Ok(items)
}
