//! A visible point, as the shading formulas want it.

use super::reflected::Reflected;
use crate::math::{Vec2, Vec3, Vec4};

/// Texture coordinates and how they change over the screen.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TexCoord {
    /// (0, 0) is the upper left corner of the image.
    pub uv: Vec2,
    /// Change of `uv` from one pixel to the next along x.
    pub ddx: Vec2,
    /// Change of `uv` from one pixel to the next along y.
    pub ddy: Vec2,
}

/// A visible point. World axes, positions relative to [`super::PreparedLights::origin`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface<'a> {
    /// Position. Only read if there are point or spot lights.
    pub position: Vec3,
    /// Direction to the eye, of any length: `−position` in perspective, one direction for parallel lines.
    pub view: Vec3,
    /// The interpolated normal, any length. Zero where the mesh has none: the face's is taken.
    pub normal: Vec3,
    /// Unit normal of the face's plane, on either side: it is turned to the viewer.
    pub geometric_normal: Vec3,
    /// Tangent, w = ±1 the sign of the bitangent; without one a normal map's frame is taken from
    /// the derivatives.
    pub tangent: Option<Vec4>,
    /// Change of `position` from one pixel to the next along x; only for normal maps.
    pub position_dx: Vec3,
    /// Change of `position` from one pixel to the next along y; only for normal maps.
    pub position_dy: Vec3,
    /// All sets of the mesh, in order; further sets count as (0, 0).
    pub tex_coords: &'a [TexCoord],
    /// Vertex colour, linear with straight alpha; multiplies the base colour.
    pub color: Vec4,
    /// For flat and Gouraud shading: from [`super::shade_face`], or interpolated from
    /// [`super::shade_vertex`]. Without it both light the point itself.
    pub lit: Option<Reflected>,
}

impl Default for Surface<'_> {
    /// Creates a white point that faces the eye, without textures.
    fn default() -> Self {
        Self {
            position: Vec3::ZERO,
            view: Vec3::Z,
            normal: Vec3::ZERO,
            geometric_normal: Vec3::Z,
            tangent: None,
            position_dx: Vec3::ZERO,
            position_dy: Vec3::ZERO,
            tex_coords: &[],
            color: Vec4::ONE,
            lit: None,
        }
    }
}
