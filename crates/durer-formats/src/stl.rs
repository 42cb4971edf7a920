//! STL, the stereolithography format: binary and ascii.
//!
//! Source: 3D Systems, *StereoLithography Interface Specification*, 1988; colors after VisCAM and
//! Materialise Magics. The content decides which of the two a file is: many binary files begin with
//! `solid`, and counts in headers are often wrong.
//!
//! Vertices are not joined and the stored facet normals, which are often wrong, are left out: the
//! mesh has three vertices per triangle, in the file's order. z is up.
//!
//! Cost: one pass, after one that looks for colors. Memory: 0.72 of a binary file, 1.7 with colors;
//! under 4 times an ascii file.

mod ascii;
mod binary;
mod palette;
mod pieces;

use crate::text::utf8;
use crate::{Error, Limits, Model, ModelFormat, Place, ReadOptions, Resources, Result, place};
pub use binary::read_binary_stream;
use durer::math::DVec3;
use durer::scene::{Instance, Mesh, UpAxis};
pub use pieces::Pieces;

/// Bytes of a binary file before its first triangle: 80 of text, and the count.
pub const HEADER: usize = 84;
/// Bytes of a triangle in a binary file: normal, three vertices, two bytes of attributes.
pub const RECORD: usize = 50;
/// Number of bytes that are searched for a keyword of ascii STL in a file that begins with `solid`.
const PROBE: usize = 4096;

/// Returns whether the content looks like STL.
pub(crate) fn sniff(bytes: &[u8]) -> bool {
    has_exact_length(bytes) || is_ascii(bytes)
}

/// Returns whether a file of `length` bytes that begins with `head`, [`HEADER`] bytes or more, is binary STL of the
/// length given by its header; [`read_binary_stream`] reads such a file.
pub fn is_whole_binary(head: &[u8], length: u64) -> bool {
    is_length_in_header(head, length) && ModelFormat::may_be_stl(head)
}

fn count_in_header(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(80..HEADER)?;
    Some(u32::from_le_bytes(count.try_into().ok()?))
}

/// Returns whether the file has the length given by a binary header; such a file is binary regardless of its beginning.
fn has_exact_length(bytes: &[u8]) -> bool {
    is_length_in_header(bytes, bytes.len() as u64)
}

fn is_length_in_header(head: &[u8], length: u64) -> bool {
    let expected = |count: u32| HEADER as u64 + RECORD as u64 * u64::from(count);
    count_in_header(head).is_some_and(|count| expected(count) == length)
}

/// Returns whether the file begins like ascii STL and continues as text.
fn is_ascii(bytes: &[u8]) -> bool {
    let text = utf8(bytes.get(..PROBE).unwrap_or(bytes));
    let text = text.trim_ascii_start();
    let begins = |word: &[u8]| text.get(..5).is_some_and(|w| w.eq_ignore_ascii_case(word));
    let solid = begins(b"solid") || begins(b"facet");
    // Control characters below tab do not occur in text and do in coordinates.
    let texty = !text.iter().any(|&b| b < b'\t');
    solid && texty
}

/// Reads an STL file.
///
/// A count that does not fit the file's length, or a file that ends inside a triangle, is a warning:
/// all whole triangles are taken. Facets of more corners than three (ascii) are polygons; of fewer, they
/// are left out with a warning.
///
/// # Errors
/// [`Error::Decode`] for a file too short to be binary STL, cut off before its first triangle, or
/// without any vertex of three numbers (ascii); [`Error::Limit`] for too many triangles.
pub fn read(bytes: &[u8], _resources: &dyn Resources, options: &ReadOptions) -> Result<Model> {
    if !has_exact_length(bytes) && is_ascii(bytes) {
        ascii::read(&utf8(bytes), &options.limits)
    } else {
        binary::read(bytes, &options.limits)
    }
}

/// Builds the model of either kind of file, given the number of vertices that are not finite.
fn finished(mut model: Model, infinite: usize) -> Result<Model> {
    model.scene.up_axis = UpAxis::Z;
    if model.scene.meshes.iter().all(|m| m.positions.is_empty()) {
        model.warn(Place::Whole, "holds no triangles");
    }
    model.warn_infinite(infinite);
    model.scene.check()?;
    Ok(model)
}

fn check_limit(triangles: u64, limits: &Limits) -> Result<()> {
    // Three vertices per triangle must be numbered in 32 bits.
    let limit = limits.primitives.min(u64::from(u32::MAX / 3));
    let what = "number of triangles";
    if triangles <= limit {
        return Ok(());
    }
    Err(Error::Limit { place: Place::Whole, what, value: triangles, limit })
}

fn add(model: &mut Model, mesh: Mesh, origin: DVec3) {
    let name = mesh.name.clone();
    let world_from_mesh = place::matrix(origin);
    model.scene.meshes.push(mesh);
    model.scene.instances.push(Instance { mesh: 0, world_from_mesh, name });
}
