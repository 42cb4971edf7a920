#![no_main]
#![allow(dead_code)]

#[path = "../bodies/arguments.rs"]
mod arguments;
#[path = "../bodies/words.rs"]
mod words;

libfuzzer_sys::fuzz_target!(|data: &[u8]| arguments::arguments(data));
