//! Clustered-dot halftones: dots that grow with the tone, as a printer's screen makes them.
//!
//! J. D. Foley, A. van Dam, S. K. Feiner, J. F. Hughes, *Computer Graphics: Principles and Practice*, 2nd ed. 1990,
//! 13.1.2; the screen of two dots in a square at 45° as in R. Ulichney, *Digital Halftoning*, 1987. Class: image space.
//! Cost: O(1) per pixel. Dots are clustered instead of scattered as in ordered dithering, so they survive printing, at
//! the cost of fine detail.

use super::light;
use crate::info::{Class, Info, Occluder};
use crate::target::Pixels;
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "clustered-dot",
    title: "Clustered-dot halftone",
    authors: "R. Ulichney; J. D. Foley, A. van Dam, S. K. Feiner, J. F. Hughes",
    year: 1987,
    source: "Digital Halftoning, MIT Press",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(1) per pixel",
    limits: "33 tones; the screen repeats every 8 pixels",
    pseudocode: &[
        "screen ← 8 × 8 thresholds: two spirals that darken from their middles,",
        "         two that lighten",
        "for each row y:",
        "    for each pixel x:",
        "        T ← (screen[y mod 8][x mod 8] + ½) / 32",
        "        // neighbours in the screen follow each other: dots hold together",
        "        if light > T: white",
        "        else: black",
    ],
};

/// The quarter of the screen that a dark dot grows in, in the order in which its pixels turn black: a spiral from the
/// middle.
const DOT: [[u8; 4]; 4] = [[12, 11, 10, 9], [13, 2, 1, 8], [14, 3, 0, 7], [15, 4, 5, 6]];

/// The thresholds of the screen, of 32: a pixel is white if light · 32 is at least half a step above its threshold.
/// Dark dots grow in two quarters that touch at their corners; in the others white dots shrink, so that both tones have
/// dots.
pub const SCREEN: [[u8; 8]; 8] = screen();

const fn screen() -> [[u8; 8]; 8] {
    let mut screen = [[0; 8]; 8];
    let mut i = 0;
    while i < 64 {
        let (x, y) = (i % 8, i / 8);
        let dot = DOT[y % 4][x % 4];
        let dark = (x / 4 + y / 4) % 2 == 0;
        screen[y][x] = if dark { 31 - dot } else { dot };
        i += 1;
    }
    screen
}

/// Step of the algorithm: a pixel was compared with the screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Column and row.
    pub pixel: [u32; 2],
    /// Its light.
    pub value: f32,
    /// The screen's threshold, as light.
    pub threshold: f32,
    /// True if it is white.
    pub white: bool,
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        if self.white { 7 } else { 8 }
    }
}

/// Returns the image that a list of steps leads to.
pub fn replay(width: u32, height: u32, steps: &[Step]) -> Pixels<u8> {
    let mut image = Pixels::new(width, height, 0);
    for step in steps {
        image.set(step.pixel[0], step.pixel[1], u8::from(step.white));
    }
    image
}

/// Returns black (0) and white (1) of an image of linear light.
///
/// ```
/// use durer::fragment::halftone::clustered_dot::dither;
/// use durer::target::Pixels;
/// use durer::trace::NoTrace;
///
/// let dots = dither(&Pixels::new(8, 8, 0.25), &mut NoTrace);
/// assert_eq!(dots.data().iter().filter(|level| **level == 1).count(), 16);
/// ```
pub fn dither(image: &Pixels<f32>, t: &mut impl Tracer<Step>) -> Pixels<u8> {
    let mut levels = Pixels::new(image.width(), image.height(), 0);
    for y in 0..image.height() {
        let (row, own) = (image.row(y), levels.row_mut(y));
        for (x, (value, level)) in row.iter().zip(own).enumerate() {
            let value = light(*value);
            let threshold = (f32::from(SCREEN[y as usize % 8][x % 8]) + 0.5) / 32.0;
            let white = value > threshold;
            t.step(|| Step { pixel: [x as u32, y], value, threshold, white });
            *level = u8::from(white);
        }
    }
    levels
}
