//! Wavefront OBJ with its material library MTL.
//!
//! Source: *Wavefront Advanced Visualizer Manual*, appendix B1 (OBJ) and B5 (MTL), 1990s, with the practice of later
//! writers. Lines, points and triangles become one mesh each; faces keep the file's order and are triangulated: as fans
//! if these are correct, else by ear clipping. Names of objects, or of groups if there is only one object, and
//! materials become parts.
//!
//! Choices where the manual is silent or tools differ:
//! - colours (of materials and of vertices, `v x y z r g b`) are sRGB values, as in viewers without
//!   colour management and in three.js; vertex colours of 0…255 are scaled.
//! - faces may refer to vertices that come later in the file; negative numbers count back from the
//!   last vertex so far.
//! - in a file with smoothing groups, corners without a normal get the area-weighted mean of the faces of their group
//!   around the vertex, or their face's own normal if smoothing is off. In a file without normals and groups, also with
//!   `s off`, normals are left to the renderer; if only some corners have normals, the others get the mean of all faces
//!   around them.
//! - a fault in one element loses only that element, with a warning.
//! - a file with only vertices is a point cloud.
//!
//! Cost: three passes over the text, one to count. Memory: the text, 24 bytes per `v` while reading,
//! and the mesh; at most 8 times the file.

mod build;
pub(crate) mod corners;
mod count;
mod parse;
mod repairs;
mod smooth;
#[cfg(test)]
mod tests;

use crate::last_digit::last_digit;
use crate::{Model, ReadOptions, Resources, Result, text};

/// Reads an OBJ file: UTF-8 or any 8-bit text, or UTF-16 with a byte-order mark.
///
/// # Errors
/// [`crate::Error::Decode`] for a file without vertices, and, if nothing else is left, with line and column for invalid
/// numbers and indices out of range; [`crate::Error::Limit`] for more primitives than allowed. A missing material
/// library or texture is a warning.
pub fn read(bytes: &[u8], resources: &dyn Resources, options: &ReadOptions) -> Result<Model> {
    let text = text::utf8(bytes);
    let counts = count::count(&text);
    counts.check(&options.limits)?;
    let parsed = parse::parse(&text, &counts, &options.limits)?;
    let last_digit = last_digit(&text, b"v");
    drop(text);
    let mut model = build::build(parsed, resources, options)?;
    model.scene.last_digit = last_digit;
    Ok(model)
}
