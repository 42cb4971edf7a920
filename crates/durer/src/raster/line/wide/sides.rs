//! The walk along the sides of a contour, which makes the outline.
//!
//! Between a vertex and the next, outline and piece enclose a strip that turns the same way on both sides; where the
//! outline passes through vertices its strips are the rectangles of the pieces. On the inner side of a corner the two
//! offset lines may be cut where they meet as long as that removes at most half of either piece: the area cut from one
//! strip is nearer to the other piece and inside its rectangle, so repeating the argument, every point of the stroke is
//! in some strip that was not cut there. Within curves the wedges on the inner side belong to the stroke, too: the area
//! that the pen sweeps beyond the centre of a tight bend is near only to the ends of the curve.

use super::contour::{Contour, Piece, Vertex};
use super::{Cap, Join, Step, Stroke, StrokePart};
use crate::curve::Contours;
use crate::math::DVec2;
use crate::trace::Tracer;

/// Largest number of points of a full turn: with widths of millions of pixels the tolerance is exceeded instead.
const MAX_ARC: f64 = 8192.0;

/// Tool that draws contours.
pub(super) struct Pen<'a, T> {
    half: f64,
    cap: Cap,
    pub join: Join,
    /// Square of the miter limit.
    miter: f64,
    tolerance: f64,
    /// Largest turn of an arc from point to point, and the square of 1 / cos of its half.
    arc: f64,
    secant: f64,
    ring: Vec<DVec2>,
    out: &'a mut Contours,
    t: &'a mut T,
}

impl<'a, T: Tracer<Step>> Pen<'a, T> {
    pub fn new(stroke: &Stroke, tolerance: f64, out: &'a mut Contours, t: &'a mut T) -> Self {
        let half = stroke.width / 2.0;
        // The points of arcs are outside the circle: their chords touch it.
        let cosine = half / (half + tolerance);
        let arc = (2.0 * libm::acos(cosine)).max(std::f64::consts::TAU / MAX_ARC);
        let cosine = libm::cos(arc / 2.0);
        Self {
            half,
            cap: stroke.cap,
            join: stroke.join,
            miter: stroke.miter_limit * stroke.miter_limit,
            tolerance,
            arc,
            secant: 1.0 / (cosine * cosine),
            ring: Vec::new(),
            out,
            t,
        }
    }

    /// Appends the outline of a contour, which may be changed, and passes the outline so far to `part`.
    pub fn stroke(&mut self, contour: &mut Contour, part: &mut impl FnMut(&mut Contours)) {
        self.append(contour);
        part(&mut *self.out);
    }

    fn append(&mut self, contour: &mut Contour) {
        let Some(start) = contour.vertices.first().copied().filter(|_| contour.drawn) else {
            return;
        };
        if contour.pieces.is_empty() {
            if self.cap != Cap::Butt {
                self.begin();
                self.cap(start.at, DVec2::X, false);
                self.cap(start.at, -DVec2::X, false);
                self.end();
            }
            return;
        }
        self.begin();
        for back in [false, true] {
            if back {
                contour.reverse();
            }
            if contour.closed {
                self.ring(contour);
                self.end();
                if !back {
                    self.begin();
                }
            } else {
                self.side(contour);
            }
        }
        if !contour.closed {
            self.end();
        }
    }

    fn begin(&mut self) {
        self.t.step(|| Step::Ring);
        self.ring.clear();
    }

    fn end(&mut self) {
        self.out.push(self.ring.iter().copied(), true);
    }

    fn push(&mut self, vertex: DVec2, point: DVec2, part: StrokePart) {
        if self.ring.last() != Some(&point) {
            self.t.step(|| Step::Point { vertex, point, part });
            self.ring.push(point);
        }
    }

    /// Draws the left side of a closed contour.
    fn ring(&mut self, contour: &Contour) {
        let Some(mut before) = contour.pieces.last() else { return };
        for (vertex, after) in contour.vertices.iter().zip(&contour.pieces) {
            self.vertex(vertex, before, after);
            before = after;
        }
    }

    /// Draws the left side of an open contour, and the cap at its end.
    fn side(&mut self, contour: &Contour) {
        let (Some(start), Some(end)) = (contour.vertices.first(), contour.vertices.last()) else {
            return;
        };
        let (Some(first), Some(last)) = (contour.pieces.first(), contour.pieces.last()) else {
            return;
        };
        let leave = start.corner.map_or(first.along, |c| c.1);
        self.leave(start.at, leave, first);
        let inner = contour.vertices.iter().skip(1);
        for (vertex, pieces) in inner.zip(contour.pieces.windows(2)) {
            self.vertex(vertex, &pieces[0], &pieces[1]);
        }
        let arrive = end.corner.map_or(last.along, |c| c.0);
        self.arrive(end.at, last, arrive);
        self.cap(end.at, arrive, arrive != last.along);
    }

    /// Returns the offset to the left of a direction.
    fn left(&self, along: DVec2) -> DVec2 {
        along.perp() * self.half
    }

    /// Draws the left side at a vertex.
    fn vertex(&mut self, vertex: &Vertex, before: &Piece, after: &Piece) {
        let p = vertex.at;
        match vertex.corner {
            Some((arrive, leave)) if !self.is_smooth(arrive, leave) => {
                if arrive == before.along && leave == after.along {
                    self.corner(p, before, after, self.join, StrokePart::Join);
                } else if arrive.perp_dot(leave) > 0.0 {
                    self.inner_curved(p, before, (arrive, leave), after);
                } else {
                    self.arrive(p, before, arrive);
                    self.outer(p, arrive, leave, self.join, StrokePart::Join);
                    self.leave(p, leave, after);
                }
            }
            _ => self.corner(p, before, after, Join::Round, StrokePart::Side),
        }
    }

    /// Returns whether a turn is so small that all joins look the same.
    fn is_smooth(&self, before: DVec2, after: DVec2) -> bool {
        2.0 <= (1.0 + before.dot(after)) * self.secant
    }

    /// Draws a corner between straight pieces.
    fn corner(&mut self, p: DVec2, before: &Piece, after: &Piece, join: Join, part: StrokePart) {
        let (from, to) = (before.along, after.along);
        if from.perp_dot(to) <= 0.0 {
            self.outer(p, from, to, join, part);
        } else if let Some(meeting) = self.meeting(before, after) {
            self.push(p, p + meeting, StrokePart::Side);
        } else if part == StrokePart::Side {
            self.sweep(p, from, to);
        } else {
            self.push(p, p + self.left(from), StrokePart::Side);
            self.push(p, p, StrokePart::Pivot);
            self.push(p, p + self.left(to), StrokePart::Side);
        }
    }

    /// Draws the inner side of a bend within a curve that is tighter than the width: the pen's edge, which turns on
    /// from one direction to the other, sweeps a wedge beyond the centre of the bend, with a part of a circle as its
    /// far side. It is added in the direction in which all the rest turns.
    fn sweep(&mut self, p: DVec2, from: DVec2, to: DVec2) {
        let wedge = |pen: &mut Self| {
            pen.push(p, p + pen.left(from), StrokePart::Side);
            pen.push(p, p, StrokePart::Pivot);
            pen.push(p, p + pen.left(to), StrokePart::Side);
        };
        wedge(self);
        self.outer(p, to, from, Join::Round, StrokePart::Side);
        wedge(self);
    }

    /// Returns the intersection of the offset lines on the inner side, relative to the vertex, if both
    /// pieces are long enough.
    fn meeting(&self, before: &Piece, after: &Piece) -> Option<DVec2> {
        let (from, to) = (before.along, after.along);
        let turn = 1.0 + from.dot(to);
        let reach = before.length.min(after.length) / 2.0;
        let fits = self.half * from.perp_dot(to).abs() <= turn * reach;
        (fits && turn > 0.0).then(|| (self.left(from) + self.left(to)) / turn)
    }

    /// Draws the inner side of a corner where curves end.
    fn inner_curved(
        &mut self,
        p: DVec2,
        before: &Piece,
        (arrive, leave): (DVec2, DVec2),
        after: &Piece,
    ) {
        let inner = before.along.perp_dot(after.along) > 0.0;
        if let Some(meeting) = self.meeting(before, after).filter(|_| inner) {
            self.push(p, p + meeting, StrokePart::Side);
            return;
        }
        if before.along.perp_dot(arrive) < 0.0 {
            self.arrive(p, before, arrive);
        } else {
            self.push(p, p + self.left(before.along), StrokePart::Side);
        }
        self.push(p, p, StrokePart::Pivot);
        if leave.perp_dot(after.along) < 0.0 {
            self.leave(p, leave, after);
        } else {
            self.push(p, p + self.left(after.along), StrokePart::Side);
        }
    }

    /// Draws the side from the last piece of a curve to the curve's direction at its end.
    fn arrive(&mut self, p: DVec2, piece: &Piece, end: DVec2) {
        if piece.along == end {
            return;
        }
        self.bend(p, piece.along, end, piece);
        self.push(p, p + self.left(end), StrokePart::Side);
    }

    /// Draws the side from a curve's direction at its start to its first piece.
    fn leave(&mut self, p: DVec2, start: DVec2, piece: &Piece) {
        if start == piece.along {
            return;
        }
        self.push(p, p + self.left(start), StrokePart::Side);
        self.bend(p, start, piece.along, piece);
    }

    /// Draws the bend between a curve's direction at an end and its piece there, without the point of the end itself.
    fn bend(&mut self, p: DVec2, from: DVec2, to: DVec2, piece: &Piece) {
        let cross = from.perp_dot(to);
        let small = self.half * (1.0 - from.dot(to)) <= self.tolerance;
        if cross > 0.0 {
            if !small || self.half * cross > piece.length / 2.0 {
                self.sweep(p, from, to);
            }
        } else if !small {
            self.outer(p, from, to, Join::Round, StrokePart::Side);
        }
    }

    /// Draws the outer side of a corner: everything between the two offset lines.
    fn outer(&mut self, p: DVec2, from: DVec2, to: DVec2, join: Join, part: StrokePart) {
        let turn = 1.0 + from.dot(to);
        let (first, last) = (self.left(from), self.left(to));
        let sharp = join == Join::Miter && 2.0 <= turn * self.miter;
        if turn > 0.0 && (sharp || 2.0 <= turn * self.secant) {
            if from != to {
                self.push(p, p + (first + last) / turn, part);
            }
        } else if join == Join::Round {
            let angle = libm::atan2(from.perp_dot(to).abs(), turn - 1.0);
            self.arc(p, first, angle, part);
        } else {
            self.push(p, p + first, part);
            self.push(p, p + last, part);
        }
    }

    /// Draws an arc that begins at an offset and turns right: the corners of the lines that touch it.
    fn arc(&mut self, p: DVec2, from: DVec2, angle: f64, part: StrokePart) {
        let pieces = (angle / self.arc).ceil().max(1.0);
        let step = angle / pieces;
        let (sine, cosine) = libm::sincos(step);
        let right = |v: DVec2| DVec2::new(cosine * v.x + sine * v.y, cosine * v.y - sine * v.x);
        let mut spoke = from - from.perp() * libm::tan(step / 2.0);
        for _ in 0..pieces as u32 {
            self.push(p, p + spoke, part);
            spoke = right(spoke);
        }
    }

    /// Draws the cap at an end; `curved` where the offset line does not lead straight to it.
    fn cap(&mut self, p: DVec2, along: DVec2, curved: bool) {
        let (left, beyond) = (self.left(along), along * self.half);
        match self.cap {
            Cap::Round => self.arc(p, left, std::f64::consts::PI, StrokePart::Cap),
            Cap::Butt => {
                self.push(p, p + left, StrokePart::Cap);
                self.push(p, p - left, StrokePart::Cap);
            }
            Cap::Square => {
                if curved {
                    self.push(p, p + left, StrokePart::Cap);
                }
                self.push(p, p + left + beyond, StrokePart::Cap);
                self.push(p, p - left + beyond, StrokePart::Cap);
            }
        }
    }
}
