//! In which order a pen draws, and from which end.
//!
//! Each stroke is first followed by the one that begins or ends nearest (`greedy`); then exchanges and moves of strokes
//! shorten the path (`improve`), while closed strokes begin where the path passes them. Paths are about a fifth shorter
//! than with the greedy search alone.
//!
//! This is the travelling salesman's problem, here with an end left open, and no optimum is promised. O(n log n) for
//! strokes spread over the paper, with a bound on the work: about a second for 100 000 strokes.

mod chain;
mod ends;
mod greedy;
mod improve;
pub(crate) mod nearest;

use crate::math::DVec2;
use crate::target::sheet::{PaperMark, Sheet};
pub use chain::Chain;
use ends::Ends;

/// Distance in millimetres between the end of a stroke and the start of the next up to which both are drawn as one:
/// machines have steps of about 0.01 mm, and every pen is thicker.
const JOIN: f64 = 0.01;

/// Number of rounds in which closed strokes are rotated to where the path passes them, and the path is shortened again.
const ROUNDS: usize = 4;

/// A chain that a pen draws without being lifted.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PenStroke {
    /// Its points, millimetres.
    pub points: Vec<DVec2>,
    /// True if it returns to the first point, which is not repeated.
    pub closed: bool,
}

/// A stroke in the order of drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OrderedStroke {
    /// Index of the stroke.
    pub index: usize,
    /// The point that it is begun at: of open strokes the first or the last.
    pub first: usize,
}

impl PenStroke {
    /// Returns the stroke, begun at one of its points.
    fn begun_at(mut self, first: usize) -> Self {
        if self.closed {
            let first = first.min(self.points.len());
            self.points.rotate_left(first);
        } else if first > 0 {
            self.points.reverse();
        }
        self
    }

    /// Returns the position of the pen after the chain.
    fn end(&self) -> Option<DVec2> {
        if self.closed { self.points.first() } else { self.points.last() }.copied()
    }
}

/// Orders strokes so that a pen that begins at `start`, and may end anywhere, makes short moves in the air. Strokes may
/// be drawn backwards, and closed ones from any of their points. Strokes without points are left out; points that are
/// not finite count as the start.
///
/// ```
/// use durer::math::DVec2;
/// use durer::paper::order::{PenStroke, OrderedStroke, turns};
/// let along = |a: f64, b: f64| PenStroke { points: vec![DVec2::new(a, 0.0), DVec2::new(b, 0.0)], closed: false };
/// let order = turns(&[along(20.0, 11.0), along(0.0, 10.0)], DVec2::ZERO);
/// assert_eq!(order, [OrderedStroke { index: 1, first: 0 }, OrderedStroke { index: 0, first: 1 }]);
/// ```
pub fn turns(strokes: &[PenStroke], start: DVec2) -> Vec<OrderedStroke> {
    let found = greedy::turns(strokes, start);
    let mut ends = Ends::new(strokes, &found, start);
    let mut way = improve::Way::new(found.len());
    for round in 0..ROUNDS {
        way.improve(&ends);
        if round + 1 == ROUNDS || !ends.turn_rings(strokes, way.sequence()) {
            break;
        }
    }
    way.unrolled().into_iter().filter_map(|end| ends.turn(end, strokes)).collect()
}

/// Orders strokes and curves as [`turns`] does, and joins those that follow each other without a gap. Curves may be
/// begun where their pieces meet, circles anywhere on a sixteenth of them.
pub fn ordered_chains(chains: Vec<Chain>, start: DVec2) -> Vec<Chain> {
    chain::joined(chain::in_turn(chains, start))
}

/// Orders the marks of a sheet, layer by layer, for pens that draw one layer after another: within a layer each pen is
/// taken once, for strokes and then for texts, which stay in one piece. Strokes with dashes are not joined, and layers
/// with fills stay as they are, because later marks cover earlier ones.
pub fn sheet(sheet: &mut Sheet) {
    let solid: Vec<bool> = sheet.pens.iter().map(|p| p.dashes.is_empty()).collect();
    let mut at = DVec2::ZERO;
    for layer in &mut sheet.layers {
        if layer.marks.iter().any(PaperMark::is_area) {
            continue;
        }
        let mut pens = ByPen::default();
        std::mem::take(&mut layer.marks).into_iter().for_each(|mark| pens.add(mark));
        for (pen, strokes, texts) in pens.0 {
            let joins = solid.get(pen).copied().unwrap_or(true);
            let chains = chain::in_turn(strokes, at);
            at = chains.last().map_or(at, Chain::end);
            let chains = if joins { chain::joined(chains) } else { chains };
            layer.marks.extend(chains.into_iter().map(|chain| chain.mark(pen)));
            layer.marks.extend(texts_in_turn(texts, &mut at));
        }
    }
}

/// The strokes and texts of a layer by the pens that draw them, in the order of their first marks.
#[derive(Default)]
struct ByPen(Vec<(usize, Vec<Chain>, Vec<PaperMark>)>);

impl ByPen {
    fn add(&mut self, mark: PaperMark) {
        match mark {
            PaperMark::Stroke { points, closed, pen } => {
                self.of(pen).1.push(Chain::Straight(PenStroke { points, closed }));
            }
            PaperMark::Curve { curve, pen } => self.of(pen).1.push(Chain::Curved(curve)),
            PaperMark::Text { pen, .. } => self.of(pen).2.push(mark),
            PaperMark::Dimension(ref dimension) => self.of(dimension.text.pen).2.push(mark),
            PaperMark::Fill { .. }
            | PaperMark::Area { .. }
            | PaperMark::Gradient(_)
            | PaperMark::Group(_) => {}
        }
    }

    fn of(&mut self, pen: usize) -> &mut (usize, Vec<Chain>, Vec<PaperMark>) {
        let index = self.0.iter().position(|p| p.0 == pen).unwrap_or(self.0.len());
        if index == self.0.len() {
            self.0.push((pen, Vec::new(), Vec::new()));
        }
        &mut self.0[index]
    }
}

/// Sorts texts for short moves from one beginning to the next.
fn texts_in_turn(texts: Vec<PaperMark>, at: &mut DVec2) -> Vec<PaperMark> {
    let place = |mark: &PaperMark| match mark {
        PaperMark::Text { at, .. } => PenStroke { points: vec![*at], closed: true },
        PaperMark::Dimension(dimension) => {
            PenStroke { points: vec![dimension.text.at], closed: true }
        }
        _ => PenStroke::default(),
    };
    let places: Vec<PenStroke> = texts.iter().map(place).collect();
    let turns = turns(&places, *at);
    let last = turns.last().and_then(|t| places.get(t.index));
    *at = last.and_then(PenStroke::end).unwrap_or(*at);
    turns.into_iter().filter_map(|t| texts.get(t.index).cloned()).collect()
}

#[cfg(test)]
mod tests;
