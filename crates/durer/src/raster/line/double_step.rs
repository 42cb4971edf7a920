//! The double-step line: two pixels at a time.
//!
//! X. Wu, J. G. Rokne, *Double-step incremental generation of lines and circles*, Computer Vision, Graphics, and Image
//! Processing 37(3), 1987. Class: image space. Two steps along the longer axis go across in one of four patterns: not
//! at all (1), in the second step (2), in the first (3), in both (4). A line of slope below ½ has no pattern 4, any
//! other no pattern 1; so one decision separates pattern 1 or 4 from the other two, and only these need a second one.
//! Cost: half to all of Bresenham's decisions, and half of his additions.
//!
//! Ties go as in the family. The paper's second idea, to draw a line from both ends at once, is left out.

use super::{Course, Options};
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::IVec2;
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "double-step",
    title: "Double-step line",
    authors: "X. Wu, J. G. Rokne",
    year: 1987,
    source: "Double-step incremental generation of lines and circles, CVGIP 37(3)",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge],
    cost: "O(n), one or two decisions and one addition for two pixels",
    limits: "none",
    pseudocode: &[
        "Δx ← |x2 − x1|, Δy ← |y2 − y1|; if Δy > Δx: swap the roles of x and y",
        "light (x1, y1)",
        "if 2Δy < Δx: D ← 4Δy − Δx",
        "else: D ← 4Δy − 3Δx",
        "while two steps are left:",
        "    if 2Δy < Δx and D ≤ 0: pattern 1, both straight",
        "    if 2Δy ≥ Δx and D > 0: pattern 4, both diagonal",
        "    else: if D ≤ 2Δy (or 2Δy − 2Δx): pattern 2, straight, then diagonal",
        "          else: pattern 3, diagonal, then straight",
        "    light two pixels",
        "    D ← D + 4Δy − 2Δx · the diagonal steps",
        "one step is left: E ← D − 2Δy (or + 2Δx); straight if E ≤ 0, else diagonal",
    ],
};

/// Way of two steps along the longer axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum StepPattern {
    /// Pattern 1: both steps straight on.
    Straight,
    /// Pattern 2: straight on, then aslant.
    Second,
    /// Pattern 3: aslant, then straight on.
    First,
    /// Pattern 4: both steps aslant.
    Aslant,
}

impl StepPattern {
    /// Returns the number that the paper gives it.
    pub(crate) const fn number(self) -> u8 {
        match self {
            Self::Straight => 1,
            Self::Second => 2,
            Self::First => 3,
            Self::Aslant => 4,
        }
    }

    /// Returns the distances across after the first and the second step.
    const fn across(self) -> [i64; 2] {
        match self {
            Self::Straight => [0, 0],
            Self::Second => [0, 1],
            Self::First => [1, 1],
            Self::Aslant => [1, 2],
        }
    }

    /// Returns the number of comparisons that found it.
    pub const fn decisions(self) -> usize {
        match self {
            Self::Straight | Self::Aslant => 1,
            Self::Second | Self::First => 2,
        }
    }
}

/// Step of the algorithm. Steps come in the direction of rising coordinates along the longer axis, in which pixels are plotted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// The first pixel is lit.
    Start {
        /// The pixel.
        pixel: IVec2,
        /// D at the beginning.
        d: i64,
    },
    /// Two pixels are lit.
    Pair {
        /// Their pattern.
        pattern: StepPattern,
        /// D that decided on it.
        d: i64,
        /// The pixels.
        pixels: [IVec2; 2],
    },
    /// A single step was left.
    Last {
        /// E that decided on it, as in Bresenham's algorithm.
        e: i64,
        /// The pixel.
        pixel: IVec2,
    },
}

impl Step {
    /// Returns the pixels that the step lights.
    pub fn pixels(&self) -> &[IVec2] {
        match self {
            Self::Start { pixel, .. } | Self::Last { pixel, .. } => std::slice::from_ref(pixel),
            Self::Pair { pixels, .. } => pixels,
        }
    }
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Start { .. } => 2,
            Self::Pair { pattern: StepPattern::Straight, .. } => 6,
            Self::Pair { pattern: StepPattern::Aslant, .. } => 7,
            Self::Pair { pattern: StepPattern::Second, .. } => 8,
            Self::Pair { pattern: StepPattern::First, .. } => 9,
            Self::Last { .. } => 12,
        }
    }
}

/// Returns the pixels that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<IVec2> {
    steps.iter().flat_map(Step::pixels).copied().collect()
}

/// Calls `plot` for the pixels of the line between two pixels, both included; any 32-bit coordinates.
///
/// ```
/// use durer::math::IVec2;
/// use durer::raster::line::{Options, double_step};
/// use durer::trace::NoTrace;
///
/// let mut pixels = Vec::new();
/// let (from, to) = (IVec2::new(0, 0), IVec2::new(4, 2));
/// double_step::draw(from, to, &Options::default(), |p| pixels.push((p.x, p.y)), &mut NoTrace);
/// assert_eq!(pixels, [(0, 0), (1, 0), (2, 1), (3, 1), (4, 2)]);
/// ```
pub fn draw(
    from: IVec2,
    to: IVec2,
    options: &Options,
    mut plot: impl FnMut(IVec2),
    t: &mut impl Tracer<Step>,
) {
    let course = Course::new(from, to, options);
    if course.first > course.last {
        return;
    }
    let (run, rise) = (course.steps, course.rise);
    // Of ties the smaller coordinate across: aslant where the line falls.
    let tie = i64::from(course.sign < 0);
    let is_positive = |v: i64| v + tie > 0;
    let mut distance = (course.numerator(course.first) / course.denominator()) as i64;
    let mut step = course.first;
    // From D to Bresenham's E, which decides on a single step.
    let e_from_d = if 2 * rise < run { -2 * rise } else { 2 * run - 2 * rise };
    let mut d = first_error(&course, step, distance) - e_from_d;
    let pixel = course.pixel(step, distance);
    t.step(|| Step::Start { pixel, d });
    plot(pixel);
    while step + 2 <= course.last {
        let pattern = match (2 * rise < run, is_positive(d)) {
            (true, false) => StepPattern::Straight,
            (false, true) => StepPattern::Aslant,
            _ if is_positive(d + e_from_d) => StepPattern::First,
            _ => StepPattern::Second,
        };
        let [first, second] = pattern.across();
        let pixels =
            [course.pixel(step + 1, distance + first), course.pixel(step + 2, distance + second)];
        t.step(|| Step::Pair { pattern, d, pixels });
        pixels.into_iter().for_each(&mut plot);
        d += 4 * rise - 2 * run * second;
        (step, distance) = (step + 2, distance + second);
    }
    if step < course.last {
        let e = d + e_from_d;
        let pixel = course.pixel(step + 1, distance + i64::from(is_positive(e)));
        t.step(|| Step::Last { e, pixel });
        plot(pixel);
    }
}

/// Returns Bresenham's E after a number of steps, in the direction of rising coordinates.
fn first_error(course: &Course, step: i64, distance: i64) -> i64 {
    let (run, rise) = (i128::from(course.steps), i128::from(course.rise));
    (2 * rise * (i128::from(step) + 1) - run * (1 + 2 * i128::from(distance))) as i64
}
