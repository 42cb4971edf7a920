//! The scenes of the pictures.

use durer::math::{DMat4, DVec3, Vec3};
use durer::scene::{Camera, Instance, Mesh, Projection, Scene};

/// Returns three cyclically overlapping beams, and a triangle through all of them.
pub fn scene() -> Scene {
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

pub fn camera() -> Camera {
    let (eye, target, up) = (DVec3::new(0.3, 0.5, 4.4), DVec3::ZERO, DVec3::Y);
    let projection = Projection::Perspective { fov_y: 0.7 };
    Camera { eye, target, up, projection, near: 2.0, far: 8.0 }
}
