//! Binary space partition: a tree of planes that orders polygons for any eye.
//!
//! H. Fuchs, Z. M. Kedem, B. F. Naylor, *On visible surface generation by a priori tree structures*, SIGGRAPH 1980.
//! List priority. One polygon's plane divides the others, splitting those that cross it, and so on in both halves. The
//! tree does not depend on the eye: for each eye a walk through it, the far half of each node first, gives an order
//! from back to front. Cost: O(n²) pieces at worst, O(n log n) as a rule; a walk is linear in the pieces.
//!
//! A piece keeps its face and the planes that cut it, and its pixels are those of the face on its side of them; so the
//! pieces divide a face's pixels among them, and the picture is the z-buffer's.

mod tree;

pub use super::pieces::PlaneSide;
pub use tree::Tree;

use super::{Face, Screen};
use crate::Result;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec3;
use crate::target::{NO_ITEM, Pixels};
use crate::trace::{PseudocodeLine, Tracer};
use crate::visibility::back_face::Eye;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "bsp-tree",
    title: "Binary space partition tree",
    authors: "H. Fuchs, Z. M. Kedem, B. F. Naylor",
    year: 1980,
    source: "On visible surface generation by a priori tree structures, SIGGRAPH",
    class: Class::ListPriority,
    occluder: Occluder::Area,
    coherence: &[Coherence::Face, Coherence::Frame],
    cost: "O(n log n) pieces as a rule, O(n²) at worst, for n polygons; a walk per eye linear in the pieces",
    limits: "plane polygons; at most as many pieces as the options allow",
    pseudocode: &[
        "build(list):",
        "    try some polygons as root: how many others does each one's plane split?",
        "    the root is the one that splits the fewest",
        "    for each other polygon of the list:",
        "        is it in front of the root's plane, behind it, or on it?",
        "        if on both sides: split it",
        "    front ← build(those in front), back ← build(those behind)",
        "paint(tree):",
        "    on which side of the root's plane is the eye?",
        "    paint the tree of the other side",
        "    paint the root over the picture so far",
        "    paint the tree of the eye's side",
    ],
};

/// Options for building the tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Number of polygons of a list that are tried as its root; the one that splits the fewest
    /// others is taken: the first alone gives large trees, five or six give nearly the smallest. At
    /// least 1.
    pub candidates: usize,
    /// The most pieces that the tree may have.
    pub max_pieces: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { candidates: 5, max_pieces: 1 << 20 }
    }
}

/// Step of the algorithm. Pieces have numbers: first the faces, then the parts that splitting
/// makes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// A piece was tried as the root of a list.
    Tried {
        /// The piece.
        piece: u32,
        /// Number of other polygons that its plane would split.
        splits: usize,
    },
    /// A piece is a node of the tree.
    Node {
        /// The node's number.
        node: u32,
        /// The piece whose plane divides.
        piece: u32,
        /// The node above and the side of it; none for the tree's root.
        below: Option<(u32, PlaneSide)>,
    },
    /// A piece was compared with the node's plane.
    Sorted {
        /// The piece.
        piece: u32,
        /// Side of the node's plane that it is on.
        side: PlaneSide,
    },
    /// A piece was split.
    Split {
        /// The piece.
        piece: u32,
        /// Parts in front and behind.
        into: [u32; 2],
    },
    /// The walk visits a node: the eye is on the given side of its plane, so the other side is painted first.
    Visit {
        /// The node.
        node: u32,
        /// The eye's side.
        eye: PlaneSide,
    },
    /// A piece is painted over the pixels there.
    Paint {
        /// The piece.
        piece: u32,
        /// Its face.
        face: u32,
    },
    /// A pixel of the piece that is painted.
    Pixel {
        /// Column and row.
        pixel: [u32; 2],
        /// The face.
        face: u32,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Tried { .. } => 2,
            Self::Node { .. } => 3,
            Self::Sorted { .. } => 5,
            Self::Split { .. } => 6,
            Self::Visit { .. } => 9,
            Self::Paint { .. } | Self::Pixel { .. } => 11,
        }
    }
}

/// Returns the picture that a list of steps leads to.
///
/// # Errors
/// [`Memory`](crate::Error::Memory) if the screen's budget does not suffice.
pub fn replay(screen: &Screen, steps: &[Step]) -> Result<Pixels<u32>> {
    screen.painted(steps.iter().filter_map(|step| match *step {
        Step::Pixel { pixel, face } => Some((pixel, face)),
        _ => None,
    }))
}

/// Returns the index of the nearest face at each pixel's centre, of equally near ones the first.
///
/// # Errors
/// [`Limit`](crate::Error::Limit) for too many pieces, [`Memory`](crate::Error::Memory) if the screen's budget does
/// not suffice.
pub fn items(
    faces: &[Face],
    screen: &Screen,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Pixels<u32>> {
    let tree = Tree::new(faces, options, &screen.work, t)?;
    let mut items = screen.plane(NO_ITEM)?;
    let _table = screen.edge_table(faces)?;
    for piece in tree.back_to_front(Eye::Along(DVec3::Z), t) {
        let number = tree.face(piece);
        let Some(face) = faces.get(number as usize) else { continue };
        t.step(|| Step::Paint { piece, face: number });
        face.pixels(screen, |pixel @ [x, y], point| {
            if tree.holds(piece, point) {
                t.step(|| Step::Pixel { pixel, face: number });
                items.set(x, y, number);
            }
        });
    }
    Ok(items)
}
