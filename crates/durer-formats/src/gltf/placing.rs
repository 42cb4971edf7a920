//! The placement of a node's mesh.

use super::buffer::Source;
use super::{deform, instancing};
use crate::{Model, Place, Result};
use durer::math::DMat4;
use durer::scene::Instance;

/// Placement and pose of a node's mesh.
pub struct Placing {
    node: usize,
    /// Weights of morph targets.
    pub weights: Vec<f32>,
    /// The matrices of the skin, if there is one.
    pub joints: Option<Vec<DMat4>>,
    /// Matrices to the world: one, or the ones of EXT_mesh_gpu_instancing.
    pub places: Vec<DMat4>,
}

impl Placing {
    /// Computes the placement of node `n`, whose morph targets have these weights.
    ///
    /// # Errors
    /// If the skin or the instances are broken, or their data are missing.
    pub fn of(
        source: &Source<'_>,
        world: &[DMat4],
        weights: Vec<f32>,
        n: usize,
        model: &mut Model,
    ) -> Result<Self> {
        let node = &source.root.nodes[n];
        let joints = node.skin.map(|skin| deform::joint_matrices(source, skin, world));
        let joints = joints.transpose()?;
        let mut places = vec![world[n]];
        if let Some(instancing) = &node.extensions.instancing {
            if joints.is_none() {
                places = instancing::matrices(source, instancing, n)?;
                places.iter_mut().for_each(|place| *place = world[n] * *place);
            } else {
                let place = Place::Path(format!("nodes[{n}]"));
                model.warn(place, "a skinned mesh cannot be instanced; drawn once");
            }
        }
        Ok(Self { node: n, weights, joints, places })
    }

    /// Adds the instances of a primitive.
    pub fn add(&self, mesh: usize, skinned: bool, name: &str, model: &mut Model) {
        // Skins bring vertices to the world themselves; their node's place means nothing.
        let places = if skinned { &[DMat4::IDENTITY][..] } else { &self.places };
        let finite = places.iter().filter(|place| place.is_finite());
        model.scene.instances.extend(finite.map(|&world_from_mesh| Instance {
            mesh,
            world_from_mesh,
            name: name.to_owned(),
        }));
        let lost = places.iter().filter(|place| !place.is_finite()).count();
        if lost > 0 {
            let message = match self.places.len() {
                1 => "its place in the world is not finite; left out".to_owned(),
                all => {
                    let are = if lost == 1 { "is" } else { "are" };
                    format!("{lost} of its {all} places {are} not finite; left out")
                }
            };
            model.warn(Place::Path(format!("nodes[{}]", self.node)), message);
        }
    }
}
