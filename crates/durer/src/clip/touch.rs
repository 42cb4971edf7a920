//! Points that are on an edge up to the rounding of their coordinates.
//!
//! A crossing is rounded by half an ulp on each axis, so it is mostly beside both edges. When clipped geometry is
//! clipped again, it must count as on them. The decision depends only on the point and the edge, so that all features
//! that have them agree.

use super::exact;
use crate::math::{DVec2, orient2d_value};
use std::cmp::Ordering;

/// Distance from an edge below which a point counts as on it, as a share of its larger coordinate: two to four ulp.
const NEAR: f64 = 2.0 * f64::EPSILON;

/// Returns the distance from a point within which it counts as reached.
#[inline]
pub(crate) fn reach(p: DVec2) -> f64 {
    p.abs().max_element() * NEAR
}

/// Returns whether two points count as one; the first argument is the distance for that.
#[inline]
pub(crate) fn are_one(p: DVec2, q: DVec2) -> bool {
    (p - q).abs().max_element() <= reach(p)
}

/// Returns whether a point is as good as on the line of an edge, and beside a part of that.
#[inline]
pub(crate) fn is_on(p: DVec2, edge: [DVec2; 2], line: [DVec2; 2]) -> bool {
    is_within(reach(p), p, edge, line)
}

/// Returns whether a point is no farther than `reach` from the line of an edge, and beside a part
/// of that.
#[inline]
pub(crate) fn is_within(reach: f64, p: DVec2, [a, b]: [DVec2; 2], [from, to]: [DVec2; 2]) -> bool {
    let beside = p.cmpge(a.min(b) - reach).all() && p.cmple(a.max(b) + reach).all();
    beside && is_near_line(p, [from, to], reach)
}

fn is_near_line(p: DVec2, [from, to]: [DVec2; 2], reach: f64) -> bool {
    let (off, bound) = (orient2d_value(from, to, p), reach * from.distance(to));
    // Huge coordinates overflow.
    if off.is_finite() && bound.is_finite() {
        off.abs() <= bound
    } else {
        exact::side(from, to, p) == Ordering::Equal
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounded_crossings_lie_on_both_edges_and_what_is_farther_does_not() {
        let p = DVec2::new;
        let (edge, mask) = ([p(1.0, 2.0), p(2.0, 5.0)], [p(-1.0, 3.0), p(5.0, 3.1)]);
        let at = exact::crossing(edge, mask).expect("they cross");
        assert!(is_on(at, edge, edge) && is_on(at, mask, mask));
        let beside = p(at.x + 1e-14, at.y);
        assert!(!is_on(beside, edge, edge) && are_one(at, p(at.x.next_up(), at.y)));
        assert!(!is_on(p(2.0, 5.1), edge, edge));
        assert!(!are_one(at, beside));
        let huge = [p(-1e300, -1e300), p(1e300, 1e300)];
        assert!(is_on(p(1e299, 1e299), huge, huge) && !is_on(p(1e299, 2e299), huge, huge));
    }
}
