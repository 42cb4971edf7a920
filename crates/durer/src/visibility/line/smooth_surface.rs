//! The smooth surface that a mesh approximates, near its outlines: a normal at each corner of each
//! triangle.
//!
//! The normals are those of the file if it has any, else averages (`vertex_normals`). An average of faces that all show
//! one side shows that side too, so outlines run only where faces of both sides meet. O(n), and O(k log k) for k
//! triangles there.

use super::planes::Planes;
use super::roundness::Round;
use super::vertex_normals::{Directions, direction, normals};
use crate::math::{DMat3, DVec3};
use crate::scene::{Mesh, Scene};
use crate::sorting::CompactSort;
use crate::view::picture_plane::PicturePlane;
use crate::visibility::object::{Edges, FaceRun, Faces};

/// The cosine up to which a normal of a file may be turned against its face: 45°.
const BELIEVED: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// The cosine within which normals are those of a flat face: files have them with 24 bits or six digits.
const FLAT: f64 = 1.0 - 1e-9;

/// Slopes below this are those of faces that are seen edge-on.
const EDGE_ON: f64 = 1e-6;

/// No corner.
const NONE: u32 = u32::MAX;

/// A vertex may have this many corners that are looked through for one that is alike.
const ALIKE: usize = 64;

/// Normals by corner; corners at one vertex with the same normal are one.
#[derive(Default)]
pub(super) struct SmoothSurface {
    /// The corners of each triangle, by item; [`NONE`] if it is flat.
    corners: Vec<[u32; 3]>,
    /// Unit normals, by corner.
    pub normals: Vec<DVec3>,
    /// Slope of the surface away from the eye, by corner: below 0 where the front is visible.
    pub slopes: Vec<f64>,
    /// The first corner at each vertex, and after each corner the next at the same.
    first: Vec<u32>,
    next: Vec<u32>,
    /// Slivers that are turned against the surface that they lie in, with its normal, in item order.
    turned: Vec<(u32, DVec3)>,
}

/// View and options that a surface is made for.
struct Seen<'a> {
    scene: &'a Scene,
    faces: &'a Faces,
    planes: &'a Planes,
    plane: &'a PicturePlane,
    /// True for each item that approximates a smooth surface.
    round: &'a [bool],
}

impl SmoothSurface {
    /// Creates the surface of the faces that are said to be `round`.
    pub fn new(
        scene: &Scene,
        (faces, edges, planes): (&Faces, &Edges, &Planes),
        plane: &PicturePlane,
        round: &Round,
    ) -> Self {
        let seen = Seen { scene, faces, planes, plane, round: &round.items };
        let kind = |(sharp, narrow): (f64, bool)| {
            let mut items = seen.without_normals();
            items.retain(|item| round.is_narrow(*item) == narrow);
            (Directions::new((faces, edges), planes, sharp, &items), items)
        };
        let kinds: Vec<_> = round.sharp().map(kind).collect();
        let turned = || kinds.iter().flat_map(|(directions, _)| &directions.turned).copied();
        let near = seen.near_outlines(turned().map(|t| t.0));
        let mut found = Self {
            corners: vec![[NONE; 3]; faces.len()],
            first: vec![NONE; faces.points().len()],
            ..Self::default()
        };
        for run in faces.runs() {
            let mesh = &scene.meshes[run.mesh];
            if !mesh.normals.is_empty() {
                found.add_given(&seen, run, mesh, &near);
            }
        }
        for (directions, items) in &kinds {
            found.add_averages(&seen, directions, items, &near);
        }
        found.turned.extend(turned());
        found.turned.compact_sort_by_key(|t| t.0);
        found
    }

    /// Returns the corners of a triangle, if it approximates a curved surface.
    pub fn corners(&self, item: u32) -> Option<[u32; 3]> {
        self.corners.get(item as usize).copied().filter(|c| c[0] != NONE)
    }

    /// Returns 1 where a triangle shows the front of the surface, −1 where its back, 0 where that is uncertain; by
    /// those of its corners that are also a part's.
    pub fn side(&self, item: u32, is_of_part: impl Fn(usize) -> bool) -> i8 {
        let Some(corners) = self.corners(item) else { return 0 };
        let slopes = (0..3).filter(|k| is_of_part(*k)).map(|k| self.slopes[corners[k] as usize]);
        let steepest = slopes.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0);
        if steepest.abs() < EDGE_ON { 0 } else { -steepest.signum() as i8 }
    }

    /// Returns whether both sides of the surface are seen at a triangle's corners.
    pub fn shows_both(&self, item: u32) -> bool {
        let slopes = |c: [u32; 3]| c.map(|c| self.slopes[c as usize]);
        let both = |s: [f64; 3]| s.iter().any(|s| *s >= 0.0) && s.iter().any(|s| *s <= 0.0);
        self.corners(item).is_some_and(|c| both(slopes(c)))
    }

    /// Returns the normal of the surface at a sliver that is turned against it.
    pub fn normal_at_sliver(&self, item: u32) -> Option<DVec3> {
        self.turned.binary_search_by_key(&item, |t| t.0).ok().map(|i| self.turned[i].1)
    }

    fn add_given(&mut self, seen: &Seen<'_>, run: &FaceRun, mesh: &Mesh, near: &[bool]) {
        let matrix = seen.normal_matrix(run);
        for item in run.items.clone().filter(|item| near[*item as usize]) {
            let Some(places) = seen.faces.corners(item) else { continue };
            let Some(normals) = believed(places, given(mesh, run, matrix, item)) else { continue };
            self.add(seen, item, normals);
            let (own, sliver) = direction(places);
            let normal = (normals[0] + normals[1] + normals[2]).normalize_or_zero();
            if sliver && own.normalize_or_zero().dot(normal) < BELIEVED {
                self.turned.push((item, normal));
            }
        }
    }

    /// Adds a triangle, unless it is flat.
    fn add(&mut self, seen: &Seen<'_>, item: u32, normals: [DVec3; 3]) {
        let Some(t) = seen.faces.triangle(item) else { return };
        let [a, b, c] = normals;
        let flat = a.dot(b) >= FLAT && a.dot(c) >= FLAT;
        if !flat && (a + b + c).is_finite() {
            self.corners[item as usize] = [0, 1, 2].map(|k| self.corner(seen, t[k], normals[k]));
        }
    }

    fn corner(&mut self, seen: &Seen<'_>, vertex: u32, normal: DVec3) -> u32 {
        let mut at = self.first[vertex as usize];
        for _ in 0..ALIKE {
            if at == NONE {
                break;
            } else if self.normals[at as usize] == normal {
                return at;
            }
            at = self.next[at as usize];
        }
        let corner = self.normals.len() as u32;
        self.normals.push(normal);
        self.slopes.push(normal.dot(seen.plane.sight_at(seen.faces.points()[vertex as usize])));
        self.next.push(std::mem::replace(&mut self.first[vertex as usize], corner));
        corner
    }

    /// Adds triangles of meshes without normals.
    fn add_averages(
        &mut self,
        seen: &Seen<'_>,
        directions: &Directions<'_>,
        items: &[u32],
        near: &[bool],
    ) {
        let faces = seen.faces;
        let added: Vec<u32> = items.iter().copied().filter(|i| near[*i as usize]).collect();
        let mut requested = vec![false; faces.points().len()];
        for t in added.iter().filter_map(|item| faces.triangle(*item)) {
            t.iter().for_each(|v| requested[*v as usize] = true);
        }
        let mut of_added = vec![[DVec3::ZERO; 3]; added.len()];
        let mut place = vec![NONE; faces.len()];
        added.iter().zip(0..).for_each(|(item, i)| place[*item as usize] = i);
        let found = normals(directions, items, &requested, |item| place[item as usize] != NONE);
        for (item, corner, normal) in found.into_iter().flatten() {
            of_added[place[item as usize] as usize][usize::from(corner)] = normal;
        }
        for (item, normals) in added.into_iter().zip(of_added) {
            self.add(seen, item, normals);
        }
    }
}

impl Seen<'_> {
    fn normal_matrix(&self, run: &FaceRun) -> DMat3 {
        DMat3::from_mat4(self.scene.instances[run.instance].world_from_mesh).inverse().transpose()
    }

    /// Returns the items of meshes without normals.
    fn without_normals(&self) -> Vec<u32> {
        let runs = self.faces.runs().iter();
        let without = runs.filter(|r| self.scene.meshes[r.mesh].normals.is_empty());
        let items = without.flat_map(|r| r.items.clone());
        items.filter(|item| self.round[*item as usize]).collect()
    }

    /// Returns true for each item that is at most two triangles away from where faces of both sides meet, or
    /// normals of both, or from a sliver of unknown side, which are given: outlines run there, and curvatures are
    /// averaged around them.
    fn near_outlines(&self, slivers: impl Iterator<Item = u32>) -> Vec<bool> {
        let mut sides = self.sides_at_vertices();
        for t in slivers.filter_map(|item| self.faces.triangle(item)) {
            t.iter().for_each(|v| sides[*v as usize] = BOTH);
        }
        let mut near: Vec<bool> = sides.into_iter().map(|s| s == BOTH).collect();
        for _ in 0..RINGS {
            let before = near.clone();
            for (_, t) in self.faces.triangles() {
                if t.iter().any(|v| before[*v as usize]) {
                    t.iter().for_each(|v| near[*v as usize] = true);
                }
            }
        }
        let mut found = vec![false; self.faces.len()];
        for (item, t) in self.faces.triangles() {
            found[item as usize] = self.round[item as usize] && t.iter().any(|v| near[*v as usize]);
        }
        found
    }

    /// Returns the visible sides of the faces around each vertex, and of the file's normals there.
    fn sides_at_vertices(&self) -> Vec<u8> {
        let mut sides = vec![0; self.faces.points().len()];
        for run in self.faces.runs() {
            let mesh = &self.scene.meshes[run.mesh];
            let matrix = self.normal_matrix(run);
            for item in run.items.clone() {
                let (Some(t), Some(places)) = (self.faces.triangle(item), self.faces.corners(item))
                else {
                    continue;
                };
                let own = side(self.planes.across(item).dot(self.plane.sight_at(places[0])));
                t.iter().for_each(|v| sides[*v as usize] |= own);
                if !mesh.normals.is_empty() {
                    let normals = given(mesh, run, matrix, item);
                    for k in 0..3 {
                        let slope = normals[k].dot(self.plane.sight_at(places[k]));
                        sides[t[k] as usize] |= side(slope);
                    }
                }
            }
        }
        sides
    }
}

/// Both sides, or one that is not known.
const BOTH: u8 = 3;

/// Number of rings of triangles around those at outlines that belong to the surface.
const RINGS: usize = 1;

/// Returns the side that a face of this slope shows.
fn side(slope: f64) -> u8 {
    if slope < 0.0 {
        1
    } else if slope > 0.0 {
        2
    } else {
        BOTH
    }
}

/// Returns the normals of a file at the corners of a triangle.
fn given(mesh: &Mesh, run: &FaceRun, matrix: DMat3, item: u32) -> [DVec3; 3] {
    let of_mesh = mesh.triangle((run.first + item - run.items.start) as usize);
    of_mesh.map(|v| (matrix * mesh.normals[v as usize].as_dvec3()).normalize_or_zero())
}

/// Returns the normals of a triangle; none if they have nothing to do with it, as where a file gives one to
/// the corner of a cube. On a round surface a sliver may be turned any way, so that is no reason there.
fn believed(places: [DVec3; 3], normals: [DVec3; 3]) -> Option<[DVec3; 3]> {
    let (own, sliver) = direction(places);
    let own = own.normalize_or_zero();
    let likes = |n: &DVec3| n.dot(own) >= BELIEVED;
    if sliver || normals.iter().all(likes) {
        return Some(normals);
    }
    normals.iter().all(|n| likes(&-*n)).then(|| normals.map(|n| -n))
}
