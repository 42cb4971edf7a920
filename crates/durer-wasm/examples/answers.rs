//! Answers requests from standard input, one per line, and prints a checksum of each answer; `.ci/explorer` compares
//! them with those of the module.

use durer_wasm::{Answer, Engine};
use std::io::BufRead;

/// Returns a checksum (FNV-1a).
fn sum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

fn main() -> std::io::Result<()> {
    let mut engine = Engine::default();
    for line in std::io::stdin().lock().lines() {
        let (kind, bytes) = match engine.answer(line?.as_bytes()) {
            Answer::Json(text) => (0, text.into_bytes()),
            Answer::Bytes(bytes) => (1, bytes),
            Answer::Error(text) => (2, text.into_bytes()),
        };
        println!("{kind} {:016x} {}", sum(&bytes), bytes.len());
    }
    Ok(())
}
