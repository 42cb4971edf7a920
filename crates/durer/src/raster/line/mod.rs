//! Lines: five methods for the pixels of thin lines, smooth lines, and the outlines of wide lines.
//!
//! The thin ones light one pixel per step along the longer axis: the one nearest to the line, of two equally
//! near ones that with the smaller coordinate across. All five light the same pixels, from either end.

pub mod anti_aliased;
pub mod bresenham;
pub mod dda;
pub mod double_step;
pub mod equation;
pub mod pattern;
mod pieces;
pub(crate) mod projected;
pub mod run_slice;
pub mod tiled;
pub mod wide;

use crate::info::family;
use crate::math::IVec2;
use crate::trace::{NoTrace, PseudocodeLine, Tracer};

family! {
    /// Methods for the pixels of a thin line.
    pub enum LineRasterizer {
        /// The equation of the line, solved for every column.
        Equation => equation::INFO,
        /// The digital differential analyzer.
        Dda => dda::INFO,
        /// Bresenham's algorithm.
        Bresenham => bresenham::INFO,
        /// Bresenham's runs.
        RunSlice => run_slice::INFO,
        /// Wu and Rokne's patterns of two pixels.
        DoubleStep => double_step::INFO,
    }
}

impl LineRasterizer {
    /// Calls `plot` for the line's pixels within the window, along its longer axis. The tracer gets a step per pixel,
    /// also from the run-slice and the double-step line; [`run_slice::draw`] and [`double_step::draw`] have their own
    /// steps.
    pub fn draw(
        self,
        from: IVec2,
        to: IVec2,
        options: &Options,
        plot: impl FnMut(IVec2),
        t: &mut impl Tracer<Step>,
    ) {
        match self {
            Self::Equation => equation::draw(from, to, options, plot, t),
            Self::Dda => dda::draw(from, to, options, plot, t),
            Self::Bresenham => bresenham::draw(from, to, options, plot, t),
            Self::RunSlice => {
                Course::new(from, to, options).report(t);
                run_slice::draw(from, to, options, plot, &mut NoTrace);
            }
            Self::DoubleStep => {
                Course::new(from, to, options).report(t);
                double_step::draw(from, to, options, plot, &mut NoTrace);
            }
        }
    }
}

/// Options for drawing a thin line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Only pixels from the first corner to the second, both included, are lit; `None` = all. The algorithm enters the
    /// line where it meets the window and does not walk there from its end.
    pub window: Option<(IVec2, IVec2)>,
}

/// One step: a pixel is lit. Steps come from the line's first end to its last, though pixels are plotted in the
/// direction of rising coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Column and row.
    pub pixel: IVec2,
    /// Position of the line itself across its longer axis, in pixels: the value of the equation, or
    /// the sum of the digital differential analyzer; its nearest whole number is the pixel's.
    pub across: f64,
    /// Bresenham's E at this pixel, 2Δy − Δx at the first one: twice the distance, times Δx, from the point midway
    /// between the two pixels that may come next to the line. If it is positive, the next step is diagonal and 2Δy −
    /// 2Δx is added; if it is negative, the next step is axial and 2Δy is added; if it is zero, the pixel with the
    /// smaller coordinate across is chosen.
    pub e: i64,
}

impl PseudocodeLine for Step {
    /// Returns the line of the pseudocode that sets a pixel; it is the same in the first three algorithms.
    fn line(&self) -> usize {
        6
    }
}

/// A line seen along its longer axis, in the direction of rising coordinates: every algorithm starts
/// from here, so all octants and both directions are one case.
#[derive(Debug, Clone, Copy)]
struct Course {
    /// True if y is the longer axis.
    steep: bool,
    /// Start along and across.
    along: i64,
    across: i64,
    /// Steps along, and the distance across that they cover, at most as many.
    steps: i64,
    rise: i64,
    /// The direction across.
    sign: i64,
    /// True if the caller's line runs the other way.
    swapped: bool,
    /// The steps to take, both included; empty if `first > last`.
    first: i64,
    last: i64,
}

impl Course {
    fn new(from: IVec2, to: IVec2, options: &Options) -> Self {
        let wide = |p: IVec2| (i64::from(p.x), i64::from(p.y));
        let mut course = Self::between(wide(from), wide(to));
        if let Some((low, high)) = options.window {
            course.restrict(course.turned(wide(low)), course.turned(wide(high)));
        }
        course
    }

    /// Returns the whole line between two pixels, column and row.
    #[inline]
    fn between(a: (i64, i64), b: (i64, i64)) -> Self {
        let steep = (b.1 - a.1).abs() > (b.0 - a.0).abs();
        let turn = |(x, y): (i64, i64)| if steep { (y, x) } else { (x, y) };
        let (a, b) = (turn(a), turn(b));
        let swapped = a.0 > b.0;
        let (a, b) = if swapped { (b, a) } else { (a, b) };
        let (steps, rise) = (b.0 - a.0, b.1 - a.1);
        Self {
            steep,
            along: a.0,
            across: a.1,
            steps,
            rise: rise.abs(),
            sign: rise.signum(),
            swapped,
            first: 0,
            last: steps,
        }
    }

    /// Returns the column and row as along and across.
    #[inline]
    fn turned(&self, (x, y): (i64, i64)) -> (i64, i64) {
        if self.steep { (y, x) } else { (x, y) }
    }

    /// Returns twice the numerator of the distance across after `step` steps, rounded: floor(n / 2·steps)
    /// is that distance. Ties go to the smaller coordinate.
    fn numerator(&self, step: i64) -> i128 {
        let half = i128::from(self.steps) - i128::from(self.sign >= 0);
        2 * i128::from(step) * i128::from(self.rise) + half.max(0)
    }

    fn denominator(&self) -> i128 {
        2 * i128::from(self.steps.max(1))
    }

    /// Restricts the steps to pixels within the window, computed from its borders.
    fn restrict(&mut self, low: (i64, i64), high: (i64, i64)) {
        self.first = self.first.max(low.0 - self.along);
        self.last = self.last.min(high.0 - self.along);
        let (near, far) = if self.sign < 0 {
            (self.across - high.1, self.across - low.1)
        } else {
            (low.1 - self.across, high.1 - self.across)
        };
        self.first = self.first.max(self.reaches(near));
        self.last = self.last.min(self.reaches(far + 1) - 1);
    }

    /// Returns the first step whose distance across is at least `distance`; one past the last where
    /// none is.
    fn reaches(&self, distance: i64) -> i64 {
        if distance <= 0 {
            return 0;
        }
        if distance > self.rise {
            return self.steps + 1;
        }
        let wanted = self.denominator() * i128::from(distance) - self.numerator(0);
        let twice = 2 * i128::from(self.rise);
        ((wanted + twice - 1) / twice).clamp(0, i128::from(self.steps) + 1) as i64
    }

    /// Reports all pixels to a tracer, in the caller's direction.
    fn report(&self, t: &mut impl Tracer<Step>) {
        for step in self.first..=self.last {
            t.step(|| {
                let step = if self.swapped { self.last - (step - self.first) } else { step };
                self.step(step)
            });
        }
    }

    fn step(&self, step: i64) -> Step {
        let distance = (self.numerator(step) / self.denominator()) as i64;
        let slope = self.rise as f64 / self.steps.max(1) as f64;
        // Steps and distance from the end at which the caller begins.
        let (done, passed) =
            if self.swapped { (self.steps - step, self.rise - distance) } else { (step, distance) };
        let wide = i128::from;
        let e = 2 * wide(self.rise) * (wide(done) + 1) - wide(self.steps) * (1 + 2 * wide(passed));
        Step {
            pixel: self.pixel(step, distance),
            across: self.across as f64 + self.sign as f64 * slope * step as f64,
            e: e as i64,
        }
    }

    fn pixel(&self, step: i64, distance: i64) -> IVec2 {
        let (along, across) = (self.along + step, self.across + self.sign * distance);
        let (x, y) = if self.steep { (across, along) } else { (along, across) };
        IVec2::new(x as i32, y as i32)
    }
}
