//! A thousand random scenes through all methods, and drawn as lines and regions: the fuzz targets without the fuzzer.

#[path = "../../../../fuzz/bodies/drawn.rs"]
mod drawn;
#[path = "../../../../fuzz/bodies/surfaces.rs"]
mod surfaces;

use crate::scenes::Numbers;
use std::path::Path;

fn bytes(seed: u64) -> Vec<u8> {
    let mut numbers = Numbers(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(1));
    let length = 40 + (numbers.next() * 700.0) as usize;
    (0..length).map(|_| (numbers.next() * 256.0) as u8).collect()
}

/// A quarter of the thousand, so that the parts run in parallel.
fn quarter(k: u64) {
    (250 * k..250 * (k + 1)).for_each(|seed| surfaces::body(&bytes(seed)));
}

#[test]
fn all_methods_agree_on_a_thousand_scenes_1() {
    quarter(0);
}

#[test]
fn all_methods_agree_on_a_thousand_scenes_2() {
    quarter(1);
}

#[test]
fn all_methods_agree_on_a_thousand_scenes_3() {
    quarter(2);
}

#[test]
fn all_methods_agree_on_a_thousand_scenes_4() {
    quarter(3);
}

#[test]
fn all_methods_agree_at_odd_sizes() {
    for (seed, (width, height)) in
        (5000..).zip([(1, 1), (1, 2048), (2048, 1), (3, 700), (700, 3), (65, 64), (513, 130)])
    {
        surfaces::compare(&bytes(seed), width, height);
    }
}

#[test]
fn all_methods_agree_on_a_large_picture() {
    surfaces::compare(&bytes(77)[..200], 2048, 2048);
}

#[test]
fn lines_of_random_scenes_are_sound() {
    (0..200).for_each(|seed| drawn::lines(&bytes(seed)));
}

#[test]
fn regions_of_random_scenes_are_sound() {
    (0..200).for_each(|seed| drawn::regions(&bytes(seed)));
}

#[test]
fn seeds_of_surfaces_lines_and_regions() {
    let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds");
    for target in ["surfaces", "lines", "regions"] {
        let body = match target {
            "surfaces" => surfaces::body,
            "lines" => drawn::lines,
            _ => drawn::regions,
        };
        let files =
            std::fs::read_dir(seeds.join(target)).expect("seeds are part of the repository");
        let read = |f: std::io::Result<std::fs::DirEntry>| std::fs::read(f.expect("a file").path());
        let all: Vec<_> = files.map(|f| read(f).expect("a seed")).collect();
        assert!(!all.is_empty(), "{target}");
        all.iter().for_each(|seed| body(seed));
    }
}

#[test]
fn any_bytes_do() {
    for data in [&[][..], &[0], &[255; 3], &[7; 4000]] {
        surfaces::body(data);
        drawn::lines(data);
        drawn::regions(data);
    }
}
