#![no_main]
#![allow(dead_code)]

#[path = "../bodies/plot.rs"]
mod plot;
#[path = "../bodies/words.rs"]
mod words;

libfuzzer_sys::fuzz_target!(|data: &[u8]| plot::height_map(data));
