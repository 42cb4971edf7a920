//! Blending: factors and equations (OpenGL 4.6, 17.3.6), and the operator *over* (Porter and Duff,
//! *Compositing Digital Images*, SIGGRAPH 1984) on straight and on premultiplied alpha. Linear light.

use crate::math::{Vec3, Vec4};

/// Factor of source or destination.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Factor {
    /// 0.
    Zero,
    /// 1.
    One,
    /// The source, channel by channel.
    Source,
    /// 1 − the source.
    OneMinusSource,
    /// The destination, channel by channel.
    Destination,
    /// 1 − the destination.
    OneMinusDestination,
    /// The source's alpha.
    SourceAlpha,
    /// 1 − the source's alpha.
    OneMinusSourceAlpha,
    /// The destination's alpha.
    DestinationAlpha,
    /// 1 − the destination's alpha.
    OneMinusDestinationAlpha,
    /// The constant, channel by channel.
    Constant,
    /// 1 − the constant.
    OneMinusConstant,
    /// The constant's alpha.
    ConstantAlpha,
    /// 1 − the constant's alpha.
    OneMinusConstantAlpha,
    /// The smaller of source alpha and 1 − destination alpha for colours; 1 for alpha.
    SourceAlphaSaturate,
}

impl Factor {
    /// All fifteen.
    pub const ALL: [Self; 15] = [
        Self::Zero,
        Self::One,
        Self::Source,
        Self::OneMinusSource,
        Self::Destination,
        Self::OneMinusDestination,
        Self::SourceAlpha,
        Self::OneMinusSourceAlpha,
        Self::DestinationAlpha,
        Self::OneMinusDestinationAlpha,
        Self::Constant,
        Self::OneMinusConstant,
        Self::ConstantAlpha,
        Self::OneMinusConstantAlpha,
        Self::SourceAlphaSaturate,
    ];

    /// Returns the factor of each channel.
    #[inline]
    fn value(self, source: Vec4, destination: Vec4, constant: Vec4) -> Vec4 {
        match self {
            Self::Zero => Vec4::ZERO,
            Self::One => Vec4::ONE,
            Self::Source => source,
            Self::OneMinusSource => Vec4::ONE - source,
            Self::Destination => destination,
            Self::OneMinusDestination => Vec4::ONE - destination,
            Self::SourceAlpha => Vec4::splat(source.w),
            Self::OneMinusSourceAlpha => Vec4::splat(1.0 - source.w),
            Self::DestinationAlpha => Vec4::splat(destination.w),
            Self::OneMinusDestinationAlpha => Vec4::splat(1.0 - destination.w),
            Self::Constant => constant,
            Self::OneMinusConstant => Vec4::ONE - constant,
            Self::ConstantAlpha => Vec4::splat(constant.w),
            Self::OneMinusConstantAlpha => Vec4::splat(1.0 - constant.w),
            Self::SourceAlphaSaturate => Vec3::splat(source.w.min(1.0 - destination.w)).extend(1.0),
        }
    }
}

/// Operation that joins the two products.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Equation {
    /// Source + destination.
    #[default]
    Add,
    /// Source − destination.
    Subtract,
    /// Destination − source.
    ReverseSubtract,
    /// The smaller of source and destination; factors are ignored.
    Min,
    /// The larger of source and destination; factors are ignored.
    Max,
}

impl Equation {
    /// All five.
    pub const ALL: [Self; 5] =
        [Self::Add, Self::Subtract, Self::ReverseSubtract, Self::Min, Self::Max];
}

/// Factors and equation of some channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Function {
    /// Factor of the source.
    pub source: Factor,
    /// Factor of the destination.
    pub destination: Factor,
    /// Equation that joins the products.
    pub equation: Equation,
}

impl Default for Function {
    /// Returns the default: source · 1 + destination · 0, OpenGL's initial state.
    fn default() -> Self {
        Self { source: Factor::One, destination: Factor::Zero, equation: Equation::Add }
    }
}

impl Function {
    #[inline]
    fn apply(&self, source: Vec4, destination: Vec4, constant: Vec4) -> Vec4 {
        let value = |f: Factor| f.value(source, destination, constant);
        let s = || source * value(self.source);
        let d = || destination * value(self.destination);
        match self.equation {
            Equation::Add => s() + d(),
            Equation::Subtract => s() - d(),
            Equation::ReverseSubtract => d() - s(),
            Equation::Min => source.min(destination),
            Equation::Max => source.max(destination),
        }
    }
}

/// Blending of a fragment with the stored colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Blend {
    /// Source over destination, both with straight alpha; right over transparent destinations too.
    Over,
    /// OpenGL's blending of the channels as they are stored.
    Functions {
        /// Function for red, green and blue.
        color: Function,
        /// Function for alpha.
        alpha: Function,
        /// The constant colour, linear.
        constant: Vec4,
    },
}

impl Blend {
    /// Returns the blended colour, clamped to 0…1.
    #[inline]
    pub fn apply(&self, source: Vec4, destination: Vec4) -> Vec4 {
        match self {
            Self::Over => over_straight(source, destination),
            Self::Functions { color, alpha, constant } => {
                let rgb = color.apply(source, destination, *constant);
                let a = alpha.apply(source, destination, *constant).w;
                rgb.truncate().extend(a).clamp(Vec4::ZERO, Vec4::ONE)
            }
        }
    }
}

/// Blends source over destination, straight alpha; transparent black if both are transparent.
#[inline(always)]
pub fn over_straight(source: Vec4, destination: Vec4) -> Vec4 {
    let under = destination.w * (1.0 - source.w);
    let alpha = source.w + under;
    if alpha > 0.0 {
        let color = (source.truncate() * source.w + destination.truncate() * under) / alpha;
        color.extend(alpha)
    } else {
        Vec4::ZERO
    }
}

/// Blends source over destination, premultiplied alpha.
#[inline(always)]
pub fn over_premultiplied(source: Vec4, destination: Vec4) -> Vec4 {
    source + destination * (1.0 - source.w)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shade::color::{premultiply, unpremultiply};

    const SOURCE: [f32; 4] = [0.9, 0.25, 0.0, 0.75];
    const DESTINATION: [f32; 4] = [0.5, 1.0, 0.125, 0.375];
    const CONSTANT: [f32; 4] = [0.1, 0.2, 0.3, 0.4];

    /// Returns the specification's table 17.2, channel by channel.
    fn table(factor: Factor, channel: usize) -> f32 {
        let (s, d, c) = (SOURCE, DESTINATION, CONSTANT);
        match factor {
            Factor::Zero => 0.0,
            Factor::One => 1.0,
            Factor::Source => s[channel],
            Factor::OneMinusSource => 1.0 - s[channel],
            Factor::Destination => d[channel],
            Factor::OneMinusDestination => 1.0 - d[channel],
            Factor::SourceAlpha => s[3],
            Factor::OneMinusSourceAlpha => 1.0 - s[3],
            Factor::DestinationAlpha => d[3],
            Factor::OneMinusDestinationAlpha => 1.0 - d[3],
            Factor::Constant => c[channel],
            Factor::OneMinusConstant => 1.0 - c[channel],
            Factor::ConstantAlpha => c[3],
            Factor::OneMinusConstantAlpha => 1.0 - c[3],
            Factor::SourceAlphaSaturate if channel == 3 => 1.0,
            Factor::SourceAlphaSaturate => s[3].min(1.0 - d[3]),
        }
    }

    fn channel(f: Function, i: usize) -> f32 {
        let (s, d) = (SOURCE[i], DESTINATION[i]);
        let (sf, df) = (table(f.source, i), table(f.destination, i));
        let value = match f.equation {
            Equation::Add => s * sf + d * df,
            Equation::Subtract => s * sf - d * df,
            Equation::ReverseSubtract => d * df - s * sf,
            Equation::Min => s.min(d),
            Equation::Max => s.max(d),
        };
        value.clamp(0.0, 1.0)
    }

    #[test]
    fn all_factors_and_equations_are_the_specifications() {
        let (s, d) = (Vec4::from_array(SOURCE), Vec4::from_array(DESTINATION));
        let functions = || {
            Factor::ALL.into_iter().flat_map(|source| {
                Factor::ALL.into_iter().flat_map(move |destination| {
                    Equation::ALL.map(|equation| Function { source, destination, equation })
                })
            })
        };
        // Colour and alpha separately: each function for colour with another one for alpha.
        for (color, alpha) in functions().zip(functions().skip(7).cycle()) {
            let blend = Blend::Functions { color, alpha, constant: CONSTANT.into() };
            let found = blend.apply(s, d).to_array();
            for (i, found) in found.into_iter().enumerate() {
                let expected = channel(if i < 3 { color } else { alpha }, i);
                assert_eq!(found, expected, "{color:?} {alpha:?} channel {i}");
            }
        }
    }

    #[test]
    fn over_is_the_same_on_straight_and_premultiplied_alpha() {
        for (a, b) in (0..=8).flat_map(|a| (0..=8).map(move |b| (a as f32 / 8.0, b as f32 / 8.0))) {
            let s = Vec4::new(0.9, 0.25, 0.0, a);
            let d = Vec4::new(0.5, 1.0, 0.125, b);
            let straight = over_straight(s, d);
            let other = unpremultiply(over_premultiplied(premultiply(s), premultiply(d)));
            assert!((straight - other).abs().max_element() < 1e-6, "{a} {b}");
        }
        let opaque = Vec4::new(0.3, 0.2, 0.1, 1.0);
        assert_eq!(over_straight(opaque, Vec4::ONE), opaque);
        assert_eq!(over_straight(Vec4::ZERO, opaque), opaque);
        assert_eq!(over_straight(Vec4::ZERO, Vec4::ZERO), Vec4::ZERO);
    }
}
