//! Watching an algorithm work: a generic listener that every algorithm takes as its last argument.
//!
//! Each algorithm has its own `Step` type. It reports steps by `t.step(|| Step::…)`; with [`NoTrace`]
//! the closure is never called and the compiler removes the call altogether. Two laws hold for every
//! algorithm and are tested: tracing changes no output, and replaying the steps rebuilds it.
//!
//! ```
//! use durer::trace::{NoTrace, Recorder, Tracer};
//!
//! fn halve(mut n: u32, t: &mut impl Tracer<u32>) -> u32 {
//!     while n % 2 == 0 && n > 0 {
//!         n /= 2;
//!         t.step(|| n);
//!     }
//!     n
//! }
//! let mut recorder = Recorder::default();
//! assert_eq!(halve(40, &mut recorder), halve(40, &mut NoTrace));
//! assert_eq!(recorder.steps(), [20, 10, 5]);
//! ```

/// A tracer for the steps of one algorithm.
pub trait Tracer<S> {
    /// Records one step; `make` is called only if steps are recorded.
    fn step(&mut self, make: impl FnOnce() -> S);
}

/// A step that belongs to a line of its algorithm's pseudocode.
///
/// ```
/// use durer::clip::line::{Segment, cohen_sutherland};
/// use durer::math::{DVec2, Rect};
/// use durer::trace::{PseudocodeLine, Recorder};
///
/// let window = Rect::new(DVec2::ZERO, DVec2::ONE)?;
/// let segment = Segment::new(DVec2::new(-1.0, 0.5), DVec2::new(0.5, 0.5));
/// let mut recorder = Recorder::default();
/// cohen_sutherland::clip(&window, segment, &mut recorder)?;
/// let text = cohen_sutherland::INFO.pseudocode;
/// let run: Vec<&str> = recorder.steps().iter().map(|step| text[step.line() - 1]).collect();
/// assert_eq!(run.len(), recorder.steps().len());
/// # Ok::<(), durer::Error>(())
/// ```
pub trait PseudocodeLine {
    /// Returns the line of [`Info::pseudocode`](crate::info::Info::pseudocode) that the step runs, counted from 1.
    fn line(&self) -> usize;
}

/// Records nothing and costs nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoTrace;

impl<S> Tracer<S> for NoTrace {
    #[inline(always)]
    fn step(&mut self, _make: impl FnOnce() -> S) {}
}

/// Tracer that keeps the steps up to a cap, and counts the dropped ones.
#[derive(Debug, Clone)]
pub struct Recorder<S> {
    steps: Vec<S>,
    cap: usize,
    dropped: usize,
}

impl<S> Recorder<S> {
    /// Creates a recorder that keeps the first `cap` steps.
    pub fn with_cap(cap: usize) -> Self {
        Self { steps: Vec::new(), cap, dropped: 0 }
    }

    /// Returns the steps kept, in the order in which they were taken.
    pub fn steps(&self) -> &[S] {
        &self.steps
    }

    /// Returns the number of steps after the cap was reached.
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// Returns the steps kept, by value.
    pub fn into_steps(self) -> Vec<S> {
        self.steps
    }
}

impl<S> Default for Recorder<S> {
    /// Keeps one million steps: enough for every picture in the documentation, and bounded.
    fn default() -> Self {
        Self::with_cap(1_000_000)
    }
}

impl<S> Tracer<S> for Recorder<S> {
    fn step(&mut self, make: impl FnOnce() -> S) {
        if self.steps.len() < self.cap {
            self.steps.push(make());
        } else {
            self.dropped += 1;
        }
    }
}

/// Only counts the steps; for measuring cost in operations instead of seconds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Steps taken so far.
    pub steps: u64,
}

impl<S> Tracer<S> for Counts {
    fn step(&mut self, _make: impl FnOnce() -> S) {
        self.steps += 1;
    }
}

impl<S, T: Tracer<S>> Tracer<S> for &mut T {
    fn step(&mut self, make: impl FnOnce() -> S) {
        (**self).step(make);
    }
}
