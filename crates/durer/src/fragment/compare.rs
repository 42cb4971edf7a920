//! The eight comparisons of alpha, stencil and depth test (OpenGL 4.6, 17.3).

/// Comparison of an incoming value with a stored one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Compare {
    /// No fragment passes.
    Never,
    /// Passes where incoming < stored.
    Less,
    /// Passes where incoming = stored.
    Equal,
    /// Passes where incoming ≤ stored.
    LessEqual,
    /// Passes where incoming > stored.
    Greater,
    /// Passes where incoming ≠ stored.
    NotEqual,
    /// Passes where incoming ≥ stored.
    GreaterEqual,
    /// Every fragment passes.
    Always,
}

impl Compare {
    /// All eight, in OpenGL's order.
    pub const ALL: [Self; 8] = [
        Self::Never,
        Self::Less,
        Self::Equal,
        Self::LessEqual,
        Self::Greater,
        Self::NotEqual,
        Self::GreaterEqual,
        Self::Always,
    ];

    /// Returns whether the incoming value passes. NaN passes `NotEqual` and `Always` alone.
    #[inline(always)]
    pub fn passes<T: PartialOrd>(self, incoming: T, stored: T) -> bool {
        match self {
            Self::Never => false,
            Self::Less => incoming < stored,
            Self::Equal => incoming == stored,
            Self::LessEqual => incoming <= stored,
            Self::Greater => incoming > stored,
            Self::NotEqual => incoming != stored,
            Self::GreaterEqual => incoming >= stored,
            Self::Always => true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_function_is_the_set_of_orders_it_names() {
        // OpenGL's enumerants GL_NEVER + i spell the set in bits: 1 less, 2 equal, 4 greater.
        for (set, function) in Compare::ALL.into_iter().enumerate() {
            assert_eq!(function.passes(1, 2), set & 1 != 0, "{function:?}");
            assert_eq!(function.passes(2, 2), set & 2 != 0, "{function:?}");
            assert_eq!(function.passes(3, 2), set & 4 != 0, "{function:?}");
            let nan = matches!(function, Compare::NotEqual | Compare::Always);
            assert_eq!(function.passes(f32::NAN, 2.0), nan, "{function:?}");
        }
    }
}
