//! Silhouettes of the smooth surface that a mesh stands for.
//!
//! Aaron Hertzmann and Denis Zorin, *Illustrating smooth surfaces*, SIGGRAPH 2000: where the normal,
//! interpolated over a triangle, is at a right angle to the line of sight. The lines run through the
//! triangles and do not zigzag along their edges. O(n).

use super::edge_lines::NO_ITEM;
use crate::math::{DMat3, DVec3};
use crate::scene::{Mesh, Scene};
use crate::view::picture_plane::PicturePlane;
use crate::visibility::object::Faces;

/// A line across one triangle, world space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SmoothSilhouette {
    pub ends: [DVec3; 2],
    pub item: u32,
}

/// All of them, in item order. Normals are those of the file; meshes without any get them as
/// [`Mesh::with_smooth_normals`] does.
pub(super) fn smooth_silhouettes(
    scene: &Scene,
    faces: &Faces,
    plane: &PicturePlane,
) -> Vec<SmoothSilhouette> {
    let mut with_normals: Vec<Option<Mesh>> = scene.meshes.iter().map(|_| None).collect();
    let mut found = Vec::new();
    for run in faces.runs() {
        let mesh = with_normals[run.mesh]
            .get_or_insert_with(|| scene.meshes[run.mesh].with_smooth_normals());
        let linear = DMat3::from_mat4(scene.instances[run.instance].world_from_mesh);
        let normal_matrix = linear.inverse().transpose();
        for item in run.items.clone() {
            let (Some(vertices), Some(corners)) = (faces.triangle(item), faces.corners(item))
            else {
                continue;
            };
            let of_mesh = mesh.triangle((run.first + item - run.items.start) as usize);
            let slopes = std::array::from_fn(|k| {
                let normal = normal_matrix * mesh.normals[of_mesh[k] as usize].as_dvec3();
                normal.normalize_or_zero().dot(plane.sight_at(corners[k]))
            });
            if let Some(ends) = zero_line(vertices, corners, slopes) {
                found.push(SmoothSilhouette { ends, item });
            }
        }
    }
    debug_assert!(found.iter().all(|s| s.item != NO_ITEM));
    found
}

/// Where a function that is linear over the triangle is zero. Neighbours with the same values at
/// their common edge cut it in the same point, to the bit.
fn zero_line(vertices: [u32; 3], corners: [DVec3; 3], values: [f64; 3]) -> Option<[DVec3; 2]> {
    let positive = values.map(|v| v >= 0.0);
    if values.iter().any(|v| !v.is_finite()) || positive == [positive[0]; 3] {
        return None;
    }
    let mut cuts = (0..3).filter_map(|i| {
        let k = (i + 1) % 3;
        let (a, b) = if vertices[i] < vertices[k] { (i, k) } else { (k, i) };
        (positive[a] != positive[b])
            .then(|| corners[a] + (corners[b] - corners[a]) * (values[a] / (values[a] - values[b])))
    });
    let ends = [cuts.next()?, cuts.next()?];
    (ends[0] != ends[1]).then_some(ends)
}
