//! A photographer's studio in closed form: soft boxes over a light floor and a lighter wall, for mirrors.
//!
//! Metal looks like metal because of its reflections. Each box is a distant rectangle in front of the scene. On rough
//! surfaces its borders, and the horizon, are softened according to the spread of the reflection, while its total light
//! stays the same. So there is neither a table nor a picture, and any roughness costs the same. Axes: to the right, up,
//! and to the eye.

use super::axes::{turned, world_axes};
use super::lane::{Lane, Vec3Lane};
use crate::math::{DVec3, Vec3};
use crate::scene::{Camera, UpAxis};

/// Position of a studio.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Studio {
    /// Unit vectors to the right, up and to the front, in world space.
    axes: [Vec3; 3],
}

/// A bright rectangle.
struct SoftBox {
    /// Unit vectors to its middle and along its sides.
    to: Vec3,
    sides: [Vec3; 2],
    /// Half its sides, as sines.
    half: [f32; 2],
    /// Brightness relative to the studio's mean.
    light: f32,
}

/// Positions of the lights that go with the camera, from the left, from the right and from behind
/// ([`super::light::auto_lights`]), so that their highlights are in the boxes; and a strip at the left.
const BOXES: [SoftBox; 4] = [
    SoftBox {
        to: Vec3::new(-0.402_739, 0.549_189, 0.732_252),
        sides: [Vec3::new(0.876_216, 0.0, 0.481_919), Vec3::new(0.264_665, 0.835_698, -0.481_208)],
        half: [0.3, 0.42],
        light: 3.6,
    },
    SoftBox {
        to: Vec3::new(0.826_977, 0.110_264, 0.551_318),
        sides: [
            Vec3::new(0.554_700, 0.0, -0.832_050),
            Vec3::new(-0.091_745, 0.993_902, -0.061_163),
        ],
        half: [0.16, 0.62],
        light: 2.2,
    },
    SoftBox {
        to: Vec3::new(0.408_248, 0.408_248, -0.816_497),
        sides: [
            Vec3::new(-0.894_427, 0.0, -0.447_214),
            Vec3::new(-0.182_574, 0.912_871, 0.365_148),
        ],
        half: [0.55, 0.14],
        light: 3.0,
    },
    SoftBox {
        to: Vec3::new(-0.873_128, 0.048_507, -0.485_071),
        sides: [Vec3::new(-0.485_643, 0.0, 0.874_157), Vec3::new(0.042_403, 0.998_823, 0.023_557)],
        half: [0.1, 0.7],
        light: 1.6,
    },
];

/// Light of the floor at the horizon, the additional light of the wall, the increase from nadir to zenith, and the
/// increase towards both of them, which shows the roundness of objects.
const FLOOR: f32 = 0.15;
const WALL: f32 = 0.45;
const SLOPE: f32 = 0.15;
const POLES: f32 = 0.55;
/// Half the width of borders in a perfect mirror, and by how much it grows with roughness.
const SHARPEST: f32 = 0.035;
const SPREAD: f32 = 1.1;

impl Studio {
    /// Returns the studio that follows a camera.
    pub(crate) fn of_camera(camera: &Camera) -> Self {
        let [right, up, back] = camera.axes();
        let unit = |v: DVec3, otherwise: DVec3| v.normalize_or(otherwise).as_vec3();
        Self { axes: [unit(right, DVec3::X), unit(up, DVec3::Y), unit(back, DVec3::Z)] }
    }

    /// Returns the studio whose front is the scene's.
    pub fn of_world(up: UpAxis) -> Self {
        Self { axes: world_axes(up) }
    }

    /// Returns light from the unit direction `r` as a mirror of roughness √`alpha` shows it; about 1 in the
    /// mean where its screens are as bright as metals mirror them, `lamps` = 1.
    #[inline(always)]
    pub(super) fn radiance<L: Lane>(&self, r: Vec3Lane<L>, alpha: L, lamps: L) -> L {
        alpha.apart(
            #[inline(always)]
            || self.light(r, alpha, lamps),
        )
    }

    #[inline(always)]
    fn light<L: Lane>(&self, r: Vec3Lane<L>, alpha: L, lamps: L) -> L {
        let r = turned(r, &self.axes);
        let one = alpha.splat(1.0);
        let horizon = step(r.y * (one / (alpha * SPREAD + 0.22)));
        let slope = r.y / (alpha * 0.5 + 1.0);
        // A cosine lobe keeps a quarter of the square's difference from its mean, 1/3.
        let poles = r.y * r.y * (alpha * -0.75 + 1.0) + alpha * 0.25;
        let mut sum = horizon * WALL + slope * SLOPE + poles * POLES + FLOOR;
        let sharpness = one / (alpha * SPREAD + SHARPEST);
        let front = one / (alpha + 0.25);
        for SoftBox { to, sides: [across, along], half, light } in BOXES {
            let shape = band(r.dot_all(across), half[0], sharpness)
                * band(r.dot_all(along), half[1], sharpness);
            sum = sum + shape * step(r.dot_all(to) * front) * lamps * light;
        }
        sum
    }
}

/// Returns a smooth step from 0 at −1 to 1 at 1, without a bend.
#[inline(always)]
fn step<L: Lane>(x: L) -> L {
    let t = (x * 0.5 + 0.5).at_least(0.0).at_most(1.0);
    t * t * (t.splat(3.0) - t * 2.0)
}

/// Returns about 1 between −half and half; its integral is 2 half, however soft its ends are.
#[inline(always)]
fn band<L: Lane>(x: L, half: f32, sharpness: L) -> L {
    step((x + half) * sharpness) - step((x - half) * sharpness)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns directions spread evenly over the sphere.
    fn directions() -> impl Iterator<Item = Vec3> {
        let count = 20_000;
        (0..count).map(move |i| {
            let z = 1.0 - (2 * i + 1) as f32 / count as f32;
            let (turn, sine) = (i as f32 * 2.399_963, (1.0 - z * z).sqrt());
            Vec3::new(sine * libm::cosf(turn), z, sine * libm::sinf(turn))
        })
    }

    fn radiance(r: Vec3, alpha: f32) -> f32 {
        Studio::of_world(UpAxis::Y).radiance(r.into(), alpha, 1.0)
    }

    #[test]
    fn roughness_keeps_the_mean_and_takes_the_contrast() {
        let mut last = f32::INFINITY;
        for alpha in [0.0, 0.1, 0.3, 0.6, 1.0] {
            let (mut sum, mut most) = (0.0, 0.0f32);
            for r in directions() {
                let light = radiance(r, alpha);
                assert!(light > 0.0, "{r} {alpha}: {light}");
                sum += f64::from(light);
                most = most.max(light);
            }
            let mean = sum / 20_000.0;
            assert!((mean - 0.93).abs() < 0.08, "{alpha}: {mean}");
            assert!(most <= last, "{alpha}: {most}");
            last = most;
        }
        assert!(last < 1.8);
    }

    #[test]
    fn boxes_are_where_the_lights_of_the_camera_are() {
        for to in
            [Vec3::new(-0.55, 0.75, 1.0), Vec3::new(0.9, 0.12, 0.6), Vec3::new(0.5, 0.5, -1.0)]
        {
            assert!(radiance(to.normalize(), 0.0) > 2.5, "{to}");
        }
        for [a, b, c] in BOXES.map(|b| [b.to, b.sides[0], b.sides[1]]) {
            assert!((a.cross(b) - c).length() < 1e-5 && (a.length() - 1.0).abs() < 1e-5);
        }
    }
}
