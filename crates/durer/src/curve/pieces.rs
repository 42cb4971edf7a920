//! Operations on chains of lines, arcs and cubic curves: paths, points, lengths, parts.

use super::{Path, PathElement, flatten};
use crate::math::DVec2;
use crate::target::{Curve, CurvePiece, EllipticArc};
use std::f64::consts::FRAC_PI_2;

/// No arc becomes more cubic curves: a quarter turn of 64 of them is exact to the last bit.
const MOST_CUBICS: u32 = 256;

/// Returns a curve as a path whose cubic curves stay within `tolerance` of its arcs, in the curve's unit.
pub fn path(curve: &Curve, tolerance: f64) -> Path {
    let mut path = Path::new();
    path.push(PathElement::MoveTo(curve.start));
    for piece in &curve.pieces {
        match *piece {
            CurvePiece::Line(end) => {
                path.push(PathElement::LineTo(end));
            }
            CurvePiece::Cubic(a, b, end) => {
                path.cubic_to(a, b, end);
            }
            CurvePiece::Arc(arc, end) => {
                cubics(&arc, end, tolerance).iter().for_each(|[a, b, end]| {
                    path.cubic_to(*a, *b, *end);
                })
            }
        }
    }
    if curve.closed {
        path.close();
    }
    path
}

/// Returns an arc that ends in `end` as cubic Bézier curves, two control points and an end each, that stay within
/// `tolerance` of it.
///
/// M. Goldapp, *Approximation of circular arcs by cubic polynomials*, 1991: with control points on the tangents, 4/3 ·
/// tan(θ/4) radii from the ends, a cubic leaves an arc over an angle θ by less than 2/27 · sin⁶(θ/4) / cos²(θ/4) radii.
pub fn cubics(arc: &EllipticArc, end: DVec2, tolerance: f64) -> Vec<[DVec2; 3]> {
    let radius = arc.axis.length();
    let error = |count: u32| {
        let (sin, cos) = libm::sincos(arc.turn.abs() / f64::from(4 * count));
        radius * 2.0 / 27.0 * (sin * sin * sin).powi(2) / (cos * cos)
    };
    let least = ((arc.turn.abs() / FRAC_PI_2 - 1e-9).ceil() as u32).max(1);
    let count = (least..MOST_CUBICS).find(|n| error(*n) <= tolerance).unwrap_or(MOST_CUBICS);
    let step = arc.turn / f64::from(count);
    let reach = 4.0 / 3.0 * libm::tan(step.abs() / 4.0);
    let one = |i: u32| {
        let (from, to) = (arc.start + step * f64::from(i), arc.start + step * f64::from(i + 1));
        let ends = if i + 1 == count { end } else { arc.at(to) };
        [arc.at(from) + arc.way(from) * reach, arc.at(to) - arc.way(to) * reach, ends]
    };
    (0..count).map(one).collect()
}

/// Returns points on a curve whose chords stay within `tolerance` of it; the first one is not repeated where the curve
/// is closed.
pub fn points(curve: &Curve, tolerance: f64) -> Vec<DVec2> {
    let contours = flatten(&path(curve, tolerance * 0.25), tolerance * 0.75);
    let mut points: Vec<DVec2> = contours.points().to_vec();
    if curve.closed && points.len() > 2 && points.last() == points.first() {
        points.pop();
    }
    points
}

/// Returns the length of a curve, to about a part in a million.
pub fn length(curve: &Curve) -> f64 {
    let piece = |(start, piece): (DVec2, &CurvePiece)| match piece {
        CurvePiece::Line(end) => start.distance(*end),
        CurvePiece::Arc(arc, _) if arc.is_circular() => arc.axis.length() * arc.turn.abs(),
        _ => {
            let alone = Curve { start, pieces: vec![*piece], closed: false };
            let across = start.distance(piece.end()).max(reach(start, piece));
            points(&alone, across * 1e-6).windows(2).map(|w| w[0].distance(w[1])).sum()
        }
    };
    curve.iter().map(piece).sum()
}

/// Returns an upper bound of a piece's distance from its start, at most a few times too large.
fn reach(start: DVec2, piece: &CurvePiece) -> f64 {
    match piece {
        CurvePiece::Line(end) => start.distance(*end),
        CurvePiece::Arc(arc, _) => 2.0 * arc.axis.length(),
        CurvePiece::Cubic(a, b, _) => start.distance(*a).max(start.distance(*b)),
    }
}

/// Divides a curve where it turns by more than the angle with this cosine. A closed curve without such corners stays
/// closed.
pub fn at_corners(curve: &Curve, cosine: f64) -> Vec<Curve> {
    let ways: Vec<[DVec2; 2]> = curve.iter().map(|(start, piece)| piece.ways(start)).collect();
    let count = ways.len();
    let is_corner = |i: usize| {
        let (come, go) = (ways[(i + count - 1) % count][1], ways[i][0]);
        come.normalize_or_zero().dot(go.normalize_or_zero()) < cosine
    };
    let all: Vec<(DVec2, CurvePiece)> =
        curve.iter().map(|(start, piece)| (start, *piece)).collect();
    let first = if curve.closed { (0..count).find(|i| is_corner(*i)) } else { Some(0) };
    let Some(first) = first else { return vec![curve.clone()] };
    let mut parts: Vec<Curve> = Vec::new();
    for k in 0..count {
        let i = (first + k) % count;
        let (start, piece) = all[i];
        match parts.last_mut() {
            Some(part) if !is_corner(i) => part.pieces.push(piece),
            _ => parts.push(Curve { start, pieces: vec![piece], closed: false }),
        }
    }
    parts
}

/// Largest number of times that a curve is halved to become arcs.
const MOST_HALVINGS: u32 = 12;

/// Returns a curve as circular arcs and lines: for each its end and its bulge, the tangent of a quarter of its turn,
/// which is 0 for lines. They stay within `tolerance` of the curve.
///
/// Ellipses and cubic curves become pairs of arcs that go over into each other without a corner: K. M. Bolton, *Biarc
/// curves*, Computer-Aided Design, 1975; both with tangents of the same length.
pub fn arcs(curve: &Curve, tolerance: f64) -> Vec<(DVec2, f64)> {
    let mut arcs = Vec::new();
    for (start, piece) in curve.iter() {
        match *piece {
            CurvePiece::Line(end) => arcs.push((end, 0.0)),
            CurvePiece::Arc(arc, end) if arc.is_circular() => {
                let parts = (arc.turn.abs() / (FRAC_PI_2 * 1.5)).ceil().max(1.0) as u32;
                let step = arc.turn / f64::from(parts);
                let bulge = libm::tan(step * 0.25);
                let inner = (1..parts).map(|i| arc.at(arc.start + step * f64::from(i)));
                arcs.extend(inner.chain([end]).map(|p| (p, bulge)));
            }
            _ => pairs(start, piece, tolerance, &mut arcs),
        }
    }
    arcs
}

/// A point of a curve and its unit direction there.
type Place = (DVec2, DVec2);

fn place(start: DVec2, piece: &CurvePiece, t: f64) -> Place {
    let (p, way) = match *piece {
        CurvePiece::Line(end) => (start.lerp(end, t), end - start),
        CurvePiece::Arc(arc, end) => {
            let angle = arc.start + arc.turn * t;
            let p = if t <= 0.0 {
                start
            } else if t >= 1.0 {
                end
            } else {
                arc.at(angle)
            };
            (p, arc.way(angle))
        }
        CurvePiece::Cubic(a, b, end) => {
            let (ab, bc, cd) = (start.lerp(a, t), a.lerp(b, t), b.lerp(end, t));
            let (left, right) = (ab.lerp(bc, t), bc.lerp(cd, t));
            let ends = piece.ways(start);
            let way = if t <= 0.0 {
                ends[0]
            } else if t >= 1.0 {
                ends[1]
            } else {
                right - left
            };
            (left.lerp(right, t), way)
        }
    };
    (p, way.normalize_or_zero())
}

fn pairs(start: DVec2, piece: &CurvePiece, tolerance: f64, arcs: &mut Vec<(DVec2, f64)>) {
    let at = |t: f64| place(start, piece, t);
    // The part of the curve that is next, last.
    let mut parts = vec![(0.5, 1.0, 1), (0.0, 0.5, 1)];
    while let Some((from, to, halvings)) = parts.pop() {
        let pair = pair(at(from), at(to));
        let between = (1..8).map(|i| at(from + (to - from) * f64::from(i) / 8.0).0);
        let is_near = |[first, second]: &[(DVec2, f64); 2]| {
            between.clone().all(|p| {
                let distance = off(p, at(from).0, *first).min(off(p, first.0, *second));
                distance <= tolerance
            })
        };
        match pair.filter(is_near) {
            Some(pair) => arcs.extend(pair),
            None if halvings < MOST_HALVINGS => {
                let middle = (from + to) * 0.5;
                parts.push((middle, to, halvings + 1));
                parts.push((from, middle, halvings + 1));
            }
            None => arcs.push((at(to).0, 0.0)),
        }
    }
}

/// Returns two arcs between two places.
fn pair((from, leaves): Place, (to, comes): Place) -> Option<[(DVec2, f64); 2]> {
    let (across, ways) = (to - from, leaves + comes);
    let (along, bend) = (across.dot(ways), 2.0 * (1.0 - leaves.dot(comes)));
    let reach = match bend > 1e-12 {
        true => ((along * along + bend * across.length_squared()).sqrt() - along) / bend,
        false => across.length_squared() / (4.0 * across.dot(comes)),
    };
    let joint = (from + to + (leaves - comes) * reach) * 0.5;
    let angle = |a: DVec2, b: DVec2| libm::atan2(a.perp_dot(b), a.dot(b));
    let bulge = |angle: f64| libm::tan(angle * 0.5);
    let first = (joint, bulge(angle(leaves, joint - from)));
    let second = (to, bulge(angle(to - joint, comes)));
    let is_sound = joint.is_finite() && first.1.abs() < 1.0 && second.1.abs() < 1.0;
    is_sound.then_some([first, second])
}

/// Returns the distance of a point from the circle of an arc.
fn off(p: DVec2, start: DVec2, (end, bulge): (DVec2, f64)) -> f64 {
    let across = end - start;
    let half = across.length() * 0.5;
    if half == 0.0 {
        return p.distance(start);
    }
    if bulge.abs() < 1e-9 {
        return across.perp_dot(p - start).abs() / (2.0 * half);
    }
    // A turn of four times the bulge's angle.
    let radius = half * (1.0 + bulge * bulge) / (2.0 * bulge);
    let height = half * (1.0 - bulge * bulge) / (2.0 * bulge);
    let center = (start + end) * 0.5 + across.perp() / (2.0 * half) * height;
    (p.distance(center) - radius.abs()).abs()
}
