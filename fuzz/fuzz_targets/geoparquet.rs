#![no_main]
#![allow(dead_code)]

#[path = "../bodies/caught.rs"]
mod caught;
#[path = "../bodies/geo.rs"]
mod geo;
#[path = "../bodies/words.rs"]
mod words;

libfuzzer_sys::fuzz_target!(init: caught::let_panic(&["parquet", "arrow"]), |data: &[u8]| geo::geoparquet(data));
