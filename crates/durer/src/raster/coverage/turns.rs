//! Contours that turn in only one direction.

use crate::math::DVec2;

/// Returns whether a closed contour turns in only one direction, once around.
pub(super) fn is_convex(points: &[DVec2]) -> bool {
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return true };
    let mut from = *last;
    let mut before = *last - points.iter().rev().find(|p| *p != last).unwrap_or(last);
    let (mut turn, mut changes) = (0.0, (0, 0));
    for to in points.iter().skip_while(|p| *p == first && first == last) {
        let along = *to - from;
        if along == DVec2::ZERO {
            continue;
        }
        let cross = before.perp_dot(along);
        if !cross.is_finite() || cross * turn < 0.0 {
            return false;
        }
        turn = if cross == 0.0 { turn } else { cross.signum() };
        changes.0 += i32::from((along.x < 0.0) != (before.x < 0.0));
        changes.1 += i32::from((along.y < 0.0) != (before.y < 0.0));
        (from, before) = (*to, along);
    }
    changes.0 <= 2 && changes.1 <= 2
}
