//! The state that commands change.

use super::lighting::LightingState;
use super::texture::BoundTexture;
use crate::fragment::{DepthRange, FragmentState, PolygonOffset};
use crate::math::{DMat4, DVec2, DVec3, Vec4};

/// Faces to leave out, by the direction of their corners on the screen: counter-clockwise, seen with y up,
/// is a front face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum CullFace {
    /// None: the initial state.
    #[default]
    None,
    /// Faces seen from the front.
    Front,
    /// Faces seen from behind.
    Back,
}

/// Place at which pixels are drawn, with the attributes of a vertex there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RasterPosition {
    /// Pixels of the framebuffer.
    pub at: DVec2,
    /// Window depth of fragments that have none of their own.
    pub depth: f64,
    /// Linear RGBA of fragments that have no colour of their own, lit where lighting is on.
    pub color: Vec4,
    /// Colour index of fragments that have none of their own.
    pub index: f32,
    /// Texture coordinates of all fragments.
    pub tex_coord: DVec2,
}

impl Default for RasterPosition {
    /// Returns the default: OpenGL's initial position, the first pixel, at the near plane, white.
    fn default() -> Self {
        Self { at: DVec2::ZERO, depth: 0.0, color: Vec4::ONE, index: 1.0, tex_coord: DVec2::ZERO }
    }
}

/// Everything that commands set; a value that can be stored, compared and restored.
#[derive(Debug, Clone, PartialEq)]
pub struct Pipeline {
    /// Object space to eye space; at first the identity.
    pub model_view: DMat4,
    /// Copies of it, the latest last; at most [`MAX_STACK`].
    pub stack: Vec<DMat4>,
    /// Eye space to clip space; at first the identity.
    pub projection: DMat4,
    /// First column, first row, width and height in pixels; at first `None`, the whole framebuffer.
    pub viewport: Option<[u32; 4]>,
    /// Linear RGBA of vertices without colour; at first white.
    pub color: Vec4,
    /// Colour index of vertices without one; at first 1.
    pub index: f32,
    /// Normal of vertices without one, object space; at first +z.
    pub normal: DVec3,
    /// Texture coordinates of vertices without any; at first 0.
    pub tex_coord: DVec2,
    /// Lights, materials, and the interpolation of colours; at first off, and smooth.
    pub lighting: LightingState,
    /// Texture of all fragments; at first none.
    pub texture: Option<BoundTexture>,
    /// Place at which pixels are drawn; `None` if it was clipped away.
    pub raster: Option<RasterPosition>,
    /// Width and height of a drawn pixel, in pixels; negative to mirror; initially 1.
    pub pixel_zoom: DVec2,
    /// Side or diameter of points in pixels; at first 1.
    pub point_size: f64,
    /// True if points are smooth discs; at first false.
    pub point_smooth: bool,
    /// Faces to leave out; at first none.
    pub cull: CullFace,
    /// Window depths of the near and the far plane; at first 0 and 1.
    pub depth_range: DepthRange,
    /// Offset added to the depths of polygons; at first nothing.
    pub polygon_offset: PolygonOffset,
    /// Scissor, alpha test, stencil, depth, blending, dithering, logic operation and write masks; initially all off,
    /// with masks that let everything through.
    pub fragments: FragmentState,
}

/// The largest number of matrices on the stack, the minimum that OpenGL requires.
pub const MAX_STACK: usize = 32;

impl Default for Pipeline {
    /// Returns the default: OpenGL's initial state, no tests, no blending, everything written.
    fn default() -> Self {
        Self {
            model_view: DMat4::IDENTITY,
            stack: Vec::new(),
            projection: DMat4::IDENTITY,
            viewport: None,
            color: Vec4::ONE,
            index: 1.0,
            normal: DVec3::Z,
            tex_coord: DVec2::ZERO,
            lighting: LightingState::default(),
            texture: None,
            raster: Some(RasterPosition::default()),
            pixel_zoom: DVec2::ONE,
            point_size: 1.0,
            point_smooth: false,
            cull: CullFace::None,
            depth_range: DepthRange::default(),
            polygon_offset: PolygonOffset::default(),
            fragments: FragmentState { depth: None, ..FragmentState::default() },
        }
    }
}
