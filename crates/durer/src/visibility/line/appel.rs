//! Appel's algorithm: quantitative invisibility carried along the edges of solids.
//!
//! A. Appel, *The notion of quantitative invisibility and the machine rendering of solids*, Proceedings of the ACM
//! National Conference, 1967. The quantitative invisibility of a point is the number of faces that hide it. It is
//! counted at one corner of each connected part, by a ray to the eye; from there it is carried along the edges. It
//! changes only where an edge crosses behind a contour edge, one between a face that turns its front to the eye and one
//! that turns its back, where it pierces a face, and at corners, where faces of the corner itself may hide one edge and
//! not another. Class: object space. Cost: O(e c) time for e edges and c contour edges, and O(f) for each ray; memory
//! O(edges and crossings).
//!
//! [`super::hidden_line`] finds the same numbers line by line, with faces from a grid, and is used for production:
//! there a wrong crossing spoils one line and not all that follow.
//!
//! Deviations: edges between two back faces are carried too, with the faces that hide them; crossings are found by
//! comparing each edge with each contour edge.

use super::face_net::{Carrier, FaceNet};
use super::hidden_line::HiddenSpan;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec3;
use crate::sorting::CompactSort;
use crate::trace::{PseudocodeLine, Tracer};
use crate::work::{Charge, Work};
use crate::{Error, Result};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "appel",
    title: "Appel's quantitative invisibility, carried along edges",
    authors: "A. Appel",
    year: 1967,
    source: "The notion of quantitative invisibility and the machine rendering of solids, ACM National Conference",
    class: Class::ObjectSpace,
    occluder: Occluder::Line,
    coherence: &[Coherence::Edge, Coherence::Object],
    cost: "O(e c) time for e edges and c contour edges, a ray for each connected part; O(edges and crossings) memory",
    limits: "closed bodies that do not touch each other; piercing bodies need a test of edges and faces",
    pseudocode: &[
        "find the contour edges: one face turned to the eye, one away from it",
        "for each connected part of the edges, with a corner V:",
        "    Q(V) ← number of faces that hide V, by a ray to the eye, without those at V",
        "    for each edge from a corner V with known Q(V) to a corner W:",
        "        Q ← Q(V) + number of faces at V that hide the beginning of the edge",
        "        for each place, by t, where it crosses behind a contour edge or pierces a face:",
        "            output the part before it with its invisibility Q",
        "            Q ← Q + 1 where the edge goes behind a face, Q − 1 where it comes out",
        "        output the last part with its invisibility Q",
        "        Q(W) ← Q − number of faces at W that hide the end of the edge",
    ],
};

/// Options for the changes to be found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// True if edges may pierce faces; false leaves out the comparison of all edges with all faces.
    pub piercing: bool,
}

impl Default for Options {
    /// Returns the default: bodies may pierce each other.
    fn default() -> Self {
        Self { piercing: true }
    }
}

/// An edge with its invisibility, part by part.
#[derive(Debug, Clone, PartialEq)]
pub struct AppelEdge {
    /// Number of the edge in the net.
    pub edge: usize,
    /// Its ends in space, t = 0 and t = 1, in the direction in which it was carried along.
    pub ends: [DVec3; 2],
    /// Its parts in their order.
    pub spans: Vec<HiddenSpan>,
}

impl AppelEdge {
    /// Returns the ends of the visible parts.
    pub fn parts(&self) -> impl Iterator<Item = [DVec3; 2]> + '_ {
        let [p, q] = self.ends;
        let seen = self.spans.iter().filter(|span| span.invisibility == 0);
        seen.map(move |span| [span.from, span.to].map(|t| p.lerp(q, t)))
    }

    /// Ends the last part at t, and begins another one with an invisibility.
    fn change(&mut self, t: f64, invisibility: u32) {
        if let Some(last) = self.spans.last_mut() {
            last.to = t;
        }
        self.spans.push(HiddenSpan { from: t, to: 1.0, invisibility });
    }
}

/// Cause of a change of the invisibility.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cause {
    /// The edge crosses behind a contour edge with this number.
    Contour(usize),
    /// The edge goes through the face with this number.
    Face(usize),
}

/// Step of the algorithm. Corners, edges and faces have their numbers in the net.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// The contour edges are known.
    Contours {
        /// Their numbers.
        edges: Vec<usize>,
    },
    /// The invisibility of a corner is counted by a ray.
    Ray {
        /// The corner.
        corner: usize,
        /// The faces that hide it.
        faces: Vec<usize>,
    },
    /// An edge begins at a corner whose invisibility is known.
    Edge {
        /// The edge.
        edge: usize,
        /// Its corners, the known one first.
        corners: [usize; 2],
        /// The faces at the corner that hide the beginning of the edge.
        faces: Vec<usize>,
        /// Invisibility of the corner, and of the beginning of the edge.
        invisibility: [u32; 2],
    },
    /// The invisibility changes along the edge.
    Change {
        /// The edge.
        edge: usize,
        /// Parameter along the edge, in space.
        t: f64,
        /// Cause of the change.
        cause: Cause,
        /// Invisibility before and after.
        invisibility: [u32; 2],
    },
    /// The end of the edge is reached.
    Corner {
        /// The edge.
        edge: usize,
        /// The corner at its end.
        corner: usize,
        /// The faces at the corner that hide the end of the edge.
        faces: Vec<usize>,
        /// Invisibility of the end of the edge, and of the corner.
        invisibility: [u32; 2],
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Contours { .. } => 1,
            Self::Ray { .. } => 3,
            Self::Edge { .. } => 5,
            Self::Change { .. } => 8,
            Self::Corner { .. } => 10,
        }
    }
}

/// Returns the lines resulting from a list of steps.
pub fn replay(net: &FaceNet, steps: &[Step]) -> Vec<AppelEdge> {
    let mut lines: Vec<AppelEdge> = Vec::new();
    for step in steps {
        match step {
            Step::Edge { edge, corners, invisibility: [_, first], .. } => {
                lines.push(line(net, *edge, *corners, *first));
            }
            Step::Change { t, invisibility: [_, after], .. } => {
                lines.iter_mut().last().into_iter().for_each(|line| line.change(*t, *after));
            }
            _ => {}
        }
    }
    lines.compact_sort_by_key(|line| line.edge);
    lines
}

/// Returns an edge of one part.
fn line(net: &FaceNet, edge: usize, corners: [usize; 2], invisibility: u32) -> AppelEdge {
    let ends = corners.map(|corner| net.corners()[corner]);
    AppelEdge { edge, ends, spans: vec![HiddenSpan { from: 0.0, to: 1.0, invisibility }] }
}

/// Returns the edges of closed bodies, in the order of the net, with the number of faces that hide each part of them.
/// Edges between faces of one plane are left out.
///
/// ```
/// use durer::math::DVec3;
/// use durer::trace::NoTrace;
/// use durer::visibility::back_face::Eye;
/// use durer::visibility::line::appel::{Options, draw};
/// use durer::visibility::line::face_net::FaceNet;
/// use durer::work::Work;
///
/// let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let face = |leave: usize| (0..4).filter(|k| *k != leave).map(|k| corner[k]).collect();
/// let faces = [face(0), face(1), face(2), face(3)];
/// let net = FaceNet::new(&faces, Eye::At(DVec3::splat(9.0)))?;
/// let lines = draw(&net, &Options::default(), &Work::default(), &mut NoTrace)?;
/// // The three edges that meet at the origin are behind the face of the three others.
/// let hidden = lines.iter().filter(|line| line.spans[0].invisibility == 1);
/// assert_eq!((lines.len(), hidden.count()), (6, 3));
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::Parameter`] for faces that do not bound closed bodies, and for bodies that touch each other so that the
/// numbers contradict each other; [`Error::Memory`] if the budget of the work is too small, and its reason if the work
/// is stopped.
pub fn draw(
    net: &FaceNet,
    options: &Options,
    work: &Work,
    t: &mut impl Tracer<Step>,
) -> Result<Vec<AppelEdge>> {
    if !net.is_closed() {
        let value = format!("{} whose edges do not all have two", net.faces().len());
        return Err(Error::parameter("faces", value, "those of closed bodies"));
    }
    let charge = work.charge_for::<usize>("invisibility of edges", net.edges().len() as u64)?;
    let contours: Vec<usize> = (0..net.edges().len()).filter(|e| net.is_contour(*e)).collect();
    t.step(|| Step::Contours { edges: contours.clone() });
    let mut run = Run { net, contours, options, lines: Vec::new(), charge, t };
    net.carry(&mut run, work)?;
    let mut lines = run.lines;
    lines.compact_sort_by_key(|line| line.edge);
    Ok(lines)
}

/// The lines so far.
struct Run<'a, T> {
    net: &'a FaceNet,
    contours: Vec<usize>,
    options: &'a Options,
    lines: Vec<AppelEdge>,
    /// Charge of the contour edges and the lines.
    charge: Charge,
    t: &'a mut T,
}

impl<T: Tracer<Step>> Carrier for Run<'_, T> {
    type State = u32;

    fn find(&mut self, corner: usize) -> u32 {
        let faces = self.net.faces_before(corner);
        let count = faces.len() as u32;
        self.t.step(|| Step::Ray { corner, faces });
        count
    }

    fn along(&mut self, edge: usize, corners: [usize; 2], &known: &u32) -> Result<u32> {
        let faces = self.net.faces_over(corners);
        let mut count = known + faces.len() as u32;
        self.t.step(|| Step::Edge { edge, corners, faces, invisibility: [known, count] });
        let mut own = line(self.net, edge, corners, count);
        for (on_page, cause, is_behind) in self.changes(edge, corners) {
            let before = count;
            count = if is_behind { count + 1 } else { count.saturating_sub(1) };
            let t = self.net.in_space(corners, on_page);
            own.change(t, count);
            self.t.step(|| Step::Change { edge, t, cause, invisibility: [before, count] });
        }
        let spans = own.spans.len() * size_of::<HiddenSpan>();
        self.charge.grow((size_of::<AppelEdge>() + spans) as u64)?;
        self.lines.push(own);
        let [from, corner] = corners;
        let faces = self.net.faces_over([corner, from]);
        let reached = count.saturating_sub(faces.len() as u32);
        self.t.step(|| Step::Corner { edge, corner, faces, invisibility: [count, reached] });
        Ok(reached)
    }
}

impl<T> Run<'_, T> {
    /// Returns the places where the invisibility of an edge changes, in their order along it: the parameter on the
    /// page, the cause, and whether the edge goes behind a face there.
    fn changes(&self, edge: usize, corners: [usize; 2]) -> Vec<(f64, Cause, bool)> {
        let (net, mut found) = (self.net, Vec::new());
        let own = &net.edges()[edge].faces;
        for &contour in &self.contours {
            let faces = &net.edges()[contour].faces;
            // Edges of one face do not cross.
            if faces.iter().any(|face| own.contains(face)) {
                continue;
            }
            let crossing = net.crossing(corners, contour);
            let Some(crossing) = crossing.filter(|crossing| crossing.nearer) else { continue };
            let front = faces.iter().find(|face| net.faces()[**face].front);
            let is_behind =
                front.is_some_and(|face| net.is_left_of(*face, contour) == crossing.leftward);
            found.push((crossing.t, Cause::Contour(contour), is_behind));
        }
        let faces = (0..net.faces().len()).filter(|_| self.options.piercing);
        for face in faces.filter(|face| net.is_hider(*face)) {
            if let Some(pierce) = net.pierce(corners, face) {
                found.push((pierce.t, Cause::Face(face), pierce.goes_behind));
            }
        }
        found.compact_sort_by(|a, b| a.0.total_cmp(&b.0));
        found
    }
}
