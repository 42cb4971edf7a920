//! Map data as all commands read them: files, choices of features and fields, and coordinate systems.

mod fields;
mod info;
mod out;
mod sink;
mod systems;
mod watched;

pub use fields::{Condition, FieldArgs, Fields, condition, none_meets};
pub use info::{LayerInfo, of_layers};
pub use out::{finish, named_format, writer};
pub use sink::{Sink, failure};
pub use systems::{CRS, Shift, SystemArgs, late};

use crate::failure::{Failure, in_words};
use crate::input::{self, display_name};
use crate::places::is_stream;
use crate::watch;
use durer::work::Work;
use durer_formats::geo::{Beside, Feature, GeoFormat, Points, Reader, unzipped};
use durer_formats::{Limits, ModelFormat, archive};
use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Read};
use std::path::Path;
use watched::Watched;

/// Bytes that are examined to find the format.
const PROBE: usize = 64 << 10;

/// A reader of a file or of standard input.
pub type Source = Reader<Box<dyn BufRead>>;

/// Returns a stream of the bytes of a file or of standard input, decompressed if they are gzip.
pub fn bytes(path: &Path) -> Result<Box<dyn BufRead>, Failure> {
    let fail = |what: String| Failure::Data(format!("{}: {what}", display_name(path)));
    let source: Box<dyn BufRead> = if is_stream(path) {
        Box::new(BufReader::with_capacity(PROBE, std::io::stdin()))
    } else {
        let file = File::open(path).map_err(|e| fail(in_words(&e)))?;
        if file.metadata().is_ok_and(|m| m.is_dir()) {
            return Err(fail("it is a folder; name the file in it".to_owned()));
        }
        Box::new(BufReader::with_capacity(PROBE, file))
    };
    unzipped(source, PROBE).map_err(|e| fail(in_words(&e)))
}

/// Returns the format that a name speaks for, or that its first bytes do; none for models.
pub fn format_of(path: &Path, head: &[u8]) -> Option<GeoFormat> {
    // Any JSON could be GeoJSON, and any XML SVG.
    let is_model =
        matches!(ModelFormat::of_content(head), Some(ModelFormat::Gltf | ModelFormat::Collada));
    if is_model { None } else { GeoFormat::of_file(&path.to_string_lossy(), head) }
}

/// Describes a file that holds no map data by its first bytes: a sentence for messages.
pub fn foreign(head: &[u8]) -> String {
    match ModelFormat::of_content(head) {
        Some(model) => format!("this is {}, a model; durer render draws it", model.name()),
        None => GeoFormat::foreign(head),
    }
}

/// Opens a file, or standard input, and finds its format; it can be read until the work is stopped.
pub fn open(
    path: &Path,
    format: Option<GeoFormat>,
    layer: Option<&str>,
    work: &Work,
) -> Result<(GeoFormat, Source), Failure> {
    watch::of_file(display_name(path));
    let fail = |what: String| Failure::Data(format!("{}: {what}", display_name(path)));
    let mut source = bytes(path)?;
    let head = source.fill_buf().map_err(|e| fail(in_words(&e)))?;
    if head.starts_with(archive::MAGIC) {
        return open_archive(path, source, (format, layer), work);
    }
    let Some(format) = format.or_else(|| format_of(path, head)) else {
        let what = foreign(head);
        return Err(fail(format!("{what}; map data are read from {}", GeoFormat::READ)));
    };
    // All layouts of GeoJSON are read alike; the suffix determines the one written to a stream.
    let named = GeoFormat::of_name(&path.to_string_lossy());
    let named = named.filter(|named| named.is_geojson() && format == GeoFormat::GeoJson);
    let source = Box::new(Watched::new(source, work, !format.is_geojson()));
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let beside = Beside { name: &name, resources: &*input::folder(path), layer };
    let reader = Reader::with(format, source as Box<dyn BufRead>, &beside);
    Ok((named.unwrap_or(format), reader.map_err(|e| fail(words(&e)))?))
}

/// A file of map data in an archive, and the files beside it there.
pub type Packed = archive::Member<Vec<u8>>;

/// Returns the only file of map data in a ZIP archive, or of several the one that the layer names: `FILE`, or
/// `FILE/LAYER` for a layer of the file.
pub fn packed(
    bytes: Vec<u8>,
    layer: Option<&str>,
    limits: &Limits,
) -> durer_formats::Result<Packed> {
    let is_map = |name: &str| GeoFormat::of_name(name).is_some();
    archive::only(
        bytes,
        limits,
        is_map,
        ("files of map data", layer, "unpack it, or name one with --layer"),
    )
}

/// Returns the names of the files of map data in a ZIP archive; none for other files and for standard input.
pub fn packed_names(path: &Path) -> Vec<String> {
    let names = match File::open(path) {
        Ok(file) if !is_stream(path) => archive::names(file).unwrap_or_default(),
        _ => Vec::new(),
    };
    names.into_iter().filter(|name| GeoFormat::of_name(name).is_some()).collect()
}

/// Opens the file of map data in a ZIP archive.
fn open_archive(
    path: &Path,
    source: impl BufRead,
    (format, layer): (Option<GeoFormat>, Option<&str>),
    work: &Work,
) -> Result<(GeoFormat, Source), Failure> {
    let fail = |what: String| Failure::Data(format!("{}: {what}", display_name(path)));
    let limits = Limits { work: work.clone(), ..Limits::default() };
    let mut bytes = Vec::new();
    // One byte beyond the budget makes its charge fail.
    let mut source = source.take(limits.memory().saturating_add(1));
    source.read_to_end(&mut bytes).map_err(|e| fail(in_words(&e)))?;
    work.keep("bytes of the file", bytes.len() as u64).map_err(|e| fail(e.to_string()))?;
    let Packed { name, bytes, beside, within } =
        packed(bytes, layer, &limits).map_err(|e| fail(words(&e)))?;
    let format = format.or_else(|| format_of(Path::new(&name), &bytes));
    let format = format.ok_or_else(|| fail(format!("{name}: {}", foreign(&bytes))))?;
    let file = name.rsplit('/').next().unwrap_or(&name);
    let source = Box::new(Cursor::new(bytes)) as Box<dyn BufRead>;
    let source = Box::new(Watched::new(source, work, !format.is_geojson()));
    let beside = Beside { name: file, resources: &beside, layer: within.as_deref() };
    let reader = Reader::with(format, source as Box<dyn BufRead>, &beside);
    Ok((format, reader.map_err(|e| fail(format!("{name}: {}", words(&e))))?))
}

/// Charges the memory of a feature that stays to the budget.
pub fn keep(feature: &Feature, work: &Work) -> durer::Result<()> {
    let mut bytes = size_of::<Feature>() + feature.properties.as_ref().map_or(0, String::len);
    if let Some(geometry) = &feature.geometry {
        geometry.for_each(&mut |points| {
            bytes += size_of::<Points>() + points.len() * (16 + 8 * points.dimensions.count());
        });
    }
    work.keep("features", bytes as u64)
}

/// Returns an error's message with the names of the command's options.
pub fn words(error: &durer_formats::Error) -> String {
    match error {
        durer_formats::Error::Io(e) => in_words(e),
        other => other.to_string(),
    }
}

/// Reads the name of a format, or a suffix of its files.
pub fn format(text: &str) -> Result<GeoFormat, String> {
    let found = GeoFormat::ALL.into_iter().find(|f| f.name() == text);
    let by_suffix = || GeoFormat::ALL.into_iter().find(|f| f.suffixes().contains(&text));
    found
        .or_else(by_suffix)
        .ok_or_else(|| format!("it must be one of {}", GeoFormat::ALL.map(|f| f.name()).join(", ")))
}
