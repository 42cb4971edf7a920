//! Walking through a text file by lines and blank-separated words, without copying.

use crate::{Error, Place, Result, number};
use std::borrow::Cow;

/// A place in a text that knows its line. `\n`, `\r\n` and a lone `\r` end a line; a backslash at
/// the end of a line joins the next one to it; `#` after a blank starts a comment.
#[derive(Debug, Clone)]
pub(crate) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u64,
    line_start: usize,
    word_start: usize,
    /// Numbers followed by other characters, e.g. `3.1+e2`: their count, and the place of the first.
    pub sloppy: Tally,
    /// Numbers with a comma as decimal sign, e.g. `1,5`.
    pub commas: Tally,
}

/// Words of a warning about numbers with a decimal comma.
pub(crate) const COMMAS: &str = "{number has a decimal comma|numbers have decimal commas}; {it was read as a point|they were read as points}";

/// Number of occurrences, and the first of them; becomes one warning instead of a million.
#[derive(Debug, Clone, Default)]
pub(crate) struct Tally {
    pub count: u64,
    pub first: Place,
}

impl Tally {
    /// Counts one more.
    pub fn add(&mut self, place: impl FnOnce() -> Place) {
        if self.count == 0 {
            self.first = place();
        }
        self.count += 1;
    }

    /// Adds the count of a later tally.
    pub fn append(&mut self, other: Self) {
        if self.count == 0 {
            self.first = other.first;
        }
        self.count += other.count;
    }
}

/// Returns names and messages from bytes that should be UTF-8, at most 60 characters.
pub(crate) fn quote(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes.get(..240).unwrap_or(bytes)).into_owned();
    if text.chars().count() <= 60 { text } else { text.chars().take(60).chain(['…']).collect() }
}

/// Returns a name in a text: UTF-8 or, if it is invalid, Windows-1252, as written by older programs.
pub(crate) fn name(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(name) => Cow::Borrowed(name),
        Err(_) => Cow::Owned(bytes.iter().map(|&b| windows_1252(b)).collect()),
    }
}

/// Returns the character behind a byte of Windows-1252, which is Latin-1 except for the 32 characters from 0x80 on; the
/// five unassigned ones are control characters.
fn windows_1252(byte: u8) -> char {
    const FROM_80: [char; 32] = [
        '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž',
        '\u{8f}', '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}',
        'ž', 'Ÿ',
    ];
    let special = usize::from(byte).checked_sub(0x80).and_then(|i| FROM_80.get(i));
    special.copied().unwrap_or(char::from(byte))
}

/// Returns text as bytes of UTF-8: without a byte-order mark, and decoded where the mark says
/// UTF-16.
pub(crate) fn utf8(bytes: &[u8]) -> Cow<'_, [u8]> {
    match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => Cow::Borrowed(rest),
        [0xff, 0xfe, rest @ ..] => Cow::Owned(utf16_le(rest)),
        [0xfe, 0xff, rest @ ..] => Cow::Owned(utf16_be(rest)),
        _ => Cow::Borrowed(bytes),
    }
}

/// Converts UTF-16 whose low bytes come first, without a mark, to UTF-8.
pub(crate) fn utf16_le(bytes: &[u8]) -> Vec<u8> {
    utf16(bytes, u16::from_le_bytes)
}

/// Converts UTF-16 whose high bytes come first, without a mark, to UTF-8.
pub(crate) fn utf16_be(bytes: &[u8]) -> Vec<u8> {
    utf16(bytes, u16::from_be_bytes)
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Vec<u8> {
    let units = bytes.as_chunks().0.iter().map(|&pair| unit(pair));
    let mut text = String::with_capacity(bytes.len() / 2);
    text.extend(char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)));
    text.into_bytes()
}

/// Returns the number of a word with a comma in place of the point, as programs write it in countries that do so: one
/// comma between two digits, and no point.
pub(crate) fn with_decimal_comma(word: &[u8]) -> Option<f64> {
    let at = word.iter().position(|&byte| byte == b',')?;
    let is_digit = |at: usize| word.get(at).is_some_and(u8::is_ascii_digit);
    let is_between = at > 0 && is_digit(at - 1) && is_digit(at + 1);
    let further = word.get(at + 1..)?.iter().any(|&byte| matches!(byte, b',' | b'.'));
    if !is_between || further || word.get(..at)?.contains(&b'.') {
        return None;
    }
    let mut pointed = word.to_vec();
    *pointed.get_mut(at)? = b'.';
    number::float(&pointed).filter(|(_, length)| *length == word.len()).map(|(value, _)| value)
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | 0x0b | 0x0c)
}

fn ends_line(byte: u8) -> bool {
    matches!(byte, b'\n' | b'\r')
}

impl<'a> Cursor<'a> {
    /// Creates a cursor at the start of a text.
    pub fn new(bytes: &'a [u8]) -> Self {
        let (sloppy, commas) = Default::default();
        Self { bytes, at: 0, line: 1, line_start: 0, word_start: 0, sloppy, commas }
    }

    /// Creates a cursor at the start of a text that is the rest of a file; `lines` is the number of its first line.
    pub fn at_line(bytes: &'a [u8], lines: u64) -> Self {
        Self { line: lines, ..Self::new(bytes) }
    }

    /// Returns the number of bytes after the current place.
    pub fn bytes_left(&self) -> usize {
        self.bytes.len().saturating_sub(self.at)
    }

    /// Returns whether the text is over.
    pub fn at_end(&self) -> bool {
        self.at >= self.bytes.len()
    }

    /// Returns the number of bytes before the current place.
    pub fn offset(&self) -> usize {
        self.at
    }

    /// Returns the number of the current line, from 1.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// Returns the place where the last word began.
    pub fn place(&self) -> Place {
        let column = self.word_start.saturating_sub(self.line_start) as u64 + 1;
        Place::Line(self.line, column)
    }

    /// Returns an error where the last word began.
    pub fn error(&self, message: impl Into<String>) -> Error {
        Error::Decode { place: self.place(), message: message.into() }
    }

    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    /// Returns the length of the line end at `at`, 0 if there is none.
    fn line_end(&self, at: usize) -> usize {
        match (self.bytes.get(at), self.bytes.get(at + 1)) {
            (Some(b'\r'), Some(b'\n')) => 2,
            (Some(b'\r' | b'\n'), _) => 1,
            _ => 0,
        }
    }

    /// Steps over blanks and joined line ends.
    fn skip_blanks(&mut self) {
        while let Some(byte) = self.peek() {
            if is_blank(byte) {
                self.at += 1;
            } else if byte == b'\\' && self.line_end(self.at + 1) > 0 {
                self.at += 1 + self.line_end(self.at + 1);
                self.line += 1;
                self.line_start = self.at;
            } else {
                break;
            }
        }
        self.word_start = self.at;
    }

    /// Returns whether the rest of the line has only blanks and a comment.
    pub fn line_is_over(&mut self) -> bool {
        self.skip_blanks();
        self.peek().is_none_or(|b| ends_line(b) || b == b'#')
    }

    /// Returns the next word of the line.
    pub fn word(&mut self) -> Option<&'a [u8]> {
        if self.line_is_over() {
            return None;
        }
        self.finish_word();
        self.bytes.get(self.word_start..self.at)
    }

    /// Steps to the end of the word at the cursor.
    fn finish_word(&mut self) {
        while let Some(byte) = self.peek() {
            let joins = byte == b'\\' && self.line_end(self.at + 1) > 0;
            if is_blank(byte) || ends_line(byte) || joins {
                break;
            }
            self.at += 1;
        }
    }

    /// Returns the rest of the line as one name, without blanks around it.
    pub fn rest(&mut self) -> &'a [u8] {
        self.skip_blanks();
        while self.peek().is_some_and(|b| !ends_line(b)) {
            self.at += 1;
        }
        self.bytes.get(self.word_start..self.at).unwrap_or_default().trim_ascii_end()
    }

    /// Returns the rest of the line as one name, up to the first word where `stop` returns true for the text from
    /// there.
    pub fn rest_before(&mut self, stop: impl Fn(&'a [u8]) -> bool) -> &'a [u8] {
        self.skip_blanks();
        let start = self.at;
        while self.peek().is_some_and(|b| !ends_line(b)) && !stop(&self.bytes[self.at..]) {
            // At least one byte, also of a backslash that would join lines.
            self.at += 1;
            self.finish_word();
            while self.peek().is_some_and(is_blank) {
                self.at += 1;
            }
        }
        self.bytes.get(start..self.at).unwrap_or_default().trim_ascii_end()
    }

    /// Goes to the start of the next line.
    pub fn next_line(&mut self) {
        while self.peek().is_some_and(|b| !ends_line(b)) {
            self.at += 1;
        }
        self.at += self.line_end(self.at);
        self.line += 1;
        self.line_start = self.at;
        self.word_start = self.at;
    }

    /// Returns the next number of the line; `None` if the line is over.
    ///
    /// # Errors
    /// A word that does not begin with a number.
    pub fn float(&mut self) -> Result<Option<f64>> {
        if self.line_is_over() {
            return Ok(None);
        }
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let Some((value, length)) = number::float(rest) else {
            let word = self.word().unwrap_or_default();
            return Err(self.error(format!("`{}` is not a number", quote(word))));
        };
        self.at += length;
        if self.peek().is_some_and(|b| !is_blank(b) && !ends_line(b)) {
            let place = self.place();
            self.finish_word();
            let word = self.bytes.get(self.word_start..self.at).unwrap_or_default();
            if let Some(value) = with_decimal_comma(word) {
                self.commas.add(|| place);
                return Ok(Some(value));
            }
            self.sloppy.add(|| place);
        }
        Ok(Some(value))
    }

    /// Reads numbers until the line is over or `values` is full; returns how many there were.
    ///
    /// # Errors
    /// A word that does not begin with a number.
    pub fn floats(&mut self, values: &mut [f64]) -> Result<usize> {
        for (i, value) in values.iter_mut().enumerate() {
            match self.float()? {
                Some(v) => *value = v,
                None => return Ok(i),
            }
        }
        Ok(values.len())
    }

    /// Returns the integer at the cursor, without skipping blanks.
    pub fn integer_here(&mut self) -> Option<i64> {
        let (value, length) = number::integer(self.bytes.get(self.at..)?)?;
        self.at += length;
        Some(value)
    }

    /// Steps over `byte` if it is right here.
    pub fn take(&mut self, byte: u8) -> bool {
        let here = self.peek() == Some(byte);
        self.at += usize::from(here);
        here
    }

    /// Returns whether a word ends right here.
    pub fn word_is_over(&self) -> bool {
        self.peek().is_none_or(|b| is_blank(b) || ends_line(b) || b == b'#' || b == b'\\')
    }

    /// Returns the whole word at the cursor, for messages.
    pub fn current_word(&mut self) -> String {
        self.finish_word();
        quote(self.bytes.get(self.word_start..self.at).unwrap_or_default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_words_and_places() {
        let mut c = Cursor::new(b"a  bc # d\r\n\\\n x\\\r\n y\rlast");
        assert_eq!((c.word(), c.word(), c.word()), (Some(&b"a"[..]), Some(&b"bc"[..]), None));
        c.next_line();
        assert_eq!((c.word(), c.place()), (Some(&b"x"[..]), Place::Line(3, 2)));
        assert_eq!((c.word(), c.place()), (Some(&b"y"[..]), Place::Line(4, 2)));
        assert_eq!(c.word(), None);
        c.next_line();
        assert_eq!((c.rest(), c.line()), (&b"last"[..], 5));
        assert!(c.at_end());
    }

    #[test]
    fn utf16_becomes_utf8() {
        let le: Vec<u8> = "\u{feff}v ä\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert_eq!(utf8(&le).as_ref(), "v ä\n".as_bytes());
        let be: Vec<u8> = "\u{feff}v ä\n".encode_utf16().flat_map(u16::to_be_bytes).collect();
        assert_eq!(utf8(&be).as_ref(), "v ä\n".as_bytes());
        assert_eq!(utf8(b"\xef\xbb\xbfv").as_ref(), b"v");
    }

    #[test]
    fn names_are_utf8_or_windows_1252() {
        assert_eq!(name("Größe".as_bytes()), "Größe");
        assert_eq!(name(b"Gr\xf6\xdfe \x80\x99\x9f"), "Größe €™Ÿ");
    }

    #[test]
    fn a_comma_between_digits_is_a_point() {
        let mut c = Cursor::new(b"1,5 -0,25e1 7 1,2,3 1,2.5 1, ,5");
        let mut values = [0.0; 6];
        assert_eq!(c.floats(&mut values).expect("numbers"), 6);
        assert_eq!(values, [1.5, -2.5, 7.0, 1.0, 1.0, 1.0]);
        assert_eq!((c.commas.count, c.sloppy.count), (2, 3));
        assert!(c.float().is_err());
    }

    #[test]
    fn a_number_with_a_tail_is_taken_and_counted() {
        let mut c = Cursor::new(b"3.1+e2 7 x");
        assert_eq!(c.float().expect("number"), Some(3.1));
        assert_eq!(c.float().expect("number"), Some(7.0));
        assert_eq!(c.sloppy.count, 1);
        assert!(c.float().is_err());
    }
}
