//! Runs: the primitives of a scene in the order of their items.

use crate::scene::{AlphaMode, Scene, Topology};
use std::ops::Range;

/// Source of a surface's fragments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Coverage {
    /// Every fragment hides those behind it.
    Opaque,
    /// A fragment is there or not, by its alpha.
    Masked,
    /// Fragments are blended in the order of their depths.
    Blended,
}

/// A run of primitives of one instance that share a material; in scene order.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Run {
    /// Index into [`Scene::instances`].
    pub instance: usize,
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// Primitives of the mesh.
    pub range: Range<u32>,
    /// Index into [`Scene::materials`].
    pub material: Option<usize>,
    /// Item index of the first primitive.
    pub first_item: u32,
    /// Meaning of the material's alpha.
    pub coverage: Coverage,
    /// True if the material is meant to be seen from its front only.
    pub single_sided: bool,
}

/// Returns the runs of a scene in item order: triangles first, in scene order, then lines and
/// points, so that the item of a triangle does not depend on them.
///
/// # Errors
/// [`crate::Error::Limit`] if there are more than 2³² − 2 primitives.
pub fn runs(scene: &Scene) -> crate::Result<Vec<Run>> {
    let mut runs = Vec::new();
    let mut next_item: u64 = 0;
    for pass in [true, false] {
        for (index, instance) in scene.instances.iter().enumerate() {
            let mesh = &scene.meshes[instance.mesh];
            if (mesh.topology == Topology::Triangles) != pass {
                continue;
            }
            for (range, material) in mesh.material_runs() {
                if range.is_empty() {
                    continue;
                }
                let first = next_item;
                next_item += range.len() as u64;
                if next_item >= u64::from(u32::MAX) {
                    let (value, limit) = (next_item, u64::from(u32::MAX) - 1);
                    return Err(crate::Error::Limit { what: "number of items", value, limit });
                }
                runs.push(Run {
                    instance: index,
                    mesh: instance.mesh,
                    range,
                    material,
                    first_item: first as u32,
                    coverage: coverage(scene, material),
                    single_sided: material.is_some_and(|m| !scene.materials[m].double_sided),
                });
            }
        }
    }
    Ok(runs)
}

fn coverage(scene: &Scene, material: Option<usize>) -> Coverage {
    match material.map(|m| scene.materials[m].alpha_mode) {
        None | Some(AlphaMode::Opaque) => Coverage::Opaque,
        Some(AlphaMode::Mask { .. }) => Coverage::Masked,
        Some(AlphaMode::Blend) => Coverage::Blended,
    }
}
