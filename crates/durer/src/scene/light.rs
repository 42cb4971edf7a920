//! Sources of light.

use crate::math::{DVec3, Vec3};

/// The kind of a light, in world space.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum LightKind {
    /// The same from everywhere.
    Ambient,
    /// From infinitely far away.
    Directional {
        /// Unit vector in which the light travels.
        direction: DVec3,
    },
    /// From a point, falling off with the square of the distance.
    Point {
        /// Position of the feature.
        position: DVec3,
        /// Distance at which it ends; `None` = never.
        range: Option<f64>,
    },
    /// A point light that shines into a cone.
    Spot {
        /// Position of the feature.
        position: DVec3,
        /// Unit vector along the cone's axis, in which the light travels.
        direction: DVec3,
        /// Distance at which it ends; `None` = never.
        range: Option<f64>,
        /// Half angle of the full-strength cone, radians.
        inner: f64,
        /// Half angle at which the light is gone, radians.
        outer: f64,
    },
}

/// A light.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Light {
    /// Kind and place.
    pub kind: LightKind,
    /// Linear colour times intensity: at 1 a white matte surface facing a directional light is white;
    /// for point and spot lights, at the distance of one world unit.
    pub color: Vec3,
}
