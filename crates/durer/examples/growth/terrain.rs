//! The scenes rendered, and the number of steps that they take.

use durer::math::{DMat4, DVec3, Vec3};
use durer::scene::{Camera, Instance, Mesh, Projection, Scene};
use durer::target::Framebuffer;
use durer::trace::Recorder;
use durer::visibility::surface::{Cull, SurfaceInput, TriangleFilter};
use durer::visibility::surface::{Options, SurfaceMethod, render_with};

/// Returns a bumpy surface of 2 n² triangles that faces the eye.
pub fn terrain(n: u32) -> Scene {
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

/// Counts the steps of a method for a square picture of this many pixels per side.
pub fn steps(method: SurfaceMethod, scene: &Scene, side: u32) -> durer::Result<f64> {
    let projection = Projection::Perspective { fov_y: 0.7 };
    let (eye, target, up) = (DVec3::new(0.9, -1.6, 2.0), DVec3::ZERO, DVec3::Y);
    let camera = Camera { eye, target, up, projection, near: 0.5, far: 6.0 };
    let view = durer::view::View::new(camera, side, side)?;
    let input = SurfaceInput::new(scene, &view, TriangleFilter::new(Cull::None, 128))?;
    let (mut counts, mut picture) = (Recorder::with_cap(1), Framebuffer::new(side, side));
    let lights = durer::shade::PreparedLights::of(scene, &camera);
    render_with(method, &input, &lights, &Options::default(), &mut picture, &mut counts)?;
    Ok((counts.steps().len() + counts.dropped()) as f64)
}
