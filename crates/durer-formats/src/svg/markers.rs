//! The positions of a path's markers, and their directions.
//!
//! Source: *SVG 2*, W3C, § 13.7.4 and § 9.5.1 (directions of vertices); unspecified cases as in Chromium. usvg treats
//! each curve of an arc as a segment, and closed paths as open ones.

use super::arcs;
use crate::arc::Ends;
use durer::math::DVec2;
use std::fmt::Write as _;
use svgtypes::{PathParser, PathSegment};

/// A corner of a path and its direction in radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Vertex {
    pub at: DVec2,
    pub angle: f64,
}

/// A segment: its end point, and its directions at both ends, if it has a length.
#[derive(Debug, Clone, Copy)]
struct Segment {
    end: DVec2,
    begins: Option<DVec2>,
    ends: Option<DVec2>,
}

impl Segment {
    /// Builds a curve through those points, from the first to the last one.
    fn new<const N: usize>(points: [DVec2; N]) -> Self {
        let end = points[N - 1];
        let begins = points.iter().map(|p| *p - points[0]).find(|way| *way != DVec2::ZERO);
        let ends = points.iter().rev().map(|p| end - *p).find(|way| *way != DVec2::ZERO);
        Self { end, begins, ends }
    }
}

#[derive(Debug, Default)]
struct Subpath {
    start: DVec2,
    segments: Vec<Segment>,
    is_closed: bool,
}

impl Subpath {
    /// Returns the corners in order; a closed path repeats the first one at its end.
    fn vertices(&self) -> Vec<Vertex> {
        let count = self.segments.len();
        let mut ways = vec![None; count + 1];
        let (mut before, mut after) = (vec![None; count + 1], vec![None; count + 1]);
        for (i, segment) in self.segments.iter().enumerate() {
            // A segment without length continues the direction of the one before.
            before[i + 1] = segment.ends.or(before[i]);
        }
        for (i, segment) in self.segments.iter().enumerate().rev() {
            after[i] = segment.begins.or(after[i + 1]);
        }
        if self.is_closed {
            (before[0], after[count]) = (before[count], after[0]);
        }
        for (way, (before, after)) in ways.iter_mut().zip(before.into_iter().zip(after)) {
            *way = between(before, after);
        }
        let points = std::iter::once(self.start).chain(self.segments.iter().map(|s| s.end));
        points.zip(ways).map(|(at, way)| Vertex { at, angle: way.unwrap_or(0.0) }).collect()
    }
}

/// Returns the angle half-way between two directions.
fn between(before: Option<DVec2>, after: Option<DVec2>) -> Option<f64> {
    let angle = |way: DVec2| libm::atan2(way.y, way.x);
    let (Some(a), Some(b)) = (before, after) else { return before.or(after).map(angle) };
    // In browsers, a turn from straight right to straight left points up, and the opposite one down.
    let b = if b.y == 0.0 { DVec2::new(b.x, -0.0) } else { b };
    let (mut a, b) = (angle(a), angle(b));
    if (a - b).abs() > std::f64::consts::PI {
        a += std::f64::consts::TAU;
    }
    Some((a + b) / 2.0)
}

/// Returns the vertices of path data, in order.
pub(super) fn vertices(data: &str) -> Vec<Vertex> {
    let mut found = Vec::new();
    let mut subpath = Subpath::default();
    let mut at = DVec2::ZERO;
    // The last control point, for smooth continuations: of a cubic and of a quadratic curve.
    let mut controls: [Option<DVec2>; 2] = [None; 2];
    for segment in PathParser::from(data).map_while(Result::ok) {
        use PathSegment::*;
        let here = at;
        let point = |abs: bool, x: f64, y: f64| {
            if abs { DVec2::new(x, y) } else { here + DVec2::new(x, y) }
        };
        let smooth = |control: Option<DVec2>| control.map_or(here, |control| here * 2.0 - control);
        let mut next = [None; 2];
        let made = match segment {
            MoveTo { abs, x, y } => {
                if !subpath.segments.is_empty() {
                    found.extend(subpath.vertices());
                }
                at = point(abs, x, y);
                subpath = Subpath { start: at, ..Subpath::default() };
                controls = next;
                continue;
            }
            LineTo { abs, x, y } => Segment::new([here, point(abs, x, y)]),
            HorizontalLineTo { abs, x } => {
                Segment::new([here, DVec2::new(point(abs, x, 0.0).x, here.y)])
            }
            VerticalLineTo { abs, y } => {
                Segment::new([here, DVec2::new(here.x, point(abs, 0.0, y).y)])
            }
            CurveTo { abs, x1, y1, x2, y2, x, y } => {
                next[0] = Some(point(abs, x2, y2));
                Segment::new([here, point(abs, x1, y1), point(abs, x2, y2), point(abs, x, y)])
            }
            SmoothCurveTo { abs, x2, y2, x, y } => {
                next[0] = Some(point(abs, x2, y2));
                Segment::new([here, smooth(controls[0]), point(abs, x2, y2), point(abs, x, y)])
            }
            Quadratic { abs, x1, y1, x, y } => {
                next[1] = Some(point(abs, x1, y1));
                Segment::new([here, point(abs, x1, y1), point(abs, x, y)])
            }
            SmoothQuadratic { abs, x, y } => {
                next[1] = Some(smooth(controls[1]));
                Segment::new([here, smooth(controls[1]), point(abs, x, y)])
            }
            EllipticalArc { abs, rx, ry, x_axis_rotation, large_arc, sweep, x, y } => {
                let (radii, turned) = (DVec2::new(rx, ry), x_axis_rotation.to_radians());
                let to = point(abs, x, y);
                arc(&Ends { from: here, to, radii, turned, large: large_arc, sweep })
            }
            ClosePath { .. } => {
                subpath.is_closed = true;
                Segment::new([here, subpath.start])
            }
        };
        controls = next;
        at = made.end;
        // After a close, a new subpath begins at the same place.
        if subpath.is_closed && !matches!(segment, ClosePath { .. }) {
            let start = subpath.start;
            found.extend(std::mem::take(&mut subpath).vertices());
            found.pop();
            subpath.start = start;
        }
        subpath.segments.push(made);
    }
    if !subpath.segments.is_empty() {
        found.extend(subpath.vertices());
    }
    found
}

fn arc(ends: &Ends) -> Segment {
    let (mut first, mut last) = (None, None);
    let is_arc = arcs::curves(ends, |points| {
        first.get_or_insert(points);
        last = Some(points);
    });
    match (is_arc, first, last) {
        (Some(()), Some([control, ..]), Some([_, before, end])) => {
            let (begins, ends) = (Some(control - ends.from), Some(end - before));
            Segment { end, begins, ends }
        }
        _ => Segment::new([ends.from, ends.to]),
    }
}

/// Returns paths that show only one marker each, at their middle, along the direction of a vertex.
pub(super) fn paths(
    vertices: &[Vertex],
    [start, mid, end]: [Option<&str>; 3],
    is_reversed: bool,
) -> String {
    let mut out = String::new();
    let last = vertices.len().saturating_sub(1);
    for (i, vertex) in vertices.iter().enumerate() {
        let ends = [(i == 0, start), (i == last, end), (i > 0 && i < last, mid)];
        for (_, marker) in ends.into_iter().filter(|(is_here, _)| *is_here) {
            let Some(marker) = marker else { continue };
            let (sin, cos) = libm::sincos(vertex.angle);
            let way =
                if i == 0 && is_reversed { DVec2::new(-cos, -sin) } else { DVec2::new(cos, sin) };
            let (a, p, b) = (vertex.at - way, vertex.at, vertex.at + way);
            let mut link = String::new();
            super::write::escape(marker, true, &mut link);
            // Writing to a string cannot fail.
            let _ = write!(
                out,
                "<path d=\"M{} {}L{} {}L{} {}\" fill=\"none\" stroke=\"none\" marker-start=\"none\" marker-end=\"none\" marker-mid=\"{link}\"></path>",
                a.x, a.y, p.x, p.y, b.x, b.y
            );
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(data: &str) -> Vec<(f64, f64, i32)> {
        vertices(data)
            .iter()
            .map(|v| (v.at.x, v.at.y, v.angle.to_degrees().round() as i32))
            .collect()
    }

    #[test]
    fn directions_are_half_way_between_segments() {
        assert_eq!(of("M0 0H10V10"), [(0.0, 0.0, 0), (10.0, 0.0, 45), (10.0, 10.0, 90)]);
        // Closed: the first and the last vertex have the same direction.
        assert_eq!(
            of("M0 0H10V10H0Z"),
            [
                (0.0, 0.0, -45),
                (10.0, 0.0, 45),
                (10.0, 10.0, 135),
                (0.0, 10.0, 225),
                (0.0, 0.0, -45)
            ]
        );
        // An arc has no vertices except its ends.
        assert_eq!(of("M0 0A5 5 0 0 1 10 0"), [(0.0, 0.0, -90), (10.0, 0.0, 90)]);
        // Control points at the ends give no direction.
        assert_eq!(of("M0 0C0 0 10 10 10 10"), [(0.0, 0.0, 45), (10.0, 10.0, 45)]);
        assert_eq!(
            of("M0 0H5H5H10"),
            [(0.0, 0.0, 0), (5.0, 0.0, 0), (5.0, 0.0, 0), (10.0, 0.0, 0)]
        );
        assert_eq!(of("M0 0q5 0 5 5t5 5").len(), 3);
        assert_eq!(
            of("M0 0H9M1 1V9"),
            [(0.0, 0.0, 0), (9.0, 0.0, 0), (1.0, 1.0, 90), (1.0, 9.0, 90)]
        );
        assert_eq!(of("M0 0H9V9ZH5").len(), 5);
        assert_eq!(of("M0 0H9Z"), [(0.0, 0.0, 90), (9.0, 0.0, -90), (0.0, 0.0, 90)]);
        assert_eq!(of("M1 1"), []);
    }
}
