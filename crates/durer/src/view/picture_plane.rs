//! The projection from world space to the plane of the picture, with a depth that is linear there.

use super::View;
use crate::Result;
use crate::math::{DVec2, DVec3, Rect};
use crate::scene::{Camera, Projection};

/// A point of the picture, with its depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanePoint {
    /// Position in plane units; see [`crate::target::drawing::Drawing`].
    pub at: DVec2,
    /// Depth: 0 in the plane through the target, growing away from the eye, in model units at the target. It is affine
    /// over a projected plane: in parallel projection the distance from the target's plane, in perspective d − d²/w for
    /// a point at distance w along the line of sight, where d is the target's distance.
    pub depth: f64,
}

/// Borders of the view volume at which faces and lines are clipped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Borders {
    /// True to clip at the near and the far plane.
    pub depth: bool,
    /// Factor (at least 1) by which the window is widened before its sides clip; `None` to clip at no sides.
    pub sides: Option<f64>,
}

/// The map from the world to the plane of the picture.
///
/// View space here: x right, y up, z = distance from the eye along the line of sight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PicturePlane {
    eye: DVec3,
    axes: [DVec3; 3],
    /// Distance of the target along the line of sight.
    distance: f64,
    perspective: bool,
    near: f64,
    far: f64,
    half: DVec2,
}

impl PicturePlane {
    /// Creates the picture plane of a view.
    pub fn new(view: &View) -> Self {
        let aspect = f64::from(view.width()) / f64::from(view.height());
        Self::seen_by(view.camera(), aspect)
    }

    /// Creates the picture plane of a camera, for pictures whose width / height is `aspect`, which affects only the
    /// window and its sides.
    ///
    /// # Errors
    /// The errors of [`Camera::check`].
    pub fn of_camera(camera: &Camera, aspect: f64) -> Result<Self> {
        camera.check()?;
        Ok(Self::seen_by(camera, aspect))
    }

    fn seen_by(camera: &Camera, aspect: f64) -> Self {
        let [right, up, back] = camera.axes();
        let distance = (camera.target - camera.eye).length();
        let (half_height, perspective) = match camera.projection {
            Projection::Perspective { fov_y } => (distance * libm::tan(fov_y * 0.5), true),
            Projection::Orthographic { height } => (height * 0.5, false),
        };
        Self {
            eye: camera.eye,
            axes: [right, up, -back],
            distance,
            perspective,
            near: camera.near,
            far: camera.far,
            half: DVec2::new(half_height * aspect, half_height),
        }
    }

    /// Returns the window of the plane that the view shows, in plane units.
    pub(crate) fn window(&self) -> Option<Rect> {
        Rect::new(-self.half, self.half).ok()
    }

    /// Returns whether the lines of sight meet in the eye.
    pub fn is_perspective(&self) -> bool {
        self.perspective
    }

    /// Returns the direction of the line of sight through a point of the world; not of unit length in perspective.
    pub(crate) fn sight_at(&self, p: DVec3) -> DVec3 {
        if self.perspective { p - self.eye } else { self.axes[2] }
    }

    /// Converts from world space to view space: right, up, distance from the eye.
    #[inline]
    pub(crate) fn view_from_world(&self, p: DVec3) -> DVec3 {
        let d = p - self.eye;
        let [right, up, sight] = self.axes;
        DVec3::new(right.dot(d), up.dot(d), sight.dot(d))
    }

    /// Projects from view space to the plane; in perspective only for points in front of the eye.
    #[inline]
    pub(crate) fn plane_from_view(&self, p: DVec3) -> PlanePoint {
        if self.perspective {
            let scale = self.distance / p.z;
            PlanePoint { at: p.truncate() * scale, depth: (p.z - self.distance) * scale }
        } else {
            PlanePoint { at: p.truncate(), depth: p.z - self.distance }
        }
    }

    /// Projects from world space to the plane; in perspective only for points in front of the eye.
    #[inline]
    pub fn plane_from_world(&self, p: DVec3) -> PlanePoint {
        self.plane_from_view(self.view_from_world(p))
    }

    /// Returns whether a point of the world is not before the near plane.
    pub(crate) fn is_behind_near(&self, p: DVec3) -> bool {
        self.view_from_world(p).z >= self.near
    }

    /// Projects a point of the world; `None` if it is before the near plane.
    pub fn project(&self, p: DVec3) -> Option<DVec2> {
        let p = self.view_from_world(p);
        (p.z >= self.near).then(|| self.plane_from_view(p).at)
    }

    /// Projects the part of a segment of the world that is behind the near plane; `None` if all of it is before that
    /// plane.
    pub(crate) fn project_segment(&self, a: DVec3, b: DVec3) -> Option<[DVec2; 2]> {
        let ends = cut(|p| self.inside(0, p, 1.0), [a, b].map(|p| self.view_from_world(p)))?;
        Some(ends.map(|p| self.plane_from_view(p).at))
    }

    /// Returns the signed distance of a view-space point from the border `index` (0 near, 1 far, 2…5 left, right,
    /// bottom, top); outside it is below 0. It is linear, so that edges can be cut where it is 0.
    fn inside(&self, index: usize, p: DVec3, widened: f64) -> f64 {
        let half = self.half * widened;
        let slope = if self.perspective { p.z / self.distance } else { 1.0 };
        match index {
            0 => p.z - self.near,
            1 => self.far - p.z,
            2 => half.x * slope + p.x,
            3 => half.x * slope - p.x,
            4 => half.y * slope + p.y,
            _ => half.y * slope - p.y,
        }
    }

    fn borders(borders: Borders) -> std::ops::Range<usize> {
        let from = if borders.depth { 0 } else { 2 };
        from..if borders.sides.is_some() { 6 } else { 2.max(from) }
    }

    /// Returns whether a point of view space is inside the borders.
    #[inline]
    pub(crate) fn contains(&self, p: DVec3, borders: Borders) -> bool {
        Self::borders(borders).all(|b| self.inside(b, p, borders.sides.unwrap_or(1.0)) >= 0.0)
    }

    /// Returns the part of a segment in view space inside the borders. Both directions of a segment yield the same
    /// points.
    pub(crate) fn clip_segment(&self, ends: [DVec3; 2], borders: Borders) -> Option<[DVec3; 2]> {
        let mut ends = ends;
        for border in Self::borders(borders) {
            ends = cut(|p| self.inside(border, p, borders.sides.unwrap_or(1.0)), ends)?;
        }
        Some(ends)
    }

    /// Returns the part of a convex polygon in view space inside the borders, border by border (Sutherland–Hodgman).
    /// Neighbours that share an edge share its cut points. Empty if nothing remains.
    pub(crate) fn clip_face(&self, corners: &[DVec3], borders: Borders) -> Vec<DVec3> {
        let mut ring = corners.to_vec();
        for border in Self::borders(borders) {
            let d = |p: DVec3| self.inside(border, p, borders.sides.unwrap_or(1.0));
            if ring.iter().all(|p| d(*p) >= 0.0) {
                continue;
            }
            let mut kept = Vec::with_capacity(ring.len() + 1);
            for (i, &p) in ring.iter().enumerate() {
                let q = ring[(i + 1) % ring.len()];
                let (dp, dq) = (d(p), d(q));
                if dp >= 0.0 {
                    kept.push(p);
                }
                if dp >= 0.0 && dq < 0.0 {
                    kept.push(crossing(p, dp, q, dq));
                } else if dp < 0.0 && dq >= 0.0 {
                    kept.push(crossing(q, dq, p, dp));
                }
            }
            ring = kept;
        }
        if ring.len() < 3 { Vec::new() } else { ring }
    }
}

/// Returns the part of a segment where `inside` is not below 0.
fn cut(inside: impl Fn(DVec3) -> f64, [a, b]: [DVec3; 2]) -> Option<[DVec3; 2]> {
    let (da, db) = (inside(a), inside(b));
    match (da >= 0.0, db >= 0.0) {
        (true, true) => Some([a, b]),
        (true, false) => Some([a, crossing(a, da, b, db)]),
        (false, true) => Some([crossing(b, db, a, da), b]),
        (false, false) => None,
    }
}

/// Returns the intersection of the border with the line between a point inside and one outside. The inside point comes
/// first, so that both directions of an edge yield the same bits.
fn crossing(inside: DVec3, d_in: f64, outside: DVec3, d_out: f64) -> DVec3 {
    (outside * d_in - inside * d_out) / (d_in - d_out)
}
