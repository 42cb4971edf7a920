//! The stencil test, with its own state for front and back faces (OpenGL 4.6, 17.3.3).

use super::Compare;

/// Operation on a stencil value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum StencilOp {
    /// It stays.
    #[default]
    Keep,
    /// It becomes 0.
    Zero,
    /// It becomes the reference.
    Replace,
    /// One more, 255 stays.
    Increment,
    /// One less, 0 stays.
    Decrement,
    /// All bits are turned over.
    Invert,
    /// One more, 255 becomes 0.
    IncrementWrap,
    /// One less, 0 becomes 255.
    DecrementWrap,
}

impl StencilOp {
    /// All eight.
    pub const ALL: [Self; 8] = [
        Self::Keep,
        Self::Zero,
        Self::Replace,
        Self::Increment,
        Self::Decrement,
        Self::Invert,
        Self::IncrementWrap,
        Self::DecrementWrap,
    ];

    /// Returns the new value.
    #[inline(always)]
    pub fn apply(self, stored: u8, reference: u8) -> u8 {
        match self {
            Self::Keep => stored,
            Self::Zero => 0,
            Self::Replace => reference,
            Self::Increment => stored.saturating_add(1),
            Self::Decrement => stored.saturating_sub(1),
            Self::Invert => !stored,
            Self::IncrementWrap => stored.wrapping_add(1),
            Self::DecrementWrap => stored.wrapping_sub(1),
        }
    }
}

/// Test and operations for faces of one side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct StencilFace {
    /// The comparison; the reference is the incoming value.
    pub compare: Compare,
    /// Reference value for the comparison.
    pub reference: u8,
    /// Bits that are compared, of reference and stored value.
    pub read_mask: u8,
    /// Operation if the stencil test fails.
    pub fail: StencilOp,
    /// Operation if the stencil test passes and the depth test fails.
    pub depth_fail: StencilOp,
    /// Operation if both pass, or there is no depth test.
    pub pass: StencilOp,
}

impl Default for StencilFace {
    /// Returns the state that always passes and keeps everything: OpenGL's initial state.
    fn default() -> Self {
        Self {
            compare: Compare::Always,
            reference: 0,
            read_mask: 0xff,
            fail: StencilOp::Keep,
            depth_fail: StencilOp::Keep,
            pass: StencilOp::Keep,
        }
    }
}

impl StencilFace {
    /// Returns whether the fragment passes over this stored value.
    #[inline(always)]
    pub fn passes(&self, stored: u8) -> bool {
        self.compare.passes(self.reference & self.read_mask, stored & self.read_mask)
    }

    /// Returns the operation that follows; `depth` is the depth test's answer.
    #[inline(always)]
    pub fn operation(&self, stencil: bool, depth: bool) -> StencilOp {
        match (stencil, depth) {
            (false, _) => self.fail,
            (true, false) => self.depth_fail,
            (true, true) => self.pass,
        }
    }
}

/// The stencil test for both sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Stencil {
    /// State for fragments of front faces, points and lines.
    pub front: StencilFace,
    /// State for fragments of back faces.
    pub back: StencilFace,
}

impl Stencil {
    /// Creates a test with the same state for both sides.
    pub fn both(face: StencilFace) -> Self {
        Self { front: face, back: face }
    }

    /// Returns the state for one side.
    #[inline(always)]
    pub(crate) fn face(&self, front_facing: bool) -> &StencilFace {
        if front_facing { &self.front } else { &self.back }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operations_are_opengls_for_every_value() {
        for (stored, reference) in (0..=255_u8).flat_map(|s| [0, 7, 255].map(|r| (s, r))) {
            let s = i32::from(stored);
            let expected = [
                s,
                0,
                i32::from(reference),
                (s + 1).min(255),
                (s - 1).max(0),
                255 - s,
                (s + 1) % 256,
                (s + 255) % 256,
            ];
            for (op, expected) in StencilOp::ALL.into_iter().zip(expected) {
                assert_eq!(i32::from(op.apply(stored, reference)), expected, "{op:?} {stored}");
            }
        }
    }

    #[test]
    fn only_masked_bits_are_compared() {
        for (compare, mask) in
            Compare::ALL.into_iter().flat_map(|c| [0, 0x0f, 0xf0, 0xff].map(|m| (c, m)))
        {
            for (reference, stored) in [(0x12, 0x32), (0x12, 0x13), (0x21, 0x12), (0, 0xff)] {
                let face =
                    StencilFace { compare, reference, read_mask: mask, ..Default::default() };
                let expected = compare.passes(reference & mask, stored & mask);
                assert_eq!(face.passes(stored), expected);
            }
        }
    }

    #[test]
    fn the_three_operations_have_their_cases() {
        let face = StencilFace {
            fail: StencilOp::Zero,
            depth_fail: StencilOp::Invert,
            pass: StencilOp::Replace,
            ..StencilFace::default()
        };
        assert_eq!(face.operation(false, false), StencilOp::Zero);
        assert_eq!(face.operation(false, true), StencilOp::Zero);
        assert_eq!(face.operation(true, false), StencilOp::Invert);
        assert_eq!(face.operation(true, true), StencilOp::Replace);
    }
}
