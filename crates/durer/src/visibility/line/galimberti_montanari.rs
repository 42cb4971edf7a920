//! Galimberti and Montanari's algorithm: the set of faces that hide a point, carried along edges.
//!
//! R. Galimberti, U. Montanari, *An algorithm for hidden line elimination*, Communications of the ACM 12(4), 1969. The
//! nature of a point is the set of faces that hide it. It is found by comparing one corner of each connected part with
//! all faces; from there it is carried along the edges. A face enters or leaves the nature where an edge crosses behind
//! one of the face's edges, or pierces the face; a part of an edge is drawn if its nature is empty. Class: object
//! space. Cost: O(e f k) time for e edges and f faces of k edges; memory O(edges and changes).
//!
//! [`super::appel`] counts faces, for which it needs closed bodies; here faces are identified, so any plane polygons
//! will do, and the result names the faces that hide a part.
//!
//! Deviations: the paper's faces bound bodies, and back faces are removed first; here they are removed only if all
//! bodies are closed. Lines along which faces intersect are not added.

use super::face_net::{Carrier, FaceNet};
use crate::Result;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec3;
use crate::sorting::CompactSort;
use crate::trace::{PseudocodeLine, Tracer};
use crate::work::{Charge, Work};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "galimberti-montanari",
    title: "Galimberti and Montanari's hidden lines",
    authors: "R. Galimberti, U. Montanari",
    year: 1969,
    source: "An algorithm for hidden line elimination, Communications of the ACM 12(4)",
    class: Class::ObjectSpace,
    occluder: Occluder::Area,
    coherence: &[Coherence::Edge],
    cost: "O(e f k) time for e edges and f faces of k edges; O(edges and changes) memory",
    limits: "plane polygons; faces that touch others without common corners depend on rounding",
    pseudocode: &[
        "leave out the faces of closed bodies that turn their backs to the eye: they hide nothing more",
        "for each connected part of the edges, with a corner V:",
        "    N(V) ← the faces that hide V, of all, without those at V",
        "    for each edge from a corner V with known N(V) to a corner W:",
        "        N ← N(V) and the faces at V that hide the beginning of the edge",
        "        for each place, by t, where it crosses behind an edge of a face F or pierces F:",
        "            output the part before it with its nature N",
        "            F enters or leaves N",
        "        output the last part with its nature N",
        "        N(W) ← N without the faces at W that hide the end of the edge",
        "draw the parts whose nature is empty",
    ],
};

/// Options for the changes to look for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// True if edges may pierce faces; false leaves that comparison out.
    pub piercing: bool,
}

impl Default for Options {
    /// Returns the default: faces may be pierced.
    fn default() -> Self {
        Self { piercing: true }
    }
}

/// A part of an edge that the same faces hide.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgePart {
    /// Start, 0 … 1 along the edge in space.
    pub from: f64,
    /// End along the edge.
    pub to: f64,
    /// Numbers of the faces that hide it, in their order; none if it is seen.
    pub nature: Vec<usize>,
}

/// An edge with its natures, part by part.
#[derive(Debug, Clone, PartialEq)]
pub struct GalimbertiEdge {
    /// Number of the edge in the net.
    pub edge: usize,
    /// Its ends in space, t = 0 and t = 1, in the direction in which it was carried along.
    pub ends: [DVec3; 2],
    /// Its parts in their order.
    pub parts: Vec<EdgePart>,
}

impl GalimbertiEdge {
    /// Creates an edge of one part.
    fn new(net: &FaceNet, edge: usize, corners: [usize; 2], nature: &[usize]) -> Self {
        let ends = corners.map(|corner| net.corners()[corner]);
        Self { edge, ends, parts: vec![EdgePart { from: 0.0, to: 1.0, nature: nature.to_vec() }] }
    }

    /// Returns the ends of the visible parts.
    pub fn visible(&self) -> impl Iterator<Item = [DVec3; 2]> + '_ {
        let [p, q] = self.ends;
        let seen = self.parts.iter().filter(|part| part.nature.is_empty());
        seen.map(move |part| [part.from, part.to].map(|t| p.lerp(q, t)))
    }

    /// Ends the last part at t, and begins another one with a nature. A part without length is none: there one face
    /// takes the place of another at their common edge.
    fn change(&mut self, t: f64, nature: Vec<usize>) {
        let next = EdgePart { from: t, to: 1.0, nature };
        match self.parts.last_mut() {
            Some(last) if last.from == t && t > 0.0 => *last = next,
            Some(last) => {
                last.to = t;
                self.parts.push(next);
            }
            None => self.parts.push(next),
        }
    }
}

/// Step of the algorithm. Corners, edges and faces have their numbers in the net.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// The faces that can hide points.
    Hiders {
        /// Their numbers.
        faces: Vec<usize>,
    },
    /// The nature of a corner is found by comparing it with all of these.
    Compared {
        /// The corner.
        corner: usize,
        /// Its nature.
        nature: Vec<usize>,
    },
    /// An edge begins at a corner whose nature is known.
    Edge {
        /// The edge.
        edge: usize,
        /// Its corners, the known one first.
        corners: [usize; 2],
        /// The faces at the corner that hide the beginning of the edge.
        own: Vec<usize>,
        /// Nature of the beginning of the edge.
        nature: Vec<usize>,
    },
    /// A face enters or leaves the nature.
    Change {
        /// The edge.
        edge: usize,
        /// Parameter along the edge, in space.
        t: f64,
        /// The face.
        face: usize,
        /// Number of the face's edge that is crossed; none where the face is pierced.
        crossed: Option<usize>,
        /// Nature from here on.
        nature: Vec<usize>,
    },
    /// The end of the edge is reached.
    Corner {
        /// The edge.
        edge: usize,
        /// The corner at its end.
        corner: usize,
        /// The faces at the corner that hide the end of the edge.
        own: Vec<usize>,
        /// Nature of the corner.
        nature: Vec<usize>,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Hiders { .. } => 1,
            Self::Compared { .. } => 3,
            Self::Edge { .. } => 5,
            Self::Change { .. } => 8,
            Self::Corner { .. } => 10,
        }
    }
}

/// Returns the lines that a list of steps leads to.
pub fn replay(net: &FaceNet, steps: &[Step]) -> Vec<GalimbertiEdge> {
    let mut lines: Vec<GalimbertiEdge> = Vec::new();
    for step in steps {
        match step {
            Step::Edge { edge, corners, nature, .. } => {
                lines.push(GalimbertiEdge::new(net, *edge, *corners, nature));
            }
            Step::Change { t, nature, .. } => {
                lines.iter_mut().last().into_iter().for_each(|l| l.change(*t, nature.clone()));
            }
            _ => {}
        }
    }
    lines.compact_sort_by_key(|line| line.edge);
    lines
}

/// Returns the edges of plane polygons, in the order of the net, with the faces that hide each part of them. Edges
/// between faces of one plane are no lines.
///
/// ```
/// use durer::math::DVec3;
/// use durer::trace::NoTrace;
/// use durer::visibility::back_face::Eye;
/// use durer::visibility::line::face_net::FaceNet;
/// use durer::visibility::line::galimberti_montanari::{Options, draw};
/// use durer::work::Work;
///
/// // A square before a long triangle, whose sides it hides in part.
/// let square = [(1., -1.), (3., -1.), (3., 2.), (1., 2.)].map(|(x, y)| DVec3::new(x, y, 1.0));
/// let behind = [(0., 0.), (5., 0.), (0., 1.)].map(|(x, y)| DVec3::new(x, y, 0.0));
/// let faces = [square.to_vec(), behind.to_vec()];
/// let net = FaceNet::new(&faces, Eye::Along(DVec3::NEG_Z))?;
/// let lines = draw(&net, &Options::default(), &Work::default(), &mut NoTrace)?;
/// let natures: Vec<_> = lines[4].parts.iter().map(|part| &part.nature[..]).collect();
/// assert_eq!(natures, [&[][..], &[0], &[]]);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::Parameter`](crate::Error::Parameter) for faces that touch each other so that natures contradict each other;
/// [`Error::Memory`](crate::Error::Memory) if the budget of the work is too small, and its reason if the work is stopped.
pub fn draw(
    net: &FaceNet,
    options: &Options,
    work: &Work,
    t: &mut impl Tracer<Step>,
) -> Result<Vec<GalimbertiEdge>> {
    let charge = work.charge_for::<usize>("natures of edges", net.faces().len() as u64)?;
    let hiders: Vec<usize> = (0..net.faces().len()).filter(|face| net.is_hider(*face)).collect();
    t.step(|| Step::Hiders { faces: hiders.clone() });
    let mut run = Run { net, hiders, options, lines: Vec::new(), charge, t };
    net.carry(&mut run, work)?;
    let mut lines = run.lines;
    lines.compact_sort_by_key(|line| line.edge);
    Ok(lines)
}

/// The lines so far.
struct Run<'a, T> {
    net: &'a FaceNet,
    hiders: Vec<usize>,
    options: &'a Options,
    lines: Vec<GalimbertiEdge>,
    /// Charge of the hiding faces and the lines.
    charge: Charge,
    t: &'a mut T,
}

/// A place where a face enters or leaves the nature: the parameter on the page, the face, its edge if that is crossed.
type Change = (f64, usize, Option<usize>);

impl<T: Tracer<Step>> Carrier for Run<'_, T> {
    type State = Vec<usize>;

    fn find(&mut self, corner: usize) -> Vec<usize> {
        let nature = self.net.faces_before(corner);
        self.t.step(|| Step::Compared { corner, nature: nature.clone() });
        nature
    }

    fn along(
        &mut self,
        edge: usize,
        corners: [usize; 2],
        known: &Vec<usize>,
    ) -> Result<Vec<usize>> {
        let own = self.net.faces_over(corners);
        let mut nature = known.clone();
        own.iter().for_each(|face| toggle(&mut nature, *face));
        self.t.step(|| Step::Edge { edge, corners, own, nature: nature.clone() });
        let mut line = GalimbertiEdge::new(self.net, edge, corners, &nature);
        for (on_page, face, crossed) in self.changes(edge, corners) {
            toggle(&mut nature, face);
            let t = self.net.in_space(corners, on_page);
            line.change(t, nature.clone());
            self.t.step(|| Step::Change { edge, t, face, crossed, nature: nature.clone() });
        }
        let natures: usize = line.parts.iter().map(|part| part.nature.len()).sum();
        let parts = line.parts.len() * size_of::<EdgePart>() + natures * size_of::<usize>();
        self.charge.grow((size_of::<GalimbertiEdge>() + parts) as u64)?;
        self.lines.push(line);
        let [from, corner] = corners;
        let own = self.net.faces_over([corner, from]);
        own.iter().for_each(|face| toggle(&mut nature, *face));
        self.t.step(|| Step::Corner { edge, corner, own, nature: nature.clone() });
        Ok(nature)
    }
}

impl<T> Run<'_, T> {
    /// Returns the places where the nature of an edge changes, in their order along it.
    fn changes(&self, edge: usize, corners: [usize; 2]) -> Vec<Change> {
        let (net, mut found) = (self.net, Vec::new());
        let own = &net.edges()[edge].faces;
        for &face in self.hiders.iter().filter(|face| !own.contains(face)) {
            for &other in net.faces()[face].edges() {
                let crossing = net.crossing(corners, other).filter(|crossing| crossing.nearer);
                found.extend(crossing.map(|crossing| (crossing.t, face, Some(other))));
            }
            let pierce = net.pierce(corners, face).filter(|_| self.options.piercing);
            found.extend(pierce.map(|pierce| (pierce.t, face, None)));
        }
        found.compact_sort_by(|a, b| a.0.total_cmp(&b.0));
        found
    }
}

/// Adds a face to a nature, or takes it out.
fn toggle(nature: &mut Vec<usize>, face: usize) {
    match nature.binary_search(&face) {
        Ok(at) => {
            nature.remove(at);
        }
        Err(at) => nature.insert(at, face),
    }
}
