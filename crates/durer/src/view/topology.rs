//! Whether a mesh is the surface of a body, and which way its faces are turned.

use super::cull::triangle_area;
use crate::math::{DVec3, Vec3};
use crate::scene::Mesh;

/// What [`mesh_topology`] finds. Vertices at equal positions count as one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MeshTopology {
    /// Whether each edge belongs to exactly two triangles: the mesh bounds a body.
    pub closed: bool,
    /// Whether no edge is run through more often in one direction than in the other, borders aside:
    /// neighbours agree on which side is the front.
    pub oriented: bool,
    /// Edges of one triangle only.
    pub boundary_edges: u64,
    /// Edges of three and more triangles.
    pub non_manifold_edges: u64,
    /// Volume in cubic units of the mesh; meaningful where closed and oriented. Negative where the
    /// faces are turned inside out.
    pub signed_volume: f64,
    /// Area of all triangles, in square units of the mesh.
    pub area: f64,
    /// Triangles that have two corners in one place, which have no part in the rest.
    pub collapsed: u64,
}

impl MeshTopology {
    /// Whether all faces of a closed body are turned to its inside.
    pub fn inside_out(&self) -> bool {
        self.closed && self.oriented && self.signed_volume < 0.0
    }
}

/// Edges, border, volume and area of a triangle mesh, in its own coordinates.
///
/// O(n log n) time, O(n) memory. Triangles with a vertex that is not finite or does not exist are left
/// out; meshes of points or lines have none.
///
/// ```
/// use durer::math::Vec3;
/// use durer::scene::Mesh;
/// use durer::view::topology::mesh_topology;
/// let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let indices = Some(vec![0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3]);
/// let found = mesh_topology(&Mesh { positions, indices, ..Mesh::default() });
/// assert!(found.closed && found.oriented);
/// assert_eq!(found.signed_volume, 1.0 / 6.0);
/// ```
pub fn mesh_topology(mesh: &Mesh) -> MeshTopology {
    let welded = weld(&mesh.positions);
    let mut found = MeshTopology { oriented: true, ..MeshTopology::default() };
    let mut edges = Vec::with_capacity(mesh.triangle_count() * 3);
    let mut origin = None;
    for corners in (0..mesh.triangle_count()).map(|i| mesh.triangle(i)) {
        let Some(points) = finite_corners(mesh, corners) else { continue };
        // Six times the tetrahedra from a point of the mesh: no cancellation for a body far from the origin.
        let origin = *origin.get_or_insert(points[0]);
        let [a, b, c] = points.map(|p| p - origin);
        found.signed_volume += a.dot(b.cross(c));
        found.area += triangle_area(points).length();
        let [a, b, c] = corners.map(|v| welded[v as usize]);
        if a == b || b == c || c == a {
            found.collapsed += 1;
        } else {
            edges.extend([(a, b), (b, c), (c, a)].map(|(a, b)| (a.min(b), a.max(b), a < b)));
        }
    }
    found.signed_volume /= 6.0;
    edges.sort_unstable();
    found.closed = !edges.is_empty();
    for uses in edges.chunk_by(|e, f| (e.0, e.1) == (f.0, f.1)) {
        let forward = uses.iter().filter(|e| e.2).count();
        found.boundary_edges += u64::from(uses.len() == 1);
        found.non_manifold_edges += u64::from(uses.len() > 2);
        found.closed &= uses.len() == 2;
        found.oriented &= uses.len() == 1 || 2 * forward == uses.len();
    }
    found
}

fn finite_corners(mesh: &Mesh, corners: [u32; 3]) -> Option<[DVec3; 3]> {
    let point = |v: u32| mesh.positions.get(v as usize).filter(|p| p.is_finite());
    let [a, b, c] = corners.map(point);
    Some([a?.as_dvec3(), b?.as_dvec3(), c?.as_dvec3()])
}

/// For each vertex the number of the first, in sorted order, at the same place.
fn weld(positions: &[Vec3]) -> Vec<u32> {
    // Adding zero makes −0 and 0 one place.
    let key = |i: u32| (positions[i as usize] + Vec3::ZERO).to_array().map(f32::to_bits);
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.sort_unstable_by_key(|&i| (key(i), i));
    let mut welded = vec![0; positions.len()];
    for same in order.chunk_by(|&i, &j| key(i) == key(j)) {
        for &i in same {
            welded[i as usize] = same[0];
        }
    }
    welded
}
