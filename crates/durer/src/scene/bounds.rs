//! Bounding boxes and spheres.

use crate::math::DVec3;

/// An axis-parallel box in three dimensions; closed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aabb {
    /// The corner with the smallest coordinates.
    pub min: DVec3,
    /// The corner with the largest coordinates.
    pub max: DVec3,
}

impl Aabb {
    /// Returns the smallest box around the finite points; `None` if there is none.
    pub fn around(points: impl IntoIterator<Item = DVec3>) -> Option<Self> {
        let mut points = points.into_iter().filter(|p| p.is_finite());
        let first = points.next()?;
        let (min, max) = points.fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p)));
        Some(Self { min, max })
    }

    /// Returns the smallest box around both.
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Returns the middle.
    pub fn center(&self) -> DVec3 {
        self.min + (self.max - self.min) * 0.5
    }

    /// Returns the extent along each axis.
    pub fn size(&self) -> DVec3 {
        self.max - self.min
    }

    /// Returns the eight corners; bit k of the index chooses max on axis k.
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, lo: f64, hi: f64| if i >> bit & 1 == 1 { hi } else { lo };
            DVec3::new(
                pick(0, self.min.x, self.max.x),
                pick(1, self.min.y, self.max.y),
                pick(2, self.min.z, self.max.z),
            )
        })
    }
}

/// A bounding sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundingSphere {
    /// The middle.
    pub center: DVec3,
    /// Radius; not negative.
    pub radius: f64,
}
