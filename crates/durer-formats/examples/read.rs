//! Reads a model and prints its contents, the time taken, and the repairs made.
//!
//! `cargo run --release --example read -- model.stl`

use durer_formats::{NoResources, ReadOptions, read_model};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let name = std::env::args().nth(1).ok_or("usage: read MODEL")?;
    let bytes = std::fs::read(&name)?;
    let start = Instant::now();
    let model = read_model(&bytes, &name, &NoResources, &ReadOptions::default())?;
    let seconds = start.elapsed().as_secs_f64();
    let speed = bytes.len() as f64 / 1e6 / seconds;
    let count = model.scene.triangle_count();
    println!("{}: {count} triangles in {:.1} ms, {speed:.0} MB/s", model.format, seconds * 1e3);
    model.warnings.iter().for_each(|w| println!("warning: {w}"));
    Ok(())
}
