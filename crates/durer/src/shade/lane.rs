//! One formula for one pixel and for eight: numbers that are either an `f32` or eight of them.
//!
//! The lighting formulas are written once, generic over [`Lane`]. Every operation is an IEEE basic operation
//! done in the same order, so a pixel has the same bits with any number of lanes.

#[cfg(test)]
mod tests;

use crate::math::Vec3;
use fearless_simd::{f32x8, f32x16, i32x8, i32x16, prelude::*};
use std::ops::{Add, Div, Mul, Sub};

/// An `f32`, or several side by side.
pub trait Lane:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f32, Output = Self>
    + Sub<f32, Output = Self>
    + Mul<f32, Output = Self>
{
    /// Returns `value` in every lane; `self` only determines the number of lanes.
    fn splat(self, value: f32) -> Self;
    /// Returns the square root, correctly rounded.
    fn sqrt(self) -> Self;
    /// Returns `then` where `self > limit`, `otherwise` elsewhere and where `self` is NaN.
    fn if_above(self, limit: f32, then: Self, otherwise: Self) -> Self;
    /// Returns the larger of two; where either is NaN, `other`.
    fn larger(self, other: Self) -> Self;
    /// Returns whether all lanes are at most `limit`; NaN is not.
    fn all_at_most(self, limit: f32) -> bool;
    /// Splits a positive number into its exponent and a mantissa between √½ and √2.
    fn split(self) -> (Self, Self);
    /// Returns two to the power `self`, a whole number between −126 and 127.
    fn exp2_whole(self) -> Self;
    /// Returns the nearest whole number below or equal.
    fn floor(self) -> Self;
    /// Calls `f` without inlining it: for long code that is seldom needed.
    fn apart<R>(self, f: impl FnOnce() -> R) -> R;
    /// Applies a function lane by lane, for functions without a vector formula, such as look-ups.
    fn lanewise<const N: usize>(values: [Self; N], f: impl Fn([f32; N]) -> f32) -> Self;
    /// Applies a function lane by lane as [`Self::lanewise`], with three results; the function is not inlined.
    fn looked_up<const N: usize>(
        values: [Self; N],
        look_up: &dyn Fn([f32; N]) -> [f32; 3],
    ) -> [Self; 3];

    /// Returns `self` where it is above `limit`, else `limit`; NaN becomes `limit`.
    #[inline(always)]
    fn at_least(self, limit: f32) -> Self {
        self.if_above(limit, self, self.splat(limit))
    }

    /// Returns `self` where it is not above `limit`, else `limit`; NaN stays.
    #[inline(always)]
    fn at_most(self, limit: f32) -> Self {
        self.if_above(limit, self.splat(limit), self)
    }

    /// Returns `1 − self`.
    #[inline(always)]
    fn one_minus(self) -> Self {
        self.splat(1.0) - self
    }

    /// Returns `self` to a whole power, by repeated squaring.
    #[inline(always)]
    fn power(self, mut exponent: u32) -> Self {
        let (mut result, mut square) = (self.splat(1.0), self);
        loop {
            if exponent & 1 == 1 {
                result = result * square;
            }
            exponent >>= 1;
            if exponent == 0 {
                return result;
            }
            square = square * square;
        }
    }

    /// Returns `self`, at least 1e-37, to any power: relative error below 1e-6 · (1 + |exponent · log2 self|).
    #[inline(always)]
    fn power_real(self, exponent: f32) -> Self {
        (self.at_least(1e-37).log2() * exponent).exp2()
    }

    /// Returns the logarithm to base 2 of a positive normal number.
    #[inline(always)]
    fn log2(self) -> Self {
        let (exponent, m) = self.split();
        // ln m = 2 artanh s with s = (m − 1)/(m + 1), |s| ≤ 0.1716; five terms reach 1e-9.
        let s = (m - 1.0) / (m + 1.0);
        let s2 = s * s;
        let series = (((s2 * (1.0 / 9.0) + 1.0 / 7.0) * s2 + 1.0 / 5.0) * s2 + 1.0 / 3.0) * s2;
        exponent + s * (series + 1.0) * (2.0 * std::f32::consts::LOG2_E)
    }

    /// Returns two to the power `self`, which is held between −126 and 127.
    #[inline(always)]
    fn exp2(self) -> Self {
        let x = self.at_least(-126.0).at_most(127.0);
        let whole = (x + 0.5).floor().at_most(127.0);
        // e^t by Taylor's polynomial, |t| ≤ 0.3466: degree 6 reaches 1e-7.
        let t = (x - whole) * std::f32::consts::LN_2;
        let tail = ((t * (1.0 / 720.0) + 1.0 / 120.0) * t + 1.0 / 24.0) * t + 1.0 / 6.0;
        let series = ((tail * t + 0.5) * t + 1.0) * t + 1.0;
        series * whole.exp2_whole()
    }
}

/// Bits of √½: numbers are split so that mantissas are between √½ and √2.
const SQRT_HALF_BITS: i32 = 0x3f35_04f3;
const MANTISSA: i32 = 0x007f_ffff;

impl Lane for f32 {
    #[inline(always)]
    fn splat(self, value: f32) -> Self {
        value
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f32::sqrt(self)
    }
    #[inline(always)]
    fn if_above(self, limit: f32, then: Self, otherwise: Self) -> Self {
        if self > limit { then } else { otherwise }
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn all_at_most(self, limit: f32) -> bool {
        self <= limit
    }
    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let bits = (self.to_bits() as i32).wrapping_sub(SQRT_HALF_BITS);
        let mantissa = (bits & MANTISSA).wrapping_add(SQRT_HALF_BITS);
        ((bits >> 23) as f32, f32::from_bits(mantissa as u32))
    }
    #[inline(always)]
    fn exp2_whole(self) -> Self {
        f32::from_bits(((self as i32).wrapping_add(127) << 23) as u32)
    }
    #[inline(always)]
    fn floor(self) -> Self {
        f32::floor(self)
    }
    #[inline(always)]
    fn apart<R>(self, f: impl FnOnce() -> R) -> R {
        f()
    }
    #[inline(always)]
    fn looked_up<const N: usize>(
        values: [Self; N],
        look_up: &dyn Fn([f32; N]) -> [f32; 3],
    ) -> [Self; 3] {
        look_up(values)
    }
    #[inline(always)]
    fn lanewise<const N: usize>(values: [Self; N], f: impl Fn([f32; N]) -> f32) -> Self {
        f(values)
    }
}

/// [`Lane`] for a vector of floats, with the vector of whole numbers that is as long.
macro_rules! lanes {
    ($floats:ident, $wholes:ident, $count:literal) => {
        impl<S: Simd> Lane for $floats<S> {
            #[inline(always)]
            fn splat(self, value: f32) -> Self {
                Self::simd_from(self.simd, value)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                SimdFloat::sqrt(self)
            }
            #[inline(always)]
            fn if_above(self, limit: f32, then: Self, otherwise: Self) -> Self {
                self.simd_gt(limit).select(then, otherwise)
            }
            #[inline(always)]
            fn larger(self, other: Self) -> Self {
                self.simd_gt(other).select(self, other)
            }
            #[inline(always)]
            fn all_at_most(self, limit: f32) -> bool {
                self.simd_le(limit).all_true()
            }
            #[inline(always)]
            fn split(self) -> (Self, Self) {
                let bits = self.bitcast::<$wholes<S>>() - SQRT_HALF_BITS;
                let mantissa = (bits & MANTISSA) + SQRT_HALF_BITS;
                ((bits >> 23).to_float(), mantissa.bitcast())
            }
            #[inline(always)]
            fn exp2_whole(self) -> Self {
                ((self.to_int::<$wholes<S>>() + 127) << 23).bitcast()
            }
            #[inline(always)]
            fn floor(self) -> Self {
                SimdFloat::floor(self)
            }
            #[inline(always)]
            fn apart<R>(self, f: impl FnOnce() -> R) -> R {
                self.simd.vectorize(f)
            }
            #[inline(never)]
            fn looked_up<const N: usize>(
                values: [Self; N],
                look_up: &dyn Fn([f32; N]) -> [f32; 3],
            ) -> [Self; 3] {
                let lanes = values.map(<[f32; $count]>::from);
                let mut results = [[0.0; $count]; 3];
                for i in 0..$count {
                    let result = look_up(std::array::from_fn(|k| lanes[k][i]));
                    (0..3).for_each(|k| results[k][i] = result[k]);
                }
                results.map(|result| $floats::from_slice(values[0].simd, &result))
            }
            #[inline(always)]
            fn lanewise<const N: usize>(values: [Self; N], f: impl Fn([f32; N]) -> f32) -> Self {
                let lanes = values.map(<[f32; $count]>::from);
                let result: [f32; $count] =
                    std::array::from_fn(|i| f(std::array::from_fn(|k| lanes[k][i])));
                // Without values there is nothing to compute; this does not occur.
                $floats::from_slice(values[0].simd, &result)
            }
        }
    };
}

lanes!(f32x8, i32x8, 8);
lanes!(f32x16, i32x16, 16);

/// A vector or a linear colour, in lanes.
#[derive(Debug, Clone, Copy)]
pub struct Vec3Lane<L> {
    /// First component, or red.
    pub x: L,
    /// Second component, or green.
    pub y: L,
    /// Third component, or blue.
    pub z: L,
}

/// The squared lengths that have a reciprocal: outside, a vector counts as without direction.
const LENGTH2: (f32, f32) = (1e-36, 1e36);

impl<L: Lane> Vec3Lane<L> {
    /// Creates a vector from its components.
    #[inline(always)]
    pub fn new(x: L, y: L, z: L) -> Self {
        Self { x, y, z }
    }

    /// Creates a vector that is the same in every lane; `like` only determines the number of lanes.
    #[inline(always)]
    pub fn splat(like: L, v: Vec3) -> Self {
        Self::new(like.splat(v.x), like.splat(v.y), like.splat(v.z))
    }

    /// Returns the scalar product, summed from the left.
    #[inline(always)]
    pub fn dot(self, o: Self) -> L {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// Returns the scalar product with one vector for all lanes.
    #[inline(always)]
    pub fn dot_all(self, o: Vec3) -> L {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// Returns the vector product.
    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        Self::new(
            self.y * o.z - o.y * self.z,
            self.z * o.x - o.z * self.x,
            self.x * o.y - o.x * self.y,
        )
    }

    /// Returns the sum.
    #[inline(always)]
    pub fn plus(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y, self.z + o.z)
    }

    /// Returns the difference.
    #[inline(always)]
    pub fn minus(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y, self.z - o.z)
    }

    /// Returns each component times one factor.
    #[inline(always)]
    pub fn scale(self, k: L) -> Self {
        Self::new(self.x * k, self.y * k, self.z * k)
    }

    /// Returns the opposite vector.
    #[inline(always)]
    pub fn reversed(self) -> Self {
        self.scale(self.x.splat(-1.0))
    }

    /// Multiplies component by component.
    #[inline(always)]
    pub fn times(self, o: Self) -> Self {
        Self::new(self.x * o.x, self.y * o.y, self.z * o.z)
    }

    /// Multiplies component by component with one colour for all lanes.
    #[inline(always)]
    pub fn times_all(self, o: Vec3) -> Self {
        Self::new(self.x * o.x, self.y * o.y, self.z * o.z)
    }

    /// Returns `then` where `value > limit`, `otherwise` elsewhere and where `value` is NaN.
    #[inline(always)]
    pub fn if_above(value: L, limit: f32, then: Self, otherwise: Self) -> Self {
        Self::new(
            value.if_above(limit, then.x, otherwise.x),
            value.if_above(limit, then.y, otherwise.y),
            value.if_above(limit, then.z, otherwise.z),
        )
    }

    /// Returns the vector at unit length where the squared length has a reciprocal; unspecified elsewhere.
    #[inline(always)]
    pub fn unit(self) -> Self {
        let length2 = self.dot(self);
        self.scale(length2.splat(1.0) / length2.sqrt())
    }

    /// Returns unit length; `otherwise` if there is no direction: zero, NaN, or beyond 1e18.
    #[inline(always)]
    pub fn unit_or(self, otherwise: Self) -> Self {
        let (length2, unit) = (self.dot(self), self.unit());
        let bounded = Self::if_above(length2, LENGTH2.1, otherwise, unit);
        Self::if_above(length2, LENGTH2.0, bounded, otherwise)
    }
}

impl From<Vec3> for Vec3Lane<f32> {
    #[inline(always)]
    fn from(v: Vec3) -> Self {
        Self::new(v.x, v.y, v.z)
    }
}

impl From<Vec3Lane<f32>> for Vec3 {
    #[inline(always)]
    fn from(v: Vec3Lane<f32>) -> Self {
        Self::new(v.x, v.y, v.z)
    }
}
