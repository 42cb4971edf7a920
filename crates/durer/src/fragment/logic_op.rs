//! Logic operations: the drawn and the stored value, combined bit by bit (OpenGL 4.6, 17.3.9).

/// A function of a source bit and a destination bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LogicOp {
    /// 0.
    Clear,
    /// s ∧ d.
    And,
    /// s ∧ ¬d.
    AndReverse,
    /// s.
    Copy,
    /// ¬s ∧ d.
    AndInverted,
    /// d.
    Noop,
    /// s ⊕ d.
    Xor,
    /// s ∨ d.
    Or,
    /// ¬(s ∨ d).
    Nor,
    /// ¬(s ⊕ d).
    Equivalent,
    /// ¬d.
    Invert,
    /// s ∨ ¬d.
    OrReverse,
    /// ¬s.
    CopyInverted,
    /// ¬s ∨ d.
    OrInverted,
    /// ¬(s ∧ d).
    Nand,
    /// 1.
    Set,
}

impl LogicOp {
    /// All sixteen, in OpenGL's order.
    pub const ALL: [Self; 16] = [
        Self::Clear,
        Self::And,
        Self::AndReverse,
        Self::Copy,
        Self::AndInverted,
        Self::Noop,
        Self::Xor,
        Self::Or,
        Self::Nor,
        Self::Equivalent,
        Self::Invert,
        Self::OrReverse,
        Self::CopyInverted,
        Self::OrInverted,
        Self::Nand,
        Self::Set,
    ];

    /// Returns the operation on all bits of a channel.
    #[inline]
    pub fn apply(self, s: u8, d: u8) -> u8 {
        match self {
            Self::Clear => 0,
            Self::And => s & d,
            Self::AndReverse => s & !d,
            Self::Copy => s,
            Self::AndInverted => !s & d,
            Self::Noop => d,
            Self::Xor => s ^ d,
            Self::Or => s | d,
            Self::Nor => !(s | d),
            Self::Equivalent => !(s ^ d),
            Self::Invert => !d,
            Self::OrReverse => s | !d,
            Self::CopyInverted => !s,
            Self::OrInverted => !s | d,
            Self::Nand => !(s & d),
            Self::Set => 0xff,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_operation_has_its_own_truth_table() {
        // X11's and OpenGL's numbering is the truth table itself: bit 0 for s = d = 1, bit 1 for
        // s = 1, d = 0, bit 2 for s = 0, d = 1, bit 3 for s = d = 0.
        for (table, op) in LogicOp::ALL.into_iter().enumerate() {
            for (bit, s, d) in [(0, 1, 1), (1, 1, 0), (2, 0, 1), (3, 0, 0)] {
                let expected = (table >> bit & 1) as u8;
                assert_eq!(op.apply(s, d) & 1, expected, "{op:?} {s} {d}");
            }
            for (s, d) in [(0x5a, 0x33), (0xff, 0x0f)] {
                for bit in 0..8 {
                    let one = op.apply(s >> bit & 1, d >> bit & 1) & 1;
                    assert_eq!(op.apply(s, d) >> bit & 1, one, "{op:?}");
                }
            }
        }
    }
}
