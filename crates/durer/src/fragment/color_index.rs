//! Colour indices: pixels that name an entry of a palette (OpenGL 2.1, 2.14.8 and 4.2.2; the colour
//! look-up table of J. Kajiya, I. Sutherland, E. Cheadle, *A Random-Access Video Frame Buffer*, 1975).
//!
//! ```
//! use durer::commands::{Command, DisplayLists, Pipeline, Primitive, CornerVertex, execute};
//! use durer::fragment::Palette;
//! use durer::math::{DVec3, Vec4};
//! use durer::target::Framebuffer;
//!
//! // Indices 16 … 31 go from black to white; the corners' indices are interpolated between them.
//! let mut palette = Palette::default();
//! palette.ramp(16..=31, Vec4::new(0.0, 0.0, 0.0, 1.0), Vec4::ONE);
//! let corner = |x, y, index| CornerVertex { index: Some(index), ..CornerVertex::from(DVec3::new(x, y, 0.0)) };
//! let corners = vec![corner(-1., -1., 16.), corner(1., -1., 31.), corner(1., 1., 31.), corner(-1., 1., 16.)];
//! let mut target = Framebuffer::new(16, 1).with_indices();
//! let square = Command::Draw(Primitive::Polygon, corners);
//! execute(&[square], &DisplayLists::default(), &mut Pipeline::default(), &mut target)?;
//! palette.resolve(&mut target);
//! assert_eq!(target.color.get(0, 0), Some([0, 0, 0, 255]));
//! assert_eq!(target.color.get(15, 0), Some([255; 4]));
//! # Ok::<(), durer::Error>(())
//! ```

use crate::math::Vec4;
use crate::shade::color::encode_rgba8;
use crate::target::Framebuffer;
use crate::{Error, Result};
use std::ops::RangeInclusive;

/// The colours of the 256 indices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Palette {
    colors: [[u8; 4]; 256],
}

impl Default for Palette {
    /// Returns greys of equal steps of the sRGB code, opaque, from black at 0 to white at 255.
    fn default() -> Self {
        Self { colors: std::array::from_fn(|i| [i as u8, i as u8, i as u8, 255]) }
    }
}

impl Palette {
    /// Creates a palette of sRGB colours with straight alpha; indices beyond them are opaque black.
    ///
    /// # Errors
    /// [`Error::Parameter`] for more than 256 colours.
    pub fn new(colors: &[[u8; 4]]) -> Result<Self> {
        let mut palette = Self { colors: [[0, 0, 0, 255]; 256] };
        let to = palette.colors.get_mut(..colors.len());
        let to = to.ok_or_else(|| Error::parameter("colours", colors.len(), "at most 256"))?;
        to.copy_from_slice(colors);
        Ok(palette)
    }

    /// Returns the colour of an index: sRGB, straight alpha.
    pub fn get(&self, index: u8) -> [u8; 4] {
        self.colors[usize::from(index)]
    }

    /// Sets the colour of an index.
    pub fn set(&mut self, index: u8, color: [u8; 4]) {
        self.colors[usize::from(index)] = color;
    }

    /// Sets a range of indices to colours in equal steps of light, from the given colour of its first index to the one
    /// of its last; linear RGBA, straight alpha. A range of one index gets the first colour.
    pub fn ramp(&mut self, indices: RangeInclusive<u8>, first: Vec4, last: Vec4) {
        let steps = f32::from(indices.end().saturating_sub(*indices.start())).max(1.0);
        for (i, index) in indices.enumerate() {
            self.set(index, encode_rgba8(first.lerp(last, i as f32 / steps)));
        }
    }

    /// Returns the index whose colour is nearest: the least sum of squared differences of sRGB codes
    /// and alpha; among equally near ones the lowest. Cost: 256 comparisons.
    pub fn nearest(&self, color: [u8; 4]) -> u8 {
        let distance = |index: &u8| -> u32 {
            let entry = self.get(*index);
            (0..4).map(|k| u32::from(entry[k].abs_diff(color[k])).pow(2)).sum()
        };
        (0..=255).min_by_key(distance).unwrap_or(0)
    }

    /// Writes the colours of the indices to the colour plane; nothing, if there are no indices.
    pub fn resolve(&self, target: &mut Framebuffer) {
        if let Some(indices) = &target.index {
            let pixels = target.color.data_mut().iter_mut().zip(indices.data());
            pixels.for_each(|(color, &index)| *color = self.get(index));
        }
    }
}

/// Returns the nearest whole index; halves go up.
pub(super) fn rounded(index: f32) -> u8 {
    whole_index((index + 0.5).floor())
}

/// Returns the lowest eight bits of a whole number, as a framebuffer of eight bits keeps them; 0
/// for NaN.
pub(super) fn whole_index(index: f32) -> u8 {
    (index as i64 & 0xff) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_wrap_and_strange_ones_do_no_harm() {
        let cases = [(0.0, 0), (0.49, 0), (0.5, 1), (254.7, 255), (255.5, 0), (256.0, 0)];
        for (index, expected) in cases {
            assert_eq!(rounded(index), expected, "{index}");
        }
        assert_eq!((rounded(-1.0), rounded(515.0), rounded(f32::NAN)), (255, 3, 0));
        assert_eq!((rounded(f32::INFINITY), rounded(f32::NEG_INFINITY)), (255, 0));
    }

    #[test]
    fn ramps_are_even_in_light_and_stay_in_their_range() {
        let mut palette = Palette::new(&[]).expect("few");
        palette.ramp(10..=12, Vec4::new(0.0, 0.0, 0.0, 1.0), Vec4::ONE);
        let codes = [9, 10, 11, 12, 13].map(|i| palette.get(i)[0]);
        // Half the light is code 188.
        assert_eq!(codes, [0, 0, 188, 255, 0]);
        palette.ramp(7..=7, Vec4::ONE, Vec4::ZERO);
        assert_eq!(palette.get(7), [255; 4]);
        palette.ramp(0..=255, Vec4::ZERO, Vec4::ONE);
        assert_eq!((palette.get(0), palette.get(255)), ([0; 4], [255; 4]));
        assert!(Palette::new(&[[0; 4]; 257]).is_err());
        assert!(Palette::new(&[[0; 4]; 256]).is_ok());
    }

    #[test]
    fn the_nearest_entry_is_found_the_lowest_of_equals() {
        let palette = Palette::default();
        for code in 0..=255 {
            assert_eq!(palette.nearest([code, code, code, 255]), code);
        }
        let two =
            Palette::new(&[[255, 0, 0, 255], [0, 0, 255, 255], [255, 0, 0, 255]]).expect("few");
        assert_eq!(two.nearest([200, 10, 30, 255]), 0);
        assert_eq!(two.nearest([100, 10, 130, 255]), 1);
    }
}
