//! Orientation of faces: the turn of each, and the outward direction.
//!
//! A. F. Möbius, *Ueber die Bestimmung des Inhaltes eines Polyëders*, Berichte der Königlich Sächsischen Gesellschaft
//! der Wissenschaften 17, 1865: faces of an orientable surface can be traversed so that each edge is passed once in
//! each direction; then the sum of the tetrahedra from any point to the faces is the volume, which is negative if the
//! faces are turned inwards. Convex bodies have a simpler test: a face is turned outwards if its normal points away
//! from the mean of all corners. Object space. Cost: O(n log n) time and O(n) memory for n corners.
//!
//! Limits: pieces of surface that cannot be oriented (Möbius' strip) stay as they are. Coherence used: edges.
//!
//! [`orient`] is the published method on polygons, traced; [`SceneOrientation`](super::SceneOrientation) does the same for scenes by the pieces
//! and volumes of [`super::Bodies`], welded and stitched.
//!
//! ```
//! use durer::math::DVec3;
//! use durer::trace::NoTrace;
//! use durer::visibility::object::orientation::{Options, orient};
//!
//! // A tetrahedron whose second face runs the other way.
//! let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
//! let faces = [vec![0, 2, 1], vec![0, 3, 1], vec![1, 2, 3], vec![2, 0, 3]];
//! let found = orient(&points, &faces, &Options::default(), &mut NoTrace)?;
//! assert_eq!(found.turned, [false, true, false, false]);
//! assert_eq!((found.pieces[0].closed, found.pieces[0].flipped), (true, 1));
//! # Ok::<(), durer::Error>(())
//! ```

pub(super) mod scene;

use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec3;
use crate::trace::{PseudocodeLine, Tracer};
use crate::view::cull::newell_area;
use crate::{Error, Result};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "orientation",
    title: "Orientation of faces",
    authors: "A. F. Möbius",
    year: 1865,
    source: "Ueber die Bestimmung des Inhaltes eines Polyëders, Berichte der Königlich Sächsischen \
             Gesellschaft der Wissenschaften 17",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge],
    cost: "O(n log n) time, O(n) memory for n corners of all faces",
    limits: "pieces that cannot be oriented stay as they are; the centroid test is for convex bodies",
    pseudocode: &[
        "for each face not yet reached:",
        "    it begins a piece and stays as it is",
        "    for each face F of the piece, in the order in which they are reached:",
        "        for each edge of F with exactly one other face G:",
        "            G not yet reached: turn it if it runs through the edge as F does",
        "            else if both run through it the same way: no orientation is right, the piece stays as it was",
        "for each piece whose every edge has two faces:",
        "    V ← Σ (A − O) · ((B − O) × (C − O)) / 6 over the triangles ABC of its faces",
        "    V < 0: turn all of its faces",
        "// or, for a convex body, for each face with normal N, with P the mean of all corners:",
        "    N · (P_k − P) < 0: turn the face",
    ],
};

/// Test that decides the outward direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Outward {
    /// The sign of the volume, for closed pieces; others stay as most of their faces are.
    #[default]
    SignedVolume,
    /// For each face, whether its normal points away from the mean of all corners of its piece; for convex bodies, also
    /// without some faces.
    Centroid,
}

/// Options for finding the orientation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Test that decides the outward direction.
    pub outward: Outward,
}

/// Step of the algorithm. Faces and pieces are numbered in their order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A face begins a piece.
    Begin {
        /// The face.
        face: usize,
        /// The piece.
        piece: usize,
    },
    /// A face is reached across an edge.
    Reached {
        /// The face before.
        from: usize,
        /// The face that is reached.
        face: usize,
        /// Ends of the edge, as the face before runs through it in the end.
        edge: [usize; 2],
        /// True if it has to be turned.
        turned: bool,
    },
    /// Two faces of a piece run through an edge the same way: the piece cannot be oriented.
    Torn {
        /// The faces.
        faces: [usize; 2],
        /// Ends of the edge.
        edge: [usize; 2],
    },
    /// The volume of a closed piece was computed; if it is negative, all of its faces are turned.
    Volume {
        /// The piece.
        piece: usize,
        /// Its volume, in cubic units.
        volume: f64,
    },
    /// A face was compared with the mean of the corners.
    Compared {
        /// The face.
        face: usize,
        /// N · (P_k − P), with N as long as the face's area.
        product: f64,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Begin { .. } => 2,
            Self::Reached { .. } => 5,
            Self::Torn { .. } => 6,
            Self::Volume { volume, .. } => 8 + usize::from(*volume < 0.0),
            Self::Compared { .. } => 11,
        }
    }
}

/// A connected piece of surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OrientedPiece {
    /// Number of its faces.
    pub faces: usize,
    /// True if each of its edges has two faces.
    pub closed: bool,
    /// False if the faces cannot be turned so that all neighbours agree.
    pub orientable: bool,
    /// True if a closed piece has most of its faces turned inwards.
    pub inside_out: bool,
    /// Number of faces that are turned otherwise than most of the piece.
    pub flipped: usize,
    /// Volume of a closed piece once it is oriented, in cubic units; else 0.
    pub volume: f64,
}

/// The orientation of faces.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FaceOrientation {
    /// True for each face that has to be turned for all to be right.
    pub turned: Vec<bool>,
    /// Piece of each face.
    pub piece: Vec<usize>,
    /// The pieces, in the order of their first faces.
    pub pieces: Vec<OrientedPiece>,
}

/// A side of a face: ends in order, the face, whether it runs from the first end to the second.
type Side = (usize, usize, usize, bool);

/// Returns the faces that have to be turned for neighbours to agree and for fronts to look outwards. Faces are rings of
/// places in `points`.
///
/// # Errors
/// [`Error::Dangling`] for a corner that is not among the points.
pub fn orient<F: AsRef<[usize]>>(
    points: &[DVec3],
    faces: &[F],
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<FaceOrientation> {
    let corners = faces.iter().flat_map(|face| face.as_ref());
    if let Some(&index) = corners.clone().find(|v| **v >= points.len()) {
        return Err(Error::Dangling { what: "corner", index, count: points.len() });
    }
    let mut found = propagate(faces, t);
    let mut members = vec![Vec::new(); found.pieces.len()];
    found.piece.iter().enumerate().for_each(|(face, piece)| members[*piece].push(face));
    for (piece, members) in members.iter().enumerate() {
        match options.outward {
            Outward::SignedVolume if found.pieces[piece].closed => {
                by_volume(points, faces, members, &mut found, t);
            }
            Outward::SignedVolume => {}
            Outward::Centroid => by_centroid(points, faces, members, &mut found, t),
        }
        let known = found.pieces[piece].closed || options.outward == Outward::Centroid;
        found.count(members, known);
    }
    Ok(found)
}

/// Returns pieces and turns in which neighbours agree.
fn propagate<F: AsRef<[usize]>>(faces: &[F], t: &mut impl Tracer<Step>) -> FaceOrientation {
    let sides = |face: usize| {
        let ring = faces[face].as_ref();
        let ends = ring.iter().zip(ring.iter().cycle().skip(1));
        ends.filter(|(a, b)| a != b).map(|(&a, &b)| (a, b))
    };
    let mut edges: Vec<Side> = (0..faces.len())
        .flat_map(|f| sides(f).map(move |(a, b)| (a.min(b), a.max(b), f, a < b)))
        .collect();
    edges.sort_unstable();
    let of_edge = |a: usize, b: usize| {
        let key = (a.min(b), a.max(b));
        let first = edges.partition_point(|e| (e.0, e.1) < key);
        // Three faces and more are treated alike.
        let count = edges[first..].iter().take(3).take_while(|e| (e.0, e.1) == key).count();
        &edges[first..first + count]
    };
    let none = usize::MAX;
    let (piece, turned) = (vec![none; faces.len()], vec![false; faces.len()]);
    let mut found = FaceOrientation { turned, piece, pieces: Vec::new() };
    for first in 0..faces.len() {
        if found.piece[first] != none {
            continue;
        }
        let number = found.pieces.len();
        t.step(|| Step::Begin { face: first, piece: number });
        found.piece[first] = number;
        let mut piece =
            OrientedPiece { closed: true, orientable: true, ..OrientedPiece::default() };
        let mut reached = vec![first];
        while let Some(&from) = reached.get(piece.faces) {
            piece.faces += 1;
            piece.closed &= sides(from).next().is_some();
            for (a, b) in sides(from) {
                let [one, two] = of_edge(a, b) else {
                    piece.closed = false;
                    continue;
                };
                let other = if one.2 == from { two } else { one };
                let face = other.2;
                let edge = if found.turned[from] { [b, a] } else { [a, b] };
                // The other one as in the file, compared with this one as turned.
                let same = (other.3 == (a < b)) != found.turned[from];
                if found.piece[face] == none {
                    (found.piece[face], found.turned[face]) = (number, same);
                    t.step(|| Step::Reached { from, face, edge, turned: same });
                    reached.push(face);
                } else if same != found.turned[face] && face != from {
                    piece.orientable = false;
                    t.step(|| Step::Torn { faces: [from, face], edge });
                }
            }
        }
        if !piece.orientable {
            piece.closed = false;
            reached.iter().for_each(|face| found.turned[*face] = false);
        }
        found.pieces.push(piece);
    }
    found
}

fn by_volume<F: AsRef<[usize]>>(
    points: &[DVec3],
    faces: &[F],
    members: &[usize],
    found: &mut FaceOrientation,
    t: &mut impl Tracer<Step>,
) {
    let Some(piece) = members.first().map(|face| found.piece[*face]) else { return };
    let corner = members.iter().find_map(|face| faces[*face].as_ref().first());
    let origin = corner.map_or(DVec3::ZERO, |v| points[*v]);
    let mut volume = 0.0;
    for &face in members {
        let ring = faces[face].as_ref();
        let fan = ring.windows(2).skip(1).map(|pair| [ring[0], pair[0], pair[1]]);
        let six: f64 = fan
            .map(|corners| {
                let [a, b, c] = corners.map(|v| points[v] - origin);
                a.dot(b.cross(c))
            })
            .sum();
        volume += if found.turned[face] { -six } else { six } / 6.0;
    }
    t.step(|| Step::Volume { piece, volume });
    found.pieces[piece].volume = volume.abs();
    if volume < 0.0 {
        members.iter().for_each(|face| found.turned[*face] ^= true);
    }
}

fn by_centroid<F: AsRef<[usize]>>(
    points: &[DVec3],
    faces: &[F],
    members: &[usize],
    found: &mut FaceOrientation,
    t: &mut impl Tracer<Step>,
) {
    let mut corners: Vec<usize> =
        members.iter().flat_map(|face| faces[*face].as_ref()).copied().collect();
    corners.sort_unstable();
    corners.dedup();
    let mean = corners.iter().map(|v| points[*v]).sum::<DVec3>() / corners.len().max(1) as f64;
    for &face in members {
        let ring: Vec<DVec3> = faces[face].as_ref().iter().map(|v| points[*v]).collect();
        let Some(&corner) = ring.first() else { continue };
        let product = newell_area(&ring).dot(corner - mean);
        t.step(|| Step::Compared { face, product });
        found.turned[face] = product < 0.0;
    }
}

impl FaceOrientation {
    /// Counts the turns of a piece. If the outside is not known, most of its faces are right, or the first
    /// one where as many are turned as are not.
    fn count(&mut self, members: &[usize], outward_is_known: bool) {
        let Some(number) = members.first().map(|face| self.piece[*face]) else { return };
        let turned = members.iter().filter(|face| self.turned[**face]).count();
        let most = 2 * turned > members.len();
        if most && !outward_is_known {
            members.iter().for_each(|face| self.turned[*face] ^= true);
        }
        let piece = &mut self.pieces[number];
        piece.inside_out = most && outward_is_known;
        piece.flipped = turned.min(members.len() - turned);
    }
}

/// Rebuilds the turns of all faces from the steps of [`orient`]; without the choice of most faces for open pieces.
pub fn replay(steps: &[Step], faces: usize) -> Vec<bool> {
    let (mut turned, mut piece) = (vec![false; faces], vec![usize::MAX; faces]);
    let all = |of: usize, piece: &[usize], turned: &mut [bool], f: fn(bool) -> bool| {
        let members = piece.iter().zip(turned).filter(|(p, _)| **p == of);
        members.for_each(|(_, turned)| *turned = f(*turned));
    };
    for step in steps {
        match *step {
            Step::Begin { face, piece: number } => piece[face] = number,
            Step::Reached { from, face, turned: turn, .. } => {
                (piece[face], turned[face]) = (piece[from], turn);
            }
            Step::Torn { .. } => {}
            Step::Volume { piece: of, volume } if volume < 0.0 => {
                all(of, &piece, &mut turned, |t| !t);
            }
            Step::Volume { .. } => {}
            Step::Compared { face, product } => turned[face] = product < 0.0,
        }
    }
    for step in steps {
        if let Step::Torn { faces: [face, _], .. } = *step {
            all(piece[face], &piece, &mut turned, |_| false);
        }
    }
    turned
}
