//! The code that clippers along linked borders share: a tame frame of coordinates, and xor as two differences.

use super::cyclic::{Linked, link, link_crossing};
use super::group::{group, is_flat};
use super::lists::NOT_SIMPLE;
use super::outline::simple_rings;
use super::steps::Step;
use super::{BooleanOp, Shapes, signed_area};
use crate::Result;
use crate::math::DVec2;
use crate::trace::Tracer;

/// Coordinates with exponents in this range have products of products that neither overflow nor underflow.
const TAME: std::ops::Range<i32> = -200..200;

/// Runs a walk for all operations and builds polygons from its rings; xor, which the walk does not know, is both
/// differences together. Huge or tiny coordinates are scaled by a power of two, which changes only digits that are
/// negligible beside the others.
///
/// `crossing` allows rings that cross, by the even-odd rule, where the walk follows the marks of the lists alone.
pub(super) fn walk_all<'t, T: Tracer<Step>>(
    inputs: [&Shapes; 2],
    op: BooleanOp,
    crossing: bool,
    t: &'t mut T,
    walk: impl FnMut(&Linked, BooleanOp, &mut Scaled<'t, T>) -> Vec<Vec<DVec2>>,
) -> Result<Shapes> {
    let points = inputs.iter().flat_map(|shapes| shapes.points());
    let largest = points.fold(0.0, |all: f64, p| all.max(p.abs().max_element()));
    let exponent = if largest.is_finite() && largest > 0.0 { libm::ilogb(largest) } else { 0 };
    let shift = if TAME.contains(&exponent) { 0 } else { exponent };
    let mirrored = inputs[0].rings().next().is_some_and(|ring| signed_area(ring) < 0.0);
    let frame = Frame { shift, mirrored };
    let mut t = Scaled { to: t, frame };
    if !mirrored && shift == 0 {
        return Ok(walk_tame(inputs, op, crossing, &mut t, walk)?.0);
    }
    let framed = inputs.map(|shapes| map(shapes, |p| frame.of(p)));
    let (found, crosses) = walk_tame([&framed[0], &framed[1]], op, crossing, &mut t, walk)?;
    let found = map(&found, |p| frame.back(p));
    // Crossing rings have no inside on one side.
    Ok(if mirrored && !crosses { reversed(&found) } else { found })
}

/// Coordinate frame of the walk: scaled by a power of two, and mirrored if the subject runs
/// clockwise. Walks have the inside on their left, and have to go in the caller's direction.
#[derive(Clone, Copy)]
struct Frame {
    shift: i32,
    mirrored: bool,
}

impl Frame {
    fn of(self, p: DVec2) -> DVec2 {
        let p = if self.mirrored { DVec2::new(p.x, -p.y) } else { p };
        times_power(p, -self.shift)
    }

    fn back(self, p: DVec2) -> DVec2 {
        let p = times_power(p, self.shift);
        // Adding zero turns −0 into 0.
        if self.mirrored { DVec2::new(p.x, -p.y + 0.0) } else { p }
    }
}

fn map(shapes: &Shapes, f: impl Fn(DVec2) -> DVec2) -> Shapes {
    let mut mapped = shapes.clone();
    mapped.points_mut().iter_mut().for_each(|p| *p = f(*p));
    mapped
}

fn times_power(p: DVec2, shift: i32) -> DVec2 {
    if shift == 0 { p } else { DVec2::new(libm::scalbn(p.x, shift), libm::scalbn(p.y, shift)) }
}

/// Returns the same shapes, each ring in the other direction.
fn reversed(shapes: &Shapes) -> Shapes {
    let mut out = Shapes::new();
    for polygon in shapes.polygons() {
        for ring in polygon.rings() {
            out.push_ring(ring.iter().rev().copied());
        }
        out.end_polygon();
    }
    out
}

/// A tracer that receives the caller's coordinates.
pub(super) struct Scaled<'t, T> {
    to: &'t mut T,
    frame: Frame,
}

impl<T: Tracer<Step>> Tracer<Step> for Scaled<'_, T> {
    fn step(&mut self, make: impl FnOnce() -> Step) {
        let frame = self.frame;
        let place = |at| frame.back(at);
        self.to.step(|| match make() {
            Step::Listed { list, at, mark } => Step::Listed { list, at: place(at), mark },
            Step::Start { at } => Step::Start { at: place(at) },
            Step::Passed { list, at } => Step::Passed { list, at: place(at) },
            Step::Crossing { at, entry } => Step::Crossing { at: place(at), entry },
            Step::Turn { at, to_subject } => Step::Turn { at: place(at), to_subject },
            Step::CrossingRings => Step::CrossingRings,
            Step::Ring { points } => Step::Ring { points: points.into_iter().map(place).collect() },
        });
    }
}

/// Clips polygons whose rings may cross; returns the result, and whether rings of an operand cross.
fn walk_tame<T: Tracer<Step>>(
    [subject, clip]: [&Shapes; 2],
    op: BooleanOp,
    crossing: bool,
    t: &mut T,
    mut walk: impl FnMut(&Linked, BooleanOp, &mut T) -> Vec<Vec<DVec2>>,
) -> Result<(Shapes, bool)> {
    // Xor is both differences; linking alone reports no steps.
    let (first, second) = match op {
        BooleanOp::Xor => (BooleanOp::Difference, true),
        _ => (op, false),
    };
    let simple = link(subject, clip, first);
    let crosses = crossing && simple.as_ref().is_err_and(|e| *e == NOT_SIMPLE);
    if crosses {
        t.step(|| Step::CrossingRings);
    }
    let mut once = |linked: Result<Linked>, op| -> Result<Vec<Vec<DVec2>>> {
        let linked = linked?;
        linked.trace(t);
        let mut found = walk(&linked, op, t);
        found.extend(linked.whole_rings(op));
        Ok(found)
    };
    let linked = |a, b| if crosses { link_crossing(a, b) } else { link(a, b, first) };
    let mut found = once(if crosses { linked(subject, clip) } else { simple }, first)?;
    if second {
        found.extend(once(linked(clip, subject), first)?);
    }
    if crosses {
        found.retain(|ring| !is_flat(ring));
    } else {
        found = simple_rings(&found);
    }
    for ring in &found {
        t.step(|| Step::Ring { points: ring.clone() });
    }
    Ok((if crosses { Shapes::from_rings(found) } else { group(found) }, crosses))
}
