//! Edges of filled outlines clipped to a box, with the same winding numbers inside it.

use std::ops::Range;

use crate::math::DVec2;

/// Farther coordinates are moved here first, so that products stay finite.
const FARTHEST: f64 = 1e15;

/// Points that are examined together.
const BLOCK: usize = 32;

/// Lines of a contour that follow each other.
pub(crate) enum Lines<'a> {
    /// Lines along points that are all inside a box, from the first on.
    Inside(&'a DVec2, &'a [DVec2], &'a DVec2),
    /// Others, which may reach beyond.
    Any(&'a [DVec2], Range<usize>),
}

impl<'a> Lines<'a> {
    /// Returns the next lines of a closed contour that begin at the points in `own`, and removes these points from the
    /// range.
    #[inline(always)]
    pub fn next(
        points: &'a [DVec2],
        own: &mut Range<usize>,
        low: DVec2,
        high: DVec2,
    ) -> Option<Self> {
        if own.start >= own.end {
            return None;
        }
        let is_inside =
            |p: &DVec2| (p.x >= low.x) & (p.x <= high.x) & (p.y >= low.y) & (p.y <= high.y);
        let (first, end) = (own.start, own.end.min(own.start + BLOCK));
        own.start = end;
        match (points.get(first..end), points.get(end).or_else(|| points.first())) {
            (Some([from, rest @ ..]), Some(next))
                if rest
                    .iter()
                    .fold(is_inside(from) & is_inside(next), |all, p| all & is_inside(p)) =>
            {
                Some(Self::Inside(from, rest, next))
            }
            _ => Some(Self::Any(points, first..end)),
        }
    }
}

/// Returns the lines of a closed contour that begin at a range of its points; points that are not finite are
/// left out.
pub(crate) fn lines(points: &[DVec2], own: Range<usize>) -> impl Iterator<Item = (DVec2, DVec2)> {
    let begin = own.start;
    let own = points.get(own).unwrap_or_default().iter().enumerate();
    own.filter(|(_, from)| from.is_finite()).filter_map(move |(i, from)| {
        let (before, after) = points.split_at_checked(begin + i + 1)?;
        let to = after.iter().chain(before).find(|p| p.is_finite())?;
        Some((*from, *to))
    })
}

/// Clips an edge to the rows of a box, in the direction of travel: up to three pieces remain. Pieces left or right of
/// the box are moved onto its border, because left of it they still wind around everything in their rows.
///
/// The pieces depend only on the two ends, not on the direction, so both faces of a shared edge get the same pieces.
/// `None` if the edge is wholly above or below the box.
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
