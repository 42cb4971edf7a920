#![no_main]
#![allow(dead_code)]

#[path = "../bodies/clip.rs"]
mod clip;

#[path = "../../crates/durer/tests/it/overlay/validity.rs"]
mod validity;

libfuzzer_sys::fuzz_target!(|data: &[u8]| clip::overlay_laws(data, validity::check));
