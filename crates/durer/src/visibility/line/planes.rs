//! The planes of triangles, for passes over edges: those meet each triangle three times.

use crate::math::DVec3;
use crate::parallel;
use crate::visibility::object::{EdgeSide, Faces};

/// Triangles per job.
const JOB: usize = 1 << 15;

/// The direction and the size of a triangle.
#[derive(Debug, Clone, Copy, Default)]
struct Plane {
    /// Twice the area, along the normal.
    across: DVec3,
    /// Twice the area.
    area: f64,
}

/// The planes of all triangles, by item.
pub(super) struct Planes(Vec<Plane>);

impl Planes {
    /// Creates the planes of faces; O(n).
    pub fn new(faces: &Faces) -> Self {
        let plane = |item: usize| {
            let corners = faces.corners(item as u32);
            let across = corners.map_or(DVec3::ZERO, |[a, b, c]| (b - a).cross(c - a));
            Plane { across, area: across.length() }
        };
        Self(parallel::each(faces.len(), JOB, plane))
    }

    /// Returns twice the area of a triangle along its normal; zero if it has none.
    #[inline]
    pub fn across(&self, item: u32) -> DVec3 {
        self.0[item as usize].across
    }

    /// Returns the unit normal of a triangle; zero if it has none.
    #[inline]
    pub fn normal(&self, item: u32) -> DVec3 {
        let Plane { across, area } = self.0[item as usize];
        let part = 1.0 / area;
        if part.is_finite() && part > 0.0 { across * part } else { DVec3::ZERO }
    }

    /// Returns twice the area of a triangle.
    #[inline]
    pub fn area(&self, item: u32) -> f64 {
        self.0[item as usize].area
    }

    /// Returns the cosine of the angle by which the surface turns between two triangles at an edge; NaN where one has
    /// no direction.
    #[inline]
    pub fn cosine(&self, a: EdgeSide, b: EdgeSide) -> f64 {
        let [p, q] = [a, b].map(|side| self.0[side.item() as usize]);
        let cosine = p.across.dot(q.across) / (p.area * q.area);
        if a.forward() == b.forward() { -cosine } else { cosine }
    }
}
