//! A model from a file or from standard input.

mod in_pieces;

pub use in_pieces::{InPieces, in_pieces};

use crate::failure::{Failure, in_words};
use crate::options::ReadingArgs;
use crate::places::is_stream;
use crate::resources::Folder;
use crate::watch;
use durer::work::Work;
use durer_formats::wording::shown_path;
use durer_formats::{
    Limits, Model, NoResources, Place, Pose, ReadOptions, Resources, gltf, read_model, stl,
};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Returns the name of an input in messages.
pub fn display_name(path: &Path) -> String {
    if is_stream(path) { "standard input".to_owned() } else { shown_path(path) }
}

/// Returns the name of an input in reports: the path as given, unescaped.
pub fn given_name(path: &Path) -> String {
    if is_stream(path) { display_name(path) } else { path.display().to_string() }
}

/// Largest coordinate whose square is a finite number of double precision.
const FARTHEST: f64 = 1e150;

/// Returns a failure with the file's name if it is caused by a model too far away for any view.
pub fn blamed(name: &str, scene: &durer::scene::Scene, failure: Failure) -> Failure {
    let farthest = || scene.bounds().map(|b| b.min.abs().max(b.max.abs()).max_element());
    let too_far = || farthest().is_some_and(|farthest| farthest.is_nan() || farthest > FARTHEST);
    match failure {
        Failure::Usage(_) | Failure::Data(_) if too_far() => Failure::Data(format!(
            "{name}: coordinates of the model, times the matrices above them, are beyond 10^150; scale them down"
        )),
        other => other,
    }
}

/// Checks that at most one model comes from standard input.
pub fn check_streams(models: &[impl AsRef<Path>]) -> Result<(), Failure> {
    match models.iter().filter(|m| is_stream(m.as_ref())).count() {
        0 | 1 => Ok(()),
        _ => Err(Failure::Usage("`-` is given twice; standard input holds one model".to_owned())),
    }
}

/// Options for reading models, and the folder that they may refer to.
#[derive(Debug)]
pub struct Reading {
    options: ReadOptions,
    root: Option<PathBuf>,
    /// `--max-triangles` and `--max-bytes`, if they are given.
    given: [Option<u64>; 2],
}

/// Returns the options for reading models.
pub fn read_options(args: &ReadingArgs, work: &Work) -> Reading {
    let default = Limits::default();
    let posed = args.animation.is_some() || args.time.is_some();
    let pose = Pose { animation: args.animation.clone(), time: args.time.unwrap_or(0.0) };
    let options = ReadOptions {
        limits: Limits {
            primitives: args.max_triangles.unwrap_or(default.primitives),
            decoded_bytes: args.max_bytes.unwrap_or(default.decoded_bytes),
            work: work.clone(),
            ..default
        },
        pose: posed.then_some(pose),
        variant: args.variant.clone(),
        scene: args.scene.clone(),
        plate: args.plate,
        own_lights: args.own_lights,
    };
    let given = [args.max_triangles, args.max_bytes];
    Reading { options, root: args.root.clone(), given }
}

/// Reads a model.
pub fn read(path: &Path, reading: &Reading) -> Result<Model, Failure> {
    let Reading { options, root, .. } = reading;
    watch::of_file(display_name(path));
    let resources = resources(path, root.as_deref())?;
    let streamed = streamed(path, &*resources, options);
    let mut model = streamed.unwrap_or_else(|| read_whole(path, &*resources, options))?;
    warn_of_ignored(&mut model, options);
    Ok(model)
}

/// Warns of options that have no effect for a model of its format.
fn warn_of_ignored(model: &mut Model, options: &ReadOptions) {
    // For formats that have lights, the reader warns itself.
    if !model.format.starts_with("glTF") {
        for (given, what) in [
            (options.pose.is_some(), "animations; --animation and --time do"),
            (options.variant.is_some(), "variants; --variant does"),
            (options.scene.is_some(), "scenes; --scene does"),
        ] {
            if given {
                let message = format!("{} has no {what} nothing", model.format);
                model.warn(Place::Whole, message);
            }
        }
    }
    let has_own = ["glTF", "COLLADA", "FBX"].iter().any(|name| model.format.starts_with(name));
    if options.own_lights && !has_own {
        let message = format!("{} has no lights; --own-lights does nothing", model.format);
        model.warn(Place::Whole, message);
    }
    if options.plate.is_some() && model.format != "3MF" {
        let message = format!("{} has no plates; --plate does nothing", model.format);
        model.warn(Place::Whole, message);
    }
}

/// Reads a model from all of its bytes.
fn read_whole(
    path: &Path,
    resources: &dyn Resources,
    options: &ReadOptions,
) -> Result<Model, Failure> {
    let bytes = bytes_within(path, &options.limits)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    read_model(&bytes, &name, resources, options)
        .map_err(|e| refused(&display_name(path), &e, &options.limits))
}

/// Returns the failure for an error of a reader, with the option that raises the limit if there is one.
fn refused(name: &str, error: &durer_formats::Error, limits: &Limits) -> Failure {
    let option = match error {
        durer_formats::Error::Limit { limit, .. } if *limit == limits.primitives => {
            "; --max-triangles raises it"
        }
        durer_formats::Error::Limit { limit, .. } if *limit == limits.decoded_bytes => {
            "; --max-bytes raises it"
        }
        _ => "",
    };
    Failure::Data(format!("{name}: {error}{option}"))
}

/// Returns access to the files beside an input, if the input is a file.
pub fn folder(path: &Path) -> Box<dyn Resources> {
    let folder = if is_stream(path) { None } else { Folder::of(path).ok() };
    folder.map_or_else(|| Box::new(NoResources) as Box<dyn Resources>, |f| Box::new(f))
}

/// Returns access to the files that a model may refer to.
fn resources(path: &Path, root: Option<&Path>) -> Result<Box<dyn Resources>, Failure> {
    let of_root = |root: &Path, e: std::io::Error| {
        Failure::Data(format!("--root {}: {}", root.display(), in_words(&e)))
    };
    let folder = if is_stream(path) { None } else { Folder::of(path).ok() };
    let folder = match (folder, root) {
        (Some(folder), Some(root)) => Some(folder.widen(root).map_err(|e| of_root(root, e))?),
        (None, Some(root)) => Some(Folder::itself(root).map_err(|e| of_root(root, e))?),
        (folder, None) => folder.map(|folder| folder.hint("; --root allows a wider one")),
    };
    Ok(folder.map_or_else(|| Box::new(NoResources) as Box<dyn Resources>, |f| Box::new(f)))
}

/// Reads a binary STL or glTF file without holding its bytes, which take at least as much memory as the model; `None`
/// for other files.
fn streamed(
    path: &Path,
    resources: &dyn Resources,
    options: &ReadOptions,
) -> Option<Result<Model, Failure>> {
    // Of a pipe the bytes read here would be lost.
    let length = std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file)?.len();
    if is_stream(path) || length > options.limits.decoded_bytes {
        return None;
    }
    let mut file = File::open(path).ok()?;
    let mut head = [0; stl::HEADER];
    file.read_exact(&mut head).ok()?;
    let model = if stl::is_whole_binary(&head, length) {
        stl::read_binary_stream(&head, file, options)
    } else if gltf::is_binary(&head) {
        gltf::read_file(file, resources, options)
    } else {
        return None;
    };
    Some(model.map_err(|e| refused(&display_name(path), &e, &options.limits)))
}

/// Returns all bytes of a file, or of standard input, refused above the limit.
pub fn bytes(path: &Path, limit: u64) -> Result<Vec<u8>, Failure> {
    bytes_within(path, &Limits { decoded_bytes: limit, ..Limits::default() })
}

/// Returns all bytes of a file, or of standard input, refused above the limit; they are charged to
/// its work.
pub fn bytes_within(path: &Path, limits: &Limits) -> Result<Vec<u8>, Failure> {
    let Limits { decoded_bytes: limit, work, .. } = limits;
    let limit = *limit;
    watch::of_file(display_name(path));
    let charge = |bytes: u64| work.keep("bytes of the file", bytes).map_err(|e| e.to_string());
    let fail = |what: String| Failure::Data(format!("{}: {what}", display_name(path)));
    if is_stream(path) {
        let bytes = bounded(std::io::stdin().lock(), 0, limit).map_err(fail)?;
        return charge(bytes.capacity() as u64).map(|()| bytes).map_err(fail);
    }
    let file = File::open(path).map_err(|e| fail(in_words(&e)))?;
    let metadata = file.metadata().map_err(|e| fail(in_words(&e)))?;
    if metadata.is_dir() {
        return Err(fail("it is a folder; name the file in it".to_owned()));
    }
    if metadata.len() <= limit {
        charge(metadata.len()).map_err(fail)?;
    }
    bounded(file, metadata.len(), limit).map_err(fail)
}

/// Returns the message about a file with more bytes than `--max-bytes` allows.
pub fn too_large(limit: u64) -> String {
    format!("it has more bytes than the limit of {limit}; --max-bytes raises it")
}

/// Returns all bytes of a source, refused above the limit.
fn bounded(source: impl Read, expected: u64, limit: u64) -> Result<Vec<u8>, String> {
    let too_large = || too_large(limit);
    if expected > limit {
        return Err(too_large());
    }
    let mut bytes = Vec::with_capacity(usize::try_from(expected).unwrap_or(0));
    source.take(limit.saturating_add(1)).read_to_end(&mut bytes).map_err(|e| in_words(&e))?;
    if bytes.len() as u64 > limit { Err(too_large()) } else { Ok(bytes) }
}
