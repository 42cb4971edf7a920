//! Crossings in pairs of floats, of which the second holds the rounding error of the first (T. J.
//! Dekker, *A floating-point technique for extending the available precision*, 1971): about 100 bits.
//!
//! A coordinate is returned only if these bits determine its rounding.

use crate::math::DVec2;
use std::ops::{Add, Mul, Sub};

/// An unevaluated sum, the second term at most half an ulp of the first.
#[derive(Debug, Clone, Copy)]
struct Pair(f64, f64);

/// Products and quotients of pairs are off by less than this share of themselves, sums and differences
/// by less than this share of their terms; with room to spare.
const ERROR: f64 = 1.0 / (1u128 << 96) as f64;

/// Differences in this range, or 0, have products whose low parts neither overflow nor underflow.
const TAME: std::ops::Range<f64> = 1e-60..1e60;

impl Pair {
    /// Returns a + b, exactly.
    #[inline(always)]
    fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let of_b = high - a;
        Self(high, (a - (high - of_b)) + (b - of_b))
    }

    /// Returns a − b, exactly.
    #[inline(always)]
    fn difference(a: f64, b: f64) -> Self {
        Self::sum(a, -b)
    }

    /// Returns a · b, exactly.
    #[inline(always)]
    fn product(a: f64, b: f64) -> Self {
        let halves = |v: f64| {
            let big = v * 134_217_729.0;
            let high = big - (big - v);
            (high, v - high)
        };
        let high = a * b;
        let ((ah, al), (bh, bl)) = (halves(a), halves(b));
        Self(high, ((ah * bh - high) + ah * bl + al * bh) + al * bl)
    }

    /// Returns the same value, where the first term may have become too small.
    #[inline(always)]
    fn settled(high: f64, low: f64) -> Self {
        let sum = high + low;
        Self(sum, low - (sum - high))
    }

    #[inline(always)]
    fn over(self, other: Self) -> Self {
        let first = self.0 / other.0;
        let back = Self::product(first, other.0);
        let rest = ((self.0 - back.0) - back.1 + self.1) - first * other.1;
        Self::settled(first, rest / other.0)
    }

    fn is_tame(self) -> bool {
        self.0 == 0.0 || TAME.contains(&self.0.abs())
    }

    /// Returns the first term if every value within `error` of the sum rounds to it.
    #[inline(always)]
    fn rounded(self, error: f64) -> Option<f64> {
        let next = if self.1 > 0.0 { self.0.next_up() } else { self.0.next_down() };
        let half = (next - self.0).abs() * 0.5;
        (self.1.abs() + error < half).then_some(self.0)
    }
}

impl Add for Pair {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (high, low) = (Self::sum(self.0, other.0), Self::sum(self.1, other.1));
        let sum = Self::settled(high.0, high.1 + low.0);
        Self::settled(sum.0, sum.1 + low.1)
    }
}

impl Sub for Pair {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + Self(-other.0, -other.1)
    }
}

impl Mul for Pair {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let product = Self::product(self.0, other.0);
        Self::settled(product.0, product.1 + (self.0 * other.1 + self.1 * other.0))
    }
}

/// Returns the coordinate on axis k of the crossing of two segments' lines, if this determines its rounding.
pub(super) fn crossing(k: usize, [a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Option<f64> {
    let minus = |p: DVec2, q: DVec2| [0, 1].map(|k| Pair::difference(p[k], q[k]));
    let (along, across, between) = (minus(b, a), minus(d, c), minus(c, a));
    if ![along, across, between].iter().flatten().all(|d| d.is_tame()) {
        return None;
    }
    let cross = |p: [Pair; 2], q: [Pair; 2]| {
        let (left, right) = (p[0] * q[1], p[1] * q[0]);
        (left - right, (left.0.abs() + right.0.abs()) * ERROR)
    };
    let ((num, num_error), (den, den_error)) = (cross(between, across), cross(along, across));
    if den.0.abs() <= den_error * 2.0 {
        return None;
    }
    let t = num.over(den);
    // Twice, because the true denominator may be half as large.
    let t_error = (num_error + t.0.abs() * den_error) / den.0.abs() * 2.0 + t.0.abs() * ERROR;
    let way = along[k] * t;
    let sum = Pair(a[k], 0.0) + way;
    let error = along[k].0.abs() * t_error + (a[k].abs() + way.0.abs()) * ERROR;
    sum.rounded(error)
}

/// Returns the coordinate of a segment on the other axis where that on `axis` is `border`,
/// likewise.
#[inline]
pub(super) fn on_border([a, b]: [DVec2; 2], axis: usize, border: f64) -> Option<f64> {
    let other = 1 - axis;
    let length = Pair::difference(b[axis], a[axis]);
    let (run, rise) = (Pair::difference(border, a[axis]), Pair::difference(b[other], a[other]));
    if length.0 == 0.0 || ![length, run, rise].iter().all(|d| d.is_tame()) {
        return None;
    }
    let way = (rise * run).over(length);
    let sum = Pair(a[other], 0.0) + way;
    sum.rounded((a[other].abs() + way.0.abs()) * ERROR)
}
