//! Primitives whose corners have an index for each of their attributes, as they become a mesh.

use crate::{color, place};
use durer::math::{DVec3, Vec2, Vec3, Vec4};
use durer::scene::{Mesh, Part, Topology};
use std::collections::HashMap;
use std::ops::Range;

/// The most sets of texture coordinates that are read.
pub(crate) const SETS: usize = 4;
/// Index of a missing attribute of a corner.
pub(crate) const NONE: u32 = u32::MAX;

/// Indices of a corner: position, normal, colour, sets of texture coordinates.
pub(crate) type Corner = [u32; 3 + SETS];

/// Attributes that the indices of corners refer to.
pub(crate) trait Values {
    /// Returns whether there are values for one of a corner's indices.
    fn has(&self, slot: usize) -> bool;
    /// Returns the values of an index, with `fill` for missing ones; `None` beyond the end.
    fn get(&self, slot: usize, index: u32, fill: f64) -> Option<[f64; 4]>;
}

/// A mesh of a geometry, without materials.
#[derive(Debug, Clone)]
pub(crate) struct Piece {
    /// Its parts have no material yet.
    pub mesh: Mesh,
    /// Origin of positions.
    pub origin: DVec3,
    /// Name of each part's material.
    pub symbols: Vec<String>,
    /// The file's numbers of the sets of texture coordinates.
    pub sets: Vec<u64>,
}

/// Primitives whose indices refer to the same vertices, as one mesh.
pub(crate) struct Builder {
    topology: Topology,
    /// The file's numbers of the sets of texture coordinates.
    sets: Vec<u64>,
    pub corners: Vec<Corner>,
    known: HashMap<Corner, u32>,
    indices: Vec<u32>,
    faces: Vec<u32>,
    runs: Vec<(usize, String)>,
}

impl Builder {
    pub fn new(topology: Topology, sets: Vec<u64>) -> Self {
        let (corners, known, indices, faces, runs) = Default::default();
        Self { topology, sets, corners, known, indices, faces, runs }
    }

    /// Begins a part with another material, by its name.
    pub fn begin(&mut self, symbol: &str) {
        self.runs.push((self.indices.len(), symbol.to_owned()));
    }

    /// Adds a polygon of at least three vertices as a fan.
    pub fn polygon(&mut self, vertices: &[u32]) {
        let [first, rest @ ..] = vertices else { return };
        self.faces.push((self.indices.len() / 3) as u32);
        for w in rest.windows(2) {
            self.indices.extend([*first, w[0], w[1]]);
        }
    }

    /// Adds a line.
    pub fn line(&mut self, ends: [u32; 2]) {
        self.indices.extend(ends);
    }

    /// Returns the number of a corner's vertex.
    pub fn vertex(&mut self, corner: Corner) -> u32 {
        *self.known.entry(corner).or_insert_with(|| {
            self.corners.push(corner);
            (self.corners.len() - 1) as u32
        })
    }

    /// Returns the mesh; `None` if it is empty.
    pub fn piece(self, values: &dyn Values, name: &str) -> Option<Piece> {
        let Builder { topology, sets, corners, indices, mut faces, runs, .. } = self;
        if indices.is_empty() {
            return None;
        }
        let get = |slot: usize, index: u32, fill: f64| values.get(slot, index, fill);
        let vector = |slot: usize, index: u32| {
            get(slot, index, 0.0).map_or(DVec3::ZERO, |[x, y, z, _]| DVec3::new(x, y, z))
        };
        let points: Vec<DVec3> = corners.iter().map(|c| vector(0, c[0])).collect();
        let origin = place::origin(&points);
        let mut mesh = Mesh { name: name.to_owned(), topology, ..Mesh::default() };
        mesh.positions = place::narrow(&points, origin);
        if values.has(1) && topology == Topology::Triangles {
            let of = |c: &Corner| vector(1, c[1]).normalize_or_zero().as_vec3();
            mesh.normals = corners.iter().map(of).collect();
        }
        if values.has(2) {
            let of = |c: &Corner| linear(get(2, c[2], 1.0).unwrap_or([1.0; 4]));
            mesh.colors = corners.iter().map(of).collect();
        }
        for slot in (0..sets.len()).map(|set| 3 + set).filter(|&slot| values.has(slot)) {
            // That of files runs upwards.
            let of = |c: &Corner| {
                let [u, v, ..] = get(slot, c[slot], 0.0).unwrap_or_default();
                Vec2::new(u as f32, (1.0 - v) as f32)
            };
            mesh.tex_coords.push(corners.iter().map(of).collect());
        }
        let per = if topology == Topology::Triangles { 3 } else { 2 };
        if faces.len() == indices.len() / 3 {
            faces = Vec::new();
        }
        mesh.faces = faces;
        let count = indices.len() / per;
        mesh.indices = Some(indices);
        let symbols = parts(&mut mesh, runs, per, count);
        Some(Piece { mesh, origin, symbols, sets })
    }
}

/// Adds the parts to a mesh, and returns the names of their materials.
fn parts(mesh: &mut Mesh, runs: Vec<(usize, String)>, per: usize, count: usize) -> Vec<String> {
    let starts: Vec<usize> = runs.iter().map(|(start, _)| start / per).chain([count]).collect();
    let mut symbols = Vec::new();
    for ((_, symbol), ends) in runs.into_iter().zip(starts.windows(2)) {
        let range: Range<u32> = ends[0] as u32..ends[1] as u32;
        if !range.is_empty() {
            mesh.parts.push(Part { range, material: None, name: String::new() });
            symbols.push(symbol);
        }
    }
    symbols
}

/// Returns an sRGB colour with alpha as linear light.
fn linear([r, g, b, a]: [f64; 4]) -> Vec4 {
    let rgb: Vec3 = color::linear3([r, g, b].map(|v| v as f32));
    rgb.extend(a as f32)
}
