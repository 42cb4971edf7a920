//! Vatti's method: a sweep line with a list of active edges that counts winding numbers.
//!
//! B. R. Vatti, *A generic solution to polygon clipping*, Communications of the ACM 35(7), 1992.
//! He sweeps upwards and finds crossings between scan beams; we sweep from left to right over edges
//! that are noded and snap-rounded already, so that the list never changes order between two nodes
//! and every operation, fill rule and degenerate input is decided exactly.

use super::overlay::{self, Winder};
use super::{BooleanOp, Shapes, Vertex};
use crate::Result;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::trace::Tracer;

pub use super::overlay::{Options, Output, Step, replay};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "vatti",
    title: "Vatti",
    authors: "B. R. Vatti",
    year: 1992,
    source: "A generic solution to polygon clipping, Communications of the ACM 35(7)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge, Coherence::ScanLine],
    cost: "O((n + k) a) time for n edges, k crossings and a edges active at once; O(n + k) memory",
    limits: "as overlay: at most 2^41 grid cells across, 2^29 points",
    pseudocode: &[
        "choose a grid; move all points to its cells",
        "find where edges cross; divide them at the cells that they pass",
        "sort all nodes",
        "for each node, from left to right and from below to above:",
        "    edges that end here leave the active list, edges that begin here come in",
        "    count the windings of subject and clip from below to above",
        "    an edge is kept if the result is on one of its sides only",
        "from each kept edge walk to the next one, the inside on the left:",
        "    back at the start, the ring is complete",
        "give each hole to the ring around it",
    ],
};

/// Computes a Boolean operation on any two sets of polygons, self-crossing too, by any fill rules.
///
/// The result's polygons nest: each outer ring comes with its holes, and islands in a hole are separate polygons, whose
/// place [`Output::tree`] gives. The result equals that of [`overlay::overlay()`] bit for bit.
///
/// ```
/// use durer::clip::polygon::{BooleanOp, Shapes, vatti::vatti};
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// let square = |x: f64| [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(u, v)| DVec2::new(x + u, x + v));
/// let (a, b) = (Shapes::from_rings([square(0.0)]), Shapes::from_rings([square(1.0)]));
/// let xor = vatti(&a, &b, BooleanOp::Xor, &Default::default(), &mut NoTrace)?;
/// assert_eq!(xor.shapes.area(), 6.0);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// As [`overlay::overlay()`].
pub fn vatti<P: Vertex>(
    subject: &Shapes<P>,
    clip: &Shapes<P>,
    op: BooleanOp,
    options: &Options,
    t: &mut impl Tracer<Step<P>>,
) -> Result<Output<P>> {
    overlay::solve(subject, clip, op, options, Winder::Sweep, t)
}
