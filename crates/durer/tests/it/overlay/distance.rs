//! The distance between the border of a region and that of an exact one, in both directions: the Hausdorff distance of
//! the borders, by brute force.

use durer::clip::polygon::overlay::Options;
use durer::clip::polygon::{BooleanOp, Shapes};
use durer::math::{DVec2, Orientation, orient2d};

type Edge = (DVec2, DVec2);

pub fn edges(shapes: &Shapes) -> Vec<Edge> {
    let pairs = |ring: &[DVec2]| -> Vec<Edge> {
        (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])).collect()
    };
    shapes.rings().flat_map(pairs).collect()
}

/// Returns the winding number around a point that is on no edge; exact.
fn winding(edges: &[Edge], p: DVec2) -> i32 {
    let turn = |&(a, b): &Edge| match (a.y <= p.y, b.y <= p.y, orient2d(a, b, p)) {
        (true, false, Orientation::CounterClockwise) => 1,
        (false, true, Orientation::Clockwise) => -1,
        _ => 0,
    };
    edges.iter().map(turn).sum()
}

fn distance((a, b): Edge, p: DVec2) -> f64 {
    let d = b - a;
    let t =
        if d == DVec2::ZERO { 0.0 } else { ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0) };
    (a + d * t).distance(p)
}

/// Returns the parts of the inputs' edges between crossings where the region differs on the two sides, tested at points
/// `off` beside their midpoints; so a border of the exact region passes within `off` of each midpoint.
fn border(a: &Shapes, b: &Shapes, op: BooleanOp, options: &Options, off: f64) -> Vec<Edge> {
    let (ours, theirs) = (edges(a), edges(b));
    let all: Vec<Edge> = ours.iter().chain(&theirs).copied().filter(|(p, q)| p != q).collect();
    let inside = |p: DVec2| {
        let (subject, clip) = (winding(&ours, p), winding(&theirs, p));
        op.keeps(options.subject_rule.fills(subject), options.clip_rule.fills(clip))
    };
    let mut border = Vec::new();
    for &(p, q) in &all {
        let d = q - p;
        let mut cuts = vec![0.0, 1.0];
        for &(r, s) in &all {
            let e = s - r;
            let across = d.perp_dot(e);
            if across != 0.0 {
                let (t, u) = ((r - p).perp_dot(e) / across, (r - p).perp_dot(d) / across);
                if t > 0.0 && t < 1.0 && (-1e-9..=1.0 + 1e-9).contains(&u) {
                    cuts.push(t);
                }
            } else if d.perp_dot(r - p) == 0.0 {
                let along = [r, s].map(|end| (end - p).dot(d) / d.length_squared());
                cuts.extend(along.into_iter().filter(|t| *t > 0.0 && *t < 1.0));
            }
        }
        cuts.sort_by(f64::total_cmp);
        let side = d.perp().normalize() * off;
        for pair in cuts.windows(2) {
            let middle = p + d * ((pair[0] + pair[1]) * 0.5);
            if inside(middle + side) != inside(middle - side) {
                border.push((p + d * pair[0], p + d * pair[1]));
            }
        }
    }
    border
}

/// Returns the largest distance from the result's border to the exact one, and vice versa.
pub fn both_ways(
    [a, b]: [&Shapes; 2],
    op: BooleanOp,
    options: &Options,
    result: &Shapes,
    off: f64,
) -> [f64; 2] {
    let (exact, found) = (border(a, b, op, options, off), edges(result));
    let farthest = |from: &[Edge], to: &[Edge]| {
        let points = from.iter().flat_map(|&(p, q)| [(p + q) * 0.5, p]);
        let nearest = |p: DVec2| to.iter().map(|&e| distance(e, p)).fold(f64::INFINITY, f64::min);
        points.map(nearest).fold(0.0, f64::max)
    };
    [farthest(&found, &exact), farthest(&exact, &found)]
}
