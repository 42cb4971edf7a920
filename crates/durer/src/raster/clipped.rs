//! Edges of filled outlines cut at a box, so that what they wind around inside it stays the same.

use crate::math::DVec2;

/// Farther coordinates are moved here first, so that products stay finite.
const FARTHEST: f64 = 1e15;

/// What remains of an edge within the rows of a box, in the direction of travel: up to three pieces, those left
/// or right of the box moved onto its border, for left of it they still wind around everything in their rows.
///
/// Which pieces they are depends on the two ends alone and not on the direction, so both faces of a shared edge
/// get the same. `None` where the edge lies wholly above or below the box.
pub(crate) fn pieces(a: DVec2, b: DVec2, low: DVec2, high: DVec2) -> Option<[(DVec2, DVec2); 3]> {
    let far = DVec2::splat(FARTHEST);
    let (a, b) = (a.clamp(-far, far), b.clamp(-far, far));
    let reversed = (b.y, b.x) < (a.y, a.x);
    let (top, bottom) = if reversed { (b, a) } else { (a, b) };
    if bottom.y < low.y || top.y > high.y {
        return None;
    }
    // Cut at the first and last row, then at the left and right border.
    let at_y = |y: f64| {
        let t = (y - top.y) / (bottom.y - top.y);
        DVec2::new(top.x + (bottom.x - top.x) * t, y)
    };
    let start = if top.y < low.y { at_y(low.y) } else { top };
    let end = if bottom.y > high.y { at_y(high.y) } else { bottom };
    let at_x = |x: f64| {
        let y = top.y + (bottom.y - top.y) * ((x - top.x) / (bottom.x - top.x));
        DVec2::new(x, y.clamp(start.y, end.y))
    };
    let mut cuts = [start, start, end, end];
    let crosses = |x: f64| (start.x < x) != (end.x < x) && start.x != x && end.x != x;
    let (left, right) =
        (crosses(low.x).then(|| at_x(low.x)), crosses(high.x).then(|| at_x(high.x)));
    let (near, far) = if start.x <= end.x { (left, right) } else { (right, left) };
    cuts[1] = near.unwrap_or(start);
    cuts[2] = far.unwrap_or(end);
    let within = |p: DVec2| p.clamp(low, high);
    let piece = |i: usize| (within(cuts[i]), within(cuts[i + 1]));
    let pieces = [piece(0), piece(1), piece(2)];
    if !reversed {
        return Some(pieces);
    }
    let [p, q, r] = pieces.map(|(p, q)| (q, p));
    Some([r, q, p])
}
