//! `durer clip`.

mod args;
mod engine;
mod mask;
mod report;
mod shapes;
mod sink;
mod srids;
mod tiles;
mod validity;
mod values;

pub use args::{ClipArgs, EXAMPLES, format, window};

use crate::failure::Failure;
use crate::input::{display_name, is_stream};
use crate::layer::{Fields, Shift, Source, words};
use crate::messages::Messages;
use crate::output::{self, Target};
use durer::clip::polygon::{BooleanOp, FillRule, PolygonClipper, Shapes};
use durer_formats::geo::{Feature, GeoFormat, Geometry, Member, System, Writer};
use engine::{Algorithm, Cutter, Rules};
use mask::Mask;
use rayon::prelude::*;
use report::{Counts, Report};
use shapes::Area;
use sink::{Sink, failure};
use srids::Srids;
use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::path::Path;
use std::time::Instant;
use tiles::Tile;

/// Features that are cut at a time, on all threads.
const BATCH: usize = 256;

/// Positions that are held before a batch is cut, however few features they are.
const BATCH_POSITIONS: usize = 1 << 18;

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
    let (from, mut reader) = crate::layer::open(&args.input, args.from, args.layer.as_deref())?;
    let to = output_format(args, from)?;
    let shift = Shift::new(&args.systems, &reader.system());
    let fields = Fields::new(&args.fields);
    let mut report = Report {
        version: env!("CARGO_PKG_VERSION"),
        input: display_name(&args.input),
        output: args.output.display().to_string(),
        from: from.name(),
        to: to.name(),
        mask_srids,
        ..Report::default()
    };
    let is_shifted = shift.is_some();
    let further = {
        let (messages, reader, report) = (&messages, &mut reader, &mut report);
        let mut job = Job { args, to, messages, reader, report, failed: None, shift, fields };
        match (args.region.tiles, mask) {
            (Some(zoom), _) => job.tile(zoom)?,
            (None, mask) if joins(args) => job.join(mask.as_ref())?,
            (None, Some(mask)) => job.cut(mask)?,
            (None, None) if converts(args, from, to) => job.convert()?,
            (None, None) => return Err(Failure::Usage(NO_MASK.to_owned())),
        }
        [job.fields.told(), job.shift.as_ref().and_then(Shift::told), job.unfit()]
    };
    tell(&messages, args, to, &reader, &mut report, is_shifted, further.into_iter().flatten());
    drop(messages);
    report.total_seconds = start.elapsed().as_secs_f64();
    report.peak_memory_bytes = crate::report::peak_memory();
    if args.json { crate::report::print(&report) } else { Ok(()) }
}

const NO_MASK: &str = "nothing to cut with: give --window, --by or --tiles; without them features are only \
                       converted to another format, chosen by --where and the like, or brought to --to-crs";

/// Whether features are to be changed or written otherwise without being cut.
fn converts(args: &ClipArgs, from: GeoFormat, to: GeoFormat) -> bool {
    let systems = &args.systems;
    from != to || !args.fields.is_idle() || systems.to_crs.is_some() || systems.from_crs.is_some()
}

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
    let is_plain = !region.outside
        && args.cutting.op == BooleanOp::Intersection
        && args.cutting.algorithm.is_none();
    if !mask && region.tiles.is_none() && !joins(args) && !is_plain {
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
fn open(path: &Path, format: Option<GeoFormat>) -> Result<(GeoFormat, Source), Failure> {
    crate::layer::open(path, format, None)
}

/// Whether no polygons of a geometry cross, pinch or overlap themselves or one another.
pub fn is_valid(geometry: &Geometry) -> bool {
    let area = Area::of_geometry(geometry);
    area.shapes.is_empty() || validity::is_valid(&area.shapes, validity::Touching::AtPoints)
}

/// The format of the result: as told, by the suffix, or that of the input.
fn output_format(args: &ClipArgs, from: GeoFormat) -> Result<GeoFormat, Failure> {
    let fits = |format: &GeoFormat| args.region.tiles.is_none() || format.is_geojson();
    let named = GeoFormat::of_name(&args.output.to_string_lossy());
    let stream = is_stream(&args.output) || output::is_special(&args.output);
    let found = args
        .to
        .or(named)
        .or(stream.then_some(from).filter(fits).filter(|format| format.is_written()))
        .or(args.region.tiles.map(|_| GeoFormat::GeoJson));
    let Some(format) = found else {
        let written = GeoFormat::ALL.into_iter().filter(|f| f.is_written());
        let suffixes = written.map(|f| f.suffixes()[0]).collect::<Vec<_>>().join(", .");
        let message = format!("the suffix tells no format; use one of .{suffixes}, or --to");
        return Err(Failure::Usage(format!("--output {}: {message}", args.output.display())));
    };
    if !format.is_written() {
        let message = format!("{format} is only read; write .geojson, .fgb or another format");
        return Err(Failure::Usage(format!("--output {}: {message}", args.output.display())));
    }
    if format == GeoFormat::Shapefile && stream {
        let message = "a Shapefile is several files; name the .shp among them";
        return Err(Failure::Usage(format!("--output {}: {message}", args.output.display())));
    }
    if args.region.tiles.is_some() && named == Some(GeoFormat::GeoJson) {
        let message = "--tiles makes a file per tile: name a folder, or a file in .geojsonl";
        return Err(Failure::Usage(message.to_owned()));
    }
    if !fits(&format) {
        return Err(Failure::Usage("tiles are written as GeoJSON".to_owned()));
    }
    Ok(format)
}

/// Warnings of reading and of cutting.
fn tell(
    messages: &Messages,
    args: &ClipArgs,
    to: GeoFormat,
    reader: &Source,
    report: &mut Report,
    is_shifted: bool,
    further: impl Iterator<Item = String>,
) {
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
    if !is_shifted {
        let is_told = reader.system().code.is_some() && to.is_geojson();
        found.extend(report.srids.told(&report.mask_srids, joins(args), to, is_told));
    }
    found.extend(further);
    let (lines, points) = (report.given.lines, report.given.points);
    if joins(args) && lines + points > 0 {
        let op = args.cutting.op;
        found
            .push(format!("left out: {lines} lines and {points} points; --op {op} joins polygons"));
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
    shift: Option<Shift>,
    fields: Fields,
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
            let mut feature = match self.reader.next_feature() {
                Ok(Some(feature)) => feature,
                Ok(None) => break,
                Err(e) if features.is_empty() => return Err(self.fail(words(&e))),
                Err(e) => {
                    self.failed = Some(self.fail(words(&e)));
                    break;
                }
            };
            if !self.fields.apply(&mut feature) {
                self.report.unchosen += 1;
                continue;
            }
            self.report.given.add(feature.geometry.as_ref());
            self.report.srids.add(feature.srid);
            // Tiles are in their own system, which features are brought to before.
            if self.args.region.tiles.is_some() && !self.shifted(&mut feature)? {
                feature.geometry = None;
            }
            positions += feature.geometry.as_ref().map_or(0, Geometry::len);
            features.push(feature);
        }
        let read = self.report.given.features;
        self.messages.progress.stage(|| format!("{read} features"));
        Ok(features)
    }

    /// A place for one file.
    fn sink(&self) -> Result<Sink, Failure> {
        if !is_stream(&self.args.output) {
            return Sink::file(&self.args.output);
        }
        if self.to.is_binary() && std::io::stdout().is_terminal() {
            let message =
                format!("--output -: {} is no text for a terminal; use a pipe or a file", self.to);
            return Err(Failure::Usage(message));
        }
        Ok(Sink::stdout())
    }

    /// Writes what there is, whole or not at all.
    fn put(
        &mut self,
        writer: &mut Option<Writer<Sink>>,
        feature: &mut Feature,
    ) -> Result<(), Failure> {
        if self.args.region.tiles.is_none() && !self.shifted(feature)? {
            return Ok(());
        }
        if writer.is_none() {
            *writer = Some(self.writer()?);
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
            None => self.writer()?,
        };
        let done =
            writer.finish_all(&self.members()).map_err(|e| failure(&self.args.output, &e))?;
        for (suffix, bytes) in done.beside {
            let target = Target::File(self.args.output.with_extension(suffix));
            output::deliver(&target, |out| {
                out.extend_from_slice(&bytes);
                Ok(())
            })?;
        }
        self.messages.warnings(&self.args.output.display().to_string(), &done.warnings);
        self.report.warnings.extend(done.warnings.iter().map(ToString::to_string));
        done.out.commit()
    }

    /// A writer that knows what stands before the features.
    fn writer(&self) -> Result<Writer<Sink>, Failure> {
        let mut writer = Writer::new(self.to, self.sink()?);
        writer.head(&self.members());
        writer.set_system(self.system());
        Ok(writer)
    }

    /// The coordinate system of what is written.
    fn system(&self) -> System {
        match (&self.shift, &self.args.systems.from_crs) {
            (Some(shift), _) => shift.system.clone(),
            (None, Some(from)) => from.system(),
            (None, None) => {
                let told = self.reader.system();
                let common = self.report.srids.common().filter(|_| told.is_unknown());
                common.map_or(told, System::of_code)
            }
        }
    }

    /// Members of the collection, with the one that tells the coordinate system where GeoJSON must be told.
    fn members(&self) -> Vec<Member> {
        let mut members = self.reader.members().to_vec();
        if !matches!(self.to, GeoFormat::GeoJson | GeoFormat::TopoJson) {
            return members;
        }
        let is_new = self.shift.is_some() || self.args.systems.from_crs.is_some();
        members.retain(|member| !is_new || member.name != CRS);
        let told = members.iter().any(|member| member.name == CRS);
        let told_by_file = is_new || !self.reader.system().is_unknown();
        members.extend(self.system().member().filter(|_| !told && told_by_file));
        members
    }

    /// What is to be told where GeoJSON has other coordinates than it should.
    fn unfit(&self) -> Option<String> {
        let code = self.system().code.filter(|code| *code != 4326 && self.to.is_lonlat())?;
        let told = self.members().iter().any(|member| member.name == CRS);
        let own = self.reader.members().iter().any(|member| member.name == CRS);
        (told && (self.shift.is_some() || !own)).then(|| {
            format!(
                "{} stands for longitude and latitude (RFC 7946); that coordinates are EPSG:{code} is told by \
                 its older member crs, which not all programs heed",
                self.to
            )
        })
    }

    /// Whether a feature has a place in the system that is asked for, to which it is brought.
    fn shifted(&mut self, feature: &mut Feature) -> Result<bool, Failure> {
        match &mut self.shift {
            Some(shift) => shift.apply(feature),
            None => {
                let from = self.args.systems.from_crs.as_ref();
                feature.srid = from.map_or(feature.srid, |from| from.code());
                Ok(true)
            }
        }
    }

    /// All features as they are.
    fn convert(&mut self) -> Result<(), Failure> {
        let mut writer = None;
        loop {
            let features = self.batch()?;
            if features.is_empty() {
                return self.end(writer);
            }
            for mut feature in features {
                self.put(&mut writer, &mut feature)?;
            }
        }
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
                    self.put(&mut writer, &mut feature)?;
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
            let mut joined = Feature { srid, ..Feature::of_geometry(geometry) };
            self.put(&mut writer, &mut joined)?;
        }
        self.end(writer)
    }

    /// Each feature to the tiles that it touches.
    fn tile(&mut self, zoom: u8) -> Result<(), Failure> {
        let (args, coordinates) = (self.args, self.args.region.tile_coordinates);
        let one_file = self.to != GeoFormat::GeoJson || is_stream(&self.args.output);
        if one_file && self.to == GeoFormat::GeoJson {
            self.to = GeoFormat::GeoJsonSeq;
        }
        let mut writer = None;
        let mut files: BTreeMap<Tile, (Writer<Vec<u8>>, Counts)> = BTreeMap::new();
        let mut seen = std::collections::BTreeSet::new();
        loop {
            let features = self.batch()?;
            if features.is_empty() {
                break;
            }
            let first = self.report.given.features - features.len() as u64;
            let cuts: Vec<_> = features
                .par_iter()
                .map(|f| {
                    let cut = |g| tiles::cut(g, zoom, coordinates, rules(args, f));
                    f.geometry.as_ref().map(cut).transpose()
                })
                .collect();
            for (i, (mut feature, cut)) in features.into_iter().zip(cuts).enumerate() {
                let cut = cut.map_err(|e| self.of_feature(first + i as u64, &e))?;
                let (pieces, repaired) = cut.unwrap_or_default();
                self.report.repaired += u64::from(repaired);
                let own = feature.members.iter().any(|member| member.name == TILE);
                self.report.replaced += u64::from(one_file && own && !pieces.is_empty());
                for (tile, geometry) in pieces {
                    feature.geometry = Some(geometry);
                    if one_file {
                        seen.insert(tile);
                        self.put(&mut writer, &mut with_tile(&feature, tile))?;
                    } else {
                        let new =
                            || (Writer::new(GeoFormat::GeoJson, Vec::new()), Counts::default());
                        let (file, counts) = files.entry(tile).or_insert_with(new);
                        counts.add(feature.geometry.as_ref());
                        file.write(&feature).map_err(|e| failure(&self.args.output, &e))?;
                    }
                }
            }
        }
        self.report.tiles = Some(seen.len().max(files.len()) as u64);
        if one_file {
            return self.end(writer);
        }
        files.into_iter().try_for_each(|(tile, file)| self.deliver(tile, file))
    }

    /// Writes the file of a tile, `z/x/y.geojson`.
    fn deliver(
        &mut self,
        tile: Tile,
        (writer, counts): (Writer<Vec<u8>>, Counts),
    ) -> Result<(), Failure> {
        self.report.out.join(&counts);
        let path = self.args.output.join(format!("{tile}.geojson"));
        output::make_folder(path.parent().unwrap_or(&self.args.output))?;
        let whole = writer.finish(&[]).map_err(|e| failure(&path, &e))?;
        let target = Target::File(path);
        output::deliver(&target, |out| {
            out.extend_from_slice(&whole);
            Ok(())
        })
        .map(drop)
    }
}

/// The member of GeoJSON's older version that tells the coordinate system, as JSON writes it.
const CRS: &str = "\"crs\"";

/// The member that names a feature's tile, as JSON writes it.
const TILE: &str = "\"tile\"";

/// The feature with a member that names the tile.
fn with_tile(feature: &Feature, tile: Tile) -> Feature {
    let mut feature = feature.clone();
    feature.members.retain(|member| member.name != TILE);
    let value = format!("\"{tile}\"");
    feature.members.push(Member { name: TILE.to_owned(), value });
    feature
}
