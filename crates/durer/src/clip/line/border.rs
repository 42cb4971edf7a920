//! The code that algorithms for axis-parallel windows share: borders, canonical direction, cut
//! points.

use super::Segment;
use crate::clip::exact;
use crate::clip::outcode::Outcode;
use crate::math::{DVec2, DVec3, Plane, Rect};
use crate::{Error, Result};
use std::cmp::Ordering;

/// One of the two ends of a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum End {
    /// The first point.
    Start,
    /// The last point.
    End,
}

impl End {
    /// Returns the other end where `swapped`.
    pub(super) fn swapped_if(self, swapped: bool) -> Self {
        match (self, swapped) {
            (Self::Start, true) => Self::End,
            (Self::End, true) => Self::Start,
            (same, false) => same,
        }
    }
}

impl<P> Segment<P> {
    /// Replaces one end; for replaying a trace.
    pub(super) fn moved(mut self, end: End, point: P) -> Self {
        match end {
            End::Start => self.start = point,
            End::End => self.end = point,
        }
        self
    }
}

/// A closed axis-parallel window in N dimensions: a rectangle or a box.
///
/// # Guarantees
/// All numbers are finite and min ≤ max on every axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClipBox<const N: usize> {
    /// `borders[axis]` is [smallest, largest].
    pub(super) borders: [[f64; 2]; N],
}

impl ClipBox<3> {
    /// Creates the box between two corners.
    ///
    /// # Errors
    /// [`Error::Parameter`] if a number is not finite or `min > max` on an axis.
    pub fn new(min: DVec3, max: DVec3) -> Result<Self> {
        if min.is_finite() && max.is_finite() && min.cmple(max).all() {
            let (min, max) = (min.to_array(), max.to_array());
            Ok(Self { borders: std::array::from_fn(|k| [min[k] + 0.0, max[k] + 0.0]) })
        } else {
            let value = format!("{min} … {max}");
            Err(Error::parameter("box", value, "finite, with min ≤ max on every axis"))
        }
    }
}

impl ClipBox<3> {
    /// Returns the six planes of the border, normals inwards: smallest and largest x, y, z.
    pub fn planes(&self) -> [Plane; 6] {
        std::array::from_fn(|i| {
            let (axis, upper) = (i / 2, i % 2);
            let sign = if upper == 0 { 1.0 } else { -1.0 };
            let mut normal = [0.0; 3];
            normal[axis] = sign;
            Plane { normal: normal.into(), distance: -sign * self.borders[axis][upper] }
        })
    }
}

impl From<&Rect> for ClipBox<2> {
    #[inline]
    fn from(window: &Rect) -> Self {
        let (min, max) = (window.min(), window.max());
        // Adding zero turns −0 into 0: a cut point's bits must not depend on the border's sign.
        Self { borders: [[min.x + 0.0, max.x + 0.0], [min.y + 0.0, max.y + 0.0]] }
    }
}

/// Returns the outcode bit of a border; bit 0 of `upper` chooses the larger coordinate.
#[inline]
pub(super) fn bit(axis: usize, upper: usize) -> Outcode {
    Outcode(1 << (2 * axis + upper))
}

/// Returns the axis and side of the lowest bit of a code that is not empty.
#[inline]
pub(super) fn lowest_border(code: Outcode) -> (usize, usize) {
    let k = code.0.trailing_zeros() as usize;
    (k >> 1, k & 1)
}

impl<const N: usize> ClipBox<N> {
    /// Returns the borders that the point is beyond; comparisons are exact.
    #[inline]
    pub(super) fn code(&self, p: [f64; N]) -> Outcode {
        let mut code = 0;
        for (k, (v, [min, max])) in p.iter().zip(&self.borders).enumerate() {
            // Negated, so that NaN is beyond both.
            let (above_min, below_max) = (v >= min, v <= max);
            code |= u8::from(!above_min) << (2 * k) | u8::from(!below_max) << (2 * k + 1);
        }
        Outcode(code)
    }
}

/// A segment from its lexicographically smaller to its larger end point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Canonical<const N: usize> {
    pub(super) p: [f64; N],
    pub(super) q: [f64; N],
    /// True if the caller's segment runs the other way.
    pub(crate) swapped: bool,
}

impl<const N: usize> Canonical<N> {
    /// Creates the segment from its lexicographically smaller to its larger end point.
    ///
    /// # Errors
    /// [`Error::NonFinite`], with index 0 for the start and 1 for the end.
    #[inline]
    pub(crate) fn new(start: [f64; N], end: [f64; N]) -> Result<Self> {
        if !both_finite(&start, &end) {
            return Err(non_finite(&start));
        }
        let swapped = is_greater(&start, &end);
        let [p, q] = exchanged_if(swapped, start, end);
        Ok(Self { p, q, swapped })
    }

    /// Returns the two points in the caller's direction.
    #[inline]
    pub(super) fn in_order<P: From<[f64; N]>>(&self, p: [f64; N], q: [f64; N]) -> Segment<P> {
        let [start, end] = exchanged_if(self.swapped, p, q);
        Segment { start: start.into(), end: end.into() }
    }

    /// Returns the crossing with `x[axis] = border`, which the segment must span.
    ///
    /// The coordinate on the axis is the border itself; the others are within 4 ulp of the largest
    /// coordinate, and on the side of each border of the window that the exact crossing is on.
    // A call would pass the cut through memory, which costs as much as computing it.
    #[inline(always)]
    pub(super) fn cut(&self, window: &ClipBox<N>, axis: usize, upper: usize) -> [f64; N] {
        let border = window.borders[axis][upper];
        let length = self.q[axis] - self.p[axis];
        let t = (border - self.p[axis]) / length;
        let mut point = [border; N];
        // The other axes, without a branch that depends on which axis it is.
        for k in (1..N).map(|step| (axis + step) % N) {
            let (p, q, [min, max]) = (self.p[k], self.q[k], window.borders[k]);
            let near = p + (q - p) * t;
            let margin = doubt(p, q);
            point[k] = near;
            // Huge coordinates make one of these infinite or NaN, and then the tests fail.
            let sure = length.abs() < f64::MAX;
            if sure && near - min > margin && max - near > margin {
                continue;
            }
            // Beyond a border by more than any rounding, it needs no exact test either.
            let below = min - near > margin && near > -f64::MAX;
            let above = near - max > margin && near < f64::MAX;
            if !sure || !(below || above) {
                self.settle_cut(window, (axis, border), k, &mut point);
            }
        }
        point
    }

    /// Decides exactly on which side of the borders of axis k the crossing with `border` is, and
    /// puts the rounded point there.
    #[inline(never)]
    pub(super) fn settle_cut(
        &self,
        window: &ClipBox<N>,
        (axis, border): (usize, f64),
        k: usize,
        point: &mut [f64; N],
    ) -> Outcode {
        point[k] = self.interpolate(axis, border)[k];
        let [min, max] = window.borders[k];
        match self.compare_cut((axis, border), (k, min), point[k]) {
            Ordering::Less => return bit(k, 0),
            Ordering::Equal => point[k] = min,
            Ordering::Greater => match self.compare_cut((axis, border), (k, max), point[k]) {
                Ordering::Greater => return bit(k, 1),
                Ordering::Equal => point[k] = max,
                // Strictly between the two: rounding must not put it elsewhere.
                Ordering::Less => point[k] = clamped(point[k], min, max),
            },
        }
        Outcode::INSIDE
    }

    /// Returns p + (q − p)·t with t = (border − p) / (q − p) on the axis.
    #[inline]
    pub(super) fn interpolate(&self, axis: usize, border: f64) -> [f64; N] {
        let mut point = self.at(self.parameter(axis, border));
        point[axis] = border;
        point
    }

    /// Returns t of the crossing with a border: 0 at p, 1 at q.
    #[inline]
    pub(super) fn parameter(&self, axis: usize, border: f64) -> f64 {
        let (p, q) = (self.p[axis], self.q[axis]);
        let length = q - p;
        if length.is_finite() {
            (border - p) / length
        } else {
            (border * 0.125 - p * 0.125) / (q * 0.125 - p * 0.125)
        }
    }

    /// Returns p + (q − p)·t for 0 ≤ t ≤ 1; finite even where q − p is not.
    #[inline]
    pub(crate) fn at(&self, t: f64) -> [f64; N] {
        let (p, q) = (&self.p, &self.q);
        let point: [f64; N] = std::array::from_fn(|k| p[k] + (q[k] - p[k]) * t);
        if finite(&point) { point } else { self.at_huge(t) }
    }

    /// Returns the point of [`Self::at`] where a difference overflows: with everything scaled by an eighth.
    #[cold]
    fn at_huge(&self, t: f64) -> [f64; N] {
        let (p, q) = (self.p.map(|v| v * 0.125), self.q.map(|v| v * 0.125));
        std::array::from_fn(|k| clamped((p[k] + (q[k] - p[k]) * t) * 8.0, f64::MIN, f64::MAX))
    }

    /// Returns the exact crossing's coordinate `k` compared with `other`; `near` is its rounded
    /// value.
    #[inline]
    fn compare_cut(
        &self,
        (axis, border): (usize, f64),
        (k, other): (usize, f64),
        near: f64,
    ) -> Ordering {
        let bound = doubt(self.p[k], self.q[k]);
        let gap = near - other;
        if gap.abs() > bound {
            return if gap > 0.0 { Ordering::Greater } else { Ordering::Less };
        }
        self.compare_cut_exactly((axis, border), (k, other))
    }

    /// Compares the parameters at which the segment, which must span both borders, crosses them;
    /// decided exactly.
    pub(super) fn compare_parameters(&self, a: (usize, f64), b: (usize, f64)) -> Ordering {
        let (ta, tb) = (self.parameter(a.0, a.1), self.parameter(b.0, b.1));
        // Each is off by at most 3ε of itself.
        if (ta - tb).abs() > (ta + tb) * (8.0 * exact::EPSILON) + 1e-290 {
            return ta.total_cmp(&tb);
        }
        let order = if a.0 == b.0 {
            a.1.partial_cmp(&b.1).unwrap_or(Ordering::Equal)
        } else {
            self.compare_cut_exactly(a, b)
        };
        if self.p[b.0] < self.q[b.0] { order } else { order.reverse() }
    }

    /// Returns the exact crossing with border `a` compared with border `b` of another axis: −, 0, +
    /// where its coordinate there is smaller, equal, larger.
    ///
    /// The corner (border, other) lies left or right of the segment projected on the two axes.
    #[inline(never)]
    pub(super) fn compare_cut_exactly(&self, a: (usize, f64), b: (usize, f64)) -> Ordering {
        let project = |v: &[f64; N]| DVec2::new(v[a.0], v[b.0]);
        let (mut p, mut q) = (project(&self.p), project(&self.q));
        if p.x > q.x {
            (p, q) = (q, p);
        }
        exact::side(p, q, DVec2::new(a.1, b.1)).reverse()
    }
}

/// Returns whether a comes after b lexicographically; without branches, which half of all segments would mispredict.
#[inline]
pub(super) fn is_greater<const N: usize>(a: &[f64; N], b: &[f64; N]) -> bool {
    (0..N).rev().fold(false, |rest, k| (a[k] > b[k]) | ((a[k] == b[k]) & rest))
}

/// Returns [b, a] where `swap`, else [a, b]; by masks, for the same reason as [`is_greater`].
#[inline]
fn exchanged_if<const N: usize>(swap: bool, a: [f64; N], b: [f64; N]) -> [[f64; N]; 2] {
    let mask = 0u64.wrapping_sub(u64::from(swap));
    let (mut x, mut y) = (a, b);
    for k in 0..N {
        let (p, q) = (a[k].to_bits(), b[k].to_bits());
        let difference = (p ^ q) & mask;
        (x[k], y[k]) = (f64::from_bits(p ^ difference), f64::from_bits(q ^ difference));
    }
    [x, y]
}

/// Returns whether no coordinate is NaN or infinite; zero times anything else is zero.
#[inline]
pub(super) fn finite<const N: usize>(p: &[f64; N]) -> bool {
    p.iter().fold(0.0, |sum, &v| sum + v * 0.0) == 0.0
}

/// Returns whether that holds for both; one comparison.
#[inline]
fn both_finite<const N: usize>(p: &[f64; N], q: &[f64; N]) -> bool {
    (0..N).fold(0.0, |sum, k| sum + (p[k] * 0.0 + q[k] * 0.0)) == 0.0
}

/// Returns a bound on the error of a coordinate computed between p and q: it is less than 5 halves
/// of an ulp of the larger of them, or the error of underflow.
#[inline]
pub(super) fn doubt(p: f64, q: f64) -> f64 {
    (p.abs() + q.abs()) * (16.0 * exact::EPSILON) + 1e-290
}

/// Clamps without the platform's choice between 0.0 and −0.0.
#[inline]
pub(super) fn clamped(v: f64, min: f64, max: f64) -> f64 {
    if v < min {
        min
    } else if v > max {
        max
    } else {
        v
    }
}

/// Returns the error for a segment whose start, if not its end, has a NaN or infinite coordinate.
#[cold]
pub(super) fn non_finite(start: &[f64]) -> Error {
    let index = usize::from(start.iter().all(|v| v.is_finite()));
    Error::NonFinite { what: "segment end point", index }
}
