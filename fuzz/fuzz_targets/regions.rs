#![no_main]
#![allow(dead_code)]

#[path = "../bodies/drawn.rs"]
mod drawn;
#[path = "../bodies/surfaces.rs"]
mod surfaces;

libfuzzer_sys::fuzz_target!(|data: &[u8]| drawn::regions(data));
