//! `durer tiles`.

mod args;
mod layers;
mod levels;
mod make;
mod out;

pub use args::{EXAMPLES, TilesArgs};
pub use out::deliver;

use crate::failure::Failure;
use crate::input::{check_streams, display_name};
use crate::messages::Messages;
use durer::clip::tiles::{Pyramid, Tile, extent};
use durer::work::Work;
use durer_formats::tiles::Metadata;
use durer_formats::wording::counted;
use layers::Layers;
use levels::Chosen;
use make::Maker;
use out::Out;
use serde::Serialize;
use std::ops::RangeInclusive;
use std::time::Instant;

/// Report of `--json`.
#[derive(Debug, Serialize)]
struct Report {
    version: &'static str,
    inputs: Vec<String>,
    output: String,
    to: &'static str,
    features: u64,
    /// Number of features in no tile.
    lost: u64,
    /// Source of the levels.
    zoom_by: Chosen,
    tiles: u64,
    /// Size in bytes as written.
    bytes: u64,
    levels: Vec<LevelReport>,
    warnings: Vec<String>,
    /// Reason why tiles are missing, and the files of those that exist.
    #[serde(flatten)]
    broken_off: Option<BrokenOff>,
    read_seconds: f64,
    total_seconds: f64,
    peak_memory_bytes: Option<u64>,
}

/// Report on tiles that could not all be written.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct BrokenOff {
    /// Reason of the failure.
    pub error: String,
    /// The files that were written before, each of them whole, within the folder.
    pub written: Vec<String>,
}

impl BrokenOff {
    /// Creates the report on the tiles in files of a suffix.
    pub fn new(failure: &Failure, tiles: &[Tile], suffix: &str) -> Self {
        let written = tiles.iter().map(|tile| format!("{tile}.{suffix}")).collect();
        Self { error: failure.to_string(), written }
    }
}

/// The levels that are made, and the tiles of a folder.
#[derive(Default)]
struct Done {
    levels: Vec<LevelReport>,
    written: Vec<Tile>,
}

/// Report on a level.
#[derive(Debug, Default, Serialize)]
struct LevelReport {
    zoom: u8,
    tiles: u64,
    bytes: u64,
    /// Bytes of the largest tile.
    largest: u64,
    /// Name of that tile.
    largest_tile: String,
    /// Features in all tiles.
    features: u64,
}

/// Makes tiles of all files.
pub fn run(args: &TilesArgs) -> Result<(), Failure> {
    let start = Instant::now();
    check_streams(&args.inputs)?;
    if args.buffer >= args.extent {
        return Err(Failure::Usage(
            "--buffer: it must be less than the extent of a tile".to_owned(),
        ));
    }
    let messages = Messages::new(&args.running, 1);
    let (format, path) = out::format(args)?;
    let mut all = layers::read(args, &messages)?;
    let bounds = extent(&all.features).unwrap_or([-180.0, -85.0, 180.0, 85.0]);
    let fail = |e: durer::Error| Failure::Data(e.to_string());
    let features = std::mem::take(&mut all.features);
    let (pyramid, chosen) = levels::pyramid(args, features).map_err(fail)?;
    let zooms = pyramid.zooms();
    if let Some(message) = chosen.message(&zooms, args) {
        messages.note(&args.output.display().to_string(), message);
    }
    let read_seconds = start.elapsed().as_secs_f64();
    bounded(args, &pyramid)?;
    let mut out = Out::new(format, path)?;
    let maker = Maker::new(args, format, *zooms.end(), &all);
    let mut done = Done::default();
    let made = zooms.clone().try_for_each(|zoom| {
        messages.progress.stage(|| format!("level {zoom}"));
        level(zoom, &pyramid, &maker, (&mut out, &args.running.work), &mut done)
    });
    let ended = made.and_then(|()| out.finish(&metadata(args, &all, &zooms, bounds)));
    if ended.is_err() && !format.is_folder() {
        // An incomplete file is not renamed to its final name.
        done = Done::default();
    }
    let Done { levels, written } = done;
    let broken_off = ended.as_ref().err().map(|f| BrokenOff::new(f, &written, format.name()));
    let (tiles, bytes) = levels.iter().fold((0, 0), |(t, b), l| (t + l.tiles, b + l.bytes));
    let lost = maker.lost();
    let mut warnings = std::mem::take(&mut all.warnings);
    for message in
        warnings_of_result(*zooms.end(), lost, tiles).into_iter().filter(|_| ended.is_ok())
    {
        messages.warning(&args.output.display().to_string(), &message);
        warnings.push(message);
    }
    drop(messages);
    let report = Report {
        version: env!("CARGO_PKG_VERSION"),
        inputs: args.inputs.iter().map(|path| display_name(path)).collect(),
        output: args.output.display().to_string(),
        to: format.name(),
        features: all.read,
        lost,
        zoom_by: chosen,
        tiles,
        bytes,
        levels,
        warnings,
        broken_off,
        read_seconds,
        total_seconds: start.elapsed().as_secs_f64(),
        peak_memory_bytes: crate::report::peak_memory(),
    };
    let printed = if args.json { crate::report::print(&report) } else { Ok(()) };
    let whole = if all.skipped > 0 { Err(Failure::Partial) } else { Ok(()) };
    ended.and(printed).and(whole)
}

/// Refuses too many tiles before one is made.
fn bounded(args: &TilesArgs, pyramid: &Pyramid) -> Result<(), Failure> {
    let count = pyramid.count(args.max_tiles).map_err(|e| Failure::Data(e.to_string()))?;
    too_many(count, args.max_tiles)
}

/// Refuses too many tiles; counting stops somewhere above the limit.
pub fn too_many(count: u64, limit: u64) -> Result<(), Failure> {
    if count <= limit {
        return Ok(());
    }
    Err(Failure::Data(format!(
        "there would be at least {count} tiles, more than the limit of {limit}; choose a lower zoom level, or raise \
         --max-tiles"
    )))
}

fn warnings_of_result(last: u8, lost: u64, tiles: u64) -> Vec<String> {
    let mut found = Vec::new();
    if lost > 0 {
        found.push(format!(
            "{} beyond the latitudes of Web Mercator, ±85.0511, or too small for the grid of level {last}",
            counted(lost, "feature is in no tile: it is", "features are in no tile: they are")
        ));
    }
    if tiles == 0 {
        found.push("there is no tile".to_owned());
    }
    found
}

/// Makes and writes all tiles of a level.
fn level(
    zoom: u8,
    pyramid: &Pyramid,
    maker: &Maker<'_>,
    (out, work): (&mut Out, &Work),
    done: &mut Done,
) -> Result<(), Failure> {
    let mut report = LevelReport { zoom, ..LevelReport::default() };
    let ended = pyramid.visit(
        zoom,
        |tile, pieces| maker.make(tile, pieces),
        |tile: Tile, made| {
            work.check()?;
            out.add(tile, &made.bytes).map_err(Stopped::Written)?;
            done.written.push(tile);
            let length = made.bytes.len() as u64;
            report.tiles += 1;
            report.bytes += length;
            report.features += made.features;
            if length > report.largest {
                (report.largest, report.largest_tile) = (length, tile.to_string());
            }
            Ok(())
        },
    );
    done.levels.push(report);
    ended.map_err(|stopped| match stopped {
        Stopped::Written(failure) => failure,
        Stopped::Cut(e) => Failure::Data(e.to_string()),
    })
}

/// Reason why making tiles ended early.
#[derive(Debug)]
pub enum Stopped {
    Cut(durer::Error),
    Written(Failure),
}

impl From<durer::Error> for Stopped {
    fn from(error: durer::Error) -> Self {
        Self::Cut(error)
    }
}

fn metadata(
    args: &TilesArgs,
    all: &Layers,
    zooms: &RangeInclusive<u8>,
    bounds: [f64; 4],
) -> Metadata {
    let stem = || args.output.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let pattern = args.output.to_string_lossy().contains("{z}");
    let name = args.name.clone().or_else(|| stem().filter(|_| !pattern));
    Metadata {
        name: name
            .unwrap_or_else(|| all.layers.first().map_or_else(String::new, |l| l.name.clone())),
        zooms: (*zooms.start(), *zooms.end()),
        bounds,
        attribution: args.attribution.clone(),
        layers: all.infos(),
    }
}
