//! How the work of visible-surface methods grows with triangles and with pixels, counted in steps.
//!
//! `cargo run --release --example growth -- docs/algorithms`

use durer::curve::{Path, stroke_font};
use durer::math::{DMat4, DVec2, DVec3, Vec3};
use durer::raster::{line::wide::Stroke, paint::Canvas};
use durer::scene::{Camera, Instance, Mesh, Projection, Scene};
use durer::target::{Framebuffer, Pixels};
use durer::trace::Recorder;
use durer::visibility::surface::method::{Options, SurfaceMethod, render_with};
use durer::visibility::surface::{Cull, input::SurfaceInput, setup::Filter};

/// A bumpy surface of 2 n² triangles that faces the eye.
fn terrain(n: u32) -> Scene {
    let height = |x: f64, y: f64| 0.3 * libm::sin(7.0 * x) * libm::cos(6.0 * y + x);
    let at = |i: u32| f64::from(i) / f64::from(n) * 2.0 - 1.0;
    let point = |i, j| DVec3::new(at(i), at(j), height(at(i), at(j))).as_vec3();
    let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
    let positions: Vec<Vec3> = cells
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
            [a, b, c, a, c, d]
        })
        .collect();
    let instance = Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() };
    Scene {
        meshes: vec![Mesh { positions, ..Mesh::default() }],
        instances: vec![instance],
        ..Scene::default()
    }
}

fn steps(method: SurfaceMethod, scene: &Scene, side: u32) -> durer::Result<f64> {
    let projection = Projection::Perspective { fov_y: 0.7 };
    let (eye, target, up) = (DVec3::new(0.9, -1.6, 2.0), DVec3::ZERO, DVec3::Y);
    let camera = Camera { eye, target, up, projection, near: 0.5, far: 6.0 };
    let view = durer::view::View::new(camera, side, side)?;
    let input = SurfaceInput::new(scene, &view, Filter { cull: Cull::None, sample_reach: 128 })?;
    let (mut counts, mut picture) = (Recorder::with_cap(1), Framebuffer::new(side, side));
    let lights = durer::shade::PreparedLights::of(scene, &camera);
    render_with(method, &input, &lights, &Options::default(), &mut picture, &mut counts)?;
    Ok((counts.steps().len() + counts.dropped()) as f64)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    for (name, sizes) in [
        ("triangles", [8, 16, 32, 64].map(|n| (n, 128))),
        ("pixels", [32, 64, 128, 256].map(|s| (16, s))),
    ] {
        let mut canvas = Canvas::new(560, 340, Default::default())?;
        let pen = |c: &mut Canvas, path: &Path, ink| {
            c.stroke(path, &Stroke { width: 1.6, ..Stroke::default() }, &ink, 1.0)
        };
        let text = |c: &mut Canvas, text: &str, at: DVec2, ink: durer::raster::paint::Paint| {
            stroke_font::line(text, 10.0).strokes.into_iter().try_for_each(|s| {
                pen(c, &Path::polyline(s.into_iter().map(|p| p + at)), ink.clone())
            })
        };
        let black = durer::raster::paint::Paint::Color([20, 20, 30, 255]);
        pen(
            &mut canvas,
            &Path::polyline([(50., 20.), (50., 300.), (380., 300.)].map(DVec2::from)),
            black.clone(),
        )?;
        text(
            &mut canvas,
            &format!("{name}, four times as many each time; up: steps, tenfold"),
            DVec2::new(50., 328.),
            black.clone(),
        )?;
        for (k, &method) in
            SurfaceMethod::ALL.iter().filter(|m| **m != SurfaceMethod::ZBuffer).enumerate()
        {
            let counts: durer::Result<Vec<f64>> =
                sizes.iter().map(|&(n, side)| steps(method, &terrain(n), side)).collect();
            let counts = counts?;
            println!("{name} {method}: {counts:?}");
            let place = |(i, c): (usize, &f64)| {
                DVec2::new(60.0 + 100.0 * i as f64, 300.0 - 60.0 * (libm::log10(*c) - 2.0))
            };
            let ink = durer::raster::paint::Paint::Color([
                (k * 97 % 200) as u8,
                (k * 151 % 180) as u8,
                (k * 61 % 220) as u8,
                255,
            ]);
            pen(&mut canvas, &Path::polyline(counts.iter().enumerate().map(place)), ink.clone())?;
            text(&mut canvas, method.name(), DVec2::new(395.0, 40.0 + 26.0 * k as f64), ink)?;
        }
        let mut picture = Pixels::new(560, 340, [255; 4]);
        canvas.render(&mut picture)?;
        let file = std::fs::File::create(format!("{folder}/growth_{name}.png"))?;
        durer_formats::png::write_color(file, &picture, durer_formats::png::Compression::Small)?;
    }
    Ok(())
}
