#![no_main]

#[path = "../bodies/drawing.rs"]
mod drawing;

/// Lets the reader catch panics of usvg and of the paths that it outlines; all others end the process, as libFuzzer's hook has it.
fn let_usvg_panic() {
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        let file = panic.location().map_or("", |at| at.file());
        if !["/usvg-", "/tiny-skia-path-"].iter().any(|of| file.contains(of)) {
            hook(panic);
        }
    }));
}

libfuzzer_sys::fuzz_target!(init: let_usvg_panic(), |data: &[u8]| drawing::drawing(data));
