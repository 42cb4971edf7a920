//! The check that a mesh is the surface of a body, and the orientation of its faces.

use super::cull::triangle_area;
use super::near::{self, OF_EDGE, Places, STEP};
use crate::math::{DVec3, Vec3};
use crate::scene::{Aabb, Mesh};
use crate::sorting::CompactSort;

/// Result of [`mesh_topology`]. Vertices at one place count as one: those whose coordinates differ by no more than 2⁻²⁶
/// of the model's extent, and ends of borders closer than rounding may have moved them, as in
/// [`crate::visibility::object::Weld::Auto`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MeshTopology {
    /// True if each edge belongs to exactly two triangles: the mesh bounds a body.
    pub closed: bool,
    /// True if no edge is run through more often in one direction than in the other, except borders: neighbours agree
    /// on the front side.
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
    /// Returns whether all faces of a closed body are turned to its inside.
    pub fn inside_out(&self) -> bool {
        self.closed && self.oriented && self.signed_volume < 0.0
    }
}

/// Returns edges, border, volume and area of a triangle mesh, in its own coordinates.
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
    written_topology(mesh, 0.0)
}

/// Finds the topology for a mesh of a file whose coordinates have a last digit that is worth `last_digit`, as
/// [`crate::scene::Scene::last_digit`] returns it.
pub fn written_topology(mesh: &Mesh, last_digit: f64) -> MeshTopology {
    let welded = weld(mesh, last_digit);
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

/// Coordinates that differ by less than this part of the model's extent are one. Exporters write 5e-17
/// for 0; an f32 above a quarter of the extent cannot hold so small a difference. Much more would
/// close real gaps, less would leave models open that are closed.
const WELD: f64 = 1.0 / (1u64 << 26) as f64;

/// Returns, for each vertex, a number that is the same for all vertices at one place: the index of one of them. The
/// last digit of coordinates is worth `last_digit`, 0 if not known.
pub(super) fn weld(mesh: &Mesh, last_digit: f64) -> Vec<u32> {
    let mut welded = weld_places(&mesh.positions);
    let lone = border_ends(mesh, &welded);
    let Some(bounds) = Aabb::around(mesh.positions.iter().map(|p| p.as_dvec3())) else {
        return welded;
    };
    if lone.is_empty() {
        return welded;
    }
    let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
    let reach = near::reach(largest * STEP, last_digit, bounds.size().max_element());
    let points: Vec<DVec3> =
        lone.iter().map(|(v, _)| mesh.positions[*v as usize].as_dvec3()).collect();
    let reaches: Vec<f64> = lone.iter().map(|(_, longest)| reach.min(longest * OF_EDGE)).collect();
    let places = Places::new(points.iter().copied());
    let joined = places.joined(&points, &reaches, |_, _| true);
    let mut moved: Vec<(u32, u32)> =
        joined.into_iter().map(|(k, i)| (lone[k].0, lone[i].0)).collect();
    moved.sort_unstable();
    for place in &mut welded {
        if let Ok(found) = moved.binary_search_by_key(place, |m| m.0) {
            *place = moved[found].1;
        }
    }
    welded
}

/// Returns the vertices at which edges of one triangle end, in order, and the longest of these
/// edges.
fn border_ends(mesh: &Mesh, welded: &[u32]) -> Vec<(u32, f64)> {
    let mut edges: Vec<[u32; 2]> = Vec::with_capacity(mesh.triangle_count() * 3);
    for corners in (0..mesh.triangle_count()).map(|i| mesh.triangle(i)) {
        if finite_corners(mesh, corners).is_none() {
            continue;
        }
        let [a, b, c] = corners.map(|v| welded[v as usize]);
        edges.extend([[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]));
    }
    edges.sort_unstable();
    let place = |v: u32| mesh.positions[v as usize].as_dvec3();
    let borders = edges.chunk_by(|e, f| e == f).filter(|same| same.len() == 1).map(|same| same[0]);
    let mut ends: Vec<(u32, f64)> = borders
        .filter(|[a, b]| a != b)
        .flat_map(|ends| ends.map(|v| (v, place(ends[0]).distance(place(ends[1])))))
        .collect();
    ends.compact_sort_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
    ends.dedup_by_key(|e| e.0);
    ends
}

/// Joins the places within [`WELD`] of each other.
fn weld_places(positions: &[Vec3]) -> Vec<u32> {
    let bounds = Aabb::around(positions.iter().map(|p| p.as_dvec3()));
    let tolerance = bounds.map_or(0.0, |b| b.size().max_element() * WELD);
    let axes = [0, 1, 2].map(|axis| classes(positions, axis, tolerance));
    // Class numbers and the vertex's own in one integer: sorting needs no look-up.
    let packed = (0..positions.len()).map(|i| {
        axes.iter().fold(0, |bits, class| bits << 32 | u128::from(class[i])) << 32 | i as u128
    });
    let mut order: Vec<u128> = packed.collect();
    order.sort_unstable();
    let mut welded = vec![0; positions.len()];
    for same in order.chunk_by(|a, b| a >> 32 == b >> 32) {
        for &vertex in same {
            welded[vertex as u32 as usize] = same[0] as u32;
        }
    }
    welded
}

/// Numbers the distinct coordinates of one axis from the smallest; neighbours within the tolerance
/// share a number.
fn classes(positions: &[Vec3], axis: usize, tolerance: f64) -> Vec<u32> {
    let mut order: Vec<(f32, u32)> = positions.iter().zip(0..).map(|(p, i)| (p[axis], i)).collect();
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut class = vec![0; positions.len()];
    let mut number = 0;
    for pair in order.windows(2) {
        let gap = f64::from(pair[1].0) - f64::from(pair[0].0);
        number += u32::from(gap.is_nan() || gap > tolerance);
        class[pair[1].1 as usize] = number;
    }
    class
}
