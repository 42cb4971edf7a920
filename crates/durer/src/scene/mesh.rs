//! Meshes: vertices, and the primitives that they form.

use crate::math::{Vec2, Vec3, Vec4};
use crate::{Error, Result};
use std::ops::Range;

/// Primitives that consecutive indices form. Readers convert strips, fans and loops to lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Topology {
    /// Points: one index each.
    Points,
    /// Lines: two indices each.
    Lines,
    /// Triangles: three indices each, counter-clockwise seen from the front.
    #[default]
    Triangles,
}

/// A run of primitives of a mesh that share a material.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Part {
    /// Range of the primitives (triangles, lines or points).
    pub range: Range<u32>,
    /// Index into [`super::Scene::materials`]; `None` is the default material.
    pub material: Option<usize>,
    /// Name of the group or object, empty if the file has none.
    pub name: String,
}

/// Geometry in its own coordinates.
///
/// An attribute array is empty if the file lacks the attribute, else as long as `positions`. Readers of formats with
/// double precision move the middle of a far-off model to the origin and the offset into the instance's matrix, so that
/// coordinates are exact to 24 bits of the model's own extent.
#[derive(Debug, Clone, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Mesh {
    /// Name in the file, empty if it has none.
    pub name: String,
    /// Primitives that the indices form.
    pub topology: Topology,
    /// Position of each vertex.
    pub positions: Vec<Vec3>,
    /// Unit normals; readers do not compute missing ones.
    pub normals: Vec<Vec3>,
    /// Unit tangents; w = ±1 is the sign of the bitangent.
    pub tangents: Vec<Vec4>,
    /// Texture coordinates, set by set; (0, 0) is the upper left corner of the image.
    pub tex_coords: Vec<Vec<Vec2>>,
    /// Colours: linear RGBA, straight alpha.
    pub colors: Vec<Vec4>,
    /// Vertex numbers; `None` if index i is vertex i.
    pub indices: Option<Vec<u32>>,
    /// Runs of primitives by material, in order, without gaps; empty = one part, default material.
    pub parts: Vec<Part>,
    /// First triangle of each face, in order, if the file has faces of more than three vertices; empty if each face is
    /// one triangle. The triangles of a face follow each other, cover the face and have its orientation: a fan from its
    /// first vertex if that covers it, as in convex faces, else any triangulation. A face of n vertices has n − 2
    /// triangles; fewer if some vertices are on spikes without area, another number if the outline crosses itself.
    pub faces: Vec<u32>,
}

impl Mesh {
    /// Creates a mesh of triangles, given by their corners, counter-clockwise seen from the front. Vertices are not
    /// shared.
    ///
    /// ```
    /// use durer::scene::Mesh;
    ///
    /// let mesh = Mesh::from_triangles([[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]]);
    /// assert_eq!(mesh.triangle_count(), 1);
    /// ```
    pub fn from_triangles<P: Into<Vec3>>(triangles: impl IntoIterator<Item = [P; 3]>) -> Self {
        let positions = triangles.into_iter().flatten().map(Into::into).collect();
        Self { positions, ..Self::default() }
    }

    /// Returns the size of its attributes, indices, parts and faces in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let sets: usize = self.tex_coords.iter().map(|set| size_of_val(&set[..])).sum();
        let bytes = size_of_val(&self.positions[..])
            + size_of_val(&self.normals[..])
            + size_of_val(&self.tangents[..])
            + sets
            + size_of_val(&self.colors[..])
            + self.indices.as_ref().map_or(0, |indices| size_of_val(&indices[..]))
            + size_of_val(&self.parts[..])
            + size_of_val(&self.faces[..]);
        bytes as u64
    }

    /// Returns the number of indices, explicit or not.
    pub fn index_count(&self) -> usize {
        self.indices.as_ref().map_or(self.positions.len(), Vec::len)
    }

    /// Returns the number of points, lines or triangles.
    pub fn primitive_count(&self) -> usize {
        match self.topology {
            Topology::Points => self.index_count(),
            Topology::Lines => self.index_count() / 2,
            Topology::Triangles => self.index_count() / 3,
        }
    }

    /// Returns the number of triangles; 0 for points and lines.
    pub fn triangle_count(&self) -> usize {
        if self.topology == Topology::Triangles { self.primitive_count() } else { 0 }
    }

    /// Returns the three vertex numbers of triangle `i < triangle_count()`.
    pub fn triangle(&self, i: usize) -> [u32; 3] {
        match &self.indices {
            Some(indices) => [indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]],
            None => [3 * i as u32, 3 * i as u32 + 1, 3 * i as u32 + 2],
        }
    }

    /// Returns, for each triangle in order, the first triangle of its face.
    ///
    /// ```
    /// use durer::scene::Mesh;
    ///
    /// // A quad and a triangle.
    /// let indices = Some(vec![0, 1, 2, 0, 2, 3, 3, 2, 4]);
    /// let mesh = Mesh { indices, faces: vec![0, 2], ..Mesh::default() };
    /// assert_eq!(mesh.faces_of_triangles().collect::<Vec<_>>(), [0, 0, 2]);
    /// ```
    pub fn faces_of_triangles(&self) -> impl Iterator<Item = u32> + '_ {
        let mut starts = self.faces.iter().copied().peekable();
        let mut first = 0;
        (0..self.triangle_count() as u32).map(move |i| {
            let starts_here = std::iter::from_fn(|| starts.next_if(|&s| s <= i)).count() > 0;
            if starts_here || self.faces.is_empty() {
                first = i;
            }
            first
        })
    }

    /// Returns the ends of line `i`, or twice the vertex of point `i`; `i < primitive_count()`.
    pub(crate) fn line_or_point(&self, i: usize) -> [u32; 2] {
        let index = |i: usize| self.indices.as_ref().map_or(i as u32, |indices| indices[i]);
        match self.topology {
            Topology::Points => [index(i); 2],
            _ => [index(2 * i), index(2 * i + 1)],
        }
    }

    /// Returns the runs of primitives with one material; none is empty unless the mesh is.
    pub(crate) fn material_runs(&self) -> impl Iterator<Item = (Range<u32>, Option<usize>)> + '_ {
        let whole = self.parts.is_empty().then(|| (0..self.primitive_count() as u32, None));
        self.parts.iter().map(|p| (p.range.clone(), p.material)).chain(whole)
    }

    /// Returns, for each vertex, whether an index refers to it; `None` if there are no indices, so that all vertices
    /// are used. Indices beyond the vertices are ignored. Cost: O(indices).
    pub(crate) fn used_vertices(&self) -> Option<Vec<bool>> {
        let indices = self.indices.as_ref()?;
        let mut used = vec![false; self.positions.len()];
        for &i in indices {
            if let Some(used) = used.get_mut(i as usize) {
                *used = true;
            }
        }
        Some(used)
    }

    /// Adds a copy of a vertex with all its attributes, and returns its number.
    pub(crate) fn double(&mut self, v: usize) -> usize {
        fn copy<T: Copy>(values: &mut Vec<T>, v: usize) {
            if let Some(&value) = values.get(v) {
                values.push(value);
            }
        }
        copy(&mut self.positions, v);
        copy(&mut self.normals, v);
        copy(&mut self.tangents, v);
        copy(&mut self.colors, v);
        self.tex_coords.iter_mut().for_each(|set| copy(set, v));
        self.positions.len() - 1
    }

    /// Checks the conditions that algorithms rely on: lengths of attributes, range of indices, order of parts.
    ///
    /// # Errors
    /// [`Error::Dangling`] or [`Error::Parameter`] for the first fault.
    pub fn check(&self) -> Result<()> {
        let count = self.positions.len();
        if u32::try_from(count).is_err() {
            return Err(Error::Limit {
                what: "number of vertices",
                value: count as u64,
                limit: 1 << 32,
            });
        }
        let lengths = [self.normals.len(), self.tangents.len(), self.colors.len()];
        let sets = self.tex_coords.iter().map(Vec::len);
        if let Some(wrong) = lengths.into_iter().chain(sets).find(|&n| n != 0 && n != count) {
            return Err(Error::parameter("attribute length", wrong, "0 or the number of vertices"));
        }
        let indices = self.indices.as_deref().unwrap_or_default();
        // Comparing with a constant is faster than searching for the largest.
        let dangling = |any, &i: &u32| any | (i >= count as u32);
        if indices.iter().fold(false, dangling) {
            let index = indices.iter().copied().max().unwrap_or_default() as usize;
            return Err(Error::Dangling { what: "vertex", index, count });
        }
        let mut end = 0;
        for part in &self.parts {
            if part.range.start != end || part.range.end < end {
                return Err(Error::parameter("part", format!("{:?}", part.range), "next in order"));
            }
            end = part.range.end;
        }
        if !self.parts.is_empty() && end as usize != self.primitive_count() {
            return Err(Error::parameter("parts' end", end, "the number of primitives"));
        }
        Ok(())
    }
}
