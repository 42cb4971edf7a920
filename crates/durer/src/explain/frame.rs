//! Frames: what is shown of one step.

use super::picture::Picture;
use super::table::Table;
use super::words::{Caption, Language, Template};
use crate::Result;
use crate::trace::{Recorder, Tracer};

/// One step of an algorithm, ready to be shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Number of the step, counted from 1.
    pub number: usize,
    /// Line of the pseudocode that runs, counted from 1.
    pub line: usize,
    /// Variant of the algorithm's `Step` in kebab case.
    pub kind: &'static str,
    /// A sentence about the step with its values.
    pub caption: Caption,
    /// State of the algorithm after the step.
    pub table: Table,
    /// Picture of the state.
    pub picture: Picture,
}

impl Frame {
    /// Returns the caption in one language.
    pub fn text(&self, language: Language) -> String {
        self.caption.text(language)
    }
}

/// Sentence of a frame that stands for steps that are not shown.
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

/// Makes a frame of each step by a function that gets the step and keeps the state; adds one that says how many
/// steps were dropped.
pub(super) fn frames<S>(steps: &Recorder<S>, mut show: impl FnMut(&S) -> Shown) -> Vec<Frame> {
    let mut frames: Vec<Frame> = Vec::new();
    for step in steps.steps() {
        let Shown { line, caption, mut table, picture } = show(step);
        table.mark_changes(frames.last().map(|frame| &frame.table));
        let (number, kind) = (frames.len() + 1, caption.template.kind);
        frames.push(Frame { number, line, kind, caption, table, picture });
    }
    if let Some(last) = frames.last().filter(|_| steps.dropped() > 0) {
        let values = [("shown", frames.len().into()), ("dropped", steps.dropped().into())];
        let (number, caption) = (last.number + 1, MORE.with(values));
        let mut more = Frame { number, kind: MORE.kind, caption, ..last.clone() };
        let cells = more.table.rows.iter_mut().flat_map(|row| &mut row.cells);
        cells.for_each(|cell| cell.changed = false);
        frames.push(more);
    }
    frames
}

/// Parts of a frame that a lesson gives.
pub(super) struct Shown {
    /// Line of the pseudocode.
    pub line: usize,
    /// Sentence.
    pub caption: Caption,
    /// State.
    pub table: Table,
    /// Picture.
    pub picture: Picture,
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
