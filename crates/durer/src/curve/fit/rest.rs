//! The fit between exact arcs: from each point the longest arc or cubic curve that fits, or a line.

use super::bends::Bends;
use super::cubic::{self, Ways};
use super::measure::Run;
use super::{EXACT, circle, longest};
use crate::math::DVec2;
use crate::target::CurvePiece;

/// Smallest number of chords that a cubic curve replaces.
const LEAST_CUBIC: usize = 3;

/// The fewest chords that a line is for.
const LEAST_LINE: usize = 2;

/// Factor by which a curve must be longer than a line, or a cubic curve longer than a circular arc, to be preferred.
const FURTHER: f64 = 1.25;

/// Appends the pieces from one point to another, each with the index of its first point.
pub(super) fn fit(bends: &Bends, from: usize, to: usize, pieces: &mut Vec<(usize, CurvePiece)>) {
    let mut at = from;
    while at < to {
        let (end, piece) = longest_piece(bends, at, to, pieces)
            .unwrap_or((at + 1, CurvePiece::Line(bends.points[at + 1])));
        pieces.push((at, piece));
        at = end;
    }
}

fn longest_piece(
    bends: &Bends,
    from: usize,
    to: usize,
    before: &[(usize, CurvePiece)],
) -> Option<(usize, CurvePiece)> {
    if to - from < LEAST_LINE || !is_bent(bends, from) {
        return None;
    }
    let tolerance = bends.tolerance;
    let line = longest_line(bends, from, to);
    let arc = longest(from, circle::LEAST, to, |end| {
        circle::loose(&Run::of_all(bends, from, end), bends.turned(from, end), tolerance)
    });
    let curve = first_ways(bends, from, to, before).into_iter().flatten().find_map(|first| {
        longest(from, LEAST_CUBIC, to, |end| {
            let ways = Ways { first, last: last_way(bends, from, end, to) };
            cubic::near(&Run::of_all(bends, from, end), ways, tolerance)
        })
    });
    let length = |end: usize| bends.along[end] - bends.along[from];
    let reach = |end: usize| length(end) * FURTHER;
    let bent = arc.as_ref().map(|a| a.0).max(curve.as_ref().map(|c| c.0));
    if let Some(end) = line.filter(|end| reach(*end) >= bent.map_or(0.0, length)) {
        return Some((end, CurvePiece::Line(bends.points[end])));
    }
    match (arc, curve) {
        (Some((end, arc)), curve) if reach(end) >= curve.map_or(0.0, |c| length(c.0)) => {
            Some((end, CurvePiece::Arc(arc, bends.points[end])))
        }
        (_, Some((end, [a, b]))) => Some((end, CurvePiece::Cubic(a, b, bends.points[end]))),
        _ => None,
    }
}

/// Returns the end of the longest line from a point: a line exactly through its points is preferred to one near them
/// that is not much longer.
fn longest_line(bends: &Bends, from: usize, to: usize) -> Option<usize> {
    let line = |within: f64| {
        let near = |end: usize| Run::of_all(bends, from, end).is_near_line(within).then_some(());
        longest(from, LEAST_LINE, to, near).map(|found| found.0)
    };
    let length = |end: usize| bends.along[end] - bends.along[from];
    let loose = line(bends.tolerance)?;
    let exact = line(bends.tolerance * EXACT).filter(|e| length(*e) * FURTHER >= length(loose));
    exact.or(Some(loose))
}

/// Returns whether chords from a point on may be a curve at all: the first ones do not leave it by more than is
/// allowed.
fn is_bent(bends: &Bends, from: usize) -> bool {
    (from..from + 2).all(|i| {
        let chord = bends.along[i + 1] - bends.along[i];
        chord * bends.turns[i + 1].abs() * 0.125 <= 4.0 * bends.allowed[i]
    })
}

/// Returns the directions in which the next curve may leave a point: first the previous curve's, if one continues
/// smoothly into it, then the polyline's.
fn first_ways(
    bends: &Bends,
    from: usize,
    to: usize,
    before: &[(usize, CurvePiece)],
) -> [Option<DVec2>; 2] {
    let is_break = bends.breaks.binary_search(&from).is_ok();
    let smooth = match before.last() {
        Some((_, piece @ CurvePiece::Arc(..))) if !is_break => Some(piece.ways(DVec2::ZERO)[1]),
        Some((_, CurvePiece::Cubic(_, b, end))) if !is_break => Some(*end - *b),
        _ => None,
    };
    let own = end_way(bends, from, from + 1, from + 2.min(to - from));
    [smooth.map(DVec2::normalize_or_zero), Some(own)]
}

/// Returns the direction in which a curve reaches a point.
fn last_way(bends: &Bends, from: usize, end: usize, to: usize) -> DVec2 {
    if end == to || end + 1 >= bends.points.len() {
        return -end_way(bends, end, end - 1, end - 2.min(end - from));
    }
    // On the circle through three points.
    let [a, b, c] = [end - 1, end, end + 1].map(|i| bends.points[i]);
    let (come, go) = (b - a, c - b);
    (come / come.length_squared() + go / go.length_squared()).normalize_or_zero()
}

/// Returns the direction in which the circle through three points leaves the first one.
fn end_way(bends: &Bends, first: usize, second: usize, third: usize) -> DVec2 {
    let [a, b, c] = [first, second, third].map(|i| bends.points[i]);
    let (go, on) = (b - a, c - b);
    if second == third {
        return go.normalize_or_zero();
    }
    let both = (go / go.length_squared() + on / on.length_squared()).normalize_or_zero();
    // The chord makes equal angles with the directions at both of its ends.
    let chord = go.normalize_or_zero();
    (2.0 * chord.dot(both) * chord - both).normalize_or_zero()
}
