//! Commands as in the classic OpenGL pipeline: state that stays, primitives, evaluators, display lists.
//!
//! M. Segal, K. Akeley, *The OpenGL Graphics System: A Specification*, 1992; display lists as in J. Foley, A. van Dam,
//! *Fundamentals of Interactive Computer Graphics*, 1982. A [`Command`] changes the [`Pipeline`] or draws; vertices go
//! through the model-view matrix, are lit, go through the projection matrix, are clipped, rasterized, textured and
//! handed to [`crate::fragment::apply`] one fragment at a time. The pixel path draws, copies and reads rectangles of
//! pixels. This module uses every fragment operation; pictures of scenes are made by [`crate::pipeline`].
//!
//! Rows count as in the framebuffer: downwards from the top, or upwards where its
//! [origin](crate::target::Framebuffer::origin) is at the lower left, as in OpenGL. Lines light exactly the pixels of
//! the whole line that are within the viewport.
//!
//! ```
//! use durer::commands::{Command, DisplayLists, Pipeline, Primitive, CornerVertex, execute};
//! use durer::math::{DVec3, Vec4};
//! use durer::target::Framebuffer;
//!
//! let mut lists = DisplayLists::default();
//! let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)];
//! let corner = |(x, y)| CornerVertex::from(DVec3::new(x, y, 0.0));
//! let triangle = lists.record(vec![Command::Draw(Primitive::Triangles, corners.map(corner).into())]);
//! let mut target = Framebuffer::new(8, 8);
//! let red = Command::Color(Vec4::new(1.0, 0.0, 0.0, 1.0));
//! execute(&[red, Command::Call(triangle)], &lists, &mut Pipeline::default(), &mut target)?;
//! assert_eq!(target.color.get(1, 6), Some([255, 0, 0, 255]));
//! assert_eq!(target.color.get(6, 1), Some([0; 4]));
//! # Ok::<(), durer::Error>(())
//! ```

mod bitmap;
mod brush;
mod draw;
mod evaluator;
mod lighting;
mod list;
mod pixels;
mod state;
mod texture;

pub use bitmap::Bitmap;
pub use evaluator::{BezierPatch, SpaceCurve};
pub use lighting::{
    ColorMaterial, LightModel, LightSource, LightingState, MAX_LIGHTS, MaterialFace, Reflection,
    ShadeModel, Step as LightStep,
};
pub use list::{
    DisplayLists, INFO, ListId, MAX_COMMANDS, MAX_NESTING, Step, execute, execute_traced, replay,
};
pub use pixels::{PixelBlock, PixelPlane, read_pixels};
pub use state::{CullFace, MAX_STACK, Pipeline, RasterPosition};
pub use texture::{BoundTexture, TextureFunction};

use crate::fragment::{DepthRange, FragmentState, PolygonOffset};
use crate::math::{DMat4, DVec2, DVec3, Vec4};

/// Kind of shapes formed by vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Primitive {
    /// Each vertex a point: a pixel, a square of pixels or a disc, see [`crate::raster::point`].
    Points,
    /// Two vertices a line, one pixel wide.
    Lines,
    /// A line from each vertex to the next.
    LineStrip,
    /// Three vertices a triangle.
    Triangles,
    /// All vertices one convex polygon.
    Polygon,
}

/// A corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerVertex {
    /// Position in object space, which the model-view matrix transforms to eye space.
    pub position: DVec3,
    /// Linear RGBA with straight alpha; `None` = the pipeline's colour.
    pub color: Option<Vec4>,
    /// Colour index, interpolated like a colour; `None` = the pipeline's index.
    pub index: Option<f32>,
    /// Normal, for lighting; `None` = the pipeline's normal.
    pub normal: Option<DVec3>,
    /// Texture coordinates; `None` = the pipeline's.
    pub tex_coord: Option<DVec2>,
}

impl From<DVec3> for CornerVertex {
    fn from(position: DVec3) -> Self {
        Self { position, color: None, index: None, normal: None, tex_coord: None }
    }
}

/// One command.
#[derive(Debug, Clone, PartialEq)]
pub enum Command {
    /// Sets the planes named to one value within the scissor rectangle, through the write masks.
    Clear {
        /// Linear RGBA, straight alpha.
        color: Option<Vec4>,
        /// Window depth.
        depth: Option<f32>,
        /// Stencil value.
        stencil: Option<u8>,
        /// Colour index.
        index: Option<u8>,
    },
    /// Sets the model-view matrix.
    LoadModelView(DMat4),
    /// Multiplies the model-view matrix from the right: the new matrix is applied first.
    MultiplyModelView(DMat4),
    /// Pushes a copy of the model-view matrix onto its stack.
    PushModelView,
    /// Restores the model-view matrix from the top of its stack.
    PopModelView,
    /// Sets the projection matrix: eye space to clip space, −w ≤ x, y, z ≤ w.
    LoadProjection(DMat4),
    /// Sets the area of the framebuffer for normalized device coordinates: first column, first row, width, height;
    /// `None` = all of it.
    Viewport(Option<[u32; 4]>),
    /// Sets the colour of vertices that have none.
    Color(Vec4),
    /// Sets the colour index of vertices that have none; drawn in colour-index framebuffers.
    Index(f32),
    /// Sets the normal of vertices that have none.
    Normal(DVec3),
    /// Sets the texture coordinates of vertices that have none.
    TexCoord(DVec2),
    /// Turns lighting on or off.
    Lighting(bool),
    /// Sets a light, or turns it off; its position and direction are transformed by the current model-view matrix.
    Light(usize, Option<LightSource>),
    /// Sets ambient light, viewer and sides.
    LightModel(LightModel),
    /// Sets the material of a side.
    Material(MaterialFace, Reflection),
    /// Sets the property of both materials that follows the colour of vertices.
    ColorMaterial(Option<ColorMaterial>),
    /// Sets whether normals are made unit length after their transformation.
    Normalize(bool),
    /// Sets the interpolation of colours.
    ShadeModel(ShadeModel),
    /// Sets the texture of all fragments, or none.
    Texture(Option<BoundTexture>),
    /// Sets the raster position, at which pixels are drawn: a vertex, transformed like all vertices.
    RasterPosition(CornerVertex),
    /// Sets the width and height of a drawn pixel.
    PixelZoom(DVec2),
    /// Sets the side or diameter of points, in pixels.
    PointSize(f64),
    /// Sets whether points are smooth discs, whose pixels have their alpha multiplied by the disc's area in them.
    PointSmooth(bool),
    /// Draws a rectangle of pixels at the raster position.
    DrawPixels(PixelBlock),
    /// Draws the set bits of a mask at the raster position, which moves on; nothing if that was clipped away.
    Bitmap(Bitmap),
    /// Draws a rectangle of the framebuffer at the raster position: first column, first row, width, height.
    CopyPixels([u32; 4], PixelPlane),
    /// Sets the faces to leave out.
    Cull(CullFace),
    /// Sets the window depths of the near and the far plane.
    DepthRange(DepthRange),
    /// Sets the offset that is added to the depths of polygons.
    PolygonOffset(PolygonOffset),
    /// Sets all fragment operations.
    Fragments(FragmentState),
    /// Draws a primitive.
    Draw(Primitive, Vec<CornerVertex>),
    /// Evaluates a curve at this many equal steps of its parameter and draws them as a line strip.
    EvaluateCurve(SpaceCurve, u32),
    /// Evaluates a patch at this many equal steps in both directions and draws its triangles.
    EvaluatePatch(BezierPatch, [u32; 2]),
    /// Replays a display list with the current state; its changes of the state stay.
    Call(ListId),
}

impl Command {
    /// Returns whether the command writes pixels; others only change the state.
    pub(crate) const fn draws(&self) -> bool {
        matches!(
            self,
            Self::Clear { .. }
                | Self::DrawPixels(_)
                | Self::Bitmap(_)
                | Self::CopyPixels(..)
                | Self::Draw(..)
                | Self::EvaluateCurve(..)
                | Self::EvaluatePatch(..)
        )
    }

    /// Returns the name of the command, as that of its variant.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Clear { .. } => "Clear",
            Self::LoadModelView(_) => "LoadModelView",
            Self::MultiplyModelView(_) => "MultiplyModelView",
            Self::PushModelView => "PushModelView",
            Self::PopModelView => "PopModelView",
            Self::LoadProjection(_) => "LoadProjection",
            Self::Viewport(_) => "Viewport",
            Self::Color(_) => "Color",
            Self::Index(_) => "Index",
            Self::Normal(_) => "Normal",
            Self::TexCoord(_) => "TexCoord",
            Self::Lighting(_) => "Lighting",
            Self::Light(..) => "Light",
            Self::LightModel(_) => "LightModel",
            Self::Material(..) => "Material",
            Self::ColorMaterial(_) => "ColorMaterial",
            Self::Normalize(_) => "Normalize",
            Self::ShadeModel(_) => "ShadeModel",
            Self::Texture(_) => "Texture",
            Self::RasterPosition(_) => "RasterPosition",
            Self::PixelZoom(_) => "PixelZoom",
            Self::PointSize(_) => "PointSize",
            Self::PointSmooth(_) => "PointSmooth",
            Self::DrawPixels(_) => "DrawPixels",
            Self::Bitmap(_) => "Bitmap",
            Self::CopyPixels(..) => "CopyPixels",
            Self::Cull(_) => "Cull",
            Self::DepthRange(_) => "DepthRange",
            Self::PolygonOffset(_) => "PolygonOffset",
            Self::Fragments(_) => "Fragments",
            Self::Draw(..) => "Draw",
            Self::EvaluateCurve(..) => "EvaluateCurve",
            Self::EvaluatePatch(..) => "EvaluatePatch",
            Self::Call(_) => "Call",
        }
    }
}
