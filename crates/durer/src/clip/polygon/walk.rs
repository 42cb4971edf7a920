//! What the clippers that walk along linked borders share: steps, and xor as two differences.

use super::locate::group;
use super::{BooleanOp, Shapes};
use crate::math::DVec2;

/// There is nothing to choose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {}

/// What happens, step by step.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// Greiner and Hormann: the borders cross here; the subject enters or leaves the clip.
    Crossing {
        /// Where.
        at: DVec2,
        /// Whether the subject enters.
        entry: bool,
    },
    /// Weiler and Atherton: the walk turns from one border to the other.
    Turn {
        /// Where.
        at: DVec2,
        /// Whether it goes on along the subject.
        to_subject: bool,
    },
    /// A ring of the result is complete.
    Ring {
        /// Its points, in the order of the walk.
        points: Vec<DVec2>,
        /// Whether it is of the second half of an xor: clip without subject.
        swapped: bool,
    },
}

/// Rebuilds the result from its steps.
pub fn replay(steps: &[Step]) -> Shapes {
    let half = |second: bool| {
        let rings = steps.iter().filter_map(move |step| match step {
            Step::Ring { points, swapped } if *swapped == second => Some(points.clone()),
            _ => None,
        });
        group(rings.collect())
    };
    let mut shapes = half(false);
    shapes.append(&half(true));
    shapes
}

/// Runs a walk that knows all operations but xor, which is both differences side by side; the flag
/// tells the walk that subject and clip are exchanged.
pub(super) fn with_xor(
    [subject, clip]: [&Shapes; 2],
    op: BooleanOp,
    mut walk: impl FnMut([&Shapes; 2], BooleanOp, bool) -> Shapes,
) -> Shapes {
    if op != BooleanOp::Xor {
        return walk([subject, clip], op, false);
    }
    let mut shapes = walk([subject, clip], BooleanOp::Difference, false);
    shapes.append(&walk([clip, subject], BooleanOp::Difference, true));
    shapes
}
