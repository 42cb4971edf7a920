//! Steps of rays: where they begin, where they lead, and how far.

use super::world::{Cast, Ray};
use super::{RayKind, Step, Tests};
use crate::math::{DMat4, DVec3, DVec4};
use crate::raster::fixed::SUBPIXELS;
use crate::scene::Projection;
use crate::view::View;

/// Maker of steps.
pub struct Report {
    world_from_screen: DMat4,
    eye: DVec3,
    /// Distance of the near plane from the eye's plane, for parallel rays.
    near: Option<f64>,
}

impl Report {
    pub fn new(view: &View) -> Self {
        let camera = view.camera();
        let parallel = matches!(camera.projection, Projection::Orthographic { .. });
        let world_from_screen = view.screen_from_world().inverse();
        Self { world_from_screen, eye: camera.eye, near: parallel.then_some(camera.near) }
    }

    /// Returns the step of a ray from the eye through a point `offset` (1/256 pixel) from a pixel's centre, with the
    /// window depth and the item of its hit.
    pub fn primary(
        &self,
        [x, y]: [i32; 2],
        offset: [i32; 2],
        hit: Option<(f32, u32)>,
        tests: Tests,
    ) -> Step {
        let place = |v: i32, o: i32| f64::from(v) + 0.5 + f64::from(o) / f64::from(SUBPIXELS);
        let (px, py) = (place(x, offset[0]), place(y, offset[1]));
        let at = |depth: f64| {
            let p = self.world_from_screen * DVec4::new(px, py, depth, 1.0);
            p.truncate() / p.w
        };
        let first = at(0.0);
        let direction = (at(1.0) - first).normalize_or_zero();
        let origin = self.near.map_or(self.eye, |near| first - direction * near);
        let kind = if offset == [0; 2] { RayKind::Primary } else { RayKind::Sample };
        let t = hit.map_or(f64::INFINITY, |(depth, _)| (at(depth.into()) - origin).length());
        let hit = hit.map(|(_, item)| item);
        Step::Ray { x, y, kind, generation: 0, origin, direction, hit, t, tests }
    }

    /// Returns the step of a ray from a surface.
    pub fn secondary(
        &self,
        [x, y]: [i32; 2],
        (kind, generation): (RayKind, u32),
        ray: &Ray,
        Cast { hit, tests }: Cast,
    ) -> Step {
        let origin = self.eye + ray.origin.as_dvec3();
        let direction = ray.direction.as_dvec3();
        let t = hit.map_or(f64::INFINITY, |hit| hit.distance.into());
        let hit = hit.map(|hit| hit.item);
        Step::Ray { x, y, kind, generation, origin, direction, hit, t, tests }
    }
}
