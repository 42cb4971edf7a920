//! Details: a part of a view within a circle, enlarged.

use super::marks::{Annotator, LETTER, circle};
use super::{SheetView, ViewKind};
use crate::Result;
use crate::clip::polygon::overlay::{self, overlay};
use crate::clip::polygon::{BooleanOp, Shapes, WindingRule};
use crate::math::{DVec2, Rect};
use crate::paper::parts::parts;
use crate::paper::{PlacedView, ViewBreaks, standard_scale};
use crate::scene::{Camera, Projection};
use crate::target::drawing::{Drawing, Line, Region};
use crate::trace::NoTrace;

/// A part of a view.
#[derive(Debug, Clone, PartialEq)]
pub struct Detail {
    /// Letter that names it, e.g. `B`.
    pub letter: String,
    /// Index of the view that it is a part of.
    pub of: usize,
    /// The middle of the circle around it, in the plane of that view.
    pub center: DVec2,
    /// The radius of the circle, in the model's units; above 0.
    pub radius: f64,
    /// Length on paper over true length; `None` takes a standard scale, at least twice that of the other views.
    pub scale: Option<f64>,
}

/// A detail whose scale is not given is at most so wide on paper, millimetres, if it can be.
const DIAMETER: f64 = 50.0;

impl Detail {
    /// Returns the part of a drawing within the circle: lines and filled parts are clipped to it; labels stay if their
    /// points are inside.
    ///
    /// # Errors
    /// [`crate::Error::NonFinite`] for regions with a corner that is not finite.
    pub fn cut(&self, drawing: &Drawing) -> Result<Drawing> {
        let mut regions = Vec::new();
        for region in &drawing.regions {
            regions.extend(self.cut_region(region)?);
        }
        let (mut lines, mut nearness) = (Vec::new(), Vec::new());
        for (i, line) in drawing.lines.iter().enumerate() {
            lines.extend(self.cut_line(line));
            if let Some(near) = drawing.nearness.get(i) {
                nearness.resize(lines.len(), *near);
            }
        }
        let within = |p: DVec2| p.distance(self.center) <= self.radius;
        let labels = drawing.labels.iter().filter(|l| within(l.at)).cloned().collect();
        let window = Some(self.bounds());
        Ok(Drawing { window, regions, lines, labels, nearness, edges: drawing.edges })
    }

    /// Returns the camera of its view, which is parallel, moved and narrowed to what the detail shows, and the origin of
    /// the new camera's plane in that of the view before it was broken.
    pub fn camera(&self, view: &Camera, breaks: &ViewBreaks) -> (Camera, DVec2) {
        let bounds = self.bounds();
        let (min, max) = (bounds.min(), bounds.max());
        let corners = [min, max, DVec2::new(min.x, max.y), DVec2::new(max.x, min.y)];
        let seen = Rect::around(corners.map(|at| breaks.seen_at(at))).unwrap_or(bounds);
        let (middle, size) = (seen.min().midpoint(seen.max()), seen.max() - seen.min());
        let [right, up, _] = view.axes();
        let way = right * middle.x + up * middle.y;
        let projection = Projection::Orthographic { height: size.max_element() };
        (Camera { eye: view.eye + way, target: view.target + way, projection, ..*view }, middle)
    }

    fn cut_region(&self, region: &Region) -> Result<Option<Region>> {
        let points = || region.rings.iter().flatten().copied();
        if !Rect::around(points()).is_some_and(|b| b.overlaps(&self.bounds())) {
            return Ok(None);
        }
        let (mut subject, mut disc) = (Shapes::new(), Shapes::new());
        region.rings.iter().for_each(|r| subject.push_ring(r.iter().copied()));
        subject.end_polygon();
        disc.push_ring(circle(self.center, self.radius));
        disc.end_polygon();
        let rule = overlay::Options::with_rule(WindingRule::NonZero);
        let cut = overlay(&subject, &disc, BooleanOp::Intersection, &rule, &mut NoTrace)?.shapes;
        let rings: Vec<Vec<DVec2>> = cut.rings().map(<[DVec2]>::to_vec).collect();
        Ok((!rings.is_empty()).then(|| Region { rings, ..region.clone() }))
    }

    /// Returns the parts of a line within the circle.
    fn cut_line(&self, line: &Line) -> Vec<Line> {
        let within = |p: &DVec2| p.distance(self.center) <= self.radius;
        if line.points.iter().all(within) {
            return vec![line.clone()];
        }
        parts(line, |a, b| self.cut_segment(a, b))
    }

    /// Returns the part of a segment within the circle; ends within it stay as they are.
    fn cut_segment(&self, a: DVec2, b: DVec2) -> Option<[DVec2; 2]> {
        let (way, from) = (b - a, a - self.center);
        let (square, half) = (way.length_squared(), way.dot(from));
        let root = half * half - square * (from.length_squared() - self.radius * self.radius);
        if !(square > 0.0 && root > 0.0) {
            return None;
        }
        let (enter, leave) = ((-half - root.sqrt()) / square, (-half + root.sqrt()) / square);
        let point = |t: f64| a + way * t;
        let start = if enter <= 0.0 { a } else { point(enter) };
        let end = if leave >= 1.0 { b } else { point(leave) };
        (enter < 1.0 && leave > 0.0 && start != end).then_some([start, end])
    }

    /// Returns the square around the circle.
    pub(super) fn bounds(&self) -> Rect {
        let reach = DVec2::splat(self.radius);
        let around = Rect::around([self.center - reach, self.center + reach]);
        around.unwrap_or_else(|| crate::paper::frame_of(&Drawing::default(), Default::default()))
    }

    /// Returns its scale, beside views with another one; `unit` is millimetres per unit of the
    /// model.
    pub(super) fn scale_beside(&self, scale: f64, unit: f64) -> f64 {
        self.scale.unwrap_or_else(|| {
            let wide = standard_scale(DIAMETER / (2.0 * self.radius * unit));
            // The standard scales are 2 or 2.5 times as large as the next smaller one.
            wide.max(standard_scale(scale * 2.5))
        })
    }
}

/// Draws the circles of all details, around the enlarged views and around the parts that they show: layer `details`.
pub fn put(annotator: &mut Annotator, views: &[SheetView], placed: &[PlacedView]) {
    for (view, place) in views.iter().zip(placed) {
        let ViewKind::Detail(detail) = &view.kind else { continue };
        annotator.circle(place.sheet_from_plane(detail.center), detail.radius * place.factor);
        let Some((parent, at)) = views.get(detail.of).zip(placed.get(detail.of)) else { continue };
        let (center, radius) = (at.sheet_from_plane(detail.center), detail.radius * at.factor);
        annotator.circle(center, radius);
        let letter = letter_place(parent.drawing, at, center, radius);
        annotator.letters(letter, &detail.letter, LETTER);
    }
    annotator.end_layer("details");
}

/// Half the side of the square that a letter takes up, with space around it, millimetres.
const LETTER_ROOM: f64 = LETTER * 0.7;

/// Returns a place beside a circle for its letter: of eight around it the first that fewest lines go
/// through.
fn letter_place(drawing: &Drawing, view: &PlacedView, center: DVec2, radius: f64) -> DVec2 {
    let places = [1, 3, 7, 5, 0, 4, 2, 6].map(|eighth: u32| {
        let turn = f64::from(eighth) * std::f64::consts::FRAC_PI_4;
        let out = DVec2::new(libm::cos(turn), -libm::sin(turn));
        center + out * (radius + LETTER_ROOM * 1.2)
    });
    let crossed = |at: &DVec2| {
        let reach = DVec2::splat(LETTER_ROOM);
        let Ok(square) = Rect::new(*at - reach, *at + reach) else { return usize::MAX };
        let lines = drawing.lines.iter().filter(|l| l.is_visible());
        let sides = lines.flat_map(|l| l.points.windows(2));
        let on_sheet = sides.map(|w| [view.sheet_from_plane(w[0]), view.sheet_from_plane(w[1])]);
        on_sheet.filter(|[a, b]| crate::clip::line::cut_inside(&square, *a, *b).is_some()).count()
    };
    // Of equals the first.
    places.into_iter().min_by_key(crossed).unwrap_or(center)
}
