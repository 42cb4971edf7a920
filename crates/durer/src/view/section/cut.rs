//! Cutting the triangles of one mesh.

use crate::math::{Plane, Vec2, Vec3, Vec4};
use crate::scene::{Aabb, Mesh, Part};
use crate::view::topology::weld;
use std::collections::HashMap;

/// A mesh after a cut.
pub struct Cut {
    pub mesh: Mesh,
    /// New edges on the plane, as the borders of the cap run: against the faces beside them. Indices into
    /// the mesh's vertices; one place has one index.
    pub segments: Vec<[u32; 2]>,
}

/// Returns the part of a mesh of triangles inside a plane; `report` is called with each triangle's index and which of its
/// corners are inside.
pub fn triangles(
    mesh: &Mesh,
    plane: &Plane,
    last_digit: f64,
    mut report: impl FnMut(u32, [bool; 3]),
) -> Cut {
    let welded = weld(mesh, last_digit);
    let heights = heights(mesh, &welded, plane);
    let mut cutter = Cutter {
        old: mesh,
        welded: &welded,
        heights: &heights,
        mesh: Mesh { indices: None, parts: Vec::new(), faces: Vec::new(), ..mesh.clone() },
        indices: Vec::with_capacity(mesh.index_count()),
        places: HashMap::new(),
        vertices: HashMap::new(),
        segments: Vec::new(),
    };
    let mut parts: Vec<Part> = Vec::new();
    for (range, material) in mesh.material_runs() {
        let start = (cutter.indices.len() / 3) as u32;
        for t in range {
            let corners = mesh.triangle(t as usize);
            if let Some(inside) = cutter.triangle(corners) {
                report(t, inside);
            }
        }
        let range = start..(cutter.indices.len() / 3) as u32;
        let name = mesh.parts.get(parts.len()).map(|p| p.name.clone()).unwrap_or_default();
        parts.push(Part { range, material, name });
    }
    let Cutter { mut mesh, indices, segments, .. } = cutter;
    mesh.indices = Some(indices);
    mesh.parts = parts;
    Cut { mesh, segments }
}

/// Vertices this near to the plane, as a part of the mesh's extent, count as on it: the precision of an f32.
const ON_PLANE: f64 = 1.0 / (1u64 << 23) as f64;

/// Returns the distance of each vertex inside the plane, the same for all at one place.
fn heights(mesh: &Mesh, welded: &[u32], plane: &Plane) -> Vec<f64> {
    let bounds = Aabb::around(mesh.positions.iter().map(|p| p.as_dvec3()));
    let extent = bounds.map_or(0.0, |b| b.size().max_element());
    let tolerance = extent * plane.normal.length() * ON_PLANE;
    let height = |&v: &u32| {
        let height = plane.evaluate(mesh.positions[v as usize].as_dvec3());
        if height.abs() <= tolerance { 0.0 } else { height }
    };
    welded.iter().map(height).collect()
}

/// Returns the lines and points whose first vertex is inside a plane.
pub fn primitives(mesh: &Mesh, plane: &Plane) -> Mesh {
    let mut kept = Mesh { indices: None, parts: Vec::new(), ..mesh.clone() };
    let per = if mesh.topology == crate::scene::Topology::Points { 1 } else { 2 };
    let mut indices = Vec::new();
    for ((range, material), i) in mesh.material_runs().zip(0..) {
        let start = (indices.len() / per) as u32;
        for primitive in range {
            let ends = mesh.line_or_point(primitive as usize);
            if plane.evaluate(mesh.positions[ends[0] as usize].as_dvec3()) > 0.0 {
                indices.extend_from_slice(&ends[..per]);
            }
        }
        let name = mesh.parts.get(i).map(|p: &Part| p.name.clone()).unwrap_or_default();
        kept.parts.push(Part { range: start..(indices.len() / per) as u32, material, name });
    }
    kept.indices = Some(indices);
    kept
}

/// Adds the triangles of a cap as a part of their own, with their own vertices.
pub fn add_caps(mesh: &mut Mesh, caps: &[[u32; 3]], normal: crate::math::DVec3, material: usize) {
    let out = (-normal).normalize_or_zero().as_vec3();
    let mut copies: HashMap<u32, u32> = HashMap::new();
    let start = (mesh.index_count() / 3) as u32;
    let mut indices = mesh.indices.take().unwrap_or_default();
    for &v in caps.iter().flatten() {
        let copy = *copies.entry(v).or_insert_with(|| {
            let at = mesh.positions[v as usize];
            push(mesh, at, v, v, 0.0);
            let index = mesh.positions.len() as u32 - 1;
            if let Some(n) = mesh.normals.last_mut() {
                *n = out;
            }
            if let Some(c) = mesh.colors.last_mut() {
                *c = Vec4::ONE;
            }
            index
        });
        indices.push(copy);
    }
    let end = (indices.len() / 3) as u32;
    mesh.indices = Some(indices);
    mesh.parts.push(Part {
        range: start..end,
        material: Some(material),
        name: "section".to_owned(),
    });
}

struct Cutter<'a> {
    old: &'a Mesh,
    welded: &'a [u32],
    heights: &'a [f64],
    mesh: Mesh,
    indices: Vec<u32>,
    /// First vertex made at each position on the plane, for caps.
    places: HashMap<[u32; 3], u32>,
    /// New vertex of each edge of the file, which may have its own attributes.
    vertices: HashMap<(u32, u32), u32>,
    segments: Vec<[u32; 2]>,
}

impl Cutter<'_> {
    /// Adds the part of a triangle inside the plane, and returns which corners are inside; `None` if one is not finite.
    fn triangle(&mut self, t: [u32; 3]) -> Option<[bool; 3]> {
        let height = |v: u32| self.heights[v as usize];
        if t.iter().any(|&v| !height(v).is_finite()) {
            return None;
        }
        let inside = t.map(|v| height(v) > 0.0);
        match inside {
            [true, true, true] => self.indices.extend(t),
            [false, false, false] => {}
            _ => self.divide(t, inside),
        }
        Some(inside)
    }

    /// Adds the part inside the plane of a triangle that it cuts, and the new edge.
    fn divide(&mut self, t: [u32; 3], inside: [bool; 3]) {
        // Turned so that one corner is alone on its side.
        let alone =
            (0..3).find(|&i| inside[i] != inside[(i + 1) % 3] && inside[i] != inside[(i + 2) % 3]);
        let i = alone.unwrap_or(0);
        let [a, b, c] = [t[i], t[(i + 1) % 3], t[(i + 2) % 3]];
        let ((ab, p), (ac, q)) = (self.meet(a, b), self.meet(a, c));
        if inside[i] {
            self.add([a, ab, ac]);
            self.segment(q, p);
        } else {
            self.add([ab, b, c]);
            self.add([ab, c, ac]);
            self.segment(p, q);
        }
    }

    /// Adds a triangle unless two of its corners are one place.
    fn add(&mut self, t: [u32; 3]) {
        let [a, b, c] = t.map(|v| self.mesh.positions[v as usize]);
        if a != b && b != c && c != a {
            self.indices.extend(t);
        }
    }

    /// Adds the cap's border from `a` to `b`, because the faces beside the cap run from `b` to `a`.
    fn segment(&mut self, a: u32, b: u32) {
        if a != b {
            self.segments.push([a, b]);
        }
    }

    /// Finds the intersection of an edge and the plane: its own vertex, and the vertex of its place.
    fn meet(&mut self, v: u32, w: u32) -> (u32, u32) {
        // From the smaller of the welded vertices, so that both neighbours find the same place.
        let (v, w) =
            if self.welded[v as usize] <= self.welded[w as usize] { (v, w) } else { (w, v) };
        if let Some(&own) = self.vertices.get(&(v, w)) {
            return (own, self.place(own));
        }
        let (from, to) = (self.welded[v as usize], self.welded[w as usize]);
        let (d, e) = (self.heights[from as usize], self.heights[to as usize]);
        let t = d / (d - e);
        let [a, b] = [from, to].map(|v| self.old.positions[v as usize]);
        let at = if d == 0.0 {
            a
        } else if e == 0.0 {
            b
        } else {
            a.as_dvec3().lerp(b.as_dvec3(), t).as_vec3()
        };
        push(&mut self.mesh, at, v, w, t as f32);
        let own = self.mesh.positions.len() as u32 - 1;
        self.vertices.insert((v, w), own);
        (own, self.place(own))
    }

    /// Returns the first vertex at the position of another.
    fn place(&mut self, own: u32) -> u32 {
        // Adding zero makes one zero of two.
        let at = (self.mesh.positions[own as usize] + Vec3::ZERO).to_array().map(f32::to_bits);
        *self.places.entry(at).or_insert(own)
    }
}

/// Adds a vertex between two others.
fn push(mesh: &mut Mesh, at: Vec3, v: u32, w: u32, t: f32) {
    let (v, w) = (v as usize, w as usize);
    mesh.positions.push(at);
    if !mesh.normals.is_empty() {
        let n = mesh.normals[v].lerp(mesh.normals[w], t);
        mesh.normals.push(n.try_normalize().unwrap_or(mesh.normals[v]));
    }
    if !mesh.tangents.is_empty() {
        let (a, b): (Vec4, Vec4) = (mesh.tangents[v], mesh.tangents[w]);
        let direction = a.truncate().lerp(b.truncate(), t);
        let direction = direction.try_normalize().unwrap_or(a.truncate());
        mesh.tangents.push(direction.extend(a.w));
    }
    for set in &mut mesh.tex_coords {
        let uv: Vec2 = set[v].lerp(set[w], t);
        set.push(uv);
    }
    if !mesh.colors.is_empty() {
        let color = mesh.colors[v].lerp(mesh.colors[w], t);
        mesh.colors.push(color);
    }
}
