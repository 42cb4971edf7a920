//! Triangles in item order, with their vertices welded by position, in world space.

use super::Edges;
use super::stitch::{Grain, divide, stitch};
use super::weld::{Weld, Welded, weld};
use crate::math::{DMat4, DVec3, Vec3, by_coordinates};
use crate::scene::{Aabb, Instance, Mesh, Scene, Topology};
use crate::view::near;
use crate::visibility::surface::setup::runs;
use crate::{Error, Result};
use std::ops::Range;

/// A run of faces of one instance and one material.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FaceRun {
    /// The items of its triangles.
    pub items: Range<u32>,
    /// Index into [`Scene::instances`].
    pub instance: usize,
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// The triangle of the mesh that is the first item.
    pub first: u32,
    /// Index into [`Scene::materials`]; `None` is the default material.
    pub material: Option<usize>,
}

/// The triangles of a scene, and its lines and points.
///
/// Vertices of one mesh at the same place are one vertex, so neighbours are found even where the file shares no
/// vertices. Vertices at borders are shared with those of other instances too, and triangles without height between
/// others are left out; [`Weld`] determines the tolerance.
///
/// # Guarantees
/// All points are finite; the three vertices of a triangle differ.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Faces {
    points: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    runs: Vec<FaceRun>,
    polygons: Option<Vec<u32>>,
    marks: Vec<[u32; 2]>,
    /// Triangles with vertices of others on their sides, in item order: their outlines including these vertices.
    outlines: Vec<(u32, Vec<u32>)>,
    /// True for each item that is among them; empty if none is.
    has_outline: Vec<bool>,
    /// Grain of each instance; empty if nothing is stitched.
    grains: Vec<Grain>,
    /// The edges, if they are known already.
    edges: Option<Edges>,
}

/// Value in place of the vertices of a triangle that has no area or no place.
const NONE: [u32; 3] = [u32::MAX; 3];

impl Faces {
    /// Creates the faces of a scene, welded by [`Weld::Auto`].
    ///
    /// # Errors
    /// See [`Self::welded`].
    pub fn new(scene: &Scene) -> Result<Self> {
        Self::welded(scene, Weld::Auto)
    }

    /// Returns the faces of a scene; O(n), and O(b log² b) for b borders.
    ///
    /// # Errors
    /// The errors of [`Scene::check`], [`Error::Parameter`] for a length that is none, and [`Error::Limit`] for more
    /// than 2³¹ − 1 triangles or vertices.
    pub fn welded(scene: &Scene, how: Weld) -> Result<Self> {
        scene.check()?;
        how.check()?;
        let limit = |what, value: u64| {
            let limit = u64::from(u32::MAX >> 1);
            if value > limit { Err(Error::Limit { what, value, limit }) } else { Ok(()) }
        };
        limit("number of triangles", scene.triangle_count())?;
        let vertices = |i: &Instance| scene.meshes[i.mesh].positions.len() as u64;
        limit("number of vertices", scene.instances.iter().map(vertices).sum())?;
        let mut faces = Self { runs: face_runs(scene)?, ..Self::default() };
        faces.triangles.reserve_exact(scene.triangle_count() as usize);
        let mut welded: Vec<Option<Welded>> = scene.meshes.iter().map(|_| None).collect();
        let exactly = how == Weld::None;
        for (instance, i) in scene.instances.iter().zip(0..) {
            let mesh = &scene.meshes[instance.mesh];
            let mut bounds = None;
            if mesh.topology == Topology::Triangles {
                let welded =
                    welded[instance.mesh].get_or_insert_with(|| weld(&mesh.positions, exactly));
                bounds = welded.bounds;
                let to_world = |v: &u32| {
                    let p = mesh.positions[*v as usize].as_dvec3();
                    instance.world_from_mesh.transform_point3(p)
                };
                faces.add(mesh, welded, to_world);
            }
            if !exactly {
                let tree = scene.trees.get(i).copied().unwrap_or(0);
                let grain = grain(instance, bounds, how);
                let digit = grain.digit * scene.last_digit;
                faces.grains.push(Grain { tree, digit, ..grain });
            }
        }
        for instance in &scene.instances {
            let mesh = &scene.meshes[instance.mesh];
            if mesh.topology != Topology::Triangles {
                faces.add_marks(mesh, &instance.world_from_mesh);
            }
        }
        faces.polygons = polygons(scene);
        if !exactly {
            let grains = std::mem::take(&mut faces.grains);
            faces.edges = Some(stitch(&mut faces, &grains));
            faces.grains = grains;
        }
        Ok(faces)
    }

    /// Leaves out some triangles.
    pub(super) fn leave_out(&mut self, items: &[u32]) {
        items.iter().for_each(|item| self.triangles[*item as usize] = NONE);
    }

    /// Puts vertices in the place of others, given as (old, new), and returns the items of the triangles that have
    /// changed.
    pub(super) fn renumber(&mut self, pairs: &[(u32, u32)]) -> Vec<u32> {
        if pairs.is_empty() {
            return Vec::new();
        }
        let mut number: Vec<u32> = (0..self.points.len() as u32).collect();
        pairs.iter().for_each(|(old, new)| number[*old as usize] = *new);
        let mut changed = Vec::new();
        for (t, item) in self.triangles.iter_mut().zip(0..).filter(|(t, _)| **t != NONE) {
            let now = t.map(|v| number[v as usize]);
            if now != *t {
                let [a, b, c] = now;
                *t = if a == b || b == c || c == a { NONE } else { now };
                changed.push(item);
            }
        }
        changed
    }

    /// Sets the outlines of those triangles that have more than three vertices on their sides, in item order.
    pub(super) fn set_outlines(&mut self, outlines: Vec<(u32, Vec<u32>)>) {
        self.has_outline = vec![false; self.triangles.len()];
        outlines.iter().for_each(|o| self.has_outline[o.0 as usize] = true);
        self.outlines = outlines;
    }

    /// Calls `f` with the ends of each side of a triangle, in its direction; a side with vertices of others on it is
    /// several.
    #[inline]
    pub(super) fn each_side(&self, item: u32, t: [u32; 3], mut f: impl FnMut(u32, u32)) {
        let [a, b, c] = t;
        let outline = (self.has_outline.get(item as usize) == Some(&true))
            .then(|| self.outlines.binary_search_by_key(&item, |o| o.0).ok())
            .flatten();
        match outline.map(|i| &self.outlines[i].1[..]) {
            Some(ring) => (0..ring.len()).for_each(|i| f(ring[i], ring[(i + 1) % ring.len()])),
            None => [(a, b), (b, c), (c, a)].into_iter().for_each(|(a, b)| f(a, b)),
        }
    }

    /// Returns the index of the instance that a triangle belongs to.
    pub(super) fn instance_of(&self, item: u32) -> Option<usize> {
        self.run_of(item).map(|run| run.instance)
    }

    /// Returns the edges of all triangles; each caller but the first has them found again.
    pub(in crate::visibility) fn take_edges(&mut self) -> Edges {
        self.edges.take().unwrap_or_else(|| Edges::new(self, |_| true))
    }

    /// Adds the lines or points of a mesh; those with a coordinate that is not finite are left out.
    fn add_marks(&mut self, mesh: &Mesh, world_from_mesh: &DMat4) {
        let offset = self.points.len() as u32;
        let to_world = |p: &Vec3| world_from_mesh.transform_point3(p.as_dvec3());
        self.points.extend(mesh.positions.iter().map(to_world));
        for i in 0..mesh.primitive_count() {
            let ends = mesh.line_or_point(i).map(|v| v + offset);
            if ends.iter().all(|&v| self.points[v as usize].is_finite()) {
                self.marks.push(ends);
            }
        }
        self.forget_infinite(offset);
    }

    /// Moves the points from `offset` on that are not finite, which no face or mark has, to the origin.
    fn forget_infinite(&mut self, offset: u32) {
        for p in self.points[offset as usize..].iter_mut().filter(|p| !p.is_finite()) {
            *p = DVec3::ZERO;
        }
    }

    fn add(&mut self, mesh: &Mesh, welded: &Welded, to_world: impl Fn(&u32) -> DVec3) {
        let offset = self.points.len() as u32;
        self.points.extend(welded.first.iter().map(to_world));
        let mut lost = false;
        for p in &mut self.points[offset as usize..] {
            lost |= !p.is_finite();
        }
        for i in 0..mesh.triangle_count() {
            let [a, b, c] = mesh.triangle(i).map(|v| welded.place[v as usize] + offset);
            let mut whole = a != b && b != c && c != a;
            if lost {
                whole &= [a, b, c].iter().all(|&v| self.points[v as usize].is_finite());
            }
            self.triangles.push(if whole { [a, b, c] } else { NONE });
        }
        if lost {
            self.forget_infinite(offset);
        }
    }

    /// Returns the faces with parts in place of some triangles, and for each triangle its former item. `edges` belong
    /// to the faces before the change, `parts` are (item, vertices) in item order, `points` are the faces' points
    /// followed by new ones. Parts of one polygon are one polygon.
    pub(in crate::visibility) fn refined(
        &self,
        edges: &Edges,
        points: Vec<DVec3>,
        parts: &[(u32, [u32; 3])],
    ) -> (Self, Vec<u32>) {
        let most = self.triangles.len() + parts.len();
        let (mut triangles, mut origins) = (Vec::with_capacity(most), Vec::with_capacity(most));
        let mut left = parts.iter().peekable();
        for (item, &t) in (0..).zip(&self.triangles) {
            let before = triangles.len();
            while let Some((_, part)) = left.next_if(|p| p.0 == item) {
                triangles.push(*part);
            }
            if triangles.len() == before {
                triangles.push(t);
            }
            origins.resize(triangles.len(), item);
        }
        let start = |item: u32| origins.partition_point(|&o| o < item) as u32;
        let run =
            |r: &FaceRun| FaceRun { items: start(r.items.start)..start(r.items.end), ..r.clone() };
        let runs = self.runs.iter().map(run).collect();
        let polygon = |&item: &u32| self.polygons.as_ref().map_or(item, |p| p[item as usize]);
        let polygons = Some(origins.iter().map(polygon).collect());
        let (marks, grains) = (self.marks.clone(), self.grains.clone());
        let mut refined = Self { points, triangles, runs, polygons, marks, ..Self::default() };
        refined.edges = Some(if self.is_at_outline(parts) {
            let edges = Edges::new(&refined, |_| true);
            divide(&mut refined, edges, &grains)
        } else {
            if !self.outlines.is_empty() {
                let outlines = self.outlines.iter().map(|(item, o)| (start(*item), o.clone()));
                refined.set_outlines(outlines.collect());
            }
            edges.divided(&refined, &origins)
        });
        refined.grains = grains;
        (refined, origins)
    }

    /// Returns whether parts of triangles touch one whose sides have vertices of others.
    fn is_at_outline(&self, parts: &[(u32, [u32; 3])]) -> bool {
        if self.outlines.is_empty() {
            return false;
        }
        let mut is_of_outline = vec![false; self.points.len()];
        let vertices = self.outlines.iter().flat_map(|(_, outline)| outline);
        vertices.for_each(|v| is_of_outline[*v as usize] = true);
        let touches = |v: &u32| is_of_outline.get(*v as usize) == Some(&true);
        parts.iter().flat_map(|(_, part)| part).any(touches)
    }

    /// Returns the number of triangles: one more than the largest item.
    pub(crate) fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Returns the distinct vertices, world space. Some may belong to no triangle.
    pub(crate) fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Returns the vertices of a triangle, indices into [`Self::points`], counter-clockwise seen from
    /// its front (unless its instance mirrors); `None` if two are one, or one is not finite, or for an
    /// item that does not exist.
    #[inline]
    pub(crate) fn triangle(&self, item: u32) -> Option<[u32; 3]> {
        self.triangles.get(item as usize).copied().filter(|t| *t != NONE)
    }

    /// Returns the lines of the scene, and its points as lines from a vertex to itself: indices
    /// into [`Self::points`], in scene order.
    pub(crate) fn marks(&self) -> &[[u32; 2]] {
        &self.marks
    }

    /// Returns all triangles that have three vertices, with their items, in item order.
    pub(crate) fn triangles(&self) -> impl Iterator<Item = (u32, [u32; 3])> + '_ {
        (0..).zip(&self.triangles).filter(|(_, t)| **t != NONE).map(|(item, t)| (item, *t))
    }

    /// Returns the corners of a triangle, world space; `None` as in [`Self::triangle`].
    #[inline]
    pub(crate) fn corners(&self, item: u32) -> Option<[DVec3; 3]> {
        Some(self.triangle(item)?.map(|v| self.points[v as usize]))
    }

    /// Returns the corners sorted by coordinates, independent of their order and direction in the file, so that copies
    /// of a triangle are rounded alike.
    pub(in crate::visibility) fn sorted_corners(&self, item: u32) -> Option<[DVec3; 3]> {
        let mut corners = self.corners(item)?;
        corners.sort_unstable_by(by_coordinates);
        Some(corners)
    }

    /// Returns the runs of one instance and material, in item order.
    pub(crate) fn runs(&self) -> &[FaceRun] {
        &self.runs
    }

    /// Returns the run of an item; `None` if there is no such item. O(log runs).
    pub(crate) fn run_of(&self, item: u32) -> Option<&FaceRun> {
        let run = self.runs.get(self.runs.partition_point(|r| r.items.end <= item))?;
        run.items.contains(&item).then_some(run)
    }

    /// Returns whether two triangles are parts of one face with more than three corners, as the file
    /// had it: their common side is not an edge. Neighbours in item order only, as fans are.
    #[inline]
    pub(crate) fn same_polygon(&self, a: u32, b: u32) -> bool {
        self.polygons.as_ref().is_some_and(|p| p.get(a as usize) == p.get(b as usize))
    }
}

/// Returns the precision of the coordinates of an instance whose mesh has these bounds, if the last
/// digit is 1.
fn grain(instance: &Instance, bounds: Option<Aabb>, how: Weld) -> Grain {
    let matrix = instance.world_from_mesh;
    let axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|a| a.truncate().length());
    let scale = axes.into_iter().fold(0.0, f64::max);
    let largest = bounds.map_or(0.0, |b| b.min.abs().max(b.max.abs()).max_element() * scale);
    let extent = bounds.map_or(0.0, |b| b.size().max_element() * scale);
    let finite = |v: f64| if v.is_finite() { v } else { 0.0 };
    let given = if let Weld::Within(length) = how { Some(length) } else { None };
    let step = finite(largest * near::STEP);
    Grain { tree: 0, step, digit: finite(scale), extent: finite(extent), given }
}

fn face_runs(scene: &Scene) -> Result<Vec<FaceRun>> {
    let triangles = runs(scene)?
        .into_iter()
        .filter(|run| scene.meshes[run.mesh].topology == Topology::Triangles)
        .map(|run| FaceRun {
            items: run.first_item..run.first_item + run.range.len() as u32,
            instance: run.instance,
            mesh: run.mesh,
            first: run.range.start,
            material: run.material,
        });
    Ok(triangles.collect())
}

/// Returns, for each item, the first item of its polygon; `None` if each polygon is one triangle.
fn polygons(scene: &Scene) -> Option<Vec<u32>> {
    scene.meshes.iter().any(|m| !m.faces.is_empty()).then(|| {
        let mut first_of = Vec::new();
        for instance in &scene.instances {
            let mesh = &scene.meshes[instance.mesh];
            let offset = first_of.len() as u32;
            first_of.extend(mesh.faces_of_triangles().map(|first| offset + first));
        }
        first_of
    })
}
