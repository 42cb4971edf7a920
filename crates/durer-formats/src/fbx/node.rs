//! Nodes with meshes, in their places.

use super::frame::Frames;
use super::material::Materials;
use super::mesh::{self, Faults};
use crate::budget::Budget;
use crate::piece::Piece;
use crate::text::Tally;
use crate::{Error, Limits, Model, Place, Result, color, place, polygon};
use durer::math::DVec3;
use durer::scene::Instance;
use std::collections::HashMap;
use ufbx::{ElementType, Material, Mesh, Node, Scene};

/// A mesh, and the materials that a node shows it in.
type Key = (u32, Vec<u32>);

/// Placement of the contents of nodes.
pub(super) struct Nodes<'s> {
    scene: &'s Scene,
    frames: &'s Frames,
    materials: Materials<'s>,
    budget: Budget,
    limits: Limits,
    faults: Faults,
    read: HashMap<u32, Vec<Piece>>,
    made: HashMap<Key, Vec<(usize, DVec3)>>,
    plain: Option<usize>,
    hidden: Tally,
    coarse: Tally,
}

impl<'s> Nodes<'s> {
    pub fn new(
        scene: &'s Scene,
        frames: &'s Frames,
        materials: Materials<'s>,
        limits: Limits,
    ) -> Self {
        let (read, made, faults) = Default::default();
        let (hidden, coarse) = Default::default();
        let budget = Budget::new(limits.clone());
        Self {
            scene,
            frames,
            materials,
            budget,
            limits,
            faults,
            read,
            made,
            plain: None,
            hidden,
            coarse,
        }
    }

    /// Places the meshes of all nodes.
    ///
    /// # Errors
    /// [`Error::Limit`].
    pub fn place(&mut self, model: &mut Model) -> Result<()> {
        let (value, limit) = (self.scene.nodes.count as u64, self.limits.instances);
        if value > limit {
            let what = "number of nodes";
            return Err(Error::Limit { place: Place::Whole, what, value, limit });
        }
        let mut shown = vec![true; self.scene.nodes.count];
        for (i, node) in self.scene.nodes.into_iter().enumerate() {
            let above = node.parent.as_deref();
            let above = above.and_then(|p| shown.get(p.element.typed_id as usize)).copied();
            let here = above.unwrap_or(true) && self.is_shown(node);
            if let Some(shown) = shown.get_mut(i) {
                *shown = here;
            }
            if let Some(mesh) = node.mesh.as_deref().filter(|_| here) {
                self.show(model, node, mesh)?;
            }
        }
        Ok(())
    }

    /// Returns whether a node, with everything below it, is neither hidden nor a coarser level of detail.
    fn is_shown(&mut self, node: &Node) -> bool {
        let here = || Place::Path(node.element.name.to_string());
        let is_coarse = node.parent.as_deref().is_some_and(|parent| {
            let first = parent.children.first().map(|c| c.element.typed_id);
            parent.attrib_type == ElementType::LodGroup && first != Some(node.element.typed_id)
        });
        if is_coarse {
            self.coarse.add(here);
        } else if !node.visible {
            self.hidden.add(here);
        }
        node.visible && !is_coarse
    }

    fn show(&mut self, model: &mut Model, node: &Node, mesh: &Mesh) -> Result<()> {
        let own = &node.materials;
        let materials = if own.is_empty() { &mesh.materials } else { own };
        let materials: Vec<&Material> = materials.into_iter().collect();
        let world = self.frames.geometry(node);
        for (mesh, origin) in self.meshes(model, mesh, &materials)? {
            let world_from_mesh = world * place::matrix(origin);
            let name = node.element.name.to_string();
            model.scene.instances.push(Instance { mesh, world_from_mesh, name });
        }
        Ok(())
    }

    /// Returns the scene's meshes of a mesh in these materials.
    fn meshes(
        &mut self,
        model: &mut Model,
        mesh: &Mesh,
        materials: &[&Material],
    ) -> Result<Vec<(usize, DVec3)>> {
        let number = mesh.element.typed_id;
        let key = (number, materials.iter().map(|m| m.element.typed_id).collect());
        if let Some(made) = self.made.get(&key) {
            return Ok(made.clone());
        }
        if !self.read.contains_key(&number) {
            let mut pieces = mesh::pieces(mesh, &mut self.budget, &mut self.faults)?;
            for piece in &mut pieces {
                polygon::recut(model, &mut piece.mesh, &self.limits)?;
            }
            self.read.insert(number, pieces);
        }
        let names: Vec<&str> = mesh.uv_sets.iter().map(|set| set.name.as_ref()).collect();
        let mut made = Vec::new();
        for mut piece in self.read.get(&number).cloned().unwrap_or_default() {
            let count = piece.mesh.primitive_count() as u64;
            self.budget.copied(count, || Place::Path(mesh::name(mesh)))?;
            for (part, symbol) in piece.mesh.parts.iter_mut().zip(&piece.symbols) {
                let material = symbol.parse().ok().and_then(|i: usize| materials.get(i));
                part.material = material.map(|m| self.materials.get(model, m, &names));
            }
            if !piece.mesh.colors.is_empty() {
                for part in piece.mesh.parts.iter_mut().filter(|p| p.material.is_none()) {
                    part.material = Some(self.plain(model));
                }
            }
            made.push((model.scene.meshes.len(), piece.origin));
            model.scene.meshes.push(piece.mesh);
        }
        self.made.insert(key, made.clone());
        Ok(made)
    }

    /// Returns the scene's number of a material that shows colours of vertices.
    fn plain(&mut self, model: &mut Model) -> usize {
        *self.plain.get_or_insert_with(|| {
            model.scene.materials.push(color::vertex_color_material());
            model.scene.materials.len() - 1
        })
    }

    /// Adds warnings about omissions.
    pub fn warn(&self, model: &mut Model) {
        self.materials.warn(model);
        for (tally, what) in [
            (
                &self.hidden,
                "{node is hidden; it and the nodes below it|nodes are hidden; they and the nodes below them} are left out",
            ),
            (
                &self.coarse,
                "{node is a coarser level of detail; it is|nodes are coarser levels of detail; they are} left out",
            ),
            (
                &self.faults.attributes,
                "{corner refers|corners refer} to a missing normal, color or texture coordinate; {it gets|they get} none",
            ),
            (
                &self.faults.holes,
                "{face is marked as a hole; it is|faces are marked as holes; they are} left out",
            ),
            (
                &self.faults.points,
                "{face has a single corner; it is|faces have a single corner; they are} left out",
            ),
        ] {
            model.warn_of(tally, what);
        }
    }
}
