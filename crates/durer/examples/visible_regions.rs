//! The visible parts of a bumpy sphere, divided exactly: `visible_regions 190 > bumps.svg`.
//!
//! The argument is the number of faces around; figures go to standard error.

use durer::math::{DMat4, Vec3};
use durer::scene::{Instance, Mesh, Scene, UpAxis};
use durer::shade::PreparedLights;
use durer::trace::NoTrace;
use durer::view::View;
use durer::view::projection::{FitOptions, Lens, ViewDirection, fit_box};
use durer::visibility::region::{Options, draw, planar_map};
use std::f64::consts::{PI, TAU};
use std::time::Instant;

fn bumps(n: u32) -> Mesh {
    let mut mesh = Mesh { indices: Some(Vec::new()), ..Mesh::default() };
    for (i, j) in (0..n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
        let (u, v) = (TAU * f64::from(i) / f64::from(n), PI * f64::from(j) / f64::from(n));
        let r = 1.0 + 0.1 * libm::sin(9.0 * u) * libm::sin(7.0 * v);
        let ring = r * libm::sin(v);
        let p = [ring * libm::cos(u), r * libm::cos(v), ring * libm::sin(u)];
        mesh.positions.push(Vec3::from(p.map(|c| c as f32)));
        let at = |i: u32, j: u32| i % n * (n + 1) + j;
        if let Some(indices) = mesh.indices.as_mut().filter(|_| j < n) {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            indices.extend([a, b, c, a, c, d]);
        }
    }
    mesh
}

fn main() -> durer::Result<()> {
    let n = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(60);
    let instance = Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() };
    let scene = Scene { meshes: vec![bumps(n)], instances: vec![instance], ..Scene::default() };
    let direction = ViewDirection::from_angles(30.0, 25.0, UpAxis::Y)?;
    let fit = FitOptions { lens: Lens::Orthographic, ..FitOptions::default() };
    let camera = fit_box(scene.bounds().as_ref(), &direction, &fit)?;
    let view = View::new(camera, 800, 800)?;
    let start = Instant::now();
    let map = planar_map::solve(&scene, &view, &Default::default(), &mut NoTrace)?;
    let (triangles, seconds) = (scene.triangle_count(), start.elapsed().as_secs_f64());
    eprintln!("{triangles} triangles: {seconds:.3} s, {:?} V, E, F, C", map.counts());
    let drawing = draw(&scene, &view, &PreparedLights::of(&scene, &camera), &Options::default())?;
    println!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='-1.3 -1.3 2.6 2.6'>");
    for region in &drawing.regions {
        let [r, g, b, _] = region.color;
        print!("<path fill='#{r:02x}{g:02x}{b:02x}' d='");
        for ring in &region.rings {
            let points: Vec<_> = ring.iter().map(|p| format!("{:.5} {:.5}", p.x, -p.y)).collect();
            print!("M{}Z", points.join("L"));
        }
        println!("'/>");
    }
    println!("</svg>");
    Ok(())
}
