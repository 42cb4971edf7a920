//! The functions that lessons make their frames with.

pub(super) use super::replay::{Frames, Shown, Want};

use crate::Result;
use crate::trace::{Recorder, Tracer};

/// Runs an algorithm with a tracer and returns its steps, up to `cap`.
pub(super) fn record<S, T>(
    cap: usize,
    run: impl FnOnce(&mut Recorder<S>) -> Result<T>,
) -> Result<Recorder<S>> {
    let mut steps = Recorder::with_cap(cap);
    run(&mut steps)?;
    Ok(steps)
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
