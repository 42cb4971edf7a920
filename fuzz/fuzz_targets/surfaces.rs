#![no_main]

#[path = "../bodies/surfaces.rs"]
mod surfaces;

libfuzzer_sys::fuzz_target!(|data: &[u8]| surfaces::body(data));
