//! 3MF, the 3D Manufacturing Format: a ZIP archive of XML.
//!
//! Source: 3MF Consortium, *3D Manufacturing Format, Core Specification* 1.3, 2021; *Materials and
//! Properties Extension* (color groups), *Production Extension* (objects in other parts).
//!
//! Each object is one mesh, placed by the build items and their components; lengths become
//! millimetres through the matrices of the instances. Base materials and color groups become
//! materials where an object has one, and colors of corners where its triangles differ; of textures
//! and composites nothing is kept. z is up.
//!
//! Inflated parts count against `limits.decoded_bytes`, checked before and while they are read, so
//! that memory is about twice that at most, whatever the archive claims.

mod package;
mod part;

use crate::{Error, Limits, Model, Place, ReadOptions, Resources, Result, color, place};
use durer::math::{DMat4, DVec3, Vec4};
use durer::scene::{Instance, Material, Mesh, Part as MeshPart, UpAxis};
use package::Package;
use part::{Object, Part, Use};
use std::collections::HashMap;

/// Reads a 3MF file.
///
/// # Errors
/// [`Error::Decode`] for a broken archive, XML that is not well-formed, indices out of range, objects
/// that are missing or contain themselves; [`Error::Limit`] for too much of anything.
pub fn read(bytes: &[u8], _resources: &dyn Resources, options: &ReadOptions) -> Result<Model> {
    let mut package = Package::open(bytes, options.limits)?;
    let mut model = Model { format: "3MF".to_owned(), ..Model::default() };
    let root = package.root()?;
    let mut assembly = Assembly {
        model: &mut model,
        package: &mut package,
        limits: options.limits,
        parts: HashMap::new(),
        primitives: 0,
        visits: 0,
    };
    assembly.load(&root)?;
    assembly.build(&root)?;
    model.scene.up_axis = UpAxis::Z;
    if model.scene.instances.is_empty() {
        model.warn(Place::Whole, "the build has no items with a mesh");
    }
    model.scene.check()?;
    Ok(model)
}

/// Places objects.
struct Assembly<'a, 'b> {
    model: &'a mut Model,
    package: &'a mut Package<'b>,
    limits: Limits,
    /// Parts by name.
    parts: HashMap<String, Part>,
    primitives: u64,
    /// Components and items followed: bounds the work where nested components multiply.
    visits: u64,
}

impl Assembly<'_, '_> {
    /// Reads a part, once.
    fn load(&mut self, name: &str) -> Result<()> {
        if self.parts.contains_key(name) {
            return Ok(());
        }
        let xml = self.package.read(name)?;
        let left = self.limits.primitives.saturating_sub(self.primitives);
        let part = part::parse(name, &xml, left)?;
        self.primitives += part.triangles;
        if part.unknown_properties {
            let message = "textures and composite materials are not read; plain colors are";
            self.model.warn(Place::Path(name.to_owned()), message);
        }
        self.parts.insert(name.to_owned(), part);
        Ok(())
    }

    fn build(&mut self, root: &str) -> Result<()> {
        let Some(part) = self.parts.get(root) else { return Ok(()) };
        let scale = DMat4::from_scale(DVec3::splat(part.millimetres));
        for item in part.items.clone() {
            self.place(root, &item, scale, &mut Vec::new())?;
        }
        Ok(())
    }

    /// Places the object that `used` names in the part `from`, and its components.
    fn place(
        &mut self,
        from: &str,
        used: &Use,
        world_from_parent: DMat4,
        inside: &mut Vec<(String, u64)>,
    ) -> Result<()> {
        let part = used.path.as_deref().unwrap_or(from).to_owned();
        let id = used.object;
        let here = (part.clone(), id);
        let at = |message: String| Error::path(format!("{part}, object {id}"), message);
        if inside.contains(&here) {
            return Err(at("contains itself; components must not form a cycle".to_owned()));
        }
        self.visits += 1;
        for (what, value, limit) in [
            ("number of placed components", self.visits, self.limits.instances),
            ("depth of components", inside.len() as u64 + 1, u64::from(self.limits.depth)),
        ] {
            if value > limit {
                return Err(Error::Limit { place: Place::Path(part), what, value, limit });
            }
        }
        self.load(&part)?;
        let world_from_object = world_from_parent * used.transform;
        let Some(object) = self.parts.get_mut(&part).and_then(|p| p.objects.get_mut(&id)) else {
            return Err(at("does not exist, but an item or component names it".to_owned()));
        };
        let (name, components) = (object.name.clone(), object.components.clone());
        if let Some((mesh, origin)) = self.mesh(&part, id) {
            let world_from_mesh = world_from_object * place::matrix(origin);
            self.model.scene.instances.push(Instance { mesh, world_from_mesh, name });
        }
        inside.push(here);
        for component in &components {
            self.place(&part, component, world_from_object, inside)?;
        }
        inside.pop();
        Ok(())
    }

    /// The scene's number of an object's mesh, made at first use, and what its positions are
    /// relative to.
    fn mesh(&mut self, part: &str, id: u64) -> Option<(usize, DVec3)> {
        let part = self.parts.get_mut(part)?;
        let object = part.objects.get_mut(&id)?;
        if object.placed.is_none() && !object.triangles.is_empty() {
            let origin = place::origin(&object.vertices);
            let scene = &mut self.model.scene;
            let mesh = mesh(object, origin, &part.colors, &mut scene.materials);
            object.placed = Some((scene.meshes.len(), origin));
            scene.meshes.push(mesh);
        }
        object.placed
    }
}

/// Takes an object's geometry as a mesh.
fn mesh(
    object: &mut Object,
    origin: DVec3,
    colors: &HashMap<u64, Vec<Vec4>>,
    materials: &mut Vec<Material>,
) -> Mesh {
    let vertices = std::mem::take(&mut object.vertices);
    let triangles = std::mem::take(&mut object.triangles);
    let color = |group: u64, index: u64| colors.get(&group)?.get(index as usize).copied();
    let own = object.property.and_then(|(group, index)| color(group, index));
    let mut mesh = Mesh { name: object.name.clone(), ..Mesh::default() };
    let material = if object.properties.is_empty() {
        mesh.positions = place::narrow(&vertices, origin);
        mesh.indices = Some(triangles.into_iter().flatten().collect());
        own.map(|base_color| Material { base_color, ..Material::default() })
    } else {
        // Corners with different colors share no vertex.
        let grey = own.unwrap_or(Material::default().base_color);
        let corner = |&v: &u32| vertices.get(v as usize).map_or(DVec3::NAN, |p| *p - origin);
        mesh.positions = triangles.iter().flatten().map(|v| corner(v).as_vec3()).collect();
        mesh.colors = vec![grey; mesh.positions.len()];
        for &(triangle, group, corners) in &object.properties {
            let at = 3 * triangle as usize;
            let slots = mesh.colors.get_mut(at..at + 3).unwrap_or_default();
            for (slot, index) in slots.iter_mut().zip(corners) {
                *slot = color(group, index).unwrap_or(grey);
            }
        }
        Some(color::vertex_color_material())
    };
    if let Some(material) = material {
        let range = 0..mesh.primitive_count() as u32;
        let known = materials.iter().position(|m| *m == material);
        let number = known.unwrap_or(materials.len());
        if known.is_none() {
            materials.push(material);
        }
        mesh.parts.push(MeshPart { range, material: Some(number), name: String::new() });
    }
    mesh
}
