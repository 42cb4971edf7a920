//! Steps of the fragment operations, and their facts.

use super::Fragment;
use crate::info::{Class, Info, Occluder};
use crate::math::Vec4;
use crate::target::Framebuffer;
use crate::trace::PseudocodeLine;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "fragment-operations",
    title: "Fragment operations",
    authors: "M. Segal, K. Akeley",
    year: 1992,
    source: "The OpenGL Graphics System, 4.6, chapter 17, and 2.1, chapter 4",
    class: Class::ImageSpace,
    occluder: Occluder::Point,
    coherence: &[],
    cost: "O(1) per fragment",
    limits: "one sample per pixel",
    pseudocode: &[
        "for each fragment (x, y, z, colour):",
        "    outside the scissor rectangle: drop it",
        "    alpha test fails: drop it",
        "    stencil test: compare the reference with the stored value",
        "    update the stored value, by which of stencil and depth test failed",
        "    stencil test failed: drop it",
        "    depth test: z against the stored depth; failed: drop it",
        "    depth(x, y) ← z",
        "    blend with the stored colour, or",
        "        combine with it by a logic operation",
        "    dither, round to 8 bits",
        "    write the channels that the masks enable",
    ],
};

/// Step in the processing of a fragment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The fragment is within the framebuffer and the scissor rectangle, or not.
    Scissor {
        /// The fragment.
        fragment: Fragment,
        /// True if the fragment passes.
        passes: bool,
    },
    /// Its alpha was compared.
    Alpha {
        /// Its alpha.
        alpha: f32,
        /// The reference, 0 … 1.
        reference: f32,
        /// True if the fragment passes.
        passes: bool,
    },
    /// The stencil value was compared and updated.
    Stencil {
        /// The stored value.
        stored: u8,
        /// The reference.
        reference: u8,
        /// True if the fragment continues.
        passes: bool,
        /// The stored value from now on.
        new: u8,
    },
    /// Its depth was compared.
    Depth {
        /// Its depth.
        depth: f32,
        /// The stored depth.
        stored: f32,
        /// True if the fragment passes.
        passes: bool,
    },
    /// Its colour was blended.
    Blend {
        /// Its colour, linear RGBA.
        source: Vec4,
        /// The stored colour, linear RGBA.
        stored: Vec4,
        /// The result, linear RGBA.
        result: Vec4,
    },
    /// It is written.
    Write {
        /// Content of the colour plane from now on, if it has one.
        color: Option<[u8; 4]>,
        /// Content of the plane of indices from now on, if there is one.
        index: Option<u8>,
        /// Content of the depth plane from now on, if it is written.
        depth: Option<f32>,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Scissor { .. } => 2,
            Self::Alpha { .. } => 3,
            Self::Stencil { passes: true, .. } => 5,
            Self::Stencil { passes: false, .. } => 6,
            Self::Depth { .. } => 7,
            Self::Blend { .. } => 9,
            Self::Write { .. } => 12,
        }
    }
}

/// Applies the steps of fragments to the colour, index, depth and stencil planes of a framebuffer.
pub fn replay(steps: &[Step], target: &mut Framebuffer) {
    let mut at = [0, 0];
    for step in steps {
        let [x, y] = at;
        match *step {
            Step::Scissor { fragment, .. } => at = [fragment.x, fragment.y],
            Step::Stencil { new, .. } => {
                target.stencil.iter_mut().for_each(|plane| plane.set(x, y, new));
            }
            Step::Write { color, index, depth } => {
                color.into_iter().for_each(|color| target.color.set(x, y, color));
                if let Some(plane) = &mut target.index {
                    index.into_iter().for_each(|index| plane.set(x, y, index));
                }
                if let Some(plane) = &mut target.depth {
                    depth.into_iter().for_each(|depth| plane.set(x, y, depth));
                }
            }
            Step::Alpha { .. } | Step::Depth { .. } | Step::Blend { .. } => {}
        }
    }
}
