//! Ambient occlusion: how much of the light from all around gets to what a picture shows.
//!
//! J. Jiménez, X. Wu, A. Pesce, A. Jarabo, *Practical Real-Time Strategies for Accurate Indirect
//! Occlusion*, SIGGRAPH 2016 course: around each pixel the highest horizon is looked for in the depth
//! plane, in a few slices that stand on the picture, and the light above it is integrated in closed
//! form. Image space. Cost: O(pixels that show something), some 30 looks at the depth plane each.
//!
//! Limits: only what the picture shows takes light away, and it is as thick as it is near: what lies
//! farther away than the radius takes nothing. Deviations: directions and steps are turned in a
//! pattern of 4 × 4 pixels, which the mean over 4 × 4 neighbours on the same surface takes out again.

use crate::info::{Class, Info};
use crate::math::{DVec3, DVec4, Vec2, Vec3};
use crate::parallel;
use crate::scene::Projection;
use crate::shade::color::{decode_srgb8, encode_srgb8};
use crate::target::Pixels;
use crate::view::View;
use std::f32::consts::{FRAC_PI_2, PI};

/// The facts.
pub const INFO: Info = Info {
    name: "ambient-occlusion",
    title: "Ambient occlusion by horizons in the depth plane",
    authors: "J. Jiménez, X. Wu, A. Pesce, A. Jarabo",
    year: 2016,
    source: "Practical Real-Time Strategies for Accurate Indirect Occlusion, SIGGRAPH course",
    class: Class::ImageSpace,
    cost: "O(n) for n pixels that show something",
    limits: "only what the picture shows takes light away",
};

/// How occlusion is found and shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// How far away things may be that take light away, world units, above 0. A tenth to a fifth of the
    /// model's size shows how its parts lie to each other.
    pub radius: f64,
    /// How much of the light is taken away at full occlusion, 0…1.
    pub strength: f32,
}

/// Slices around each pixel.
const SLICES: u32 = 3;

/// Looks at the depth plane in each of the two directions of a slice.
const STEPS: u32 = 5;

/// The side of the pattern by which slices are turned, in pixels.
const PATTERN: u32 = 4;

/// Looks farther than this many pixels away would miss what is near.
const FARTHEST: f32 = 256.0;

/// Neighbours whose planes are farther apart than this part of the radius are different surfaces.
const SAME_SURFACE: f32 = 0.05;

/// Darkens a picture by the occlusion of what it shows. `depth` is its window depth, 1 where nothing is,
/// `normal` the unit normals in the world, both at the pixels' centres.
///
/// The same bytes on every CPU and number of threads.
pub fn apply(
    view: &View,
    depth: &Pixels<f32>,
    normal: &Pixels<[f32; 3]>,
    options: &Options,
    color: &mut Pixels<[u8; 4]>,
) {
    let light = occlusion(view, depth, normal, options.radius);
    for (color, light) in color.data_mut().iter_mut().zip(light.data()) {
        if *light < 1.0 {
            let left = 1.0 - options.strength * (1.0 - light);
            for c in &mut color[..3] {
                *c = encode_srgb8(decode_srgb8(*c) * left);
            }
        }
    }
}

/// Returns the part of the light from all around that gets to each pixel, 0…1; 1 where nothing is.
pub fn occlusion(
    view: &View,
    depth: &Pixels<f32>,
    normal: &Pixels<[f32; 3]>,
    radius: f64,
) -> Pixels<f32> {
    let seen = Seen::new(view, depth, normal, radius as f32);
    let rows = |f: &(dyn Fn(u32, u32) -> f32 + Sync)| {
        let row = |y: u32| (0..seen.width).map(|x| f(x, y)).collect::<Vec<f32>>();
        parallel::map((0..seen.height).collect(), row).concat()
    };
    let rough = rows(&|x, y| seen.light_at(x, y));
    let smooth = rows(&|x, y| seen.mean_around(&rough, x, y));
    // As many as there are pixels, so this is no error.
    Pixels::from_data(seen.width, seen.height, smooth)
        .unwrap_or_else(|_| Pixels::new(seen.width, seen.height, 1.0))
}

/// What the picture shows, as places and normals relative to the eye.
struct Seen {
    width: u32,
    height: u32,
    /// `None` where nothing is.
    points: Vec<Option<Point>>,
    /// The positions of the points, NaN where nothing is.
    positions: Vec<Vec3>,
    /// To the right and down the screen, and back to the eye; world axes.
    axes: [Vec3; 3],
    radius: f32,
    per_radius_squared: f32,
    /// Pixels per world unit: at a distance of 1 in perspective, else everywhere.
    scale: f32,
    perspective: bool,
    /// All directions of slices, in order over half a turn.
    directions: Vec<Vec2>,
}

#[derive(Clone, Copy)]
struct Point {
    position: Vec3,
    /// Towards the eye's side.
    normal: Vec3,
}

impl Seen {
    fn new(view: &View, depth: &Pixels<f32>, normal: &Pixels<[f32; 3]>, radius: f32) -> Self {
        let (width, height) = (depth.width(), depth.height());
        let camera = view.camera();
        let [right, up, back] = camera.axes();
        let (perspective, shown) = match camera.projection {
            Projection::Perspective { fov_y } => (true, 2.0 * libm::tan(fov_y * 0.5)),
            Projection::Orthographic { height } => (false, height),
        };
        let axes = [right, -up, back].map(|a| a.as_vec3());
        let scale = (f64::from(height) / shown) as f32;
        let world_from_screen = view.screen_from_world().inverse();
        let place = |x: u32, y: u32, depth: f32| -> Option<Vec3> {
            let at = DVec4::new(f64::from(x) + 0.5, f64::from(y) + 0.5, f64::from(depth), 1.0);
            let p: DVec4 = world_from_screen * at;
            let p: DVec3 = p.truncate() / p.w - camera.eye;
            p.is_finite().then(|| p.as_vec3())
        };
        let point = |x: u32, y: u32| {
            let depth = depth.get(x, y).filter(|d| *d < 1.0)?;
            let position = place(x, y, depth)?;
            let normal = Vec3::from(normal.get(x, y)?).try_normalize()?;
            let to_eye = if perspective { -position } else { axes[2] };
            let normal = if normal.dot(to_eye) < 0.0 { -normal } else { normal };
            Some(Point { position, normal })
        };
        let row = |y: u32| (0..width).map(|x| point(x, y)).collect::<Vec<_>>();
        let points = parallel::map((0..height).collect(), row).concat();
        let directions = (0..SLICES * PATTERN * PATTERN).map(direction).collect();
        let positions = points.iter().map(|p| p.map_or(Vec3::NAN, |p: Point| p.position)).collect();
        let per_radius_squared = 1.0 / (radius * radius);
        Self {
            width,
            height,
            points,
            positions,
            axes,
            radius,
            per_radius_squared,
            scale,
            perspective,
            directions,
        }
    }

    /// The place of a pixel in the planes; `None` beside the picture.
    #[inline(always)]
    fn place(&self, x: i32, y: i32) -> Option<usize> {
        // What is below 0 is far above the size.
        let inside = (x as u32) < self.width && (y as u32) < self.height;
        inside.then(|| y as usize * self.width as usize + x as usize)
    }

    #[inline(always)]
    fn at(&self, x: i32, y: i32) -> Option<&Point> {
        self.points.get(self.place(x, y)?)?.as_ref()
    }

    #[inline(always)]
    fn position(&self, x: i32, y: i32) -> Option<Vec3> {
        self.positions.get(self.place(x, y)?).copied()
    }

    /// The part of the light that gets to a pixel, before it is smoothed.
    fn light_at(&self, x: u32, y: u32) -> f32 {
        let Some(point) = self.at(x as i32, y as i32) else { return 1.0 };
        let to_eye = if self.perspective { -point.position } else { self.axes[2] };
        let distance = to_eye.length();
        let to_eye = to_eye / distance;
        let per_unit = if self.perspective { self.scale / distance } else { self.scale };
        let reach = (self.radius * per_unit).min(FARTHEST);
        if reach.is_nan() || reach < 1.0 {
            return 1.0;
        }
        let turn = TURNS[(y % PATTERN * PATTERN + x % PATTERN) as usize];
        let light: f32 = (0..SLICES)
            .map(|i| {
                let part = (i * PATTERN * PATTERN + turn) as usize;
                let along = self.directions[part];
                self.light_in_slice(point, [x as i32, y as i32], (to_eye, along, reach), turn)
            })
            .sum();
        (light / SLICES as f32).clamp(0.0, 1.0)
    }

    /// The part of the light in the plane of the sight and a direction of the screen.
    fn light_in_slice(
        &self,
        point: &Point,
        at: [i32; 2],
        (to_eye, along, reach): (Vec3, Vec2, f32),
        turn: u32,
    ) -> f32 {
        let on_screen = self.axes[0] * along.x + self.axes[1] * along.y;
        let across = on_screen - to_eye * on_screen.dot(to_eye);
        let axis = across.cross(to_eye).normalize_or_zero();
        let in_plane = point.normal - axis * point.normal.dot(axis);
        let length = in_plane.length();
        if length < 1e-4 {
            return 0.0;
        }
        let cos_n = (in_plane.dot(to_eye) / length).clamp(-1.0, 1.0);
        let sin_n = (1.0 - cos_n * cos_n).sqrt().copysign(in_plane.dot(across));
        // The horizon of the surface itself, cos(n ± π/2), and what rises above it.
        let horizons = [-1.0_f32, 1.0].map(|side| {
            let low = -side * sin_n;
            let mut highest = low;
            for step in 0..STEPS {
                let part = (step as f32 + JITTER[turn as usize]) * (1.0 / STEPS as f32);
                // Closer together where they are near.
                let away = along * (side * (1.0 + part * part * reach));
                let Some(other) = self.position(at[0] + nearest(away.x), at[1] + nearest(away.y))
                else {
                    continue;
                };
                let delta = other - point.position;
                let squared = delta.length_squared();
                let fading = squared * self.per_radius_squared;
                // Not so where nothing is, for that is no number.
                if fading < 1.0 && squared > 0.0 {
                    let cosine = delta.dot(to_eye) / squared.sqrt();
                    highest = highest.max(low + (cosine - low) * (1.0 - fading));
                }
            }
            (side, highest.clamp(-1.0, 1.0))
        });
        let arc = |(side, cos_h): (f32, f32)| {
            let (h, sin_h) = (side * arc_cos(cos_h), side * (1.0 - cos_h * cos_h).sqrt());
            // cos(2h − n), by the sums of angles.
            let cos = (2.0 * cos_h * cos_h - 1.0) * cos_n + 2.0 * sin_h * cos_h * sin_n;
            0.25 * (cos_n - cos + 2.0 * h * sin_n)
        };
        length * (arc(horizons[0]) + arc(horizons[1]))
    }

    /// The mean over the pattern's size around a pixel, of what is on the same surface.
    fn mean_around(&self, rough: &[f32], x: u32, y: u32) -> f32 {
        let Some(point) = self.at(x as i32, y as i32) else { return 1.0 };
        let same = 1.0 / (SAME_SURFACE * self.radius);
        let (mut sum, mut weights) = (0.0, 0.0);
        for (dx, dy) in (-2..2).flat_map(|dy| (-2..2).map(move |dx| (dx, dy))) {
            let (i, j) = (x as i32 + dx, y as i32 + dy);
            let Some(other) = self.at(i, j) else { continue };
            let apart = (other.position - point.position).dot(point.normal).abs();
            let weight = (1.0 - apart * same).max(0.0);
            sum += weight * rough[j as usize * self.width as usize + i as usize];
            weights += weight;
        }
        if weights > 0.0 { sum / weights } else { 1.0 }
    }
}

/// The order in which the pixels of the pattern turn their slices: a Bayer matrix.
const TURNS: [u32; 16] = [0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5];

/// By which part of a step pixels of each turn look farther.
const JITTER: [f32; 16] = [
    0.03, 0.53, 0.28, 0.78, 0.16, 0.66, 0.41, 0.91, 0.09, 0.59, 0.34, 0.84, 0.22, 0.72, 0.47, 0.97,
];

/// The nearest whole number; half goes away from zero.
#[inline(always)]
fn nearest(v: f32) -> i32 {
    // Without SSE 4.1 rounding is a call.
    (v + 0.5_f32.copysign(v)) as i32
}

/// One of the directions in half a turn, in order.
fn direction(part: u32) -> Vec2 {
    let angle = PI * part as f32 / (SLICES * PATTERN * PATTERN) as f32;
    Vec2::new(libm::cosf(angle), libm::sinf(angle))
}

/// The angle in 0…π of a cosine in −1…1, to 7 · 10⁻⁵: M. Abramowitz, I. Stegun, *Handbook of Mathematical
/// Functions*, 1964, formula 4.4.45.
#[inline]
fn arc_cos(x: f32) -> f32 {
    let a = x.abs();
    let polynomial = ((-0.018_729_3 * a + 0.074_261) * a - 0.212_114_4) * a + FRAC_PI_2;
    let angle = (1.0 - a).max(0.0).sqrt() * polynomial;
    if x < 0.0 { PI - angle } else { angle }
}
