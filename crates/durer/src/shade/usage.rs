//! The meaning of texels.

use super::color::{decode_rgba8, decode_unorm8};
use crate::math::Vec4;

/// Meaning of a texture's 8-bit values, which decides how they are averaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Usage {
    /// sRGB colour, averaged in linear light; alpha has no say.
    Color,
    /// sRGB colour weighted by its alpha, so that transparent texels do not show at borders.
    ColorWithAlpha,
    /// Numbers, averaged as they are.
    Data,
}

impl Usage {
    /// Returns one texel as numbers 0…1; colours become linear.
    #[inline(always)]
    pub(super) fn decode(self, code: [u8; 4]) -> Vec4 {
        match self {
            Self::Data => Vec4::from_array(code.map(decode_unorm8)),
            _ => decode_rgba8(code),
        }
    }
}
