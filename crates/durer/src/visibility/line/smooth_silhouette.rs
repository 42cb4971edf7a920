//! Silhouettes of the smooth surface that a mesh approximates.
//!
//! Aaron Hertzmann and Denis Zorin, *Illustrating smooth surfaces*, SIGGRAPH 2000: the silhouette is where the normal,
//! interpolated over a triangle, is at a right angle to the line of sight. The lines run through the triangles and do
//! not zigzag along their edges. But lines hidden by the mesh end at the mesh's own outline beside them, so a
//! silhouette drawn on the triangles would leave gaps and stubs where others end on it. Here the mesh itself gets the
//! silhouette, as in Pierre Bénard, Aaron Hertzmann and Michael Kass, *Computing smooth surface contours with accurate
//! topology*, ACM Transactions on Graphics, 2014: triangles are divided along it, and the new vertices are on the
//! smooth surface, over the edges of the mesh as in Alex Vlachos, Jörg Peters, Chas Boyd and Jason Mitchell, *Curved PN
//! triangles*, I3D 2001. Outline and hidden lines are then those of the same mesh, but the normals determine its
//! visible side: facets beside an outline may be turned otherwise, and slivers in any direction. A facet that shows the
//! other side is folded over the outline, and lines behind it are counted once less: so the number of surfaces in front
//! changes exactly at the outline, and the search for consistent positions of 2014 is not needed.
//!
//! `bend` finds where a surface hides its own outline. O(n log n).

use super::bend::{Bend, Bends};
use super::crossing::{Crossing, crossings};
use super::planes::Planes;
use super::roundness::Round;
use super::smooth_surface::SmoothSurface;
use crate::math::DVec3;
use crate::scene::Scene;
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
    /// Triangle in `whole` that each triangle is a part of.
    pub origins: Vec<u32>,
    /// Side of the surface at each triangle: 1 for its front, −1 for its back, 0 if it is not known.
    turns: Vec<i8>,
    /// Bend of the surface at each vertex of an outline.
    bends: Vec<Bend>,
    surface: SmoothSurface,
}

/// Faces before they were divided, if they were.
#[derive(Clone, Copy)]
pub(super) struct Whole<'a>(pub Option<&'a Divided>);

impl Whole<'_> {
    /// Returns the corners of the triangle that a triangle of `faces` is a part of.
    pub fn corners(self, faces: &Faces, item: u32) -> Option<[DVec3; 3]> {
        self.0.map_or_else(|| faces.corners(item), |d| d.whole.corners(self.item(item)))
    }

    /// Returns the triangle that one of `faces` is a part of.
    pub fn triangle(self, faces: &Faces, item: u32) -> Option<[u32; 3]> {
        self.0.map_or_else(|| faces.triangle(item), |d| d.whole.triangle(self.item(item)))
    }

    /// Returns the normal of the smooth surface that a sliver lies in, if it is turned against
    /// that.
    pub fn normal_at_sliver(self, item: u32) -> Option<DVec3> {
        self.0.and_then(|d| d.surface.normal_at_sliver(self.item(item)))
    }

    /// Returns whether it is known from a smooth surface how a triangle is turned.
    pub fn is_smooth(self, item: u32) -> bool {
        self.turns().get(item as usize).is_some_and(|turn| *turn != 0)
    }

    /// Returns the sides of the surfaces that triangles approximate, by item; see [`Divided`].
    pub fn turns(&self) -> &[i8] {
        self.0.map_or(&[], |d| &d.turns)
    }

    /// Returns whether an outline runs through the triangle that one is a part of, or touches it.
    pub fn at_outline(self, item: u32) -> bool {
        self.0.is_some_and(|d| d.surface.shows_both(self.item(item)))
    }

    /// Returns whether the triangle that one is a part of has a vertex of those that others are
    /// parts of.
    pub fn is_beside(self, item: u32, others: [u32; 2]) -> bool {
        let Some(divided) = self.0 else { return false };
        let of = |item: u32| divided.whole.triangle(self.item(item)).unwrap_or_default();
        let own = of(item);
        others.iter().any(|o| of(*o).iter().any(|v| own.contains(v)))
    }

    /// Returns the bend of the surface at a vertex of an outline; see [`Divided`].
    pub fn bend(self, vertex: u32) -> Bend {
        self.0.and_then(|d| d.bends.get(vertex as usize)).copied().unwrap_or_default()
    }

    /// Returns the item of the scene.
    pub fn item(self, item: u32) -> u32 {
        self.0.map_or(item, |d| d.origins.get(item as usize).copied().unwrap_or(item))
    }
}

/// A part of a triangle: the triangle's item, and the vertices of the part.
type Part = (u32, [u32; 3]);

/// A corner of a part of a triangle: its vertex, and where it lies on the flat triangle.
type Corner = (u32, DVec3);

/// Divides the faces that are said to be `round`.
pub(super) fn divided(
    scene: &Scene,
    (whole, edges, planes): (Faces, &Edges, Planes),
    plane: &PicturePlane,
    round: &Round,
) -> Divided {
    let surface = SmoothSurface::new(scene, (&whole, edges, &planes), plane, round);
    drop(planes);
    let mut crossings = crossings(&whole, &surface);
    crossings.sort_unstable_by(|a, b| {
        a.edge.cmp(&b.edge).then(a.at.total_cmp(&b.at)).then(a.item.cmp(&b.item))
    });
    let bends = Bends::new(&whole, &surface, &crossings, plane);
    let found = Vertices::new(&whole, &surface, edges, &crossings, &bends);
    let (mut parts, mut buffers) = (Vec::new(), (Vec::new(), Vec::new()));
    let mut crossed = vec![false; whole.points().len()];
    crossings.iter().flat_map(|c| c.edge).for_each(|v| crossed[v as usize] = true);
    for (item, triangle) in whole.triangles() {
        if triangle.iter().filter(|v| crossed[**v as usize]).count() > 1 {
            found.divide(item, triangle, &mut buffers, &mut parts);
        }
    }
    let Vertices { points, bends, .. } = found;
    let (faces, origins) = whole.refined(edges, points, &parts);
    let turn = |(item, origin): (u32, &u32)| {
        let smooth = surface.corners(*origin).and_then(|_| whole.triangle(*origin));
        let Some((part, all)) = faces.triangle(item).zip(smooth) else { return 0 };
        surface.side(*origin, |k| part.contains(&all[k]))
    };
    let turns = (0..).zip(&origins).map(turn).collect();
    Divided { faces, whole, origins, turns, bends, surface }
}

/// Returns, for each vertex, the start of the crossings, which are sorted, whose smaller end it is; and their number.
fn starts(crossings: &[Crossing], vertices: usize) -> Vec<u32> {
    let mut starts = vec![0_u32; vertices + 1];
    crossings.iter().for_each(|c| starts[c.edge[0] as usize + 1] += 1);
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }
    starts
}

/// The vertices that the silhouette gives to the edges.
struct Vertices<'a> {
    faces: &'a Faces,
    surface: &'a SmoothSurface,
    crossings: &'a [Crossing],
    /// For each vertex where the crossings of its edges to larger ones start; one more at the end.
    starts: Vec<u32>,
    /// Vertex of each crossing, new or old.
    vertices: Vec<u32>,
    /// The points of the faces, and the new ones.
    points: Vec<DVec3>,
    /// See [`Divided`].
    bends: Vec<Bend>,
}

impl<'a> Vertices<'a> {
    /// Creates the vertices of the silhouette; `crossings` are sorted by edge, then place.
    fn new(
        faces: &'a Faces,
        surface: &'a SmoothSurface,
        edges: &Edges,
        crossings: &'a [Crossing],
        bends: &Bends,
    ) -> Self {
        let mut found = Self {
            faces,
            surface,
            crossings,
            starts: starts(crossings, faces.points().len()),
            vertices: Vec::new(),
            points: Vec::with_capacity(faces.points().len() + crossings.len()),
            bends: vec![Bend::default(); faces.points().len()],
        };
        found.points.extend_from_slice(faces.points());
        for on_edge in crossings.chunk_by(|a, b| a.edge == b.edge) {
            let sides = edges.at(on_edge[0].edge).len();
            for same in on_edge.chunk_by(|a, b| a.at == b.at) {
                let all_alike = sides > 1
                    && same.len() == sides
                    && same.iter().all(|c| c.corners == same[0].corners);
                let vertex = found.vertex(&same[0], all_alike);
                found.bends[vertex as usize] = bends.at(&same[0]);
                found.vertices.extend(same.iter().map(|_| vertex));
            }
        }
        found
    }

    /// Returns the vertex of a crossing; on the curve over the edge if the surface is `round`
    /// there.
    fn vertex(&mut self, crossing: &Crossing, round: bool) -> u32 {
        let Crossing { edge, at, corners, .. } = *crossing;
        let ends = edge.map(|v| self.points[v as usize]);
        if at < AT_VERTEX {
            return edge[0];
        } else if at > 1.0 - AT_VERTEX {
            return edge[1];
        }
        let normals = corners.map(|c| self.surface.normals[c as usize]);
        let round = round && normals[0].dot(normals[1]) > ROUND;
        self.points.push(if round { curve_over(ends, normals, at) } else { flat(ends, at) });
        self.bends.push(Bend::default());
        self.points.len() as u32 - 1
    }

    /// Pushes the parts of a triangle, if it has more than one. The previous contents of the buffers
    /// are ignored.
    fn divide(
        &self,
        item: u32,
        triangle: [u32; 3],
        (ring, own): &mut (Vec<Corner>, Vec<u32>),
        parts: &mut Vec<Part>,
    ) {
        ring.clear();
        own.clear();
        for i in 0..3 {
            let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
            ring.push((a, self.faces.points()[a as usize]));
            self.add_crossings(item, [a, b], ring, own);
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
            triangulate(ring, |vertices| parts.push((item, vertices)));
        };
        match places[..] {
            [p, q] if p.abs_diff(q) > 1 && p.abs_diff(q) + 1 < ring.len() => {
                let (p, q) = (p.min(q), p.max(q));
                push(ring[p..=q].to_vec());
                push(ring[q..].iter().chain(&ring[..=p]).copied().collect());
            }
            _ => push(ring.clone()),
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
        let [start, end] = [0, 1].map(|k| self.starts[edge[0] as usize + k] as usize);
        let here = self.crossings[start..end].iter().zip(&self.vertices[start..end]);
        let first = ring.len();
        for (crossing, &vertex) in here.filter(|(c, _)| c.edge == edge) {
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

/// Returns a point of the cubic over an edge that is at a right angle to the normals at its ends.
fn curve_over([p, q]: [DVec3; 2], [n, m]: [DVec3; 2], t: f64) -> DVec3 {
    let along = q - p;
    let b = (p * 2.0 + q - n * along.dot(n)) / 3.0;
    let c = (q * 2.0 + p + m * along.dot(m)) / 3.0;
    let s = 1.0 - t;
    p * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + q * (t * t * t)
}

/// Cuts the ears off a convex ring, of which more than two may lie on a line: the best first, if that leaves a ring and
/// not a line.
fn triangulate(mut ring: Vec<Corner>, mut push: impl FnMut([u32; 3])) {
    while ring.len() > 2 {
        let count = ring.len();
        let ear = |i: usize| [ring[(i + count - 1) % count], ring[i], ring[(i + 1) % count]];
        let quality = |i: usize| height(ear(i)).min(width_without(&ring, i));
        let best = (0..count).map(|i| (quality(i), i)).max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, best)) = best else { return };
        push(ear(best).map(|c| c.0));
        ring.remove(best);
    }
}

/// Returns the width of a ring without one of its corners, as a part of its length; 1 if nothing of it
/// remains.
fn width_without(ring: &[Corner], gone: usize) -> f64 {
    let left = (1..ring.len()).map(|k| ring[(gone + k) % ring.len()].1);
    let mut rest = left.clone().skip(1);
    let (Some(first), Some(mut last)) = (left.clone().next(), rest.next()) else { return 1.0 };
    let (mut area, mut longest, mut any) = (DVec3::ZERO, first.distance_squared(last), false);
    for p in rest {
        area += (last - first).cross(p - first);
        longest = longest.max(first.distance_squared(p)).max(last.distance_squared(p));
        (last, any) = (p, true);
    }
    if any { area.length() / longest } else { 1.0 }
}

/// Returns the height of a triangle as a part of its longest side.
fn height(corners: [Corner; 3]) -> f64 {
    let [a, b, c] = corners.map(|c| c.1);
    let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
    (b - a).cross(c - a).length() / longest
}
