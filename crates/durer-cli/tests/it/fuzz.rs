//! The fuzz targets for options and annotations, run on their seeds and on random bytes.

#[path = "../../../../fuzz/bodies/arguments.rs"]
mod bodies;
#[path = "../../../../fuzz/bodies/words.rs"]
mod words;

use std::path::Path;

/// Calls a target's function with its seeds and with prefixes of them.
fn with_seeds(target: &str, body: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds").join(target);
    let files = std::fs::read_dir(&folder).expect("seeds are part of the repository");
    for file in files {
        let seed = std::fs::read(file.expect("a file").path()).expect("a seed");
        (0..=8).for_each(|i| body(&seed[..seed.len() * i / 8]));
    }
}

/// Returns pseudo-random bytes, the same on every run.
fn bytes(seed: u64, count: usize) -> Vec<u8> {
    let mut state = seed;
    let mut next = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 56) as u8
    };
    (0..count).map(|_| next()).collect()
}

#[test]
fn any_options_are_parsed() {
    with_seeds("arguments", bodies::arguments);
    (0..60).for_each(|seed| bodies::arguments(&bytes(seed, 120)));
}

#[test]
fn any_annotations_are_parsed() {
    with_seeds("annotations", bodies::annotations);
    (0..300).for_each(|seed| bodies::annotations(&bytes(seed, 120)));
}
