//! Normals for meshes that have none: averaged over the faces around a vertex, but not across
//! creases.
//!
//! Source: H. Gouraud, *Continuous shading of curved surfaces* (1971), with faces weighted by area;
//! the crease angle as modelling programs have it. Cost: O(n log n) for n triangles.

use super::{Mesh, Topology};
use crate::math::{DVec3, Vec3};

/// The cosine of 40°: faces that meet at a sharper angle keep their edge.
const CREASE_COSINE: f64 = 0.766_044_443_118_978;

impl Mesh {
    /// Returns the triangles with normals: each corner has the average over the faces that share its position and lie
    /// within 40° of its own face. Vertices are no longer shared.
    ///
    /// A mesh with normals, and lines and points, are returned as they are.
    pub fn with_smooth_normals(&self) -> Self {
        if !self.normals.is_empty() || self.topology != Topology::Triangles {
            return self.clone();
        }
        let corners: Vec<u32> = (0..self.triangle_count()).flat_map(|i| self.triangle(i)).collect();
        let faces: Vec<DVec3> = corners.chunks_exact(3).map(|c| self.area_vector(c)).collect();
        let mut mesh = self.unshared(&corners);
        mesh.normals = vec![Vec3::ZERO; corners.len()];
        for group in same_positions(&mesh.positions) {
            for &corner in &group {
                let own = faces[corner as usize / 3];
                let sum = group
                    .iter()
                    .map(|&c| faces[c as usize / 3])
                    .filter(|f| f.dot(own) >= CREASE_COSINE * f.length() * own.length())
                    .fold(DVec3::ZERO, |sum, f| sum + f);
                mesh.normals[corner as usize] = sum.normalize_or(own.normalize_or_zero()).as_vec3();
            }
        }
        mesh
    }

    /// Returns twice the area of a triangle along its normal.
    fn area_vector(&self, corners: &[u32]) -> DVec3 {
        let at = |i: usize| self.positions[corners[i] as usize].as_dvec3();
        let (a, b, c) = (at(0), at(1), at(2));
        let normal = (b - a).cross(c - a);
        if normal.is_finite() { normal } else { DVec3::ZERO }
    }

    /// Returns the mesh with one vertex per corner.
    fn unshared(&self, corners: &[u32]) -> Self {
        fn gather<T: Copy>(values: &[T], corners: &[u32]) -> Vec<T> {
            if values.is_empty() {
                return Vec::new();
            }
            corners.iter().map(|&c| values[c as usize]).collect()
        }
        Self {
            name: self.name.clone(),
            topology: self.topology,
            positions: gather(&self.positions, corners),
            normals: gather(&self.normals, corners),
            tangents: gather(&self.tangents, corners),
            tex_coords: self.tex_coords.iter().map(|set| gather(set, corners)).collect(),
            colors: gather(&self.colors, corners),
            indices: None,
            parts: self.parts.clone(),
            faces: self.faces.clone(),
        }
    }
}

/// Returns groups of vertices at the same place, each in ascending order.
fn same_positions(positions: &[Vec3]) -> Vec<Vec<u32>> {
    // Adding zero makes −0 into 0, which is the same place.
    let key = |i: &u32| positions[*i as usize].to_array().map(|v| (v + 0.0).to_bits());
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.sort_by_key(key);
    order.chunk_by(|a, b| key(a) == key(b)).map(<[u32]>::to_vec).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_faces(z: f32) -> Mesh {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(-1.0, 0.0, z)];
        Mesh { positions, indices: Some(vec![0, 1, 2, 0, 2, 3]), ..Mesh::default() }
    }

    #[test]
    fn flat_neighbours_are_averaged_and_creases_are_kept() {
        let smooth = two_faces(-0.3).with_smooth_normals();
        assert_eq!(smooth.normals[0], smooth.normals[3]);
        assert!(smooth.normals[0].x < 0.0 && smooth.normals[1] == Vec3::Z);
        let creased = two_faces(-3.0).with_smooth_normals();
        assert_eq!(creased.normals[..3], [Vec3::Z; 3]);
        assert!(creased.normals[3].x < -0.9);
    }
}
