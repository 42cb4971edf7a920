//! The row of pixels through the middle of a scene, as fragments of its faces.

use super::Scene;
use super::triangles::Triangles;
use crate::Result;
use crate::explain::input::Input;
use crate::math::{DVec2, DVec3};
use crate::raster::interpolate::{barycentric_2d, blend};
use crate::scene::{Camera, Projection};
use crate::sorting::CompactSort;

/// Points of faces behind the centres of a row's pixels.
#[derive(Clone)]
pub(in crate::explain) struct Row {
    scene: Scene,
    points: Vec<(usize, u32, f64)>,
    far: f64,
}

impl Row {
    /// Cuts the faces of an input.
    pub fn new(input: &Input) -> Result<Self> {
        let scene = Scene::new(input)?;
        let triangles = Triangles::new(&scene)?;
        let y = f64::from(scene.raster.rows / 2) + 0.5;
        let mut points = Vec::new();
        for (item, corners) in (0..).zip(&triangles.corners) {
            let flat = corners.map(|corner| corner.truncate());
            for x in 0..scene.raster.columns {
                let at = DVec2::new(f64::from(x) + 0.5, y);
                // On a common edge of two triangles the first one counts.
                let face = triangles.face(item);
                let is_new =
                    !points.iter().any(|(other, column, _)| (*other, *column) == (face, x));
                let weights = barycentric_2d(flat, at).filter(|all| all.iter().all(|w| *w >= 0.0));
                if let Some(weights) = weights.filter(|_| is_new) {
                    points.push((face, x, blend(weights, corners.map(|corner| corner.z))));
                }
            }
        }
        points.compact_sort_by_key(|(face, x, _)| (*face, *x));
        let deepest = triangles.corners.iter().flatten().map(|corner| corner.z).fold(0.8, f64::max);
        Ok(Self { scene, points, far: deepest * 1.25 })
    }

    /// Returns the number of columns.
    pub fn columns(&self) -> u32 {
        self.scene.raster.columns
    }

    /// Returns the depth of the far plane.
    pub fn far(&self) -> f64 {
        self.far
    }

    /// Returns face, column and depth of each point, face by face.
    pub fn points(&self) -> impl Iterator<Item = (usize, u32, f64)> + '_ {
        self.points.iter().copied()
    }
}

/// Returns a camera before the middle of a scene that sees a single row of this many pixels, the nearest corners just
/// within sight.
pub(in crate::explain) fn row_camera(scene: &Scene, triangles: &Triangles, pixels: u32) -> Camera {
    let [width, height] = [scene.raster.columns, scene.raster.rows].map(f64::from);
    let depths = || triangles.corners.iter().flatten().map(|corner| corner.z);
    let farthest = depths().fold(0.0, f64::max);
    let nearest = depths().fold(f64::INFINITY, f64::min).min(farthest);
    let middle = DVec3::new(width / 2.0, height / 2.0, 0.0);
    let eye = middle.with_z((width * 0.9 - nearest).max(0.5));
    let across = width * 0.5 / (eye.z + nearest).max(0.5);
    let fov_y = 2.0 * libm::atan(across / f64::from(pixels));
    Camera {
        eye,
        target: middle.with_z(-farthest),
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y },
        near: (eye.z + nearest) * 0.5,
        far: eye.z + farthest + 1.0,
    }
}
