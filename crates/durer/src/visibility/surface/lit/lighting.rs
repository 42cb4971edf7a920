//! The data that all lit points share: of a picture, and of the items of a run.

use super::TEX_COORD_SETS;
use crate::math::{DMat3, Vec2, Vec3};
use crate::scene::{Mesh, Scene, Topology};
use crate::shade::{PreparedLights, PreparedMaterial, PreparedMaterials, Shading};
use crate::simd::Level;
use crate::view::View;
use crate::visibility::surface::points::triangles::Needs;
use crate::visibility::surface::setup::Run;

/// Data that all threads share.
#[derive(Clone, Copy)]
pub struct Lighting<'a> {
    pub scene: &'a Scene,
    pub view: &'a View,
    pub runs: &'a [Run],
    pub materials: &'a PreparedMaterials<'a>,
    pub lights: &'a PreparedLights,
    pub shading: Option<Shading>,
    /// Largest distance from pixels' centres of items that are then lit there, in 1/256 pixel.
    pub reach: i32,
    /// SIMD level; all levels produce the same bytes.
    pub level: Level,
}

impl<'a> Lighting<'a> {
    /// Creates lighting by the formula of each material, for tests.
    #[cfg(test)]
    pub fn by_material(
        (scene, view, runs): (&'a Scene, &'a View, &'a [Run]),
        (materials, lights): (&'a PreparedMaterials<'a>, &'a PreparedLights),
        reach: i32,
        level: Level,
    ) -> Self {
        Self { scene, view, runs, materials, lights, shading: None, reach, level }
    }

    /// Returns the data of their triangles that lighting several pixels of plain materials needs.
    pub fn needs(&self) -> Needs {
        // Lights need the positions of points, and shadows the orientation of their faces.
        let more = !self.lights.shadows.is_empty() || !self.lights.points.is_empty();
        if more { Needs::All } else { Needs::Normals }
    }

    /// Returns whether only normals are needed from triangles of a run, if these are settled.
    pub fn asks_for_normals(&self, run: usize) -> bool {
        self.needs() == Needs::Normals && self.run_info(run).is_plain()
    }

    pub fn run_info(&self, index: usize) -> RunInfo<'a> {
        let run = &self.runs[index];
        let mesh = &self.scene.meshes[run.mesh];
        let is_marks = mesh.topology != Topology::Triangles;
        let material = if is_marks && mesh.colors.is_empty() {
            self.materials.of_marks(run.material)
        } else {
            self.materials.get(run.material)
        };
        let without_sides = is_marks && mesh.normals.is_empty();
        let shading = match self.shading {
            _ if without_sides => Shading::Unlit,
            Some(shading) => shading,
            None => material.shading(),
        };
        let per_pixel = !matches!(shading, Shading::Flat | Shading::Gouraud);
        let coords = material
            .looked_up_together(shading)
            .filter(|set| mesh.colors.is_empty() && *set < TEX_COORD_SETS)
            .and_then(|set| mesh.tex_coords.get(set));
        let way = if material.is_plain() && mesh.colors.is_empty() && per_pixel {
            Way::Plain
        } else if let Some(coords) = coords {
            Way::LookedUp(LookedUp { coords, changing: material.has_levels() })
        } else if material.is_lit_together(shading) {
            Way::Sampled
        } else {
            Way::Alone
        };
        let (first_item, count) = (run.first_item, run.range.len() as u32);
        RunInfo { run: index, first_item, count, mesh, material, shading, way }
    }

    /// Returns a direction of a run's mesh along world axes.
    pub fn world_axes(&self, run: usize, direction: Vec3) -> Vec3 {
        let world_from_mesh = self.scene.instances[self.runs[run].instance].world_from_mesh;
        DMat3::from_mat4(world_from_mesh).as_mat3() * direction
    }
}

/// Properties that all items of a run share.
#[derive(Clone, Copy)]
pub struct RunInfo<'a> {
    pub run: usize,
    pub first_item: u32,
    pub count: u32,
    pub mesh: &'a Mesh,
    pub material: &'a PreparedMaterial<'a>,
    pub shading: Shading,
    pub way: Way<'a>,
}

/// The way in which the points of a run are lit.
#[derive(Clone, Copy)]
pub enum Way<'a> {
    /// Sixteen at a time, by constants: the material has no textures, and the mesh no colours.
    Plain,
    /// Sixteen at a time, as are the look-ups of textures.
    LookedUp(LookedUp<'a>),
    /// Eight at a time, after their textures were looked up one by one.
    Sampled,
    /// One by one.
    Alone,
}

impl RunInfo<'_> {
    /// Returns whether points need nothing but normals, positions, and directions to the eye.
    #[inline(always)]
    pub fn is_plain(&self) -> bool {
        matches!(self.way, Way::Plain)
    }

    /// Returns whether an item is of the run.
    #[inline(always)]
    pub fn has(&self, item: u32) -> bool {
        item.wrapping_sub(self.first_item) < self.count
    }
}

/// The one set of texture coordinates that a run's material uses.
#[derive(Clone, Copy)]
pub struct LookedUp<'a> {
    /// Coordinates of the mesh's vertices.
    pub coords: &'a [Vec2],
    /// True if it matters how they change over the screen.
    pub changing: bool,
}
