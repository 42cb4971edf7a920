//! The destinations of tiles.

use super::args::{TileFormat, TilesArgs};
use crate::beside::Beside;
use crate::failure::{Failure, in_words};
use crate::output::{self, Target, is_special};
use crate::places::is_stream;
use durer::clip::tiles::Tile;
use durer_formats::tiles::{MbTiles, Metadata, PmTiles};
use durer_formats::{Error, Result as Made};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

type File = BufWriter<Beside>;

/// Writer that takes tiles one after the other.
pub enum Out {
    PmTiles(PmTiles<File>, PathBuf),
    MbTiles(MbTiles<File>, PathBuf),
    Folder(PathBuf, TileFormat),
}

/// Returns the format that is requested, and the file or folder.
pub fn format(args: &TilesArgs) -> Result<(TileFormat, PathBuf), Failure> {
    let path = &args.output;
    let usage = |what: &str| Err(Failure::Usage(format!("--output {}: {what}", path.display())));
    if is_stream(path) {
        return usage(
            "tiles are many files, or one that is not written from start to end; name a .pmtiles or .mbtiles \
             file, or a folder",
        );
    }
    let text = path.to_string_lossy();
    let pattern = text.find("{z}").map(|at| (&text[..at], &text[at..]));
    let (found, folder) = match pattern {
        Some((folder, "{z}/{x}/{y}.mvt" | "{z}/{x}/{y}.pbf")) => (Some(TileFormat::Mvt), folder),
        Some((folder, "{z}/{x}/{y}.geojson" | "{z}/{x}/{y}.json")) => {
            (Some(TileFormat::Geojson), folder)
        }
        Some(_) => return usage("tiles are named {z}/{x}/{y}.mvt or {z}/{x}/{y}.geojson"),
        None => {
            let suffix = path.extension().map(|s| s.to_string_lossy().to_ascii_lowercase());
            let found = match suffix.as_deref() {
                Some("pmtiles") => Some(TileFormat::Pmtiles),
                Some("mbtiles") => Some(TileFormat::Mbtiles),
                Some("mvt" | "pbf" | "geojson" | "json") => {
                    return usage(
                        "there is a file for each tile: name a folder, or FOLDER/{z}/{x}/{y}.mvt",
                    );
                }
                _ => None,
            };
            (found, &text[..])
        }
    };
    let format = match (args.to, found) {
        (Some(to), Some(found)) if to != found => {
            return usage("the name and --to tell different formats");
        }
        (to, found) => to.or(found).unwrap_or(TileFormat::Mvt),
    };
    let folder = if folder.is_empty() { Path::new(".") } else { Path::new(folder) };
    Ok((format, folder.to_owned()))
}

impl Out {
    /// Creates an empty place for tiles.
    pub fn new(format: TileFormat, path: PathBuf) -> Result<Self, Failure> {
        let file = |path: &Path| {
            if path.is_dir() || is_special(path) {
                return Err(Failure::of_file(
                    path,
                    "tiles in one file need a file that can be replaced",
                ));
            }
            let file = Beside::create(path).map_err(|e| Failure::of_file(path, in_words(&e)))?;
            Ok(BufWriter::with_capacity(1 << 16, file))
        };
        let fail = |path: &Path, e: &Error| Failure::of_file(path, e);
        Ok(match format {
            TileFormat::Pmtiles => {
                Self::PmTiles(PmTiles::new(file(&path)?).map_err(|e| fail(&path, &e))?, path)
            }
            TileFormat::Mbtiles => {
                Self::MbTiles(MbTiles::new(file(&path)?).map_err(|e| fail(&path, &e))?, path)
            }
            TileFormat::Mvt | TileFormat::Geojson => {
                output::make_folder(&path)?;
                Self::Folder(path, format)
            }
        })
    }

    /// Adds a tile.
    pub fn add(&mut self, tile: Tile, bytes: &[u8]) -> Result<(), Failure> {
        let fail = |path: &Path, done: Made<()>| done.map_err(|e| crate::layer::failure(path, &e));
        match self {
            Self::PmTiles(out, path) => fail(path, out.add(tile.id(), bytes)),
            Self::MbTiles(out, path) => fail(path, out.add(tile, bytes)),
            Self::Folder(folder, format) => deliver(folder, tile, format.name(), bytes),
        }
    }

    /// Renames everything to its final name.
    pub fn finish(self, metadata: &Metadata) -> Result<(), Failure> {
        let commit = |path: &Path, done: Made<File>| {
            let file = done.map_err(|e| crate::layer::failure(path, &e))?;
            let moved = file.into_inner().map_err(std::io::IntoInnerError::into_error);
            moved.and_then(Beside::commit).map_err(|e| Failure::of_file(path, in_words(&e)))
        };
        match self {
            Self::PmTiles(out, path) => commit(&path, out.finish(metadata)),
            Self::MbTiles(out, path) => commit(&path, out.finish(metadata)),
            Self::Folder(folder, format) => {
                let document = metadata.tile_json(&format!("{{z}}/{{x}}/{{y}}.{}", format.name()));
                put(folder.join("tiles.json"), format!("{document:#}\n").as_bytes())
            }
        }
    }
}

/// Writes the file of a tile, `z/x/y.SUFFIX`.
pub fn deliver(folder: &Path, tile: Tile, suffix: &str, bytes: &[u8]) -> Result<(), Failure> {
    let path = folder.join(format!("{tile}.{suffix}"));
    output::make_folder(path.parent().unwrap_or(folder))?;
    put(path, bytes)
}

fn put(path: PathBuf, bytes: &[u8]) -> Result<(), Failure> {
    output::deliver_bytes(&Target::File(path), bytes).map(drop)
}
