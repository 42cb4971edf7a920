//! Directions from pixels to the eye.

use super::patch::Patch;
use crate::math::{DVec3, Vec3};
use crate::scene::Projection;
use crate::shade::lane::Vec3Lane;
use crate::view::View;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};

/// The direction to the eye by pixel: a linear function of the place on the screen, because all points that a pixel can
/// show are on one line through the eye.
#[derive(Debug, Clone, Copy)]
pub struct Sight {
    /// The middle of the screen, in pixels.
    middle: [f32; 2],
    /// Towards the eye there; in perspective of unit length, world axes, as are the others.
    at_middle: Vec3,
    /// Its change from one pixel to the next along x; zero if projection lines are parallel.
    right: Vec3,
    /// Its change along y, downwards.
    down: Vec3,
}

impl Sight {
    /// Builds the pixels of a view.
    pub fn new(view: &View) -> Self {
        let camera = view.camera();
        let [right, up, back] = camera.axes();
        let [width, height] = [view.width(), view.height()].map(f64::from);
        let pixel = match camera.projection {
            Projection::Perspective { fov_y } => 2.0 * libm::tan(fov_y * 0.5) / height,
            Projection::Orthographic { .. } => 0.0,
        };
        let change = |axis: DVec3| (axis * pixel).as_vec3();
        Self {
            middle: [width * 0.5, height * 0.5].map(|v| v as f32),
            at_middle: back.as_vec3(),
            right: change(-right),
            down: change(up),
        }
    }

    /// Returns the position of a pixel's centre, from the middle: halves, so no rounding.
    #[inline(always)]
    fn place(&self, [x, y]: [i32; 2]) -> [f32; 2] {
        [x as f32 + 0.5 - self.middle[0], y as f32 + 0.5 - self.middle[1]]
    }

    /// Returns the vector towards the eye from the point seen at a pixel's centre, world axes.
    #[inline(always)]
    pub fn towards_eye(&self, pixel: [i32; 2]) -> Vec3 {
        let [x, y] = self.place(pixel);
        self.at_middle + self.right * x + self.down * y
    }

    /// Returns the vectors of a patch's pixels as [`Self::towards_eye`] does, bit for bit.
    #[inline(always)]
    pub fn towards_eye_x16<S: Simd>(&self, simd: S, patch: Patch) -> Vec3Lane<f32x16<S>> {
        let [x, y] = patch.places(simd, self.place(patch.at));
        self.by_place(x, y)
    }

    /// Returns the vectors of any sixteen pixels as [`Self::towards_eye`] does, bit for bit.
    #[inline(always)]
    pub fn towards_eye_of<S: Simd>(&self, simd: S, pixels: &[[i32; 2]; 16]) -> Vec3Lane<f32x16<S>> {
        let mut places = [[0.0; 16]; 2];
        for (i, &pixel) in pixels.iter().enumerate() {
            let [x, y] = self.place(pixel);
            (places[0][i], places[1][i]) = (x, y);
        }
        let [x, y] = &places;
        self.by_place(f32x16::from_slice(simd, x), f32x16::from_slice(simd, y))
    }

    #[inline(always)]
    fn by_place<S: Simd>(&self, x: f32x16<S>, y: f32x16<S>) -> Vec3Lane<f32x16<S>> {
        let Self { at_middle: a, right: r, down: d, .. } = self;
        Vec3Lane::new(x * r.x + a.x + y * d.x, x * r.y + a.y + y * d.y, x * r.z + a.z + y * d.z)
    }
}
