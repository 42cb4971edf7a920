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

/// Coordinates with exponents in this range have products of products that neither overflow nor underflow.
const TAME: std::ops::Range<i32> = -200..200;

/// Runs a walk that knows all operations but xor, which is both differences side by side, and makes
/// polygons of what it finds. Where coordinates are huge or tiny, all is done at a power of two of their size,
/// which changes no digit but of those beside which nobody sees them.
pub(super) fn walk_all<'t, T: Tracer<Step>>(
    inputs: [&Shapes; 2],
    op: BooleanOp,
    t: &'t mut T,
    walk: impl FnMut(&Linked, BooleanOp, &mut Scaled<'t, T>) -> Vec<Vec<DVec2>>,
) -> Result<Shapes> {
    let points = inputs.iter().flat_map(|shapes| shapes.points());
    let largest = points.fold(0.0, |all: f64, p| all.max(p.abs().max_element()));
    let exponent = if largest.is_finite() && largest > 0.0 { libm::ilogb(largest) } else { 0 };
    let shift = if TAME.contains(&exponent) { 0 } else { exponent };
    let mut t = Scaled { to: t, shift };
    if shift == 0 {
        return walk_tame(inputs, op, &mut t, walk);
    }
    let scaled = inputs.map(|shapes| scale(shapes, -shift));
    let found = walk_tame([&scaled[0], &scaled[1]], op, &mut t, walk)?;
    Ok(scale(&found, shift))
}

fn scale(shapes: &Shapes, shift: i32) -> Shapes {
    let mut scaled = shapes.clone();
    scaled.points_mut().iter_mut().for_each(|p| *p = times_power(*p, shift));
    scaled
}

fn times_power(p: DVec2, shift: i32) -> DVec2 {
    DVec2::new(libm::scalbn(p.x, shift), libm::scalbn(p.y, shift))
}

/// A listener that is told the caller's coordinates.
pub(super) struct Scaled<'t, T> {
    to: &'t mut T,
    shift: i32,
}

impl<T: Tracer<Step>> Tracer<Step> for Scaled<'_, T> {
    fn step(&mut self, make: impl FnOnce() -> Step) {
        let shift = self.shift;
        let place = |at| if shift == 0 { at } else { times_power(at, shift) };
        self.to.step(|| match make() {
            Step::Crossing { at, entry } => Step::Crossing { at: place(at), entry },
            Step::Turn { at, to_subject } => Step::Turn { at: place(at), to_subject },
            Step::Ring { points } => Step::Ring { points: points.into_iter().map(place).collect() },
        });
    }
}

fn walk_tame<T: Tracer<Step>>(
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
