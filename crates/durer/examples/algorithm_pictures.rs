//! The pictures of docs/algorithms: what a visible-surface method is doing on the way.
//!
//! `cargo run --example algorithm_pictures -- docs/algorithms`

use durer::math::{DMat4, DVec3, IVec2, Vec3};
use durer::raster::line::{Options as LineOptions, bresenham};
use durer::scene::{Camera, Instance, Mesh, Projection, Scene};
use durer::shade::PreparedLights;
use durer::target::{Framebuffer, Pixels};
use durer::trace::{NoTrace, Recorder};
use durer::view::View;
use durer::visibility::surface::method::{Options, Step, SurfaceMethod, render_with};
use durer::visibility::surface::{Cull, depth_sort, input::SurfaceInput, setup::Filter};
use durer::visibility::surface::{scan_line_z as scan, spanning_scan_line as spanning, warnock};

/// Three beams, each over the next and under the one before, and a triangle through all of them.
fn scene() -> Scene {
    let corner = |i: usize, x: f64, y: f64, z: f64| {
        DMat4::from_rotation_z(i as f64 * std::f64::consts::TAU / 3.0)
            .transform_point3(DVec3::new(x, y, z))
            .as_vec3()
    };
    let beam = |i| {
        let [a, b] = [corner(i, -1.5, 0.4, -0.4), corner(i, -1.5, 0.75, -0.4)];
        let [c, d] = [corner(i, 1.5, 0.4, 0.4), corner(i, 1.5, 0.75, 0.4)];
        [a, c, b, b, c, d]
    };
    let mut positions: Vec<Vec3> = (0..3).flat_map(beam).collect();
    positions.extend([
        Vec3::new(-1.2, -0.9, 0.9),
        Vec3::new(1.3, -0.5, -0.9),
        Vec3::new(0.1, 1.3, 0.2),
    ]);
    let instance = Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() };
    Scene {
        meshes: vec![Mesh { positions, ..Mesh::default() }],
        instances: vec![instance],
        ..Scene::default()
    }
}

/// Lets a step be seen over the picture: windows, spans, polygons' outlines, the row of depths.
fn draw(step: &Step, row: &mut u32, p: &mut Pixels<[u8; 4]>) {
    let tint =
        |item: u32| [0, 8, 16].map(|s| 120 + (item.wrapping_mul(0x9e37_79b9) >> s & 0x7f) as u8);
    match *step {
        Step::Warnock(warnock::Step::Divide { window: w, x, y }) => {
            (w.y0..w.y1).for_each(|y| p.set(x as u32, y as u32, [20, 20, 30, 255]));
            (w.x0..w.x1).for_each(|x| p.set(x as u32, y as u32, [20, 20, 30, 255]));
        }
        Step::SpanningScanLine(spanning::Step::Row { y })
        | Step::ScanLineZ(scan::Step::Row { y }) => *row = y as u32,
        Step::SpanningScanLine(spanning::Step::Span { item, x0, x1 }) => {
            let [r, g, b] = tint(item);
            (x0..x1).for_each(|x| p.set(x as u32, *row, [r, g, b, 255]));
        }
        Step::ScanLineZ(scan::Step::Write { x, depth, .. }) => {
            let grey = ((1.0 - depth) * 800.0).clamp(0.0, 255.0) as u8;
            p.set(x as u32, *row, [grey, grey, grey, 255]);
        }
        _ => {}
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let (eye, target, up) = (DVec3::new(0.3, 0.5, 4.4), DVec3::ZERO, DVec3::Y);
    let projection = Projection::Perspective { fov_y: 0.7 };
    let camera = Camera { eye, target, up, projection, near: 2.0, far: 8.0 };
    let (scene, view) = (scene(), View::new(camera, 288, 216)?);
    let input = SurfaceInput::new(&scene, &view, Filter { cull: Cull::None, sample_reach: 128 })?;
    for &method in SurfaceMethod::ALL {
        let (mut steps, mut picture, mut row) =
            (Recorder::default(), Framebuffer::new(288, 216), 0);
        let lights = PreparedLights::of(&scene, &camera);
        render_with(method, &input, &lights, &Options::default(), &mut picture, &mut steps)?;
        steps.steps().iter().for_each(|step| draw(step, &mut row, &mut picture.color));
        if method == SurfaceMethod::DepthSort {
            for polygon in depth_sort::order(&input, &mut NoTrace) {
                let outline: Vec<IVec2> =
                    polygon.outline(&input).iter().map(|v| v.as_ivec2()).collect();
                for (&a, &b) in outline.iter().zip(outline.iter().cycle().skip(1)) {
                    let plot =
                        |q: IVec2| picture.color.set(q.x as u32, q.y as u32, [20, 20, 30, 255]);
                    bresenham::draw(a, b, &LineOptions::default(), plot, &mut NoTrace);
                }
            }
        }
        let file = std::fs::File::create(format!("{folder}/{method}.png"))?;
        durer_formats::png::write_color(
            file,
            &picture.color,
            durer_formats::png::Compression::Small,
        )?;
    }
    Ok(())
}
