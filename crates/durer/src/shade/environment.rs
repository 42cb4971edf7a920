//! The surroundings of the scene: light from all around, and the reflections in mirrors.
//!
//! Mirrors need something around them to show. By default this is a hemisphere of sky over one of ground, in closed
//! form: a function only of the height over the horizon, a slope from nadir to zenith and a soft step at the horizon,
//! both of which can be blurred for rough surfaces without a table. Instead, metals, smooth plastics and clear layers
//! may mirror a [`Studio`], and everything may mirror a [`Panorama`], which then also gives the light from all around.

use super::axes::turned;
use super::lane::{Lane, Vec3Lane};
use super::panorama::Panorama;
use super::studio::Studio;
use crate::math::Vec3;
use std::sync::Arc;

/// Surroundings of a scene, as a picture's options name it.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Surroundings {
    /// Metals, smooth plastics and clear layers mirror a studio; it follows the camera if the lights do.
    #[default]
    Studio,
    /// Only the sky over the ground that lights make.
    None,
    /// A panorama, which lights the scene instead of the lights that go with the camera, and beside others.
    Panorama(Arc<Panorama>),
}

/// A surrounding that gets brighter upwards.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Environment {
    /// Unit vector to the zenith.
    pub up: Vec3,
    /// Light from all around on a matte surface: at 1 a white one appears white.
    pub ambient: Vec3,
    /// Part of `ambient` that a surface facing up receives in addition, and one facing down less; 0…1.
    pub slope: f32,
    /// Mean radiance that mirrors show; the factor of a panorama.
    pub radiance: Vec3,
    /// Part of `radiance` by which zenith and nadir differ from the mean, without the step; 0…1.
    pub gradient: f32,
    /// Part by which sky and ground differ from the mean besides; `gradient + step ≤ 1`.
    pub step: f32,
    /// Reflection in mirrors in place of sky and ground.
    pub mirrored: Mirrored,
}

/// Reflection in mirrors.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) enum Mirrored {
    /// Sky and ground.
    #[default]
    Sky,
    /// A studio for metals, smooth plastics and clear layers; sky and ground for other surfaces.
    Studio(Studio),
    /// A panorama, which lights matte surfaces too.
    Panorama {
        /// The panorama.
        panorama: Arc<Panorama>,
        /// Unit vectors to the right, up and to the front, in world space.
        axes: [Vec3; 3],
    },
}

/// Half the width of the horizon's step in a perfect mirror, as a sine.
const SHARPEST: f32 = 0.12;

impl Environment {
    /// Creates an environment with the same light from everywhere.
    pub(crate) fn uniform(ambient: Vec3) -> Self {
        Self {
            up: Vec3::Y,
            ambient,
            slope: 0.0,
            radiance: ambient,
            gradient: 0.0,
            step: 0.0,
            mirrored: Mirrored::Sky,
        }
    }

    /// Returns the light reflected by a matte white surface with unit normal `n`.
    #[inline(always)]
    pub(crate) fn diffuse<L: Lane>(&self, n: Vec3Lane<L>) -> Vec3Lane<L> {
        if let Mirrored::Panorama { panorama, axes } = &self.mirrored {
            let light = panorama.diffuse(turned(n, axes)).times_all(self.radiance);
            return light.plus(Vec3Lane::splat(n.x, self.ambient));
        }
        let k = n.dot_all(self.up) * self.slope + 1.0;
        Vec3Lane::new(k * self.ambient.x, k * self.ambient.y, k * self.ambient.z)
    }

    /// Returns the reflection in the unit direction `r`; `alpha` is its roughness, squared. `lamps` is the brightness
    /// of a studio's screens, for metals, smooth surfaces and clear layers; `None` shows no studio.
    #[inline(always)]
    pub(crate) fn reflection<L: Lane>(
        &self,
        r: Vec3Lane<L>,
        alpha: L,
        lamps: Option<L>,
    ) -> Vec3Lane<L> {
        let k = match (&self.mirrored, lamps) {
            (Mirrored::Studio(studio), Some(lamps)) => studio.radiance(r, alpha, lamps),
            (Mirrored::Panorama { panorama, axes }, _) => {
                let seen = panorama.reflection(turned(r, axes), alpha).times_all(self.radiance);
                return seen.plus(Vec3Lane::splat(alpha, self.ambient));
            }
            _ => self.sky(r, alpha),
        };
        Vec3Lane::new(k * self.radiance.x, k * self.radiance.y, k * self.radiance.z)
    }

    /// Returns whether there is more to mirror than sky and ground.
    pub(crate) fn is_furnished(&self) -> bool {
        self.mirrored != Mirrored::Sky
    }

    /// Returns sky and ground as a part of their mean.
    #[inline(always)]
    fn sky<L: Lane>(&self, r: Vec3Lane<L>, alpha: L) -> L {
        let height = r.dot_all(self.up);
        // A cosine lobe keeps 2/3 of a slope, the value at alpha = 1.
        let slope = height / (alpha * 0.5 + 1.0);
        // x/√(1 + x²): odd, so that the mean stays, and as soft as the mirror is rough.
        let x = height / (alpha + SHARPEST);
        let step = x / (x * x + 1.0).sqrt();
        (slope * self.gradient + step * self.step + 1.0).at_least(0.0)
    }
}
