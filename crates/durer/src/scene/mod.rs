//! The contents of a model file: meshes placed in a right-handed world, with materials, lights,
//! cameras.

mod bounds;
mod camera;
pub(crate) mod height_field;
mod light;
mod material;
mod mesh;
mod smooth;
mod texture;

pub use bounds::{Aabb, BoundingSphere};
pub use camera::{Camera, NamedCamera, Projection};
pub use height_field::{Diagonal, HeightField};
pub use light::{Light, LightKind};
pub use material::{AlphaMode, Material, ShadingModel, TextureRef};
pub use mesh::{Mesh, Part, Topology};
pub use texture::{Image, MipFilter, Sampler, Texture, TextureFilter, Wrap};

use crate::math::{DMat4, DVec3};
use crate::{Error, Result};

/// Axis of the file that points up in the model's own world.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum UpAxis {
    /// y up: glTF, most OBJ and PLY files.
    #[default]
    Y,
    /// z up: most STL and 3MF files.
    Z,
    /// x up.
    X,
    /// −y up: y up, turned half around the axis to the front, as in pictures whose rows count downwards.
    NegY,
    /// −z up: z up, turned half around the axis to the front, as in maps of depths.
    NegZ,
    /// −x up.
    NegX,
}

impl UpAxis {
    /// All axes.
    pub const ALL: &'static [Self] =
        &[Self::Y, Self::Z, Self::X, Self::NegY, Self::NegZ, Self::NegX];

    /// Returns the axis with its sign, as options and reports write it, e.g. `-y`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Y => "y",
            Self::Z => "z",
            Self::X => "x",
            Self::NegY => "-y",
            Self::NegZ => "-z",
            Self::NegX => "-x",
        }
    }

    /// Returns the unit vector that points up.
    pub const fn up(self) -> DVec3 {
        match self {
            Self::Y => DVec3::Y,
            Self::Z => DVec3::Z,
            Self::X => DVec3::X,
            Self::NegY => DVec3::NEG_Y,
            Self::NegZ => DVec3::NEG_Z,
            Self::NegX => DVec3::NEG_X,
        }
    }

    /// Returns the unit vector from the model towards its front. Turning the world around it by quarters takes y, x,
    /// −y and −x up into each other; by half, z and −z.
    pub const fn front(self) -> DVec3 {
        match self {
            Self::Y | Self::X | Self::NegY | Self::NegX => DVec3::Z,
            Self::Z | Self::NegZ => DVec3::NEG_Y,
        }
    }

    /// Returns the unit vector to the right as seen from the front: up × front.
    pub const fn right(self) -> DVec3 {
        match self {
            Self::Y | Self::Z => DVec3::X,
            Self::X => DVec3::NEG_Y,
            Self::NegY | Self::NegZ => DVec3::NEG_X,
            Self::NegX => DVec3::Y,
        }
    }
}

/// A mesh placed in the world.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Instance {
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// Matrix from the mesh's coordinates to the world's. Affine; may mirror.
    pub world_from_mesh: DMat4,
    /// The name of the node or object, empty if the file has none.
    pub name: String,
}

impl Instance {
    /// Creates an instance of a mesh in its own coordinates, without a name.
    pub const fn of(mesh: usize) -> Self {
        Self { mesh, world_from_mesh: DMat4::IDENTITY, name: String::new() }
    }
}

impl From<Mesh> for Scene {
    /// Creates a scene that shows one mesh in its own coordinates.
    fn from(mesh: Mesh) -> Self {
        Self { meshes: vec![mesh], instances: vec![Instance::of(0)], ..Self::default() }
    }
}

/// Everything that can be drawn, posed at one moment. Instances are drawn in their order.
///
/// The item index of a triangle is its place in the sequence of all triangles of all instances.
#[derive(Debug, Clone, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Scene {
    /// Shared geometry.
    pub meshes: Vec<Mesh>,
    /// Meshes in their places; item order.
    pub instances: Vec<Instance>,
    /// For each instance the number of the object it belongs to, if the file distinguishes unrelated objects; instances
    /// beyond the end of the list belong to tree 0. Coincident borders within one tree are joined
    /// ([`crate::visibility::object::Weld`]).
    pub trees: Vec<u32>,
    /// Value of a unit in the last digit of the meshes' coordinates in the file, in their units: 0.001 for three
    /// decimals. 0 if the file is not text, or if it is not known.
    pub last_digit: f64,
    /// Materials of the meshes' parts.
    pub materials: Vec<Material>,
    /// Images with samplers.
    pub textures: Vec<Texture>,
    /// Decoded images, shared by textures.
    pub images: Vec<Image>,
    /// The file's own lights, in world space; empty if it has none.
    pub lights: Vec<Light>,
    /// The file's own cameras, in world space.
    pub cameras: Vec<NamedCamera>,
    /// Axis that points up.
    pub up_axis: UpAxis,
}

impl Scene {
    /// Returns the number of triangles over all instances: one more than the largest item index.
    pub fn triangle_count(&self) -> u64 {
        let of = |i: &Instance| self.meshes.get(i.mesh).map_or(0, |m| m.triangle_count() as u64);
        self.instances.iter().map(of).sum()
    }

    /// Returns the bytes of the scene, about, and of its copies.
    pub fn bytes(&self) -> u64 {
        let meshes: u64 = self.meshes.iter().map(|m| m.bytes() + size_of::<Mesh>() as u64).sum();
        let images: u64 = self.images.iter().map(|i| size_of_val(&i.data[..]) as u64).sum();
        let lists = size_of_val(&self.instances[..]) + size_of_val(&self.materials[..]);
        meshes + images + lists as u64
    }

    /// Returns the bytes that its meshes would take if each instance had its own copy, as in sections.
    pub fn bytes_of_instances(&self) -> u64 {
        let of = |i: &Instance| self.meshes.get(i.mesh).map_or(0, Mesh::bytes);
        self.instances.iter().map(of).fold(0, u64::saturating_add)
    }

    /// Returns the box around all finite vertices that some instance uses, in world space.
    pub fn bounds(&self) -> Option<Aabb> {
        let mut bounds: Option<Aabb> = None;
        for instance in &self.instances {
            let Some(mesh) = self.meshes.get(instance.mesh) else { continue };
            let points = mesh
                .positions
                .iter()
                .map(|p| instance.world_from_mesh.transform_point3(p.as_dvec3()));
            if let Some(b) = Aabb::around(points) {
                bounds = Some(bounds.map_or(b, |a| a.union(&b)));
            }
        }
        bounds
    }

    /// Returns a sphere around all finite vertices in world space, centred on the box's centre:
    /// tighter than the box's own sphere, and found in one more pass.
    pub fn bounding_sphere(&self) -> Option<BoundingSphere> {
        let center: DVec3 = self.bounds()?.center();
        let mut radius2: f64 = 0.0;
        for instance in &self.instances {
            let Some(mesh) = self.meshes.get(instance.mesh) else { continue };
            for p in &mesh.positions {
                let d = instance.world_from_mesh.transform_point3(p.as_dvec3()) - center;
                if d.is_finite() {
                    radius2 = radius2.max(d.length_squared());
                }
            }
        }
        Some(BoundingSphere { center, radius: radius2.sqrt() })
    }

    /// Assigns a material to all parts that have none.
    pub fn give_material(&mut self, material: Material) {
        let number = self.materials.len();
        for mesh in &mut self.meshes {
            if mesh.parts.is_empty() {
                let range = 0..mesh.primitive_count() as u32;
                mesh.parts.push(Part { range, material: None, name: String::new() });
            }
            for part in &mut mesh.parts {
                part.material.get_or_insert(number);
            }
        }
        self.materials.push(material);
    }

    /// Checks that every index refers to something that exists.
    ///
    /// # Errors
    /// [`Error::Dangling`] or [`Error::Parameter`] for the first fault.
    pub fn check(&self) -> Result<()> {
        let exists = |what, index: usize, count: usize| {
            if index < count { Ok(()) } else { Err(Error::Dangling { what, index, count }) }
        };
        for instance in &self.instances {
            exists("mesh", instance.mesh, self.meshes.len())?;
        }
        for mesh in &self.meshes {
            mesh.check()?;
            for material in mesh.parts.iter().filter_map(|p| p.material) {
                exists("material", material, self.materials.len())?;
            }
        }
        for texture in self.materials.iter().flat_map(Material::textures) {
            exists("texture", texture.texture, self.textures.len())?;
        }
        for texture in &self.textures {
            exists("image", texture.image, self.images.len())?;
        }
        Ok(())
    }
}
