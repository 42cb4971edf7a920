//! `durer dissolve`.

use super::{FilesArgs, Job};
use crate::clip::MIXED;
use crate::failure::Failure;
use crate::layer;
use clap::Args;
use durer::clip::mask::{Rules, Union};
use durer::parallel;
use durer::work::Work;
use durer_formats::geo::{Feature, Member};
use std::collections::BTreeMap;

pub const EXAMPLES: &str = "\
Examples:
  durer dissolve counties.geojson --by STATE -o states.geojson
  durer dissolve parcels.shp --by owner,use -o holdings.fgb
  durer dissolve lakes.geojson -o one.geojson

Features with equal values of all fields become one, in the order of their first feature; without --by, all features \
become one. The result keeps these fields, and `count` is the number of its features. Polygons are joined: borders \
between them vanish, and overlaps count once. Lines and points are collected unchanged.

Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong usage; 3 features were left out by \
--skip-failures.";

/// The options of `durer dissolve`.
#[derive(Debug, Args)]
pub struct DissolveArgs {
    /// Join features with equal values of these fields
    #[arg(long, value_name = "FIELD,…", value_delimiter = ',')]
    pub by: Vec<String>,
    /// Input and output.
    #[command(flatten)]
    pub files: FilesArgs,
}

/// Features that become one.
#[derive(Default)]
struct Group {
    /// The values of its fields, `null` if there is none.
    fields: Vec<Member>,
    count: u64,
    union: Union,
    srid: Option<i32>,
}

/// Joins a file's features.
pub fn run(args: &DissolveArgs) -> Result<(), Failure> {
    let mut job = Job::new(&args.files)?;
    let (mut groups, mut places) = (Vec::new(), BTreeMap::new());
    let (mut missing, mut mixed) = (args.by.clone(), false);
    loop {
        let features = job.batch(super::BATCH)?;
        if features.is_empty() {
            break;
        }
        let clean = |(number, f): &(u64, Feature)| {
            let rules =
                Rules { fill: f.fill_rule, grid: None, work: args.files.running.work.clone() };
            let made = f.geometry.as_ref().map(|g| rules.clean(g)).transpose();
            made.map_err(|e| (*number, e))
        };
        let cleaned = parallel::of_each(&features, clean);
        for ((_, feature), made) in features.into_iter().zip(cleaned) {
            let made = made.map_err(|(n, e)| job.fail(format!("feature {n}: {e}")))?;
            layer::keep(&feature, &args.files.running.work).map_err(|e| job.fail(e))?;
            let own = feature.fields();
            missing.retain(|name| !own.iter().any(|field| field.key() == *name));
            let fields: Vec<Member> = args.by.iter().map(|name| value(&own, name)).collect();
            let key: Vec<String> = fields.iter().map(|field| field.value.clone()).collect();
            let place = *places.entry(key).or_insert_with(|| {
                groups.push(Group { fields, srid: feature.srid, ..Group::default() });
                groups.len() - 1
            });
            let group: &mut Group = &mut groups[place];
            group.count += 1;
            let repaired = made.as_ref().is_some_and(|made| made.repaired);
            *job.report.repaired.get_or_insert(0) += u64::from(repaired);
            if let (Some(geometry), Some(made)) = (&feature.geometry, made) {
                mixed |= group.union.add(geometry, &made.area);
            }
        }
    }
    if job.report.given.features > 0 && !missing.is_empty() {
        job.report.warnings.push(format!("no feature has the field {}", missing.join(", ")));
    }
    if mixed {
        job.report.warnings.push(MIXED.to_owned());
    }
    let repaired = job.report.repaired.unwrap_or(0);
    if repaired > 0 {
        job.report.warnings.push(super::fix::repair_note(repaired));
    }
    let into_feature = |group: Group| group.into_feature(&args.files.running.work);
    let features = parallel::map(groups, into_feature).into_iter();
    let features = features.collect::<durer::Result<_>>().map_err(|e| job.fail(e))?;
    job.write(features)
}

/// Returns the value of a field, `null` if there is none.
fn value(own: &[Member], name: &str) -> Member {
    let found = own.iter().find(|field| field.key() == name).cloned();
    found.unwrap_or_else(|| Member::new(name, "null".to_owned()))
}

impl Group {
    fn into_feature(mut self, work: &Work) -> durer::Result<Feature> {
        let geometry = self.union.finish(work)?;
        let mut feature = Feature { geometry, srid: self.srid, ..Feature::default() };
        self.fields.push(Member::new("count", self.count.to_string()));
        feature.set_fields(&self.fields);
        Ok(feature)
    }
}
