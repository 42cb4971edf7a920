//! The pictures of docs/algorithms for two dimensions, curves and lines: each panel a step, or some
//! steps, as a tracer was told them.
//!
//! `cargo run --example step_pictures -- docs/algorithms`

mod curves;
mod hidden;
mod lessons;
mod pixels;
mod polygons;
#[path = "../algorithm_pictures/scene.rs"]
mod scene;
mod sketch;
mod strokes;

type Picture = (&'static str, durer::Result<String>);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    for &(lesson, example) in lessons::SHEETS {
        std::fs::write(format!("{folder}/{lesson}.svg"), lessons::sheet((lesson, example))?)?;
    }
    let pictures: [&[fn() -> Picture]; 5] =
        [polygons::ALL, pixels::ALL, curves::ALL, hidden::ALL, strokes::ALL];
    for picture in pictures.into_iter().flatten() {
        let (name, svg) = picture();
        std::fs::write(format!("{folder}/{name}.svg"), svg?)?;
    }
    Ok(())
}
