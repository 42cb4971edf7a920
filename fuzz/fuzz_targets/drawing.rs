#![no_main]

#[path = "../bodies/drawing.rs"]
mod drawing;

// The hook that libFuzzer has been given ends the process also where a panic is caught, as usvg's are.
libfuzzer_sys::fuzz_target!(init: drop(std::panic::take_hook()), |data: &[u8]| drawing::drawing(data));
