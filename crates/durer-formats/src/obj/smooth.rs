//! Normals for corners without one.
//!
//! Such a corner has [`NONE`] as its normal, or in files with smoothing groups a number after the file's normals: the
//! first is for flat faces, the others are for the groups.

use super::corners::{Corner, NONE};
use crate::{Model, Place, polygon};
use durer::math::DVec3;
use durer::scene::Mesh;

/// Fills in the normals of a mesh whose faces are fans; `count` is the number of normals in the file.
///
/// Each is the mean of the vector areas of the faces around the vertex that are of the same group. Flat
/// faces are left without, which means the face's own.
pub(super) fn fill(model: &mut Model, mesh: &mut Mesh, keys: &[Corner], count: usize) {
    let missing = keys.iter().filter(|k| k.normal == NONE).count();
    let words = "{vertex has no normal where others have one; its normal was|vertices have no normal where others have one; their normals were} computed";
    model.warn_counted(Place::Whole, missing as u64, words);
    let mut computed: Vec<u32> =
        (0..).zip(keys).filter(|(_, k)| k.normal as usize > count).map(|(v, _)| v).collect();
    if computed.is_empty() {
        return;
    }
    let areas = areas(mesh);
    let key = |v: &u32| keys.get(*v as usize).map(|k| (k.position, k.normal));
    computed.sort_by_key(key);
    for same in computed.chunk_by(|a, b| key(a) == key(b)) {
        let sum: DVec3 = same.iter().filter_map(|v| areas.get(*v as usize)).sum();
        for &v in same {
            if let Some(normal) = mesh.normals.get_mut(v as usize) {
                *normal = sum.normalize_or_zero().as_vec3();
            }
        }
    }
}

/// Returns for each vertex the sum of twice the vector areas of its faces.
fn areas(mesh: &Mesh) -> Vec<DVec3> {
    let at = |v: u32| mesh.positions.get(v as usize).copied().unwrap_or_default().as_dvec3();
    let mut areas = vec![DVec3::ZERO; mesh.positions.len()];
    for face in polygon::faces(mesh) {
        let cross = |i| {
            let [a, b, c] = mesh.triangle(i).map(at);
            (b - a).cross(c - a)
        };
        let area: DVec3 = face.clone().map(cross).sum();
        let area = if area.is_finite() { area } else { DVec3::ZERO };
        let first = face.clone().next().map(|i| mesh.triangle(i));
        let ends = face.map(|i| mesh.triangle(i)[2]);
        for v in first.into_iter().flat_map(|[a, b, _]| [a, b]).chain(ends) {
            if let Some(sum) = areas.get_mut(v as usize) {
                *sum += area;
            }
        }
    }
    areas
}
