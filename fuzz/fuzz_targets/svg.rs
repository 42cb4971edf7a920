#![no_main]
#![allow(dead_code)]

#[path = "../bodies/geo.rs"]
mod geo;

libfuzzer_sys::fuzz_target!(|data: &[u8]| geo::svg(data));
