//! Commands as in the classic OpenGL pipeline: state that stays, primitives, evaluators, display lists.
//!
//! M. Segal, K. Akeley, *The OpenGL Graphics System: A Specification*, 1992; display lists as in J. Foley,
//! A. van Dam, *Fundamentals of Interactive Computer Graphics*, 1982. A [`Command`] changes the
//! [`Pipeline`] or draws; vertices go through model-view and projection matrix, are clipped, rasterized
//! and handed to [`crate::fragment::apply`] one fragment at a time. This is the place to see every
//! fragment operation at work; pictures of scenes are made by [`crate::pipeline`].
//!
//! ```
//! use durer::commands::{Command, DisplayLists, Pipeline, Primitive, Vertex, execute};
//! use durer::math::{DVec3, Vec4};
//! use durer::target::Framebuffer;
//!
//! let mut lists = DisplayLists::default();
//! let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)];
//! let corner = |(x, y)| Vertex::from(DVec3::new(x, y, 0.0));
//! let triangle = lists.record(vec![Command::Draw(Primitive::Triangles, corners.map(corner).into())]);
//! let mut target = Framebuffer::new(8, 8);
//! let red = Command::Color(Vec4::new(1.0, 0.0, 0.0, 1.0));
//! execute(&[red, Command::Call(triangle)], &lists, &mut Pipeline::default(), &mut target)?;
//! assert_eq!(target.color.get(1, 6), Some([255, 0, 0, 255]));
//! assert_eq!(target.color.get(6, 1), Some([0; 4]));
//! # Ok::<(), durer::Error>(())
//! ```

mod draw;
mod evaluator;
mod list;
mod state;

pub use evaluator::{Curve, Patch};
pub use list::{DisplayLists, ListId, MAX_COMMANDS, MAX_NESTING, execute};
pub use state::{CullFace, MAX_STACK, Pipeline};

use crate::fragment::{DepthRange, FragmentState, PolygonOffset};
use crate::math::{DMat4, DVec3, Vec4};

/// Way in which vertices form shapes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Primitive {
    /// Each vertex a pixel.
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
pub struct Vertex {
    /// In the space that the model-view matrix takes to the eye's.
    pub position: DVec3,
    /// Linear RGBA with straight alpha; `None` = the pipeline's colour.
    pub color: Option<Vec4>,
    /// Colour index, interpolated like a colour; `None` = the pipeline's index.
    pub index: Option<f32>,
}

impl From<DVec3> for Vertex {
    fn from(position: DVec3) -> Self {
        Self { position, color: None, index: None }
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
    /// Multiplies it from the right: what comes next is transformed first.
    MultiplyModelView(DMat4),
    /// Keeps a copy of it.
    PushModelView,
    /// Takes the latest copy back.
    PopModelView,
    /// Sets the projection matrix: eye space to clip space, −w ≤ x, y, z ≤ w.
    LoadProjection(DMat4),
    /// Sets where normalized device coordinates lie in the framebuffer: first column, first row, width,
    /// height; `None` = all of it.
    Viewport(Option<[u32; 4]>),
    /// Sets the colour of vertices that have none.
    Color(Vec4),
    /// Sets the colour index of vertices that have none; drawn in colour-index framebuffers.
    Index(f32),
    /// Sets which faces are left out.
    Cull(CullFace),
    /// Sets where near and far lie in window depth.
    DepthRange(DepthRange),
    /// Sets what is added to the depths of polygons.
    PolygonOffset(PolygonOffset),
    /// Sets all fragment operations.
    Fragments(FragmentState),
    /// Draws.
    Draw(Primitive, Vec<Vertex>),
    /// Evaluates a curve at this many equal steps of its parameter and draws them as a line strip.
    EvaluateCurve(Curve, u32),
    /// Evaluates a patch at this many equal steps both ways and draws its triangles.
    EvaluatePatch(Patch, [u32; 2]),
    /// Replays a display list with the state as it is; what it changes stays changed.
    Call(ListId),
}
