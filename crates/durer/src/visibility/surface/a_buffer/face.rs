//! A triangle with the data common to all its fragments.

use super::edges::Slopes;
use super::mask::Direction;
use crate::visibility::surface::setup::{Coverage, ScreenTriangle};
use fearless_simd::Simd;

/// A triangle with the data that all its fragments share.
#[derive(Debug, Clone, Copy)]
pub struct Face {
    pub triangle: u32,
    pub coverage: Coverage,
    pub slopes: Slopes,
    /// Change of depth over half a pixel in both directions.
    pub half_depth: f32,
    /// Direction to the far plane, if that is near.
    pub far: Option<Direction>,
}

impl Face {
    /// Fragment of no triangle.
    pub const NONE: Self = Self {
        triangle: u32::MAX,
        coverage: Coverage::Opaque,
        slopes: Slopes::NONE,
        half_depth: 0.0,
        far: None,
    };

    #[inline(always)]
    pub fn new<S: Simd>(simd: S, t: &ScreenTriangle, triangle: u32, coverage: Coverage) -> Self {
        let half_depth = 0.5 * (t.depth_dx.abs() + t.depth_dy.abs());
        let far = (t.depth_max >= 1.0).then(|| Direction::new(-t.depth_dx, -t.depth_dy));
        Self { triangle, coverage, slopes: Slopes::new(simd, t), half_depth, far }
    }
}
