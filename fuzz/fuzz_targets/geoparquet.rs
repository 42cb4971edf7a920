#![no_main]
#![allow(dead_code)]

#[path = "../bodies/geo.rs"]
mod geo;
#[path = "../bodies/words.rs"]
mod words;

libfuzzer_sys::fuzz_target!(|data: &[u8]| geo::geoparquet(data));
