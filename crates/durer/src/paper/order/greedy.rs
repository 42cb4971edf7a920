//! From each end to the nearest stroke not yet drawn.
//!
//! Nearest neighbour (Rosenkrantz, Stearns and Lewis, *An analysis of several heuristics for the traveling
//! salesman problem*, 1977). O(n log n) as a rule.

use super::nearest::{Nearest, Tree};
use super::{OrderedStroke, PenStroke};
use crate::math::DVec2;

/// Returns the strokes that have points, from the one nearest to `start`. Of equally near strokes the one with the
/// lower index is first, forwards.
pub fn turns(strokes: &[PenStroke], start: DVec2) -> Vec<OrderedStroke> {
    let starts: Vec<OrderedStroke> = strokes.iter().enumerate().flat_map(starts_of).collect();
    let place = |turn: &OrderedStroke| strokes[turn.index].points[turn.first];
    let finite = |p: DVec2| if p.is_finite() { p } else { start };
    let mut tree = Tree::new(starts.iter().map(|turn| finite(place(turn))));
    let firsts: Vec<usize> = first_of_each(&starts, strokes.len());
    let (mut found, mut pen, mut nearest) = (Vec::new(), finite(start), Nearest::new(1));
    loop {
        tree.nearest(pen, &mut nearest, |_| true);
        let Some(&(_, number)) = nearest.list.first() else { return found };
        let turn = starts[number as usize];
        for other in firsts[turn.index]..firsts[turn.index + 1] {
            tree.remove(other as u32);
        }
        pen = finite(other_end(&strokes[turn.index], turn.first));
        found.push(turn);
    }
}

/// Returns all ways to draw a stroke.
fn starts_of((index, stroke): (usize, &PenStroke)) -> impl Iterator<Item = OrderedStroke> {
    let count = stroke.points.len();
    let step = if stroke.closed || count < 2 { 1 } else { count - 1 };
    (0..count).step_by(step).map(move |first| OrderedStroke { index, first })
}

/// Returns the position of each stroke's starts in their list, and the list's end.
fn first_of_each(starts: &[OrderedStroke], strokes: usize) -> Vec<usize> {
    let mut firsts = vec![0; strokes + 1];
    starts.iter().for_each(|turn| firsts[turn.index + 1] += 1);
    for i in 0..strokes {
        firsts[i + 1] += firsts[i];
    }
    firsts
}

/// Returns the position of the pen after a stroke that begins at a point.
pub fn other_end(stroke: &PenStroke, first: usize) -> DVec2 {
    let end = match (stroke.closed, first) {
        (true, first) => first,
        (false, 0) => stroke.points.len() - 1,
        (false, _) => 0,
    };
    stroke.points[end]
}
