//! Meshes: faces of any number of corners, to pieces.

use crate::budget::Budget;
use crate::piece::{Builder, Corner, NONE, Piece, SETS, Values};
use crate::text::Tally;
use crate::{Place, Result};
use durer::scene::Topology;
use std::collections::BTreeMap;
use ufbx::Mesh;

/// Memory that a corner takes, at most, while it is joined to vertices.
const CORNER: u64 = 100;

/// Omissions and repairs in meshes.
#[derive(Debug, Default)]
pub(super) struct Faults {
    pub attributes: Tally,
    pub holes: Tally,
    pub points: Tally,
}

/// Attributes that the indices of corners refer to.
struct Attributes<'m>(&'m Mesh);

impl Values for Attributes<'_> {
    fn has(&self, slot: usize) -> bool {
        match slot {
            0 => true,
            1 => self.0.vertex_normal.exists,
            2 => self.0.vertex_color.exists,
            _ => self.0.uv_sets.get(slot - 3).is_some_and(|set| set.vertex_uv.exists),
        }
    }

    fn get(&self, slot: usize, index: u32, _fill: f64) -> Option<[f64; 4]> {
        let at = index as usize;
        let finite = |v: [f64; 4]| v.map(|v| if v.is_finite() { v } else { 0.0 });
        Some(finite(match slot {
            0 => self.0.vertex_position.values.get(at).map(|v| [v.x, v.y, v.z, 0.0])?,
            1 => self.0.vertex_normal.values.get(at).map(|v| [v.x, v.y, v.z, 0.0])?,
            2 => self.0.vertex_color.values.get(at).map(|v| [v.x, v.y, v.z, v.w])?,
            _ => {
                let set = self.0.uv_sets.get(slot - 3)?;
                set.vertex_uv.values.get(at).map(|v| [v.x, v.y, 0.0, 0.0])?
            }
        }))
    }
}

impl Attributes<'_> {
    /// Returns the indices of a corner, and whether all of them refer to existing values.
    fn corner(&self, index: usize) -> (Corner, bool) {
        let mesh = self.0;
        let mut corner = [NONE; 3 + SETS];
        let mut whole = true;
        let lists = [
            &mesh.vertex_position.indices,
            &mesh.vertex_normal.indices,
            &mesh.vertex_color.indices,
        ];
        let sets = mesh.uv_sets.iter().map(|set| &set.vertex_uv.indices);
        let slots = corner.iter_mut().zip(lists.into_iter().chain(sets));
        for (slot, (corner, list)) in slots.enumerate() {
            let Some(&at) = list.get(index) else { continue };
            let there = self.get(slot, at, 0.0).is_some();
            *corner = if there { at } else { NONE };
            whole &= there;
        }
        (corner, whole)
    }
}

/// Reads a mesh: a piece of triangles and one of lines, whose parts are called by the numbers of
/// their materials.
///
/// # Errors
/// [`crate::Error::Limit`].
pub(super) fn pieces(mesh: &Mesh, budget: &mut Budget, faults: &mut Faults) -> Result<Vec<Piece>> {
    let place = || Place::Path(name(mesh));
    budget.bytes(CORNER.saturating_mul(mesh.num_indices as u64), place)?;
    let values = Attributes(mesh);
    let sets: Vec<u64> = (0..mesh.uv_sets.len().min(SETS) as u64).collect();
    let mut builders =
        [Topology::Triangles, Topology::Lines].map(|t| Builder::new(t, sets.clone()));
    let mut vertices = Vec::new();
    for (material, faces) in by_material(mesh, faults) {
        builders.iter_mut().for_each(|b| b.begin(&material.to_string()));
        for face in faces.iter().filter_map(|&f| mesh.faces.get(f)) {
            let first = face.index_begin as usize;
            vertices.clear();
            let builder = usize::from(face.num_indices < 3);
            for at in first..first + face.num_indices as usize {
                let (corner, whole) = values.corner(at);
                if !whole {
                    faults.attributes.add(place);
                }
                vertices.push(builders[builder].vertex(corner));
            }
            budget.primitives((vertices.len() as u64).saturating_sub(2).max(1), place)?;
            match vertices[..] {
                [] | [_] => faults.points.add(place),
                [a, b] => builders[1].line([a, b]),
                _ => builders[0].polygon(&vertices),
            }
        }
    }
    let called = name(mesh);
    Ok(builders.into_iter().filter_map(|b| b.piece(&values, &called)).collect())
}

/// Returns the faces that are not holes, by their materials.
fn by_material(mesh: &Mesh, faults: &mut Faults) -> BTreeMap<u32, Vec<usize>> {
    let mut all: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for face in 0..mesh.faces.len() {
        if mesh.face_hole.get(face) == Some(&true) {
            faults.holes.add(|| Place::Path(name(mesh)));
            continue;
        }
        let material = mesh.face_material.get(face).copied().unwrap_or(0);
        all.entry(material).or_default().push(face);
    }
    all
}

/// Returns the name of a mesh: its own, or the first node's that shows it.
pub(super) fn name(mesh: &Mesh) -> String {
    let node = mesh.element.instances.first().map_or("", |node| node.element.name.as_ref());
    let own: &str = mesh.element.name.as_ref();
    if own.is_empty() { node.to_owned() } else { own.to_owned() }
}
