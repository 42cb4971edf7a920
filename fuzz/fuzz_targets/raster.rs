#![no_main]
#![allow(dead_code)]

#[path = "../bodies/raster.rs"]
mod raster;

libfuzzer_sys::fuzz_target!(|data: &[u8]| raster::raster(data));
