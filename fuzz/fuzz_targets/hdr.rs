#![no_main]
#![allow(dead_code)]

#[path = "../bodies/hdr.rs"]
mod hdr;

libfuzzer_sys::fuzz_target!(|data: &[u8]| hdr::hdr(data));
