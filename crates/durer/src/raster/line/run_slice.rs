//! The run-slice line: one decision for a whole row of pixels.
//!
//! J. E. Bresenham, *Run length slice algorithm for incremental lines*, in R. A. Earnshaw (ed.), *Fundamental Algorithms for
//! Computer Graphics*, 1985; a later account is E. Angel, D. Morrison, *Speeding up Bresenham's algorithm*, IEEE Computer
//! Graphics and Applications 11(6), 1991. Class: image space. A line of Δx by Δy pixels is Δy + 1 runs, whose lengths, but for
//! the first and the last, are q or q + 1 with q = ⌊Δx / Δy⌋. Cost: one division for the line, one decision per run; so it
//! saves most where lines are nearly horizontal or vertical, and nothing at 45°.
//!
//! Runs extend along the longer axis; ties are resolved as in the whole family. In a window, the algorithm begins with
//! the run that enters it.

use super::{Course, Options};
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::IVec2;
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "run-slice",
    title: "Run-slice line",
    authors: "J. E. Bresenham",
    year: 1985,
    source: "Run length slice algorithm for incremental lines, Fundamental Algorithms for Computer Graphics",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge, Coherence::Span],
    cost: "O(n) pixels, one decision per run of them",
    limits: "none",
    pseudocode: &[
        "Δx ← |x2 − x1|, Δy ← |y2 − y1|",
        "if Δy > Δx: swap the roles of x and y",
        "q ← Δx div Δy, r ← 2 (Δx mod Δy)",
        "// half a step across: the first run has about half the length",
        "light ⌈Δx / 2Δy⌉ pixels, E ← its excess length, times 2Δy",
        "for each further row:",
        "    y ← y ± 1, E ← E − r",
        "    if E ≥ 0:",
        "        light q pixels",
        "    else:",
        "        light q + 1 pixels, E ← E + 2Δy",
        "the last run ends at x2",
    ],
};

/// Kind of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RunKind {
    /// The first one, about half as long as the others.
    First,
    /// One of q pixels, as E is not negative.
    Short,
    /// One of q + 1 pixels, as E is negative.
    Long,
}

/// Step of the algorithm: a run is lit. Runs come in the direction of rising coordinates along the longer axis, in which they
/// are plotted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    /// Kind of the run.
    pub run: RunKind,
    /// First and last pixel.
    pub ends: [IVec2; 2],
    /// E that decided on its length.
    pub e: i64,
    /// True if the line or the window ends before the run does.
    pub is_cut: bool,
}

impl Step {
    /// Returns the pixels of the run.
    pub fn pixels(&self) -> impl Iterator<Item = IVec2> {
        let [from, to] = self.ends;
        let way = (to - from).signum();
        let count = (to - from).abs().max_element();
        (0..=count).map(move |k| from + way * k)
    }
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match (self.run, self.is_cut) {
            (RunKind::First, _) => 5,
            (_, true) => 12,
            (RunKind::Short, false) => 9,
            (RunKind::Long, false) => 11,
        }
    }
}

/// Returns the pixels that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<IVec2> {
    steps.iter().flat_map(Step::pixels).collect()
}

/// Calls `plot` for the pixels of the line between two pixels, both included; any 32-bit coordinates.
///
/// ```
/// use durer::math::IVec2;
/// use durer::raster::line::{Options, run_slice};
/// use durer::trace::Recorder;
///
/// let (mut count, mut steps) = (0, Recorder::default());
/// run_slice::draw(IVec2::ZERO, IVec2::new(20, 2), &Options::default(), |_| count += 1, &mut steps);
/// // 21 pixels, three runs.
/// assert_eq!((count, steps.steps().len()), (21, 3));
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
    let (whole, twice) = (course.denominator(), 2 * i128::from(course.rise));
    let mut distance = course.numerator(course.first) / whole;
    // The first step of the next row: where the numerator reaches its multiple of the denominator.
    let missing = (distance + 1) * whole - course.numerator(0);
    let (mut end, mut e) = if twice == 0 {
        (course.last + 1, 0)
    } else {
        let end = (missing + twice - 1) / twice;
        (end as i64, (end * twice - missing) as i64)
    };
    let twice = (2 * course.rise).max(1);
    let (q, r) = (2 * course.steps / twice, 2 * course.steps % twice);
    let (mut start, mut run, mut decided) = (course.first, RunKind::First, e);
    while start <= course.last {
        let stop = end.min(course.last + 1);
        t.step(|| {
            let pixel = |step| course.pixel(step, distance as i64);
            let ends = [pixel(start), pixel(stop - 1)];
            Step { run, ends, e: decided, is_cut: end > stop }
        });
        for step in start..stop {
            plot(course.pixel(step, distance as i64));
        }
        (start, distance) = (stop, distance + 1);
        e -= r;
        (decided, run) = (e, if e < 0 { RunKind::Long } else { RunKind::Short });
        end += q;
        if e < 0 {
            end += 1;
            e += twice;
        }
    }
}
