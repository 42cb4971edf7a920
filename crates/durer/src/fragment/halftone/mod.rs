//! Halftones: grey with few levels, beside the ordered dithering of [`super::Dither`].
//!
//! Values are linear light from 0 (black) to 1 (white); NaN counts as 0. Levels are equal steps of
//! light, so that the mean over an area is right.

pub mod clustered_dot;
pub mod error_diffusion;

use crate::target::Pixels;

/// Returns a value as it counts: from 0 to 1.
fn light(value: f32) -> f32 {
    if value > 0.0 { value.min(1.0) } else { 0.0 }
}

/// Returns the light of a level, of this many steps.
fn of_level(level: u8, steps: u8) -> f32 {
    f32::from(level) / f32::from(steps)
}

/// Returns the image of levels as light, for comparing.
///
/// ```
/// use durer::fragment::halftone::as_light;
/// use durer::target::Pixels;
/// let levels = Pixels::from_data(3, 1, vec![0_u8, 1, 2]).unwrap();
/// assert_eq!(as_light(&levels, 3).data(), [0.0, 0.5, 1.0]);
/// ```
pub fn as_light(image: &Pixels<u8>, levels: u8) -> Pixels<f32> {
    let steps = levels.max(2) - 1;
    let mut light = Pixels::new(image.width(), image.height(), 0.0);
    for (value, level) in light.data_mut().iter_mut().zip(image.data()) {
        *value = of_level((*level).min(steps), steps);
    }
    light
}
