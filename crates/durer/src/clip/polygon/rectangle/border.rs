//! Points on the window's border and their exact order around it.

use crate::clip::exact::{Exact, on_border};
use crate::math::{DVec2, Rect};
use std::cmp::Ordering;

/// Returns the corner with which each side of the window begins, counter-clockwise: bottom, right,
/// top, left.
pub(super) fn corners(window: &Rect) -> [DVec2; 4] {
    let (min, max) = (window.min(), window.max());
    [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)]
}

/// Returns the end of the visible part of an edge, where it is cut, correctly rounded.
#[inline]
pub(super) fn exact_cut(window: &Rect, point: DVec2, [a, b]: [DVec2; 2]) -> DVec2 {
    if point == a || point == b {
        return point;
    }
    let (min, max) = (window.min(), window.max());
    let cut = |axis: usize| {
        let border = point[axis];
        let crossed = (border == min[axis] || border == max[axis]) && a[axis] != b[axis];
        let other = 1 - axis;
        let at = crossed.then(|| on_border([a, b], axis, border))?;
        // Where rounding has moved the end to a corner, it may have crossed the other side.
        let mut cut = point;
        cut[other] = at;
        (min[other] <= at && at <= max[other]).then_some(cut)
    };
    cut(0).or_else(|| cut(1)).unwrap_or(point)
}

/// Point at which a chain touches the border, with the data that order it exactly.
#[derive(Debug, Clone, Copy)]
pub(super) struct BorderPoint {
    pub(super) point: DVec2,
    /// The side it counts for; a corner counts for the side that begins there.
    pub(super) side: usize,
    /// True if rounding, or its own place, has moved it to the corner from the side before.
    from_side_before: bool,
    /// The edge that touches the border here, from outside or the border to the inside.
    edge: [DVec2; 2],
}

impl BorderPoint {
    /// Creates a point of the border at which `edge` leads inside.
    pub(super) fn new(window: &Rect, point: DVec2, edge: [DVec2; 2]) -> Self {
        let (min, max) = (window.min(), window.max());
        let side = if point.y == min.y && point.x < max.x {
            0
        } else if point.x == max.x && point.y < max.y {
            1
        } else if point.y == max.y && point.x > min.x {
            2
        } else {
            3
        };
        let outside = edge[0];
        // At a corner the side that was crossed is the one the edge's outer end lies beyond.
        let from_side_before = point == corners(window)[side]
            && match side {
                0 => outside.x < min.x && outside.y >= min.y,
                1 => outside.y < min.y && outside.x <= max.x,
                2 => outside.x > max.x && outside.y <= max.y,
                _ => outside.y > max.y && outside.x >= min.x,
            };
        Self { point, side, from_side_before, edge }
    }

    /// Returns the order in which a walk around the border, counter-clockwise from the lower left corner, meets the
    /// points; among edges that meet in one point, the one turned furthest back comes first.
    pub(super) fn order(&self, other: &Self) -> Ordering {
        let by_side = self.side.cmp(&other.side);
        by_side.then_with(|| self.order_on_side(other))
    }

    fn order_on_side(&self, other: &Self) -> Ordering {
        let along = |b: &Self| b.point[b.side % 2];
        let (a, b) = (along(self), along(other));
        // Cut points are off by less than 4 ulp of their edge's ends.
        let size = |e: &[DVec2; 2]| e[0].abs().max_element().max(e[1].abs().max_element());
        let bound = (size(&self.edge) + size(&other.edge)) * (8.0 * f64::EPSILON);
        if (a - b).abs() > bound {
            // The lower and right sides are walked upwards, the others downwards.
            let ascending = a.total_cmp(&b);
            return if self.side < 2 { ascending } else { ascending.reverse() };
        }
        self.order_exactly(other)
    }

    #[cold]
    fn order_exactly(&self, other: &Self) -> Ordering {
        if self.from_side_before != other.from_side_before {
            return other.from_side_before.cmp(&self.from_side_before);
        }
        let crossed = if self.from_side_before { (self.side + 3) % 4 } else { self.side };
        let (a, b) = (self.crossing(crossed % 2), other.crossing(crossed % 2));
        let ascending = (a.0 * b.1 - b.0 * a.1).sign();
        let walked = if crossed < 2 { ascending } else { ascending.reverse() };
        walked.then_with(|| self.turned_back(other))
    }

    /// Returns the coordinate on `axis` of the exact point where the edge crosses the side:
    /// numerator and positive denominator.
    fn crossing(&self, axis: usize) -> (Exact, Exact) {
        let e = Exact::from;
        let across = 1 - axis;
        let (mut p, mut q) = (self.edge[0], self.edge[1]);
        if p[across] > q[across] {
            (p, q) = (q, p);
        }
        let border = self.point[across];
        if p[across] == q[across] || self.edge[0] == self.point {
            return (e(self.point[axis]), e(1.0));
        }
        let length = e(q[across]) - e(p[across]);
        let near = e(p[axis]) * (e(q[across]) - e(border));
        let far = e(q[axis]) * (e(border) - e(p[across]));
        (near + far, length)
    }

    /// Compares edges from one point of the border; the one nearest to the backward direction comes first.
    fn turned_back(&self, other: &Self) -> Ordering {
        let e = Exact::from;
        let direction = |b: &Self| {
            let [from, to] = b.edge;
            (e(to.x) - e(from.x), e(to.y) - e(from.y))
        };
        let ((ax, ay), (bx, by)) = (direction(self), direction(other));
        (ax * by - ay * bx).sign()
    }
}
