#![no_main]
#![allow(dead_code)]

#[path = "../bodies/sheets.rs"]
mod sheets;
#[path = "../bodies/surfaces.rs"]
mod surfaces;

libfuzzer_sys::fuzz_target!(|data: &[u8]| sheets::marks(data));
