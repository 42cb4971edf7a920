//! Write masks: which channels, depths, stencil and index bits may change (OpenGL 4.6,
//! 17.4.2; 2.1, 4.2.2).

/// Planes and channels that may be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct WriteMask {
    /// Red, green, blue, alpha.
    pub color: [bool; 4],
    /// Depth, and with it the item and the normal of the nearest surface.
    pub depth: bool,
    /// Stencil bits, for front and back faces.
    pub stencil: [u8; 2],
    /// Bits of colour indices.
    pub index: u8,
}

impl Default for WriteMask {
    /// Returns the default: everything is written.
    fn default() -> Self {
        Self { color: [true; 4], depth: true, stencil: [0xff; 2], index: 0xff }
    }
}

impl WriteMask {
    /// Returns the new channels where they may be written, the old ones elsewhere.
    #[inline(always)]
    pub(crate) fn color(&self, new: [u8; 4], old: [u8; 4]) -> [u8; 4] {
        std::array::from_fn(|i| if self.color[i] { new[i] } else { old[i] })
    }

    /// Returns the new stencil bits where they may be written, the old ones elsewhere.
    #[inline(always)]
    pub(crate) fn stencil(&self, front_facing: bool, new: u8, old: u8) -> u8 {
        let mask = self.stencil[usize::from(!front_facing)];
        (new & mask) | (old & !mask)
    }

    /// Returns the new bits of a colour index where they may be written, the old ones elsewhere.
    #[inline(always)]
    pub(crate) fn index(&self, new: u8, old: u8) -> u8 {
        (new & self.index) | (old & !self.index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_unmasked_bits_change() {
        let (new, old) = ([1, 2, 3, 4], [5, 6, 7, 8]);
        for bits in 0..16_usize {
            let mask = WriteMask {
                color: std::array::from_fn(|i| bits >> i & 1 == 1),
                ..WriteMask::default()
            };
            for (i, value) in mask.color(new, old).into_iter().enumerate() {
                assert_eq!(value, if bits >> i & 1 == 1 { new[i] } else { old[i] });
            }
        }
        let mask = WriteMask { stencil: [0x0f, 0xf0], index: 0x3c, ..WriteMask::default() };
        assert_eq!(mask.stencil(true, 0xab, 0xcd), 0xcb);
        assert_eq!(mask.stencil(false, 0xab, 0xcd), 0xad);
        assert_eq!(mask.index(0b1010_1010, 0b0101_0101), 0b0110_1001);
    }
}
