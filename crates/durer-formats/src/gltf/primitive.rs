//! A primitive's vertices and indices, as lists of points, lines or triangles.

use super::buffer::Source;
use super::geometry::{Geometry, Influences};
use super::json::{Primitive, Whole};
use super::{draco, normals};
use crate::wording::{agreeing, counted};
use crate::{Error, Result};
use durer::math::{Vec3, Vec4};
use durer::scene::{Mesh, Topology};

/// Reads a primitive; `None` if it has no positions.
///
/// # Errors
/// If an accessor does not fit its use, or indices refer to no vertex and nothing is left without them.
pub fn read(source: &Source<'_>, primitive: &Primitive, at: &str) -> Result<Option<Geometry>> {
    let attributes = Attributes::of(source, primitive, at)?;
    let Some(positions) = attributes.vectors("POSITION")? else { return Ok(None) };
    let mut g = Geometry { mesh: Mesh { positions, ..Mesh::default() }, ..Geometry::default() };
    let count = g.mesh.positions.len();
    if u32::try_from(count).is_err() {
        return Err(Error::path(at, format!("{count} vertices are more than 32 bits can number")));
    }
    g.mesh.normals = attributes.vectors("NORMAL")?.unwrap_or_default();
    g.mesh.tangents = attributes.vectors("TANGENT")?.unwrap_or_default();
    g.mesh.colors = attributes.colors()?;
    while let Some(set) = attributes.vectors(&format!("TEXCOORD_{}", g.mesh.tex_coords.len()))? {
        g.mesh.tex_coords.push(set);
    }
    attributes.influences(&mut g)?;
    g.check_counts(at)?;
    let indices = match &attributes.packed {
        Some(packed) => Some(packed.indices()),
        None => read_indices(source, primitive, at)?,
    };
    let dangling = indices.as_deref().and_then(|list| first_dangling(list, count));
    let mode = if attributes.packed.is_some() { Mode::Triangles } else { Mode::of(primitive, at)? };
    g.join(mode, indices, source, at)?;
    if let Some(first) = dangling {
        g.leave_out_dangling(&first, at)?;
    }
    normals::repair(&mut g);
    Ok(Some(g))
}

/// Source of attributes: accessors, or a Draco mesh.
struct Attributes<'a> {
    source: &'a Source<'a>,
    primitive: &'a Primitive,
    packed: Option<draco::Packed>,
    at: &'a str,
}

impl<'a> Attributes<'a> {
    fn of(source: &'a Source<'a>, primitive: &'a Primitive, at: &'a str) -> Result<Self> {
        let packed = match &primitive.extensions.draco {
            Some(draco) => draco::Packed::read(source, draco, at)?,
            None => None,
        };
        Ok(Self { source, primitive, packed, at })
    }

    fn accessor(&self, name: &str) -> Option<Whole> {
        self.primitive.attributes.get(name).copied()
    }

    /// Returns an attribute of N floats each; `None` if the primitive has it not.
    fn vectors<T: From<[f32; N]>, const N: usize>(&self, name: &str) -> Result<Option<Vec<T>>> {
        let Some(accessor) = self.accessor(name) else { return Ok(None) };
        let at = format!("{}.attributes.{name}", self.at);
        if let Some(packed) = self.packed_attribute(name) {
            let normalized = self.source.root.accessors.get(accessor.index());
            let floats =
                packed.floats(normalized.is_some_and(|a| a.normalized), self.source, &at)?;
            return Ok(Some(floats.into_iter().map(T::from).collect()));
        }
        self.source.vectors(accessor, &at).map(Some)
    }

    fn packed_attribute(&self, name: &str) -> Option<draco::Attribute<'_>> {
        let id = self.primitive.extensions.draco.as_ref()?.attributes.get(name)?;
        self.packed.as_ref()?.attribute(*id)
    }

    /// Returns the first set of vertex colours; without alpha, opaque.
    fn colors(&self) -> Result<Vec<Vec4>> {
        let Some(accessor) = self.accessor("COLOR_0") else { return Ok(Vec::new()) };
        let shape = self.source.root.accessors.get(accessor.index()).map(|a| a.shape.as_str());
        if shape == Some("VEC4") {
            return Ok(self.vectors("COLOR_0")?.unwrap_or_default());
        }
        let rgb: Vec<Vec3> = self.vectors("COLOR_0")?.unwrap_or_default();
        Ok(rgb.into_iter().map(|rgb| rgb.extend(1.0)).collect())
    }

    /// Reads all sets of joints that have weights.
    fn influences(&self, g: &mut Geometry) -> Result<()> {
        for set in 0.. {
            let (joints, weights) = (format!("JOINTS_{set}"), format!("WEIGHTS_{set}"));
            let Some(accessor) = self.accessor(&joints) else { break };
            let Some(weights) = self.vectors(&weights)? else {
                g.notes.push(format!("{joints} without {weights} is ignored"));
                break;
            };
            let at = format!("{}.attributes.{joints}", self.at);
            let joints = match self.packed_attribute(&joints) {
                Some(packed) => {
                    let floats = packed.floats::<4>(false, self.source, &at)?;
                    floats.into_iter().map(|j| j.map(|j| j as u32)).collect()
                }
                None => self.source.integers::<4>(accessor, &at)?,
            };
            g.influences.push(Influences { joints, weights });
        }
        Ok(())
    }
}

/// Primitive mode of the file.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Mode {
    Points,
    Lines,
    LineLoop,
    LineStrip,
    Triangles,
    TriangleStrip,
    TriangleFan,
}

impl Mode {
    fn of(primitive: &Primitive, at: &str) -> Result<Self> {
        use Mode::*;
        let modes = [Points, Lines, LineLoop, LineStrip, Triangles, TriangleStrip, TriangleFan];
        let number = primitive.mode.unwrap_or(Whole(4));
        let wrong =
            || Error::path(format!("{at}.mode"), format!("{} is not one of 0 … 6", number.0));
        modes.get(number.index()).copied().ok_or_else(wrong)
    }

    fn topology(self) -> Topology {
        match self {
            Self::Points => Topology::Points,
            Self::Lines | Self::LineLoop | Self::LineStrip => Topology::Lines,
            Self::Triangles | Self::TriangleStrip | Self::TriangleFan => Topology::Triangles,
        }
    }

    /// Returns the number of primitives that `count` indices make, and of indices per primitive.
    fn primitives(self, count: usize) -> (usize, usize) {
        match self {
            Self::Points => (count, 1),
            Self::Lines => (count / 2, 2),
            Self::LineLoop => (if count < 2 { 0 } else { count }, 2),
            Self::LineStrip => (count.saturating_sub(1), 2),
            Self::Triangles => (count / 3, 3),
            Self::TriangleStrip | Self::TriangleFan => (count.saturating_sub(2), 3),
        }
    }

    /// Returns which of `count` indices is the corner `corner` of primitive `i` (glTF 2.0,
    /// §3.7.2.1).
    fn corner(self, i: usize, corner: usize, count: usize) -> usize {
        match self {
            Self::Points => i,
            Self::Lines => 2 * i + corner,
            Self::LineLoop => (i + corner) % count,
            Self::LineStrip => i + corner,
            Self::Triangles => 3 * i + corner,
            // Every second triangle of a strip has its last two corners swapped.
            Self::TriangleStrip => i + [0, 1 + i % 2, 2 - i % 2][corner],
            Self::TriangleFan => [i + 1, i + 2, 0][corner],
        }
    }
}

impl Geometry {
    /// Checks that each attribute has as many elements as there are positions.
    fn check_counts(&self, at: &str) -> Result<()> {
        let count = self.mesh.positions.len();
        let optional = [
            ("NORMAL".to_owned(), self.mesh.normals.len()),
            ("TANGENT".to_owned(), self.mesh.tangents.len()),
            ("COLOR_0".to_owned(), self.mesh.colors.len()),
        ];
        let sets = self.mesh.tex_coords.iter().map(Vec::len).enumerate();
        let sets = sets.map(|(i, n)| (format!("TEXCOORD_{i}"), n));
        let skin =
            self.influences.iter().enumerate().flat_map(|(i, Influences { joints, weights })| {
                [(format!("JOINTS_{i}"), joints.len()), (format!("WEIGHTS_{i}"), weights.len())]
            });
        let present = optional.into_iter().filter(|(_, n)| *n != 0).chain(sets).chain(skin);
        for (name, n) in present {
            if n != count {
                let message = format!("has {n} elements where POSITION has {count}");
                return Err(Error::path(format!("{at}.attributes.{name}"), message));
            }
        }
        Ok(())
    }

    /// Sets topology and indices from the file's mode.
    fn join(
        &mut self,
        mode: Mode,
        indices: Option<Vec<u32>>,
        source: &Source<'_>,
        at: &str,
    ) -> Result<()> {
        let count = indices.as_ref().map_or(self.mesh.positions.len(), Vec::len);
        let (primitives, corners) = mode.primitives(count);
        source.budget.primitives(primitives as u64, at)?;
        self.mesh.topology = mode.topology();
        let list = matches!(mode, Mode::Points | Mode::Lines | Mode::Triangles);
        if list && primitives * corners != count {
            let rest = count - primitives * corners;
            let words = "{index at the end makes|indices at the end make} no primitive; left out";
            self.notes.push(agreeing(rest as u64, words));
        }
        self.mesh.indices = match indices {
            None if list && primitives * corners == count => None,
            Some(mut indices) if list => {
                indices.truncate(primitives * corners);
                Some(indices)
            }
            indices => {
                source.budget.bytes((primitives * corners * 4) as u64, at)?;
                let index = |i: usize| indices.as_ref().map_or(i as u32, |list| list[i]);
                let all = (0..primitives).flat_map(|i| (0..corners).map(move |c| (i, c)));
                Some(all.map(|(i, c)| index(mode.corner(i, c, count))).collect())
            }
        };
        Ok(())
    }

    /// Leaves out primitives with a corner that is not a vertex; `first` describes the first of these. If nothing is
    /// left, that is an error.
    fn leave_out_dangling(&mut self, first: &str, at: &str) -> Result<()> {
        let (corners, [one, several]) = match self.mesh.topology {
            Topology::Points => (1, ["point", "points"]),
            Topology::Lines => (2, ["line", "lines"]),
            Topology::Triangles => (3, ["triangle", "triangles"]),
        };
        let vertices = self.mesh.positions.len();
        let indices = self.mesh.indices.get_or_insert_default();
        let (count, mut kept) = (indices.len(), 0);
        for one in (0..count / corners).map(|i| i * corners..(i + 1) * corners) {
            if indices[one.clone()].iter().all(|&i| (i as usize) < vertices) {
                indices.copy_within(one, kept);
                kept += corners;
            }
        }
        indices.truncate(kept);
        if kept == 0 {
            return Err(Error::path(format!("{at}.indices"), first));
        }
        let left_out = (count - kept) / corners;
        if left_out > 0 {
            let kinds = counted(left_out as u64, one, several);
            let then = if left_out == 1 { "is left out" } else { "are left out, the first" };
            let message = format!("{kinds} with a corner that is not a vertex {then}: {first}");
            self.notes.push(message);
        }
        Ok(())
    }
}

fn read_indices(source: &Source<'_>, primitive: &Primitive, at: &str) -> Result<Option<Vec<u32>>> {
    let Some(accessor) = primitive.indices else { return Ok(None) };
    Ok(Some(source.integers::<1>(accessor, &format!("{at}.indices"))?.into_flattened()))
}

/// Returns a message about the first index that is not below the number of vertices, if there is one.
fn first_dangling(indices: &[u32], vertices: usize) -> Option<String> {
    // All of them at once, because there is hardly ever one, and it is found sooner than the first.
    let dangling = |i: u32| i as usize >= vertices;
    if !indices.iter().fold(false, |any, &i| any | dangling(i)) {
        return None;
    }
    let place = indices.iter().position(|&i| dangling(i))?;
    Some(format!("index {place} is vertex {} of {vertices}", indices[place]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the corners of all primitives of `count` vertices without indices.
    fn list(mode: Mode, count: usize) -> Vec<usize> {
        let (primitives, corners) = mode.primitives(count);
        (0..primitives * corners).map(|k| mode.corner(k / corners, k % corners, count)).collect()
    }

    #[test]
    fn modes_become_lists() {
        assert_eq!(list(Mode::Points, 2), [0, 1]);
        assert_eq!(list(Mode::Lines, 5), [0, 1, 2, 3]);
        assert_eq!(list(Mode::LineStrip, 3), [0, 1, 1, 2]);
        assert_eq!(list(Mode::LineLoop, 3), [0, 1, 1, 2, 2, 0]);
        assert_eq!(list(Mode::TriangleStrip, 5), [0, 1, 2, 1, 3, 2, 2, 3, 4]);
        assert_eq!(list(Mode::TriangleFan, 5), [1, 2, 0, 2, 3, 0, 3, 4, 0]);
        for mode in [Mode::LineLoop, Mode::LineStrip, Mode::TriangleFan, Mode::TriangleStrip] {
            assert!(list(mode, 0).is_empty() && list(mode, 1).is_empty());
        }
    }
}
