//! The digital differential analyzer: the slope is added once per step along the longer axis.
//!
//! After the mechanical integrators of the 1930s, and the DDA hardware of early plotters and displays.
//! Class: image space. Cost: one addition per pixel. The sum is a fixed-point number with 95 bits below
//! one, for with fewer the error could grow to a pixel over 2³² steps.

use super::{Course, Options, Step};
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::IVec2;
use crate::trace::Tracer;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "dda",
    title: "Digital differential analyzer",
    authors: "F. Steele and others",
    year: 1950,
    source: "MADDIDA, Northrop Aircraft",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge],
    cost: "O(n), one wide addition per pixel",
    limits: "none",
    pseudocode: &[
        "Δx ← x2 − x1, Δy ← y2 − y1",
        "if |Δy| > |Δx|: swap the roles of x and y",
        "m ← Δy / Δx, y ← y1",
        "for each x from x1 to x2:",
        "    // y is the sum of all m so far",
        "    set pixel (x, ⌊y + ½⌋)",
        "    y ← y + m",
        "// one addition and one rounding per pixel",
    ],
};

/// Bits below one: 32 more than the longest line has steps, twice over, and the sum still fits 127.
const BITS: u32 = 95;

/// Calls `plot` for the pixels of the line between two pixels, both included.
pub fn draw(
    from: IVec2,
    to: IVec2,
    options: &Options,
    mut plot: impl FnMut(IVec2),
    t: &mut impl Tracer<Step>,
) {
    let course = Course::new(from, to, options);
    let slope = ((course.rise as u128) << BITS) / course.steps.max(1) as u128;
    // Half a pixel, so that cutting off rounds. The slope is at most too small by one unit, which over all
    // steps is less than 2³²: ties must come out above one half going down and below it going up.
    let slack = 1_u128 << 40;
    let half = 1_u128 << (BITS - 1);
    let offset = if course.sign < 0 { half + slack } else { half - slack };
    let mut sum = slope * course.first.max(0) as u128 + offset;
    course.report(t);
    for step in course.first..=course.last {
        let pixel = course.pixel(step, (sum >> BITS) as i64);
        plot(pixel);
        sum += slope;
    }
}
