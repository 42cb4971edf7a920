//! Exact signs for every finite input, the extremes of the number range included.
//!
//! A floating-point filter decides nearly all cases; what it leaves open goes to whole numbers of
//! unbounded length, which f64 values are after scaling by a power of two: expansion arithmetic loses
//! its promise where products overflow or underflow.

use crate::math::{DVec2, orient2d_value};
use std::cmp::Ordering;
use std::ops::{Add, Mul, Sub};

/// Half an ulp of 1: the largest relative error of one rounded operation.
pub(crate) const EPSILON: f64 = f64::EPSILON * 0.5;

/// Products below this may have lost bits to underflow, so a filter must not trust them.
const TRUSTED_MIN: f64 = 1e-270;

/// On which side of the directed line a → b the point c lies: `Greater` left, `Less` right.
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

/// An exact dyadic rational: ± magnitude · 2^exponent.
#[derive(Debug, Clone)]
pub struct Exact {
    negative: bool,
    /// Little-endian digits; no zero digit at the upper end, empty for zero.
    digits: Vec<u32>,
    exponent: i32,
}

impl From<f64> for Exact {
    /// The exact value of a finite number.
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
    /// Compared with zero.
    pub(crate) fn sign(&self) -> Ordering {
        match (self.digits.is_empty(), self.negative) {
            (true, _) => Ordering::Equal,
            (false, true) => Ordering::Less,
            (false, false) => Ordering::Greater,
        }
    }

    /// self / other, to within 2 ulp; 0 where `other` is 0.
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

    /// The digits when the number is written with a smaller exponent.
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

/// a − b for a ≥ b.
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

    proptest! {
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
