//! Frames, each step of an algorithm ready to be shown; all of a run, kept as differences from one to the next.

use super::picture::{Mark, Picture};
use super::table::{Row, Table};
use super::words::{Caption, Language, Word};

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

/// Frames from one that is kept whole to the next: the most that are read to make a frame anew.
const WHOLE: usize = 64;

/// All frames of a run. It keeps of each only the rows and marks that the one before lacks, so that runs of 100,000
/// steps fit into memory; [`Frames::frame`] makes a frame from at most 64 of them.
#[derive(Debug, Clone, Default)]
pub struct Frames {
    steps: Vec<Packed>,
}

/// A frame as its differences from the one before.
#[derive(Debug, Clone)]
struct Packed {
    line: usize,
    caption: Caption,
    heads: Change<Word>,
    rows: Change<Row>,
    marks: Change<Mark>,
    /// The picture without its marks.
    empty: Picture,
}

/// Items of a list that replace all but the first and last ones of the list before.
#[derive(Debug, Clone)]
struct Change<T> {
    /// Number of items that are kept at the start.
    first: usize,
    items: Vec<T>,
    /// Number of items that are kept at the end.
    last: usize,
}

impl<T: Clone + PartialEq> Change<T> {
    /// Returns what leads from one list to the other.
    fn new(from: &[T], to: &[T]) -> Self {
        let same = |pair: &(&T, &T)| pair.0 == pair.1;
        let first = from.iter().zip(to).take_while(same).count();
        let (rest, ends) = (from.iter().skip(first).rev(), to.iter().skip(first).rev());
        let last = rest.zip(ends).take_while(same).count();
        let items = to.get(first..to.len() - last).unwrap_or_default().to_vec();
        Self { first, items, last }
    }

    /// Applies the change.
    fn apply<'a>(&'a self, list: &mut Vec<&'a T>) {
        let end = list.len().saturating_sub(self.last).max(self.first);
        list.splice(self.first.min(list.len())..end.min(list.len()), &self.items);
    }
}

/// Collector of the frames of a run.
#[derive(Default)]
pub(super) struct Packer {
    frames: Frames,
    /// Head, rows and marks of the frame before.
    before: (Vec<Word>, Vec<Row>, Vec<Mark>),
}

impl Packer {
    /// Adds a frame at the end.
    pub fn push(&mut self, shown: Shown) {
        let Shown { line, caption, table: Table { heads, rows }, picture } = shown;
        let Picture { extent, down, grid, marks, picture_from_input } = picture;
        let empty = Picture { extent, down, grid, marks: Vec::new(), picture_from_input };
        if self.frames.steps.len().is_multiple_of(WHOLE) {
            self.before = Default::default();
        }
        let now = (heads, rows, marks);
        let heads = Change::new(&self.before.0, &now.0);
        let rows = Change::new(&self.before.1, &now.1);
        let marks = Change::new(&self.before.2, &now.2);
        self.before = now;
        self.frames.steps.push(Packed { line, caption, heads, rows, marks, empty });
    }

    /// Adds the last frame once more with another caption, if there is one.
    pub fn again(&mut self, caption: impl FnOnce(usize) -> Caption) {
        let shown = self.frames.steps.len();
        let Some(last) = shown.checked_sub(1).and_then(|last| self.frames.frame(last)) else {
            return;
        };
        let Frame { line, mut table, picture, .. } = last;
        table.rows.iter_mut().flat_map(|row| &mut row.cells).for_each(|cell| cell.changed = false);
        self.push(Shown { line, caption: caption(shown), table, picture });
    }

    /// Returns the run.
    pub fn finish(self) -> Frames {
        self.frames
    }
}

/// Head, rows and marks of a frame, borrowed from the run.
#[derive(Default)]
struct Lists<'a> {
    heads: Vec<&'a Word>,
    rows: Vec<&'a Row>,
    marks: Vec<&'a Mark>,
}

impl<'a> Lists<'a> {
    fn apply(&mut self, step: &'a Packed, index: usize) {
        if index.is_multiple_of(WHOLE) {
            *self = Self::default();
        }
        step.heads.apply(&mut self.heads);
        step.rows.apply(&mut self.rows);
        step.marks.apply(&mut self.marks);
    }

    fn table(&self) -> Table {
        Table {
            heads: self.heads.iter().copied().copied().collect(),
            rows: self.rows.iter().copied().cloned().collect(),
        }
    }
}

impl Frames {
    /// Returns the number of frames.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// Returns whether the algorithm took no step.
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// Returns the lines of the pseudocode, counted from 1, and the captions of all frames.
    pub fn captions(&self) -> impl ExactSizeIterator<Item = (usize, &Caption)> {
        self.steps.iter().map(|step| (step.line, &step.caption))
    }

    /// Returns one frame, counted from 0.
    pub fn frame(&self, index: usize) -> Option<Frame> {
        self.steps.get(index)?;
        // Cells that changed need the table of the frame before.
        let start = index.saturating_sub(1);
        self.range(start - start % WHOLE, start, index + 1).last()
    }

    /// Returns all frames in their order.
    pub fn iter(&self) -> impl Iterator<Item = Frame> {
        self.range(0, 0, self.steps.len())
    }

    /// Returns the frames of a range, read from one that is kept whole.
    fn range(&self, whole: usize, start: usize, end: usize) -> impl Iterator<Item = Frame> {
        let mut lists = Lists::default();
        let mut before: Option<Table> = None;
        let steps = self.steps.iter().enumerate().take(end).skip(whole);
        steps.filter_map(move |(index, step)| {
            lists.apply(step, index);
            if index < start {
                return None;
            }
            let plain = lists.table();
            let mut table = plain.clone();
            table.mark_changes(before.as_ref());
            before = Some(plain);
            let marks = lists.marks.iter().copied().cloned().collect();
            let picture = Picture { marks, ..step.empty.clone() };
            let (line, caption) = (step.line, step.caption.clone());
            let (number, kind) = (index + 1, caption.template.kind);
            Some(Frame { number, line, kind, caption, table, picture })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Input, lesson};
    use super::*;

    #[test]
    fn changes_lead_from_list_to_list() {
        let lists: [&[u8]; 7] = [b"", b"abc", b"abxc", b"abxc", b"bxc", b"aaaa", b"aa"];
        for from in lists {
            for to in lists {
                let change = Change::new(from, to);
                let mut list: Vec<&u8> = from.iter().collect();
                change.apply(&mut list);
                assert!(list.into_iter().eq(to), "{from:?} {to:?}");
            }
        }
        assert_eq!(Change::new(b"abc", b"abxc").items, b"x");
    }

    /// A frame by itself is the one that all frames in their order have in its place, on both sides of those kept
    /// whole.
    #[test]
    fn any_frame_can_be_made() {
        let input = Input::Example(String::new());
        let run = lesson("naive").and_then(|l| l.record(&input, &Default::default(), 150));
        let run = run.unwrap();
        let frames: Vec<Frame> = run.iter().collect();
        assert_eq!((frames.len(), run.len()), (151, 151));
        for index in [0, 1, 63, 64, 65, 127, 128, 149, 150] {
            assert_eq!(run.frame(index).as_ref(), frames.get(index), "{index}");
        }
        assert_eq!(run.frame(151), None);
        assert!(frames[65].table.rows.iter().flat_map(|row| &row.cells).any(|cell| !cell.changed));
        assert_eq!(frames[150].kind, "more");
    }
}
