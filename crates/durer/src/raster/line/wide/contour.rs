//! Contours of a path as chains of straight pieces that know their directions.

use crate::curve::{PathElement, chain};
use crate::math::DVec2;

/// Points nearer to the one before than this share of the tolerance are left out: rounding would choose their
/// direction.
const NEAR: f64 = 1e-6;

/// Control points nearer to a curve's end than this share of the tolerance do not give its direction.
const NEAR_END: f64 = 1e-3;

/// A straight piece of a contour.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    /// Its direction, of length 1.
    pub along: DVec2,
    pub length: f64,
}

/// Point where two pieces meet, or a contour ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vertex {
    pub at: DVec2,
    /// Corner at the end of an element: the directions of the path before and after it.
    pub corner: Option<(DVec2, DVec2)>,
}

/// A contour: vertex i, piece i, vertex i + 1, …; in a closed one the last piece leads to the first vertex.
#[derive(Debug, Default)]
pub(super) struct Contour {
    pub vertices: Vec<Vertex>,
    pub pieces: Vec<Piece>,
    pub closed: bool,
    /// True if anything was drawn, though perhaps without length.
    pub drawn: bool,
}

impl Contour {
    /// Reverses the contour, so that it goes from its end to its start.
    pub fn reverse(&mut self) {
        let fixed = usize::from(self.closed);
        if let Some(vertices) = self.vertices.get_mut(fixed..) {
            vertices.reverse();
        }
        for vertex in &mut self.vertices {
            vertex.corner = vertex.corner.map(|(before, after)| (-after, -before));
        }
        self.pieces.reverse();
        self.pieces.iter_mut().for_each(|piece| piece.along = -piece.along);
    }

    fn clear(&mut self) {
        self.vertices.clear();
        self.pieces.clear();
        (self.closed, self.drawn) = (false, false);
    }

    fn start(&mut self, at: DVec2) {
        self.clear();
        self.vertices.push(Vertex { at, corner: None });
    }

    /// Appends an element, given its points after the start and its directions at both ends.
    fn element(&mut self, points: &[DVec2], ends: impl Fn() -> [Option<DVec2>; 2], near: f64) {
        self.drawn = true;
        let first = self.pieces.len();
        for point in points {
            self.piece(*point, near);
        }
        let Some(pieces) = self.pieces.get(first..) else { return };
        let ([Some(start), Some(end)], [leave, arrive]) =
            ([pieces.first(), pieces.last()].map(|p| p.map(|p| p.along)), ends())
        else {
            return;
        };
        let (leave, arrive) = (leave.unwrap_or(start), arrive.unwrap_or(end));
        if let Some(vertex) = self.vertices.get_mut(first) {
            // The direction before the element; at the start of the contour, its own, so that nothing turns.
            let before = vertex.corner.map_or(leave, |c| c.0);
            vertex.corner = Some((before, leave));
        }
        if let Some(vertex) = self.vertices.last_mut() {
            vertex.corner = Some((arrive, arrive));
        }
    }

    fn piece(&mut self, to: DVec2, near: f64) {
        let Some(from) = self.vertices.last().map(|v| v.at) else { return };
        let length = from.distance(to);
        if length > near {
            self.pieces.push(Piece { along: (to - from) / length, length });
            self.vertices.push(Vertex { at: to, corner: None });
        }
    }

    /// Closes the contour, back to its start.
    fn close(&mut self, near: f64) {
        (self.closed, self.drawn) = (true, true);
        let (Some(first), Some(last)) = (self.vertices.first().copied(), self.vertices.last())
        else {
            return;
        };
        if last.at.distance(first.at) > near {
            self.element(&[first.at], || [None; 2], near);
        }
        // The start is the end, too.
        let end = if self.pieces.is_empty() { None } else { self.vertices.pop() };
        if let (Some(end), Some(start)) = (end, self.vertices.first_mut()) {
            let (before, after) = (end.corner.map(|c| c.0), first.corner.map(|c| c.1));
            start.corner = before.zip(after);
        }
    }
}

/// Calls `stroke` for every contour of a path of finite points.
pub(super) fn each(
    elements: impl Iterator<Item = PathElement>,
    tolerance: f64,
    mut stroke: impl FnMut(&mut Contour),
) {
    let (mut contour, mut points, mut at) = (Contour::default(), Vec::new(), DVec2::ZERO);
    let near = tolerance * NEAR;
    for element in elements {
        match element {
            PathElement::MoveTo(p) => {
                stroke(&mut contour);
                contour.start(p);
                at = p;
            }
            PathElement::Close => {
                contour.close(near);
                stroke(&mut contour);
                contour.clear();
            }
            PathElement::LineTo(p) | PathElement::QuadTo(_, p) | PathElement::CubicTo(_, _, p) => {
                points.clear();
                chain(at, &element, tolerance, &mut points);
                contour.element(&points, || directions(at, &element, tolerance * NEAR_END), near);
                at = p;
            }
        }
    }
    stroke(&mut contour);
}

/// Returns the directions of a curve at its ends; `None` for a line.
fn directions(a: DVec2, element: &PathElement, near: f64) -> [Option<DVec2>; 2] {
    let points = match *element {
        PathElement::QuadTo(b, c) => [a, b, b, c],
        PathElement::CubicTo(b, c, d) => [a, b, c, d],
        _ => return [None; 2],
    };
    let [a, b, c, d] = points;
    let first = |ways: [DVec2; 3]| {
        ways.into_iter().find(|way| way.length() > near).and_then(DVec2::try_normalize)
    };
    [first([b - a, c - a, d - a]), first([d - c, d - b, d - a])]
}
