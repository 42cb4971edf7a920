//! `durer fix`.

use super::{FilesArgs, Job};
use crate::clip::{Area, Rules};
use crate::failure::Failure;
use clap::Args;
use durer::clip::polygon::FillRule;
use durer::clip::polygon::validity::{Touching, is_valid};
use durer_formats::geo::{Feature, Geometry};

pub const EXAMPLES: &str = "\
Examples:
  durer fix parcels.geojson -o valid.geojson
  durer fix outlines.wkt --rule non-zero -o filled.wkt

Features that are valid come out as they went in. Of the others, polygons that enclose the same points by the rule, \
with their heights and measures: edges that cross are cut there, spikes and doubled rings vanish. durer check says \
what is wrong and where.

Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong use.";

/// The options of `durer fix`.
#[derive(Debug, Args)]
pub struct FixArgs {
    /// Which points rings that cross enclose: even-odd, non-zero, positive (rings counter-clockwise) or negative
    /// [default: even-odd; of an SVG, what its paths say]
    #[arg(long, value_name = "RULE")]
    pub rule: Option<FillRule>,
    /// What is read and written.
    #[command(flatten)]
    pub files: FilesArgs,
}

/// Makes a file's features valid.
pub fn run(args: &FixArgs) -> Result<(), Failure> {
    let mut job = Job::new(&args.files)?;
    job.report.repaired = Some(0);
    let fix = |feature: &Feature, geometry: &Geometry| {
        let fill = args.rule.unwrap_or(feature.fill_rule);
        let mut changed = false;
        let geometry = fixed(geometry, &Rules { fill, grid: None }, &mut changed)?;
        Ok((geometry, changed))
    };
    let note = |report: &mut super::Report, feature: &mut Feature, number: u64, changed: bool| {
        feature.fill_rule = FillRule::EvenOdd;
        if changed {
            let count = report.repaired.get_or_insert(0);
            *count += 1;
            if *count == 1 {
                report.warnings.push(format!("feature {number} is the first that was repaired"));
            }
        }
    };
    job.each(fix, note)
}

/// What is said of features that were made valid on the way.
pub fn told(repaired: u64) -> String {
    format!(
        "{repaired} features are not valid; they were made so by the even-odd rule, as durer fix does"
    )
}

/// The geometry with valid polygons; `None` where nothing of it is left.
fn fixed(
    geometry: &Geometry,
    rules: &Rules,
    changed: &mut bool,
) -> durer::Result<Option<Geometry>> {
    match geometry {
        Geometry::Polygon(_) | Geometry::MultiPolygon(_) => {
            let area = Area::of_geometry(geometry);
            let plain = rules.fill == FillRule::EvenOdd;
            if plain && is_valid(&area.shapes, Touching::AtPoints) {
                return Ok(Some(geometry.clone()));
            }
            let made = rules.clean(geometry)?;
            *changed |= !is_valid(&area.shapes, Touching::AtPoints);
            Ok(made.area.into_geometry())
        }
        Geometry::Collection(parts) => {
            let parts = parts.iter().map(|part| fixed(part, rules, changed));
            let parts: durer::Result<Vec<Option<Geometry>>> = parts.collect();
            let parts: Vec<Geometry> = parts?.into_iter().flatten().collect();
            Ok((!parts.is_empty()).then_some(Geometry::Collection(parts)))
        }
        other => Ok(Some(other.clone())),
    }
}
