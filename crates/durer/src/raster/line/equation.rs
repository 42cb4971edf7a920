//! A line from its equation: for every step along the longer axis, y = y₀ + (x − x₀) · Δy / Δx, rounded.
//!
//! Class: image space. Cost: a multiplication and a division per pixel; the simplest method, against which the others
//! are checked. Exact for all 32-bit end points.

use super::{Course, Options, Step};
use crate::info::{Class, Info, Occluder};
use crate::math::IVec2;
use crate::trace::Tracer;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "equation",
    title: "Equation of the line",
    authors: "R. Descartes",
    year: 1637,
    source: "La géométrie",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n), one division per pixel",
    limits: "none",
    pseudocode: &[
        "Δx ← x2 − x1, Δy ← y2 − y1",
        "if |Δy| > |Δx|: swap the roles of x and y",
        "m ← Δy / Δx",
        "for each x from x1 to x2:",
        "    y ← y1 + m · (x − x1)",
        "    set pixel (x, ⌊y + ½⌋)",
        "// one multiplication, one addition and one rounding per pixel",
        "// every pixel is computed afresh: no error adds up",
    ],
};

/// Calls `plot` for the pixels of the line between two pixels, both included.
pub fn draw(
    from: IVec2,
    to: IVec2,
    options: &Options,
    mut plot: impl FnMut(IVec2),
    t: &mut impl Tracer<Step>,
) {
    let course = Course::new(from, to, options);
    course.report(t);
    for step in course.first..=course.last {
        let pixel = course.pixel(step, (course.numerator(step) / course.denominator()) as i64);
        plot(pixel);
    }
}
