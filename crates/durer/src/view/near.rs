//! Points by place, and which of them rounding may have moved apart.
//!
//! Jon Bentley, *Multidimensional binary search trees used for associative searching*, Communications of the ACM, 1975:
//! a k-d tree. Building takes O(n log² n), a query about O(√n + k) for k points near a segment. Each half of a range is
//! on one side of its middle, so the tree is a permutation of the points and one axis per point.

use crate::math::DVec3;

/// Points of three dimensions, indexed to find those near a segment.
pub(crate) struct Places {
    /// Each point with its number; the middle of each range divides it.
    points: Vec<(DVec3, u32)>,
    /// The axis along which each point divides its range.
    axes: Vec<u8>,
}

/// A point near a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Found {
    /// The number of the point.
    pub number: u32,
    /// Parameter on the segment at which it is nearest, 0 … 1.
    pub at: f64,
}

impl Places {
    /// Sorts finite points, which are numbered in order.
    pub fn new(points: impl Iterator<Item = DVec3>) -> Self {
        let mut points: Vec<(DVec3, u32)> = points.zip(0..).collect();
        let mut axes = vec![0; points.len()];
        let mut ranges: Vec<std::ops::Range<usize>> = std::iter::once(0..points.len()).collect();
        while let Some(range) = ranges.pop() {
            if range.len() < 2 {
                continue;
            }
            let middle = range.start + range.len() / 2;
            let part = &mut points[range.clone()];
            let axis = widest(part);
            part.select_nth_unstable_by(range.len() / 2, |a, b| {
                a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1))
            });
            axes[middle] = axis as u8;
            ranges.extend([range.start..middle, middle + 1..range.end]);
        }
        Self { points, axes }
    }

    /// Calls `f` with each point no further than `reach` from a segment, which may be a point; in no
    /// particular order.
    pub fn along(&self, [p, q]: [DVec3; 2], reach: f64, mut f: impl FnMut(Found)) {
        let way = q - p;
        let slack = reach * (1.0 + 1e-6);
        let mut ranges = vec![(0..self.points.len(), 0.0, 1.0)];
        while let Some((range, from, to)) = ranges.pop() {
            let middle = range.start + range.len() / 2;
            let Some(&(point, number)) = self.points[..range.end].get(middle) else { continue };
            let at = ((point - p).dot(way) / way.length_squared()).clamp(0.0, 1.0);
            let at = if at.is_nan() { 0.0 } else { at };
            if (p + way * at).distance_squared(point) <= reach * reach {
                f(Found { number, at });
            }
            let axis = self.axes[middle] as usize;
            let (start, step, border) = (p[axis], way[axis], point[axis]);
            if let Some((a, b)) = below(start, step, border + slack, (from, to)) {
                ranges.push((range.start..middle, a, b));
            }
            if let Some((a, b)) = below(-start, -step, slack - border, (from, to)) {
                ranges.push((middle + 1..range.end, a, b));
            }
        }
    }
}

/// The spacing of numbers with 24 bits, as a part of them; or half of it.
pub(crate) const STEP: f64 = 1.0 / (1u64 << 23) as f64;

/// Distance, in spacings of numbers, within which borders coincide: 2⁻¹⁶ of the largest coordinate. Errors of programs
/// that compute in single precision are rarely larger, and no drawing shows smaller distances.
const STEPS: f64 = 128.0;

/// Units of the last written digit within which borders coincide: each coordinate is rounded by up to half a unit.
const DIGITS: f64 = 2.0;

/// Part of the extent above which a file's last digit is not taken for rounding.
const COARSEST: f64 = 1.0 / 1024.0;

/// Largest distance that a border's end moves, as a part of the longest border at it, so that small features are not
/// lost.
pub(crate) const OF_EDGE: f64 = 1.0 / 16.0;

/// Returns the largest distance between ends of borders that were one point, where numbers as large as the largest
/// coordinate are `step` apart and the last digit of coordinates is worth `digit`, 0 if not known.
pub(crate) fn reach(step: f64, digit: f64, extent: f64) -> f64 {
    let written = if digit <= extent * COARSEST { digit * DIGITS } else { 0.0 };
    (step * STEPS).max(written)
}

impl Places {
    /// Returns the point that each point becomes: each one, in order, takes the points that are mutually in reach and
    /// not taken by an earlier one. So joined points are within two reaches, however many form a chain.
    pub fn joined(
        &self,
        points: &[DVec3],
        reaches: &[f64],
        may_join: impl Fn(usize, usize) -> bool,
    ) -> Vec<(usize, usize)> {
        let mut taken = vec![false; points.len()];
        let mut joined = Vec::new();
        for (i, p) in points.iter().enumerate() {
            if std::mem::replace(&mut taken[i], true) {
                continue;
            }
            self.along([*p, *p], reaches[i], |found| {
                let k = found.number as usize;
                let near = || p.distance_squared(points[k]) <= reaches[k] * reaches[k];
                if !taken[k] && may_join(k, i) && near() {
                    taken[k] = true;
                    joined.push((k, i));
                }
            });
        }
        joined
    }
}

/// Returns the axis along which the points are spread most.
fn widest(points: &[(DVec3, u32)]) -> usize {
    let (min, max) = points
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| (lo.min(p.0), hi.max(p.0)));
    let size = max - min;
    if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    }
}

/// Returns the part of a range of t where start + t · step is at most `limit`.
fn below(start: f64, step: f64, limit: f64, (from, to): (f64, f64)) -> Option<(f64, f64)> {
    if step == 0.0 {
        return (start <= limit).then_some((from, to));
    }
    let t = (limit - start) / step;
    let (from, to) = if step > 0.0 { (from, to.min(t)) } else { (from.max(t), to) };
    (from <= to).then_some((from, to))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_near_a_segment_are_those_that_a_look_at_all_finds() {
        let mut state = 7_u64;
        let mut next = || {
            state =
                state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        let mut point = || DVec3::new(next(), next(), (next() * 4.0).floor());
        let points: Vec<DVec3> = (0..300).map(|_| point()).collect();
        let places = Places::new(points.iter().copied());
        for reach in [0.0, 0.05, 0.3] {
            for i in 0..60 {
                let ends = [points[i], if i % 3 == 0 { points[i] } else { point() }];
                let mut found = Vec::new();
                places.along(ends, reach, |f| found.push(f.number));
                found.sort_unstable();
                let way = ends[1] - ends[0];
                let near = |p: &DVec3| {
                    let at = ((*p - ends[0]).dot(way) / way.length_squared().max(1e-300))
                        .clamp(0.0, 1.0);
                    (ends[0] + way * at).distance(*p) <= reach
                };
                let all: Vec<u32> = (0..300).filter(|&k| near(&points[k as usize])).collect();
                assert_eq!(found, all);
            }
        }
        assert_eq!(Places::new(std::iter::empty()).points.len(), 0);
    }
}
