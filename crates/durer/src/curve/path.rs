//! Outlines of lines, Bézier curves and arcs, for fills, strokes, clip paths and glyphs.

use crate::math::{DAffine2, DVec2, Rect};

/// One element of a path; points are in the path's own space, usually pixels with y down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PathElement {
    /// Starts a new contour.
    MoveTo(DVec2),
    /// A straight line to a point.
    LineTo(DVec2),
    /// A quadratic Bézier curve: control point, end point.
    QuadTo(DVec2, DVec2),
    /// A cubic Bézier curve: two control points, end point.
    CubicTo(DVec2, DVec2, DVec2),
    /// Back to the contour's start.
    Close,
}

/// A sequence of contours. An element before the first `MoveTo` starts a contour at its own end point.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Path {
    elements: Vec<PathElement>,
}

/// Distance of the control points of a quarter circle of radius 1, for the least radial error (2.7e-4).
const QUARTER_CIRCLE: f64 = 0.552_284_749_830_793_4;

impl Path {
    /// Creates a path without elements.
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns the elements in order.
    pub fn elements(&self) -> &[PathElement] {
        &self.elements
    }

    /// Returns whether there is nothing in it.
    pub fn is_empty(&self) -> bool {
        self.elements.is_empty()
    }

    /// Appends one element.
    pub fn push(&mut self, element: PathElement) -> &mut Self {
        self.elements.push(element);
        self
    }

    /// Starts a new contour at (x, y).
    pub fn move_to(&mut self, x: f64, y: f64) -> &mut Self {
        self.push(PathElement::MoveTo(DVec2::new(x, y)))
    }

    /// Appends a straight line to (x, y).
    pub fn line_to(&mut self, x: f64, y: f64) -> &mut Self {
        self.push(PathElement::LineTo(DVec2::new(x, y)))
    }

    /// Appends a quadratic curve with control point (cx, cy) to (x, y).
    pub fn quad_to(&mut self, cx: f64, cy: f64, x: f64, y: f64) -> &mut Self {
        self.push(PathElement::QuadTo(DVec2::new(cx, cy), DVec2::new(x, y)))
    }

    /// Appends a cubic curve to the third point.
    pub fn cubic_to(&mut self, a: DVec2, b: DVec2, end: DVec2) -> &mut Self {
        self.push(PathElement::CubicTo(a, b, end))
    }

    /// Closes the contour with a line back to its start.
    pub fn close(&mut self) -> &mut Self {
        self.push(PathElement::Close)
    }

    /// Appends all elements of another path.
    pub fn extend(&mut self, other: &Self) -> &mut Self {
        self.elements.extend_from_slice(&other.elements);
        self
    }

    /// Creates a closed polygon.
    pub fn polygon(points: impl IntoIterator<Item = DVec2>) -> Self {
        let mut path = Self::polyline(points);
        if !path.is_empty() {
            path.close();
        }
        path
    }

    /// Creates an open chain of lines.
    pub fn polyline(points: impl IntoIterator<Item = DVec2>) -> Self {
        let mut path = Self::new();
        for (i, p) in points.into_iter().enumerate() {
            path.push(if i == 0 { PathElement::MoveTo(p) } else { PathElement::LineTo(p) });
        }
        path
    }

    /// Creates a rectangle, from its upper left corner to the right first.
    pub fn rectangle(x: f64, y: f64, width: f64, height: f64) -> Self {
        let (right, bottom) = (x + width, y + height);
        let corners = [(x, y), (right, y), (right, bottom), (x, bottom)];
        Self::polygon(corners.map(|(x, y)| DVec2::new(x, y)))
    }

    /// Creates a circle as four cubic curves; radial error below 0.03 % of the radius.
    pub fn circle(center: DVec2, radius: f64) -> Self {
        Self::ellipse(center, DVec2::splat(radius))
    }

    /// Creates an ellipse with its axes parallel to the coordinate axes, as four cubic curves.
    pub fn ellipse(center: DVec2, radii: DVec2) -> Self {
        let at = |x: f64, y: f64| center + radii * DVec2::new(x, y);
        let k = QUARTER_CIRCLE;
        let mut path = Self::new();
        path.push(PathElement::MoveTo(at(1.0, 0.0)));
        path.cubic_to(at(1.0, k), at(k, 1.0), at(0.0, 1.0));
        path.cubic_to(at(-k, 1.0), at(-1.0, k), at(-1.0, 0.0));
        path.cubic_to(at(-1.0, -k), at(-k, -1.0), at(0.0, -1.0));
        path.cubic_to(at(k, -1.0), at(1.0, -k), at(1.0, 0.0));
        path.close();
        path
    }

    /// Appends a circular arc angle `start` over `sweep` radians (positive turns x towards y), as cubic curves of at
    /// most a quarter turn each. Appends a line to its start where a contour is open.
    pub fn arc(&mut self, center: DVec2, radius: f64, start: f64, sweep: f64) -> &mut Self {
        let turns = sweep.clamp(-std::f64::consts::TAU, std::f64::consts::TAU);
        let pieces = (turns.abs() / std::f64::consts::FRAC_PI_2).ceil().max(1.0) as u32;
        let step = turns / f64::from(pieces);
        let k = 4.0 / 3.0 * libm::tan(step / 4.0);
        let unit = |angle: f64| DVec2::new(libm::cos(angle), libm::sin(angle));
        let first = center + radius * unit(start);
        self.push(match self.elements.last() {
            None | Some(PathElement::Close) => PathElement::MoveTo(first),
            Some(_) => PathElement::LineTo(first),
        });
        for i in 0..pieces {
            let (from, to) =
                (unit(start + step * f64::from(i)), unit(start + step * f64::from(i + 1)));
            let a = center + radius * (from + k * from.perp());
            let b = center + radius * (to - k * to.perp());
            self.cubic_to(a, b, center + radius * to);
        }
        self
    }

    /// Returns the path with every point mapped
    pub fn transformed(&self, map: DAffine2) -> Self {
        use PathElement::{Close, CubicTo, LineTo, MoveTo, QuadTo};
        let at = |p: DVec2| map.transform_point2(p);
        let elements = self.elements.iter().map(|e| match *e {
            MoveTo(p) => MoveTo(at(p)),
            LineTo(p) => LineTo(at(p)),
            QuadTo(c, p) => QuadTo(at(c), at(p)),
            CubicTo(a, b, p) => CubicTo(at(a), at(b), at(p)),
            Close => Close,
        });
        Self { elements: elements.collect() }
    }

    /// Returns the smallest rectangle around all finite points and control points; it contains the
    /// curves.
    pub fn bounds(&self) -> Option<Rect> {
        use PathElement::{Close, CubicTo, LineTo, MoveTo, QuadTo};
        Rect::around(self.elements.iter().flat_map(|e| {
            let (points, count) = match *e {
                MoveTo(p) | LineTo(p) => ([p; 3], 1),
                QuadTo(c, p) => ([c, p, p], 2),
                CubicTo(a, b, p) => ([a, b, p], 3),
                Close => ([DVec2::ZERO; 3], 0),
            };
            points.into_iter().take(count)
        }))
    }
}
