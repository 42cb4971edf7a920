//! The light above the horizons around sixteen pixels of a row at a time.

use super::planes::{FARTHEST, LANES, Lens, PATTERN, Planes};
use crate::math::Vec2;
use crate::scene::Projection;
use crate::view::View;
use fearless_simd::{f32x16, mask32x16, prelude::*};
use fearless_simd_macros::simd;
use std::f32::consts::{FRAC_PI_2, PI};

/// Slices around each pixel.
const SLICES: usize = 3;

/// Number of samples of the depth plane in each of the two directions of a slice.
const STEPS: usize = 5;

/// Neighbours whose planes are farther apart than this part of the radius are different surfaces.
const SAME_SURFACE: f32 = 0.05;

/// The order in which the pixels of the pattern turn their slices: a Bayer matrix.
const TURNS: [usize; 16] = [0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5];

/// Part of a step by which the samples of the pixels of each turn are farther away.
const JITTER: [f32; 16] = [
    0.03, 0.53, 0.28, 0.78, 0.16, 0.66, 0.41, 0.91, 0.09, 0.59, 0.34, 0.84, 0.22, 0.72, 0.47, 0.97,
];

/// Directions and distances of samples.
pub struct Surroundings {
    radius: f32,
    per_radius_squared: f32,
    /// Pixels per world unit: at a distance of 1 in perspective, else everywhere.
    pixels: f32,
    /// All directions of slices, in order over half a turn.
    directions: Vec<Vec2>,
}

impl Surroundings {
    /// Creates the surroundings for a picture of `height` pixels; `radius` in world units.
    pub fn new(view: &View, height: u32, radius: f32) -> Self {
        let shown = match view.camera().projection {
            Projection::Perspective { fov_y } => 2.0 * libm::tan(fov_y * 0.5),
            Projection::Orthographic { height } => height,
        };
        Self {
            radius,
            per_radius_squared: 1.0 / (radius * radius),
            pixels: (f64::from(height) / shown) as f32,
            directions: (0..SLICES * PATTERN * PATTERN).map(direction).collect(),
        }
    }

    /// Returns the samples of the pixels of a turn, up to a distance of `reach` pixels.
    fn looks(&self, turn: usize, reach: f32) -> Looks {
        let slice = |i: usize| {
            let along = self.directions[i * PATTERN * PATTERN + turn];
            let side = |side: f32| {
                let step = |step: usize| {
                    let part = (step as f32 + JITTER[turn]) * (1.0 / STEPS as f32);
                    // The samples are closer together near the pixel.
                    let away = along * (side * (1.0 + part * part * reach));
                    [away.x, away.y].map(nearest)
                };
                std::array::from_fn(step)
            };
            (along, [side(-1.0), side(1.0)])
        };
        Looks { reach, slices: std::array::from_fn(slice) }
    }
}

/// The directions of a turn's slices, and the pixels that are examined to their two sides.
struct Looks {
    reach: f32,
    slices: [(Vec2, [[[i32; 2]; STEPS]; 2]); SLICES],
}

/// A place or a direction on the axes of the screen, in all lanes.
#[derive(Clone, Copy)]
struct Vec3x16<S: Simd> {
    x: f32x16<S>,
    y: f32x16<S>,
    z: f32x16<S>,
}

impl<S: Simd> Vec3x16<S> {
    #[inline(always)]
    fn dot(self, other: Self) -> f32x16<S> {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    fn scale(self, by: f32x16<S>) -> Self {
        Self { x: self.x * by, y: self.y * by, z: self.z * by }
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }

    #[inline(always)]
    fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }
}

/// Sixteen pixels of one phase of a row, and their items.
#[derive(Clone, Copy)]
struct Points<S: Simd> {
    x: i32,
    y: i32,
    place: Vec3x16<S>,
    normal: Vec3x16<S>,
    /// True for pixels that show a surface.
    shown: mask32x16<S>,
}

impl<S: Simd> Points<S> {
    /// Returns the points from the column `x` on; `None` if they show nothing.
    #[inline(always)]
    fn get(simd: S, planes: &Planes, x: i32, y: i32) -> Option<Self> {
        let at = planes.place(x, y);
        let lanes = |plane: &[f32]| f32x16::from_slice(simd, &plane[at..at + LANES]);
        let place = place_of(simd, planes, x, y);
        let shown = place.z.simd_eq(place.z);
        if !shown.any_true() {
            return None;
        }
        let [nx, ny, nz] = &planes.normal;
        let normal = Vec3x16 { x: lanes(nx), y: lanes(ny), z: lanes(nz) };
        Some(Self { x, y, place, normal, shown })
    }
}

/// Returns the points that sixteen pixels show, relative to the eye; NaN at background pixels.
#[inline(always)]
fn place_of<S: Simd>(simd: S, planes: &Planes, x: i32, y: i32) -> Vec3x16<S> {
    let at = planes.place(x, y);
    let z = f32x16::from_slice(simd, &planes.back[at..at + LANES]);
    let Lens { first, step, scale, .. } = &planes.lens;
    let columns = f32x16::from_slice(simd, &COLUMNS) + x as f32;
    let scale = z * scale[1] + scale[0];
    let x = (columns * step[0] + first[0]) * scale;
    let y = scale * (y as f32 * step[1] + first[1]);
    Vec3x16 { x, y, z }
}

/// The columns of sixteen pixels of one phase.
const COLUMNS: [f32; LANES] =
    [0.0, 4.0, 8.0, 12.0, 16.0, 20.0, 24.0, 28.0, 32.0, 36.0, 40.0, 44.0, 48.0, 52.0, 56.0, 60.0];

/// Sets the part of the light that reaches the pixels of a row, before smoothing, in the order of the planes.
#[simd]
pub fn light_of_row<S: Simd>(
    simd: S,
    planes: &Planes,
    around: &Surroundings,
    y: i32,
    row: &mut [f32],
) {
    for phase in 0..PATTERN as i32 {
        let turn = TURNS[y as usize % PATTERN * PATTERN + phase as usize];
        let mut looks = around.looks(turn, 1.0);
        for x in (phase..planes.width as i32).step_by(PATTERN * LANES) {
            let Some(points) = Points::get(simd, planes, x, y) else { continue };
            let light = light(simd, planes, around, &points, (turn, &mut looks));
            let at = planes.place(x, 0);
            row[at..at + LANES].copy_from_slice(&light);
        }
    }
}

/// Returns the part of the light that reaches sixteen pixels; those with the same reach are lit together.
#[inline(always)]
fn light<S: Simd>(
    simd: S,
    planes: &Planes,
    around: &Surroundings,
    points: &Points<S>,
    (turn, looks): (usize, &mut Looks),
) -> [f32; LANES] {
    let splat = |v: f32| f32x16::splat(simd, v);
    // Direction to the eye, and pixels per unit of length, at each point.
    let (to_eye, per_unit) = if planes.lens.perspective {
        let distance = points.place.dot(points.place).sqrt();
        (points.place.scale(splat(-1.0) / distance), splat(around.pixels) / distance)
    } else {
        (Vec3x16 { x: splat(0.0), y: splat(0.0), z: splat(1.0) }, splat(around.pixels))
    };
    // The reach is rounded, so that neighbours often have the same and are lit together.
    let reach = (per_unit * around.radius).min(splat(FARTHEST as f32));
    let reach: [f32; LANES] = points.shown.select(reach, splat(0.0)).into();
    let reach = reach.map(rounded_down);
    let mut light = [1.0; LANES];
    for lane in 0..LANES {
        // A lane with the reach of an earlier lane has been lit with it.
        if reach[lane] < 1.0 || reach[..lane].contains(&reach[lane]) {
            continue;
        }
        if looks.reach != reach[lane] {
            *looks = around.looks(turn, reach[lane]);
        }
        let sum = light_above(simd, planes, around, points, to_eye, looks);
        let part = (sum * (1.0 / SLICES as f32)).max(splat(0.0)).min(splat(1.0));
        let part: [f32; LANES] = part.into();
        for other in lane..LANES {
            if reach[other] == reach[lane] {
                light[other] = part[other];
            }
        }
    }
    light
}

/// Returns the light above the horizons of all slices, summed.
#[inline(always)]
fn light_above<S: Simd>(
    simd: S,
    planes: &Planes,
    around: &Surroundings,
    points: &Points<S>,
    to_eye: Vec3x16<S>,
    looks: &Looks,
) -> f32x16<S> {
    let splat = |v: f32| f32x16::splat(simd, v);
    let mut sum = splat(0.0);
    for (along, sides) in &looks.slices {
        // Plane through the line of sight and a direction on the screen.
        let forth = to_eye.x * along.x + to_eye.y * along.y;
        let on_screen = Vec3x16 { x: splat(along.x), y: splat(along.y), z: splat(0.0) };
        let across = on_screen.minus(to_eye.scale(forth));
        let axis = across.cross(to_eye);
        let squared = axis.dot(axis);
        // The normal projected into the plane, and its angle to the line of sight.
        let off = points.normal.dot(axis) / squared;
        let off = squared.simd_gt(splat(1e-20)).select(off, splat(0.0));
        let in_plane = points.normal.minus(axis.scale(off));
        let length = in_plane.dot(in_plane).sqrt();
        let cos_n = in_plane.dot(to_eye) / length;
        let cos_n = cos_n.max(splat(-1.0)).min(splat(1.0));
        let sin_n =
            (splat(1.0) - cos_n * cos_n).max(splat(0.0)).sqrt().copysign(in_plane.dot(across));
        let mut arcs = splat(0.0);
        for (side, pixels) in [-1.0_f32, 1.0].into_iter().zip(sides) {
            // Horizon of the surface itself, cos(n ± π/2), and the highest horizon above it.
            let low = sin_n * -side;
            let highest = highest(simd, planes, around, (points, to_eye), low, pixels);
            arcs += arc(simd, side, highest, [cos_n, sin_n]);
        }
        // The length of the projected normal weights the slice; too short ones contribute nothing.
        sum += length.simd_gt(splat(1e-4)).select(length * arcs, splat(0.0));
    }
    sum
}

/// Returns the cosine of the highest horizon to one side.
#[inline(always)]
fn highest<S: Simd>(
    simd: S,
    planes: &Planes,
    around: &Surroundings,
    (points, to_eye): (&Points<S>, Vec3x16<S>),
    low: f32x16<S>,
    pixels: &[[i32; 2]; STEPS],
) -> f32x16<S> {
    let splat = |v: f32| f32x16::splat(simd, v);
    let mut highest = low;
    for [dx, dy] in pixels {
        let (x, y) = (points.x + dx, points.y + dy);
        // Negative numbers become larger than the height.
        if y as u32 >= planes.height {
            continue;
        }
        let delta = place_of(simd, planes, x, y).minus(points.place);
        let squared = delta.dot(delta);
        let fading = squared * around.per_radius_squared;
        let cosine = delta.dot(to_eye) / squared.sqrt();
        let above = low + (cosine - low) * (splat(1.0) - fading);
        // False at background pixels, whose values are NaN.
        let counts = fading.simd_lt(splat(1.0)) & squared.simd_gt(splat(0.0));
        highest = (counts & above.simd_gt(highest)).select(above, highest);
    }
    highest.max(splat(-1.0)).min(splat(1.0))
}

/// Returns the light between the direction to the eye and the horizon of one side.
#[inline(always)]
fn arc<S: Simd>(simd: S, side: f32, cos_h: f32x16<S>, [cos_n, sin_n]: [f32x16<S>; 2]) -> f32x16<S> {
    let one = f32x16::splat(simd, 1.0);
    let h = arc_cos(simd, cos_h) * side;
    let sin_h = (one - cos_h * cos_h).sqrt() * side;
    // cos(2h − n), by the addition theorem.
    let cos = (cos_h * cos_h * 2.0 - 1.0) * cos_n + sin_h * cos_h * sin_n * 2.0;
    (cos_n - cos + h * sin_n * 2.0) * 0.25
}

/// Sets the pixels of a row to the mean over the pattern's size around them, of everything on the same surface.
#[simd]
pub fn mean_of_row<S: Simd>(
    simd: S,
    planes: &Planes,
    around: &Surroundings,
    rough: &[f32],
    y: i32,
    row: &mut [f32],
) {
    for phase in 0..PATTERN as i32 {
        for x in (phase..planes.width as i32).step_by(PATTERN * LANES) {
            let Some(points) = Points::get(simd, planes, x, y) else { continue };
            let mean: [f32; LANES] = mean(simd, planes, around, rough, &points).into();
            let pixels = row[x as usize..].iter_mut().step_by(PATTERN);
            pixels.zip(mean).for_each(|(to, from)| *to = from);
        }
    }
}

/// Returns, for each of sixteen pixels, the mean over neighbours on the same surface; 1 at background pixels.
#[inline(always)]
fn mean<S: Simd>(
    simd: S,
    planes: &Planes,
    around: &Surroundings,
    rough: &[f32],
    points: &Points<S>,
) -> f32x16<S> {
    let splat = |v: f32| f32x16::splat(simd, v);
    let same = 1.0 / (SAME_SURFACE * around.radius);
    let half = PATTERN as i32 / 2;
    let (mut sum, mut weights) = (splat(0.0), splat(0.0));
    for dy in -half..half {
        let y = points.y + dy;
        if y as u32 >= planes.height {
            continue;
        }
        for x in points.x - half..points.x + half {
            let apart = place_of(simd, planes, x, y).minus(points.place).dot(points.normal).abs();
            let weight = splat(1.0) - apart * same;
            // At background pixels the weight is NaN, which is not above 0.
            let weight = weight.simd_gt(splat(0.0)).select(weight, splat(0.0));
            let at = planes.place(x, y);
            sum += weight * f32x16::from_slice(simd, &rough[at..at + LANES]);
            weights += weight;
        }
    }
    weights.simd_gt(splat(0.0)).select(sum / weights, splat(1.0))
}

/// Returns the nearest whole number; halves are rounded away from zero.
fn nearest(v: f32) -> i32 {
    // Without SSE 4.1, rounding is a function call.
    (v + 0.5_f32.copysign(v)) as i32
}

/// Returns the next number below with two bits after its first, so that neighbours have the same reach.
fn rounded_down(reach: f32) -> f32 {
    f32::from_bits(reach.to_bits() & 0xffe0_0000)
}

/// Returns one of the directions in half a turn, in order.
fn direction(part: usize) -> Vec2 {
    let angle = PI * part as f32 / (SLICES * PATTERN * PATTERN) as f32;
    Vec2::new(libm::cosf(angle), libm::sinf(angle))
}

/// Returns the angle in 0…π of a cosine in −1…1, to 7 · 10⁻⁵: M. Abramowitz, I. Stegun, *Handbook of
/// Mathematical Functions*, 1964, formula 4.4.45.
#[inline(always)]
fn arc_cos<S: Simd>(simd: S, x: f32x16<S>) -> f32x16<S> {
    let zero = f32x16::splat(simd, 0.0);
    let a = x.abs();
    let polynomial = ((a * -0.018_729_3 + 0.074_261) * a - 0.212_114_4) * a + FRAC_PI_2;
    let angle = (f32x16::splat(simd, 1.0) - a).max(zero).sqrt() * polynomial;
    x.simd_lt(zero).select(f32x16::splat(simd, PI) - angle, angle)
}
