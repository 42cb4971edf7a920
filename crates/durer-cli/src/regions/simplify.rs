//! `durer simplify`.

use super::{FilesArgs, Job};
use crate::failure::Failure;
use crate::values;
use clap::{ArgGroup, Args};
use durer::clip::polygon::signed_area;
use durer::clip::simplify::coverage::Options;
use durer::clip::simplify::{Coverage, LineSimplifier, tolerance_for_share};
use durer::trace::NoTrace;
use durer_formats::geo::{Feature, Geometry, Points};
use serde::Serialize;

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
    /// Largest distance that lines may move, in units of the coordinates: by douglas-peucker the distance of points
    /// that are left out; by visvalingam the side of a square as large as the triangles that are
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
    dropped: Dropped,
}

impl Simplified {
    /// Returns the words for what the input should not have had.
    pub fn told(&self) -> Option<String> {
        let n = self.dropped.degenerate;
        let what =
            "rings of fewer than three different points, or lines of fewer than two, are left out";
        (n > 0).then(|| format!("{n} {what}"))
    }
}

/// Simplifies one file.
pub fn run(args: &SimplifyArgs) -> Result<(), Failure> {
    let mut job = Job::new(&args.files)?;
    let least = args.drop_below.unwrap_or(0.0);
    let mut told = Simplified { method: args.method.name(), ..Simplified::default() };
    if args.each {
        job.report.simplified = Some(told);
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
    told.tolerance = Some(simplify(&mut all, args).map_err(|e| job.fail(e))?);
    let mut left = Vec::with_capacity(features.len());
    for (_, mut feature) in features {
        let had = feature.geometry.is_some();
        feature.geometry = feature.geometry.and_then(|g| told.dropped.left(g, least));
        if had && feature.geometry.is_none() {
            job.gone += 1;
        } else {
            left.push(feature);
        }
    }
    job.report.simplified = Some(told);
    job.write(left)
}

/// Simplifies geometries together; returns the tolerance.
fn simplify(geometries: &mut [&mut Geometry], args: &SimplifyArgs) -> durer::Result<f64> {
    let mut coverage = Coverage::default();
    for geometry in geometries.iter_mut() {
        chains(geometry, &mut |points, closed| {
            let xy = points.xy.iter().copied();
            if closed { coverage.push_ring(xy) } else { coverage.push_line(xy) }
        });
    }
    let limit = args.tolerance.unwrap_or(f64::INFINITY);
    let options = Options { method: args.method, limit };
    let weights = coverage.weights(&options, &mut NoTrace)?;
    let tolerance = match args.keep {
        Some(share) => tolerance_for_share(&weights, share),
        None => limit,
    };
    let mut weights = weights.into_iter();
    let mut thin = |points: &mut Points, _: bool| {
        let mut left = Points::new(points.dimensions);
        for (i, weight) in (0..points.len()).zip(weights.by_ref()) {
            if weight > tolerance {
                left.push(points.xy[i], points.zm(i));
            }
        }
        *points = left;
    };
    geometries.iter_mut().for_each(|geometry| chains(geometry, &mut thin));
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

/// Runs of points that are left out.
#[derive(Debug, Default, Clone, Copy, Serialize)]
struct Dropped {
    /// Rings that enclose less than asked for.
    small_rings: u64,
    /// Rings of fewer than three points and lines of fewer than two, as the input had them but for repeated points.
    degenerate: u64,
}

impl Dropped {
    fn add(&mut self, other: Self) {
        self.small_rings += other.small_rings;
        self.degenerate += other.degenerate;
    }

    /// Returns whether a ring stays.
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

    /// Returns the rest of a geometry. A geometry that was empty before stays.
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
