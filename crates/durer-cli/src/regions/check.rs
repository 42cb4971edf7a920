//! `durer check`.

use crate::failure::Failure;
use crate::input::display_name;
use crate::layer::{Condition, FieldArgs, Fields, condition, none_meets, open, words};
use crate::messages::Messages;
use crate::options::RunningArgs;
use crate::values;
use clap::{Args, ValueHint};
use durer::clip::mask::Area;
use durer::clip::polygon::Shapes;
use durer::clip::polygon::mismatch::misfits;
use durer::clip::polygon::validity::flaws;
use durer_formats::geo::{GeoFormat, Geometry, Points};
use durer_formats::wording::counted;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

pub const EXAMPLES: &str = "\
Examples:
  durer check parcels.geojson
  durer check parcels.geojson --coverage --gap-width 0.5
  durer check countries.shp --json | jq .faults[0]

A polygon is valid as in OGC Simple Features: rings neither cross nor touch themselves and touch one another in points \
only, holes are inside the outer ring, and the interior is connected. A layer is a coverage if no two features overlap \
and neighbours have the same points on their shared border.

Repairs and omissions made while reading the file count as `reading`.

Exit codes: 0 no faults; 1 faults, or the file cannot be read; 2 wrong usage.";

/// The options of `durer check`.
#[derive(Debug, Args)]
pub struct CheckArgs {
    /// A layer: GeoJSON (also one feature per line), WKT, WKB, Shapefile, FlatGeobuf and others; `-` reads standard
    /// input
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath)]
    pub input: PathBuf,
    /// The format of IN [default: by its content, then by its suffix]
    #[arg(long, value_name = "FORMAT", value_parser = crate::layer::format)]
    pub from: Option<GeoFormat>,
    /// The layer of a TopoJSON or GeoPackage file; of an archive, the file or FILE/LAYER [default: all, as one]
    #[arg(long, value_name = "NAME")]
    pub layer: Option<String>,
    /// Check features whose field satisfies a condition: FIELD=VALUE; also !=, <, <=, >, >= and ~ (contains, ignoring
    /// case)
    ///
    /// If there are several, all must hold. Numbers are compared as numbers; a VALUE in quotes is a text.
    #[arg(long = "where", value_name = "FIELD=VALUE", value_parser = condition)]
    pub conditions: Vec<Condition>,
    /// Also compare neighbouring features: overlaps, and points that only one of two neighbours has
    #[arg(long)]
    pub coverage: bool,
    /// Also report holes between features that are narrower than this, in units of the coordinates
    #[arg(long, value_name = "W", requires = "coverage", value_parser = values::positive)]
    pub gap_width: Option<f64>,
    /// Report at most this many faults; all are counted
    #[arg(long, value_name = "N", default_value = "20")]
    pub most: usize,
    /// Threads and messages.
    #[command(flatten)]
    pub running: RunningArgs,
    /// Write the faults to standard output as JSON
    #[arg(long, help_heading = "Running")]
    pub json: bool,
}

/// Something that is wrong.
#[derive(Debug, Serialize)]
struct Found {
    /// The feature, counted from 1.
    feature: u64,
    /// The other feature, for faults between two.
    #[serde(skip_serializing_if = "Option::is_none")]
    other: Option<u64>,
    fault: &'static str,
    #[serde(skip)]
    words: &'static str,
    /// A place of it.
    at: [f64; 2],
}

/// Report of `--json`.
#[derive(Debug, Default, Serialize)]
struct Report {
    version: &'static str,
    input: String,
    /// Features that were checked.
    features: u64,
    /// Features that are not valid.
    invalid: u64,
    /// True if all are valid, and with --coverage are a coverage.
    valid: bool,
    /// Number of faults of each kind.
    counts: BTreeMap<&'static str, u64>,
    faults: Vec<Found>,
    warnings: Vec<String>,
}

/// Reports the faults of a file's features.
pub fn run(args: &CheckArgs) -> Result<(), Failure> {
    let messages = Messages::new(&args.running, 1);
    let name = display_name(&args.input);
    let fail = |what: String| Failure::Data(format!("{name}: {what}"));
    let chosen = args.layer.as_deref();
    let (_, mut reader) = open(&args.input, args.from, chosen, &args.running.work)?;
    // A broken feature is a fault like others.
    reader.skip_failures();
    let version = env!("CARGO_PKG_VERSION");
    let mut report = Report { version, input: name.clone(), ..Report::default() };
    let (mut layer, mut numbers): (Vec<Shapes>, Vec<u64>) = (Vec::new(), Vec::new());
    let conditions = args.conditions.clone();
    let mut fields = Fields::new(&FieldArgs { conditions, ..FieldArgs::default() });
    let mut number = 0;
    while let Some(mut feature) = reader.next_feature().map_err(|e| fail(words(&e)))? {
        number += 1;
        messages.progress.stage(|| format!("{number} features"));
        if !fields.apply(&mut feature) {
            continue;
        }
        report.features += 1;
        let Some(geometry) = &feature.geometry else { continue };
        let before = report.faults_counted();
        let mut parts = Vec::new();
        each_part(geometry, &mut parts);
        for part in parts {
            let found = flaws(&part).map_err(|e| fail(format!("feature {number}: {e}")))?;
            for flaw in found {
                let (fault, words) = (flaw.fault.name(), flaw.fault.words());
                let found =
                    Found { feature: number, other: None, fault, words, at: flaw.at.into() };
                report.add(found, args.most);
            }
        }
        report.add_lines(geometry, number, args.most);
        report.invalid += u64::from(report.faults_counted() > before);
        if args.coverage {
            layer.push(Area::of_geometry(geometry).shapes);
            numbers.push(number);
        }
    }
    if args.coverage {
        for misfit in misfits(&layer, args.gap_width).map_err(|e| fail(e.to_string()))? {
            let [feature, other] = misfit.features.map(|i| numbers[i]);
            let (fault, words) = (misfit.mismatch.name(), misfit.mismatch.words());
            let other = (other != feature).then_some(other);
            report.add(Found { feature, other, fault, words, at: misfit.at.into() }, args.most);
        }
    }
    messages.warnings(&name, reader.warnings());
    report.warnings = reader.warnings().iter().map(ToString::to_string).collect();
    let none = (report.features == 0 && number > 0).then(|| none_meets(number));
    for message in fields.warning().into_iter().chain(none) {
        messages.warning(&name, &message);
        report.warnings.push(message);
    }
    // Features mended or left out during reading count as faults, too.
    let mended = reader.warnings().iter().filter(|warning| !reader.is_note(warning)).count();
    let skipped = reader.skipped().saturating_sub(1);
    let mended = mended as u64 + reader.further_warnings() + skipped;
    if mended > 0 {
        report.counts.insert("reading", mended);
    }
    report.valid = report.counts.is_empty();
    drop(messages);
    if args.json {
        crate::report::print(&report)?;
    } else {
        report.print();
    }
    if report.valid { Ok(()) } else { Err(Failure::Data(report.sum())) }
}

/// Collects the polygons of each part of a geometry, the members of collections separately.
fn each_part(geometry: &Geometry, parts: &mut Vec<Shapes>) {
    match geometry {
        Geometry::Collection(members) => members.iter().for_each(|part| each_part(part, parts)),
        Geometry::Polygon(_) | Geometry::MultiPolygon(_) => {
            parts.push(Area::of_geometry(geometry).shapes);
        }
        _ => {}
    }
}

impl Report {
    fn add(&mut self, found: Found, most: usize) {
        *self.counts.entry(found.fault).or_default() += 1;
        if self.faults.len() < most {
            self.faults.push(found);
        }
    }

    /// Returns the number of faults that have a place.
    fn faults_counted(&self) -> u64 {
        self.counts.iter().filter(|(kind, _)| **kind != "reading").map(|(_, n)| n).sum()
    }

    /// Adds the lines that have no length.
    fn add_lines(&mut self, geometry: &Geometry, feature: u64, most: usize) {
        let mut line = |line: &Points| {
            let first = line.xy.first().copied().filter(|p| line.xy.iter().all(|q| q == p));
            if let Some(at) = first {
                let (fault, words) = ("no-length", "a line has no length");
                self.add(Found { feature, other: None, fault, words, at: at.into() }, most);
            }
        };
        match geometry {
            Geometry::LineString(points) => line(points),
            Geometry::MultiLineString(lines) => lines.iter().for_each(line),
            Geometry::Collection(parts) => {
                parts.iter().for_each(|part| self.add_lines(part, feature, most));
            }
            _ => {}
        }
    }

    /// Prints the faults, one per line.
    fn print(&self) {
        for found in &self.faults {
            let [x, y] = found.at;
            let feature = match found.other {
                Some(other) => format!("features {} and {other}", found.feature),
                None => format!("feature {}", found.feature),
            };
            println!("{feature}: {} at {x} {y}", found.words);
        }
        let more = self.faults_counted() - self.faults.len() as u64;
        if more > 0 {
            println!("and {more} more; --most prints more of them");
        }
        if self.valid {
            let features = counted(self.features, "feature", "features");
            println!("{}: {features}, nothing is wrong", self.input);
        }
    }

    /// Returns the numbers of faults by kind, in one line.
    fn sum(&self) -> String {
        let counts: Vec<String> = self.counts.iter().map(|(f, n)| format!("{n} {f}")).collect();
        let total = counted(self.features, "feature", "features");
        let (invalid, verb) = (self.invalid, if self.invalid == 1 { "is" } else { "are" });
        let counts = counts.join(", ");
        format!("{}: {invalid} of {total} {verb} not valid; faults: {counts}", self.input)
    }
}
