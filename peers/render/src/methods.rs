//! durer's ways to find visible surfaces beside its z-buffer.

use crate::clock::{Cost, measure, median_cost, ratio};
use crate::options::Options;
use crate::{Result, table};
use durer::math::{DMat4, DVec3, Vec3};
use durer::pipeline::Samples;
use durer::scene::{Camera, Instance, Mesh, Projection, Scene};
use durer::shade::PreparedLights;
use durer::target::Framebuffer;
use durer::trace::NoTrace;
use durer::view::View;
use durer::visibility::surface::ray::PrimaryRays;
use durer::visibility::surface::{
    self, Cull, SurfaceInput, SurfaceMethod, TriangleFilter, render_with,
};
use std::path::Path;

const SIDE: u32 = 1024;

/// Degrees between top and bottom of the picture.
const FOV_Y: f64 = 30.0;

/// Measures all methods on each model, one thread.
pub fn run(options: &Options) -> Result<()> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let default =
        [format!("{}/meshes/3DBenchy.stl", std::env::var("DURER_DATA").unwrap_or_default())];
    let names = if options.names.is_empty() { &default[..] } else { &options.names };
    table::head(&["model", "what", "CPU ms", "CPU / z-buffer's"]);
    for name in names {
        let scene = read_stl(name.as_ref())?;
        // Errors of this workspace cannot go from thread to thread.
        pool.install(|| contest(name, &scene, options.rounds).map_err(|e| e.to_string()))?;
    }
    Ok(())
}

/// Returns the triangles of a binary STL file.
pub fn read_stl(path: &Path) -> Result<Scene> {
    let bytes = std::fs::read(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let number = |b: &[u8]| b.try_into().map_or(0.0, f32::from_le_bytes);
    let corner = |b: &[u8]| Vec3::new(number(&b[..4]), number(&b[4..8]), number(&b[8..]));
    let records = bytes.get(84..).unwrap_or_default().chunks_exact(50);
    let positions = records.flat_map(|r| [12, 24, 36].map(|at| corner(&r[at..at + 12]))).collect();
    let mesh = Mesh { positions, ..Mesh::default() };
    let instance = Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() };
    Ok(Scene { meshes: vec![mesh], instances: vec![instance], ..Scene::default() })
}

/// Returns the whole model from one side; `rays.py` has the same.
fn camera(scene: &Scene) -> Result<Camera> {
    let bounds = scene.bounds().ok_or("the model is empty")?;
    let (center, extent) = ((bounds.min + bounds.max) * 0.5, (bounds.max - bounds.min).length());
    Ok(Camera {
        eye: center + DVec3::new(0.6, -0.7, 0.45).normalize() * (extent * 2.0),
        target: center,
        up: DVec3::Z,
        projection: Projection::Perspective { fov_y: FOV_Y.to_radians() },
        near: extent * 0.1,
        far: extent * 4.0,
    })
}

fn contest(name: &str, scene: &Scene, rounds: usize) -> Result<()> {
    let camera = camera(scene)?;
    let view = View::new(camera, SIDE, SIDE)?;
    let lights = PreparedLights::of(scene, &camera);
    let mut costs: Vec<Vec<Cost>> = vec![Vec::new(); SurfaceMethod::ALL.len()];
    let mut rays: [Vec<Cost>; 2] = Default::default();
    let mut finer: [Vec<Cost>; 2] = Default::default();
    let mut hits = 0;
    for _ in 0..=rounds {
        for (&method, costs) in SurfaceMethod::ALL.iter().zip(&mut costs) {
            let work = || picture(method, Samples::One, scene, &view, &lights);
            let (result, cost) = measure(work);
            result?;
            costs.push(cost);
        }
        for (samples, costs) in [Samples::Four, Samples::Sixteen].into_iter().zip(&mut finer) {
            let work = || picture(SurfaceMethod::ZBuffer, samples, scene, &view, &lights);
            let (result, cost) = measure(work);
            result?;
            costs.push(cost);
        }
        let filter = TriangleFilter::new(Cull::None, 0);
        let input = SurfaceInput::new(scene, &view, filter)?;
        let (built, cost) = measure(|| PrimaryRays::new(&input));
        rays[0].push(cost);
        let (found, cost) = measure(|| built.hits().len());
        rays[1].push(cost);
        hits = found;
    }
    // The first round warms up.
    costs.iter_mut().chain(&mut rays).chain(&mut finer).for_each(|costs| {
        costs.remove(0);
    });
    let row = |what: &str, costs: &[Cost], base: &[Cost]| {
        let ms = format!("{:.1}", median_cost(costs).cpu * 1e3);
        table::row(&[
            name.into(),
            what.into(),
            ms,
            format!("{:.2}", ratio(costs, base, |c| c.cpu)),
        ]);
    };
    for (&method, own) in SurfaceMethod::ALL.iter().zip(&costs) {
        row(method.name(), own, &costs[0]);
    }
    row("z-buffer, 4 samples", &finer[0], &costs[0]);
    row("z-buffer, 16 samples", &finer[1], &costs[0]);
    row("primary rays: hierarchy", &rays[0], &costs[0]);
    row(&format!("primary rays: {} rays, {hits} hits", SIDE * SIDE), &rays[1], &costs[0]);
    Ok(())
}

fn picture(
    method: SurfaceMethod,
    samples: Samples,
    scene: &Scene,
    view: &View,
    lights: &PreparedLights,
) -> Result<Framebuffer> {
    let filter = TriangleFilter::new(Cull::None, method.sample_reach());
    // The production path makes no list of triangles.
    let nothing = Scene::default();
    let listed = if method == SurfaceMethod::ZBuffer { &nothing } else { scene };
    let mut input = SurfaceInput::new(listed, view, filter)?;
    input.scene = scene;
    let mut framebuffer = Framebuffer::new(SIDE, SIDE);
    let options = surface::Options { samples, ..Default::default() };
    render_with(method, &input, lights, &options, &mut framebuffer, &mut NoTrace)?;
    Ok(framebuffer)
}
