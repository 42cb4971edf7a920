//! A file as a whole.

use super::eye;
use super::frame::{Frames, World};
use super::material::Materials;
use super::node::Nodes;
use super::picture::Pictures;
use crate::{Error, Limits, Model, Place, ReadOptions, Resources, Result};
use ufbx::{AllocatorOpts, ErrorType, IndexErrorHandling, LoadOpts, Scene, SceneRoot, WarningType};

/// Reads an FBX file.
///
/// # Errors
/// [`Error::Decode`] if it is broken, [`Error::Limit`] for data above a limit. Warnings name missing and omitted
/// parts.
pub fn read(bytes: &[u8], resources: &dyn Resources, options: &ReadOptions) -> Result<Model> {
    let limits = options.limits.clone();
    let scene = load(bytes, &limits)?;
    let mut model = Model { format: format(&scene), ..Model::default() };
    if scene.metadata.ascii && ends_inside(bytes) {
        model.warn(Place::Whole, "the file ends before its last `}`; what follows is missing");
    }
    repairs(&scene, &mut model);
    let world = World::of(&scene, &mut model);
    model.scene.up_axis = world.up_axis;
    let frames = Frames::of(&scene, world.matrix);
    let pictures = Pictures::new(&scene, resources);
    let materials = Materials::new(&scene, &pictures, limits.clone());
    let mut nodes = Nodes::new(&scene, &frames, materials, limits);
    nodes.place(&mut model)?;
    nodes.warn(&mut model);
    eye::add(&mut model, &scene, &frames, world.unit, options.own_lights);
    left_out(&scene, &frames, &mut model);
    if model.scene.instances.is_empty() {
        model.warn(Place::Whole, "the scene has no nodes with a mesh");
    }
    model.scene.check()?;
    Ok(model)
}

/// Reads the scene with the library, from memory only.
fn load(bytes: &[u8], limits: &Limits) -> Result<SceneRoot> {
    let memory = usize::try_from(limits.memory()).unwrap_or(usize::MAX);
    let allocator = || AllocatorOpts {
        allocator: ufbx::Allocator::Libc,
        memory_limit: memory,
        ..AllocatorOpts::default()
    };
    let options = LoadOpts {
        temp_allocator: allocator(),
        result_allocator: allocator(),
        ignore_animation: true,
        ignore_missing_external_files: true,
        use_blender_pbr_material: true,
        index_error_handling: IndexErrorHandling::NoIndex,
        node_depth_limit: limits.depth,
        file_format: ufbx::FileFormat::Fbx,
        ..LoadOpts::default()
    };
    ufbx::load_memory(bytes, options).map_err(|e| error(&e, limits))
}

fn error(e: &ufbx::Error, limits: &Limits) -> Error {
    let limit = |what, limit| Error::Limit { place: Place::Whole, what, value: limit + 1, limit };
    match e.type_ {
        ErrorType::MemoryLimit | ErrorType::OutOfMemory => {
            limit("memory for elements", limits.memory())
        }
        ErrorType::NodeDepthLimit => limit("depth of nodes", u64::from(limits.depth)),
        kind => Error::whole(format!("the FBX file cannot be read: {}", what_is_wrong(kind))),
    }
}

/// Describes the fault of a file, because the library's messages describe its internals.
fn what_is_wrong(kind: ErrorType) -> &'static str {
    match kind {
        ErrorType::EmptyFile => "it is empty",
        ErrorType::TruncatedFile | ErrorType::Io => "it is cut off",
        ErrorType::UnrecognizedFileFormat => "it begins like no FBX file",
        ErrorType::UnsupportedVersion => "its version is not read; save it as FBX 7.4 or later",
        ErrorType::InvalidUtf8 => "a name is not in UTF-8",
        ErrorType::BadNurbs => "a NURBS curve or surface is broken",
        _ => "an element is broken, or has an index beyond its list",
    }
}

fn format(scene: &Scene) -> String {
    let (version, kind) = (scene.metadata.version, scene.metadata.ascii);
    let kind = if kind { "ASCII" } else { "binary" };
    format!("FBX {}.{} {kind}", version / 1000, version % 1000 / 100)
}

/// Returns whether text ends where braces are open, which the library takes as their end.
fn ends_inside(text: &[u8]) -> bool {
    let (mut depth, mut quoted, mut comment) = (0u64, false, false);
    for byte in text {
        match byte {
            b'\n' => comment = false,
            _ if comment => {}
            b'"' => quoted = !quoted,
            _ if quoted => {}
            b';' => comment = true,
            b'{' => depth += 1,
            b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    depth > 0
}

/// Adds warnings about the library's repairs.
fn repairs(scene: &Scene, model: &mut Model) {
    for warning in &scene.metadata.warnings {
        if let Some(what) = what_is_repaired(warning.type_) {
            let count = warning.count;
            let times = if count > 1 { format!(" ({count} times)") } else { String::new() };
            model.warn(Place::Whole, format!("{what}{times}"));
        }
    }
}

/// Describes a repair by the library, whose messages describe its internals; `None` if nothing is lost, or for files
/// that this reader does not take.
fn what_is_repaired(kind: WarningType) -> Option<&'static str> {
    Some(match kind {
        WarningType::DuplicateConnection
        | WarningType::MissingExternalFile
        | WarningType::ImplicitMtl => return None,
        WarningType::TruncatedArray => "a list is shorter than it says; the rest of it is zeros",
        WarningType::MissingGeometryData => "a mesh lacks vertices or faces; it is empty",
        WarningType::IndexClamped => "an index is beyond its list; it is left out",
        WarningType::BadUnicode => "a name is not in UTF-8; what is not is replaced",
        WarningType::BadElementConnectedToRoot => {
            "an object without a place is a child of the scene itself; it is left out"
        }
        WarningType::DuplicateObjectId => "two objects have one number; links lead to one of them",
        WarningType::EmptyFaceRemoved => "a face has no corners; it is left out",
        _ => "something is broken, and left out",
    })
}

/// Warns of kinds of elements that are not read.
fn left_out(scene: &Scene, frames: &Frames, model: &mut Model) {
    let levels = scene.meshes.into_iter().filter(|m| m.subdivision_preview_levels > 0).count();
    let blends = scene.blend_channels.count;
    for (count, what) in [
        (
            scene.skin_deformers.count,
            "{skin is not bent by its bones; its mesh is|skins are not bent by their bones; their meshes are} shown at rest",
        ),
        (blends, "{blend shape is|blend shapes are} not read; meshes have their basic shape"),
        (
            levels,
            "{mesh is meant to be subdivided; its control mesh is|meshes are meant to be subdivided; their control meshes are} shown",
        ),
        (scene.cache_deformers.count, "{mesh moves|meshes move} by a cache, which is not read"),
        (scene.nurbs_surfaces.count, "NURBS {surface is|surfaces are} not read"),
        (scene.nurbs_curves.count + scene.line_curves.count, "{curve is|curves are} not read"),
        (scene.procedural_geometries.count, "procedural {geometry is|geometries are} not read"),
        (
            frames.broken,
            "{transform has|transforms have} numbers that are not finite, which are ignored",
        ),
    ] {
        model.warn_counted(Place::Whole, count as u64, what);
    }
    let words =
        "{curve of an animation is|curves of animations are} not read; the model is shown at rest";
    model.warn_counted(Place::Whole, scene.anim_curves.count as u64, words);
}
