//! Frames, each step of an algorithm ready to be shown; all of a run, made anew from its steps.

use super::picture::Picture;
use super::table::Table;
use super::words::{Caption, Language, Template};
use crate::trace::Recorder;
use std::fmt;
use std::sync::Arc;

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

/// Parts of a frame that are wanted; what costs time is left out of frames on the way to the one that is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Want {
    /// The line and the sentence.
    Words,
    /// These and the table.
    Table,
    /// The whole frame.
    All,
}

impl Want {
    /// Returns the parts of a frame that are wanted.
    pub fn shown(
        self,
        line: usize,
        caption: Caption,
        table: impl FnOnce() -> Table,
        picture: impl FnOnce() -> Picture,
    ) -> Shown {
        let table = (self >= Self::Table).then(table);
        Shown { line, caption, table, picture: (self == Self::All).then(picture) }
    }
}

/// Parts of a frame that a lesson gives.
pub(super) struct Shown {
    /// Line of the pseudocode.
    pub line: usize,
    /// Sentence.
    pub caption: Caption,
    /// State, if it is wanted.
    pub table: Option<Table>,
    /// Picture, if it is wanted.
    pub picture: Option<Picture>,
}

/// Sentence of a frame in place of steps that are not shown.
static MORE: Template = Template::new(
    "more",
    "{shown} {shown|step is|steps are} shown; {dropped} more {dropped|follows|follow}.",
    "{shown} {shown|Schritt ist|Schritte sind} gezeigt; {dropped} {dropped|weiterer folgt|weitere folgen}.",
);

/// Steps from one kept state to the next in a short run: the most that are taken again to make a frame.
const SHORTEST: usize = 16;

/// The most states that are kept; longer runs have more steps between them.
const MOST_STATES: usize = 256;

/// All frames of a run. It keeps the steps, and the state of the algorithm before some of them; [`Frames::frame`] makes
/// a frame from the nearest state before it. So runs of 100,000 steps are made in little time and fit into memory.
#[derive(Clone)]
pub struct Frames {
    replay: Arc<dyn Replay + Send + Sync>,
    /// Line and sentence of each step.
    outline: Arc<[(usize, &'static Template)]>,
    /// Number of steps that were dropped.
    dropped: usize,
}

/// A run that can be taken again from any step.
trait Replay {
    /// Returns the way from the nearest kept state before a step, and the number of the step that it begins with.
    fn way_to(&self, step: usize) -> (usize, Box<dyn Way + '_>);
}

/// Steps that are taken one after the other.
trait Way {
    /// Takes a step and returns the parts of its frame that are wanted.
    fn next(&mut self, want: Want) -> Option<Shown>;
}

/// Steps of a run, and functions that show them, each with the state before one of the steps.
struct Kept<S, F> {
    steps: Vec<S>,
    /// Steps from one kept state to the next.
    apart: usize,
    states: Vec<F>,
}

impl<S, F: FnMut(&S, Want) -> Shown + Clone> Replay for Kept<S, F> {
    fn way_to(&self, step: usize) -> (usize, Box<dyn Way + '_>) {
        let place = (step / self.apart).min(self.states.len().saturating_sub(1));
        let first = place * self.apart;
        let steps = self.steps.get(first..).unwrap_or_default();
        (first, Box::new(Going { steps, show: self.states.get(place).cloned() }))
    }
}

/// Steps that follow, and the function that shows them with the state before; none in a run without steps.
struct Going<'a, S, F> {
    steps: &'a [S],
    show: Option<F>,
}

impl<S, F: FnMut(&S, Want) -> Shown> Way for Going<'_, S, F> {
    fn next(&mut self, want: Want) -> Option<Shown> {
        let (step, rest) = self.steps.split_first()?;
        self.steps = rest;
        self.show.as_mut().map(|show| show(step, want))
    }
}

/// The first way through a run, which keeps states.
struct First<'a, S, F> {
    way: Going<'a, S, F>,
    states: Vec<F>,
}

/// Steps that are taken one after the other, and states to keep.
trait Keep {
    /// Keeps the state before the next step.
    fn keep(&mut self);

    /// Takes a step, and returns the line and the sentence of its frame.
    fn next(&mut self) -> Option<Shown>;
}

impl<S, F: FnMut(&S, Want) -> Shown + Clone> Keep for First<'_, S, F> {
    fn keep(&mut self) {
        self.states.extend(self.way.show.clone());
    }

    fn next(&mut self) -> Option<Shown> {
        self.way.next(Want::Words)
    }
}

/// Takes all steps of a run, and keeps every `apart`-th state; returns the line and the sentence of each step. Not
/// generic, so that it is compiled once and not for each lesson.
fn outline(
    first: &mut dyn Keep,
    count: usize,
    apart: usize,
    dropped: usize,
) -> Vec<(usize, &'static Template)> {
    let mut outline = Vec::with_capacity(count + 1);
    for index in 0..count {
        if index.is_multiple_of(apart) {
            first.keep();
        }
        outline.extend(first.next().map(|shown| (shown.line, shown.caption.template)));
    }
    if let Some(&(line, _)) = outline.last().filter(|_| dropped > 0) {
        outline.push((line, &MORE));
    }
    outline
}

/// A place in a run.
struct Cursor<'a> {
    frames: &'a Frames,
    /// The step that is taken next.
    at: usize,
    way: Box<dyn Way + 'a>,
}

impl Cursor<'_> {
    /// Takes the steps up to one, and returns the parts of its frame that are wanted.
    fn step(&mut self, step: usize, want: Want) -> Option<Shown> {
        if step < self.at {
            (self.at, self.way) = self.frames.replay.way_to(step);
        }
        while self.at < step {
            self.way.next(Want::Words)?;
            self.at += 1;
        }
        self.at += 1;
        self.way.next(want)
    }

    /// Returns the parts of a frame that are wanted; the one with the number of dropped steps repeats the last step.
    fn frame(&mut self, index: usize, want: Want) -> Option<Shown> {
        let Frames { dropped, .. } = *self.frames;
        if dropped == 0 || index + 1 < self.frames.len() {
            return self.step(index, want);
        }
        let shown = self.step(index.checked_sub(1)?, want)?;
        let values = [("shown", index.into()), ("dropped", dropped.into())];
        Some(Shown { caption: MORE.with(values), ..shown })
    }
}

impl Frames {
    /// Makes frames of steps by a function that takes a step, keeps the state, and shows what is wanted of the frame. It
    /// is kept before several steps, each time with the state that it has then.
    pub(super) fn new<S, F>(recorder: Recorder<S>, show: F) -> Self
    where
        S: Send + Sync + 'static,
        F: FnMut(&S, Want) -> Shown + Clone + Send + Sync + 'static,
    {
        let dropped = recorder.dropped();
        let steps = recorder.into_steps();
        let apart = steps.len().div_ceil(MOST_STATES).max(SHORTEST);
        let way = Going { steps: &steps, show: Some(show) };
        let mut first = First { way, states: Vec::new() };
        let outline = outline(&mut first, steps.len(), apart, dropped).into();
        let states = first.states;
        Self { replay: Arc::new(Kept { steps, apart, states }), outline, dropped }
    }

    /// Returns the number of frames.
    pub fn len(&self) -> usize {
        self.outline.len()
    }

    /// Returns whether the algorithm took no step.
    pub fn is_empty(&self) -> bool {
        self.outline.is_empty()
    }

    /// Returns the lines of the pseudocode, counted from 1, and the templates of the captions of all frames.
    pub fn outline(&self) -> impl ExactSizeIterator<Item = (usize, &'static Template)> {
        self.outline.iter().copied()
    }

    /// Returns the captions of the frames from one on, counted from 0.
    pub fn captions(&self, first: usize) -> impl Iterator<Item = Caption> {
        let mut cursor = self.cursor(first);
        (first..self.len()).filter_map(move |index| Some(cursor.frame(index, Want::Words)?.caption))
    }

    /// Returns one frame, counted from 0.
    pub fn frame(&self, index: usize) -> Option<Frame> {
        self.outline.get(index)?;
        self.starting_at(index).next()
    }

    /// Returns all frames in their order.
    pub fn iter(&self) -> impl Iterator<Item = Frame> {
        self.starting_at(0)
    }

    /// Returns the frames from one on.
    fn starting_at(&self, start: usize) -> impl Iterator<Item = Frame> {
        // Cells that changed need the table of the frame before.
        let before = start.checked_sub(1);
        let mut cursor = self.cursor(before.unwrap_or(start));
        let mut last = before.and_then(|index| cursor.frame(index, Want::Table)?.table);
        (start..self.len()).filter_map(move |index| {
            let Shown { line, caption, table, picture } = cursor.frame(index, Want::All)?;
            let (plain, kind) = (table?, caption.template.kind);
            let mut table = plain.clone();
            table.mark_changes(last.as_ref());
            last = Some(plain);
            Some(Frame { number: index + 1, line, kind, caption, table, picture: picture? })
        })
    }

    fn cursor(&self, step: usize) -> Cursor<'_> {
        let (at, way) = self.replay.way_to(step);
        Cursor { frames: self, at, way }
    }
}

impl fmt::Debug for Frames {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Frames").field("len", &self.len()).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Input, lessons};
    use super::*;

    /// Checks that a frame built alone equals the one in the sequence of all frames: on both sides of stored states,
    /// and where a run was cut off.
    #[test]
    fn any_frame_can_be_made() {
        for lesson in lessons() {
            let run = |cap| lesson.record(&Input::Example(String::new()), &Default::default(), cap);
            let whole = run(150).unwrap();
            let cap = whole.len().saturating_sub(1).clamp(1, 33);
            let cut = run(cap).unwrap();
            for run in [&whole, &cut] {
                let frames: Vec<Frame> = run.iter().collect();
                assert_eq!(frames.len(), run.len(), "{}", lesson.name);
                for index in [0, 1, 15, 16, 17, 31, 32, 33, 34, 149, 150, 151] {
                    let (own, all) = (run.frame(index), frames.get(index));
                    assert_eq!(own.as_ref(), all, "{} {index}", lesson.name);
                }
                let outline = frames.iter().map(|frame| (frame.line, frame.caption.template));
                assert!(run.outline().eq(outline), "{}", lesson.name);
                let captions = frames.iter().skip(5).map(|frame| frame.caption.clone());
                assert!(run.captions(5).eq(captions), "{}", lesson.name);
            }
            let is_cut = cut.iter().last().is_some_and(|frame| frame.kind == "more");
            assert_eq!(is_cut, whole.len() > cap, "{}", lesson.name);
        }
    }

    /// Checks that a long run has more steps between stored states than a short one, and the same frames.
    #[test]
    fn frames_of_long_runs_are_those_of_short_ones() {
        let grid = super::super::Grid { columns: 24, cells: vec![0; 24 * 24], seed: [3, 4] };
        let lesson = super::super::lesson("naive").unwrap();
        let input = Input::Grid(grid);
        let run = |cap| lesson.record(&input, &Default::default(), cap).unwrap();
        let long = run(usize::MAX);
        assert!(long.len() > MOST_STATES * SHORTEST, "{}", long.len());
        for index in [0, 100, 2_000, 4_095] {
            let frame = long.frame(index);
            assert!(frame.is_some());
            assert_eq!(frame, run(index + 1).frame(index), "{index}");
        }
    }

    /// Checks that frames are built from the state of their own step, even after others were built.
    #[test]
    fn cells_that_changed_are_those_of_the_step() {
        let input = Input::Example(String::new());
        let run =
            super::super::lesson("naive").and_then(|l| l.record(&input, &Default::default(), 150));
        let frame = run.unwrap().frame(65).unwrap();
        let cells = || frame.table.rows.iter().flat_map(|row| &row.cells);
        assert!(cells().any(|cell| cell.changed) && cells().any(|cell| !cell.changed));
    }
}
