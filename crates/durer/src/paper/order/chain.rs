//! Marks that a pen draws without being lifted, straight or curved.

use super::{JOIN, PenStroke, turns};
use crate::math::DVec2;
use crate::target::sheet::PaperMark;
use crate::target::{Curve, CurvePiece, EllipticArc};

/// Places at which a whole circle or ellipse may be begun.
const PLACES: usize = 16;

/// Chain that a pen draws without being lifted, in millimetres.
#[derive(Debug, Clone, PartialEq)]
pub enum Chain {
    /// Straight pieces.
    Straight(PenStroke),
    /// Lines and curves.
    Curved(Curve),
}

impl Chain {
    /// Returns the points at which it may be begun.
    fn places(&self) -> PenStroke {
        match self {
            Self::Straight(stroke) => stroke.clone(),
            Self::Curved(curve) => {
                let points = match curve.whole() {
                    Some(arc) => (0..PLACES).map(|i| arc.at(angle(arc, i))).collect(),
                    None => curve.iter().map(|(start, _)| start).collect(),
                };
                let mut stroke = PenStroke { points, closed: curve.closed };
                if !curve.closed {
                    stroke.points.push(curve.end());
                }
                stroke
            }
        }
    }

    /// Returns the chain, begun at one of its places.
    fn begun_at(self, first: usize) -> Self {
        match self {
            Self::Straight(stroke) => Self::Straight(stroke.begun_at(first)),
            Self::Curved(curve) if first == 0 => Self::Curved(curve),
            Self::Curved(curve) if !curve.closed => Self::Curved(curve.reversed()),
            Self::Curved(mut curve) => {
                if let Some(arc) = curve.whole().copied() {
                    let arc = EllipticArc { start: angle(&arc, first), ..arc };
                    curve.start = arc.at(arc.start);
                    curve.pieces = vec![CurvePiece::Arc(arc, curve.start)];
                } else if let Some(before) = curve.pieces.get(first - 1) {
                    curve.start = before.end();
                    curve.pieces.rotate_left(first);
                }
                Self::Curved(curve)
            }
        }
    }

    /// Returns the position of the pen after the chain.
    pub(super) fn end(&self) -> DVec2 {
        match self {
            Self::Straight(stroke) => stroke.end().unwrap_or_default(),
            Self::Curved(curve) => curve.end(),
        }
    }

    /// Returns the chain as an open curve; closed chains, and chains without a length, are returned as errors.
    fn open(self) -> Result<Curve, Self> {
        match self {
            Self::Curved(curve) if !curve.closed => Ok(curve),
            Self::Straight(PenStroke { points, closed: false }) if points.len() > 1 => {
                let pieces = points[1..].iter().map(|p| CurvePiece::Line(*p)).collect();
                Ok(Curve { start: points[0], pieces, closed: false })
            }
            other => Err(other),
        }
    }

    pub(super) fn mark(self, pen: usize) -> PaperMark {
        match self {
            Self::Straight(PenStroke { points, closed }) => {
                PaperMark::Stroke { points, closed, pen }
            }
            Self::Curved(curve) if curve.is_straight() && !curve.closed => {
                let rest = curve.pieces.iter().map(CurvePiece::end);
                let points = std::iter::once(curve.start).chain(rest).collect();
                PaperMark::Stroke { points, closed: false, pen }
            }
            Self::Curved(curve) => PaperMark::Curve { curve, pen },
        }
    }
}

/// Returns the angle of a place of a whole ellipse.
fn angle(arc: &EllipticArc, place: usize) -> f64 {
    arc.start + arc.turn * (place as f64 / PLACES as f64)
}

/// Puts chains in the order of [`turns`].
pub(super) fn in_turn(chains: Vec<Chain>, start: DVec2) -> Vec<Chain> {
    let places: Vec<PenStroke> = chains.iter().map(Chain::places).collect();
    let mut chains: Vec<Option<Chain>> = chains.into_iter().map(Some).collect();
    let turns = turns(&places, start).into_iter();
    turns.filter_map(|t| Some(chains.get_mut(t.index)?.take()?.begun_at(t.first))).collect()
}

/// Makes one chain of open ones that follow each other without a gap.
pub(super) fn joined(chains: Vec<Chain>) -> Vec<Chain> {
    let mut found: Vec<Chain> = Vec::with_capacity(chains.len());
    let mut last: Option<Curve> = None;
    for chain in chains {
        match (chain.open(), &mut last) {
            (Ok(next), Some(last)) if last.end().distance(next.start) <= JOIN => {
                if last.end() != next.start {
                    last.pieces.push(CurvePiece::Line(next.start));
                }
                last.pieces.extend(next.pieces);
            }
            (Ok(next), _) => found.extend(last.replace(next).map(Chain::Curved)),
            (Err(other), _) => {
                found.extend(last.take().map(Chain::Curved));
                found.push(other);
            }
        }
    }
    found.extend(last.map(Chain::Curved));
    found
}
