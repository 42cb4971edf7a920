//! Exact signs for every finite input, the extremes of the number range included.
//!
//! A floating-point filter decides nearly all cases. The remaining ones use integers of unbounded length, to which f64
//! values are scaled by a power of two, because expansion arithmetic is no longer exact when products overflow or
//! underflow.

use crate::math::{DVec2, orient2d_value};
use std::cmp::Ordering;
use std::ops::{Add, Mul, Sub};

mod pair;

/// Half an ulp of 1: the largest relative error of one rounded operation.
pub(crate) const EPSILON: f64 = f64::EPSILON * 0.5;

/// Products below this may have lost bits to underflow, so a filter must not trust them.
const TRUSTED_MIN: f64 = 1e-270;

/// Returns the side of the directed line a → b on which the point c is: `Greater` left, `Less` right.
#[inline]
pub(crate) fn side(a: DVec2, b: DVec2, c: DVec2) -> Ordering {
    let (left, right) = ((b.x - a.x) * (c.y - a.y), (b.y - a.y) * (c.x - a.x));
    // Three roundings in each product and one in the difference: 4ε would do, 8ε is safe.
    let bound = (left.abs() + right.abs()) * (8.0 * EPSILON);
    let det = left - right;
    // Written so that an overflow (infinite bound, NaN determinant) falls through.
    if det.abs() > bound && bound > TRUSTED_MIN * EPSILON {
        return if det > 0.0 { Ordering::Greater } else { Ordering::Less };
    }
    side_exact(a, b, c)
}

#[cold]
#[inline(never)]
fn side_exact(a: DVec2, b: DVec2, c: DVec2) -> Ordering {
    // Shewchuk's expansions are exact, and fast, where nothing overflows or underflows.
    let tame = |v: f64| v == 0.0 || (v.abs() > 1e-100 && v.abs() < 1e100);
    if [a, b, c].iter().all(|p| tame(p.x) && tame(p.y)) {
        return orient2d_value(a, b, c).partial_cmp(&0.0).unwrap_or(Ordering::Equal);
    }
    side_in_whole_numbers(a, b, c)
}

fn side_in_whole_numbers(a: DVec2, b: DVec2, c: DVec2) -> Ordering {
    let e = Exact::from;
    let left = (e(b.x) - e(a.x)) * (e(c.y) - e(a.y));
    let right = (e(b.y) - e(a.y)) * (e(c.x) - e(a.x));
    (left - right).sign()
}

/// Returns the point where two closed segments cross, each coordinate correctly rounded: the same
/// bits for either order and direction. `None` if they are apart or collinear.
pub(crate) fn crossing([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Option<DVec2> {
    let apart = |s: Ordering, t: Ordering| s == t;
    if apart(side(a, b, c), side(a, b, d)) || apart(side(c, d, a), side(c, d, b)) {
        return None;
    }
    let axis = |k: usize| crossing_on_axis(k, [a, b], [c, d]);
    Some(DVec2::new(axis(0), axis(1)))
}

fn crossing_on_axis(k: usize, [a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> f64 {
    // A border of a window is met as it is; adding zero turns −0 into 0.
    if a[k] == b[k] {
        return a[k] + 0.0;
    }
    if c[k] == d[k] {
        return c[k] + 0.0;
    }
    pair::crossing(k, [a, b], [c, d])
        .unwrap_or_else(|| crossing_in_whole_numbers(k, [a, b], [c, d]))
}

#[cold]
#[inline(never)]
fn crossing_in_whole_numbers(k: usize, [a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> f64 {
    let minus = |p: DVec2, q: DVec2, k: usize| Exact::from(p[k]) - Exact::from(q[k]);
    let cross = |p: [DVec2; 2], q: [DVec2; 2]| {
        minus(p[1], p[0], 0) * minus(q[1], q[0], 1) - minus(p[1], p[0], 1) * minus(q[1], q[0], 0)
    };
    let (num, den) = (cross([a, c], [c, d]), cross([a, b], [c, d]));
    (Exact::from(a[k]) * den.clone() + minus(b, a, k) * num).rounded_ratio(&den)
}

/// Returns the coordinate on the other axis where the segment a → b, which spans it, crosses the
/// line on which the coordinate on `axis` is `border`; correctly rounded.
pub(crate) fn on_border([a, b]: [DVec2; 2], axis: usize, border: f64) -> f64 {
    let other = 1 - axis;
    if a[other] == b[other] {
        return a[other] + 0.0;
    }
    pair::on_border([a, b], axis, border).unwrap_or_else(|| {
        let minus = |p: f64, q: f64| Exact::from(p) - Exact::from(q);
        let length = minus(b[axis], a[axis]);
        let rise = minus(b[other], a[other]) * minus(border, a[axis]);
        (Exact::from(a[other]) * length.clone() + rise).rounded_ratio(&length)
    })
}

/// An exact dyadic rational: ± magnitude · 2^exponent.
#[derive(Debug, Clone)]
pub struct Exact {
    negative: bool,
    /// Little-endian digits; no zero digit at the upper end, empty for zero.
    digits: Vec<u32>,
    exponent: i32,
}

impl From<f64> for Exact {
    /// Returns the exact value of a finite number.
    fn from(value: f64) -> Self {
        let bits = value.to_bits();
        let raw = ((bits >> 52) & 0x7ff) as i32;
        let fraction = bits & ((1 << 52) - 1);
        let (mantissa, exponent) =
            if raw == 0 { (fraction, -1074) } else { (fraction | 1 << 52, raw - 1075) };
        // Trailing zeros go to the exponent, which keeps small integers to one digit.
        let zeros = if mantissa == 0 { 0 } else { mantissa.trailing_zeros() };
        let mantissa = mantissa >> zeros;
        let digits = trimmed(vec![mantissa as u32, (mantissa >> 32) as u32]);
        Self { negative: value < 0.0, digits, exponent: exponent + zeros as i32 }
    }
}

impl Exact {
    /// Compares the number with zero.
    pub(crate) fn sign(&self) -> Ordering {
        match (self.digits.is_empty(), self.negative) {
            (true, _) => Ordering::Equal,
            (false, true) => Ordering::Less,
            (false, false) => Ordering::Greater,
        }
    }

    /// Returns self / other, to within 2 ulp; 0 where `other` is 0.
    pub(crate) fn ratio(&self, other: &Self) -> f64 {
        // The upper 96 bits of each, and the powers of two that were left out.
        let leading = |v: &Self| {
            let top = v.digits.iter().rev().take(3);
            let mantissa = top.fold(0.0, |sum, &d| sum * 4_294_967_296.0 + f64::from(d));
            let dropped = v.digits.len().saturating_sub(3) as i32;
            (if v.negative { -mantissa } else { mantissa }, v.exponent + 32 * dropped)
        };
        let ((a, ea), (b, eb)) = (leading(self), leading(other));
        if b == 0.0 { 0.0 } else { libm::scalbn(a / b, ea - eb) }
    }

    /// Returns self / other, correctly rounded, ties to even, where it is finite; 0 where `other` is 0.
    pub(crate) fn rounded_ratio(&self, other: &Self) -> f64 {
        let mut near = self.ratio(other);
        let (num, den) = match other.sign() {
            Ordering::Equal => return 0.0,
            Ordering::Greater => (self.clone(), other.clone()),
            Ordering::Less => (Self::from(0.0) - self.clone(), Self::from(0.0) - other.clone()),
        };
        let twice = num.clone() + num;
        // The quotient compared with the middle between two neighbours.
        let beyond = |p: f64, q: f64| {
            let middle = (Self::from(p) + Self::from(q)) * den.clone();
            (twice.clone() - middle).sign()
        };
        let odd = |v: f64| v.to_bits() & 1 == 1;
        // An error of at most two ulp needs no more steps.
        for _ in 0..4 {
            let (up, down) = (near.next_up(), near.next_down());
            near = match (beyond(near, up), beyond(down, near)) {
                (Ordering::Greater, _) => up,
                (Ordering::Equal, _) if odd(near) => up,
                (_, Ordering::Less) => down,
                (_, Ordering::Equal) if odd(near) => down,
                _ => break,
            };
            if !near.is_finite() {
                break;
            }
        }
        near + 0.0
    }

    /// Returns the digits when the number is written with a smaller exponent.
    fn aligned(&self, exponent: i32) -> Vec<u32> {
        let shift = self.exponent.saturating_sub(exponent).max(0) as u32;
        let mut digits = vec![0; (shift / 32) as usize];
        let mut carry = 0u64;
        for &d in &self.digits {
            carry |= u64::from(d) << (shift % 32);
            digits.push(carry as u32);
            carry >>= 32;
        }
        digits.push(carry as u32);
        trimmed(digits)
    }
}

fn trimmed(mut digits: Vec<u32>) -> Vec<u32> {
    while digits.last() == Some(&0) {
        digits.pop();
    }
    digits
}

fn compare(a: &[u32], b: &[u32]) -> Ordering {
    a.len().cmp(&b.len()).then_with(|| a.iter().rev().cmp(b.iter().rev()))
}

fn sum(a: &[u32], b: &[u32]) -> Vec<u32> {
    let digit = |s: &[u32], i: usize| u64::from(s.get(i).copied().unwrap_or(0));
    let mut carry = 0;
    let digits = (0..=a.len().max(b.len())).map(|i| {
        carry += digit(a, i) + digit(b, i);
        let low = carry as u32;
        carry >>= 32;
        low
    });
    trimmed(digits.collect())
}

/// Returns a − b for a ≥ b.
fn difference(a: &[u32], b: &[u32]) -> Vec<u32> {
    let mut borrow = false;
    let digits = a.iter().enumerate().map(|(i, &d)| {
        let (low, under) = d.overflowing_sub(b.get(i).copied().unwrap_or(0));
        let (low, under_too) = low.overflowing_sub(u32::from(borrow));
        borrow = under || under_too;
        low
    });
    trimmed(digits.collect())
}

impl Sub for Exact {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        let exponent = self.exponent.min(other.exponent);
        let (a, b) = (self.aligned(exponent), other.aligned(exponent));
        if self.negative != other.negative {
            return Self { negative: self.negative, digits: sum(&a, &b), exponent };
        }
        match compare(&a, &b) {
            Ordering::Less => {
                Self { negative: !self.negative, digits: difference(&b, &a), exponent }
            }
            _ => Self { negative: self.negative, digits: difference(&a, &b), exponent },
        }
    }
}

impl Add for Exact {
    type Output = Self;

    fn add(self, mut other: Self) -> Self {
        other.negative = !other.negative;
        self - other
    }
}

impl Mul for Exact {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let mut digits = vec![0u32; self.digits.len() + other.digits.len()];
        for (i, &a) in self.digits.iter().enumerate() {
            let mut carry = 0u64;
            for (slot, j) in digits.iter_mut().skip(i).zip(0..) {
                let b = other.digits.get(j).copied().unwrap_or(0);
                carry += u64::from(*slot) + u64::from(a) * u64::from(b);
                *slot = carry as u32;
                carry >>= 32;
            }
        }
        Self {
            negative: self.negative != other.negative,
            digits: trimmed(digits),
            exponent: self.exponent + other.exponent,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn extremes_are_decided() {
        let p = DVec2::new;
        let (a, b) = (p(-1e300, -1e300), p(1e300, 1e300));
        assert_eq!(side(a, b, p(1e-300, 1e-300)), Ordering::Equal);
        assert_eq!(
            side(a, b, p(1e-300, f64::from_bits(1e-300f64.to_bits() + 1))),
            Ordering::Greater
        );
        let tiny = f64::from_bits(1);
        assert_eq!(side(p(0.0, 0.0), p(tiny, 0.0), p(0.0, tiny)), Ordering::Greater);
        assert_eq!(side(p(0.0, 0.0), p(tiny, tiny), p(2.0 * tiny, tiny)), Ordering::Less);
        assert_eq!(side(p(-f64::MAX, 0.0), p(f64::MAX, 0.0), p(0.0, -tiny)), Ordering::Less);
    }

    /// Returns points on a coarse grid, times powers of two, and points next to them: many are collinear, and many
    /// nearly so.
    fn points() -> impl Strategy<Value = [DVec2; 4]> {
        let coordinate = (-40i32..40, prop::sample::select(vec![0.1, 1.0, 3e-7, 1e9]), -2i32..3);
        let number = coordinate.prop_map(|(v, unit, steps)| {
            let v = f64::from(v) * unit;
            (0..steps.abs()).fold(v, |v, _| if steps > 0 { v.next_up() } else { v.next_down() })
        });
        prop::array::uniform8(number).prop_map(|c| [0, 2, 4, 6].map(|i| p(c[i], c[i + 1])))
    }

    fn p(x: f64, y: f64) -> DVec2 {
        DVec2::new(x, y)
    }

    #[test]
    fn crossings_are_correctly_rounded() {
        // The shared edge of two neighbours, and the edge of a mask.
        let (edge, mask) = ([p(1.0, 2.0), p(2.0, 5.0)], [p(-1.0, 3.0), p(5.0, 3.1)]);
        let expected = Some(p(1.346_368_715_083_798_9, 3.039_106_145_251_396_6));
        for e in [edge, [edge[1], edge[0]]] {
            for m in [mask, [mask[1], mask[0]]] {
                assert_eq!((crossing(e, m), crossing(m, e)), (expected, expected));
            }
        }
        let third = [p(0.0, 0.0), p(3.0, 1.0)];
        assert_eq!(on_border(third, 0, 1.0), 1.0 / 3.0);
        assert_eq!(crossing(third, [p(1.0, -1.0), p(1.0, 1.0)]), Some(p(1.0, 1.0 / 3.0)));
        assert_eq!(
            crossing([p(-1.0, -1.0), p(1.0, 1.0)], [p(-1.0, 1.0), p(1.0, -1.0)]),
            Some(p(0.0, 0.0))
        );
        assert_eq!(crossing(third, [p(6.0, 2.0), p(9.0, 3.0)]), None);
        let far = 1e300;
        let diagonals = ([p(-far, -far), p(far, far)], [p(-far, far), p(far, -far)]);
        assert_eq!(crossing(diagonals.0, diagonals.1), Some(p(0.0, 0.0)));
    }

    proptest! {
        #[test]
        fn pairs_of_floats_round_as_whole_numbers_do([a, b, c, d] in points(), border in -4i32..4) {
            if let Some(point) = crossing([a, b], [c, d]) {
                let exact = |k| crossing_in_whole_numbers(k, [a, b], [c, d]);
                prop_assert_eq!(point, p(exact(0), exact(1)));
                prop_assert_eq!(crossing([d, c], [b, a]), Some(point));
                // Rounded like the ends, it is between them.
                let within = |p: DVec2, q: DVec2| point.cmpge(p.min(q)).all() && point.cmple(p.max(q)).all();
                prop_assert!(within(a, b) && within(c, d));
            }
            let border = f64::from(border) * 0.3;
            if (a.x < border) != (b.x < border) {
                let wall = [p(border, -1e12), p(border, 1e12)];
                prop_assert_eq!(crossing([a, b], wall), Some(p(border + 0.0, on_border([b, a], 0, border))));
                let exact = crossing_in_whole_numbers(1, [a, b], wall);
                prop_assert_eq!(on_border([a, b], 0, border), exact);
            }
        }

        #[test]
        fn whole_numbers_agree_with_i128(v in prop::array::uniform4(-(1i64 << 60)..1i64 << 60)) {
            let [a, b, c, d] = v.map(|v| v >> 8 << 8);
            let e = |v: i64| Exact::from(v as f64);
            let wide = |v: i64| (v as f64) as i128;
            let exact = e(a) * e(b) - (e(c) - e(d)) * e(a);
            let expected = wide(a) * wide(b) - (wide(c) - wide(d)) * wide(a);
            prop_assert_eq!(exact.sign(), expected.cmp(&0));
        }

        #[test]
        fn agrees_with_shewchuks_predicate(v in prop::array::uniform6(-3i32..=3), k in 0..6usize, up in any::<bool>()) {
            let mut c = v.map(|v| f64::from(v) * 0.1);
            c[k] = if up && c[k] != 0.0 { c[k].next_up() } else { c[k] };
            let [a, b, c] = [DVec2::new(c[0], c[1]), DVec2::new(c[2], c[3]), DVec2::new(c[4], c[5])];
            let expected = crate::math::orient2d_value(a, b, c).partial_cmp(&0.0).unwrap();
            prop_assert_eq!(side(a, b, c), expected);
            prop_assert_eq!(side_in_whole_numbers(a, b, c), expected);
        }
    }
}
