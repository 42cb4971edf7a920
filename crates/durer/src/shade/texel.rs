//! The steps of texture sampling, and the sums that it is made of.
//!
//! Textures: E. Catmull, *A Subdivision Algorithm for Computer Display of Curved Surfaces*, PhD thesis, 1974; J. F. Blinn,
//! M. E. Newell, *Texture and Reflection in Computer Generated Images*, CACM 19(10), 1976. Levels: L. Williams,
//! *Pyramidal Parametrics*, SIGGRAPH 1983. [`super::texture`] has the algorithm.

use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::{Vec2, Vec4};
use crate::scene::MipFilter;
use crate::trace::PseudocodeLine;

/// The facts of sampling one image: wrap modes, the nearest texel, bilinear filtering.
pub const INFO: Info = Info {
    name: "texture-sampling",
    title: "Texture sampling",
    authors: "E. Catmull; J. F. Blinn, M. E. Newell",
    year: 1976,
    source: "Texture and reflection in computer generated images, CACM 19(10)",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(1): one texel for the nearest, four for bilinear filtering, eight between two levels",
    limits: "one image, without levels, flickers where texels are smaller than pixels",
    pseudocode: &[
        "u, v at the pixel and its neighbours, perspective-correct; x, y ← the ways to these, in texels",
        "ρ ← max(|x|, |y|); λ ← log2 ρ",
        "λ ≤ 0, a texel is no smaller than a pixel: value ← filtered(0, filter for magnification)",
        "without levels: value ← filtered(0, filter for minification)",
        "nearest level: value ← filtered(⌊λ + ½⌋, filter for minification)",
        "between levels: d ← ⌊λ⌋; t ← λ − d; value ← (1 − t) · filtered(d) + t · filtered(d + 1)",
        "filtered(level of w × h texels, filter):",
        "    u ← u − ⌊u⌋ (repeat), folded at 1 (mirrored repeat), or held to 0 … 1 (clamp); v likewise",
        "    nearest: the texel (⌊u w⌋, ⌊v h⌋)",
        "    bilinear: i ← ⌊u w − ½⌋, a ← its fraction; j ← ⌊v h − ½⌋, b ← its fraction",
        "        texels (i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1), beyond the border by the wrap mode",
        "        their sum with the weights (1 − a)(1 − b), a (1 − b), (1 − a) b, a b",
        "a colour that is weighted by alpha: divide it by the alpha of the sum",
    ],
};

/// The facts of mip maps: smaller and smaller images, chosen by the size of a pixel in texels.
pub const MIP_MAP: Info = Info {
    name: "mip-map",
    title: "Mip maps",
    authors: "L. Williams",
    year: 1983,
    source: "Pyramidal parametrics, SIGGRAPH 1983",
    coherence: &[Coherence::Area],
    cost: "O(texels) once and a third more memory; then O(1), eight texels",
    limits: "a pixel counts as a square: textures seen at a slant become too soft",
    ..INFO
};

/// Step of taking one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The levels were chosen.
    Detail {
        /// Ways to the next pixel to the right and downwards, in texels of the image.
        ways: [Vec2; 2],
        /// Logarithm to base 2 of the longer one: the level of detail, −∞ where both are 0.
        lod: f32,
        /// Filter between the levels.
        mip: MipFilter,
        /// The level, or the larger one of two.
        level: usize,
        /// Weight of the next level, if there are two.
        weight: Option<f32>,
    },
    /// The coordinates were brought to 0 … 1 by the wrap modes.
    Wrapped {
        /// Level.
        level: usize,
        /// Columns and rows of the level.
        size: [u32; 2],
        /// Coordinates.
        from: Vec2,
        /// Coordinates in 0 … 1.
        to: Vec2,
    },
    /// The nearest texel was fetched.
    Nearest {
        /// Level.
        level: usize,
        /// Column and row.
        texel: [u32; 2],
        /// Its value; a colour is multiplied by alpha if that weights it.
        value: Vec4,
    },
    /// Four texels were fetched and weighted.
    Bilinear {
        /// Level.
        level: usize,
        /// Columns and rows of the texels: row by row, from the left.
        texels: [[u32; 2]; 4],
        /// Weights of the second column and of the second row.
        fractions: [f32; 2],
        /// Values of the texels.
        values: [Vec4; 4],
        /// Their weighted sum.
        value: Vec4,
    },
    /// The values of two levels were weighted.
    Between {
        /// Weight of the second one.
        weight: f32,
        /// The weighted sum.
        value: Vec4,
    },
    /// The colour was divided by its alpha.
    Divided(Vec4),
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Detail { lod, .. } if *lod <= 0.0 => 3,
            Self::Detail { mip: MipFilter::None, .. } => 4,
            Self::Detail { mip: MipFilter::Nearest, .. } => 5,
            Self::Detail { mip: MipFilter::Linear, .. } | Self::Between { .. } => 6,
            Self::Wrapped { .. } => 8,
            Self::Nearest { .. } => 9,
            Self::Bilinear { .. } => 12,
            Self::Divided(_) => 13,
        }
    }
}

/// Returns the sample that a list of steps leads to: computed from their texels and weights.
pub fn replay(steps: &[Step]) -> Vec4 {
    let [mut last, mut before] = [Vec4::ZERO; 2];
    for step in steps {
        let value = match *step {
            Step::Detail { .. } | Step::Wrapped { .. } => continue,
            Step::Nearest { value, .. } => value,
            Step::Bilinear { fractions, values, .. } => bilinear(values, fractions),
            Step::Between { weight, .. } => mix(before, last, weight),
            Step::Divided(_) => super::color::unpremultiply(last),
        };
        (before, last) = (last, value);
    }
    last
}

/// Returns the weights of four texels, row by row, from those of the second column and of the second row.
///
/// ```
/// use durer::shade::texture::weights;
/// assert_eq!(weights([0.75, 0.5]), [0.125, 0.375, 0.125, 0.375]);
/// ```
pub fn weights([a, b]: [f32; 2]) -> [f32; 4] {
    [(1.0 - a) * (1.0 - b), a * (1.0 - b), (1.0 - a) * b, a * b]
}

/// Returns the weighted sum of four texels: along the rows, then between them.
#[inline(always)]
pub(super) fn bilinear(values: [Vec4; 4], [a, b]: [f32; 2]) -> Vec4 {
    mix(mix(values[0], values[1], a), mix(values[2], values[3], a), b)
}

/// Returns the weighted sum of two values, `t` being the weight of the second.
#[inline(always)]
pub(super) fn mix(first: Vec4, second: Vec4, t: f32) -> Vec4 {
    first * (1.0 - t) + second * t
}
