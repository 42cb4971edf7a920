//! `durer clip --tiles`: to a file per tile, or to a sequence of features.

use super::report::Counts;
use super::{Job, rules};
use crate::failure::Failure;
use crate::layer::failure;
use crate::places::is_stream;
use crate::tiles::{BrokenOff, Stopped};
use durer::clip::tiles::{Reach, Subject, Tile, Tiling};
use durer::parallel;
use durer_formats::geo::{Feature, GeoFormat, Geometry, Member, Writer};
use std::collections::BTreeSet;

impl Job<'_> {
    /// Cuts each feature by the tiles that it touches.
    pub fn tile(&mut self, zoom: u8) -> Result<(), Failure> {
        let tiling = Tiling::new(zoom, self.args.region.tile_coordinates.into());
        if self.to == GeoFormat::GeoJson && !is_stream(&self.args.output) {
            return self.tile_files(&tiling);
        }
        if self.to == GeoFormat::GeoJson {
            self.to = GeoFormat::GeoJsonSeq;
        }
        self.tile_sequence(&tiling)
    }

    /// Writes the pieces feature by feature, and within each feature tile by tile.
    fn tile_sequence(&mut self, tiling: &Tiling) -> Result<(), Failure> {
        let (mut writer, mut seen) = (None, BTreeSet::new());
        let limit = self.args.region.max_tiles;
        let mut first = 0;
        loop {
            let features = self.batch()?;
            if features.is_empty() {
                break;
            }
            let subjects = self.subjects(tiling, &features, first);
            let of_one = |subject: &Subject<'_>| {
                let one = std::slice::from_ref(subject);
                let count = tiling.count(one, limit)?;
                crate::tiles::too_many(count, limit).map_err(Stopped::Written)?;
                let mut pieces = Vec::new();
                let take = |tile, parts: Vec<(usize, Geometry)>| {
                    pieces.extend(parts.into_iter().map(|(_, geometry)| (tile, geometry)));
                    Ok::<_, Stopped>(())
                };
                tiling.visit(one, |_, parts| parts, take).map(|()| pieces)
            };
            let cuts = parallel::of_each(&subjects, of_one);
            for (subject, pieces) in subjects.iter().zip(cuts) {
                let pieces = pieces.map_err(|stopped| self.of_tiling(tiling, stopped))?;
                self.report.repaired += u64::from(subject.is_repaired());
                let feature = &features[subject.index() - first];
                let own = feature.members.iter().any(|member| member.name == TILE);
                self.report.replaced += u64::from(own && !pieces.is_empty());
                for (tile, geometry) in pieces {
                    seen.insert(tile);
                    crate::tiles::too_many(seen.len() as u64, limit)?;
                    self.put(&mut writer, &mut with_tile(feature, geometry, tile))?;
                }
            }
            first += features.len();
        }
        self.report.tiles = Some(seen.len() as u64);
        self.end(writer)
    }

    /// Writes the pieces tile by tile, each tile to a separate file, `z/x/y.geojson`.
    fn tile_files(&mut self, tiling: &Tiling) -> Result<(), Failure> {
        let mut features = Vec::new();
        loop {
            let batch = self.batch()?;
            if batch.is_empty() {
                break;
            }
            features.extend(batch);
        }
        let subjects = self.subjects(tiling, &features, 0);
        let limit = self.args.region.max_tiles;
        let count = tiling.count(&subjects, limit);
        crate::tiles::too_many(count.map_err(|e| self.of_tiling(tiling, e.into()))?, limit)?;
        let make = |_: Tile, parts: Vec<(usize, Geometry)>| {
            let mut counts = Counts::default();
            let mut writer = Writer::new(GeoFormat::GeoJson, Vec::new());
            for (index, geometry) in parts {
                let feature = Feature { geometry: Some(geometry), ..features[index].clone() };
                counts.add(feature.geometry.as_ref());
                writer.write(&feature)?;
            }
            Ok((writer.finish(&[])?, counts))
        };
        let suffix = GeoFormat::GeoJson.suffixes()[0];
        let (mut out, mut written) = (Counts::default(), Vec::new());
        let folder = &self.args.output;
        let take = |tile: Tile, made: durer_formats::Result<(Vec<u8>, Counts)>| {
            let (bytes, counts) = made.map_err(|e| Stopped::Written(failure(folder, &e)))?;
            crate::tiles::deliver(folder, tile, suffix, &bytes).map_err(Stopped::Written)?;
            out.join(&counts);
            written.push(tile);
            Ok(())
        };
        let done = tiling.visit(&subjects, make, take);
        let done = done.map_err(|stopped| self.of_tiling(tiling, stopped));
        self.report.broken_off =
            done.as_ref().err().map(|failure| BrokenOff::new(failure, &written, suffix));
        let repaired = |subject: &&Subject<'_>| subject.is_repaired();
        self.report.repaired += subjects.iter().filter(repaired).count() as u64;
        self.report.out.join(&out);
        self.report.tiles = Some(written.len() as u64);
        done
    }

    /// Returns the features within the range of tiles; records the others.
    fn subjects<'a>(
        &mut self,
        tiling: &'a Tiling,
        features: &'a [Feature],
        first: usize,
    ) -> Vec<Subject<'a>> {
        let mut subjects = Vec::new();
        for (feature, index) in features.iter().zip(first..) {
            let Some(geometry) = &feature.geometry else { continue };
            let reach = tiling.reach(geometry);
            self.report.beyond += u64::from(reach == Reach::BeyondLatitudes);
            self.report.too_far += u64::from(reach == Reach::TooFar);
            if reach != Reach::TooFar {
                subjects.push(Subject::new(tiling, index, geometry, rules(self.args, feature)));
            }
        }
        subjects
    }

    fn of_tiling(&self, tiling: &Tiling, stopped: Stopped) -> Failure {
        match (stopped, tiling.failed()) {
            (Stopped::Written(failure), _) => failure,
            (Stopped::Cut(error), None) => self.fail(error),
            (Stopped::Cut(error), Some(index)) => self.of_feature(index as u64, &error),
        }
    }
}

/// The member that names a feature's tile, as JSON writes it.
const TILE: &str = "\"tile\"";

/// Returns the part of a feature in a tile, with a member that names the tile.
fn with_tile(feature: &Feature, geometry: Geometry, tile: Tile) -> Feature {
    let mut feature = Feature { geometry: Some(geometry), ..feature.clone() };
    feature.members.retain(|member| member.name != TILE);
    let value = format!("\"{tile}\"");
    feature.members.push(Member { name: TILE.to_owned(), value });
    feature
}
