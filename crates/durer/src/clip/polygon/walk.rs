//! What the clippers that walk along linked borders share: steps, and xor as two differences.

use super::cyclic::{Linked, link};
use super::locate::group;
use super::outline::simple_rings;
use super::{BooleanOp, Shapes};
use crate::Result;
use crate::math::DVec2;
use crate::trace::Tracer;

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
        /// Its points, the inside on the left.
        points: Vec<DVec2>,
    },
}

/// Rebuilds the result from its steps.
pub fn replay(steps: &[Step]) -> Shapes {
    let rings = steps.iter().filter_map(|step| match step {
        Step::Ring { points } => Some(points.clone()),
        _ => None,
    });
    group(rings.collect())
}

/// Runs a walk that knows all operations but xor, which is both differences side by side, and makes
/// polygons of what it finds.
pub(super) fn walk_all<T: Tracer<Step>>(
    [subject, clip]: [&Shapes; 2],
    op: BooleanOp,
    t: &mut T,
    mut walk: impl FnMut(&Linked, BooleanOp, &mut T) -> Vec<Vec<DVec2>>,
) -> Result<Shapes> {
    let mut once = |subject, clip, op| -> Result<Vec<Vec<DVec2>>> {
        let linked = link(subject, clip, op)?;
        let mut found = walk(&linked, op, t);
        found.extend(linked.whole_rings(op));
        Ok(found)
    };
    let found = if op == BooleanOp::Xor {
        let mut found = once(subject, clip, BooleanOp::Difference)?;
        found.extend(once(clip, subject, BooleanOp::Difference)?);
        found
    } else {
        once(subject, clip, op)?
    };
    let rings = simple_rings(&found);
    for ring in &rings {
        t.step(|| Step::Ring { points: ring.clone() });
    }
    Ok(group(rings))
}
