//! The bend of the surface at one pixel.

use crate::math::DVec3;

/// The two principal directions of a pixel's surface, the one of stronger curvature first.
pub struct Bent {
    pub directions: [DVec3; 2],
    /// Clarity of the directions: 0 where the surface is flat or bends alike in all directions,
    /// towards 1.
    pub weight: f64,
    /// Excess of the first curvature over the second, from 0 towards 1.
    pub lead: f64,
}

impl Bent {
    /// A flat surface, or the background.
    pub const NOT: Self = Self { directions: [DVec3::ZERO; 2], weight: 0.0, lead: 0.0 };
}
