//! The alpha test: fragments are dropped by their alpha (OpenGL 2.1, 4.1.4).

use super::Compare;

/// Test that passes where `alpha compare reference`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlphaTest {
    /// The comparison; the fragment's alpha is the incoming value.
    pub compare: Compare,
    /// Reference value for alpha; clamped to 0…1.
    pub reference: f32,
}

impl AlphaTest {
    /// Returns whether a fragment of this alpha passes.
    #[inline(always)]
    pub fn passes(&self, alpha: f32) -> bool {
        self.compare.passes(alpha, self.reference.clamp(0.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alpha_is_the_left_operand_and_the_reference_is_held() {
        for compare in Compare::ALL {
            for (alpha, reference, held) in [
                (0.2, 0.5, 0.5),
                (0.5, 0.5, 0.5),
                (0.9, 0.5, 0.5),
                (1.0, 7.0, 1.0),
                (0.0, -1.0, 0.0),
            ] {
                let test = AlphaTest { compare, reference };
                assert_eq!(test.passes(alpha), compare.passes(alpha, held), "{compare:?}");
            }
        }
        assert!(AlphaTest { compare: Compare::GreaterEqual, reference: 0.5 }.passes(0.5));
        assert!(!AlphaTest { compare: Compare::Greater, reference: 0.5 }.passes(0.5));
    }
}
