//! Thick and patterned lines on pixels: a pen that is moved along a thin line, and a mask that tells where it is down.
//!
//! J. D. Foley, A. van Dam, S. K. Feiner, J. F. Hughes, *Computer Graphics: Principles and Practice*, 2nd ed. 1990, 3.7
//! and 3.9; the pattern as in OpenGL 1.0 (1992), `glLineStipple`. Class: image space. Cost: O(n · w) for n steps and w
//! pixels of the pen. [`super::wide`] gives wide lines as areas, with joints and ends, and dashes by length.
//!
//! The pattern is counted in steps from the line's first end, so it is coarser along diagonals, as published, and it
//! can go on from line to line.

use super::bresenham;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::IVec2;
use crate::trace::{NoTrace, PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "line-pattern",
    title: "Thick and stippled lines on pixels",
    authors: "J. D. Foley, A. van Dam, S. K. Feiner, J. F. Hughes",
    year: 1990,
    source: "Computer Graphics: Principles and Practice, 3.7 and 3.9",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge],
    cost: "O(n w), n pixels of the thin line and w of the pen",
    limits: "replicated pixels make diagonals thinner by 1/√2, a square pen makes them thicker by √2",
    pseudocode: &[
        "for each pixel p of the thin line, by Bresenham:",
        "    s ← steps from the first end",
        "    bit ← ⌊(offset + s) / repeat⌋ mod 16",
        "    if this bit of the pattern, the lowest first, is 0:",
        "        the pen is up: next pixel",
        "    for each pixel of the pen around p:",
        "        plot it",
        "the next line continues at offset + length",
    ],
};

/// Shape drawn at each pixel of the thin line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PenShape {
    /// Pixels across the longer axis, replicated: columns of flat lines, rows of steep ones.
    Replicated(u32),
    /// A square with this many pixels per side. Pixels may be plotted several times.
    Square(u32),
}

/// Options for drawing a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Options {
    /// Pen that draws the line.
    pub pen: PenShape,
    /// Pattern of 16 bits, the lowest first: the pen is down where they are 1.
    pub pattern: u16,
    /// Each bit counts for this many steps; 0 is taken as 1.
    pub repeat: u32,
    /// Step of the pattern at which the line begins.
    pub offset: u64,
}

impl Default for Options {
    /// Creates a thin solid line.
    fn default() -> Self {
        Self { pen: PenShape::Replicated(1), pattern: u16::MAX, repeat: 1, offset: 0 }
    }
}

impl Options {
    /// Returns whether the pen is down at a step.
    pub(crate) fn is_down(&self, step: u64) -> bool {
        let bit = (self.offset.wrapping_add(step) / u64::from(self.repeat.max(1))) % 16;
        self.pattern >> bit & 1 == 1
    }
}

/// Step of the algorithm: a pixel of the thin line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    /// Column and row.
    pub pixel: IVec2,
    /// Distance from the first end, in steps.
    pub step: u64,
    /// True if the pen is down.
    pub down: bool,
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        if self.down { 7 } else { 5 }
    }
}

/// Returns the pixels that a list of steps leads to, for the line from `from` to `to`.
pub fn replay(from: IVec2, to: IVec2, options: &Options, steps: &[Step]) -> Vec<IVec2> {
    let mut pixels = Vec::new();
    for step in steps.iter().filter(|step| step.down) {
        stamp(step.pixel, options.pen, is_steep(from, to), &mut |p| pixels.push(p));
    }
    pixels
}

/// Calls `plot` for the pixels of the line between two pixels, both included. A pen of no width draws nothing.
///
/// ```
/// use durer::math::IVec2;
/// use durer::raster::line::pattern::{Options, draw};
/// use durer::trace::NoTrace;
///
/// // Two pixels on, two off.
/// let options = Options { pattern: 0b0011_0011_0011_0011, ..Options::default() };
/// let mut columns = Vec::new();
/// draw(IVec2::ZERO, IVec2::new(7, 0), &options, |p| columns.push(p.x), &mut NoTrace);
/// assert_eq!(columns, [0, 1, 4, 5]);
/// ```
pub fn draw(
    from: IVec2,
    to: IVec2,
    options: &Options,
    mut plot: impl FnMut(IVec2),
    t: &mut impl Tracer<Step>,
) {
    let steep = is_steep(from, to);
    let along = |p: IVec2| i64::from(if steep { p.y } else { p.x });
    let thin = |pixel: IVec2| {
        let step = along(pixel).abs_diff(along(from));
        let down = options.is_down(step);
        t.step(|| Step { pixel, step, down });
        if down {
            stamp(pixel, options.pen, steep, &mut plot);
        }
    };
    bresenham::draw(from, to, &super::Options::default(), thin, &mut NoTrace);
}

fn is_steep(from: IVec2, to: IVec2) -> bool {
    to.y.abs_diff(from.y) > to.x.abs_diff(from.x)
}

/// Plots the pen at a pixel; an even width has one pixel more before it than behind. Pixels beyond i32 are left out.
fn stamp(at: IVec2, pen: PenShape, steep: bool, plot: &mut impl FnMut(IVec2)) {
    let reach = |width: u32| {
        let before = i64::from(width / 2);
        -before..i64::from(width) - before
    };
    let mut put = |dx: i64, dy: i64| {
        let moved = (i32::try_from(i64::from(at.x) + dx), i32::try_from(i64::from(at.y) + dy));
        if let (Ok(x), Ok(y)) = moved {
            plot(IVec2::new(x, y));
        }
    };
    match pen {
        PenShape::Replicated(width) if steep => reach(width).for_each(|d| put(d, 0)),
        PenShape::Replicated(width) => reach(width).for_each(|d| put(0, d)),
        PenShape::Square(width) => {
            for dy in reach(width) {
                reach(width).for_each(|dx| put(dx, dy));
            }
        }
    }
}
