//! `durer clip`.

mod args;
mod engine;
mod mask;
mod report;
mod shapes;
mod sink;
mod srids;
mod tiles;
mod tiling;
mod validity;
mod values;

pub use args::{ClipArgs, EXAMPLES, TileCoordinates, format, window};
pub use report::Counts;
pub use sink::failure;

use crate::failure::{Failure, in_words};
use crate::input::{display_name, is_stream};
use crate::messages::Messages;
use crate::output;
use durer::clip::polygon::{BooleanOp, FillRule, PolygonClipper, Shapes};
use durer_formats::geo::{Feature, GeoFormat, Geometry, Reader, Writer};
use engine::{Algorithm, Cutter, Rules};
use mask::Mask;
use rayon::prelude::*;
use report::Report;
use shapes::Area;
use sink::Sink;
use srids::Srids;
use std::fs::File;
use std::io::{BufRead, BufReader, IsTerminal};
use std::path::Path;
use std::time::Instant;

/// Features that are cut at a time, on all threads.
const BATCH: usize = 256;

/// Positions that are held before a batch is cut, however few features they are.
const BATCH_POSITIONS: usize = 1 << 18;

/// Bytes that are looked at to find the format.
const PROBE: usize = 64 << 10;

/// A file that is read feature by feature.
pub type Source = Reader<Box<dyn BufRead>>;

/// Cuts one file.
pub fn run(args: &ClipArgs) -> Result<(), Failure> {
    let start = Instant::now();
    check(args)?;
    let messages = Messages::new(&args.running, 1);
    let mut mask_srids = Srids::default();
    let mask = match (&args.region.window, &args.region.by) {
        (Some(window), _) => {
            Some(Mask::window(*window).map_err(|e| Failure::Usage(format!("--window: {e}")))?)
        }
        (_, Some(path)) => Some(mask::read(path, args, &mut mask_srids, &messages)?),
        _ => None,
    };
    let (from, mut reader) = open(&args.input, args.from)?;
    let to = output_format(args, from)?;
    let mut report = Report {
        version: env!("CARGO_PKG_VERSION"),
        input: display_name(&args.input),
        output: args.output.display().to_string(),
        from: from.name(),
        to: to.name(),
        mask_srids,
        ..Report::default()
    };
    let (source, told) = (&mut reader, &mut report);
    let mut job = Job { args, to, messages: &messages, reader: source, report: told, failed: None };
    match (args.region.tiles, mask) {
        (Some(zoom), _) => job.tile(zoom)?,
        (None, mask) if joins(args) => job.join(mask.as_ref())?,
        (None, Some(mask)) => job.cut(mask)?,
        (None, None) => return Err(Failure::Usage(NO_MASK.to_owned())),
    }
    tell(&messages, args, to, &reader, &mut report);
    drop(messages);
    report.total_seconds = start.elapsed().as_secs_f64();
    report.peak_memory_bytes = crate::report::peak_memory();
    if args.json { crate::report::print(&report) } else { Ok(()) }
}

const NO_MASK: &str = "nothing to cut with: give --window, --by or --tiles";

/// Whether all polygons become one.
fn joins(args: &ClipArgs) -> bool {
    matches!(args.cutting.op, BooleanOp::Union | BooleanOp::Xor)
}

/// What the parser does not know to be wrong.
fn check(args: &ClipArgs) -> Result<(), Failure> {
    let usage = |message: &str| Err(Failure::Usage(message.to_owned()));
    let region = &args.region;
    if region.by.as_deref().is_some_and(is_stream) && is_stream(&args.input) {
        return usage("`-` is given twice; standard input holds one file");
    }
    let mask = region.window.is_some() || region.by.is_some();
    if !mask && region.tiles.is_none() && !joins(args) {
        return usage(NO_MASK);
    }
    if args.json && is_stream(&args.output) {
        return usage("--json: the report goes to standard output, where the result goes too");
    }
    let Some(algorithm) = args.cutting.algorithm else { return Ok(()) };
    let name = algorithm.name();
    if region.tiles.is_some() {
        return usage("--algorithm and --tiles do not go together: tiles are cut by what is fast");
    }
    if joins(args) && !algorithm.joins() {
        return usage("--op union and xor are done by --algorithm overlay and vatti");
    }
    if algorithm.needs_window() && region.window.is_none() {
        return Err(Failure::Usage(format!("--algorithm {name} needs --window")));
    }
    let difference = region.outside || args.cutting.op == BooleanOp::Difference;
    if algorithm.needs_intersection() && difference {
        return Err(Failure::Usage(format!("--algorithm {name} keeps the inside only")));
    }
    let ruled = args.cutting.grid.is_some()
        || args.cutting.fill_rule.is_some_and(|rule| rule != FillRule::EvenOdd);
    if ruled && !algorithm.takes_rules() {
        let message =
            "takes polygons as they are; --grid and --fill-rule go with overlay and vatti";
        return Err(Failure::Usage(format!("--algorithm {name} {message}")));
    }
    Ok(())
}

/// What holds for one feature: what the options say, or else the feature itself.
fn rules(args: &ClipArgs, feature: &Feature) -> Rules {
    let fill = args.cutting.fill_rule.unwrap_or(feature.fill_rule);
    Rules { fill, grid: args.cutting.grid }
}

/// Opens a file, or standard input, and finds its format.
pub fn open(path: &Path, format: Option<GeoFormat>) -> Result<(GeoFormat, Source), Failure> {
    let fail = |what: String| Failure::Data(format!("{}: {what}", display_name(path)));
    let mut source: Box<dyn BufRead> = if is_stream(path) {
        Box::new(BufReader::with_capacity(PROBE, std::io::stdin()))
    } else {
        let file = File::open(path).map_err(|e| fail(in_words(&e)))?;
        if file.metadata().is_ok_and(|m| m.is_dir()) {
            return Err(fail("it is a folder; name the file in it".to_owned()));
        }
        Box::new(BufReader::with_capacity(PROBE, file))
    };
    let head = source.fill_buf().map_err(|e| fail(in_words(&e)))?;
    let by_name = || GeoFormat::of_name(&path.to_string_lossy());
    let found = format.or_else(|| GeoFormat::of_content(head)).or_else(by_name);
    let Some(format) = found else {
        let what = if head.is_empty() { "the file is empty" } else { "not a known format" };
        return Err(fail(format!("{what}; map data are read from GeoJSON, WKT, WKB and SVG")));
    };
    // The layouts of GeoJSON are read alike; the suffix tells the one to write to a stream.
    let named = by_name().filter(|named| named.is_geojson() && format == GeoFormat::GeoJson);
    let reader = Reader::new(format, source).map_err(|e| fail(words(&e)))?;
    Ok((named.unwrap_or(format), reader))
}

/// What went wrong with reading, in the command's words.
pub fn words(error: &durer_formats::Error) -> String {
    match error {
        durer_formats::Error::Io(e) => in_words(e),
        other => other.to_string(),
    }
}

/// The format of the result: as told, by the suffix, or on a stream that of the input.
pub fn named_format(
    output: &Path,
    to: Option<GeoFormat>,
    from: Option<GeoFormat>,
) -> Result<GeoFormat, Failure> {
    let named = GeoFormat::of_name(&output.to_string_lossy());
    let stream = is_stream(output) || output::is_special(output);
    to.or(named).or(from.filter(|_| stream)).ok_or_else(|| {
        let suffixes = GeoFormat::ALL.map(|f| f.suffixes()[0]).join(", .");
        let message = format!("the suffix tells no format; use one of .{suffixes}, or --to");
        Failure::Usage(format!("--output {}: {message}", output.display()))
    })
}

/// The format of the result; of tiles always GeoJSON.
fn output_format(args: &ClipArgs, from: GeoFormat) -> Result<GeoFormat, Failure> {
    if args.region.tiles.is_none() {
        return named_format(&args.output, args.to, Some(from));
    }
    let from = Some(from).filter(|from| from.is_geojson());
    let format = named_format(&args.output, args.to, from).unwrap_or(GeoFormat::GeoJson);
    if GeoFormat::of_name(&args.output.to_string_lossy()) == Some(GeoFormat::GeoJson) {
        let message = "--tiles makes a file per tile: name a folder, or a file in .geojsonl";
        return Err(Failure::Usage(message.to_owned()));
    }
    if !format.is_geojson() {
        return Err(Failure::Usage("tiles are written as GeoJSON".to_owned()));
    }
    Ok(format)
}

/// A place for one file.
pub fn place(output: &Path, to: GeoFormat) -> Result<Sink, Failure> {
    if !is_stream(output) {
        return Sink::file(output);
    }
    if to == GeoFormat::Wkb && std::io::stdout().is_terminal() {
        let message = "--output -: WKB is no text for a terminal; use a pipe or a file";
        return Err(Failure::Usage(message.to_owned()));
    }
    Ok(Sink::stdout())
}

/// Warnings of reading and of cutting.
fn tell(messages: &Messages, args: &ClipArgs, to: GeoFormat, reader: &Source, report: &mut Report) {
    let name = display_name(&args.input);
    messages.warnings(&name, reader.warnings());
    report.warnings = reader.warnings().iter().map(ToString::to_string).collect();
    let more = reader.further_warnings();
    if more > 0 {
        report.warnings.push(format!("and {more} more"));
    }
    let mut found = Vec::new();
    // An SVG says itself what paths that cross enclose.
    if report.repaired > 0 && report.from != GeoFormat::Svg.name() {
        found.push(format!(
            "polygons of {} features crossed, pinched or overlapped themselves or one another; made \
             valid by the even-odd rule",
            report.repaired
        ));
    }
    if report.lost > 0 {
        found.push(format!(
            "polygons of the mask smaller than a cell of the grid, by default 2^-40 of the feature's \
             extent, may be lost at {} features",
            report.lost
        ));
    }
    if report.given.features == 0 {
        found.push("there is no feature in it".to_owned());
    }
    found.extend(report.srids.told(&report.mask_srids, joins(args), to));
    let (lines, points) = (report.given.lines, report.given.points);
    if joins(args) && lines + points > 0 {
        let op = args.cutting.op;
        found
            .push(format!("left out: {lines} lines and {points} points; --op {op} joins polygons"));
    }
    if report.beyond > 0 {
        let features = report.beyond;
        found.push(format!(
            "{features} features reach beyond the latitudes of Web Mercator, ±85.0511; what lies there is in no tile"
        ));
    }
    if report.too_far > 0 {
        let features = report.too_far;
        found.push(format!(
            "{features} features lie more than four worlds beyond 180 degrees; left out"
        ));
    }
    if report.replaced > 0 {
        let features = report.replaced;
        found.push(format!(
            "the member \"tile\" of {features} features gives way to the tile's name"
        ));
    }
    for message in found {
        let warning = durer_formats::Warning { place: Default::default(), message };
        messages.warnings(&name, std::slice::from_ref(&warning));
        report.warnings.push(warning.to_string());
    }
}

/// One run over the features.
struct Job<'a> {
    args: &'a ClipArgs,
    to: GeoFormat,
    messages: &'a Messages,
    reader: &'a mut Source,
    report: &'a mut Report,
    /// Why reading ended, told when what was read before is written.
    failed: Option<Failure>,
}

impl Job<'_> {
    fn fail(&self, what: impl std::fmt::Display) -> Failure {
        Failure::Data(format!("{}: {what}", display_name(&self.args.input)))
    }

    /// The next features; none at the end.
    fn batch(&mut self) -> Result<Vec<Feature>, Failure> {
        if let Some(failure) = self.failed.take() {
            return Err(failure);
        }
        let mut features = Vec::new();
        let mut positions = 0;
        while features.len() < BATCH && positions < BATCH_POSITIONS {
            let feature = match self.reader.next_feature() {
                Ok(Some(feature)) => feature,
                Ok(None) => break,
                Err(e) if features.is_empty() => return Err(self.fail(words(&e))),
                Err(e) => {
                    self.failed = Some(self.fail(words(&e)));
                    break;
                }
            };
            self.report.given.add(feature.geometry.as_ref());
            self.report.srids.add(feature.srid);
            positions += feature.geometry.as_ref().map_or(0, Geometry::len);
            features.push(feature);
        }
        let read = self.report.given.features;
        self.messages.progress.stage(|| format!("{read} features"));
        Ok(features)
    }

    /// Writes what there is, whole or not at all.
    fn put(&mut self, writer: &mut Option<Writer<Sink>>, feature: &Feature) -> Result<(), Failure> {
        if writer.is_none() {
            let mut new = Writer::new(self.to, place(&self.args.output, self.to)?);
            new.head(self.reader.members());
            *writer = Some(new);
        }
        self.report.out.add(feature.geometry.as_ref());
        match writer {
            Some(writer) => writer.write(feature).map_err(|e| failure(&self.args.output, &e)),
            None => Ok(()),
        }
    }

    fn end(&mut self, writer: Option<Writer<Sink>>) -> Result<(), Failure> {
        let writer = match writer {
            Some(writer) => writer,
            None => Writer::new(self.to, place(&self.args.output, self.to)?),
        };
        let done = writer.finish(self.reader.members());
        done.map_err(|e| failure(&self.args.output, &e))?.commit()
    }

    /// Each feature for itself.
    fn cut(&mut self, mask: Mask) -> Result<(), Failure> {
        let outside = self.args.region.outside;
        let op = if outside { BooleanOp::Difference } else { self.args.cutting.op };
        let (args, algorithm) = (self.args, self.args.cutting.algorithm);
        let cut = |feature: &Feature| {
            let cutter = Cutter { mask: &mask, op, rules: rules(args, feature), algorithm };
            feature.geometry.as_ref().map(|g| cutter.cut(g)).transpose()
        };
        let mut writer = None;
        loop {
            let features = self.batch()?;
            if features.is_empty() {
                return self.end(writer);
            }
            let first = self.report.given.features - features.len() as u64;
            let cuts: Vec<_> = features.par_iter().map(cut).collect();
            for (i, (mut feature, cut)) in features.into_iter().zip(cuts).enumerate() {
                let cut = cut.map_err(|e| self.of_feature(first + i as u64, &e))?;
                let cut = cut.unwrap_or_default();
                self.report.repaired += u64::from(cut.repaired);
                self.report.lost += u64::from(cut.lost);
                if cut.geometry.is_some() {
                    feature.geometry = cut.geometry;
                    feature.fill_rule = FillRule::EvenOdd;
                    self.put(&mut writer, &feature)?;
                }
            }
        }
    }

    fn of_feature(&self, index: u64, error: &durer::Error) -> Failure {
        self.fail(format!("feature {} (from 1): {error}", index + 1))
    }

    /// All polygons, those of the mask too, to one feature.
    fn join(&mut self, mask: Option<&Mask>) -> Result<(), Failure> {
        let (args, mut all) = (self.args, Area::default());
        loop {
            let features = self.batch()?;
            if features.is_empty() {
                break;
            }
            let first = self.report.given.features - features.len() as u64;
            let areas: Vec<_> = features
                .par_iter()
                .filter_map(|f| f.geometry.as_ref().map(|g| rules(args, f).clean(g)))
                .collect();
            for (i, area) in areas.into_iter().enumerate() {
                all.append(&area.map_err(|e| self.of_feature(first + i as u64, &e))?);
            }
        }
        let op = self.args.cutting.op;
        let rule = if op == BooleanOp::Xor { FillRule::EvenOdd } else { FillRule::Positive };
        let none = Shapes::new();
        let mask = mask.map_or(&none, Mask::shapes);
        let rules = Rules { fill: rule, grid: self.args.cutting.grid };
        let joined = match self.args.cutting.algorithm {
            Some(Algorithm::Polygon(PolygonClipper::Vatti)) => rules.vatti(&all, mask, op, rule),
            _ => rules.overlay(&all, mask, op, rule),
        };
        let joined = joined.map_err(|e| self.fail(e))?;
        let mut writer = None;
        if let Some(geometry) = joined.into_geometry() {
            let srid = self.report.srids.common();
            self.put(&mut writer, &Feature { srid, ..Feature::of_geometry(geometry) })?;
        }
        self.end(writer)
    }
}
