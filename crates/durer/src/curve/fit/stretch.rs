//! The part of a polyline between two breaks: arcs exactly through its points first, then the rest.

use super::bends::Bends;
use super::measure::Run;
use super::{circle, ellipse, longest, rest};
use crate::target::{CurvePiece, EllipticArc};
use std::f64::consts::PI;

/// The fewest chords of an elliptical arc.
const LEAST_ELLIPSE: usize = 6;

/// Factor by which an arc near the points must be longer than one exactly through them to be preferred: over a short
/// distance, any curve is a circle.
const FURTHER: f64 = 1.6;

/// Turn from which an arc is certain, whatever the length of one near the points.
const CERTAIN: f64 = PI / 3.0;

/// An arc between two points of a polyline.
struct Found {
    from: usize,
    to: usize,
    arc: EllipticArc,
}

/// Appends the pieces of a stretch, each with the index of its first point.
pub(super) fn fit(bends: &Bends, from: usize, to: usize, pieces: &mut Vec<(usize, CurvePiece)>) {
    let mut at = from;
    if to - from >= circle::LEAST {
        for found in prolonged(bends, exact_arcs(bends, from, to), from, to) {
            rest::fit(bends, at, found.from, pieces);
            pieces.push((found.from, CurvePiece::Arc(found.arc, bends.points[found.to])));
            at = found.to;
        }
    }
    rest::fit(bends, at, to, pieces);
}

/// Returns the arcs between two points that contain their points exactly.
fn exact_arcs(bends: &Bends, from: usize, to: usize) -> Vec<Found> {
    let mut arcs = Vec::new();
    let mut at = from;
    while at + circle::LEAST <= to {
        match exact_arc(bends, at, to) {
            Ok(found) => {
                at = found.to;
                arcs.push(found);
            }
            Err(reach) => at += (reach / STEPS).max(1),
        }
    }
    arcs
}

/// Number of parts into which an arc that fits exactly but is none is divided: the next one is sought after one part,
/// since from every point an almost straight polyline would take forever.
const STEPS: usize = 16;

/// Returns the longest exact arc from a point, if it is really an arc and not a short section of another curve; else
/// the number of chords that an arc would span.
fn exact_arc(bends: &Bends, from: usize, to: usize) -> Result<Found, usize> {
    if !goes_round(bends, from) {
        return Err(0);
    }
    let tolerance = bends.tolerance;
    // Folds give no evidence, so that more points are needed to be certain.
    let more = if (from..to.min(from + circle::LEAST)).any(|i| bends.is_fold(i)) { 3 } else { 1 };
    let circle = longest(from, circle::LEAST * more, to, |end| {
        circle::exact(&Run::new(bends, from, end), bends.turned(from, end), tolerance)
    });
    if let Some((end, arc)) = circle
        && is_certain(bends, from, to, (end, &arc))
    {
        return Ok(Found { from, to: end, arc });
    }
    let ellipse = longest(from, LEAST_ELLIPSE * more, to, |end| {
        ellipse::exact(&Run::new(bends, from, end), bends.turned(from, end), tolerance)
    });
    match ellipse {
        Some((end, arc)) if ellipse::is_certain(bends.turned(from, end)) => {
            Ok(Found { from, to: end, arc })
        }
        _ => {
            let reach = |end: Option<usize>| end.map_or(0, |end| end - from);
            Err(reach(circle.map(|c| c.0)).max(reach(ellipse.map(|e| e.0))))
        }
    }
}

/// Returns whether a circular arc exactly through its points is certain to be one.
fn is_certain(bends: &Bends, from: usize, to: usize, (end, arc): (usize, &EllipticArc)) -> bool {
    if end == to || arc.turn.abs() >= CERTAIN {
        return true;
    }
    let near = longest(from, circle::LEAST, to, |end| {
        circle::loose(&Run::of_all(bends, from, end), bends.turned(from, end), bends.tolerance)
    });
    let length = |end: usize| bends.along[end] - bends.along[from];
    near.is_none_or(|(near, _)| length(near) <= length(end) * FURTHER)
}

/// Returns whether the polyline turns in one direction at the next points, which excludes most runs that are not arcs.
fn goes_round(bends: &Bends, from: usize) -> bool {
    let turns = &bends.turns[from + 1..from + circle::LEAST];
    turns.iter().all(|t| *t > 0.0) || turns.iter().all(|t| *t < 0.0)
}

/// Prolongs arcs to the ends of the stretch over a last chord: where something is in front, a polyline ends between two
/// points of the arc.
fn prolonged(bends: &Bends, mut arcs: Vec<Found>, from: usize, to: usize) -> Vec<Found> {
    let try_to = |found: &mut Found, start: usize, end: usize| {
        let run = Run::new(bends, start, end);
        if let Some(arc) = circle::prolonged(&found.arc, &run, bends.tolerance) {
            *found = Found { from: start, to: end, arc };
        }
    };
    if let Some(first) = arcs.first_mut().filter(|f| f.from == from + 1) {
        let to = first.to;
        try_to(first, from, to);
    }
    if let Some(last) = arcs.last_mut().filter(|f| f.to + 1 == to) {
        let from = last.from;
        try_to(last, from, to);
    }
    arcs
}
