//! The fuzz targets for clipping and rasterizing, run on their seeds and on random bytes.

use crate::overlay::validity;
use proptest::prelude::*;
use std::path::Path;

#[path = "../../../../fuzz/bodies/clip.rs"]
mod clip;
#[path = "../../../../fuzz/bodies/raster.rs"]
mod raster;

/// Runs a target on the files of its folder of seeds; there must be some.
fn seeds(target: &str, body: impl Fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds").join(target);
    let files = std::fs::read_dir(&folder).expect("seeds are part of the repository");
    let mut paths: Vec<_> = files.map(|f| f.expect("a file").path()).collect();
    paths.sort();
    assert!(!paths.is_empty(), "{}", folder.display());
    for path in paths {
        body(&std::fs::read(&path).expect("a seed"));
    }
}

fn overlay(bytes: &[u8]) {
    clip::overlay_laws(bytes, validity::check);
}

#[test]
fn seeds_of_lines_polygons_and_overlays() {
    seeds("line", clip::line);
    seeds("polygon", clip::polygon);
    seeds("overlay", overlay);
}

#[test]
fn seeds_of_paths_and_seed_fills() {
    seeds("raster", raster::raster);
    seeds("seed_fill", raster::seed_fill);
}

fn bytes(most: usize) -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec(any::<u8>(), 0..most)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn lines_of_any_bytes(bytes in bytes(256)) {
        clip::line(&bytes);
    }

    #[test]
    fn polygons_of_any_bytes(bytes in bytes(256)) {
        clip::polygon(&bytes);
    }

    #[test]
    fn overlays_of_any_bytes(bytes in bytes(256)) {
        overlay(&bytes);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn paths_of_any_bytes(bytes in bytes(512)) {
        raster::raster(&bytes);
    }

    #[test]
    fn seed_fills_of_any_bytes(bytes in bytes(512)) {
        raster::seed_fill(&bytes);
    }
}
