//! Sources of light.

use crate::math::{DVec3, Vec3};

/// The kind of a light, in world space.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum LightKind {
    /// The same light from everywhere.
    Ambient,
    /// Light from infinitely far away.
    Directional {
        /// Unit vector in which the light travels.
        direction: DVec3,
    },
    /// Light from a point, falling off with the square of the distance.
    Point {
        /// Position of the light.
        position: DVec3,
        /// Distance at which the light ends; `None` = never.
        range: Option<f64>,
    },
    /// Light from a point into a cone.
    Spot {
        /// Position of the light.
        position: DVec3,
        /// Unit vector along the cone's axis, in which the light travels.
        direction: DVec3,
        /// Distance at which the light ends; `None` = never.
        range: Option<f64>,
        /// Half angle of the cone of full strength, radians.
        inner: f64,
        /// Half angle of the whole cone, without light outside, radians.
        outer: f64,
    },
}

/// A light.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Light {
    /// Kind and position.
    pub kind: LightKind,
    /// Linear colour times intensity: at 1 a white matte surface facing a directional light is white;
    /// for point and spot lights, at the distance of one world unit.
    pub color: Vec3,
}
