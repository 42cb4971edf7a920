//! Convex bodies in Roberts' form: a plane for each face, its inside positive.

use crate::math::{DVec3, Plane};
use crate::view::cull::newell_area;
use crate::{Error, Result};
use std::collections::BTreeMap;

/// Largest distance that counts as none, in units of a body's extent.
pub(super) const FLATNESS: f64 = 1e-9;

/// A convex body with plane faces.
///
/// # Guarantees
/// All corners are finite and lie on the inside of every plane, or on it; each edge has two faces.
#[derive(Debug, Clone, PartialEq)]
pub struct ConvexBody {
    corners: Vec<DVec3>,
    planes: Vec<Plane>,
    edges: Vec<BodyEdge>,
}

/// An edge of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BodyEdge {
    /// Indices of its corners.
    pub corners: [usize; 2],
    /// Indices of the planes of its two faces.
    pub planes: [usize; 2],
}

impl ConvexBody {
    /// Creates a body from its faces, each a ring of corners in either direction. Corners are common where they are
    /// equal.
    ///
    /// # Errors
    /// [`Error::NonFinite`]; [`Error::Parameter`] for faces without an area, for a surface that is not closed, and for
    /// a body that is not convex.
    pub fn new(faces: &[Vec<DVec3>]) -> Result<Self> {
        let (corners, rings) = numbered(faces)?;
        let middle = corners.iter().sum::<DVec3>() / corners.len().max(1) as f64;
        let extent = corners.iter().map(|c| c.distance(middle)).fold(0.0, f64::max);
        let wrong =
            |expected| Error::parameter("body", format!("of {} faces", faces.len()), expected);
        let (mut planes, mut owners) = (Vec::new(), Vec::with_capacity(rings.len()));
        for ring in &rings {
            let ring: Vec<DVec3> = ring.iter().map(|&corner| corners[corner]).collect();
            let is_in = |plane: &Plane| {
                ring.iter().all(|corner| plane.evaluate(*corner).abs() <= extent * FLATNESS)
            };
            // Faces in one plane, as the triangles of a polygon, are one.
            let known = planes.iter().position(is_in).filter(|_| !ring.is_empty());
            owners.push(known.unwrap_or(planes.len()));
            if known.is_none() {
                let plane = plane(&ring).ok_or_else(|| wrong("whose faces have areas"))?;
                // Roberts' correction of signs: a point inside must be on the positive side of every plane.
                let is_turned = plane.evaluate(middle) < 0.0;
                planes.push(if is_turned { reversed(plane) } else { plane });
            }
        }
        if planes.iter().any(|plane| plane.evaluate(middle) <= extent * FLATNESS) {
            return Err(wrong("with a volume"));
        }
        let off = |plane: &Plane, corner: &DVec3| plane.evaluate(*corner) < -extent * FLATNESS;
        if planes.iter().any(|plane| corners.iter().any(|corner| off(plane, corner))) {
            return Err(wrong("convex, with plane faces"));
        }
        let edges =
            edges(&rings, &owners).ok_or_else(|| wrong("closed: two faces at each edge"))?;
        Ok(Self { corners, planes, edges })
    }

    /// Divides faces into bodies: those that have corners in common belong together.
    ///
    /// # Errors
    /// Those of [`ConvexBody::new`].
    pub fn several(faces: &[Vec<DVec3>]) -> Result<Vec<Self>> {
        let (corners, rings) = numbered(faces)?;
        if rings.iter().any(Vec::is_empty) {
            return Err(Error::parameter("face", "without corners", "a ring of three or more"));
        }
        let mut parents: Vec<usize> = (0..corners.len()).collect();
        for ring in &rings {
            for pair in ring.windows(2) {
                let [a, b] = [root(&mut parents, pair[0]), root(&mut parents, pair[1])];
                parents[a.max(b)] = a.min(b);
            }
        }
        let mut groups = BTreeMap::<usize, Vec<Vec<DVec3>>>::new();
        for (ring, face) in rings.iter().zip(faces) {
            let first = ring.first().copied().unwrap_or_default();
            groups.entry(root(&mut parents, first)).or_default().push(face.clone());
        }
        groups.values().map(|faces| Self::new(faces)).collect()
    }

    /// Returns the corners, each once.
    pub fn corners(&self) -> &[DVec3] {
        &self.corners
    }

    /// Returns the planes of the faces, each once, in the order of the faces: the columns of the body's matrix. Normals
    /// have unit length and point inwards.
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// Returns the edges between faces of different planes, in the order in which the faces have them.
    pub fn edges(&self) -> &[BodyEdge] {
        &self.edges
    }

    /// Returns the ends of an edge.
    pub(crate) fn ends(&self, edge: &BodyEdge) -> [DVec3; 2] {
        edge.corners.map(|corner| self.corners[corner])
    }
}

/// Returns the plane of a ring by Newell's method.
fn plane(ring: &[DVec3]) -> Option<Plane> {
    let center = ring.iter().sum::<DVec3>() / ring.len().max(1) as f64;
    let plane = Plane::through(center, newell_area(ring)).normalized();
    plane.filter(|plane| plane.distance.is_finite())
}

fn reversed(plane: Plane) -> Plane {
    Plane { normal: -plane.normal, distance: -plane.distance }
}

/// Returns the first of the corners that are joined with one.
fn root(parents: &mut [usize], mut corner: usize) -> usize {
    while parents[corner] != corner {
        parents[corner] = parents[parents[corner]];
        corner = parents[corner];
    }
    corner
}

/// Returns the distinct corners in their order, and each face as numbers of them.
pub(in crate::visibility::line) fn numbered(
    faces: &[Vec<DVec3>],
) -> Result<(Vec<DVec3>, Vec<Vec<usize>>)> {
    let mut corners = Vec::new();
    let mut known = BTreeMap::new();
    let mut rings = Vec::with_capacity(faces.len());
    for corner in faces.iter().flatten().enumerate() {
        if !corner.1.is_finite() {
            return Err(Error::NonFinite { what: "corner", index: corner.0 });
        }
    }
    for face in faces {
        let mut ring = Vec::with_capacity(face.len());
        for &corner in face {
            // Adding zero makes −0 and 0 one number.
            let bits = (corner + DVec3::ZERO).to_array().map(f64::to_bits);
            let number = *known.entry(bits).or_insert_with(|| {
                corners.push(corner);
                corners.len() - 1
            });
            ring.push(number);
        }
        rings.push(ring);
    }
    Ok((corners, rings))
}

/// Returns the edges between two planes in the order of the rings, whose planes are `owners`; `None` if an edge has not
/// exactly two faces.
fn edges(rings: &[Vec<usize>], owners: &[usize]) -> Option<Vec<BodyEdge>> {
    let mut edges: Vec<(BodyEdge, usize)> = Vec::new();
    let mut known = BTreeMap::new();
    for (ring, &face) in rings.iter().zip(owners) {
        for (&a, &b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            if a == b {
                continue;
            }
            let number = *known.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                edges.push((BodyEdge { corners: [a, b], planes: [face; 2] }, 0));
                edges.len() - 1
            });
            let (edge, count) = &mut edges[number];
            edge.planes[1] = face;
            *count += 1;
        }
    }
    let complete = edges.iter().all(|(_, count)| *count == 2) && !edges.is_empty();
    let edges = edges.into_iter().map(|(edge, _)| edge);
    complete.then(|| edges.filter(|edge| edge.planes[0] != edge.planes[1]).collect())
}
