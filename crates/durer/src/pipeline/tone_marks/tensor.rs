//! Symmetric tensors in space: directions without sign, and curvatures.

use crate::math::DVec3;
use std::ops::{Add, Mul};

/// xx, xy, xz, yy, yz, zz.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tensor([f32; 6]);

impl Tensor {
    pub const ZERO: Self = Self([0.0; 6]);

    /// Returns v·vᵀ.
    pub fn of(v: DVec3) -> Self {
        Self([v.x * v.x, v.x * v.y, v.x * v.z, v.y * v.y, v.y * v.z, v.z * v.z].map(|v| v as f32))
    }

    /// Returns v·wᵀ + w·vᵀ.
    pub fn between(v: DVec3, w: DVec3) -> Self {
        let of = |a: usize, b: usize| v[a] * w[b] + v[b] * w[a];
        Self([of(0, 0), of(0, 1), of(0, 2), of(1, 1), of(1, 2), of(2, 2)].map(|v| v as f32))
    }

    /// Returns the sum with this many times another.
    pub fn plus(self, other: Self, times: f32) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + times * other.0[k]))
    }

    /// Returns vᵀ·T·w.
    pub fn form(&self, v: DVec3, w: DVec3) -> f64 {
        let [xx, xy, xz, yy, yz, zz] = self.0.map(f64::from);
        v.x * (xx * w.x + xy * w.y + xz * w.z)
            + v.y * (xy * w.x + yy * w.y + yz * w.z)
            + v.z * (xz * w.x + yz * w.y + zz * w.z)
    }
}

impl Add for Tensor {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.plus(other, 1.0)
    }
}

impl Mul<f64> for Tensor {
    type Output = Self;

    fn mul(self, times: f64) -> Self {
        Self(self.0.map(|v| v * times as f32))
    }
}
