//! The painter's method alone: faces are sorted once by depth, then painted over each other from back to front, without
//! tests.
//!
//! In Newell, Newell, Sancha, *A Solution to the Hidden Surface Problem*, ACM Annual Conference 1972, the first step of
//! the depth sort. Class: list priority. Cost: O(n log n + covered pixels). It is wrong where faces overlap in depth
//! and in the picture, and no order at all is right where they overlap cyclically: so it is not a member of any family.
//! Use [`crate::visibility::surface::depth_sort`].

use super::{Face, Screen};
use crate::Result;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::sorting::CompactSort;
use crate::target::{NO_ITEM, Pixels};
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "painter",
    title: "Painter's method",
    authors: "M. Newell, R. Newell, T. Sancha",
    year: 1972,
    source: "A Solution to the Hidden Surface Problem, ACM Annual Conference",
    class: Class::ListPriority,
    occluder: Occluder::Area,
    coherence: &[Coherence::Face, Coherence::Depth],
    cost: "O(n log n + covered pixels), n faces",
    limits: "wrong where faces overlap in depth and in the picture",
    pseudocode: &[
        "for each face:",
        "    z ← its largest depth",
        "sort the faces by z, the farthest first",
        "for each face in this order:",
        "    for each row that it covers:",
        "        paint it over the picture so far",
        "// nothing is tested: where faces overlap in depth",
        "// the picture may be wrong",
    ],
};

/// Key by which faces are sorted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Key {
    /// The z of the farthest corner.
    #[default]
    Farthest,
    /// The mean of the corners' z.
    Mean,
}

/// Options for sorting faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Key by which faces are sorted.
    pub key: Key,
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A face's place in the order, from far to near.
    Sorted {
        /// Its index.
        face: u32,
        /// Depth that it was sorted by.
        z: f64,
    },
    /// Pixels of a row are overwritten with a face's item.
    Paint {
        /// The face.
        face: u32,
        /// Row.
        y: i32,
        /// First column.
        x0: i32,
        /// The column after the last.
        x1: i32,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Sorted { .. } => 3,
            Self::Paint { .. } => 6,
        }
    }
}

/// Returns the picture that a list of steps leads to.
///
/// # Errors
/// [`Memory`](crate::Error::Memory) if the screen's budget does not suffice.
pub fn replay(screen: &Screen, steps: &[Step]) -> Result<Pixels<u32>> {
    let runs = steps.iter().filter_map(|step| match *step {
        Step::Paint { face, y, x0, x1 } => {
            Some((x0..x1).map(move |x| ([x as u32, y as u32], face)))
        }
        _ => None,
    });
    screen.painted(runs.flatten())
}

/// Returns the index of the face that is painted last at each pixel's centre; among faces with equal keys the first one
/// is painted last.
///
/// # Errors
/// [`Memory`](crate::Error::Memory) if the screen's budget does not suffice.
pub fn items(
    faces: &[Face],
    screen: &Screen,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Pixels<u32>> {
    let mut items = screen.plane(NO_ITEM)?;
    let key = |face: &Face| match options.key {
        Key::Farthest => face.depths()[1],
        Key::Mean => face.corners().iter().map(|c| c.z).sum::<f64>() / face.corners().len() as f64,
    };
    let _table = screen.edge_table(faces)?;
    let _order =
        screen.work.charge_for::<(f64, u32, &Face)>("order of polygons", faces.len() as u64)?;
    let mut order: Vec<(f64, u32, &Face)> =
        (0..).zip(faces).map(|(number, face)| (key(face), number, face)).collect();
    order.compact_sort_by(|a, b| b.0.total_cmp(&a.0).then(b.1.cmp(&a.1)));
    order.iter().for_each(|&(z, face, _)| t.step(|| Step::Sorted { face, z }));
    for (_, number, face) in order {
        face.spans(screen, |span| {
            t.step(|| Step::Paint { face: number, y: span.y, x0: span.x0, x1: span.x1 });
            (span.x0..span.x1).for_each(|x| items.set(x as u32, span.y as u32, number));
        });
    }
    Ok(items)
}
