//! The plane of the picture: where exact drawings have their coordinates.

use crate::Result;
use crate::math::{DVec2, DVec3, Rect};
use crate::scene::{Camera, Projection};

/// The plane through a camera's target at right angles to the line of sight; its points are in plane
/// units, as in [`crate::target::drawing::Drawing`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PicturePlane {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    ahead: DVec3,
    /// From the eye to the plane; `None` for a parallel projection.
    distance: Option<f64>,
    target: DVec3,
    near: f64,
    /// Half of the height that the camera sees of the plane.
    half_height: f64,
}

impl PicturePlane {
    /// The plane of a camera.
    ///
    /// # Errors
    /// What [`Camera::check`] finds.
    pub fn new(camera: &Camera) -> Result<Self> {
        camera.check()?;
        let [right, up, back] = camera.axes();
        let distance = camera.eye.distance(camera.target);
        let (distance, half_height) = match camera.projection {
            Projection::Perspective { fov_y } => {
                (Some(distance), distance * libm::tan(fov_y * 0.5))
            }
            Projection::Orthographic { height } => (None, height * 0.5),
        };
        let Camera { eye, target, near, .. } = *camera;
        Ok(Self { eye, right, up, ahead: -back, distance, target, near, half_height })
    }

    /// Distance of a point from the plane through the eye, along the line of sight; world units.
    pub fn depth(&self, p: DVec3) -> f64 {
        (p - self.eye).dot(self.ahead)
    }

    /// Distance of the near plane from the eye, as [`Self::depth`] measures it.
    pub fn near(&self) -> f64 {
        self.near
    }

    /// Where a point of the world is seen; `None` where it lies before the near plane.
    pub fn project(&self, p: DVec3) -> Option<DVec2> {
        let depth = self.depth(p);
        (depth >= self.near).then(|| self.project_at(p, depth))
    }

    fn project_at(&self, p: DVec3, depth: f64) -> DVec2 {
        match self.distance {
            Some(distance) => {
                let q = p - self.eye;
                DVec2::new(q.dot(self.right), q.dot(self.up)) * (distance / depth)
            }
            None => {
                let q = p - self.target;
                DVec2::new(q.dot(self.right), q.dot(self.up))
            }
        }
    }

    /// The part of a segment of the world that lies behind the near plane, as seen; `None` where all
    /// of it lies before.
    pub fn project_segment(&self, a: DVec3, b: DVec3) -> Option<[DVec2; 2]> {
        let (da, db) = (self.depth(a), self.depth(b));
        let cut = || {
            let t = (self.near - da) / (db - da);
            self.project_at(a + (b - a) * t, self.near)
        };
        match (da >= self.near, db >= self.near) {
            (true, true) => Some([self.project_at(a, da), self.project_at(b, db)]),
            (true, false) => Some([self.project_at(a, da), cut()]),
            (false, true) => Some([cut(), self.project_at(b, db)]),
            (false, false) => None,
        }
    }

    /// What a picture of this width / height shows of the plane, plane units.
    ///
    /// # Errors
    /// [`crate::Error::Parameter`] for an aspect that gives no finite rectangle.
    pub fn window(&self, aspect: f64) -> Result<Rect> {
        let half = DVec2::new(self.half_height * aspect, self.half_height);
        Rect::new(-half, half)
    }
}
