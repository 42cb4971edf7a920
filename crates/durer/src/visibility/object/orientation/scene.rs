//! The orientation of a scene's triangles.

use crate::Result;
use crate::math::{DMat3, DVec3};
use crate::scene::{Aabb, Mesh, Scene};
use crate::visibility::object::{Bodies, Edges, Faces};

/// Orientation of a scene's faces; triangles that are parts of one polygon count as one.
///
/// A closed piece of surface that faces inwards and is within another closed one bounds a cavity, and is right. Pieces
/// with a border take the direction of most of their triangles; pieces that cannot be oriented stay unchanged.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SceneOrientation {
    /// Number of closed pieces.
    pub closed: u64,
    /// Number of closed pieces, except cavities, most of whose faces are turned inwards.
    pub inside_out: u64,
    /// Number of faces that are turned otherwise than most of their piece.
    pub flipped: u64,
    /// True for each item that has to be turned.
    turned: Vec<bool>,
}

/// Limit on the boxes and triangles examined to find pieces within others; pieces left beyond it count as cavities.
const MOST_TESTS: u64 = 1 << 26;

impl SceneOrientation {
    /// Finds the orientation of all triangles of a scene. O(n log n) time for n triangles, and n for each piece that is
    /// turned inwards within the box of another one.
    ///
    /// # Errors
    /// Those of [`Faces::new`].
    pub fn of(scene: &Scene) -> Result<Self> {
        let faces = Faces::new(scene)?;
        let (bodies, edges) = Bodies::find(&faces);
        let pieces = Pieces::new(&faces, &bodies, &edges);
        let mut found = Self { turned: in_file(scene, &faces, &bodies), ..Self::default() };
        let mut tests = 0;
        for (piece, items) in pieces.items.iter().enumerate() {
            if pieces.torn[piece] {
                items.iter().for_each(|item| found.turned[*item as usize] = false);
                continue;
            }
            let closed = bodies.all()[piece].closed;
            found.closed += u64::from(closed);
            if found.most_turned(items) {
                if closed && !pieces.is_cavity(piece, &mut tests) {
                    found.inside_out += 1;
                } else {
                    items.iter().for_each(|item| found.turned[*item as usize] ^= true);
                }
            }
            found.flipped += found.odd(&faces, items);
        }
        Ok(found)
    }

    fn most_turned(&self, items: &[u32]) -> bool {
        2 * items.iter().filter(|item| self.turned[**item as usize]).count() > items.len()
    }

    /// Returns the number of faces that are turned otherwise than most.
    fn odd(&self, faces: &Faces, items: &[u32]) -> u64 {
        let most = self.most_turned(items);
        let is_first = |k: usize| k == 0 || !faces.same_polygon(items[k - 1], items[k]);
        let is_odd = |k: usize| self.turned[items[k] as usize] != most;
        (0..items.len()).filter(|k| is_odd(*k) && (is_first(*k) || !is_odd(k - 1))).count() as u64
    }

    /// Turns the faces that need it in the scene, which must be the one given to [`Self::of`]. Vertex normals that look
    /// away from the new front are reversed. Instances of one mesh that must be turned differently get separate meshes.
    pub fn apply(&self, scene: &mut Scene) {
        let mut next = 0;
        let mut made: Vec<Option<(Vec<bool>, usize)>> = vec![None; scene.meshes.len()];
        for instance in 0..scene.instances.len() {
            let mesh = scene.instances[instance].mesh;
            let count = scene.meshes[mesh].triangle_count();
            let own = self.turned.get(next..next + count).unwrap_or_default().to_vec();
            next += count;
            match &made[mesh] {
                Some((turned, place)) if *turned == own => scene.instances[instance].mesh = *place,
                // The first instance changes the mesh itself, later ones change copies of the original.
                Some((turned, place)) => {
                    let mut copy = scene.meshes[*place].clone();
                    let back: Vec<bool> = turned.iter().zip(&own).map(|(a, b)| a != b).collect();
                    turn(&mut copy, &back);
                    scene.instances[instance].mesh = scene.meshes.len();
                    scene.meshes.push(copy);
                }
                None => {
                    turn(&mut scene.meshes[mesh], &own);
                    made[mesh] = Some((own, mesh));
                }
            }
        }
    }
}

/// Returns true for each item whose corners run against the outside of its piece, as the file has it.
fn in_file(scene: &Scene, faces: &Faces, bodies: &Bodies) -> Vec<bool> {
    let mirrors =
        |i: &crate::scene::Instance| DMat3::from_mat4(i.world_from_mesh).determinant() < 0.0;
    let mirrored: Vec<bool> = scene.instances.iter().map(mirrors).collect();
    // Matrices that mirror turn no front into a back.
    let is_mirrored = |item: u32| faces.run_of(item).is_some_and(|run| mirrored[run.instance]);
    let turned = |item: u32| bodies.of(item).is_some() && bodies.turned(item) != is_mirrored(item);
    (0..faces.len() as u32).map(turned).collect()
}

/// The pieces of surface with their triangles.
struct Pieces<'a> {
    faces: &'a Faces,
    bodies: &'a Bodies,
    items: Vec<Vec<u32>>,
    /// True for those that cannot be oriented.
    torn: Vec<bool>,
    /// Boxes around the closed ones.
    boxes: Vec<Option<Aabb>>,
}

impl<'a> Pieces<'a> {
    fn new(faces: &'a Faces, bodies: &'a Bodies, edges: &Edges) -> Self {
        let count = bodies.all().len();
        let mut torn = vec![false; count];
        for (_, sides) in edges.iter() {
            let [a, b] = sides else { continue };
            let goes = |s: &super::super::EdgeSide| s.forward() != bodies.turned(s.item());
            if let (true, Some(piece)) = (goes(a) == goes(b), bodies.of(a.item())) {
                torn[piece as usize] = true;
            }
        }
        let mut items = vec![Vec::new(); count];
        for item in 0..faces.len() as u32 {
            if let Some(piece) = bodies.of(item) {
                items[piece as usize].push(item);
            }
        }
        let boxes = items.iter().zip(bodies.all()).map(|(items, body)| {
            let corners = items.iter().filter_map(|item| faces.corners(*item)).flatten();
            body.closed.then(|| Aabb::around(corners)).flatten()
        });
        let boxes = boxes.collect();
        Self { faces, bodies, items, torn, boxes }
    }

    /// Returns whether a piece is within an odd number of closed ones. `tests` counts triangles.
    fn is_cavity(&self, piece: usize, tests: &mut u64) -> bool {
        let Some(own) = &self.boxes[piece] else { return false };
        let corner = self.items[piece].first().and_then(|item| self.faces.corners(*item));
        let Some([corner, ..]) = corner else { return false };
        let mut around = 0;
        for (other, outer) in self.boxes.iter().enumerate() {
            *tests += 1;
            if *tests > MOST_TESTS {
                return true;
            }
            let holds = |b: &Aabb| b.min.cmple(own.min).all() && b.max.cmpge(own.max).all();
            if other == piece || !outer.as_ref().is_some_and(holds) {
                continue;
            }
            *tests += self.items[other].len() as u64;
            around += u64::from(self.winds_around(other, corner));
        }
        around % 2 == 1
    }

    /// Returns whether a closed piece winds around a point: the sum of the solid angles under which its triangles are
    /// seen (A. van Oosterom, J. Strackee, *The solid angle of a plane triangle*, IEEE Transactions on Biomedical
    /// Engineering 30, 1983) is 4π inside and 0 outside.
    fn winds_around(&self, piece: usize, at: DVec3) -> bool {
        let half = |item: &u32| {
            let [a, b, c] = self.faces.corners(*item)?.map(|p| p - at);
            let (la, lb, lc) = (a.length(), b.length(), c.length());
            let across = a.dot(b.cross(c));
            let along = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            let angle = libm::atan2(across, along);
            Some(if self.bodies.turned(*item) { -angle } else { angle })
        };
        let sum: f64 = self.items[piece].iter().filter_map(half).sum();
        sum.abs() > std::f64::consts::PI
    }
}

/// Turns triangles of a mesh.
fn turn(mesh: &mut Mesh, turned: &[bool]) {
    if !turned.contains(&true) {
        return;
    }
    let mut indices =
        mesh.indices.take().unwrap_or_else(|| (0..mesh.positions.len() as u32).collect());
    let triangles = || turned.iter().enumerate().filter(|(_, turned)| **turned).map(|(i, _)| i);
    triangles().for_each(|i| indices.swap(3 * i + 1, 3 * i + 2));
    if !mesh.normals.is_empty() {
        reverse_normals(mesh, &mut indices, turned);
    }
    mesh.indices = Some(indices);
}

/// Reverses the normals of turned triangles' corners that look away from the front; vertices that others use, too, are
/// doubled.
fn reverse_normals(mesh: &mut Mesh, indices: &mut [u32], turned: &[bool]) {
    let looks_away = |mesh: &Mesh, corners: &[u32], v: u32| {
        let [a, b, c] = [0, 1, 2].map(|k| mesh.positions[corners[k] as usize].as_dvec3());
        (b - a).cross(c - a).dot(mesh.normals[v as usize].as_dvec3()) < 0.0
    };
    let reversed: Vec<bool> = indices
        .as_chunks::<3>()
        .0
        .iter()
        .zip(turned)
        .flat_map(|(corners, turned)| corners.map(|v| *turned && looks_away(mesh, corners, v)))
        .collect();
    let mut kept = vec![false; mesh.positions.len()];
    for (&v, reversed) in indices.iter().zip(&reversed) {
        kept[v as usize] |= !reversed;
    }
    let mut copies: Vec<Option<u32>> = vec![None; mesh.positions.len()];
    for (index, _) in indices.iter_mut().zip(reversed).filter(|(_, reversed)| *reversed) {
        let v = *index as usize;
        *index = *copies[v].get_or_insert_with(|| {
            let place = if kept[v] { mesh.double(v) } else { v };
            mesh.normals[place] = -mesh.normals[place];
            place as u32
        });
    }
}
