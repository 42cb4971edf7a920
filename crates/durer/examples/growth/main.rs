//! The growth of the work of visible-surface methods with triangles and pixels, counted in steps.
//!
//! `cargo run --release --example growth -- docs/algorithms`

mod chart;
mod terrain;

use chart::{Axis, Chart};
use durer::visibility::surface::SurfaceMethod;
use durer_formats::png::{Compression, write_color};
use terrain::{steps, terrain};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    // Cells along each side of the surface, pixels along each side of the picture.
    for (name, sizes) in [
        ("triangles", [8, 16, 32, 64].map(|n| (n, 128))),
        ("pixels", [32, 64, 128, 256].map(|side| (16, side))),
    ] {
        let title = format!("{name}, four times as many each time; up: steps, tenfold");
        let places = sizes.map(|(n, side)| match name {
            "triangles" => (2 * n * n).to_string(),
            _ => format!("{side} x {side}"),
        });
        let mut curves = Vec::new();
        for &method in SurfaceMethod::ALL.iter().filter(|m| **m != SurfaceMethod::ZBuffer) {
            let counts = sizes.iter().map(|&(n, side)| steps(method, &terrain(n), side));
            let counts = counts.collect::<durer::Result<Vec<f64>>>()?;
            println!("{name} {method}: {counts:?}");
            curves.push((method.name(), counts));
        }
        let all = curves.iter().flat_map(|(_, counts)| counts.iter().copied());
        let range = [all.clone().fold(f64::MAX, f64::min), all.fold(0.0, f64::max)];
        let mut chart = Chart::new(&title, Axis { range, places: places.to_vec() })?;
        curves.iter().try_for_each(|(name, counts)| chart.curve(name, counts))?;
        let file = std::fs::File::create(format!("{folder}/growth_{name}.png"))?;
        write_color(file, &chart.picture()?, Compression::Small)?;
    }
    Ok(())
}
