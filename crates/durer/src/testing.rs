//! Numbers, scenes and cameras for the tests of the library.

use crate::math::{DMat4, DVec3, Vec3};
use crate::scene::{Camera, Instance, Mesh, Projection, Scene};

/// Pseudo-random numbers, the same on every machine.
pub struct Numbers(pub u32);

impl Numbers {
    /// Returns a number from 0 to below 1.
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as f32 / 16_777_216.0
    }

    /// Returns a number from −1 to below 1.
    pub fn signed(&mut self) -> f32 {
        self.unit() * 2.0 - 1.0
    }

    /// Returns a whole number below `count`.
    pub fn below(&mut self, count: u32) -> u32 {
        ((self.unit() * count as f32) as u32).min(count - 1)
    }

    /// Returns a vector of three numbers from −1 to below 1.
    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.signed(), self.signed(), self.signed())
    }
}

/// Returns a mesh where it was made.
pub fn instance(mesh: usize) -> Instance {
    Instance { mesh, world_from_mesh: DMat4::IDENTITY, name: String::new() }
}

/// Returns a scene of one mesh.
pub fn scene_of(mesh: Mesh) -> Scene {
    Scene { meshes: vec![mesh], instances: vec![instance(0)], ..Scene::default() }
}

/// Returns a camera that looks at the origin from a point, y upwards.
pub fn camera(eye: DVec3, projection: Projection) -> Camera {
    let (target, up) = (DVec3::ZERO, DVec3::Y);
    Camera { eye, target, up, projection, near: 0.1, far: 100.0 }
}

/// Returns a [`camera`] in perspective.
pub fn camera_at(x: f64, y: f64, z: f64) -> Camera {
    camera(DVec3::new(x, y, z), Projection::Perspective { fov_y: 0.7 })
}
