//! Ambient occlusion: the part of the light from all around that reaches the surfaces in a picture.
//!
//! J. Jiménez, X. Wu, A. Pesce, A. Jarabo, *Practical Real-Time Strategies for Accurate Indirect Occlusion*, SIGGRAPH
//! 2016 course: around each pixel, the highest horizon is searched in the depth plane along a few slices perpendicular
//! to the picture, and the light above it is integrated in closed form. L. Bavoil, *Deinterleaved Texturing for
//! Cache-Efficient Interleaved Sampling*, 2013: pixels that search in the same directions are processed together. Image
//! space. Cost: O(pixels that show a surface), about 30 reads of the depth plane each, sixteen pixels at a time.
//!
//! Limits: only surfaces visible in the picture occlude, and only within the radius. Deviations: directions and steps
//! vary in a pattern of 4 × 4 pixels, which the mean over 4 × 4 neighbours on the same surface removes; the search
//! distance is rounded down to one of four steps between powers of two.

mod horizon;
mod planes;

use crate::info::{Class, Info, Occluder};
use crate::parallel;
use crate::shade::color::{decode_srgb8, encode_srgb8};
use crate::simd::{Level, dispatch};
use crate::target::Pixels;
use crate::view::View;
use horizon::{Surroundings, light_of_row, mean_of_row};
use planes::Planes;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "ambient-occlusion",
    title: "Ambient occlusion by horizons in the depth plane",
    authors: "J. Jiménez, X. Wu, A. Pesce, A. Jarabo",
    year: 2016,
    source: "Practical Real-Time Strategies for Accurate Indirect Occlusion, SIGGRAPH course",
    class: Class::ImageSpace,
    occluder: Occluder::Point,
    coherence: &[],
    cost: "O(n) for n pixels that show a surface",
    limits: "only visible surfaces occlude",
    pseudocode: &[],
};

/// Amount of light that counts as unoccluded: on a flat floor at a grazing angle, the steps of the depth alone take
/// away a hundredth.
const OPEN: f32 = 0.98;

/// Options for finding and showing occlusion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Largest distance of occluders, world units, above 0. A tenth to a fifth of the
    /// model's size shows how its parts lie relative to each other.
    pub radius: f64,
    /// Share of the light that full occlusion removes, 0…1.
    pub strength: f32,
}

/// Darkens a picture by the occlusion of its surfaces. `depth` is its window depth, 1 at the background; `normal` has
/// the unit normals, world axes; both at the pixels' centres. Colours are multiplied by the square of the light that
/// arrives, as painters exaggerate it: contacts become dark, and open surfaces stay unchanged.
///
/// The same bytes at every SIMD level and for any number of threads.
pub fn apply(
    view: &View,
    (depth, normal): (&Pixels<f32>, &Pixels<[f32; 3]>),
    options: &Options,
    level: Level,
    color: &mut Pixels<[u8; 4]>,
) {
    let light = occlusion(view, depth, normal, options.radius, level);
    for (color, light) in color.data_mut().iter_mut().zip(light.data()) {
        if *light < 1.0 {
            let open = (light / OPEN).min(1.0);
            let left = 1.0 - options.strength * (1.0 - open * open);
            for c in &mut color[..3] {
                *c = encode_srgb8(decode_srgb8(*c) * left);
            }
        }
    }
}

/// Returns the part of the light from all around that reaches each pixel, 0…1; 1 at the background. `radius` as in
/// [`Options`].
pub fn occlusion(
    view: &View,
    depth: &Pixels<f32>,
    normal: &Pixels<[f32; 3]>,
    radius: f64,
    level: Level,
) -> Pixels<f32> {
    let (width, height) = (depth.width(), depth.height());
    let planes = Planes::new(view, depth, normal);
    let around = Surroundings::new(view, height, radius as f32);
    let mut rough = vec![1.0; planes.len()];
    let rows = (0..height as i32).zip(rough.chunks_mut(planes.row_len()));
    parallel::map(rows.collect(), |(y, row)| {
        dispatch!(level, simd => light_of_row(simd, &planes, &around, y, row));
    });
    let mut light = Pixels::new(width, height, 1.0);
    let rows = (0..height as i32).zip(light.data_mut().chunks_mut(width.max(1) as usize));
    parallel::map(rows.collect(), |(y, row)| {
        dispatch!(level, simd => mean_of_row(simd, &planes, &around, &rough, y, row));
    });
    light
}
