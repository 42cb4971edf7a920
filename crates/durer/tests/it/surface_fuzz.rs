//! A thousand random scenes through all methods: the body of the fuzz target, without the fuzzer.

#[path = "../../../../fuzz/bodies/surfaces.rs"]
mod body;

use crate::scenes::Numbers;

fn bytes(seed: u64) -> Vec<u8> {
    let mut numbers = Numbers(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(1));
    let length = 40 + (numbers.next() * 700.0) as usize;
    (0..length).map(|_| (numbers.next() * 256.0) as u8).collect()
}

/// A quarter of the thousand, so that they run side by side.
fn quarter(k: u64) {
    (250 * k..250 * (k + 1)).for_each(|seed| body::body(&bytes(seed)));
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
        body::compare(&bytes(seed), width, height);
    }
}

#[test]
fn all_methods_agree_on_a_large_picture() {
    body::compare(&bytes(77)[..200], 2048, 2048);
}

#[test]
fn any_bytes_do() {
    for data in [&[][..], &[0], &[255; 3], &[7; 4000]] {
        body::body(data);
    }
}
