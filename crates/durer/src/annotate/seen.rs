//! A view on the sheet, as annotations need it.

use crate::math::{DVec2, DVec3, Rect};
use crate::paper::PlacedView;
use crate::scene::Projection;
use crate::sorting::CompactSort;
use crate::target::drawing::{Drawing, Line, LineClass};
use crate::visibility::object::Cylinder;

/// Directions are one, or at right angles, up to this sine: 0.2°.
const STRAIGHT: f64 = 3.5e-3;

/// A parallel view.
pub(super) struct Seen<'a> {
    pub placed: &'a PlacedView,
    /// Directions to the right, up, and away from the eye, of unit length.
    axes: [DVec3; 3],
    /// The points of the lines that are drawn, millimetres, sorted by x.
    points: Vec<DVec2>,
    /// Bounds of the drawing, in the sheet's millimetres.
    bounds: Rect,
}

/// Appearance of a direction in a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Sight {
    /// Seen as a point.
    EndOn,
    /// In its true length, in this direction on the sheet.
    Along(DVec2),
    /// Shortened, in this direction on the sheet.
    Oblique(DVec2),
}

impl<'a> Seen<'a> {
    /// Creates a view of a drawing; `None` in perspective, or without a camera. Hidden lines count if they are drawn.
    pub fn new(placed: &'a PlacedView, drawing: &Drawing, hidden: bool) -> Option<Self> {
        let camera = placed.camera.as_ref()?;
        if !matches!(camera.projection, Projection::Orthographic { .. }) {
            return None;
        }
        let [right, up, back] = camera.axes();
        // Break lines extend beyond the parts that they cut.
        let shown = |l: &&Line| (hidden || l.is_visible()) && l.class != LineClass::Break;
        let lines = drawing.lines.iter().filter(shown);
        let points = lines.flat_map(|l| &l.points).map(|p| placed.sheet_from_plane(*p));
        let mut points: Vec<DVec2> = points.filter(|p| p.is_finite()).collect();
        points.compact_sort_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
        points.dedup();
        let drawn =
            drawing.bounds().map(|b| [b.min(), b.max()].map(|p| placed.sheet_from_plane(p)));
        let bounds = drawn.and_then(Rect::around).unwrap_or(placed.bounds);
        Some(Self { placed, axes: [right, up, -back], points, bounds })
    }

    pub fn bounds(&self) -> Rect {
        self.bounds
    }

    /// Returns the millimetres of the sheet per unit of the model.
    pub fn factor(&self) -> f64 {
        self.placed.factor
    }

    /// Returns a point of the world on the sheet.
    pub fn point(&self, p: DVec3) -> DVec2 {
        self.placed.sheet_from_model(p).unwrap_or(DVec2::NAN)
    }

    /// Returns the length between two places of the sheet along a direction, in units of the model, including the parts
    /// that breaks leave out.
    pub fn length(&self, ends: [DVec2; 2], way: DVec2) -> f64 {
        let [from, to] = ends.map(|p| self.placed.plane_from_sheet(p));
        (to - from).dot(DVec2::new(way.x, -way.y))
    }

    /// Returns a direction of the world on the sheet, no longer of unit length.
    pub fn way(&self, direction: DVec3) -> DVec2 {
        DVec2::new(direction.dot(self.axes[0]), -direction.dot(self.axes[1]))
    }

    pub fn sight(&self, direction: DVec3) -> Sight {
        let (way, depth) = (self.way(direction), direction.dot(self.axes[2]).abs());
        if way.length() < STRAIGHT {
            Sight::EndOn
        } else if depth < STRAIGHT {
            Sight::Along(way.normalize_or_zero())
        } else {
            Sight::Oblique(way.normalize_or_zero())
        }
    }

    /// Returns whether one of the world's axes is seen as a point: a view from a side.
    pub fn is_from_a_side(&self) -> bool {
        [DVec3::X, DVec3::Y, DVec3::Z].iter().any(|a| self.sight(*a) == Sight::EndOn)
    }

    /// Returns the circle of a cylinder that is seen in its true shape: its centre and radius on the sheet;
    /// `None` if the axis is not seen end-on, or nothing of the circle is drawn.
    pub fn circle(&self, cylinder: &Cylinder) -> Option<(DVec2, f64)> {
        if self.sight(cylinder.axis()) != Sight::EndOn {
            return None;
        }
        let center = self.point((cylinder.ends[0] + cylinder.ends[1]) * 0.5);
        let radius = cylinder.radius * self.factor();
        self.has_circle(center, radius).then_some((center, radius))
    }

    /// Returns whether a line has a corner at a place.
    pub fn has_point(&self, at: DVec2) -> bool {
        let start = self.points.partition_point(|p| p.x < at.x - 0.05);
        let near = self.points[start..].iter().take_while(|p| p.x <= at.x + 0.05);
        near.into_iter().any(|p| (p.y - at.y).abs() <= 0.05)
    }

    /// Returns whether the points of the lines lie on a circle: at least three of them, not all in one
    /// half of it.
    fn has_circle(&self, center: DVec2, radius: f64) -> bool {
        let tolerance = (radius * 5e-3).max(0.01);
        let reach = radius + tolerance;
        let start = self.points.partition_point(|p| p.x < center.x - reach);
        let near = self.points[start..].iter().take_while(|p| p.x <= center.x + reach);
        let mut quadrants = [0u32; 4];
        for spoke in near.map(|p| *p - center) {
            if (spoke.length() - radius).abs() <= tolerance {
                quadrants[usize::from(spoke.x < 0.0) + 2 * usize::from(spoke.y < 0.0)] += 1;
            }
        }
        quadrants.iter().sum::<u32>() >= 5 && quadrants.iter().filter(|q| **q > 0).count() >= 2
    }

    /// Returns the point of the lines that is farthest in a direction of the sheet, and among those the
    /// farthest in another.
    pub fn farthest(&self, way: DVec2, then: DVec2) -> Option<DVec2> {
        let most = self.points.iter().map(|p| p.dot(way)).fold(f64::NEG_INFINITY, f64::max);
        // A hundredth of a millimetre is nothing on paper.
        let border = self.points.iter().filter(|p| p.dot(way) >= most - 0.01);
        border.copied().max_by(|p, q| p.dot(then).total_cmp(&q.dot(then)))
    }
}
