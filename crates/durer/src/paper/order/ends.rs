//! The points at which strokes can be entered and left.

use super::greedy::other_end;
use super::nearest::{Nearest, Tree};
use super::{OrderedStroke, PenStroke};
use crate::math::DVec2;

/// One end of a stroke: twice its place in the list, and 1 more for its end.
pub type End = u32;

/// Number of nearby ends that are tried for each end.
const NEIGHBORS: usize = 10;

/// The ends of strokes; the last of them is the pen's home, from which it starts.
pub struct Ends {
    turns: Vec<OrderedStroke>,
    /// Points by end.
    points: Vec<DVec2>,
    /// The nearest ends of other strokes, up to this many an end, the nearest first.
    near: Vec<End>,
    /// Start of each end's list; one more than there are ends.
    firsts: Vec<u32>,
}

impl Ends {
    /// Creates the ends of strokes as they are drawn first.
    pub fn new(strokes: &[PenStroke], turns: &[OrderedStroke], home: DVec2) -> Self {
        let finite = |p: DVec2| if p.is_finite() { p } else { home };
        let both = |turn: &OrderedStroke| {
            let stroke = &strokes[turn.index];
            [stroke.points[turn.first], other_end(stroke, turn.first)].map(finite)
        };
        let home = if home.is_finite() { home } else { DVec2::ZERO };
        let points = turns.iter().flat_map(both).chain([home; 2]).collect();
        let (near, firsts) = (Vec::new(), Vec::new());
        let mut ends = Self { turns: turns.to_vec(), points, near, firsts };
        ends.find_near();
        ends
    }

    fn find_near(&mut self) {
        let tree = Tree::new(self.points.iter().copied());
        let mut nearest = Nearest::new(NEIGHBORS);
        self.near.clear();
        self.firsts.clear();
        for (end, point) in self.points.iter().enumerate() {
            self.firsts.push(self.near.len() as u32);
            tree.nearest(*point, &mut nearest, |other| other as usize / 2 != end / 2);
            self.near.extend(nearest.list.iter().map(|n| n.1));
        }
        self.firsts.push(self.near.len() as u32);
    }

    /// Returns the ends near to one, the nearest first.
    pub fn near(&self, end: End) -> &[End] {
        let [from, to] = [end, end + 1].map(|e| self.firsts[e as usize] as usize);
        &self.near[from..to]
    }

    /// Returns the distance from end to end; 0 for the return, because the pen may stay anywhere.
    pub fn distance(&self, a: End, b: End) -> f64 {
        let back = self.points.len() as End - 2;
        if a == back || b == back {
            return 0.0;
        }
        self.points[a as usize].distance(self.points[b as usize])
    }

    /// Returns the turn that begins at an end; `None` for home.
    pub fn turn(&self, end: End, strokes: &[PenStroke]) -> Option<OrderedStroke> {
        let turn = *self.turns.get(end as usize / 2)?;
        let stroke = &strokes[turn.index];
        if end.is_multiple_of(2) || stroke.closed {
            return Some(turn);
        }
        let first = if turn.first == 0 { stroke.points.len() - 1 } else { 0 };
        Some(OrderedStroke { first, ..turn })
    }

    /// Rotates closed strokes to begin where the path past them is shortest, given all strokes as a cycle of the ends
    /// at which they are entered. Returns whether the path became shorter.
    pub fn turn_rings(&mut self, strokes: &[PenStroke], sequence: &[End]) -> bool {
        let (count, mut shorter) = (sequence.len(), false);
        for (i, &end) in sequence.iter().enumerate() {
            let Some(turn) = self.turns.get(end as usize / 2).copied() else { continue };
            let stroke = &strokes[turn.index];
            if !stroke.closed || stroke.points.len() < 2 {
                continue;
            }
            let before = sequence[(i + count - 1) % count] ^ 1;
            let after = sequence[(i + 1) % count];
            if let Some(first) = self.best_first(stroke, turn.first, before, after) {
                shorter = true;
                self.turns[end as usize / 2].first = first;
                self.points[end as usize] = stroke.points[first];
                self.points[end as usize ^ 1] = stroke.points[first];
            }
        }
        if shorter {
            self.find_near();
        }
        shorter
    }

    /// Returns the point of a closed stroke with the shortest path from end to end, if that is shorter than by `now`.
    fn best_first(&self, stroke: &PenStroke, now: usize, before: End, after: End) -> Option<usize> {
        let back = self.points.len() as End - 2;
        let way = |p: DVec2| {
            let to =
                |end: End| if end == back { 0.0 } else { p.distance(self.points[end as usize]) };
            to(before) + to(after)
        };
        let mut best = (way(stroke.points[now]) * (1.0 - 1e-9), None);
        for (i, p) in stroke.points.iter().enumerate().filter(|(_, p)| p.is_finite()) {
            let length = way(*p);
            if length < best.0 {
                best = (length, Some(i));
            }
        }
        best.1
    }
}
