//! The materials of a scene.

use super::PreparedMaterial;
use crate::math::Vec3;
use crate::scene::{Material, Scene, ShadingModel};
use crate::shade::slot::Chains;

/// All materials of a scene, ready for shading. Borrows the scene's images.
#[derive(Debug, Clone)]
pub struct PreparedMaterials<'a> {
    materials: Vec<PreparedMaterial<'a>>,
    default: PreparedMaterial<'a>,
    /// For lines and points without a material.
    ink: PreparedMaterial<'a>,
}

impl<'a> PreparedMaterials<'a> {
    /// Filters the mip chains that the scene's materials use, each once.
    ///
    /// Cost: O(texels) time, a third of the images in memory.
    pub fn new(scene: &'a Scene) -> Self {
        let mut chains = Chains::new(scene);
        let mut prepare = |m: &Material| PreparedMaterial::new(m, &mut chains);
        let materials = scene.materials.iter().map(&mut prepare).collect();
        let default = prepare(&Material::default());
        let ink = default.clone();
        Self { materials, default, ink }
    }

    /// Creates the same where lines and points that have no material are drawn in a linear colour,
    /// unlit.
    #[must_use]
    pub(crate) fn with_ink(mut self, color: Vec3) -> Self {
        self.ink.model = ShadingModel::Unlit;
        self.ink.base_color = color.extend(1.0);
        self
    }

    /// Returns the material of lines or points: as [`Self::get`], but for `None` the ink.
    #[inline]
    pub(crate) fn of_marks(&self, index: Option<usize>) -> &PreparedMaterial<'a> {
        index.map_or(&self.ink, |_| self.get(index))
    }

    /// Returns the material of this index; for `None`, or if there is none, the default material.
    #[inline]
    pub fn get(&self, index: Option<usize>) -> &PreparedMaterial<'a> {
        index.and_then(|i| self.materials.get(i)).unwrap_or(&self.default)
    }
}
