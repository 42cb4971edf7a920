#![no_main]

#[path = "../bodies/caught.rs"]
mod caught;
#[path = "../bodies/drawing.rs"]
mod drawing;

libfuzzer_sys::fuzz_target!(init: caught::let_panic(&["usvg", "tiny-skia-path"]), |data: &[u8]| drawing::drawing(data));
