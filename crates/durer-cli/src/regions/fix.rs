//! `durer fix`.

use super::{BATCH, FilesArgs, Job, Report};
use crate::failure::Failure;
use clap::Args;
use durer::clip::mask::{Rules, match_points};
use durer::clip::polygon::WindingRule;
use durer::parallel;
use durer_formats::geo::{Feature, Geometry};
use durer_formats::wording::counted;

pub const EXAMPLES: &str = "\
Examples:
  durer fix parcels.geojson -o valid.geojson
  durer fix outlines.wkt --rule non-zero -o filled.wkt
  durer fix counties.geojson --coverage -o matched.geojson

Valid features are not changed. Other polygons are replaced by valid ones that enclose the same points by the rule and \
keep heights and measures: crossing edges are cut, spikes and doubled rings vanish. durer check reports what is wrong \
and where.

Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong usage; 3 features were left out by \
--skip-failures.";

/// The options of `durer fix`.
#[derive(Debug, Args)]
pub struct FixArgs {
    /// Fill rule for crossing rings: even-odd, non-zero, positive (rings counter-clockwise), negative or abs-geq-two
    /// (two rings at least) [default: even-odd; of an SVG, the rule of its paths]
    #[arg(long, value_name = "RULE")]
    pub rule: Option<WindingRule>,
    /// Give neighbours the same points on shared borders: a point that only one of them has is added to the other if it
    /// is on the border up to the rounding of its coordinates
    ///
    /// All features are held in memory. Larger overlaps and gaps remain; durer check --coverage reports them.
    #[arg(long)]
    pub coverage: bool,
    /// Input and output.
    #[command(flatten)]
    pub files: FilesArgs,
}

/// Makes a file's features valid.
pub fn run(args: &FixArgs) -> Result<(), Failure> {
    let mut job = Job::new(&args.files)?;
    job.report.repaired = Some(0);
    if args.coverage {
        return match_all(job, args);
    }
    job.each(|feature, geometry| made(args, feature, geometry), note)
}

/// Returns a feature's geometry made valid, `None` if nothing of it is left; and whether it was
/// not.
fn made(
    args: &FixArgs,
    feature: &Feature,
    geometry: &Geometry,
) -> durer::Result<(Option<Geometry>, bool)> {
    let fill = args.rule.unwrap_or(feature.fill_rule);
    let work = args.files.running.work.clone();
    let fixed = Rules { fill, grid: None, work }.fix(geometry)?;
    Ok((fixed.geometry, fixed.changed))
}

/// Counts a feature that is valid now.
fn note(report: &mut Report, feature: &mut Feature, number: u64, changed: bool) {
    feature.fill_rule = WindingRule::EvenOdd;
    if changed {
        let count = report.repaired.get_or_insert(0);
        *count += 1;
        if *count == 1 {
            report.warnings.push(format!("feature {number} is the first that was repaired"));
        }
    }
}

/// Makes a file's features valid, and matches the points of neighbours.
fn match_all(mut job: Job<'_>, args: &FixArgs) -> Result<(), Failure> {
    let mut all = Vec::new();
    loop {
        let features = job.batch(BATCH)?;
        if features.is_empty() {
            break;
        }
        let fix = |(_, feature): &(u64, Feature)| {
            feature.geometry.as_ref().map(|geometry| made(args, feature, geometry)).transpose()
        };
        let fixed = parallel::of_each(&features, fix);
        for ((number, mut feature), made) in features.into_iter().zip(fixed) {
            let made = made.map_err(|e| job.fail(format!("feature {number}: {e}")))?;
            if let Some((geometry, changed)) = made {
                feature.geometry = geometry;
                note(&mut job.report, &mut feature, number, changed);
                if feature.geometry.is_none() {
                    job.gone += 1;
                    continue;
                }
            }
            all.push(feature);
        }
    }
    let count = with_matched_points(&mut all);
    if count > 0 {
        let features = counted(count as u64, "feature", "features");
        job.report.warnings.push(format!("{features} got points that their neighbours have"));
    }
    job.write(all)
}

/// Adds to polygons the points that neighbours have on their borders; returns the number of features changed.
fn with_matched_points(features: &mut [Feature]) -> usize {
    let mut geometries: Vec<_> = features.iter_mut().map(|f| f.geometry.take()).collect();
    let count = match_points(&mut geometries);
    features.iter_mut().zip(geometries).for_each(|(feature, g)| feature.geometry = g);
    count
}

/// Returns the message about features that were made valid.
pub fn repair_note(repaired: u64) -> String {
    let (one, several) = ("feature is not valid; it was", "features are not valid; they were");
    format!("{} made so by the even-odd rule, as durer fix does", counted(repaired, one, several))
}
