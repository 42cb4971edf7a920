//! Chains of lines, arcs and cubic curves, for strokes of a sheet that are not polylines.

use crate::math::DVec2;
use std::f64::consts::TAU;

/// An arc of an ellipse or a circle, or a whole one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EllipticArc {
    /// The middle of the ellipse.
    pub center: DVec2,
    /// Vector from the centre to the end of the longer axis; for a circle, a radius in any direction.
    pub axis: DVec2,
    /// The shorter axis over the longer one, in (0, 1]; 1 for circles.
    pub ratio: f64,
    /// Start, in radians: an angle on the circle that the ellipse is when it is stretched along its shorter axis,
    /// from `axis` towards `axis.perp()`.
    pub start: f64,
    /// Sweep from the start, in radians: from −2π to 2π, ±2π for a whole ellipse.
    pub turn: f64,
}

impl EllipticArc {
    /// Returns the point at an angle, counted as `start` is.
    pub fn at(&self, angle: f64) -> DVec2 {
        let (sin, cos) = libm::sincos(angle);
        self.center + self.axis * cos + self.axis.perp() * (self.ratio * sin)
    }

    /// Returns the derivative at an angle, in the direction of the arc.
    pub(crate) fn way(&self, angle: f64) -> DVec2 {
        let (sin, cos) = libm::sincos(angle);
        let way = self.axis.perp() * (self.ratio * cos) - self.axis * sin;
        if self.turn < 0.0 { -way } else { way }
    }

    /// Returns half the longer and half the shorter axis.
    pub fn radii(&self) -> DVec2 {
        let longer = self.axis.length();
        DVec2::new(longer, longer * self.ratio)
    }

    /// Returns whether it is a part of a circle.
    pub fn is_circular(&self) -> bool {
        self.ratio == 1.0
    }

    /// Returns whether it comes back to where it began.
    pub fn is_whole(&self) -> bool {
        self.turn.abs() >= TAU
    }
}

/// A piece of a [`Curve`], from where the one before it ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CurvePiece {
    /// A straight line to a point.
    Line(DVec2),
    /// An arc and the point where it ends. Its start and end are the curve's points, which are on the arc up to
    /// rounding.
    Arc(EllipticArc, DVec2),
    /// A cubic Bézier curve: two control points and its end.
    Cubic(DVec2, DVec2, DVec2),
}

impl CurvePiece {
    /// Returns the point that it ends in.
    pub fn end(&self) -> DVec2 {
        match *self {
            Self::Line(end) | Self::Arc(_, end) | Self::Cubic(_, _, end) => end,
        }
    }

    /// Returns the directions in which it leaves `start` and reaches its end; of any length, 0 if it has no extent.
    pub fn ways(&self, start: DVec2) -> [DVec2; 2] {
        match *self {
            Self::Line(end) => [end - start; 2],
            Self::Arc(arc, _) => [arc.way(arc.start), arc.way(arc.start + arc.turn)],
            Self::Cubic(a, b, end) => {
                let first = |ways: [DVec2; 3]| {
                    ways.into_iter().find(|w| *w != DVec2::ZERO).unwrap_or(DVec2::ZERO)
                };
                [first([a - start, b - start, end - start]), first([end - b, end - a, end - start])]
            }
        }
    }
}

/// A chain of pieces, each beginning where the one before it ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Start of the first piece.
    pub start: DVec2,
    /// The pieces in order.
    pub pieces: Vec<CurvePiece>,
    /// True if its end, which then is its start to the bit, is joined to its start.
    pub closed: bool,
}

impl Curve {
    /// Returns each piece with the point that it begins in.
    pub fn iter(&self) -> impl Iterator<Item = (DVec2, &CurvePiece)> {
        let ends = self.pieces.iter().map(CurvePiece::end);
        std::iter::once(self.start).chain(ends).zip(&self.pieces)
    }

    /// Returns the curve, run through from its end to its start.
    #[must_use]
    pub(crate) fn reversed(self) -> Self {
        let back = |(start, piece): (DVec2, &CurvePiece)| match *piece {
            CurvePiece::Line(_) => CurvePiece::Line(start),
            CurvePiece::Arc(arc, _) => CurvePiece::Arc(
                EllipticArc { start: arc.start + arc.turn, turn: -arc.turn, ..arc },
                start,
            ),
            CurvePiece::Cubic(a, b, _) => CurvePiece::Cubic(b, a, start),
        };
        let mut pieces: Vec<CurvePiece> = self.iter().map(back).collect();
        pieces.reverse();
        Self { start: self.end(), pieces, closed: self.closed }
    }

    /// Returns the point that it ends in.
    pub fn end(&self) -> DVec2 {
        self.pieces.last().map_or(self.start, CurvePiece::end)
    }

    /// Returns whether all of it is straight.
    pub fn is_straight(&self) -> bool {
        self.pieces.iter().all(|p| matches!(p, CurvePiece::Line(_)))
    }

    /// Returns the arc if the curve is one whole circle or ellipse.
    pub fn whole(&self) -> Option<&EllipticArc> {
        match &self.pieces[..] {
            [CurvePiece::Arc(arc, _)] if self.closed && arc.is_whole() => Some(arc),
            _ => None,
        }
    }
}
