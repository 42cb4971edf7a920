#![no_main]
#![allow(dead_code)]

#[path = "../bodies/caught.rs"]
mod caught;
#[path = "../bodies/gltf_made.rs"]
mod gltf_made;
#[path = "../bodies/model.rs"]
mod model;

libfuzzer_sys::fuzz_target!(init: caught::let_panic(&["draco-core"]), |data: &[u8]| gltf_made::gltf_made(data));
