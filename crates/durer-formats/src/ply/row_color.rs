//! The colour of a row of faces or edges.

use super::body::Values;
use super::header::Type;
use crate::Result;
use crate::facets::Palette;
use crate::obj::corners::NONE;

/// The colour of the row that is read: values of sRGB, and alpha.
#[derive(Debug, Clone, Copy)]
pub(super) struct RowColor {
    rgba: [f32; 4],
    /// True if rows have one.
    used: bool,
}

impl RowColor {
    /// Creates a white colour; `used` tells whether rows have colours.
    pub fn new(used: bool) -> Self {
        Self { rgba: [1.0; 4], used }
    }

    /// Reads red, green, blue or alpha.
    ///
    /// # Errors
    /// A value that is missing or wrong.
    pub fn set(&mut self, part: usize, kind: Type, values: &mut impl Values) -> Result<()> {
        let value = values.next(kind)?;
        if let Some(to) = self.rgba.get_mut(part) {
            *to = (value / kind.full_scale()) as f32;
        }
        Ok(())
    }

    /// Returns its number in the palette; [`NONE`] if rows have no colours.
    pub fn number(self, palette: &mut Palette) -> u32 {
        if self.used { palette.number(self.rgba) } else { NONE }
    }
}
