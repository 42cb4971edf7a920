#![no_main]
#![allow(dead_code)]

#[path = "../bodies/model.rs"]
mod model;

libfuzzer_sys::fuzz_target!(|data: &[u8]| model::fbx(data));
