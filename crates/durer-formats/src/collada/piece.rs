//! Pieces of geometries: primitives that share sources, as they become a mesh.

use super::source::Source;
use crate::{color, place};
use durer::math::{DVec3, Vec2, Vec3, Vec4};
use durer::scene::{Mesh, Part, Topology};
use std::collections::HashMap;
use std::ops::Range;
use std::rc::Rc;

/// The most sets of texture coordinates that are read.
pub(super) const SETS: usize = 4;
/// Where a corner has no such attribute.
pub(super) const NONE: u32 = u32::MAX;

/// Indices of a corner: position, normal, colour, sets of texture coordinates.
pub(super) type Corner = [u32; 3 + SETS];

/// The source of each of a corner's indices.
pub(super) type Slots = [Option<usize>; 3 + SETS];

/// A mesh of a geometry, without materials.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    /// Its parts have no material yet.
    pub mesh: Mesh,
    /// What positions are relative to.
    pub origin: DVec3,
    /// What each part calls its material.
    pub symbols: Vec<String>,
    /// The file's numbers of the sets of texture coordinates.
    pub sets: Vec<u64>,
}

/// Primitives that share sources: one mesh.
pub(super) struct Builder {
    pub topology: Topology,
    /// The source of each slot, and the sets' numbers.
    pub slots: Slots,
    pub sets: Vec<u64>,
    pub corners: Vec<Corner>,
    pub known: HashMap<Corner, u32>,
    pub indices: Vec<u32>,
    pub faces: Vec<u32>,
    pub runs: Vec<(usize, String)>,
}

impl Builder {
    pub fn new(topology: Topology, slots: Slots, sets: Vec<u64>) -> Self {
        let (corners, known, indices, faces, runs) = Default::default();
        Self { topology, slots, sets, corners, known, indices, faces, runs }
    }

    /// The number of a corner's vertex.
    pub fn vertex(&mut self, corner: Corner) -> u32 {
        *self.known.entry(corner).or_insert_with(|| {
            self.corners.push(corner);
            (self.corners.len() - 1) as u32
        })
    }

    /// The mesh; `None` where it is empty.
    pub fn piece(self, sources: &HashMap<usize, Option<Rc<Source>>>, name: &str) -> Option<Piece> {
        let Builder { topology, slots, sets, corners, indices, mut faces, runs, .. } = self;
        if indices.is_empty() {
            return None;
        }
        let source = |slot: usize| {
            let number: usize = slots[slot]?;
            sources.get(&number)?.clone()
        };
        let positions = source(0)?;
        let points: Vec<DVec3> = corners
            .iter()
            .map(|c| positions.get(c[0], 0.0).map_or(DVec3::ZERO, DVec3::from))
            .collect();
        let origin = place::origin(&points);
        let mut mesh = Mesh { name: name.to_owned(), topology, ..Mesh::default() };
        mesh.positions = place::narrow(&points, origin);
        if let Some(normals) = source(1).filter(|_| topology == Topology::Triangles) {
            let of = |c: &Corner| normals.get(c[1], 0.0).map_or(DVec3::ZERO, DVec3::from);
            mesh.normals = corners.iter().map(|c| of(c).normalize_or_zero().as_vec3()).collect();
        }
        if let Some(colors) = source(2) {
            let of = |c: &Corner| linear(colors.get(c[2], 1.0).unwrap_or([1.0; 4]));
            mesh.colors = corners.iter().map(of).collect();
        }
        for set in 0..sets.len() {
            let Some(places) = source(3 + set) else { continue };
            // The format's v runs upwards.
            let of = |c: &Corner| {
                let [u, v] = places.get(c[3 + set], 0.0).unwrap_or([0.0; 2]);
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

/// Gives a mesh its parts, and returns what they call their materials.
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

/// An sRGB colour with alpha as linear light.
fn linear([r, g, b, a]: [f64; 4]) -> Vec4 {
    let rgb: Vec3 = color::linear3([r, g, b].map(|v| v as f32));
    rgb.extend(a as f32)
}
