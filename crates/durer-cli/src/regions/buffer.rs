//! `durer buffer`.

use super::{FilesArgs, Job};
use crate::failure::Failure;
use crate::values;
use clap::{Args, ValueEnum};
use durer::clip::mask::Area;
use durer::clip::polygon::{Shapes, WindingRule};
use durer::raster::line::wide::buffer::{self, Options};
use durer::raster::line::wide::{Cap, Join};
use durer_formats::geo::crs::Crs;
use durer_formats::geo::{Feature, Geometry};
use durer_formats::wording::counted;

pub const EXAMPLES: &str = "\
Examples:
  durer buffer roads.geojson --distance 12 -o corridors.geojson
  durer buffer parcels.fgb --distance -2.5 --join miter -o buildable.fgb
  durer buffer wells.csv --distance 500 --dissolve -o protected.geojson

The distance is in units of the coordinates: convert longitude and latitude to metres first, with durer clip --to-crs. \
A negative distance shrinks polygons. Heights and measures are not kept.

Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong usage; 3 features were left out by \
--skip-failures.";

/// The options of `durer buffer`.
#[derive(Debug, Args)]
pub struct BufferArgs {
    /// Distance that the result extends beyond the input, in units of the coordinates
    #[arg(short, long, value_name = "D", allow_hyphen_values = true, value_parser = values::number)]
    pub distance: f64,
    /// Shape of corners
    #[arg(long, value_name = "JOIN", default_value = "round")]
    pub join: JoinName,
    /// Shape of the ends of lines, and of points
    #[arg(long, value_name = "CAP", default_value = "round")]
    pub cap: CapName,
    /// Cut off corners that reach farther than this, in multiples of the distance
    #[arg(long, value_name = "L", default_value = "5", value_parser = values::positive)]
    pub miter_limit: f64,
    /// Largest distance between arcs and the polygons that approximate them, in units of the coordinates
    /// [default: a thousandth of the distance]
    #[arg(long, value_name = "T", value_parser = values::positive)]
    pub tolerance: Option<f64>,
    /// Join all features into one
    #[arg(long)]
    pub dissolve: bool,
    /// Input and output.
    #[command(flatten)]
    pub files: FilesArgs,
}

/// `--join`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum JoinName {
    /// Arcs
    Round,
    /// Sharp
    Miter,
    /// Cut off straight
    Bevel,
}

/// `--cap`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CapName {
    /// Half circles; points become discs
    Round,
    /// Straight, at the end; points vanish
    Butt,
    /// Straight, a distance beyond the end; points become squares
    Square,
}

impl BufferArgs {
    fn options(&self) -> Options {
        let join = match self.join {
            JoinName::Round => Join::Round,
            JoinName::Miter => Join::Miter,
            JoinName::Bevel => Join::Bevel,
        };
        let cap = match self.cap {
            CapName::Round => Cap::Round,
            CapName::Butt => Cap::Butt,
            CapName::Square => Cap::Square,
        };
        let (distance, tolerance) = (self.distance, self.tolerance);
        let work = self.files.running.work.clone();
        Options { distance, join, cap, miter_limit: self.miter_limit, tolerance, work }
    }
}

/// Makes buffers of a file's features.
pub fn run(args: &BufferArgs) -> Result<(), Failure> {
    if args.miter_limit < 1.0 {
        return Err(Failure::Usage("--miter-limit: at least 1".to_owned()));
    }
    let mut job = Job::new(&args.files)?;
    let options = args.options();
    let degrees = Crs::of_system(&job.reader.system()).is_ok_and(|crs| crs.is_geographic());
    if degrees {
        let message = "coordinates are degrees, and so is the distance; durer clip --to-crs brings them to metres";
        job.report.warnings.push(message.to_owned());
    }
    let one = |feature: &Feature, geometry: &Geometry| {
        buffer::of_geometry(geometry, feature.fill_rule, &options)
    };
    if !args.dissolve {
        let geometry = |f: &Feature, g: &Geometry| Ok((Area::flat(one(f, g)?).into_geometry(), ()));
        return job.each(geometry, |_, feature, _, ()| feature.fill_rule = WindingRule::EvenOdd);
    }
    let mut all = Shapes::new();
    loop {
        let features = job.batch(super::BATCH)?;
        if features.is_empty() {
            break;
        }
        for (number, feature) in &features {
            let Some(geometry) = &feature.geometry else { continue };
            let made = one(feature, geometry);
            all.append(&made.map_err(|e| job.fail(format!("feature {number}: {e}")))?);
        }
    }
    let whole = Area::flat(all).union(&options.work).map_err(|e| job.fail(e))?;
    let given = job.report.given.features;
    if whole.shapes.is_empty() && given > 0 {
        let given = counted(given, "feature", "features");
        job.report.warnings.push(format!("nothing is left of {given}"));
    }
    let features = whole.into_geometry().map(Feature::of_geometry).into_iter().collect();
    job.write(features)
}
