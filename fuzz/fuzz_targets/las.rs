#![no_main]
#![allow(dead_code)]

#[path = "../bodies/caught.rs"]
mod caught;
#[path = "../bodies/model.rs"]
mod model;

libfuzzer_sys::fuzz_target!(init: caught::let_panic(&["laz", "las"]), |data: &[u8]| model::las(data));
