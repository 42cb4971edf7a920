//! The placement of a view on its sheet, so that others can draw on it.

use super::{ViewBreaks, onto_paper};
use crate::math::{DVec2, DVec3, Rect};
use crate::scene::{Camera, Projection};
use crate::view::picture_plane::PicturePlane;

/// A view on a sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedView {
    /// Name of the view: `front`, `top`, `A–A`, `B`, …; empty for the only one.
    pub name: String,
    /// Camera of the view; `None` if it is not known.
    pub camera: Option<Camera>,
    /// Position of the origin of the drawing's plane, in millimetres from the sheet's upper left corner, y
    /// down.
    pub origin: DVec2,
    /// Millimetres on the sheet per unit of the model.
    pub factor: f64,
    /// Bounds of the drawing, in the sheet's millimetres.
    pub bounds: Rect,
    /// The breaks of the drawing.
    pub breaks: ViewBreaks,
}

impl PlacedView {
    /// Creates the place of a drawing with `bounds` in its plane.
    pub(super) fn new(
        name: &str,
        camera: Option<Camera>,
        bounds: Rect,
        origin: DVec2,
        factor: f64,
    ) -> Self {
        let corners = [bounds.min(), bounds.max()].map(|p| onto_paper(p, origin, factor));
        let bounds = Rect::around(corners).unwrap_or(bounds);
        let breaks = ViewBreaks::default();
        Self { name: name.to_owned(), camera, origin, factor, bounds, breaks }
    }

    /// Returns a point of the drawing's plane, as it is drawn, on the sheet, millimetres.
    pub fn sheet_from_plane(&self, p: DVec2) -> DVec2 {
        onto_paper(p, self.origin, self.factor)
    }

    /// Returns the point of the plane that is drawn at a place of the sheet, as the view sees it without its
    /// breaks.
    pub(crate) fn plane_from_sheet(&self, at: DVec2) -> DVec2 {
        let off = (at - self.origin) / self.factor;
        self.breaks.seen_at(DVec2::new(off.x, -off.y))
    }

    /// Returns a point of the model on the sheet, millimetres; `None` if it is in front of the near plane of a
    /// perspective view, or the camera is not known.
    pub fn sheet_from_model(&self, p: DVec3) -> Option<DVec2> {
        let camera = self.camera.as_ref()?;
        let plane = PicturePlane::of_camera(camera, 1.0).ok()?;
        let seen = match camera.projection {
            Projection::Orthographic { .. } => Some(plane.plane_from_world(p).at),
            Projection::Perspective { .. } => plane.project(p),
        };
        seen.map(|at| self.sheet_from_plane(self.breaks.drawn_at(at))).filter(|at| at.is_finite())
    }
}
