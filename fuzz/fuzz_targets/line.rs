#![no_main]
#![allow(dead_code)]

#[path = "../bodies/clip.rs"]
mod clip;

libfuzzer_sys::fuzz_target!(|data: &[u8]| clip::line(data));
