//! The materials of a scene.

use super::PreparedMaterial;
use crate::math::Vec3;
use crate::scene::{Material, MipFilter, Scene, ShadingModel, Texture};
use crate::shade::slot::Chains;
use std::collections::BTreeSet;

/// All materials of a scene, ready for shading. Borrows the scene's images.
#[derive(Debug, Clone)]
pub struct PreparedMaterials<'a> {
    materials: Vec<PreparedMaterial<'a>>,
    default: PreparedMaterial<'a>,
    /// Material for lines and points without a material.
    ink: PreparedMaterial<'a>,
}

impl<'a> PreparedMaterials<'a> {
    /// Name of the stage that makes materials ready, in errors.
    pub(crate) const STAGE: &'static str = "materials";

    /// Returns the bytes that the materials of a scene take, about: their own, and the smaller sizes of their images, a
    /// third each. An image that is read in two ways is counted once.
    pub(crate) fn bytes(scene: &Scene) -> u64 {
        let has_levels = |t: &&Texture| t.sampler.mip != MipFilter::None;
        let filtered: BTreeSet<usize> =
            scene.textures.iter().filter(has_levels).map(|t| t.image).collect();
        let images = filtered.iter().filter_map(|i| scene.images.get(*i));
        let texels: u64 = images.map(|image| size_of_val(&image.data[..]) as u64).sum();
        (scene.materials.len() * size_of::<PreparedMaterial<'_>>()) as u64 + texels / 3
    }

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

    /// Returns the materials with which lines and points that have no material are drawn in a linear colour, unlit.
    #[must_use]
    pub(crate) fn with_ink(mut self, color: Vec3) -> Self {
        self.ink.model = ShadingModel::Unlit;
        self.ink.base_color = color.extend(1.0);
        self
    }

    /// Returns the material of lines or points: as [`Self::get`], but the ink for `None`.
    #[inline]
    pub(crate) fn of_marks(&self, index: Option<usize>) -> &PreparedMaterial<'a> {
        index.map_or(&self.ink, |_| self.get(index))
    }

    /// Returns the material with an index; for `None`, or if there is no such material, the default material.
    #[inline]
    pub fn get(&self, index: Option<usize>) -> &PreparedMaterial<'a> {
        index.and_then(|i| self.materials.get(i)).unwrap_or(&self.default)
    }
}
