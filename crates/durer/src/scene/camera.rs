//! The eye and how it sees.

use crate::math::{DMat4, DVec3};
use crate::{Error, Result};

/// Projection of the view space.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Projection {
    /// Lines through the eye.
    Perspective {
        /// Vertical angle of view in radians, between 0 and π.
        fov_y: f64,
    },
    /// Parallel lines.
    Orthographic {
        /// Height of the view in world units.
        height: f64,
    },
}

/// An eye that looks from one point to another; right-handed, looks down −z of its own space.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Camera {
    /// Position of the eye, world space.
    pub eye: DVec3,
    /// A point in the middle of the picture, world space.
    pub target: DVec3,
    /// A direction that is up in the picture; not parallel to the line of sight.
    pub up: DVec3,
    /// Perspective or parallel.
    pub projection: Projection,
    /// Distance of the near plane from the eye; > 0 for perspective.
    pub near: f64,
    /// Distance of the far plane from the eye; > near.
    pub far: f64,
}

/// A camera of a file.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NamedCamera {
    /// Its name. Readers make names unique and name unnamed cameras `camera0`, `camera1` …
    pub name: String,
    /// The camera. Files without a far plane get one from the scene's bounds.
    pub camera: Camera,
    /// Width / height by the file.
    pub aspect: Option<f64>,
}

impl Camera {
    /// Creates a camera at `eye` that looks at `target` in perspective, with a vertical angle of 45° and the
    /// clipping planes at a hundredth and a hundred times the distance; all world space. `up` is up in the
    /// picture.
    ///
    /// ```
    /// use durer::scene::{Camera, Projection};
    ///
    /// let camera = Camera::look_at([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    /// assert_eq!((camera.near, camera.far), (0.05, 500.0));
    /// let parallel = Camera { projection: Projection::Orthographic { height: 2.0 }, ..camera };
    /// assert!(parallel.check().is_ok());
    /// ```
    pub fn look_at(eye: impl Into<DVec3>, target: impl Into<DVec3>, up: impl Into<DVec3>) -> Self {
        let (eye, target) = (eye.into(), target.into());
        let distance = eye.distance(target);
        let projection = Projection::Perspective { fov_y: std::f64::consts::FRAC_PI_4 };
        Self {
            eye,
            target,
            up: up.into(),
            projection,
            near: distance / 100.0,
            far: distance * 100.0,
        }
    }

    /// Checks that the camera can see: finite, eye ≠ target, up not parallel, near < far.
    ///
    /// # Errors
    /// [`Error::Parameter`] naming the first parameter that is wrong.
    pub fn check(&self) -> Result<()> {
        let bad = |name, value: String, expected| Err(Error::Parameter { name, value, expected });
        for (name, v) in [("eye", self.eye), ("target", self.target), ("up", self.up)] {
            if !v.is_finite() {
                return bad(name, v.to_string(), "finite");
            }
        }
        let sight = self.target - self.eye;
        if sight.length_squared() == 0.0 || !sight.length_squared().is_finite() {
            return bad("target", self.target.to_string(), "a point other than the eye");
        }
        let side = sight.normalize().cross(self.up.normalize_or_zero());
        if side.length() < 1e-9 {
            return bad("up", self.up.to_string(), "a direction not parallel to the line of sight");
        }
        if !(self.near.is_finite() && self.far.is_finite() && self.near < self.far) {
            return bad("near", self.near.to_string(), "finite and less than far");
        }
        match self.projection {
            Projection::Perspective { fov_y } if !(fov_y > 0.0 && fov_y < std::f64::consts::PI) => {
                bad("fov", fov_y.to_degrees().to_string(), "between 0 and 180 degrees")
            }
            Projection::Perspective { .. } if self.near <= 0.0 => {
                bad("near", self.near.to_string(), "above 0 for a perspective camera")
            }
            Projection::Orthographic { height } if !(height > 0.0 && height.is_finite()) => {
                bad("ortho", height.to_string(), "a finite height above 0")
            }
            _ => Ok(()),
        }
    }

    /// Returns the camera's axes in world space, each of unit length: right, up, and backward (+z).
    pub fn axes(&self) -> [DVec3; 3] {
        let back = (self.eye - self.target).normalize();
        let right = self.up.normalize().cross(back).normalize();
        [right, back.cross(right), back]
    }

    /// Returns the matrix from world space to view space: the eye at the origin, looking down −z.
    pub fn view_from_world(&self) -> DMat4 {
        let [right, up, back] = self.axes();
        let row = |axis: DVec3| axis.extend(-axis.dot(self.eye));
        DMat4::from_cols(row(right), row(up), row(back), glam::DVec4::W).transpose()
    }

    /// Returns the matrix from view space to clip space, −w ≤ x, y, z ≤ w. `aspect` is width / height.
    pub fn clip_from_view(&self, aspect: f64) -> DMat4 {
        let (n, f) = (self.near, self.far);
        match self.projection {
            Projection::Perspective { fov_y } => {
                let s = 1.0 / libm::tan(fov_y * 0.5);
                DMat4::from_cols_array_2d(&[
                    [s / aspect, 0.0, 0.0, 0.0],
                    [0.0, s, 0.0, 0.0],
                    [0.0, 0.0, (f + n) / (n - f), -1.0],
                    [0.0, 0.0, 2.0 * f * n / (n - f), 0.0],
                ])
            }
            Projection::Orthographic { height } => {
                let s = 2.0 / height;
                DMat4::from_cols_array_2d(&[
                    [s / aspect, 0.0, 0.0, 0.0],
                    [0.0, s, 0.0, 0.0],
                    [0.0, 0.0, 2.0 / (n - f), 0.0],
                    [0.0, 0.0, (f + n) / (n - f), 1.0],
                ])
            }
        }
    }
}
