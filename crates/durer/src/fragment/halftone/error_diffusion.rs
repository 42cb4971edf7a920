//! Floyd–Steinberg error diffusion: the error of a pixel's level is passed to the neighbours that come after it.
//!
//! R. W. Floyd, L. Steinberg, *An adaptive algorithm for spatial greyscale*, Proceedings of the Society for Information
//! Display 17(2), 1976. Class: image space. Cost: O(1) per pixel, two rows of errors. Of the error 7/16 go to the next
//! pixel of the row, 3/16, 5/16 and 1/16 to those below: behind, straight and ahead; errors are lost only at the
//! borders.

use super::{light, of_level};
use crate::info::{Class, Info, Occluder};
use crate::target::Pixels;
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "floyd-steinberg",
    title: "Floyd–Steinberg error diffusion",
    authors: "R. W. Floyd, L. Steinberg",
    year: 1976,
    source: "An adaptive algorithm for spatial greyscale, Proceedings of the Society for Information Display 17(2)",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(1) per pixel, two rows of errors",
    limits: "pixels in order: a change alters the pattern of all later pixels",
    pseudocode: &[
        "for each row y, from top to bottom:",
        "    for each pixel x, from left to right:",
        "        v ← its light and the errors that have come to it",
        "        level ← the nearest output level",
        "        e ← v − light of the level",
        "        // 7 to the right; 3, 5 and 1 below",
        "        give 7/16 e to (x + 1, y)",
        "        give 3/16 e to (x − 1, y + 1)",
        "        give 5/16 e to (x, y + 1)",
        "        give 1/16 e to (x + 1, y + 1)",
    ],
};

/// Options for diffusing errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Options {
    /// Equal steps from black to white, 2 … 255; held to that.
    pub levels: u8,
    /// True to process every other row from right to left, which breaks up the worms of the
    /// published form.
    pub serpentine: bool,
}

impl Default for Options {
    /// Returns black and white, as published.
    fn default() -> Self {
        Self { levels: 2, serpentine: false }
    }
}

/// Step of the algorithm: the level of a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Column and row.
    pub pixel: [u32; 2],
    /// Its value with the errors passed to it.
    pub value: f32,
    /// The nearest level.
    pub level: u8,
    /// Error of the level: value − level's light, of which 7, 3, 5 and 1 sixteenths go to four neighbours.
    pub error: f32,
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        5
    }
}

/// Returns the image that a list of steps leads to.
pub fn replay(width: u32, height: u32, steps: &[Step]) -> Pixels<u8> {
    let mut image = Pixels::new(width, height, 0);
    steps.iter().for_each(|step| image.set(step.pixel[0], step.pixel[1], step.level));
    image
}

/// Returns the levels of an image of linear light.
///
/// ```
/// use durer::fragment::halftone::error_diffusion::{Options, dither};
/// use durer::target::Pixels;
/// use durer::trace::NoTrace;
///
/// let grey = Pixels::new(64, 64, 0.25);
/// let dots = dither(&grey, &Options::default(), &mut NoTrace);
/// let white = dots.data().iter().filter(|level| **level == 1).count();
/// assert!(white.abs_diff(64 * 64 / 4) < 32);
/// ```
pub fn dither(image: &Pixels<f32>, options: &Options, t: &mut impl Tracer<Step>) -> Pixels<u8> {
    let steps = options.levels.max(2) - 1;
    let width = image.width() as usize;
    let mut levels = Pixels::new(image.width(), image.height(), 0);
    let (mut here, mut below) = (vec![0.0_f32; width], vec![0.0_f32; width]);
    for y in 0..image.height() {
        let backward = options.serpentine && y % 2 == 1;
        for k in 0..width {
            let x = if backward { width - 1 - k } else { k };
            let value = light(image.row(y)[x]) + here[x];
            let level = (value * f32::from(steps) + 0.5).clamp(0.0, f32::from(steps)) as u8;
            let error = value - of_level(level, steps);
            t.step(|| Step { pixel: [x as u32, y], value, level, error });
            levels.row_mut(y)[x] = level;
            // The pixels before and behind in the direction of the row, if there are any.
            let [next, last] = [
                x.checked_add_signed(if backward { -1 } else { 1 }),
                x.checked_add_signed(if backward { 1 } else { -1 }),
            ];
            let give = |row: &mut [f32], x: Option<usize>, share: f32| {
                if let Some(place) = x.and_then(|x| row.get_mut(x)) {
                    *place += error * (share / 16.0);
                }
            };
            give(&mut here, next, 7.0);
            give(&mut below, last, 3.0);
            give(&mut below, Some(x), 5.0);
            give(&mut below, next, 1.0);
        }
        std::mem::swap(&mut here, &mut below);
        below.fill(0.0);
    }
    levels
}
