//! Models that are read in pieces, repeatedly, because they do not fit in memory.

use crate::{Model, Result};
use durer::scene::{Aabb, Scene, UpAxis};
use durer::work::Charge;

/// Receiver of a piece of a model; may change its contents.
pub type Visit<'a> = &'a mut dyn FnMut(&mut Scene) -> durer::Result<()>;

/// A model of one mesh that is read from its file piece by piece, as often as it is requested.
///
/// Pieces are scenes of one instance, with the materials of the model; their primitives follow each other as in the
/// scene that the format's `read` gives, and have the same bits.
pub trait Pieces {
    /// Returns an upper bound of the bytes for the whole model and a picture of it.
    fn whole(&self) -> u64;

    /// Returns the axis that points up.
    fn up_axis(&self) -> UpAxis;

    /// Returns whether its vertices have normals.
    fn has_normals(&self) -> bool;

    /// Visits all vertices, with the primitives that use them if known; for boxes and cameras. Vertices
    /// that no primitive uses have NaN as coordinates. All pieces but the last have a multiple of
    /// [`durer::view::projection::PIECE`] vertices.
    ///
    /// # Errors
    /// [`crate::Error::Io`], errors of `visit`, and errors for an invalid file.
    fn vertices(&mut self, visit: Visit<'_>) -> Result<()>;

    /// Finds the box around all finite vertices, as [`Scene::bounds`] does of the whole.
    ///
    /// # Errors
    /// As [`Self::vertices`].
    fn bounds(&mut self) -> Result<Option<Aabb>>;

    /// Visits all primitives, without colours.
    ///
    /// # Errors
    /// As [`Self::vertices`].
    fn primitives(&mut self, visit: Visit<'_>) -> Result<()>;

    /// Reads only the primitives of these numbers, which ascend; returns them with the charge of their memory.
    ///
    /// # Errors
    /// As [`Self::vertices`]; [`durer::Error::Memory`] if the budget has no room for them.
    fn only(&mut self, numbers: &[u32]) -> Result<(Scene, Charge)>;

    /// Returns facts about the model as a whole. Reads the file if that has not been done yet.
    ///
    /// # Errors
    /// As [`Self::vertices`].
    fn facts(&mut self) -> Result<Facts>;
}

/// Facts about a model in pieces.
#[derive(Debug, Clone, PartialEq)]
pub struct Facts {
    /// The model without its mesh: format, warnings, materials, and which axis is up.
    pub model: Model,
    /// Triangles.
    pub triangles: u64,
    /// Points.
    pub points: u64,
    /// Vertices.
    pub vertices: u64,
}

/// Returns the box around two that may be empty.
pub(crate) fn union(a: Option<Aabb>, b: Option<Aabb>) -> Option<Aabb> {
    a.into_iter().chain(b).reduce(|a, b| a.union(&b))
}
