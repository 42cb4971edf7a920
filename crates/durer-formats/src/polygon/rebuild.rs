//! New triangles into a mesh, in the place of fans.

use super::crossing::{Corner, Resolved};
use crate::{Error, Limits, Place, Result};
use durer::scene::Mesh;
use std::ops::{Add, Mul};

/// A vertex to be added: the mean of two points, each on the line between two vertices.
type Between = [([u32; 2], f64); 2];

/// The faces whose triangles are replaced, in order.
#[derive(Debug, Default)]
pub(super) struct Replaced {
    /// Faces, and where their triangles end.
    faces: Vec<(usize, usize)>,
    /// Numbers of vertices, those to be added counted on from the mesh's.
    triangles: Vec<[u32; 3]>,
    added: Vec<Between>,
    /// Vertices of the mesh.
    vertices: usize,
}

impl Replaced {
    pub fn new(mesh: &Mesh) -> Self {
        Self { vertices: mesh.positions.len(), ..Self::default() }
    }

    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// Replaces a face by triangles of its corners; none are a replacement, too.
    pub fn add(&mut self, face: usize, corners: &[u32], triangles: &[[u32; 3]]) {
        if triangles.is_empty() {
            return;
        }
        let vertex = |i: u32| corners.get(i as usize).copied().unwrap_or_default();
        self.triangles.extend(triangles.iter().map(|t| t.map(vertex)));
        self.faces.push((face, self.triangles.len()));
    }

    /// Replaces a face by triangles whose corners may be at crossings of its edges.
    pub fn add_resolved(&mut self, face: usize, corners: &[u32], resolved: &Resolved) {
        if resolved.triangles.is_empty() {
            return;
        }
        let old = |i: usize| corners.get(i).copied().unwrap_or_default();
        let first = self.vertices + self.added.len();
        let vertex = |corner| match corner {
            Corner::Old(i) => old(i),
            Corner::New(i) => (first + i) as u32,
        };
        self.triangles.extend(resolved.triangles.iter().map(|t| t.map(vertex)));
        self.faces.push((face, self.triangles.len()));
        let between = resolved.crossings.iter();
        self.added.extend(between.map(|c| c.map(|(ends, t)| (ends.map(old), t))));
    }

    /// Puts all into the mesh.
    ///
    /// # Errors
    /// More triangles than allowed, or more vertices than 32 bits can number.
    pub fn put_into(&self, mesh: &mut Mesh, limits: &Limits) -> Result<()> {
        let added = self.triangles.len() as u64;
        let vertices = (self.vertices + self.added.len()) as u64;
        for (what, value, limit) in [
            ("number of triangles", mesh.triangle_count() as u64, limits.primitives),
            ("number of triangles of crossing polygons", added, limits.primitives),
            ("number of vertices", vertices, u64::from(u32::MAX) - 1),
        ] {
            if value > limit {
                return Err(Error::Limit { place: Place::Whole, what, value, limit });
            }
        }
        self.add_vertices(mesh);
        if !self.fit_in_place(mesh) {
            self.rebuild(mesh);
        }
        Ok(())
    }

    /// Returns each face with its triangles.
    fn all(&self) -> impl Iterator<Item = (usize, &[[u32; 3]])> {
        let starts = [0].into_iter().chain(self.faces.iter().map(|(_, end)| *end));
        let range = |(start, &(face, end)): (usize, &(usize, usize))| {
            (face, self.triangles.get(start..end).unwrap_or_default())
        };
        starts.zip(&self.faces).map(range)
    }

    /// Overwrites the fans if each has as many triangles as its replacement; returns whether that was possible.
    fn fit_in_place(&self, mesh: &mut Mesh) -> bool {
        let count = mesh.triangle_count();
        let Some(indices) = &mut mesh.indices else { return true };
        let range = |face: usize| {
            let end = mesh.faces.get(face + 1).map_or(count, |&end| end as usize);
            mesh.faces.get(face).map_or(0, |&first| first as usize)..end
        };
        if self.all().any(|(face, triangles)| range(face).len() != triangles.len()) {
            return false;
        }
        for (face, triangles) in self.all() {
            let range = range(face);
            if let Some(place) = indices.get_mut(3 * range.start..3 * range.end) {
                place.copy_from_slice(triangles.as_flattened());
            }
        }
        true
    }

    /// Rewrites all triangles, and adjusts the starts of faces and parts.
    fn rebuild(&self, mesh: &mut Mesh) {
        let count = mesh.triangle_count();
        let old = mesh.indices.take().unwrap_or_default();
        let mut new: Vec<u32> = Vec::with_capacity(old.len());
        let firsts = std::mem::take(&mut mesh.faces);
        let mut replaced = self.all().peekable();
        let mut ranges = mesh.parts.iter_mut().map(|part| &mut part.range).peekable();
        let mut moved_to = 0;
        for (face, &first) in firsts.iter().enumerate() {
            let end = firsts.get(face + 1).map_or(count, |&end| end as usize);
            let here = (new.len() / 3) as u32;
            while let Some(range) = ranges.next_if(|range| range.end <= first) {
                *range = std::mem::replace(&mut moved_to, here)..here;
            }
            mesh.faces.push(here);
            match replaced.next_if(|(i, _)| *i == face) {
                Some((_, triangles)) => new.extend(triangles.as_flattened()),
                None => new.extend(old.get(3 * first as usize..3 * end).unwrap_or_default()),
            }
        }
        let here = (new.len() / 3) as u32;
        ranges.for_each(|range| *range = std::mem::replace(&mut moved_to, here)..here);
        mesh.indices = Some(new);
    }

    fn add_vertices(&self, mesh: &mut Mesh) {
        let old = mesh.normals.len();
        extend(&mut mesh.positions, &self.added);
        extend(&mut mesh.normals, &self.added);
        mesh.normals.iter_mut().skip(old).for_each(|n| *n = n.normalize_or_zero());
        extend(&mut mesh.tangents, &self.added);
        extend(&mut mesh.colors, &self.added);
        mesh.tex_coords.iter_mut().for_each(|set| extend(set, &self.added));
    }
}

/// Adds the values of new vertices, if there are any values.
fn extend<T>(values: &mut Vec<T>, added: &[Between])
where
    T: Copy + Default + Add<Output = T> + Mul<f32, Output = T>,
{
    if values.is_empty() {
        return;
    }
    for [first, second] in added {
        let at = |v: u32| values.get(v as usize).copied().unwrap_or_default();
        let along =
            |([from, to], t): ([u32; 2], f64)| at(from) * (1.0 - t) as f32 + at(to) * t as f32;
        let mean = (along(*first) + along(*second)) * 0.5;
        values.push(mean);
    }
}
