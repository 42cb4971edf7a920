//! Faces that are split by planes, for methods that paint them in an order.

use super::Face;
use crate::math::{DVec3, Plane};
use crate::work::{Charge, Work};
use crate::{Error, Result};

/// Distance from a plane, in units of the largest coordinate, below which a corner counts as in it: corners made by
/// splitting are rounded.
const IN_PLANE: f64 = 1e-10;

/// The side of a plane that a polygon is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PlaneSide {
    /// Side that the normal points to.
    Front,
    /// Behind it.
    Back,
    /// In the plane itself.
    On,
    /// On both sides: it is split.
    Both,
}

/// Part of a face after splitting.
#[derive(Debug, Clone)]
struct Piece {
    face: u32,
    corners: Vec<DVec3>,
    /// The last cut that made it.
    cut: Option<u32>,
}

/// A side of a plane that pieces keep to, and the cut before it.
#[derive(Debug, Clone, Copy)]
struct Cut {
    plane: Plane,
    front: bool,
    before: Option<u32>,
}

/// Pieces with numbers: first the faces, then the parts that splitting makes.
#[derive(Debug, Clone, Default)]
pub struct Pieces {
    pieces: Vec<Piece>,
    cuts: Vec<Cut>,
    /// Distance from a plane below which corners count as in it.
    tolerance: f64,
    charge: Charge,
}

impl Pieces {
    /// Begins with the whole faces.
    ///
    /// # Errors
    /// [`Error::Memory`] where the budget does not suffice.
    pub fn new(faces: &[Face], work: &Work) -> Result<Self> {
        let bytes = faces.iter().map(|face| bytes(face.corners().len())).sum();
        let charge = work.charge("pieces of polygons", bytes)?;
        let piece =
            |(face, own): (u32, &Face)| Piece { face, corners: own.corners().to_vec(), cut: None };
        let largest = faces.iter().flat_map(Face::corners);
        let largest = largest.fold(0.0, |all: f64, c| all.max(c.abs().max_element()));
        let pieces = (0..).zip(faces).map(piece).collect();
        Ok(Self { pieces, cuts: Vec::new(), tolerance: largest * IN_PLANE, charge })
    }

    /// Returns the side of a plane that a piece is on.
    pub fn side(&self, plane: &Plane, piece: u32) -> PlaneSide {
        let (mut front, mut back) = (false, false);
        for corner in &self.pieces[piece as usize].corners {
            let distance = plane.evaluate(*corner);
            front |= distance > self.tolerance;
            back |= distance < -self.tolerance;
        }
        match (front, back) {
            (true, true) => PlaneSide::Both,
            (true, false) => PlaneSide::Front,
            (false, true) => PlaneSide::Back,
            (false, false) => PlaneSide::On,
        }
    }

    /// Returns the parts of a piece in front of a plane and behind it.
    ///
    /// # Errors
    /// [`Error::Limit`] for more pieces of this kind than allowed; [`Error::Memory`] where the budget does not suffice.
    pub fn split(
        &mut self,
        plane: &Plane,
        piece: u32,
        (what, most): (&'static str, usize),
    ) -> Result<[u32; 2]> {
        let limit = most as u64;
        if self.pieces.len() as u64 + 2 > limit {
            let value = self.pieces.len() as u64 + 2;
            return Err(Error::Limit { what, value, limit });
        }
        let Piece { face, ref corners, cut: before } = self.pieces[piece as usize];
        // A cut of a concave ring may leave nearly all corners to both parts.
        self.charge.grow(2 * bytes(corners.len() + 2))?;
        let parts = [1.0, -1.0].map(|sign| part(plane, sign, corners));
        let first = self.pieces.len() as u32;
        for (corners, front) in parts.into_iter().zip([true, false]) {
            let cut = Some(self.cuts.len() as u32);
            self.cuts.push(Cut { plane: *plane, front, before });
            self.pieces.push(Piece { face, corners, cut });
        }
        Ok([first, first + 1])
    }

    /// Returns the face that a piece is of.
    pub fn face(&self, piece: u32) -> u32 {
        self.pieces[piece as usize].face
    }

    /// Returns the corners of a piece.
    pub fn corners(&self, piece: u32) -> &[DVec3] {
        &self.pieces[piece as usize].corners
    }

    /// Returns whether a point of a piece's face belongs to the piece.
    pub fn holds(&self, piece: u32, point: DVec3) -> bool {
        let mut next = self.pieces[piece as usize].cut;
        while let Some(cut) = next.and_then(|cut| self.cuts.get(cut as usize)) {
            if (cut.plane.evaluate(point) >= 0.0) != cut.front {
                return false;
            }
            next = cut.before;
        }
        true
    }
}

/// Returns the bytes that a piece takes with its cut.
fn bytes(corners: usize) -> u64 {
    (size_of::<Piece>() + size_of::<Cut>() + corners * size_of::<DVec3>()) as u64
}

/// Returns the corners of the part on one side of a plane, by Sutherland and Hodgman.
pub(super) fn part(plane: &Plane, sign: f64, corners: &[DVec3]) -> Vec<DVec3> {
    let mut part = Vec::with_capacity(corners.len() + 1);
    let next = corners.iter().cycle().skip(1);
    for (&a, &b) in corners.iter().zip(next) {
        let [da, db] = [a, b].map(|p| plane.evaluate(p) * sign);
        if da >= 0.0 {
            part.push(a);
        }
        if (da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0) {
            part.push(a + (b - a) * (da / (da - db)));
        }
    }
    part
}
