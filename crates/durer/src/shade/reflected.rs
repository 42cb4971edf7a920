//! Light that a point reflects.

use crate::math::Vec3;

/// Light that a point reflects, before the material's colours are applied; linear.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reflected {
    /// Ambient and diffuse light: times the diffuse colour.
    pub diffuse: Vec3,
    /// Specular light: times the specular colour.
    pub specular: Vec3,
}

impl Reflected {
    /// Returns the value at barycentric coordinates of three vertices' values.
    #[inline(always)]
    pub fn interpolate(corners: [Self; 3], weights: [f32; 3]) -> Self {
        let [a, b, c] = corners;
        let [u, v, w] = weights;
        Self {
            diffuse: a.diffuse * u + b.diffuse * v + c.diffuse * w,
            specular: a.specular * u + b.specular * v + c.specular * w,
        }
    }
}
