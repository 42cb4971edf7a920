//! The functions that lessons make their frames with.

pub(super) use super::packed::{Frames, Shown};

use super::packed::Packer;
use super::words::Template;
use crate::Result;
use crate::trace::{Recorder, Tracer};

/// Sentence of a frame in place of steps that are not shown.
pub(super) static MORE: Template = Template::new(
    "more",
    "{shown} steps are shown; {dropped} more follow.",
    "{shown} Schritte sind gezeigt; {dropped} weitere folgen.",
);

/// Runs an algorithm with a tracer and returns its steps, up to `cap`.
pub(super) fn record<S, T>(
    cap: usize,
    run: impl FnOnce(&mut Recorder<S>) -> Result<T>,
) -> Result<Recorder<S>> {
    let mut steps = Recorder::with_cap(cap);
    run(&mut steps)?;
    Ok(steps)
}

/// Makes a frame of each step by a function that gets the step and keeps the state; adds one with the number of steps
/// that were dropped.
pub(super) fn frames<S>(steps: &Recorder<S>, show: impl FnMut(&S) -> Shown) -> Frames {
    let mut run = Packer::default();
    steps.steps().iter().map(show).for_each(|shown| run.push(shown));
    let dropped = steps.dropped();
    if dropped > 0 {
        run.again(|shown| MORE.with([("shown", shown.into()), ("dropped", dropped.into())]));
    }
    run.finish()
}

/// A tracer of several runs that adds the number of the run to each step.
pub(super) struct Numbered<'a, T> {
    pub number: usize,
    pub t: &'a mut T,
}

impl<S, T: Tracer<(usize, S)>> Tracer<S> for Numbered<'_, T> {
    fn step(&mut self, make: impl FnOnce() -> S) {
        let number = self.number;
        self.t.step(|| (number, make()));
    }
}
