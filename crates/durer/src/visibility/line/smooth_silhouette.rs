//! Silhouettes of the smooth surface that a mesh stands for.
//!
//! Aaron Hertzmann and Denis Zorin, *Illustrating smooth surfaces*, SIGGRAPH 2000: where the normal,
//! interpolated over a triangle, is at a right angle to the line of sight. The lines run through the
//! triangles and do not zigzag along their edges. What the mesh hides ends at the mesh's own outline
//! beside them, though, so a line drawn on the triangles would leave gaps and stubs where others end on
//! it. Here the mesh itself gets the silhouette, as in Pierre Bénard, Aaron Hertzmann and Michael
//! Kass, *Computing smooth surface contours with accurate topology*, ACM Transactions on Graphics, 2014:
//! triangles are divided along it, and the new vertices lie on the smooth surface, over the edges
//! of the mesh as in Alex Vlachos, Jörg Peters, Chas Boyd and Jason Mitchell, *Curved PN triangles*,
//! I3D 2001. Outline and hidden lines are then those of one and the same mesh. Where its facing differs from
//! that of the normals, the outline is the mesh's: 2014's search for consistent positions is left
//! out. O(n).

use crate::math::{DMat3, DVec3};
use crate::scene::{Mesh, Scene};
use crate::view::picture_plane::PicturePlane;
use crate::visibility::object::{Edges, Faces};

/// Nearer to a vertex than this part of an edge, the silhouette goes through the vertex: slivers help
/// nobody.
const AT_VERTEX: f64 = 1.0 / 64.0;

/// Edges whose normals differ by more than 60° are straight.
const ROUND: f64 = 0.5;

/// Faces divided along their smooth silhouettes.
pub(super) struct Divided {
    pub faces: Faces,
    /// The faces as they were.
    pub whole: Faces,
    /// Of each triangle the one in `whole` that it is a part of.
    pub origins: Vec<u32>,
}

/// What faces were before they were divided, if they were.
#[derive(Clone, Copy)]
pub(super) struct Whole<'a>(pub Option<&'a Divided>);

impl Whole<'_> {
    /// The corners of the triangle that a triangle of `faces` is a part of.
    pub fn corners(self, faces: &Faces, item: u32) -> Option<[DVec3; 3]> {
        self.0.map_or_else(|| faces.corners(item), |d| d.whole.corners(self.item(item)))
    }

    /// The item of the scene.
    pub fn item(self, item: u32) -> u32 {
        self.0.map_or(item, |d| d.origins[item as usize])
    }
}

/// A place of the silhouette on an edge of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Crossing {
    /// The edge, the smaller vertex first.
    edge: [u32; 2],
    /// 0 … 1 from the first vertex.
    at: f64,
    /// Unit normals at both vertices.
    normals: [DVec3; 2],
    item: u32,
}

/// A part of a triangle.
struct Part {
    item: u32,
    vertices: [u32; 3],
}

/// A corner of a part of a triangle: its vertex, and where it lies on the flat triangle.
type Corner = (u32, DVec3);

/// Divides the faces. Normals are those of the file; meshes without any get them as
/// [`Mesh::with_smooth_normals`] does.
pub(super) fn divided(scene: &Scene, whole: Faces, plane: &PicturePlane) -> Divided {
    let mut crossings = crossings(scene, &whole, plane);
    crossings.sort_unstable_by(|a, b| {
        a.edge.cmp(&b.edge).then(a.at.total_cmp(&b.at)).then(a.item.cmp(&b.item))
    });
    let found = Vertices::new(&whole, &crossings);
    let mut parts = Vec::new();
    for (item, triangle) in whole.triangles() {
        found.divide(item, triangle, &mut parts);
    }
    let points = found.points;
    let (faces, origins) = whole.refined(points, parts.iter().map(|p| (p.item, p.vertices)));
    Divided { faces, whole, origins }
}

/// Where the normals of all triangles turn away from the eye, two on each that has any.
fn crossings(scene: &Scene, faces: &Faces, plane: &PicturePlane) -> Vec<Crossing> {
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
            let normals = of_mesh
                .map(|v| (normal_matrix * mesh.normals[v as usize].as_dvec3()).normalize_or_zero());
            let slopes = [0, 1, 2].map(|k| normals[k].dot(plane.sight_at(corners[k])));
            if slopes.iter().all(|s| s.is_finite()) {
                found.extend(zeros(item, vertices, slopes, normals));
            }
        }
    }
    found
}

/// Where a function that is linear along the edges of a triangle changes its sign. Neighbours with
/// the same values at their common edge find the same place, to the bit.
fn zeros(
    item: u32,
    vertices: [u32; 3],
    values: [f64; 3],
    normals: [DVec3; 3],
) -> impl Iterator<Item = Crossing> {
    (0..3).filter_map(move |i| {
        let k = (i + 1) % 3;
        let (a, b) = if vertices[i] < vertices[k] { (i, k) } else { (k, i) };
        ((values[a] >= 0.0) != (values[b] >= 0.0)).then(|| Crossing {
            edge: [vertices[a], vertices[b]],
            at: values[a] / (values[a] - values[b]),
            normals: [normals[a], normals[b]],
            item,
        })
    })
}

/// The vertices that the silhouette gives to the edges.
struct Vertices<'a> {
    faces: &'a Faces,
    crossings: &'a [Crossing],
    /// Of each crossing its vertex, new or old.
    vertices: Vec<u32>,
    /// The points of the faces, and the new ones.
    points: Vec<DVec3>,
}

impl<'a> Vertices<'a> {
    /// `crossings` are sorted by edge, then place.
    fn new(faces: &'a Faces, crossings: &'a [Crossing]) -> Self {
        let mut found =
            Self { faces, crossings, vertices: Vec::new(), points: faces.points().to_vec() };
        let edges = Edges::new(faces, |_| true);
        for on_edge in crossings.chunk_by(|a, b| a.edge == b.edge) {
            let sides = edges.at(on_edge[0].edge).len();
            for same in on_edge.chunk_by(|a, b| a.at == b.at) {
                let all_alike = sides > 1
                    && same.len() == sides
                    && same.iter().all(|c| c.normals == same[0].normals);
                let vertex = found.vertex(&same[0], all_alike);
                found.vertices.extend(same.iter().map(|_| vertex));
            }
        }
        found
    }

    /// The vertex of a crossing; on the curve over the edge if the surface is `round` there.
    fn vertex(&mut self, crossing: &Crossing, round: bool) -> u32 {
        let Crossing { edge, at, normals, .. } = *crossing;
        let ends = edge.map(|v| self.points[v as usize]);
        if at < AT_VERTEX {
            return edge[0];
        } else if at > 1.0 - AT_VERTEX {
            return edge[1];
        }
        let round = round && normals[0].dot(normals[1]) > ROUND;
        self.points.push(if round { curve_over(ends, normals, at) } else { flat(ends, at) });
        self.points.len() as u32 - 1
    }

    /// Pushes the parts of a triangle, if it has more than one.
    fn divide(&self, item: u32, triangle: [u32; 3], parts: &mut Vec<Part>) {
        let mut ring: Vec<Corner> = Vec::with_capacity(6);
        let mut own = Vec::with_capacity(2);
        for i in 0..3 {
            let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
            ring.push((a, self.faces.points()[a as usize]));
            self.add_crossings(item, [a, b], &mut ring, &mut own);
        }
        ring.dedup_by_key(|c| c.0);
        if ring.len() > 1 && ring[0].0 == ring[ring.len() - 1].0 {
            ring.pop();
        }
        if ring.len() < 4 {
            return;
        }
        let places = own.iter().map(|v| ring.iter().position(|c| c.0 == *v));
        let places: Vec<usize> = places.flatten().collect();
        let mut push = |ring: Vec<Corner>| {
            triangulate(ring, |vertices| parts.push(Part { item, vertices }));
        };
        match places[..] {
            [p, q] if p.abs_diff(q) > 1 && p.abs_diff(q) + 1 < ring.len() => {
                let (p, q) = (p.min(q), p.max(q));
                push(ring[p..=q].to_vec());
                push(ring[q..].iter().chain(&ring[..=p]).copied().collect());
            }
            _ => push(ring),
        }
    }

    /// Pushes what lies on an edge, from a to b; with what of it is the triangle's own silhouette.
    fn add_crossings(
        &self,
        item: u32,
        [a, b]: [u32; 2],
        ring: &mut Vec<Corner>,
        own: &mut Vec<u32>,
    ) {
        let edge = [a.min(b), a.max(b)];
        let start = self.crossings.partition_point(|c| c.edge < edge);
        let on_edge = self.crossings[start..].iter().take_while(|c| c.edge == edge);
        let first = ring.len();
        for (crossing, &vertex) in on_edge.zip(&self.vertices[start..]) {
            ring.push((vertex, flat(edge.map(|v| self.faces.points()[v as usize]), crossing.at)));
            if crossing.item == item {
                own.push(vertex);
            }
        }
        if a > b {
            ring[first..].reverse();
        }
    }
}

fn flat([p, q]: [DVec3; 2], t: f64) -> DVec3 {
    p + (q - p) * t
}

/// A point of the cubic over an edge that is at a right angle to the normals at its ends.
fn curve_over([p, q]: [DVec3; 2], [n, m]: [DVec3; 2], t: f64) -> DVec3 {
    let along = q - p;
    let b = (p * 2.0 + q - n * along.dot(n)) / 3.0;
    let c = (q * 2.0 + p + m * along.dot(m)) / 3.0;
    let s = 1.0 - t;
    p * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + q * (t * t * t)
}

/// Cuts the ears off a convex ring, the best first.
fn triangulate(mut ring: Vec<Corner>, mut push: impl FnMut([u32; 3])) {
    while ring.len() > 2 {
        let count = ring.len();
        let ear = |i: usize| [ring[(i + count - 1) % count], ring[i], ring[(i + 1) % count]];
        let best = (0..count).map(|i| (height(ear(i)), i)).max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, best)) = best else { return };
        push(ear(best).map(|c| c.0));
        ring.remove(best);
    }
}

/// The height of a triangle as a part of its longest side.
fn height(corners: [Corner; 3]) -> f64 {
    let [a, b, c] = corners.map(|c| c.1);
    let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
    (b - a).cross(c - a).length() / longest
}
