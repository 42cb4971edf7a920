//! Plane polygons with common corners in front of an eye, for methods that carry visibility along edges.
//!
//! [`super::appel`] and [`super::galimberti_montanari`] find the faces that hide one corner, and update them along the
//! edges to all others. Corners are on a page: x to the right, y up, z growing with the distance from the eye. In
//! perspective z is the negative reciprocal of the distance, so that lines and planes remain lines and planes.
//!
//! The eye is turned by some millionths of a radian, or moved by a similar amount, so that edges at different distances
//! do not coincide, and no face is seen exactly edge-on.

mod carry;
mod meet;

pub(super) use carry::Carrier;

use super::roberts::numbered;
use crate::math::{DVec2, DVec3, orient2d_value};
use crate::trace::NoTrace;
use crate::view::cull::newell_area;
use crate::visibility::back_face::Eye;
use crate::visibility::object::orientation::{Options, orient};
use crate::{Error, Result};
use std::collections::BTreeMap;

/// Largest distance that counts as none, in units of the extent on the page.
const FLATNESS: f64 = 1e-9;

/// Largest distance of corners from the plane of their face, in units of the extent of all.
const PLANE: f64 = 1e-6;

/// Slopes by which the page is sheared against coincidences: any that no drawing has.
const TURN: [f64; 2] = [1.318e-6, -2.273e-6];

/// Plane polygons with common corners, on the page of an eye.
///
/// # Guarantees
/// All corners are finite and before the eye; each face has an area and at least three corners in one plane. Faces of
/// closed bodies run counter-clockwise seen from outside.
#[derive(Debug, Clone, PartialEq)]
pub struct FaceNet {
    /// Corners in space.
    corners: Vec<DVec3>,
    /// Corners on the page.
    points: Vec<DVec3>,
    faces: Vec<NetFace>,
    edges: Vec<NetEdge>,
    /// Edges at each corner that are no parts of a plane.
    around: Vec<Vec<usize>>,
    closed: bool,
    /// Distances on the page up to this count as zero.
    small: f64,
    is_perspective: bool,
}

/// A face of a net.
#[derive(Debug, Clone, PartialEq)]
pub struct NetFace {
    /// Numbers of its corners, in order.
    pub ring: Vec<usize>,
    /// True if it turns its front to the eye.
    pub front: bool,
    /// Numbers of its edges: the first from the first corner to the second.
    edges: Vec<usize>,
    /// A point of its plane on the page, and the unit normal that points to the eye's side.
    center: DVec3,
    normal: DVec3,
}

/// An edge of a net.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NetEdge {
    /// Numbers of its corners.
    pub corners: [usize; 2],
    /// Numbers of its faces.
    pub faces: Vec<usize>,
    /// True if its two faces are in one plane and continue each other: no line of a drawing.
    pub flat: bool,
}

impl FaceNet {
    /// Creates a net from faces, each a ring of corners in either direction. Corners are common where they are equal.
    ///
    /// ```
    /// use durer::math::DVec3;
    /// use durer::visibility::back_face::Eye;
    /// use durer::visibility::line::face_net::FaceNet;
    ///
    /// let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let face = |leave: usize| (0..4).filter(|k| *k != leave).map(|k| corner[k]).collect();
    /// let net = FaceNet::new(&[face(0), face(1), face(2), face(3)], Eye::At(DVec3::splat(9.0)))?;
    /// assert_eq!((net.corners().len(), net.edges().len(), net.is_closed()), (4, 6, true));
    /// // One face of the tetrahedron turns its front to the eye, and has three contour edges.
    /// assert_eq!(net.faces().iter().filter(|face| face.front).count(), 1);
    /// assert_eq!((0..6).filter(|edge| net.is_contour(*edge)).count(), 3);
    /// # Ok::<(), durer::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NonFinite`]; [`Error::Parameter`] for faces without an area or with corners off their plane, and for
    /// corners that are not before the eye.
    pub fn new(faces: &[Vec<DVec3>], eye: Eye) -> Result<Self> {
        let (corners, mut rings) = numbered(faces)?;
        rings.iter_mut().for_each(without_repeats);
        let orientation = orient(&corners, &rings, &Options::default(), &mut NoTrace)?;
        for (ring, _) in rings.iter_mut().zip(&orientation.turned).filter(|(_, turned)| **turned) {
            ring.reverse();
        }
        let closed = orientation.pieces.iter().all(|piece| piece.closed && piece.orientable);
        let points = projected(&corners, eye)?;
        let extent = extent(&points);
        let found = rings.iter().map(|ring| face(ring, &points, extent));
        let mut faces = found.collect::<Result<Vec<_>>>()?;
        let edges = edges(&mut faces, extent);
        let mut around = vec![Vec::new(); points.len()];
        for (number, edge) in edges.iter().enumerate().filter(|(_, edge)| !edge.flat) {
            edge.corners.into_iter().for_each(|corner| around[corner].push(number));
        }
        let (small, is_perspective) = (extent * FLATNESS, matches!(eye, Eye::At(_)));
        Ok(Self { corners, points, faces, edges, around, closed, small, is_perspective })
    }

    /// Returns the corners in space, each once.
    pub fn corners(&self) -> &[DVec3] {
        &self.corners
    }

    /// Returns the faces in their order.
    pub fn faces(&self) -> &[NetFace] {
        &self.faces
    }

    /// Returns the edges in the order in which the faces have them, also flat ones.
    pub fn edges(&self) -> &[NetEdge] {
        &self.edges
    }

    /// Returns whether all faces bound closed bodies.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Returns whether an edge has one face that turns its front to the eye, and one that turns its back.
    pub fn is_contour(&self, edge: usize) -> bool {
        match self.edges[edge].faces[..] {
            [a, b] => self.faces[a].front != self.faces[b].front,
            _ => false,
        }
    }

    /// Returns whether a face hides what is behind it: all do but the backs of closed bodies, before which there is
    /// always a front.
    pub fn is_hider(&self, face: usize) -> bool {
        self.faces[face].front || !self.closed
    }

    /// Returns the parameter in space of the point at `t` of the way from one corner to another on the page.
    pub(crate) fn in_space(&self, [from, to]: [usize; 2], t: f64) -> f64 {
        if !self.is_perspective {
            return t;
        }
        // Distances from the eye are −1/z.
        let [near, far] = [from, to].map(|corner| self.points[corner].z);
        t * far / (near + t * (far - near))
    }
}

/// Leaves out corners that follow themselves around a ring.
fn without_repeats(ring: &mut Vec<usize>) {
    ring.dedup();
    if ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
}

/// Returns the corners on the page.
fn projected(corners: &[DVec3], eye: Eye) -> Result<Vec<DVec3>> {
    let middle = corners.iter().sum::<DVec3>() / corners.len().max(1) as f64;
    let (origin, toward) = match eye {
        Eye::At(eye) => (eye, middle - eye),
        Eye::Along(direction) => (DVec3::ZERO, direction),
    };
    let n = toward.normalize_or(DVec3::NEG_Z);
    let reference = if n.y.abs() < 0.9 { DVec3::Y } else { DVec3::Z };
    let up = (reference - n * reference.dot(n)).normalize_or(DVec3::X);
    let right = n.cross(up);
    let distance = n.dot(middle - origin);
    let place = |corner: &DVec3| {
        let p = *corner - origin;
        let (page, depth) = (DVec2::new(p.dot(right), p.dot(up)), p.dot(n));
        let (page, depth) = match eye {
            // Scaled for the middle to keep its place, and lengths there theirs.
            Eye::At(_) if depth > 0.0 => {
                (page * (distance / depth), -distance * (distance / depth))
            }
            Eye::At(_) => return Err(Error::parameter("corner", *corner, "before the eye")),
            Eye::Along(_) => (page, depth),
        };
        Ok((page + DVec2::from(TURN) * depth).extend(depth))
    };
    corners.iter().map(place).collect()
}

/// Returns the largest distance of a point from the middle of all.
fn extent(points: &[DVec3]) -> f64 {
    let middle = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
    points.iter().map(|point| point.distance(middle)).fold(0.0, f64::max)
}

/// Returns a face with its plane by Newell's method.
fn face(ring: &[usize], points: &[DVec3], extent: f64) -> Result<NetFace> {
    let wrong = |expected| Error::parameter("face", format!("of {} corners", ring.len()), expected);
    let own: Vec<DVec3> = ring.iter().map(|&corner| points[corner]).collect();
    let center = own.iter().sum::<DVec3>() / own.len().max(1) as f64;
    let Some(normal) = newell_area(&own).try_normalize() else {
        return Err(wrong("with an area"));
    };
    if own.iter().any(|p| normal.dot(*p - center).abs() > extent * PLANE) {
        return Err(wrong("with all corners in one plane"));
    }
    // The page, y upwards and z away from the eye, is left-handed: a front's Newell normal points away.
    let front = normal.z > 0.0;
    let normal = if front { -normal } else { normal };
    Ok(NetFace { ring: ring.to_vec(), front, edges: Vec::new(), center, normal })
}

/// Returns the edges in the order of the faces, and gives the faces their numbers.
fn edges(faces: &mut [NetFace], extent: f64) -> Vec<NetEdge> {
    let mut edges: Vec<NetEdge> = Vec::new();
    let mut known = BTreeMap::new();
    for (number, face) in faces.iter_mut().enumerate() {
        let ends = face.ring.iter().zip(face.ring.iter().cycle().skip(1));
        let pairs: Vec<[usize; 2]> = ends.map(|(a, b)| [*a, *b]).collect();
        for [a, b] in pairs {
            let edge = *known.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                edges.push(NetEdge { corners: [a, b], faces: Vec::new(), flat: false });
                edges.len() - 1
            });
            edges[edge].faces.push(number);
            face.edges.push(edge);
        }
    }
    for edge in &mut edges {
        if let [a, b] = edge.faces[..] {
            let [a, b] = [&faces[a], &faces[b]];
            let is_in = a.normal.dot(b.center - a.center).abs() <= extent * PLANE;
            edge.flat = is_in && a.front == b.front && a.normal.dot(b.normal) > 1.0 - FLATNESS;
        }
    }
    edges
}

/// Returns a value whose sign says on which side of the line from `a` to `b` a point is on the page: positive on the
/// left.
fn side(a: DVec3, b: DVec3, point: DVec3) -> f64 {
    orient2d_value(a.truncate(), b.truncate(), point.truncate())
}
