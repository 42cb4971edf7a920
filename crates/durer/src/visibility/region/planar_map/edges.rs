//! The lines along which the picture may be divided: sides of faces, and intersections of faces.

use super::cells::Cells;
use super::faces::{CLEARLY, Face, Place, float, nearest};
use crate::clip::polygon::overlay::lattice::cross;
use crate::math::DVec2;
use crate::parallel;

/// A segment on one or two faces, with its depth at both ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Grid; `a` before `b`.
    pub a: Place,
    pub b: Place,
    pub depths: [f64; 2],
    /// Largest error of its depth.
    pub error: f64,
}

/// Returns the sides of all faces over some cell, each once.
pub fn sides(faces: &[Face], cells: &Cells) -> Vec<Edge> {
    let mut seen = vec![false; faces.len()];
    for cell in 0..cells.count() {
        let cover = cells.cover(cell);
        for &i in cells.items(cell) {
            let face = &faces[i as usize];
            seen[i as usize] |= face.near - face.error <= cover;
        }
    }
    let mut edges = Vec::with_capacity(faces.len() * 2);
    for face in faces.iter().zip(seen).filter(|(_, seen)| *seen).map(|(face, _)| face) {
        for k in 0..3 {
            let (i, j) = (k, (k + 1) % 3);
            let (a, b) = (face.corners[i], face.corners[j]);
            let (from, to) = (face.depths[i], face.depths[j]);
            let (a, b, depths) = if a <= b { (a, b, [from, to]) } else { (b, a, [to, from]) };
            edges.push(Edge { a, b, depths, error: face.error });
        }
    }
    unite(&mut edges);
    edges
}

/// Keeps one of the edges between the same two points of space.
fn unite(edges: &mut Vec<Edge>) {
    // Most pairs meet in one bucket of their first point, which is cheaper than one great sort.
    edges.sort_unstable_by(|e, f| {
        (e.a, e.b)
            .cmp(&(f.a, f.b))
            .then_with(|| e.depths[0].total_cmp(&f.depths[0]))
            .then_with(|| e.depths[1].total_cmp(&f.depths[1]))
            .then_with(|| e.error.total_cmp(&f.error))
    });
    edges.dedup_by(|f, e| {
        let same = (e.a, e.b, e.depths) == (f.a, f.b, f.depths);
        if same {
            e.error = e.error.min(f.error);
        }
        same
    });
}

/// Number of cells in one task.
const TASK: usize = 1 << 12;

/// Finds the intersections of faces: a segment for each pair whose depths change their order.
pub fn intersections(faces: &[Face], cells: &Cells) -> Vec<Edge> {
    let starts: Vec<usize> = (0..cells.count()).step_by(TASK).collect();
    let found = parallel::map(starts, |start| {
        let mut pairs = Vec::new();
        for cell in start..(start + TASK).min(cells.count()) {
            in_cell(faces, cells, cell, &mut pairs);
        }
        pairs
    });
    let mut pairs: Vec<(u32, u32)> = found.into_iter().flatten().collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs.into_iter().filter_map(|(i, j)| segment(&faces[i as usize], &faces[j as usize])).collect()
}

fn in_cell(faces: &[Face], cells: &Cells, cell: usize, pairs: &mut Vec<(u32, u32)>) {
    let items = cells.items(cell);
    let cover = cells.cover(cell);
    for (k, &i) in items.iter().enumerate() {
        let f = &faces[i as usize];
        if f.near > cover {
            break;
        }
        for &j in &items[k + 1..] {
            let g = &faces[j as usize];
            if g.near > f.far {
                break;
            }
            if may_penetrate(f, g) {
                pairs.push((i.min(j), i.max(j)));
            }
        }
    }
}

/// Returns whether neither face is on one side of the other, and their projections overlap.
fn may_penetrate(f: &Face, g: &Face) -> bool {
    let ((f0, f1), (g0, g1)) = (f.bounds(), g.bounds());
    let apart = (f1.x <= g0.x) | (g1.x <= f0.x) | (f1.y <= g0.y) | (g1.y <= f0.y);
    if apart || shared(f, g) >= 2 {
        return false;
    }
    straddles(f, g) && straddles(g, f) && !separated(f, g) && !separated(g, f)
}

/// Returns corners that two faces have in common.
fn shared(f: &Face, g: &Face) -> usize {
    let has =
        |&(p, d): &(Place, f64)| g.corners.iter().zip(g.depths).any(|(&q, e)| p == q && d == e);
    f.corners.into_iter().zip(f.depths).filter(|v| has(v)).count()
}

/// Returns whether `f` has corners both in front of and behind the plane of `g`.
fn straddles(f: &Face, g: &Face) -> bool {
    let tolerance = f.error + g.error;
    let over = |k: usize| f.depths[k] - g.plane.depth(float(f.corners[k]));
    let d = [over(0), over(1), over(2)];
    d.iter().any(|&d| d > tolerance) && d.iter().any(|&d| d < -tolerance)
}

/// Returns whether a side of `f` keeps `g` outside; exact.
fn separated(f: &Face, g: &Face) -> bool {
    f.sides().iter().any(|&(a, b)| g.corners.iter().all(|&p| cross(a, b, p) <= 0))
}

/// Returns the segment over which two faces have the same depth.
fn segment(f: &Face, g: &Face) -> Option<Edge> {
    // The difference of the depths is linear; its zero line is cut by the six sides.
    let origin = float(f.corners[0]);
    let slope = f.plane.slope - g.plane.slope;
    let length = slope.length();
    if length == 0.0 || !length.is_finite() {
        return None;
    }
    let value = f.plane.depth(origin) - g.plane.depth(origin);
    let foot = origin - slope * (value / (length * length));
    let along = slope.perp() / length;
    let (mut from, mut to) = ((f64::NEG_INFINITY, 0.0), (f64::INFINITY, 0.0));
    for (a, b) in f.sides().into_iter().chain(g.sides()) {
        let (a, b) = (float(a), float(b));
        let (side, change) = ((b - a).perp_dot(foot - a), (b - a).perp_dot(along));
        let beyond = OVERSHOOT * a.distance(b) / change.abs();
        if change > 0.0 && -side / change > from.0 {
            from = (-side / change, beyond);
        } else if change < 0.0 && -side / change < to.0 {
            to = (-side / change, beyond);
        } else if change == 0.0 && side < 0.0 {
            return None;
        }
    }
    if !(to.0 - from.0 > 0.0 && from.0.is_finite() && to.0.is_finite()) {
        return None;
    }
    // A little further on both sides, so that it surely meets the sides that bound it.
    let (from, to) = (from.0 - from.1.min(FARTHEST), to.0 + to.1.min(FARTHEST));
    let ends = [foot + along * from, foot + along * to].map(nearest);
    let (a, b) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    let depths = [a, b].map(|p| f.depth(float(p)).min(g.depth(float(p))));
    (a != b).then_some(Edge { a, b, depths, error: f.error + g.error })
}

/// Length of visible pieces under the face that hides the rest, in grid steps from the side that they
/// pass. A division too much does no harm, for both its sides show the same face; one that ends, its
/// corners being rounded, before it meets the next would join separate faces.
const OVERSHOOT: f64 = 3.0;

/// Limit on the length along a side that is hardly left.
const FARTHEST: f64 = 65_536.0;

/// Hidden parts closer than this, in grid steps, are one: rounding at the borders of cells.
const GAP: f64 = 1e-3;

/// Number of edges in one task.
const EDGES: usize = 1 << 13;

/// A hidden part of an edge, and how far the visible parts beside it extend into it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Hidden {
    from: f64,
    to: f64,
    /// Parts of the edge's length.
    after_from: f64,
    before_to: f64,
}

/// Returns the pieces of the edges that no face hides, as segments of the grid.
pub fn visible(edges: &[Edge], faces: &[Face], cells: &Cells) -> Vec<(Place, Place)> {
    let pieces = parallel::map(edges.chunks(EDGES).collect(), |edges| {
        let mut pieces = Vec::with_capacity(edges.len());
        let mut hidden = Vec::new();
        for edge in edges {
            hidden_parts(edge, faces, cells, &mut hidden);
            visible_parts(edge, &mut hidden, &mut pieces);
        }
        pieces
    });
    pieces.into_iter().flatten().collect()
}

/// Finds the parts of an edge, as parts of its length, that are behind faces.
fn hidden_parts(edge: &Edge, faces: &[Face], cells: &Cells, hidden: &mut Vec<Hidden>) {
    hidden.clear();
    let (a, b) = (float(edge.a), float(edge.b));
    let [da, db] = edge.depths;
    let depth = |t: f64| da + (db - da) * t;
    cells.walk(a, b, |cell, from, to| {
        let (near, far) = {
            let (d, e) = (depth(from), depth(to));
            (d.min(e), d.max(e))
        };
        if near - CLEARLY * edge.error > cells.cover(cell) {
            hidden.push(Hidden { from, to, after_from: 0.0, before_to: 0.0 });
            return;
        }
        for &i in cells.items(cell) {
            let face = &faces[i as usize];
            if face.near > far {
                break;
            }
            let Some(mut part) = inside(edge, face) else { continue };
            if part.from < from {
                (part.from, part.after_from) = (from, 0.0);
            }
            if part.to > to {
                (part.to, part.before_to) = (to, 0.0);
            }
            if behind(edge, face, a, b, &mut part) {
                hidden.push(part);
                if part.from <= from && part.to >= to {
                    break;
                }
            }
        }
    });
}

/// Returns the part of an edge strictly inside a face, in the picture; which sides it crosses is
/// exact.
#[inline]
fn inside(edge: &Edge, face: &Face) -> Option<Hidden> {
    let mut part = Hidden { from: 0.0, to: 1.0, after_from: 0.0, before_to: 0.0 };
    for (p, q) in face.sides() {
        let (a, b) = (cross(p, q, edge.a), cross(p, q, edge.b));
        if a <= 0 && b <= 0 {
            return None;
        }
        if a >= 0 && b >= 0 {
            continue;
        }
        let (a, b) = (a as f64, b as f64);
        let t = a / (a - b);
        // Cross products over the side's length are distances from it.
        let beyond = || OVERSHOOT * float(p).distance(float(q)) / (a - b).abs();
        if a < 0.0 && t > part.from {
            (part.from, part.after_from) = (t, beyond());
        } else if b < 0.0 && t < part.to {
            (part.to, part.before_to) = (t, beyond());
        }
    }
    (part.from < part.to).then_some(part)
}

/// Reduces a part to the section clearly behind the face; returns whether anything is left.
#[inline]
fn behind(edge: &Edge, face: &Face, a: DVec2, b: DVec2, part: &mut Hidden) -> bool {
    let (from, to) = (part.from, part.to);
    if from >= to {
        return false;
    }
    let [da, db] = edge.depths;
    let tolerance = CLEARLY * (face.error + edge.error);
    let over = |t: f64| da + (db - da) * t - face.depth(a + (b - a) * t) - tolerance;
    let (s, e) = (over(from), over(to));
    let change = || from + (to - from) * (s / (s - e));
    match (s > 0.0, e > 0.0) {
        (false, false) => return false,
        (true, true) => {}
        (true, false) => (part.to, part.before_to) = (change(), 0.0),
        (false, true) => (part.from, part.after_from) = (change(), 0.0),
    }
    true
}

/// Adds the visible parts of an edge to `pieces`.
fn visible_parts(edge: &Edge, hidden: &mut [Hidden], pieces: &mut Vec<(Place, Place)>) {
    if hidden.is_empty() {
        pieces.push((edge.a, edge.b));
        return;
    }
    hidden.sort_unstable_by(|h, k| h.from.total_cmp(&k.from).then(h.to.total_cmp(&k.to)));
    let (a, b) = (float(edge.a), float(edge.b));
    let length = (b - a).length();
    let (gap, least) = (GAP / length, OVERSHOOT / length);
    let mut emit = |from: f64, to: f64| {
        let at = |t: f64| nearest(a + (b - a) * t);
        let p = if from <= 0.0 { edge.a } else { at(from) };
        let q = if to >= 1.0 { edge.b } else { at(to) };
        if p != q {
            pieces.push((p.min(q), p.max(q)));
        }
    };
    // The visible part that began last, if it has not ended.
    let mut start = Some(0.0);
    let mut rest = hidden.iter().peekable();
    while let Some(&first) = rest.next() {
        // Parts without gaps are one; its first and last ones determine how far the visible parts extend into it.
        let mut whole = first;
        while let Some(next) = rest.next_if(|next| next.from <= whole.to + gap) {
            if next.from <= whole.from + least {
                whole.after_from = whole.after_from.max(next.after_from);
            }
            if next.to > whole.to + least {
                whole.before_to = next.before_to;
            } else if next.to > whole.to - least {
                whole.before_to = whole.before_to.max(next.before_to);
            }
            whole.to = whole.to.max(next.to);
        }
        let from = if whole.from <= gap { 0.0 } else { whole.from + whole.after_from.max(least) };
        let to = if whole.to >= 1.0 - gap { 1.0 } else { whole.to - whole.before_to.max(least) };
        if from >= to {
            continue;
        }
        if let Some(start) = start.take().filter(|_| from > 0.0) {
            emit(start, from);
        }
        start = (to < 1.0).then_some(to);
        if start.is_none() {
            return;
        }
    }
    if let Some(start) = start {
        emit(start, 1.0);
    }
}
