//! What surrounds the scene: a hemisphere of sky over one of ground, in closed form.
//!
//! Mirrors show nothing where there is nothing around them. This surrounding is a function of the
//! height over the horizon alone: a slope from nadir to zenith and a soft step at the horizon, both
//! of which can be blurred for rough surfaces without any table.

use super::lane::{Lane, Vec3Lane};
use crate::math::Vec3;

/// A surrounding that gets brighter upwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Environment {
    /// Unit vector to the zenith.
    pub up: Vec3,
    /// Light from all around on a matte surface: at 1 a white one appears white.
    pub ambient: Vec3,
    /// By which part of `ambient` a surface facing up gets more, one facing down less; 0…1.
    pub slope: f32,
    /// Mean radiance that mirrors show.
    pub radiance: Vec3,
    /// By which part of `radiance` zenith and nadir differ from the mean, without the step; 0…1.
    pub gradient: f32,
    /// By which part sky and ground differ from the mean besides; `gradient + step ≤ 1`.
    pub step: f32,
}

/// Half the width of the horizon's step in a perfect mirror, as a sine.
const SHARPEST: f32 = 0.12;

impl Environment {
    /// The same light from everywhere.
    pub fn uniform(ambient: Vec3) -> Self {
        Self { up: Vec3::Y, ambient, slope: 0.0, radiance: ambient, gradient: 0.0, step: 0.0 }
    }

    /// What a matte white surface with unit normal `n` reflects.
    #[inline(always)]
    pub fn diffuse<L: Lane>(&self, n: Vec3Lane<L>) -> Vec3Lane<L> {
        let k = n.dot_all(self.up) * self.slope + 1.0;
        Vec3Lane::new(k * self.ambient.x, k * self.ambient.y, k * self.ambient.z)
    }

    /// What a mirror shows in the unit direction `r`; `alpha` is its roughness, squared.
    #[inline(always)]
    pub fn reflection<L: Lane>(&self, r: Vec3Lane<L>, alpha: L) -> Vec3Lane<L> {
        let height = r.dot_all(self.up);
        // A cosine lobe keeps 2/3 of a slope: what is left at alpha = 1.
        let slope = height / (alpha * 0.5 + 1.0);
        // x/√(1 + x²): odd, so that the mean stays, and as soft as the mirror is rough.
        let x = height / (alpha + SHARPEST);
        let step = x / (x * x + 1.0).sqrt();
        let k = (slope * self.gradient + step * self.step + 1.0).at_least(0.0);
        Vec3Lane::new(k * self.radiance.x, k * self.radiance.y, k * self.radiance.z)
    }
}
