//! The part of a line that one face hides, and the parts that all of them leave.
//!
//! In the plane of the picture a line is cut at the three borders of the face as Cyrus and Beck do,
//! with exact signs; along the line the difference of depths is linear, so the face's plane is one
//! more border. A line that runs along a border of the face is hidden on one side only; it counts
//! as hidden where both of its sides are.

use super::super::page::{Vertex, orient};
use super::absorb::absorb;
use super::occluders::Occluder;
use super::span::HiddenSpan;

/// The part of a line that one face hides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cover {
    /// The face's item.
    pub item: u32,
    /// Start of the part, 0 … 1 along the line.
    pub from: f64,
    /// End of the part, 0 … 1 along the line.
    pub to: f64,
    /// True if the left side of the line is hidden, seen along it, y up.
    pub left: bool,
    /// True if its right side is.
    pub right: bool,
    /// Number of surfaces that it counts for: 1, or −1 for a face that lies folded over an outline, where another
    /// of the same surface counts once too often.
    pub weight: i8,
}

/// Returns the part of the line p → q that lies behind the face; depths closer than `touching` are
/// equal.
pub(super) fn cover([p, q]: &[Vertex; 2], face: &Occluder, touching: f64) -> Option<Cover> {
    let [a, b, c] = face.corners;
    let nearest = a.depth.min(b.depth).min(c.depth);
    if nearest >= p.depth.max(q.depth) {
        return None;
    }
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    let (mut left, mut right) = (true, true);
    let mut sides = [(0.0, 0.0); 3];
    for (side, (u, v)) in sides.iter_mut().zip([(b, c), (c, a), (a, b)]) {
        let (s, e) = (orient(u.at, v.at, p.at), orient(u.at, v.at, q.at));
        *side = (s as f64, e as f64);
        if s <= 0 && e <= 0 {
            if s != 0 || e != 0 {
                return None;
            }
            // Along the border: the face lies to the left of u → v.
            let ([bx, by], [lx, ly]) = (v.at.minus(u.at), q.at.minus(p.at));
            let same = bx * lx + by * ly > 0;
            left &= same;
            right &= !same;
        } else if s < 0 {
            from = from.max(s as f64 / (s - e) as f64);
        } else if e < 0 {
            to = to.min(s as f64 / (s - e) as f64);
        }
    }
    if from >= to {
        return None;
    }
    let area = sides.iter().map(|s| s.0).sum::<f64>();
    let [z0, z1] = [from, to].map(|t| {
        let weights = sides.map(|(s, e)| (s + t * (e - s)).max(0.0));
        let z = (weights[0] * a.depth + weights[1] * b.depth + weights[2] * c.depth) / area;
        p.depth + t * (q.depth - p.depth) - z
    });
    let tolerance = touching + 2.0 * (slope(face, area) + line_slope(p, q));
    if z0 <= tolerance && z1 <= tolerance {
        return None;
    }
    // Behind the face at one end, before it at the other: it goes through.
    if z0 < -tolerance {
        from += (to - from) * (z0 / (z0 - z1));
    } else if z1 < -tolerance {
        to = from + (to - from) * (z0 / (z0 - z1));
    }
    let Occluder { item, weight, .. } = *face;
    (from < to).then_some(Cover { item, from, to, left, right, weight })
}

/// Returns the depth per step on the face: how far snapping may have moved its plane.
fn slope(face: &Occluder, area: f64) -> f64 {
    let [a, b, c] = face.corners;
    let ([bx, by], [cx, cy]) = (b.at.minus(a.at), c.at.minus(a.at));
    let (zb, zc) = (b.depth - a.depth, c.depth - a.depth);
    let gx = (zb * cy as f64 - zc * by as f64) / area;
    let gy = (zc * bx as f64 - zb * cx as f64) / area;
    gx.abs() + gy.abs()
}

fn line_slope(p: &Vertex, q: &Vertex) -> f64 {
    (q.depth - p.depth).abs() / p.at.distance(q.at)
}

/// Cuts a line where the number of faces in front changes; if not `counted`, where it becomes 0 or
/// ceases to be. Parts shorter than `sliver` (as a part of
/// the line) go to the longer of their neighbours. From one end to the other of `fold` it is hidden at least once.
pub(super) fn spans(
    covers: &[Cover],
    fold: [f64; 2],
    sliver: f64,
    counted: bool,
    found: &mut Vec<HiddenSpan>,
) {
    found.clear();
    let mut events: Vec<(f64, i32, i32)> = Vec::with_capacity(covers.len() * 2);
    for c in covers {
        let [l, r] = [c.left, c.right].map(|side| i32::from(side) * i32::from(c.weight));
        events.extend([(c.from, l, r), (c.to, -l, -r)]);
    }
    // Where nothing at all is in front, the curvature is that of a coarse mesh, and wrong.
    let [folds, unfolds] = if covers.is_empty() { [0.0; 2] } else { fold };
    if folds < unfolds {
        events.extend(fold.map(|t| (t, 0, 0)));
    }
    events.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((b.1, b.2).cmp(&(a.1, a.2))));
    let most = if counted { i32::MAX } else { 1 };
    let (mut at, mut left, mut right) = (0.0, 0, 0);
    for (t, l, r) in events.into_iter().chain([(1.0, 0, 0)]) {
        if t > at {
            let least = i32::from(folds <= at && at < unfolds);
            let invisibility = left.min(right).clamp(least, most) as u32;
            match found.last_mut() {
                Some(last) if last.invisibility == invisibility => last.to = t,
                _ => found.push(HiddenSpan { from: at, to: t, invisibility }),
            }
            at = t;
        }
        left += l;
        right += r;
    }
    absorb(sliver, found);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::visibility::line::page::GridPoint;

    fn vertex(x: i32, y: i32, depth: f64) -> Vertex {
        Vertex { at: GridPoint { x, y }, depth }
    }

    #[test]
    fn a_line_along_a_border_is_hidden_where_both_of_its_sides_are() {
        let line = [vertex(0, 0, 9.0), vertex(1000, 0, 9.0)];
        let face = |corners: [(i32, i32); 3]| Occluder {
            item: 0,
            corners: corners.map(|(x, y)| vertex(x, y, 1.0)),
            weight: 1,
        };
        let above = cover(&line, &face([(0, 0), (1000, 0), (0, 1000)]), 0.0).expect("a cover");
        let below = cover(&line, &face([(0, 0), (0, -1000), (1000, 0)]), 0.0).expect("a cover");
        assert_eq!([above, below].map(|c| (c.left, c.right)), [(true, false), (false, true)]);
        let [p, q] = line;
        let back = cover(&[q, p], &face([(0, 0), (1000, 0), (0, 1000)]), 0.0).expect("a cover");
        assert_eq!((back.left, back.right), (false, true));
        let mut found = Vec::new();
        for (covers, hidden) in [(vec![above], 0), (vec![below], 0), (vec![above, below], 1)] {
            spans(&covers, [0.0; 2], 0.0, true, &mut found);
            assert_eq!(found, [HiddenSpan { from: 0.0, to: 1.0, invisibility: hidden }]);
        }
    }

    #[test]
    fn slivers_go_to_the_longer_neighbour() {
        let part = |from, to| Cover { item: 0, from, to, left: true, right: true, weight: 1 };
        let mut found = Vec::new();
        let covers = [part(0.3, 0.3001), part(0.7, 1.0)];
        spans(&covers, [0.0; 2], 1e-3, true, &mut found);
        let ends: Vec<_> = found.iter().map(|s| (s.from, s.to, s.invisibility)).collect();
        assert_eq!(ends, [(0.0, 0.7, 0), (0.7, 1.0, 1)]);
        spans(&covers, [0.0; 2], 1e-5, true, &mut found);
        assert_eq!(found.len(), 4);
    }

    #[test]
    fn folded_faces_count_once_less_and_folds_hide_once() {
        let part = |from, to, weight| Cover { item: 0, from, to, left: true, right: true, weight };
        let counts = |covers: &[Cover], fold| {
            let mut found = Vec::new();
            spans(covers, fold, 0.0, true, &mut found);
            found.iter().map(|s| (s.from, s.to, s.invisibility)).collect::<Vec<_>>()
        };
        let folded = [part(0.0, 1.0, 1), part(0.25, 0.5, -1)];
        assert_eq!(counts(&folded, [0.0; 2]), [(0.0, 0.25, 1), (0.25, 0.5, 0), (0.5, 1.0, 1)]);
        // Surfaces in front of the fold count once, and without any nothing is hidden.
        let hidden = [part(0.5, 0.75, 1)];
        assert_eq!(counts(&hidden, [0.25, 1.0]), [(0.0, 0.25, 0), (0.25, 1.0, 1)]);
        assert_eq!(counts(&[], [0.25, 1.0]), [(0.0, 1.0, 0)]);
    }
}
