//! The places at which the normals of a smooth surface turn away from the eye, on the edges of its triangles.

use super::smooth_surface::SmoothSurface;
use crate::visibility::object::Faces;

/// A place of the silhouette on an edge of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Crossing {
    /// The edge, the smaller vertex first.
    pub edge: [u32; 2],
    /// 0 … 1 from the first vertex.
    pub at: f64,
    /// The surface's corners at both vertices.
    pub corners: [u32; 2],
    /// The triangle.
    pub item: u32,
}

/// Returns the points at which the normals of all triangles turn away from the eye, two on each
/// that has any.
pub(super) fn crossings(faces: &Faces, surface: &SmoothSurface) -> Vec<Crossing> {
    let mut found = Vec::new();
    for (item, vertices) in faces.triangles() {
        let Some(corners) = surface.corners(item) else { continue };
        let slopes = corners.map(|c| surface.slopes[c as usize]);
        if slopes.iter().any(|s| (*s >= 0.0) != (slopes[0] >= 0.0)) {
            found.extend(zeros(item, vertices, slopes, corners));
        }
    }
    found
}

/// Finds the points at which a function that is linear along the edges of a triangle changes its
/// sign. Neighbours with the same values at their common edge find the same place, to the bit.
fn zeros(
    item: u32,
    vertices: [u32; 3],
    values: [f64; 3],
    corners: [u32; 3],
) -> impl Iterator<Item = Crossing> {
    (0..3).filter_map(move |i| {
        let k = (i + 1) % 3;
        let (a, b) = if vertices[i] < vertices[k] { (i, k) } else { (k, i) };
        ((values[a] >= 0.0) != (values[b] >= 0.0)).then(|| Crossing {
            edge: [vertices[a], vertices[b]],
            at: values[a] / (values[a] - values[b]),
            corners: [corners[a], corners[b]],
            item,
        })
    })
}
