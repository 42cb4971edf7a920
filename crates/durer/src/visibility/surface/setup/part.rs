//! Triangles of a run that are set up together.

use super::vertex::Transform;
use super::{EIGHT, ScreenVertex};
use crate::scene::Mesh;
use std::ops::Range;

/// Triangles of a run, and their vertices.
pub(super) struct Part<'p> {
    pub mesh: &'p Mesh,
    pub transform: &'p Transform,
    /// Triangles of the mesh.
    pub triangles: Range<u32>,
    /// The item of the first.
    pub first_item: u32,
    pub vertices: &'p [ScreenVertex],
    /// Shared vertices of triangles: the index of the first of `vertices` in the mesh, and the corners.
    pub shared: Option<(u32, &'p [[u32; 3]])>,
}

impl Part<'_> {
    /// Returns the positions of the i-th triangle's vertices.
    #[inline(always)]
    pub(super) fn corners(&self, i: usize) -> [usize; 3] {
        match self.shared {
            Some((first, corners)) => corners[i].map(|corner| (corner - first) as usize),
            None => [3 * i, 3 * i + 1, 3 * i + 2],
        }
    }

    /// Returns the vertices of eight triangles from the i-th on, by corner. If fewer than eight are left, the last one
    /// is repeated.
    #[inline(always)]
    pub(super) fn eight(&self, i: usize) -> [[&ScreenVertex; EIGHT]; 3] {
        let mut vertices = [[&self.vertices[0]; EIGHT]; 3];
        let [first, second, third] = &mut vertices;
        let lanes = first.iter_mut().zip(second).zip(third);
        let eight =
            self.shared.and_then(|(first, corners)| Some((first, corners[i..].first_chunk()?)));
        if let Some((first, eight)) = eight {
            let eight: &[[u32; 3]; EIGHT] = eight;
            for (((a, b), c), of) in lanes.zip(eight) {
                *a = &self.vertices[(of[0] - first) as usize];
                *b = &self.vertices[(of[1] - first) as usize];
                *c = &self.vertices[(of[2] - first) as usize];
            }
        } else {
            for (lane, ((a, b), c)) in lanes.enumerate() {
                let of = self.corners((i + lane).min(self.triangles.len() - 1));
                (*a, *b, *c) =
                    (&self.vertices[of[0]], &self.vertices[of[1]], &self.vertices[of[2]]);
            }
        }
        vertices
    }

    /// Returns the item of the i-th triangle, and its vertices in the mesh.
    #[inline(always)]
    pub(super) fn primitive(&self, i: usize) -> (u32, [u32; 3]) {
        let corners = match self.shared {
            Some((_, corners)) => corners[i],
            None => self.mesh.triangle(self.triangles.start as usize + i),
        };
        (self.first_item + i as u32, corners)
    }
}
