//! The bend of smooth surfaces at their outlines.
//!
//! A surface hides its own outline where it bends towards the eye, behind a cusp: there the slope increases against the
//! line of sight. The bend, similar to the radial curvature of Doug DeCarlo, Adam Finkelstein, Szymon Rusinkiewicz and
//! Anthony Santella, *Suggestive contours for conveying shape*, SIGGRAPH 2003, is averaged over the faces around each
//! vertex and linear along edges. O(n).

use super::crossing::Crossing;
use super::smooth_surface::SmoothSurface;
use crate::view::picture_plane::PicturePlane;
use crate::visibility::object::Faces;

/// Bend of a surface at an outline.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Bend {
    /// The curvature along the sight, in 1 / world units: below 0 where the surface hides the outline itself.
    pub radial: f32,
    /// Largest distance in front of the outline of a facet of the same surface that does not hide it, world
    /// units.
    pub reach: f32,
}

/// Bends of surfaces beside their outlines.
pub(super) struct Bends {
    /// The curvature along the sight, by corner of the surface.
    radial: Vec<f64>,
    /// The most that the sides of facets lie from the surface, and their longest length, by vertex.
    chords: Vec<[f32; 2]>,
}

impl Bends {
    /// Creates the bends at the crossings of outlines.
    pub fn new(
        faces: &Faces,
        surface: &SmoothSurface,
        crossings: &[Crossing],
        plane: &PicturePlane,
    ) -> Self {
        let radial = radial(faces, surface, crossings, plane);
        Self { radial, chords: chords(faces, surface, crossings) }
    }

    /// Returns the bend of the surface at a crossing.
    ///
    /// A facet stays within the surface by the chord's sagitta s or reaches over it, and the outline is made of chords
    /// as well. On a surface of curvature k along the sight, what reaches over an outline by 2s has come forward by
    /// √(2 · 2s / k); but no facet reaches further than it is long. Facets are those around the ends of the edge.
    pub fn at(&self, crossing: &Crossing) -> Bend {
        let [a, b] = crossing.corners.map(|c| self.radial[c as usize]);
        let radial = a + (b - a) * crossing.at;
        let [a, b] = crossing.edge.map(|v| self.chords[v as usize].map(f64::from));
        let reach = (a[0].max(b[0]) / radial.abs()).sqrt() * 2.0;
        Bend { radial: radial as f32, reach: a[1].max(b[1]).min(reach) as f32 }
    }
}

/// Returns the curvature along the sight at each corner of the surface that is beside an outline: an
/// average over its triangles, by area.
fn radial(
    faces: &Faces,
    surface: &SmoothSurface,
    crossings: &[Crossing],
    plane: &PicturePlane,
) -> Vec<f64> {
    let mut beside = vec![false; surface.slopes.len()];
    crossings.iter().flat_map(|c| c.corners).for_each(|c| beside[c as usize] = true);
    let mut sums = vec![[0.0; 2]; surface.slopes.len()];
    for (item, _) in faces.triangles() {
        let Some(corners) = surface.corners(item) else { continue };
        if corners.iter().all(|c| !beside[*c as usize]) {
            continue;
        }
        let Some([a, b, c]) = faces.corners(item) else { continue };
        let slopes = corners.map(|c| surface.slopes[c as usize]);
        let (u, v) = (b - a, c - a);
        let sight = plane.sight_at((a + b + c) / 3.0).normalize_or_zero();
        // The gradient of a linear function in a plane, times twice the area.
        let across = u.cross(v);
        let gradient = (v * (slopes[1] - slopes[0]) - u * (slopes[2] - slopes[0])).cross(across);
        let growth = gradient.dot(sight) / across.length();
        if growth.is_finite() {
            for sum in corners.map(|c| c as usize) {
                sums[sum] = [sums[sum][0] + growth, sums[sum][1] + across.length()];
            }
        }
    }
    sums.into_iter().map(|[growth, area]| if area > 0.0 { growth / area } else { 0.0 }).collect()
}

/// Computes [`Bends::chords`].
fn chords(faces: &Faces, surface: &SmoothSurface, crossings: &[Crossing]) -> Vec<[f32; 2]> {
    let mut beside = vec![false; faces.points().len()];
    crossings.iter().flat_map(|c| c.edge).for_each(|v| beside[v as usize] = true);
    let mut most = vec![[0.0_f32; 2]; faces.points().len()];
    for (item, t) in faces.triangles().filter(|(_, t)| t.iter().any(|v| beside[*v as usize])) {
        let Some(chord) = longest_chord(faces, surface, item) else { continue };
        for v in t {
            let most = &mut most[v as usize];
            *most = [0, 1].map(|k| most[k].max(chord[k] as f32));
        }
    }
    most
}

/// Returns the largest distance of a triangle's sides from the surface, and the length of its
/// longest side.
fn longest_chord(faces: &Faces, surface: &SmoothSurface, item: u32) -> Option<[f64; 2]> {
    let (places, corners) = (faces.corners(item)?, surface.corners(item)?);
    let normals = corners.map(|c| surface.normals[c as usize]);
    let sides = [0, 1, 2].map(|k| {
        let (along, turn) = (places[(k + 1) % 3] - places[k], normals[(k + 1) % 3] - normals[k]);
        [along.dot(turn).abs() / 8.0, along.length()]
    });
    sides.into_iter().reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])])
}
