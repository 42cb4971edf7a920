//! Depth cueing and fog: with distance, colours approach the colour of the air.
//!
//! Depth cueing: J. D. Foley, A. van Dam, S. K. Feiner, J. F. Hughes, *Computer Graphics: Principles and Practice*, 2nd
//! ed. 1990, 14.3.4 and 16.1.3. Fog: *The OpenGL Graphics System* 2.1 (2006), 3.10. Cost: O(1). Limits: colours are
//! mixed as they are, linear light mixes as air does.

use crate::info::{Class, Info, Occluder};
use crate::math::{Vec4, exp2};
use crate::trace::{NoTrace, PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "fog",
    title: "Depth cueing and fog",
    authors: "J. D. Foley, A. van Dam, S. K. Feiner, J. F. Hughes; the OpenGL board",
    year: 1990,
    source: "Computer Graphics: Principles and Practice, 14.3.4 and 16.1.3; OpenGL 2.1, 3.10",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(1) per fragment",
    limits: "the same air everywhere",
    pseudocode: &[
        "z ← distance of the fragment from the eye",
        "depth cueing and linear fog:",
        "    f ← least + (1 − least) · (end − z) / (end − start), held to least … 1",
        "exponential fog:",
        "    f ← e^(−ρ z)",
        "squared fog:",
        "    f ← e^(−(ρ z)²)",
        "colour ← f · colour + (1 − f) · colour of the air; alpha stays",
    ],
};

/// Formula for the share of a colour that remains at a distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fog {
    /// Depth cueing: the whole colour up to `start`, the share `least` from `end` on, linear in between. With `least` =
    /// 0 it is OpenGL's linear fog, (end − z) / (end − start).
    Linear {
        /// Distance from the eye, world units.
        start: f32,
        /// Distance from the eye beyond `start`, world units.
        end: f32,
        /// Share that remains from `end` on, 0 … 1.
        least: f32,
    },
    /// e^(−density · z): air that takes the same share per unit.
    Exponential {
        /// Density per world unit.
        density: f32,
    },
    /// e^(−(density · z)²): clear nearby, thick soon.
    Squared {
        /// Density per world unit.
        density: f32,
    },
}

/// Step of the mixing of one colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The share that remains was computed.
    Share {
        /// The formula.
        fog: Fog,
        /// Distance from the eye.
        z: f32,
        /// Share that remains, 0 … 1.
        left: f32,
    },
    /// The colour was mixed.
    Mixed(Vec4),
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Share { fog: Fog::Linear { .. }, .. } => 3,
            Self::Share { fog: Fog::Exponential { .. }, .. } => 5,
            Self::Share { fog: Fog::Squared { .. }, .. } => 7,
            Self::Mixed(_) => 8,
        }
    }
}

/// Returns the colour that a list of steps leads to from a colour in some air.
pub fn replay(color: Vec4, air: Vec4, steps: &[Step]) -> Vec4 {
    let share = steps.iter().find_map(|step| match step {
        Step::Share { left, .. } => Some(*left),
        Step::Mixed(_) => None,
    });
    share.map_or(color, |left| mixed(color, air, left))
}

/// Returns a colour of which a share is left in the air; alpha stays.
fn mixed(color: Vec4, air: Vec4, left: f32) -> Vec4 {
    (color * left + air * (1.0 - left)).truncate().extend(color.w)
}

impl Fog {
    /// Returns the share of a colour that remains at a distance from the eye, 0 … 1; all of it for
    /// NaN.
    ///
    /// ```
    /// use durer::fragment::fog::Fog;
    /// let cue = Fog::Linear { start: 2.0, end: 4.0, least: 0.5 };
    /// assert_eq!([1.0, 2.0, 3.0, 4.0, 9.0].map(|z| cue.left(z)), [1.0, 1.0, 0.75, 0.5, 0.5]);
    /// ```
    pub fn left(&self, z: f32) -> f32 {
        let left = match *self {
            Self::Linear { start, end, least } => {
                let far = if z >= end { 0.0 } else { (end - z) / (end - start) };
                least + (1.0 - least) * far.clamp(0.0, 1.0)
            }
            Self::Exponential { density } => exp2(-(density * z) * std::f32::consts::LOG2_E),
            Self::Squared { density } => {
                let thick = density * z;
                exp2(-(thick * thick) * std::f32::consts::LOG2_E)
            }
        };
        if left.is_nan() { 1.0 } else { left.clamp(0.0, 1.0) }
    }

    /// Returns a colour at a distance, mixed with the air's; alpha stays.
    pub fn apply(&self, color: Vec4, air: Vec4, z: f32) -> Vec4 {
        self.apply_traced(color, air, z, &mut NoTrace)
    }

    /// Returns a colour as [`Self::apply`] does, with a listener for its steps.
    pub fn apply_traced(&self, color: Vec4, air: Vec4, z: f32, t: &mut impl Tracer<Step>) -> Vec4 {
        let left = self.left(z);
        t.step(|| Step::Share { fog: *self, z, left });
        let mixed = mixed(color, air, left);
        t.step(|| Step::Mixed(mixed));
        mixed
    }
}
