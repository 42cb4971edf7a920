//! `durer simplify`.

use crate::args::RunningArgs;
use crate::clip::Counts;
use crate::failure::Failure;
use crate::input::{display_name, is_stream};
use crate::layer::{self, Source, failure, named_format, open, words};
use crate::messages::Messages;
use crate::values;
use clap::{ArgGroup, Args, ValueHint};
use durer::clip::polygon::signed_area;
use durer::clip::simplify::coverage::Options;
use durer::clip::simplify::{Coverage, LineSimplifier, tolerance_for_share};
use durer::trace::NoTrace;
use durer_formats::geo::{Feature, GeoFormat, Geometry, Points, Writer};
use rayon::prelude::*;
use serde::Serialize;
use std::path::PathBuf;
use std::time::Instant;

pub const EXAMPLES: &str = "\
Examples:
  durer simplify countries.geojson --tolerance 0.05 -o coarse.geojson
  durer simplify parcels.geojson --keep 10% -o light.geojson
  durer simplify roads.geojsonl --each --tolerance 2 --method douglas-peucker -o -

Borders that neighbours share, point by point, are simplified once and stay shared; lines and borders that do not \
cross before do not cross after; every ring keeps three points. Properties, ids and members are kept, and so are \
the heights and measures of points that stay.

Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong use.";

/// The options of `durer simplify`.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("amount").required(true))]
pub struct SimplifyArgs {
    /// GeoJSON (also one feature per line), WKT, WKB or SVG; `-` reads standard input
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath)]
    pub input: PathBuf,
    /// Where the result goes: a file whose suffix tells the format, or `-` for standard output, in the format of the input
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::FilePath)]
    pub output: PathBuf,
    /// How far lines may move, in units of the coordinates: by douglas-peucker the distance of points that are left
    /// out; by visvalingam the side of a square as large as the triangles that are
    #[arg(long, value_name = "T", group = "amount", allow_hyphen_values = true, value_parser = values::not_negative)]
    pub tolerance: Option<f64>,
    /// Keep this share of the points that can be left out, e.g. 10%
    #[arg(long, value_name = "P%", group = "amount", allow_hyphen_values = true, value_parser = share)]
    pub keep: Option<f64>,
    /// douglas-peucker (the farthest points stay) or visvalingam (the smallest triangles go)
    #[arg(long, value_name = "NAME", default_value = "visvalingam")]
    pub method: LineSimplifier,
    /// Leave out rings that then enclose less than this, in squared units of the coordinates; a polygon goes with its
    /// outer ring, and a feature with all of its polygons
    #[arg(long, value_name = "AREA", allow_hyphen_values = true, value_parser = values::not_negative)]
    pub drop_below: Option<f64>,
    /// Each feature for itself, as a stream; borders between features may come apart
    #[arg(long)]
    pub each: bool,
    /// The format of IN [default: by its content, then by its suffix]
    #[arg(long, value_name = "FORMAT", value_parser = crate::clip::format, help_heading = "Formats")]
    pub from: Option<GeoFormat>,
    /// The format of OUT [default: by its suffix]
    #[arg(long, visible_alias = "format", value_name = "FORMAT", value_parser = crate::clip::format, help_heading = "Formats")]
    pub to: Option<GeoFormat>,
    /// Threads and messages.
    #[command(flatten)]
    pub running: RunningArgs,
    /// Write a report on standard output, in JSON: counts and areas in and out
    #[arg(long, help_heading = "Running")]
    pub json: bool,
}

/// A share in percent.
fn share(text: &str) -> Result<f64, String> {
    let percent = values::not_negative(text.strip_suffix('%').unwrap_or(text))?;
    if percent > 100.0 {
        return Err("at most 100% can be kept".to_owned());
    }
    Ok(percent / 100.0)
}

/// What `--json` says.
#[derive(Debug, Serialize)]
struct Report {
    version: &'static str,
    input: String,
    output: String,
    from: &'static str,
    to: &'static str,
    method: &'static str,
    /// That of all features together.
    #[serde(skip_serializing_if = "Option::is_none")]
    tolerance: Option<f64>,
    #[serde(rename = "in")]
    given: Counts,
    out: Counts,
    dropped: Dropped,
    warnings: Vec<String>,
    total_seconds: f64,
    peak_memory_bytes: Option<u64>,
}

/// Features that are simplified at a time where each is taken for itself.
const BATCH: usize = 1024;

/// Simplifies one file.
pub fn run(args: &SimplifyArgs) -> Result<(), Failure> {
    let start = Instant::now();
    if args.json && is_stream(&args.output) {
        let message = "--json: the report goes to standard output, where the result goes too";
        return Err(Failure::Usage(message.to_owned()));
    }
    let messages = Messages::new(&args.running, 1);
    let (from, mut reader) = open(&args.input, args.from, None)?;
    let to = named_format(&args.output, args.to, Some(from))?;
    let mut report = Report {
        version: env!("CARGO_PKG_VERSION"),
        input: display_name(&args.input),
        output: args.output.display().to_string(),
        from: from.name(),
        to: to.name(),
        method: args.method.name(),
        tolerance: None,
        given: Counts::default(),
        out: Counts::default(),
        dropped: Dropped::default(),
        warnings: Vec::new(),
        total_seconds: 0.0,
        peak_memory_bytes: None,
    };
    write(args, to, &mut reader, &mut report, &messages)?;
    tell(&messages, args, &reader, &mut report);
    drop(messages);
    report.total_seconds = start.elapsed().as_secs_f64();
    report.peak_memory_bytes = crate::report::peak_memory();
    if args.json { crate::report::print(&report) } else { Ok(()) }
}

fn tell(messages: &Messages, args: &SimplifyArgs, reader: &Source, report: &mut Report) {
    let name = display_name(&args.input);
    messages.warnings(&name, reader.warnings());
    report.warnings.extend(reader.warnings().iter().map(ToString::to_string));
    let gone = report.given.features - report.out.features;
    let mut found = Vec::new();
    if report.given.features == 0 {
        found.push("there is no feature in it".to_owned());
    }
    let degenerate = report.dropped.degenerate;
    if degenerate > 0 {
        found.push(format!(
            "{degenerate} rings of fewer than three different points, or lines of fewer than two, are left out"
        ));
    }
    if gone > 0 {
        found.push(format!("{gone} features have nothing left and are left out"));
    }
    for message in found {
        messages.warning(&name, &message);
        report.warnings.push(message);
    }
}

/// Reads, simplifies and writes.
fn write(
    args: &SimplifyArgs,
    to: GeoFormat,
    reader: &mut Source,
    report: &mut Report,
    messages: &Messages,
) -> Result<(), Failure> {
    let mut writer: Option<Writer<_>> = None;
    loop {
        let most = if args.each { BATCH } else { usize::MAX };
        let mut features = batch(args, reader, most, report)?;
        if writer.is_some() && features.is_empty() {
            break;
        }
        let each = if args.each { 1 } else { features.len().max(1) };
        let tolerances: Result<Vec<f64>, Failure> =
            features.par_chunks_mut(each).map(|some| simplify(some, args)).collect();
        let tolerances = tolerances?;
        report.tolerance = tolerances.first().copied().filter(|_| !args.each);
        let writer = match &mut writer {
            Some(writer) => writer,
            none => {
                let system = reader.system();
                none.insert(layer::writer(&args.output, to, reader.members(), system)?)
            }
        };
        for mut feature in features {
            let had = feature.geometry.is_some();
            let least = args.drop_below.unwrap_or(0.0);
            feature.geometry = feature.geometry.and_then(|g| report.dropped.left(g, least));
            if feature.geometry.is_some() || !had {
                report.out.add(feature.geometry.as_ref());
                writer.write(&feature).map_err(|e| failure(&args.output, &e))?;
            }
        }
    }
    let Some(writer) = writer else { return Ok(()) };
    report.warnings = layer::finish(writer, &args.output, reader.members(), messages)?;
    Ok(())
}

/// The next features.
fn batch(
    args: &SimplifyArgs,
    reader: &mut Source,
    most: usize,
    report: &mut Report,
) -> Result<Vec<Feature>, Failure> {
    let mut features = Vec::new();
    while features.len() < most {
        let fail = |e| Failure::Data(format!("{}: {}", display_name(&args.input), words(&e)));
        let Some(feature) = reader.next_feature().map_err(fail)? else { break };
        report.given.add(feature.geometry.as_ref());
        features.push(feature);
    }
    Ok(features)
}

/// Simplifies features together; gives the tolerance.
fn simplify(features: &mut [Feature], args: &SimplifyArgs) -> Result<f64, Failure> {
    let mut coverage = Coverage::default();
    let geometries = |features: &mut [Feature], f: &mut dyn FnMut(&mut Points, bool)| {
        features.iter_mut().filter_map(|f| f.geometry.as_mut()).for_each(|g| chains(g, f));
    };
    geometries(features, &mut |points, closed| {
        let xy = points.xy.iter().copied();
        if closed { coverage.push_ring(xy) } else { coverage.push_line(xy) }
    });
    let limit = args.tolerance.unwrap_or(f64::INFINITY);
    let options = Options { method: args.method, limit };
    let weights = coverage.weights(&options, &mut NoTrace);
    let weights =
        weights.map_err(|e| Failure::Data(format!("{}: {e}", display_name(&args.input))))?;
    let tolerance = match args.keep {
        Some(share) => tolerance_for_share(&weights, share),
        None => limit,
    };
    let mut weights = weights.into_iter();
    geometries(features, &mut |points, _| {
        let mut left = Points::new(points.dimensions);
        for (i, weight) in (0..points.len()).zip(weights.by_ref()) {
            if weight > tolerance {
                left.push(points.xy[i], points.zm(i));
            }
        }
        *points = left;
    });
    Ok(tolerance.max(0.0))
}

/// Calls for each line and ring, and says which it is.
fn chains(geometry: &mut Geometry, f: &mut dyn FnMut(&mut Points, bool)) {
    match geometry {
        Geometry::Point(_) | Geometry::MultiPoint(_) => {}
        Geometry::LineString(line) => f(line, false),
        Geometry::MultiLineString(lines) => lines.iter_mut().for_each(|line| f(line, false)),
        Geometry::Polygon(rings) => rings.iter_mut().for_each(|ring| f(ring, true)),
        Geometry::MultiPolygon(polygons) => {
            polygons.iter_mut().flatten().for_each(|ring| f(ring, true));
        }
        Geometry::Collection(parts) => parts.iter_mut().for_each(|part| chains(part, f)),
    }
}

/// Which runs of points are left out.
#[derive(Debug, Default, Clone, Copy, Serialize)]
struct Dropped {
    /// Rings that enclose less than asked for.
    small_rings: u64,
    /// Rings of fewer than three points and lines of fewer than two, as the input had them but for repeated points.
    degenerate: u64,
}

impl Dropped {
    /// Whether a ring stays.
    fn keeps(&mut self, ring: &Points, least: f64) -> bool {
        let degenerate = ring.len() < 3;
        let small = !degenerate && signed_area(&ring.xy).abs() < least;
        self.degenerate += u64::from(degenerate);
        self.small_rings += u64::from(small);
        !degenerate && !small
    }

    fn polygon(&mut self, mut rings: Vec<Points>, least: f64) -> Option<Vec<Points>> {
        // Without its outer ring there is nothing of a polygon.
        let outer = rings.first().is_some_and(|ring| self.keeps(ring, least));
        let mut first = true;
        rings.retain(|ring| std::mem::take(&mut first) || self.keeps(ring, least));
        Some(rings).filter(|_| outer)
    }

    fn line(&mut self, line: &Points) -> bool {
        self.degenerate += u64::from(line.len() < 2);
        line.len() > 1
    }

    /// What is left of a geometry. What was empty before stays.
    fn left(&mut self, geometry: Geometry, least: f64) -> Option<Geometry> {
        if geometry.is_empty() {
            return Some(geometry);
        }
        let left = match geometry {
            Geometry::LineString(line) if !self.line(&line) => return None,
            Geometry::MultiLineString(mut lines) => {
                lines.retain(|line| self.line(line));
                Geometry::MultiLineString(lines)
            }
            Geometry::Polygon(rings) => Geometry::Polygon(self.polygon(rings, least)?),
            Geometry::MultiPolygon(polygons) => {
                let left = polygons.into_iter().filter_map(|rings| self.polygon(rings, least));
                Geometry::MultiPolygon(left.collect())
            }
            Geometry::Collection(parts) => {
                let left = parts.into_iter().filter_map(|part| self.left(part, least));
                Geometry::Collection(left.collect())
            }
            other => other,
        };
        Some(left).filter(|left| !left.is_empty())
    }
}
