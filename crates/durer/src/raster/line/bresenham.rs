//! Bresenham's line algorithm, the midpoint algorithm in its integer form.
//!
//! J. E. Bresenham, *Algorithm for computer control of a digital plotter*, IBM Systems Journal 4 (1965).
//! Class: image space. Cost: one or two additions and a comparison per pixel, integers only. Clipping
//! enters the line with the error term it would have there, so exactly the unclipped pixels are lit.

use super::{Course, Options, Step};
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::IVec2;
use crate::trace::Tracer;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "bresenham",
    title: "Bresenham's algorithm",
    authors: "J. E. Bresenham",
    year: 1965,
    source: "Algorithm for computer control of a digital plotter, IBM Systems Journal 4",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge],
    cost: "O(n), two integer additions per pixel",
    limits: "none",
    pseudocode: &[
        "Δx ← |x2 − x1|, Δy ← |y2 − y1|",
        "if Δy > Δx: swap the roles of x and y",
        "E ← 2Δy − Δx, y ← y1",
        "for each x from x1 to x2:",
        "    // the sign of E is the side of the midpoint between the next two pixels",
        "    set pixel (x, y)",
        "    if E > 0:",
        "        y ← y ± 1",
        "        E ← E + 2Δy − 2Δx",
        "    else:",
        "        E ← E + 2Δy",
    ],
};

/// Calls `plot` for the pixels of the line between two pixels, both included; any 32-bit coordinates.
///
/// ```
/// use durer::math::IVec2;
/// use durer::raster::line::{Options, bresenham};
/// use durer::trace::NoTrace;
///
/// let mut pixels = Vec::new();
/// let (from, to) = (IVec2::new(0, 0), IVec2::new(4, 2));
/// bresenham::draw(from, to, &Options::default(), |p| pixels.push((p.x, p.y)), &mut NoTrace);
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
    let (start, whole) = (course.numerator(course.first), course.denominator());
    // Most lines start at their end, where nothing need be divided.
    let (distance, error) = if start < whole { (0, start) } else { (start / whole, start % whole) };
    let (mut error, whole, rise) = (error as i64, whole as i64, 2 * course.rise);
    let mut pixel = course.pixel(course.first, distance as i64);
    let across = course.sign as i32;
    let (along, across) = if course.steep {
        (IVec2::Y, IVec2::new(across, 0))
    } else {
        (IVec2::X, IVec2::new(0, across))
    };
    course.report(t);
    for _ in course.first..=course.last {
        plot(pixel);
        error += rise;
        // Without a branch, which the processor could not predict.
        let turn = i64::from(error >= whole);
        error -= whole * turn;
        pixel = pixel.wrapping_add(along).wrapping_add(across * turn as i32);
    }
}
