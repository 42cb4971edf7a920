//! The pictures of docs/algorithms: visible-surface methods at work.
//!
//! `cargo run --example algorithm_pictures -- docs/algorithms`

mod back_faces;
mod overlay;
mod scene;

use durer::shade::PreparedLights;
use durer::target::Framebuffer;
use durer::trace::{NoTrace, Recorder};
use durer::view::View;
use durer::visibility::surface::{Cull, SurfaceInput, TriangleFilter, depth_sort};
use durer::visibility::surface::{Options, SurfaceMethod, render_with};
use durer_formats::png::{Compression, write_color};

const SIZE: [u32; 2] = [288, 216];

/// Returns the picture by a method, with its steps over it.
fn picture(method: SurfaceMethod, input: &SurfaceInput<'_>) -> durer::Result<Framebuffer> {
    let (mut steps, mut row) = (Recorder::default(), 0);
    let mut picture = Framebuffer::new(SIZE[0], SIZE[1]);
    let lights = PreparedLights::of(input.scene, input.view.camera());
    render_with(method, input, &lights, &Options::default(), &mut picture, &mut steps)?;
    steps.steps().iter().for_each(|step| overlay::draw(step, &mut row, &mut picture.color));
    if method == SurfaceMethod::DepthSort {
        for polygon in depth_sort::order(input, &mut NoTrace)? {
            overlay::outline(&polygon.outline(input), &mut picture.color);
        }
    }
    Ok(picture)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let (scene, camera) = (scene::scene(), scene::camera());
    let view = View::new(camera, SIZE[0], SIZE[1])?;
    let input = SurfaceInput::new(&scene, &view, TriangleFilter::new(Cull::None, 128))?;
    let write = |name: &str, picture: &Framebuffer| {
        let file = std::fs::File::create(format!("{folder}/{name}.png"))?;
        write_color(file, &picture.color, Compression::Small)
    };
    for &method in SurfaceMethod::ALL {
        write(method.name(), &picture(method, &input)?)?;
    }
    write("back-face-removal", &back_faces::picture(&camera, SIZE)?)?;
    Ok(())
}
