//! `durer clip`.

mod args;
mod cells;
mod mask;
mod report;
mod srids;
mod systems;
mod tiling;
mod window;

pub use args::{ClipArgs, EXAMPLES};
pub use report::Counts;
pub use window::window;

use crate::failure::Failure;
use crate::input::display_name;
use crate::layer::{self, Fields, Shift, Sink, Source, failure, named_format, words};
use crate::messages::Messages;
use crate::places::is_stream;
use durer::clip::mask::{Algorithm, Area, Cutter, Made, Mask, Rules, oriented};
use durer::clip::polygon::{BooleanOp, PolygonClipper, Shapes, WindingRule};
use durer::parallel;
use durer_formats::geo::crs::Crs;
use durer_formats::geo::{Feature, GeoFormat, Geometry, System, Writer};
use durer_formats::wording::counted;
use report::Report;
use srids::Srids;
use std::time::Instant;
use window::Window;

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
            Some(window.mask().map_err(|e| Failure::Usage(format!("--window: {e}")))?)
        }
        (_, Some(path)) => Some(mask::read(path, args, &mut mask_srids, &messages)?),
        _ => None,
    };
    let cells = args
        .region
        .cells
        .as_ref()
        .map(|path| cells::read(path, args, &mut mask_srids, &messages))
        .transpose()?;
    let (from, mut reader) =
        crate::layer::open(&args.input, args.from, args.layer.as_deref(), &args.running.work)?;
    if args.fields.skip_failures {
        reader.skip_failures();
    }
    let to = output_format(args, from)?;
    let converts = converts(args, from, to) || reader.is_arcgis();
    let shift = Shift::new(&args.systems);
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
    let mut ended = Ok(());
    let (is_shifted, further) = {
        let (messages, reader, report) = (&messages, &mut reader, &mut report);
        let (failed, stated) = (None, None);
        let mut job = Job { args, to, messages, reader, report, failed, shift, fields, stated };
        match (cells, args.region.tiles, mask) {
            (Some(cells), ..) => job.cut_by_cells(&cells)?,
            // Tiles in files of their own may be there in part.
            (None, Some(zoom), _) => ended = job.tile(zoom),
            (None, None, mask) if joins(args) => job.join(mask.as_ref())?,
            (None, None, Some(mask)) => job.cut(mask)?,
            (None, None, None) if converts => job.convert()?,
            (None, None, None) => return Err(Failure::Usage(NO_MASK.to_owned())),
        }
        let shifted = job.shift.as_ref().and_then(Shift::warning);
        (job.shift.is_some(), [job.fields.warning(), shifted, job.unfit(), job.no_degrees()])
    };
    if ended.is_err() && report.broken_off.is_none() {
        return ended;
    }
    warn(&messages, args, to, &reader, &mut report, is_shifted, further.into_iter().flatten());
    drop(messages);
    report.total_seconds = start.elapsed().as_secs_f64();
    report.peak_memory_bytes = crate::report::peak_memory();
    let printed = if args.json { crate::report::print(&report) } else { Ok(()) };
    let whole = if reader.skipped() > 0 { Err(Failure::Partial) } else { Ok(()) };
    ended.and(printed).and(whole)
}

/// The warning where features that are joined have different ordinates.
pub const MIXED: &str = "heights and measures that some features have and others lack are 0 there";

const NO_MASK: &str = "nothing to clip with: give --window, --by, --cells or --tiles; without these, \
                       features are only converted to another format, selected (--where, --skip-failures) or transformed \
                       (--to-crs)";

/// Returns whether features are to be changed or written otherwise without being cut.
fn converts(args: &ClipArgs, from: GeoFormat, to: GeoFormat) -> bool {
    let (fields, systems) = (&args.fields, &args.systems);
    let chooses = !fields.is_idle() || fields.skip_failures;
    from != to || chooses || systems.to_crs.is_some() || systems.from_crs.is_some()
}

/// Returns whether all polygons become one.
fn joins(args: &ClipArgs) -> bool {
    matches!(args.cutting.op, BooleanOp::Union | BooleanOp::Xor)
}

/// Refuses combinations of options that the parser accepts separately.
fn check(args: &ClipArgs) -> Result<(), Failure> {
    let usage = |message: &str| Err(Failure::Usage(message.to_owned()));
    let region = &args.region;
    let masks = [&region.by, &region.cells].into_iter().flatten();
    if masks.into_iter().any(|path| is_stream(path)) && is_stream(&args.input) {
        return usage("`-` is given twice; standard input holds one file");
    }
    let mask = region.window.is_some() || region.by.is_some() || region.cells.is_some();
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
        return usage(
            "--algorithm and --tiles do not go together: tiles are always cut by the fastest algorithm",
        );
    }
    if joins(args) && !algorithm.joins() {
        return usage("--op union and xor are done by --algorithm overlay and vatti");
    }
    if algorithm.needs_window() && region.window.is_none() {
        return Err(Failure::Usage(format!("--algorithm {name} needs --window")));
    }
    if algorithm.needs_window() && matches!(region.window, Some(Window::Across(_))) {
        let message = "takes one rectangle, not a window across 180 degrees";
        return Err(Failure::Usage(format!("--algorithm {name} {message}")));
    }
    let difference = region.outside || args.cutting.op == BooleanOp::Difference;
    if algorithm.needs_intersection() && difference {
        return Err(Failure::Usage(format!("--algorithm {name} keeps the inside only")));
    }
    let ruled = args.cutting.grid.is_some()
        || args.cutting.fill_rule.is_some_and(|rule| rule != WindingRule::EvenOdd);
    if ruled && !algorithm.takes_rules() {
        let message =
            "takes polygons as they are; --grid and --fill-rule go with overlay and vatti";
        return Err(Failure::Usage(format!("--algorithm {name} {message}")));
    }
    Ok(())
}

/// Returns the rules for one feature: the options', or else the feature's own.
fn rules(args: &ClipArgs, feature: &Feature) -> Rules {
    let fill = args.cutting.fill_rule.unwrap_or(feature.fill_rule);
    Rules { fill, grid: args.cutting.grid, work: args.running.work.clone() }
}

/// Returns the format of the result; always GeoJSON for tiles.
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

/// Prints the warnings of reading and of cutting.
fn warn(
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
    report.warnings.extend(reader.warnings().iter().map(ToString::to_string));
    let more = reader.further_warnings();
    if more > 0 {
        report.warnings.push(format!("and {more} more"));
    }
    let mut found = Vec::new();
    // An SVG gives the fill rule of crossing paths itself.
    if report.repaired > 0 && report.from != GeoFormat::Svg.name() {
        found.push(format!(
            "polygons of {} crossed, pinched or overlapped themselves or one another; made valid by the \
             even-odd rule",
            counted(report.repaired, "feature", "features")
        ));
    }
    if report.lost > 0 {
        found.push(format!(
            "polygons of the mask smaller than a cell of the grid, by default 2^-40 of the feature's \
             extent, may be lost at {}",
            counted(report.lost, "feature", "features")
        ));
    }
    if report.long_ways > 0 {
        found.push(format!(
            "{} edges over more than 180 degrees of longitude, which are kept; if they are meant to cross the \
             180th meridian, cut them there, as RFC 7946 requires",
            counted(report.long_ways, "feature has", "features have")
        ));
    }
    if report.flat > 0 {
        let flat = counted(report.flat, "line without length", "lines without length");
        found.push(format!("left out: {flat}"));
    }
    if report.mixed {
        found.push(MIXED.to_owned());
    }
    match (report.given.features, report.unchosen) {
        (0, 0) => found.push("there is no feature in it".to_owned()),
        (0, all) => found.push(layer::none_meets(all)),
        (some, _) if report.out.features == 0 && report.broken_off.is_none() => {
            let some = counted(some, "feature", "features");
            found.push(format!("nothing remains of its {some}; durer info tells the extent"));
        }
        _ => {}
    }
    let stated = args.systems.from_crs.as_ref().map_or_else(|| reader.system(), Crs::system);
    found.extend(report.srids.other_mask(&report.mask_srids, &stated));
    if !is_shifted {
        let is_stated = reader.system().code.is_some() && to.is_lonlat();
        found.extend(report.srids.warnings(joins(args), to, is_stated));
    }
    found.extend(further);
    let (lines, points) = (report.given.lines, report.given.points);
    if joins(args) && lines + points > 0 {
        let op = args.cutting.op;
        let (lines, points) = (counted(lines, "line", "lines"), counted(points, "point", "points"));
        found.push(format!("left out: {lines} and {points}; --op {op} joins polygons"));
    }
    if report.beyond > 0 {
        let features = counted(report.beyond, "feature reaches", "features reach");
        found.push(format!(
            "{features} beyond the latitudes of Web Mercator, ±85.0511; the parts there are in no tile"
        ));
    }
    if report.too_far > 0 {
        let features = counted(report.too_far, "feature lies", "features lie");
        found.push(format!("{features} more than four worlds beyond 180 degrees; left out"));
    }
    if report.replaced > 0 {
        let features = counted(report.replaced, "feature", "features");
        found.push(format!("the member \"tile\" of {features} is replaced by the tile's name"));
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
    /// Reason why reading ended; reported after everything read before it is written.
    failed: Option<Failure>,
    shift: Option<Shift>,
    fields: Fields,
    /// The coordinate system that the file states before its features; none before the first.
    stated: Option<System>,
}

impl Job<'_> {
    fn fail(&self, what: impl std::fmt::Display) -> Failure {
        Failure::Data(format!("{}: {what}", display_name(&self.args.input)))
    }

    /// Returns the next features; none at the end.
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
            self.begin();
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

    /// Writes the result, whole or not at all.
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
        self.check_degrees(feature);
        self.report.out.add(feature.geometry.as_ref());
        match writer {
            Some(writer) => writer.write(feature).map_err(|e| failure(&self.args.output, &e)),
            None => Ok(()),
        }
    }

    fn end(&mut self, writer: Option<Writer<Sink>>) -> Result<(), Failure> {
        self.check_system()?;
        let writer = match writer {
            Some(writer) => writer,
            None => self.writer()?,
        };
        let lost = layer::finish(writer, &self.args.output, &self.members(), self.messages)?;
        self.report.warnings.extend(lost);
        Ok(())
    }

    /// Returns a writer that knows the text before the features.
    fn writer(&self) -> Result<Writer<Sink>, Failure> {
        layer::writer(&self.args.output, self.to, &self.members(), self.system())
    }

    /// Writes all features as they are, in GeoJSON with the directions of rings that it requires.
    fn convert(&mut self) -> Result<(), Failure> {
        let mut writer = None;
        loop {
            let features = self.batch()?;
            if features.is_empty() {
                return self.end(writer);
            }
            for mut feature in features {
                if self.to.is_geojson() {
                    feature.geometry = feature.geometry.map(oriented);
                }
                self.put(&mut writer, &mut feature)?;
            }
        }
    }

    /// Cuts each feature separately.
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
            if let Some(window) = &self.args.region.window {
                let long =
                    |f: &&Feature| f.geometry.as_ref().is_some_and(|g| window.is_long_way(g));
                self.report.long_ways += features.iter().filter(long).count() as u64;
            }
            let cuts = parallel::of_each(&features, cut);
            for (i, (mut feature, cut)) in features.into_iter().zip(cuts).enumerate() {
                let cut = cut.map_err(|e| self.of_feature(first + i as u64, &e))?;
                let cut = cut.unwrap_or_default();
                self.report.add([&cut]);
                if cut.geometry.is_some() {
                    feature.geometry = cut.geometry;
                    feature.fill_rule = WindingRule::EvenOdd;
                    self.put(&mut writer, &mut feature)?;
                }
            }
        }
    }

    fn of_feature(&self, index: u64, error: &durer::Error) -> Failure {
        self.fail(format!("feature {} (from 1): {error}", index + 1))
    }

    /// Joins all polygons, including the mask's, into one feature.
    fn join(&mut self, mask: Option<&Mask>) -> Result<(), Failure> {
        let (args, mut all) = (self.args, Area::default());
        loop {
            let features = self.batch()?;
            if features.is_empty() {
                break;
            }
            let first = self.report.given.features - features.len() as u64;
            let clean = |f: &Feature| f.geometry.as_ref().map(|g| rules(args, f).clean(g));
            let areas = parallel::of_each(&features, clean);
            for (i, area) in areas.into_iter().flatten().enumerate() {
                let made = area.map_err(|e| self.of_feature(first + i as u64, &e))?;
                self.report.repaired += u64::from(made.repaired);
                self.report.snapped += made.snapped as u64;
                self.report.mixed |= all.append(&made.area);
            }
        }
        let op = self.args.cutting.op;
        let rule = if op == BooleanOp::Xor { WindingRule::EvenOdd } else { WindingRule::Positive };
        let none = Shapes::new();
        let mask = mask.map_or(&none, Mask::shapes);
        let rules = Rules {
            fill: rule,
            grid: self.args.cutting.grid,
            work: self.args.running.work.clone(),
        };
        let joined = match self.args.cutting.algorithm {
            Some(Algorithm::Polygon(PolygonClipper::Vatti)) => {
                let area = rules.vatti(&all, mask, op, rule);
                area.map(|area| Made { area, ..Made::default() })
            }
            _ => rules.overlay(&all, mask, op, rule),
        };
        let joined = joined.map_err(|e| self.fail(e))?;
        self.report.snapped += joined.snapped as u64;
        let mut writer = None;
        if let Some(geometry) = joined.area.into_geometry() {
            let srid = self.report.srids.common();
            let mut joined = Feature { srid, ..Feature::of_geometry(geometry) };
            self.put(&mut writer, &mut joined)?;
        }
        self.end(writer)
    }
}
