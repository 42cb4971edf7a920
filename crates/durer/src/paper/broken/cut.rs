//! Drawings cut at the two lines of a break.

use super::ViewBreak;
use crate::Result;
use crate::clip::polygon::overlay::{self, overlay};
use crate::clip::polygon::{BooleanOp, Shapes, WindingRule};
use crate::math::{DVec2, Rect};
use crate::paper::parts::parts;
use crate::target::drawing::{Drawing, Line, LineClass, Region};
use crate::trace::NoTrace;

/// Extents of a break line, as parts of the gap: of its zigzag to each side, of the zigzag along the line from its
/// middle, and of the line beyond the parts that it cuts.
const SWING: f64 = 0.4;
const HALF: f64 = 0.75;
const BEYOND: f64 = 0.6;

/// Largest half of a zigzag as a part of the line, which makes it smaller on short lines.
const MOST: f64 = 0.3;

/// One of the two lines of a break, and the side of it that stays.
struct Side<'a> {
    of: &'a ViewBreak,
    /// Position of the line on the axis.
    at: f64,
    /// 1 if the part above stays, −1 if the part below does.
    sign: f64,
    /// The zigzag: places along the line, and how far it swings off there.
    knots: [(f64, f64); 4],
    /// The ends of the line.
    ends: [f64; 2],
}

/// Cuts a drawing at both lines of a break and moves the part above.
pub(super) fn cut(of: &ViewBreak, drawing: Drawing) -> Result<Drawing> {
    let Some(bounds) = drawing.bounds() else { return Ok(drawing) };
    let span = across(of, &drawing);
    let sides = [(of.from, -1.0), (of.to, 1.0)].map(|(at, sign)| Side::new(of, at, sign, span));
    let mut kept = Drawing { edges: drawing.edges, ..Drawing::default() };
    for side in &sides {
        let lines = drawing.lines.iter().enumerate();
        for (i, line) in lines.flat_map(|(i, l)| side.line(l).into_iter().map(move |l| (i, l))) {
            kept.lines.push(line);
            kept.nearness.extend(drawing.nearness.get(i));
        }
        for region in &drawing.regions {
            kept.regions.extend(side.region(region, &bounds)?);
        }
        let labels = drawing.labels.iter().filter(|l| side.off(l.at) > 0.0).cloned();
        kept.labels.extend(
            labels.map(|l| crate::target::drawing::TextLabel { at: side.moved(l.at), ..l }),
        );
        if span.is_some() {
            kept.lines.push(side.break_line());
            kept.nearness.extend(drawing.nearness.first().map(|_| None));
        }
    }
    Ok(kept)
}

/// Returns the range of places along the break's lines in which it cuts lines.
fn across(of: &ViewBreak, drawing: &Drawing) -> Option<[f64; 2]> {
    let rings = drawing.regions.iter().flat_map(|r| &r.rings).map(|r| (&r[..], true));
    let chains = drawing.lines.iter().map(|l| (&l.points[..], l.closed)).chain(rings);
    let mut span: Option<[f64; 2]> = None;
    for (points, closed) in chains {
        let last = points.first().zip(points.last()).filter(|_| closed).map(|(a, b)| [*b, *a]);
        for [a, b] in points.windows(2).map(|w| [w[0], w[1]]).chain(last) {
            for at in [of.from, of.to] {
                let [low, high] = [a, b].map(|p| p.dot(of.way) - at);
                if low * high > 0.0 || low == high {
                    continue;
                }
                let v = a.lerp(b, low / (low - high)).dot(of.way.perp());
                span = Some(span.map_or([v; 2], |[from, to]| [from.min(v), to.max(v)]));
            }
        }
    }
    span.filter(|[from, to]| from.is_finite() && to.is_finite())
}

impl<'a> Side<'a> {
    fn new(of: &'a ViewBreak, at: f64, sign: f64, span: Option<[f64; 2]>) -> Self {
        let [from, to] = span.unwrap_or_default();
        let (middle, half) = ((from + to) * 0.5, (of.gap * HALF).min((to - from) * MOST));
        let swing = of.gap * SWING * (half / (of.gap * HALF));
        let knots = [(-1.0, 0.0), (-1.0 / 3.0, swing), (1.0 / 3.0, -swing), (1.0, 0.0)];
        let knots = knots.map(|(share, off)| (middle + half * share, off));
        let ends = [from - of.gap * BEYOND, to + of.gap * BEYOND];
        Self { of, at, sign, knots, ends }
    }

    /// Returns the point of the plane so far along the axis and so far along the line.
    fn point(&self, u: f64, v: f64) -> DVec2 {
        self.of.way * u + self.of.way.perp() * v
    }

    /// Returns the offset of the line at a place along it.
    fn swing(&self, v: f64) -> f64 {
        let piece = self.knots.windows(2).find(|w| w[0].0 <= v && v < w[1].0);
        piece.map_or(0.0, |w| w[0].1 + (w[1].1 - w[0].1) * ((v - w[0].0) / (w[1].0 - w[0].0)))
    }

    /// Returns the distance of a point into the side that stays.
    fn off(&self, p: DVec2) -> f64 {
        (p.dot(self.of.way) - self.at - self.swing(p.dot(self.of.way.perp()))) * self.sign
    }

    /// Returns the new position of a point on the side that stays.
    fn moved(&self, p: DVec2) -> DVec2 {
        if self.sign > 0.0 { p - self.of.way * self.of.shift() } else { p }
    }

    fn break_line(&self) -> Line {
        let [from, to] = self.ends;
        let bends = self.knots.iter().map(|(v, off)| (*v, *off));
        let all = [(from, 0.0)].into_iter().chain(bends).chain([(to, 0.0)]);
        let points = all.map(|(v, off)| self.moved(self.point(self.at + off, v))).collect();
        Line { class: LineClass::Break, invisibility: 0, points, closed: false }
    }

    /// Returns the parts of a line on the side that stays, moved.
    fn line(&self, line: &Line) -> Vec<Line> {
        let swing = self.knots[1].1;
        let clear = |p: &DVec2| (p.dot(self.of.way) - self.at) * self.sign >= swing;
        let mut kept = match line.points.iter().all(clear) {
            true => vec![line.clone()],
            false => parts(line, |a, b| self.segment(a, b)),
        };
        kept.iter_mut().flat_map(|l| &mut l.points).for_each(|p| *p = self.moved(*p));
        kept
    }

    /// Returns the parts of a segment on the side that stays; its ends stay as they are.
    fn segment(&self, a: DVec2, b: DVec2) -> Vec<[DVec2; 2]> {
        let [from, to] = [a, b].map(|p| p.dot(self.of.way.perp()));
        let bends = self.knots.iter().map(|(v, _)| (v - from) / (to - from));
        let mut places: Vec<f64> = bends.filter(|t| *t > 0.0 && *t < 1.0).collect();
        places.sort_by(f64::total_cmp);
        places.insert(0, 0.0);
        places.push(1.0);
        let point = |t: f64| match t {
            0.0 => a,
            1.0 => b,
            _ => a.lerp(b, t),
        };
        let mut spans: Vec<[f64; 2]> = Vec::new();
        for w in places.windows(2) {
            let (off, then) = (self.off(point(w[0])), self.off(point(w[1])));
            if !(off > 0.0 || then > 0.0) {
                continue;
            }
            let crossing = w[0] + (w[1] - w[0]) * (off / (off - then));
            let start = if off < 0.0 { crossing } else { w[0] };
            let end = if then < 0.0 { crossing } else { w[1] };
            match spans.last_mut() {
                Some(last) if last[1] == start => last[1] = end,
                _ => spans.push([start, end]),
            }
        }
        spans.into_iter().map(|s| s.map(point)).filter(|[p, q]| p != q).collect()
    }

    /// Returns the part of a region on the side that stays, moved.
    fn region(&self, region: &Region, bounds: &Rect) -> Result<Option<Region>> {
        let (mut subject, mut half) = (Shapes::new(), Shapes::new());
        region.rings.iter().for_each(|r| subject.push_ring(r.iter().copied()));
        subject.end_polygon();
        half.push_ring(self.half_plane(bounds));
        half.end_polygon();
        let rule = overlay::Options::with_rule(WindingRule::NonZero);
        let cut = overlay(&subject, &half, BooleanOp::Intersection, &rule, &mut NoTrace)?.shapes;
        let ring = |r: &[DVec2]| r.iter().map(|p| self.moved(*p)).collect();
        let rings: Vec<Vec<DVec2>> = cut.rings().map(ring).collect();
        Ok((!rings.is_empty()).then(|| Region { rings, ..region.clone() }))
    }

    /// Returns a ring around all of the drawing on the side that stays.
    fn half_plane(&self, bounds: &Rect) -> Vec<DVec2> {
        let reach = bounds.min().abs().max(bounds.max().abs()).length() * 2.0 + self.at.abs();
        let bends = self.knots.iter().map(|(v, off)| (*v, *off));
        let edge = [(-reach, 0.0)].into_iter().chain(bends).chain([(reach, 0.0)]);
        let edge = edge.map(|(v, off)| self.point(self.at + off, v));
        let far = self.at + self.sign * 2.0 * reach;
        edge.chain([self.point(far, reach), self.point(far, -reach)]).collect()
    }
}
