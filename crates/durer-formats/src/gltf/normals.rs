//! Normals and tangents scaled to unit length; vectors for which that is impossible are replaced.

use super::geometry::Geometry;
use crate::model::count_infinite;
use crate::wording::agreeing;
use durer::math::{Vec3, Vec4};
use durer::scene::Topology;

/// Scales normals and tangents to unit length. A normal without a direction becomes the mean of the normals of the
/// triangles around its vertex, weighted by area; if these have none either, +z.
pub fn repair(g: &mut Geometry) {
    let positions = count_infinite(&g.mesh.positions);
    if positions > 0 {
        g.notes.push(agreeing(positions as u64, "{vertex is|vertices are} not finite"));
    }
    let mut bad = Vec::new();
    for (i, normal) in g.mesh.normals.iter_mut().enumerate() {
        match unit(*normal) {
            Some(n) => *normal = n,
            None => bad.push(i),
        }
    }
    if !bad.is_empty() {
        let words = "{normal without a direction is|normals without a direction are} computed anew";
        g.notes.push(agreeing(bad.len() as u64, words));
        let sums = area_normals(g);
        bad.into_iter().for_each(|i| g.mesh.normals[i] = unit(sums[i]).unwrap_or(Vec3::Z));
    }
    for tangent in &mut g.mesh.tangents {
        let sign = if tangent.w < 0.0 { -1.0 } else { 1.0 };
        *tangent = unit(tangent.truncate()).unwrap_or(Vec3::X).extend(sign);
    }
    let colors = g.mesh.colors.iter_mut().filter(|c| !c.is_finite());
    colors.for_each(|c| *c = Vec4::ONE);
}

/// Returns the vector at unit length; vectors that already have it up to the last bits stay unchanged; `None` for
/// vectors that are too short or not finite.
fn unit(v: Vec3) -> Option<Vec3> {
    // In double precision, in which squares of tiny and huge numbers neither underflow nor overflow.
    let (d, length) = (v.as_dvec3(), v.as_dvec3().length());
    if !length.is_finite() || length < 1e-12 {
        return None;
    }
    Some(if (length - 1.0).abs() < 1e-7 { v } else { (d / length).as_vec3() })
}

/// Returns the sum of the area-weighted normals around each vertex.
fn area_normals(g: &Geometry) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; g.mesh.positions.len()];
    if g.mesh.topology != Topology::Triangles {
        return sums;
    }
    let whole: Vec<u32>;
    let indices = match &g.mesh.indices {
        Some(indices) => indices,
        None => {
            whole = (0..g.mesh.positions.len() as u32).collect();
            &whole
        }
    };
    for triangle in indices.as_chunks::<3>().0 {
        let [a, b, c] = triangle.map(|i| g.mesh.positions[i as usize]);
        let normal = (b - a).cross(c - a);
        if normal.is_finite() {
            triangle.iter().for_each(|&i| sums[i as usize] += normal);
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer::scene::Mesh;

    #[test]
    fn bad_normals_are_made_from_triangles() {
        let mut g = Geometry {
            mesh: Mesh {
                positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
                normals: vec![Vec3::ZERO, Vec3::NAN, Vec3::new(0.0, 3.0, 0.0)],
                tangents: vec![Vec4::new(2.0, 0.0, 0.0, -0.5); 3],
                ..Mesh::default()
            },
            ..Geometry::default()
        };
        repair(&mut g);
        assert_eq!(g.mesh.normals, [Vec3::Z, Vec3::Z, Vec3::Y]);
        assert_eq!(g.mesh.tangents[0], Vec4::new(1.0, 0.0, 0.0, -1.0));
        assert_eq!(g.notes.len(), 1);
    }
}
