//! The lines and columns of offsets in a text, without counting from its beginning each time.

use crate::Place;

/// Number of bytes between two places that are counted beforehand; at most as many are examined for each query.
const STEP: usize = if cfg!(test) { 4 } else { 4096 };

/// Lines and columns of a text, both counted from 1, columns in letters.
pub(super) struct Lines<'a> {
    text: &'a str,
    /// Every [`STEP`] bytes an offset with its line and column.
    marks: Vec<(usize, [u64; 2])>,
}

impl<'a> Lines<'a> {
    /// Counts the lines of a text.
    pub fn new(text: &'a str) -> Self {
        let mut marks = Vec::with_capacity(text.len() / STEP + 1);
        let mut at = [1, 1];
        for (offset, letter) in text.char_indices() {
            if offset >= marks.len() * STEP {
                marks.push((offset, at));
            }
            at = after(at, letter);
        }
        Self { text, marks }
    }

    /// Returns the line and column of an offset in bytes, clamped to the end.
    pub fn at(&self, offset: usize) -> (u64, u64) {
        let before = self.marks.partition_point(|(mark, _)| *mark <= offset).checked_sub(1);
        let (mark, start) = before.and_then(|i| self.marks.get(i)).copied().unwrap_or((0, [1, 1]));
        let letters = self.text.get(mark..).unwrap_or_default().char_indices();
        let letters = letters.take_while(|(at, letter)| mark + at + letter.len_utf8() <= offset);
        let [line, column] = letters.fold(start, |at, (_, letter)| after(at, letter));
        (line, column)
    }

    /// Returns the line and column as a place for messages.
    pub fn place(&self, offset: usize) -> Place {
        let (line, column) = self.at(offset);
        Place::Line(line, column)
    }
}

fn after([line, column]: [u64; 2], letter: char) -> [u64; 2] {
    if letter == '\n' { [line + 1, 1] } else { [line, column + 1] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use usvg::roxmltree::Document;

    #[test]
    fn places_are_those_of_the_parser() {
        let text = "<a>\n\nxyzxyzxyz é\u{1F600}öü\n  <b/>äöü<c/>\n</a>";
        let (lines, document) = (Lines::new(text), Document::parse(text).unwrap());
        for offset in (0..text.len() + 3).filter(|&i| i > text.len() || text.is_char_boundary(i)) {
            let at = document.text_pos_at(offset);
            assert_eq!(lines.at(offset), (at.row.into(), at.col.into()), "{offset}");
        }
        assert_eq!(Lines::new("").at(5), (1, 1));
    }
}
