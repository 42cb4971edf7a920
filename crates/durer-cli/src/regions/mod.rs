//! Commands that transform features: `durer simplify`, `durer buffer`, `durer dissolve`, `durer fix`; and `durer
//! check`, which reports their faults.

mod buffer;
mod check;
mod dissolve;
mod fix;
mod simplify;

pub use buffer::{BufferArgs, EXAMPLES as BUFFER, run as buffer};
pub use check::{CheckArgs, EXAMPLES as CHECK, run as check};
pub use dissolve::{DissolveArgs, EXAMPLES as DISSOLVE, run as dissolve};
pub use fix::{EXAMPLES as FIX, FixArgs, run as fix};
pub use simplify::{EXAMPLES as SIMPLIFY, SimplifyArgs, run as simplify};

use crate::clip::Counts;
use crate::failure::Failure;
use crate::input::display_name;
use crate::layer::{self, FieldArgs, Fields, Source, failure, late, named_format, words};
use crate::messages::Messages;
use crate::options::RunningArgs;
use crate::places::is_stream;
use clap::{Args, ValueHint};
use durer::parallel;
use durer_formats::geo::{Feature, GeoFormat, Geometry, System};
use durer_formats::wording::counted;
use serde::Serialize;
use simplify::Simplified;
use std::path::PathBuf;
use std::time::Instant;

/// Options for input and output.
#[derive(Debug, Args)]
pub struct FilesArgs {
    /// A layer: GeoJSON (also one feature per line), WKT, WKB, Shapefile, FlatGeobuf and others; `-` reads standard
    /// input
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath)]
    pub input: PathBuf,
    /// File to write the result to: its suffix selects the format; `-` for standard output, in the format of the input
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::FilePath)]
    pub output: PathBuf,
    /// The format of IN [default: by its content, then by its suffix]
    #[arg(long, value_name = "FORMAT", value_parser = crate::layer::format, help_heading = "Formats")]
    pub from: Option<GeoFormat>,
    /// The layer of a TopoJSON or GeoPackage file; of an archive, the file or FILE/LAYER [default: all, as one]
    #[arg(long, value_name = "NAME", help_heading = "Formats")]
    pub layer: Option<String>,
    /// The format of OUT [default: by its suffix]
    #[arg(long, visible_alias = "format", value_name = "FORMAT", value_parser = crate::layer::format, help_heading = "Formats")]
    pub to: Option<GeoFormat>,
    /// Features to keep.
    #[command(flatten)]
    pub fields: FieldArgs,
    /// Threads and messages.
    #[command(flatten)]
    pub running: RunningArgs,
    /// Write a report on standard output, in JSON: counts and areas in and out
    #[arg(long, help_heading = "Running")]
    pub json: bool,
}

/// Report of `--json`.
#[derive(Debug, Default, Serialize)]
struct Report {
    version: &'static str,
    input: String,
    output: String,
    from: &'static str,
    to: &'static str,
    #[serde(rename = "in")]
    given: Counts,
    out: Counts,
    /// Features that were changed because they were not valid.
    #[serde(skip_serializing_if = "Option::is_none")]
    repaired: Option<u64>,
    /// Report of `durer simplify`.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    simplified: Option<Simplified>,
    warnings: Vec<String>,
    total_seconds: f64,
    peak_memory_bytes: Option<u64>,
}

/// Features that are worked on at a time, on all threads.
const BATCH: usize = 256;

/// One run over a file.
struct Job<'a> {
    args: &'a FilesArgs,
    to: GeoFormat,
    reader: Source,
    fields: Fields,
    report: Report,
    /// Number of features of which nothing is left.
    gone: u64,
    messages: Messages,
    start: Instant,
}

impl<'a> Job<'a> {
    fn new(args: &'a FilesArgs) -> Result<Self, Failure> {
        let start = Instant::now();
        if args.json && is_stream(&args.output) {
            let message = "--json: the report goes to standard output, where the result goes too";
            return Err(Failure::Usage(message.to_owned()));
        }
        let messages = Messages::new(&args.running, 1);
        let (from, mut reader) =
            layer::open(&args.input, args.from, args.layer.as_deref(), &args.running.work)?;
        if args.fields.skip_failures {
            reader.skip_failures();
        }
        let to = named_format(&args.output, args.to, Some(from))?;
        let report = Report {
            version: env!("CARGO_PKG_VERSION"),
            input: display_name(&args.input),
            output: args.output.display().to_string(),
            from: from.name(),
            to: to.name(),
            ..Report::default()
        };
        let fields = Fields::new(&args.fields);
        Ok(Self { args, to, reader, fields, report, gone: 0, messages, start })
    }

    fn fail(&self, what: impl std::fmt::Display) -> Failure {
        Failure::Data(format!("{}: {what}", display_name(&self.args.input)))
    }

    /// Returns the next features that are kept, with their numbers in the file; at most `most`, none at
    /// the end.
    fn batch(&mut self, most: usize) -> Result<Vec<(u64, Feature)>, Failure> {
        let mut features = Vec::new();
        while features.len() < most {
            let next = self.reader.next_feature().map_err(|e| self.fail(words(&e)))?;
            let Some(mut feature) = next else { break };
            self.report.given.add(feature.geometry.as_ref());
            let number = self.report.given.features;
            if self.fields.apply(&mut feature) {
                if most > BATCH {
                    layer::keep(&feature, &self.args.running.work).map_err(|e| self.fail(e))?;
                }
                features.push((number, feature));
            }
        }
        let read = self.report.given.features;
        self.messages.progress.stage(|| format!("{read} features"));
        Ok(features)
    }

    /// Changes each geometry separately; features without a remaining geometry are left out. `note` gets the additional
    /// results of `change`.
    fn each<N: Send>(
        mut self,
        change: impl Fn(&Feature, &Geometry) -> durer::Result<(Option<Geometry>, N)> + Sync,
        mut note: impl FnMut(&mut Report, &mut Feature, u64, N),
    ) -> Result<(), Failure> {
        let (mut writer, mut stated) = (None, None);
        loop {
            let features = self.batch(BATCH)?;
            stated.get_or_insert_with(|| self.reader.system());
            if writer.is_some() && features.is_empty() {
                break;
            }
            let changed = parallel::of_each(&features, |(_, f)| {
                f.geometry.as_ref().map(|g| change(f, g)).transpose()
            });
            let writer = match &mut writer {
                Some(writer) => writer,
                none => none.insert(self.writer()?),
            };
            for ((number, mut feature), changed) in features.into_iter().zip(changed) {
                let had = feature.geometry.is_some();
                let changed = changed.map_err(|e| self.fail(format!("feature {number}: {e}")))?;
                if let Some((geometry, noted)) = changed {
                    feature.geometry = geometry;
                    note(&mut self.report, &mut feature, number, noted);
                }
                if feature.geometry.is_none() && had {
                    self.gone += 1;
                    continue;
                }
                self.report.out.add(feature.geometry.as_ref());
                writer.write(&feature).map_err(|e| failure(&self.args.output, &e))?;
            }
        }
        self.check_system(stated.as_ref())?;
        self.end(writer)
    }

    /// Refuses a system that the file states after the features, if the output states the one before.
    fn check_system(&self, stated: Option<&System>) -> Result<(), Failure> {
        match late(stated, &self.reader) {
            Some((why, option)) if self.to.states_system() => {
                Err(self
                    .fail(format!("{why}; durer clip {option} writes a file that states it first")))
            }
            _ => Ok(()),
        }
    }

    /// Writes these features, and nothing else.
    fn write(mut self, features: Vec<Feature>) -> Result<(), Failure> {
        let mut writer = self.writer()?;
        for feature in features {
            self.report.out.add(feature.geometry.as_ref());
            writer.write(&feature).map_err(|e| failure(&self.args.output, &e))?;
        }
        self.end(Some(writer))
    }

    fn writer(&self) -> Result<durer_formats::geo::Writer<layer::Sink>, Failure> {
        layer::writer(&self.args.output, self.to, self.reader.members(), self.reader.system())
    }

    fn end(
        mut self,
        writer: Option<durer_formats::geo::Writer<layer::Sink>>,
    ) -> Result<(), Failure> {
        let writer = match writer {
            Some(writer) => writer,
            None => self.writer()?,
        };
        let (args, messages) = (self.args, &self.messages);
        let lost = layer::finish(writer, &args.output, self.reader.members(), messages)?;
        let name = display_name(&args.input);
        messages.warnings(&name, self.reader.warnings());
        let own = std::mem::take(&mut self.report.warnings);
        let none =
            (self.report.given.features == 0).then(|| "there is no feature in it".to_owned());
        let (one, several) = (
            "feature has nothing left and is left out",
            "features have nothing left and are left out",
        );
        let gone = (self.gone > 0).then(|| counted(self.gone, one, several));
        let odd = self.report.simplified.as_ref().and_then(Simplified::warning);
        let more = [self.fields.warning(), none, odd, gone].into_iter().flatten();
        let own: Vec<String> = own.into_iter().chain(more).collect();
        own.iter().for_each(|warning| messages.warning(&name, warning));
        let read = self.reader.warnings().iter().map(ToString::to_string);
        self.report.warnings = lost.into_iter().chain(read).chain(own).collect();
        drop(self.messages);
        self.report.total_seconds = self.start.elapsed().as_secs_f64();
        self.report.peak_memory_bytes = crate::report::peak_memory();
        let printed = if args.json { crate::report::print(&self.report) } else { Ok(()) };
        let whole = if self.reader.skipped() > 0 { Err(Failure::Partial) } else { Ok(()) };
        printed.and(whole)
    }
}
