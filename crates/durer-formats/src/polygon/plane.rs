//! The plane of a polygon, and the polygon in it.

use durer::math::{DVec2, DVec3};

/// Distance from the plane, as a part of the polygon's size, below which corners count as in it.
const FLAT: f64 = 1e-9;

/// Corners farther from the plane than this part of the polygon's size make a bent face.
const BENT: f64 = 1e-3;

/// A plane in which a polygon runs counter-clockwise.
#[derive(Debug)]
pub(super) struct Plane {
    origin: DVec3,
    /// Normal of length 1.
    normal: DVec3,
    /// Distance that counts as zero.
    none: f64,
}

impl Plane {
    /// Returns the plane through the first corner, across Newell's normal; if that is nothing,
    /// across the largest triangle of the fan. `None` for corners on one line, or that are not
    /// finite.
    pub fn of(points: &[DVec3]) -> Option<Self> {
        let (&origin, rest) = points.split_first()?;
        let size = rest.iter().map(|p| (*p - origin).length()).fold(0.0, f64::max);
        let fan = || rest.windows(2).map(|w| (w[0] - origin).cross(w[1] - origin));
        let newell: DVec3 = fan().sum();
        let largest = fan().fold(DVec3::ZERO, |most, n| {
            if n.length_squared() > most.length_squared() { n } else { most }
        });
        let rounding = 1e-12 * largest.length();
        let chosen = if newell.length() > rounding { newell } else { largest };
        let normal = chosen.try_normalize()?;
        size.is_finite().then_some(Self { origin, normal, none: FLAT * size })
    }

    /// Returns whether corners are so far off the plane that edges which cross in it pass each other in space.
    pub fn is_left_by(&self, points: &[DVec3]) -> bool {
        let limit = self.none / FLAT * BENT;
        points.iter().any(|p| (*p - self.origin).dot(self.normal).abs() > limit)
    }

    /// Projects a point along the normal to the plane of two axes in which the polygon is largest. Points already in
    /// the polygon's plane keep their coordinates, so that no rounding bends straight lines.
    pub fn flat(&self, p: DVec3) -> DVec2 {
        let height = (p - self.origin).dot(self.normal);
        let p = if height.abs() > self.none { p - height * self.normal } else { p };
        let n = self.normal;
        let size = n.abs();
        let (u, v, up) = if size.z >= size.x.max(size.y) {
            (p.x, p.y, n.z)
        } else if size.y >= size.x {
            (p.z, p.x, n.y)
        } else {
            (p.y, p.z, n.x)
        };
        if up > 0.0 { DVec2::new(u, v) } else { DVec2::new(v, u) }
    }
}
