//! Roberts' algorithm: the hidden lines of convex bodies, body by body.
//!
//! L. G. Roberts, *Machine perception of three-dimensional solids*, MIT Lincoln Laboratory TR 315, 1963; the quick test
//! and the junction lines as in D. F. Rogers, *Procedural Elements for Computer Graphics*, 1985, section 4-3. A body is
//! a matrix whose columns are the planes of its faces, positive inside. A plane whose value at the eye is positive
//! belongs to a face that looks away; a line between two of them is hidden by its own body. Of any other line, the
//! points P(t) that a body hides are those from which a ray to the eye, P(t) + α E in homogeneous coordinates, is
//! inside all planes for some α ≥ 0: linear inequalities in t and α, whose smallest and largest t are the ends of the
//! hidden part. Class: object space. Cost: O(l b m²) for l lines, b bodies and m planes of a body; memory O(lines +
//! visible parts).
//!
//! Deviations: the linear program is solved by eliminating α (Fourier and Motzkin), pair by pair of planes, as the
//! textbooks solve it by hand, but without testing solutions. What is hidden is open: a line in the surface of another
//! body, or along its outline, is seen. The paper's sorting of bodies by depth, which saves comparisons, is left out.

mod body;
mod program;
mod step;

pub use body::{BodyEdge, ConvexBody};
pub use step::{Bound, Step, Values, replay};

use crate::Result;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::{DVec3, Plane};
use crate::trace::Tracer;
use crate::visibility::back_face::Eye;
use crate::work::{Charge, Work};
use body::FLATNESS;
pub(super) use body::numbered;
use program::{EyePoint, Program};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "roberts",
    title: "Roberts' algorithm",
    authors: "L. G. Roberts",
    year: 1963,
    source: "Machine perception of three-dimensional solids, MIT Lincoln Laboratory TR 315",
    class: Class::ObjectSpace,
    occluder: Occluder::Area,
    coherence: &[Coherence::Object, Coherence::Edge],
    cost: "O(l b m²) time for l lines, b bodies, m planes of a body; O(lines and visible parts) memory",
    limits: "closed convex bodies",
    pseudocode: &[
        "for each body:",
        "    V ← the planes of its faces, a point inside on the positive side of each",
        "    w ← E · V; a face with w < 0 is seen by the eye E",
        "    a line between two faces that look away is hidden by its own body",
        "add the junction lines, where faces that are seen pierce faces of other bodies",
        "for each line from P to Q that is left:",
        "    for each other body: p ← P · V, p + q ← Q · V",
        "        p ≤ 0, p + q ≤ 0 and w ≤ 0 for one plane: not hidden, next body",
        "        h(t, α) = p + t q + α w > 0 for all planes, 0 ≤ t ≤ 1, α ≥ 0",
        "        for each pair of a plane with w > 0, or α = 0, and one with w ≤ 0:",
        "            solve for t; it bounds the hidden part from below or above",
        "        hidden from the largest lower to the smallest upper bound",
        "    draw the parts that no body hides",
    ],
};

/// Options for the lines to find.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// True if lines are added where faces of two bodies pierce each other.
    pub junctions: bool,
}

impl Default for Options {
    /// Returns the default: with junction lines.
    fn default() -> Self {
        Self { junctions: true }
    }
}

/// A line with its visible parts.
#[derive(Debug, Clone, PartialEq)]
pub struct VisibleLine {
    /// The body that has this edge, twice, or the two bodies that intersect along it.
    pub bodies: [usize; 2],
    /// Its ends, t = 0 and t = 1.
    pub ends: [DVec3; 2],
    /// Parameters of the parts that are seen, in their order.
    pub visible: Vec<[f64; 2]>,
}

impl VisibleLine {
    /// Returns the ends of the visible parts.
    pub fn parts(&self) -> impl Iterator<Item = [DVec3; 2]> + '_ {
        let [p, q] = self.ends;
        self.visible.iter().map(move |part| part.map(|t| if t < 1.0 { p + (q - p) * t } else { q }))
    }

    /// Takes a hidden part out.
    pub(crate) fn hide(&mut self, [from, to]: [f64; 2]) {
        let left = |[a, b]: &[f64; 2]| [[*a, b.min(from)], [a.max(to), *b]];
        let parts = self.visible.iter().flat_map(left).filter(|[a, b]| a < b);
        self.visible = parts.collect();
    }
}

/// Returns the lines that their own bodies do not hide, with the parts of them that no other body hides: edges body by
/// body, then junction lines. Edges between faces of one plane are no lines.
///
/// ```
/// use durer::math::DVec3;
/// use durer::trace::NoTrace;
/// use durer::visibility::back_face::Eye;
/// use durer::visibility::line::roberts::{ConvexBody, Options, draw};
/// use durer::work::Work;
///
/// let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let face = |leave: usize| (0..4).filter(|k| *k != leave).map(|k| corner[k]).collect();
/// let tetrahedron = ConvexBody::new(&[face(0), face(1), face(2), face(3)])?;
/// let eye = Eye::At(DVec3::splat(9.0));
/// let lines = draw(&[tetrahedron], eye, &Options::default(), &Work::default(), &mut NoTrace)?;
/// // The three edges that meet at the origin are behind the face of the three others.
/// assert_eq!(lines.len(), 3);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::Memory`](crate::Error::Memory) if the budget of the work is too small, and its reason if the work is stopped.
pub fn draw(
    bodies: &[ConvexBody],
    eye: Eye,
    options: &Options,
    work: &Work,
    t: &mut impl Tracer<Step>,
) -> Result<Vec<VisibleLine>> {
    let eye = match eye {
        Eye::At(at) => EyePoint { at, w: 1.0 },
        Eye::Along(direction) => EyePoint { at: -direction.normalize_or_zero(), w: 0.0 },
    };
    let small = extent(bodies) * FLATNESS;
    let mut lines = Lines { all: Vec::new(), charge: work.charge("lines of bodies", 0)? };
    for (body, own) in bodies.iter().enumerate() {
        add_edges(&mut lines, (body, own), &eye, small, t)?;
    }
    if options.junctions {
        for (b, second) in bodies.iter().enumerate() {
            for (a, first) in bodies[..b].iter().enumerate() {
                add_junctions(&mut lines, ([a, b], [first, second]), &eye, small)?;
            }
        }
    }
    work.begin("lines", lines.all.len() as u64);
    for (line, own) in lines.all.iter_mut().enumerate() {
        work.check()?;
        work.advance(1);
        t.step(|| Step::Line { line, bodies: own.bodies, ends: own.ends });
        for (body, other) in bodies.iter().enumerate() {
            if own.visible.is_empty() {
                break;
            }
            if own.bodies.contains(&body) {
                continue;
            }
            if let Some(part) = compare((line, own), (body, other), &eye, small, t) {
                t.step(|| Step::Hidden { line, body, part });
                own.hide(part);
            }
        }
        t.step(|| Step::Visible { line, parts: own.visible.clone() });
    }
    Ok(lines.all)
}

/// Lines that are charged to the budget.
struct Lines {
    all: Vec<VisibleLine>,
    charge: Charge,
}

impl Lines {
    /// Adds a line, of which nothing is hidden yet.
    fn add(&mut self, bodies: [usize; 2], ends: [DVec3; 2]) -> Result<()> {
        self.charge.grow((size_of::<VisibleLine>() + size_of::<[f64; 2]>()) as u64)?;
        self.all.push(VisibleLine { bodies, ends, visible: vec![[0.0, 1.0]] });
        Ok(())
    }
}

/// Returns the largest distance of a corner from the middle of all.
fn extent(bodies: &[ConvexBody]) -> f64 {
    let corners = || bodies.iter().flat_map(ConvexBody::corners);
    let middle = corners().sum::<DVec3>() / corners().count().max(1) as f64;
    corners().map(|corner| corner.distance(middle)).fold(0.0, f64::max)
}

/// Adds the edges of a body with at least one visible face.
fn add_edges(
    lines: &mut Lines,
    (body, own): (usize, &ConvexBody),
    eye: &EyePoint,
    small: f64,
    t: &mut impl Tracer<Step>,
) -> Result<()> {
    let values: Vec<f64> = own.planes().iter().map(|plane| eye.value(plane)).collect();
    t.step(|| Step::Body { body, eye: values.clone() });
    let is_seen = |plane: usize| values[plane] < -small;
    for edge in own.edges() {
        let ends = own.ends(edge);
        if edge.planes.into_iter().any(is_seen) {
            lines.add([body; 2], ends)?;
        } else {
            t.step(|| Step::SelfHidden { body, ends });
        }
    }
    Ok(())
}

/// Adds the lines in which faces of two bodies that are both seen pierce each other: between the points where the
/// common line of two planes enters and leaves both bodies.
fn add_junctions(
    lines: &mut Lines,
    (numbers, bodies): ([usize; 2], [&ConvexBody; 2]),
    eye: &EyePoint,
    small: f64,
) -> Result<()> {
    let seen = |body: usize| bodies[body].planes().iter().filter(|p| eye.value(p) < -small);
    for first in seen(0) {
        for second in seen(1) {
            if let Some(ends) = common_part(first, second, bodies, small) {
                lines.add(numbers, ends)?;
            }
        }
    }
    Ok(())
}

/// Returns the part of two planes' common line that is in both bodies; `None` where there is none, or only along a
/// face.
fn common_part(a: &Plane, b: &Plane, bodies: [&ConvexBody; 2], small: f64) -> Option<[DVec3; 2]> {
    let along = a.normal.cross(b.normal);
    let square = along.length_squared();
    if square < FLATNESS {
        return None;
    }
    let origin =
        (b.normal.cross(along) * -a.distance + along.cross(a.normal) * -b.distance) / square;
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    for plane in bodies.iter().flat_map(|body| body.planes()).filter(|p| *p != a && *p != b) {
        let (at, rise) = (plane.evaluate(origin), plane.normal.dot(along));
        if rise.abs() < FLATNESS {
            if at <= small {
                return None;
            }
        } else if rise > 0.0 {
            from = from.max(-at / rise);
        } else {
            to = to.min(-at / rise);
        }
    }
    let is_long = to - from > small && (to - from).is_finite();
    is_long.then(|| [origin + along * from, origin + along * to])
}

/// Returns the part of a line that a body hides.
fn compare(
    (line, own): (usize, &VisibleLine),
    (body, other): (usize, &ConvexBody),
    eye: &EyePoint,
    small: f64,
    t: &mut impl Tracer<Step>,
) -> Option<[f64; 2]> {
    let program = Program::new(other, own.ends, eye, small);
    if let Some(plane) = program.apart() {
        t.step(|| Step::Apart { line, body, plane, values: program.values().to_vec() });
        return None;
    }
    t.step(|| Step::Compare { line, body, values: program.values().to_vec() });
    program.hidden(|bound| t.step(|| Step::Bound { line, body, bound }))
}
