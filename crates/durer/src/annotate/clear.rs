//! Lines end before text that is placed on them.

use super::quad::Quad;
use crate::curve::pieces;
use crate::math::DVec2;
use crate::sorting::CompactSort;
use crate::target::sheet::{PaperMark, Sheet};
use crate::target::{Curve, CurvePiece, EllipticArc};

/// Shortest rest of a line between two texts, in millimetres: a shorter one looks like dirt.
const SHORTEST: f64 = 0.3;

/// Curves are examined as chains this near to them, millimetres; arcs in chords of two degrees.
const NEAR: f64 = 0.01;
const CHORD: f64 = 2.0 * std::f64::consts::PI / 180.0;

/// Cuts the strokes of a sheet, including those of dimensions, wherever one of the quads covers them.
pub(super) fn clear(sheet: &mut Sheet, quads: &[Quad]) {
    for layer in sheet.layers.iter_mut().filter(|l| !is_whole(&l.name)) {
        cut_marks(&mut layer.marks, quads);
    }
}

/// Returns whether a layer is not cut: nothing is written across the frame, and areas are not lines.
fn is_whole(layer: &str) -> bool {
    matches!(layer, "frame" | "title-block" | "regions")
}

fn cut_marks(marks: &mut Vec<PaperMark>, quads: &[Quad]) {
    let mut kept = Vec::with_capacity(marks.len());
    for mut mark in std::mem::take(marks) {
        if let PaperMark::Dimension(dimension) = &mut mark {
            cut_marks(&mut dimension.marks, quads);
        }
        match mark {
            PaperMark::Stroke { points, closed, pen } => match outside(&points, closed, quads) {
                Some(parts) => kept.extend(parts.into_iter().map(|points| PaperMark::Stroke {
                    points,
                    closed: false,
                    pen,
                })),
                None => kept.push(PaperMark::Stroke { points, closed, pen }),
            },
            PaperMark::Curve { curve, pen } => match outside_of_curve(&curve, quads) {
                Some(parts) => {
                    kept.extend(parts.into_iter().map(|curve| PaperMark::Curve { curve, pen }))
                }
                None => kept.push(PaperMark::Curve { curve, pen }),
            },
            mark => kept.push(mark),
        }
    }
    *marks = kept;
}

/// Returns the parts of a chain outside all quads; `None` if no quad meets it.
fn outside(points: &[DVec2], closed: bool, quads: &[Quad]) -> Option<Vec<Vec<DVec2>>> {
    let again = points.first().copied().filter(|_| closed);
    let chain: Vec<DVec2> = points.iter().copied().chain(again).collect();
    let hit = chain.windows(2).any(|w| quads.iter().any(|q| q.inside(w[0], w[1]).is_some()));
    if !hit {
        return None;
    }
    let mut parts: Vec<Vec<DVec2>> = Vec::new();
    let mut open = false;
    for w in chain.windows(2) {
        for (from, to) in gaps(w[0], w[1], quads) {
            let [p, q] = [from, to].map(|t| w[0].lerp(w[1], t));
            match parts.last_mut() {
                Some(part) if open && from == 0.0 => part.push(q),
                _ => parts.push(vec![p, q]),
            }
            open = to == 1.0;
        }
        open &= !quads.iter().any(|quad| quad.inside(w[0], w[1]).is_some_and(|i| i.1 == 1.0));
    }
    join_ends(&mut parts, closed);
    let length = |part: &[DVec2]| part.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
    parts.retain(|part| length(part) >= SHORTEST);
    Some(parts)
}

/// Returns the parts of a curve outside all quads, each piece separately; `None` if no quad meets it.
fn outside_of_curve(curve: &Curve, quads: &[Quad]) -> Option<Vec<Curve>> {
    outside(&pieces::points(curve, NEAR), curve.closed, quads)?;
    let parts = curve.iter().flat_map(|(start, piece)| match *piece {
        CurvePiece::Arc(arc, end) => arcs(&arc, [start, end], quads),
        CurvePiece::Line(end) => polylines(&[start, end], quads),
        CurvePiece::Cubic(..) => {
            let alone = Curve { start, pieces: vec![*piece], closed: false };
            polylines(&pieces::points(&alone, NEAR), quads)
        }
    });
    Some(parts.collect())
}

/// Returns the parts of a chain outside of all quads, as curves.
fn polylines(points: &[DVec2], quads: &[Quad]) -> Vec<Curve> {
    let parts = outside(points, false, quads).unwrap_or_else(|| vec![points.to_vec()]);
    let curve = |part: Vec<DVec2>| {
        let (start, rest) = part.split_first()?;
        let pieces = rest.iter().map(|p| CurvePiece::Line(*p)).collect();
        Some(Curve { start: *start, pieces, closed: false })
    };
    parts.into_iter().filter_map(curve).collect()
}

/// Returns the parts of an arc between its ends outside of all quads: arcs again.
fn arcs(arc: &EllipticArc, [start, end]: [DVec2; 2], quads: &[Quad]) -> Vec<Curve> {
    let count = (arc.turn.abs() / CHORD).ceil().max(1.0);
    let at = |t: f64| match t {
        0.0 => start,
        1.0 => end,
        _ => arc.at(arc.start + arc.turn * t),
    };
    let mut spans: Vec<(f64, f64)> = Vec::new();
    for i in 0..count as u32 {
        let [low, high] = [i, i + 1].map(|i| f64::from(i) / count);
        for (from, to) in gaps(at(low), at(high), quads) {
            let [from, to] = [from, to].map(|t| low + (high - low) * t);
            match spans.last_mut() {
                Some(last) if from <= last.1 + 1e-12 => last.1 = to,
                _ => spans.push((from, to)),
            }
        }
    }
    let part = |(from, to): (f64, f64)| {
        let (start, turn) = (arc.start + arc.turn * from, arc.turn * (to - from));
        let piece = CurvePiece::Arc(EllipticArc { start, turn, ..*arc }, at(to));
        Curve { start: at(from), pieces: vec![piece], closed: false }
    };
    let long = |s: &(f64, f64)| (s.1 - s.0) * arc.turn.abs() * arc.radii().y >= SHORTEST;
    spans.into_iter().filter(long).map(part).collect()
}

/// Joins the last part of a closed chain to the first, if both touch its first point.
fn join_ends(parts: &mut Vec<Vec<DVec2>>, closed: bool) {
    let touch = parts.first().and_then(|p| p.first()) == parts.last().and_then(|p| p.last());
    if closed && parts.len() > 1 && touch {
        let first = parts.remove(0);
        if let Some(last) = parts.last_mut() {
            last.extend(first.into_iter().skip(1));
        }
    }
}

/// Returns the parts of a segment outside of all quads, as shares of its length.
fn gaps(a: DVec2, b: DVec2, quads: &[Quad]) -> Vec<(f64, f64)> {
    let mut inside: Vec<(f64, f64)> = quads.iter().filter_map(|q| q.inside(a, b)).collect();
    inside.compact_sort_by(|p, q| p.0.total_cmp(&q.0));
    let (mut at, mut gaps) = (0.0, Vec::new());
    for (from, to) in inside {
        if from > at {
            gaps.push((at, from));
        }
        at = to.max(at);
    }
    if at < 1.0 {
        gaps.push((at, 1.0));
    }
    gaps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_across_a_text_stays_round() {
        let arc = EllipticArc {
            center: DVec2::ZERO,
            axis: DVec2::new(10.0, 0.0),
            ratio: 1.0,
            start: 0.0,
            turn: std::f64::consts::TAU,
        };
        let start = DVec2::new(10.0, 0.0);
        let circle = Curve { start, pieces: vec![CurvePiece::Arc(arc, start)], closed: true };
        let p = DVec2::new;
        let quad = Quad([p(-12.0, -2.0), p(-8.0, -2.0), p(-8.0, 2.0), p(-12.0, 2.0)]);
        let parts = outside_of_curve(&circle, &[quad]).expect("cut");
        let ends = [parts[0].pieces[0].end(), parts[1].start];
        assert_eq!(parts.len(), 2);
        assert!((ends[0].y - 2.0).abs() < 0.01 && (ends[1].y + 2.0).abs() < 0.01, "{ends:?}");
        assert!(ends.iter().all(|e| (e.length() - 10.0).abs() < 1e-12));
    }

    #[test]
    fn a_ring_across_a_text_is_open_there() {
        let p = DVec2::new;
        let ring = [p(0.0, 0.0), p(10.0, 0.0), p(10.0, 10.0), p(0.0, 10.0)];
        let quad = Quad([p(-1.0, 4.0), p(3.0, 4.0), p(3.0, 6.0), p(-1.0, 6.0)]);
        let parts = outside(&ring, true, &[quad]).expect("cut");
        let whole = [p(0.0, 4.0), ring[0], ring[1], ring[2], ring[3], p(0.0, 6.0)];
        assert_eq!(parts, [whole.to_vec()]);
        assert_eq!(outside(&ring, false, &[quad]), None);
        let line = [p(2.0, 5.0), p(20.0, 5.0)];
        assert_eq!(outside(&line, false, &[quad]), Some(vec![vec![p(3.0, 5.0), p(20.0, 5.0)]]));
        // A line that ends just beyond is removed entirely.
        assert_eq!(outside(&[p(-1.1, 5.0), p(3.1, 5.0)], false, &[quad]), Some(Vec::new()));
    }
}
