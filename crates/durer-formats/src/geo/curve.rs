//! Arcs of circles through three positions, as lines.

use super::Points;
use durer::math::DVec2;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Number of edges for a quarter of a circle, all corners of which are on it: their error is below 1/3000 of the
/// radius.
const EDGES: f64 = 32.0;

/// Returns the line through the arcs of control positions: every second one is on an arc, and its neighbours are the
/// arc's ends. An arc has the same corners in either direction, so that neighbours that share it stay neighbours.
///
/// # Errors
/// If there is an even number of positions, or one.
pub fn flatten(control: &Points) -> Result<Points, &'static str> {
    if control.is_empty() {
        return Ok(Points::new(control.dimensions));
    }
    if control.len() < 3 || control.len().is_multiple_of(2) {
        return Err("arcs need an odd number of positions, three or more");
    }
    let mut line = Points::new(control.dimensions);
    line.push(control.xy[0], control.zm(0));
    for start in (0..control.len() - 2).step_by(2) {
        let ends = [start, start + 1, start + 2];
        let flat = arc(control, ends);
        (1..flat.len()).for_each(|i| line.push(flat.xy[i], flat.zm(i)));
    }
    Ok(line)
}

/// Adds a part to a chain, whose last position the part begins with.
pub fn join(chain: &mut Points, part: &Points) {
    if chain.is_empty() {
        chain.dimensions = part.dimensions;
    }
    let skipped = usize::from(!chain.is_empty() && chain.xy.last() == part.xy.first());
    (skipped..part.len()).for_each(|i| chain.push(part.xy[i], part.zm(i)));
}

/// Removes empty rings, and all holes of a polygon whose outer ring is empty.
pub fn keep_polygon(rings: &mut Vec<Points>) {
    if rings.first().is_some_and(Points::is_empty) {
        rings.clear();
    }
    rings.retain(|ring| !ring.is_empty());
}

/// Returns one arc, its ends included.
fn arc(control: &Points, ends: [usize; 3]) -> Points {
    let [a, b, c] = ends.map(|i| control.xy[i]);
    let turned = (c.x, c.y) < (a.x, a.y);
    let order = if turned { [ends[2], ends[1], ends[0]] } else { ends };
    let flat = arc_onwards(control, order, if turned { [c, b, a] } else { [a, b, c] });
    if !turned {
        return flat;
    }
    let mut back = Points::new(flat.dimensions);
    (0..flat.len()).rev().for_each(|i| back.push(flat.xy[i], flat.zm(i)));
    back
}

fn arc_onwards(control: &Points, order: [usize; 3], [a, b, c]: [DVec2; 3]) -> Points {
    let mut flat = Points::new(control.dimensions);
    flat.push(a, control.zm(order[0]));
    if let Some((center, to_b, turn)) = circle(a, b, c) {
        let radius = (a - center).length();
        let start = libm::atan2(a.y - center.y, a.x - center.x);
        let count =
            libm::ceil(turn.abs() / FRAC_PI_2 * EDGES - 1e-6).clamp(1.0, 4.0 * EDGES) as u32;
        let [za, zb, zc] = order.map(|i| control.zm(i));
        for i in 1..count {
            let angle = turn * f64::from(i) / f64::from(count);
            let (sin, cos) = libm::sincos(start + angle);
            // Heights and measures grow evenly from each position to the next.
            let (share, from, to) = if angle.abs() < to_b.abs() {
                (angle / to_b, za, zb)
            } else {
                ((angle - to_b) / (turn - to_b), zb, zc)
            };
            let mixed = [0, 1].map(|j| from[j] + (to[j] - from[j]) * share);
            flat.push(center + DVec2::new(cos, sin) * radius, mixed);
        }
    } else {
        flat.push(b, control.zm(order[1]));
    }
    flat.push(c, control.zm(order[2]));
    flat
}

/// Returns the centre of the circle through three positions, and the angles from the first to the second and to the
/// third; `None` if they are collinear.
fn circle(a: DVec2, b: DVec2, c: DVec2) -> Option<(DVec2, f64, f64)> {
    if a == c {
        // A whole circle, counter-clockwise, with its middle between both positions.
        let center = a * 0.5 + b * 0.5;
        return (a != b).then_some((center, TAU / 2.0, TAU));
    }
    let (u, v) = (b - a, c - a);
    let twice = 2.0 * u.perp_dot(v);
    let (uu, vv) = (u.length_squared(), v.length_squared());
    let center = a + DVec2::new(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / twice;
    if twice == 0.0 || !center.is_finite() {
        return None;
    }
    let from = a - center;
    let angle = |p: DVec2| {
        let q = p - center;
        let turn = libm::atan2(from.perp_dot(q), from.dot(q));
        match twice > 0.0 {
            true if turn < 0.0 => turn + TAU,
            false if turn > 0.0 => turn - TAU,
            _ => turn,
        }
    };
    Some((center, angle(b), angle(c)))
        .filter(|(_, to_b, turn)| *to_b != 0.0 && turn.abs() > to_b.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::Dimensions;

    fn points(list: &[(f64, f64)]) -> Points {
        Points::flat(list.iter().map(|&(x, y)| DVec2::new(x, y)).collect())
    }

    #[test]
    fn arcs_lie_on_their_circle_both_ways() {
        let there = flatten(&points(&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)])).expect("an arc");
        let mut back = flatten(&points(&[(2.0, 0.0), (1.0, 1.0), (0.0, 0.0)])).expect("an arc");
        back.xy.reverse();
        assert_eq!((there.len(), &there), (65, &back));
        for p in &there.xy {
            assert!(((*p - DVec2::X).length() - 1.0).abs() < 1e-15 && p.y >= -1e-15, "{p}");
        }
        let large = flatten(&points(&[(1.0, 0.0), (-1.0, 0.0), (0.0, -1.0)])).expect("an arc");
        assert_eq!(large.len(), 97);
        let whole = flatten(&points(&[(0.0, 0.0), (2.0, 0.0), (0.0, 0.0)])).expect("a circle");
        assert_eq!((whole.len(), whole.xy[0]), (129, whole.xy[128]));
        let straight = flatten(&points(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)])).expect("a line");
        assert_eq!(straight.len(), 3);
        assert!(flatten(&points(&[(0.0, 0.0), (1.0, 1.0)])).is_err());
    }

    #[test]
    fn heights_grow_along_arcs() {
        let mut control = Points::new(Dimensions::Xyz);
        for (x, y, z) in [(0.0, 0.0, 0.0), (1.0, 1.0, 4.0), (2.0, 0.0, 4.0)] {
            control.push(DVec2::new(x, y), [z, 0.0]);
        }
        let flat = flatten(&control).expect("an arc");
        assert!((flat.zm(16)[0] - 2.0).abs() < 1e-9 && (flat.zm(48)[0] - 4.0).abs() < 1e-9);
    }
}
