//! 3MF, the 3D Manufacturing Format: a ZIP archive of XML.
//!
//! Source: 3MF Consortium, *3D Manufacturing Format, Core Specification* 1.3, 2021; *Materials and
//! Properties Extension* 1.2.1, *Production Extension* (objects in other parts), *Beam Lattice
//! Extension* 1.2.0.
//!
//! Each object is one mesh, placed by the build items and their components; lengths become millimetres through the
//! matrices of the instances. Meshes of uniform appearance share vertices; where triangles differ in colour or texture,
//! each has its own, and triangles of one material are consecutive. Beams become a separate mesh. z is up.
//!
//! Of slicers' projects (Bambu Studio, OrcaSlicer, PrusaSlicer) paint, colours of filaments, and
//! plates are read; modifiers, holes and places for supports are left out.
//!
//! Inflated parts count against `limits.decoded_bytes`, checked before and while they are read, so that memory is at
//! most about twice that, whatever the archive claims.

mod assembly;
mod extension;
mod lattice;
mod mesh;
mod package;
mod paint;
mod part;
mod property;
mod resource;
mod settings;

use crate::{Model, Place, ReadOptions, Resources, Result};
use assembly::Assembly;
use durer::scene::UpAxis;
use package::Package;

/// Reads a 3MF file.
///
/// # Errors
/// [`crate::Error::Decode`] for a broken archive, XML that is not well-formed, objects that are
/// missing or contain themselves, a missing plate; [`crate::Error::Unsupported`] if a
/// part requires an extension that is not read; [`crate::Error::Limit`] for data above a limit.
pub fn read(bytes: &[u8], _resources: &dyn Resources, options: &ReadOptions) -> Result<Model> {
    let mut package = Package::open(bytes, &options.limits)?;
    let mut model = Model { format: "3MF".to_owned(), ..Model::default() };
    let root = package.root()?;
    let mut assembly = Assembly::new(&mut model, &mut package, options.limits.clone());
    assembly.build(&root, options.plate)?;
    let plates = assembly.settings.plates;
    model.plates = plates.into_iter().map(|plate| plate.name).collect();
    model.scene.up_axis = UpAxis::Z;
    if model.scene.instances.is_empty() {
        model.warn(Place::Whole, "the build has no items with triangles or beams");
    }
    model.scene.check()?;
    Ok(model)
}
