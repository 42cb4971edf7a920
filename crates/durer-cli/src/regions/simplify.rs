//! `durer simplify`.

use super::{FilesArgs, Job};
use crate::failure::Failure;
use crate::values;
use clap::{ArgGroup, Args};
use durer::clip::simplify::{self, Amount, Dropped, LineSimplifier};
use durer_formats::geo::{Feature, Geometry};
use durer_formats::wording::agreeing;
use serde::{Serialize, Serializer};

pub const EXAMPLES: &str = "\
Examples:
  durer simplify countries.geojson --tolerance 0.05 -o coarse.geojson
  durer simplify parcels.geojson --keep 10% -o light.geojson
  durer simplify roads.geojsonl --each --tolerance 2 --method douglas-peucker -o -

Borders that neighbours share point by point are simplified once and stay shared. Lines and borders that do not cross \
before do not cross afterwards, and every ring keeps at least three points. Properties, ids and members are kept, and \
so are the heights and measures of the remaining points.

Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong usage; 3 features were left out by \
--skip-failures.";

/// The options of `durer simplify`.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("amount").required(true))]
pub struct SimplifyArgs {
    /// Largest distance that lines may move, in units of the coordinates: with douglas-peucker, the distance of
    /// removed points; with visvalingam, the side of a square with the area of the removed triangles
    #[arg(long, value_name = "T", group = "amount", allow_hyphen_values = true, value_parser = values::not_negative)]
    pub tolerance: Option<f64>,
    /// Keep this share of the points that can be removed, e.g. 10%
    #[arg(long, value_name = "P%", group = "amount", allow_hyphen_values = true, value_parser = share)]
    pub keep: Option<f64>,
    /// douglas-peucker (keeps the farthest points) or visvalingam (removes the smallest triangles)
    #[arg(long, value_name = "NAME", default_value = "visvalingam")]
    pub method: LineSimplifier,
    /// Remove rings that then enclose less than this, in squared units of the coordinates; a polygon is removed with
    /// its outer ring, and a feature with its last polygon
    #[arg(long, value_name = "AREA", allow_hyphen_values = true, value_parser = values::not_negative)]
    pub drop_below: Option<f64>,
    /// Simplify each feature separately, as a stream; borders between features may come apart
    #[arg(long)]
    pub each: bool,
    /// Input and output.
    #[command(flatten)]
    pub files: FilesArgs,
}

/// Returns a share in percent.
fn share(text: &str) -> Result<f64, String> {
    let percent = values::not_negative(text.strip_suffix('%').unwrap_or(text))?;
    if percent > 100.0 {
        return Err("at most 100% can be kept".to_owned());
    }
    Ok(percent / 100.0)
}

/// Additional figures in `--json`.
#[derive(Debug, Default, Serialize)]
pub struct Simplified {
    method: &'static str,
    /// Tolerance for all features together.
    #[serde(skip_serializing_if = "Option::is_none")]
    tolerance: Option<f64>,
    #[serde(serialize_with = "of_dropped")]
    dropped: Dropped,
}

impl Simplified {
    /// Returns a message about faults of the input.
    pub fn warning(&self) -> Option<String> {
        let n = self.dropped.degenerate;
        let words = "{ring of fewer than three different points, or line of fewer than two, is|rings of fewer than three different points, or lines of fewer than two, are} left out";
        (n > 0).then(|| agreeing(n, words))
    }
}

/// Simplifies one file.
pub fn run(args: &SimplifyArgs) -> Result<(), Failure> {
    let mut job = Job::new(&args.files)?;
    let least = args.drop_below.unwrap_or(0.0);
    let mut simplified = Simplified { method: args.method.name(), ..Simplified::default() };
    if args.each {
        job.report.simplified = Some(simplified);
        let one = |_: &Feature, geometry: &Geometry| {
            let (mut left, mut dropped) = (geometry.clone(), Dropped::default());
            simplify(&mut [&mut left], args)?;
            Ok((dropped.left(left, least), dropped))
        };
        return job.each(one, |report, _, _, dropped| {
            report.simplified.get_or_insert_default().dropped.add(dropped);
        });
    }
    let mut features = job.batch(usize::MAX)?;
    let mut all: Vec<_> = features.iter_mut().filter_map(|(_, f)| f.geometry.as_mut()).collect();
    simplified.tolerance = Some(simplify(&mut all, args).map_err(|e| job.fail(e))?);
    let mut left = Vec::with_capacity(features.len());
    for (_, mut feature) in features {
        let had = feature.geometry.is_some();
        feature.geometry = feature.geometry.and_then(|g| simplified.dropped.left(g, least));
        if had && feature.geometry.is_none() {
            job.gone += 1;
        } else {
            left.push(feature);
        }
    }
    job.report.simplified = Some(simplified);
    job.write(left)
}

/// Simplifies geometries together; returns the tolerance.
fn simplify(geometries: &mut [&mut Geometry], args: &SimplifyArgs) -> durer::Result<f64> {
    let tolerance = Amount::Tolerance(args.tolerance.unwrap_or(f64::INFINITY));
    simplify::simplify(geometries, args.method, args.keep.map_or(tolerance, Amount::Keep))
}

fn of_dropped<S: Serializer>(dropped: &Dropped, serializer: S) -> Result<S::Ok, S::Error> {
    let counts = [("small_rings", dropped.small_rings), ("degenerate", dropped.degenerate)];
    serializer.collect_map(counts)
}
