//! The search for segments that may meet: those whose parts in a horizontal slab are near each
//! other.

use crate::math::DVec2;

/// Margin of a part beyond its slab, in slabs: more than rounding moves a height.
const MARGIN: f64 = 1e-6;

/// A segment's part in a slab.
#[derive(Debug, Clone, Copy)]
struct Part {
    low: f64,
    high: f64,
    segment: usize,
}

/// Reports all pairs of closed segments that have a point in common, and others that are near each other, some of them
/// several times. About O(n √n) time for n segments and O(n √n) memory if all are long, nearly O(n log n) and O(n) if
/// they are short.
pub(super) fn pairs(segments: &[[DVec2; 2]], mut found_pair: impl FnMut(usize, usize)) {
    let mut active: Vec<Part> = Vec::new();
    for mut parts in slabs(segments) {
        parts.sort_by(|p, q| p.low.total_cmp(&q.low));
        active.clear();
        for part in parts {
            active.retain(|other| other.high >= part.low);
            for other in &active {
                found_pair(part.segment, other.segment);
            }
            active.push(part);
        }
    }
}

/// Returns the parts of all segments in slabs of equal height.
fn slabs(segments: &[[DVec2; 2]]) -> Vec<Vec<Part>> {
    let bottom = segments.iter().flatten().fold(f64::INFINITY, |y, p| y.min(p.y));
    let top = segments.iter().flatten().fold(f64::NEG_INFINITY, |y, p| y.max(p.y));
    let count = libm::sqrt(segments.len() as f64) as usize + 1;
    // Halves, because the height of the whole may overflow.
    let place = |y: f64| (y * 0.5 - bottom * 0.5) / (top * 0.5 - bottom * 0.5) * count as f64;
    let slab = |y: f64| (place(y).max(0.0) as usize).min(count - 1);
    let mut slabs = vec![Vec::new(); count];
    for (segment, &[a, b]) in segments.iter().enumerate() {
        let (low, high) = (a.min(b), a.max(b));
        let (first, last) = (slab(low.y), slab(high.y));
        for (k, parts) in (first..).zip(&mut slabs[first..=last]) {
            // Where the segment's x is as it comes into the slab, and as it leaves it.
            let across = |edge: f64| {
                let t = (edge - place(a.y)) / (place(b.y) - place(a.y));
                a.x + (b.x - a.x) * t.clamp(0.0, 1.0)
            };
            let ends = [across(k as f64 - MARGIN), across((k + 1) as f64 + MARGIN)];
            let rounding = (a.x.abs() + b.x.abs()) * (8.0 * f64::EPSILON);
            let (from, to) = (ends[0].min(ends[1]) - rounding, ends[0].max(ends[1]) + rounding);
            let is_finite = ends.iter().all(|x| x.is_finite());
            let (low, high) = if is_finite { (from, to) } else { (low.x, high.x) };
            parts.push(Part { low, high, segment });
        }
    }
    slabs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Orientation, orient2d};

    /// Returns whether two segments have a point in common, by the signs of their ends.
    fn meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
        let side = |a, b, p| match orient2d(a, b, p) {
            Orientation::CounterClockwise => 1,
            Orientation::Clockwise => -1,
            Orientation::Collinear => 0,
        };
        let apart = a.max(b).cmplt(c.min(d)).any() || c.max(d).cmplt(a.min(b)).any();
        let across = side(a, b, c) * side(a, b, d) <= 0 && side(c, d, a) * side(c, d, b) <= 0;
        !apart && across
    }

    #[test]
    fn no_pair_that_meets_is_left_out() {
        let mut state = 3_u64;
        let mut random = |range: u64| {
            let step = (6_364_136_223_846_793_005, 1_442_695_040_888_963_407);
            state = state.wrapping_mul(step.0).wrapping_add(step.1);
            ((state >> 33) % range) as f64
        };
        for case in 0..2000 {
            let scale = [1.0, 1e-100, 1e100, 0.1][case % 4];
            let far = [0.0, 1e9 / 3.0][case / 4 % 2] * scale;
            let mut point = || DVec2::new(random(40), random(40)) * scale + DVec2::splat(far);
            let segments: Vec<[DVec2; 2]> = (0..30).map(|_| [point(), point()]).collect();
            let mut found = vec![[false; 30]; 30];
            pairs(&segments, |i, j| (found[i][j], found[j][i]) = (true, true));
            for i in 0..30 {
                for j in 0..i {
                    let missed = meet(segments[i], segments[j]) && !found[i][j];
                    assert!(!missed, "{case}: {:?} {:?}", segments[i], segments[j]);
                }
            }
        }
    }
}
