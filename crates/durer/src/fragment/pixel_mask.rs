//! Windows of any shape, with holes: one bit per pixel.
//!
//! Like the scissor rectangle, but for any shape: clipping per pixel when nothing was clipped before.
//! Cost: O(1) per fragment; memory one bit per pixel.

use crate::curve::Contours;
use crate::raster::coverage::FillRule;
use crate::raster::polygon::{self, PolygonRasterizer};
use crate::raster::span::Span;
use crate::{Error, Result};

/// Mask of the pixels that may be drawn to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PixelMask {
    width: u32,
    /// Rows, each in whole words.
    words: Vec<u64>,
    per_row: usize,
}

/// The most pixels of a mask: 2³² bits are half a gigabyte.
const MAX_PIXELS: u64 = 1 << 32;

impl PixelMask {
    /// Creates a mask of this size without any pixel.
    ///
    /// # Errors
    /// [`Error::TooLarge`] above 2³² pixels.
    pub fn empty(width: u32, height: u32) -> Result<Self> {
        let pixels = u64::from(width) * u64::from(height);
        if pixels > MAX_PIXELS {
            return Err(Error::TooLarge {
                what: "number of pixels of a mask",
                value: pixels,
                limit: MAX_PIXELS,
            });
        }
        let per_row = width.div_ceil(64) as usize;
        Ok(Self { width, words: vec![0; per_row * height as usize], per_row })
    }

    /// Returns the pixels whose centres are inside contours, in pixels; with the even-odd rule
    /// every second contour inside another is a hole.
    ///
    /// # Errors
    /// As [`Self::empty`].
    pub fn of_contours(
        contours: &Contours,
        rule: FillRule,
        width: u32,
        height: u32,
    ) -> Result<Self> {
        let mut mask = Self::empty(width, height)?;
        let options = polygon::Options { rule };
        let set = |span: Span| {
            (span.x0..span.x1).for_each(|x| mask.set(x as u32, span.y as u32, true));
        };
        PolygonRasterizer::EdgeTable.fill(contours, width, height, &options, set);
        Ok(mask)
    }

    /// Sets whether a pixel may be drawn to; outside the mask nothing happens.
    pub fn set(&mut self, x: u32, y: u32, inside: bool) {
        if x >= self.width {
            return;
        }
        if let Some(word) = self.words.get_mut(y as usize * self.per_row + x as usize / 64) {
            let bit = 1 << (x % 64);
            *word = if inside { *word | bit } else { *word & !bit };
        }
    }

    /// Returns whether a pixel may be drawn to; none outside the mask may.
    #[inline]
    pub fn contains(&self, x: u32, y: u32) -> bool {
        let word = self.words.get(y as usize * self.per_row + x as usize / 64);
        x < self.width && word.is_some_and(|word| word >> (x % 64) & 1 == 1)
    }
}
