//! The scene that all in-process contenders draw: camera, light and colours of the llvmpipe harness.

use crate::mesh::Mesh;
use vek::{Mat4, Vec3};

/// Width of a frame in pixels.
pub const WIDTH: usize = 1920;
/// Height of a frame in pixels.
pub const HEIGHT: usize = 1080;
/// Vertical angle of view, radians.
#[expect(clippy::approx_constant, reason = "the harness's own number, for the same pixels")]
pub const FOV_Y: f64 = 0.7854;
/// Direction to the light, view space, of unit length up to rounding.
pub const LIGHT: [f64; 3] = [0.4364, 0.4364, 0.7868];
/// Light that comes from everywhere, times the surface's colour.
pub const AMBIENT: [f32; 3] = [0.08, 0.08, 0.10];
/// Diffuse colour of the surface.
pub const DIFFUSE: [f32; 3] = [0.7, 0.55, 0.35];
/// Specular colour of the surface.
pub const SPECULAR: f32 = 0.4;
/// Exponent of n·h.
pub const SHININESS: f32 = 32.0;
/// Colour of the background.
pub const BACKGROUND: [f32; 3] = [0.1, 0.1, 0.12];
/// Frames before the clock runs.
pub const WARM: usize = 3;
/// Frames in one turn of a contender.
pub const FRAMES: usize = 5;
/// The frame whose picture is compared: the last one.
pub const LAST: usize = WARM + FRAMES - 1;

/// Placement of the mesh and distance of the eye.
pub struct Place {
    /// Middle of the mesh's box, world space.
    pub center: [f64; 3],
    /// From there to the eye.
    pub distance: f64,
}

impl Place {
    /// Returns the mesh seen whole, as near as the harness comes with a zoom of 1.25.
    pub fn of(mesh: &Mesh) -> Self {
        let bound = |f: fn(f32, f32) -> f32, k: usize| {
            f64::from(mesh.positions.iter().map(|p| p[k]).reduce(f).unwrap_or(0.0))
        };
        let (min, max) =
            ([0, 1, 2].map(|k| bound(f32::min, k)), [0, 1, 2].map(|k| bound(f32::max, k)));
        let center = std::array::from_fn(|k| (min[k] + max[k]) / 2.0);
        let radius = (0..3).map(|k| (max[k] - min[k]).powi(2)).sum::<f64>().sqrt() / 2.0;
        Self { center, distance: radius / (FOV_Y / 2.0).sin() * 0.85 / 1.25 }
    }

    /// Returns the near plane's distance from the eye.
    pub fn near(&self) -> f64 {
        self.distance * 0.05
    }

    /// Returns the far plane's distance from the eye.
    pub fn far(&self) -> f64 {
        self.distance * 4.0
    }

    /// Returns the mesh turned before the eye as it is in a frame.
    pub fn view_from_world(&self, frame: usize) -> Mat4<f32> {
        let to_center = Vec3::from(self.center.map(|c| -c as f32));
        // The camera turns the other way round the mesh than the mesh before the camera.
        let away = Vec3::new(0.0, 0.0, -self.distance as f32);
        Mat4::<f32>::translation_3d(away)
            * Mat4::<f32>::rotation_y(angle(frame) as f32)
            * Mat4::<f32>::translation_3d(to_center)
    }
}

/// Returns the angle of the mesh in a frame, radians; half a degree more in each.
pub fn angle(frame: usize) -> f64 {
    0.6 + 0.5 * 0.01745 * frame as f64
}
