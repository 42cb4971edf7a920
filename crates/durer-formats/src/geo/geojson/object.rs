//! Values in a piece of JSON text, with their places in the file.

use super::scan::{Progress, Scan};
use crate::foreign;
use crate::{Error, Place, Result};

/// A piece of a file, and the place of a value in it.
#[derive(Debug, Clone, Copy)]
pub struct Text<'a> {
    bytes: &'a [u8],
    /// Range of the value in the piece.
    from: usize,
    to: usize,
    /// Line and column of the piece's first byte in the file, from 1.
    start: (u64, u64),
}

/// A member of an object: its name with quotes, and its value.
pub type RawMember<'a> = (Text<'a>, Text<'a>);

impl<'a> Text<'a> {
    /// Creates a piece that is one value.
    pub fn new(bytes: &'a [u8], start: (u64, u64)) -> Self {
        Self { bytes, from: 0, to: bytes.len(), start }
    }

    /// Returns the value's bytes.
    pub fn as_bytes(&self) -> &'a [u8] {
        self.bytes.get(self.from..self.to).unwrap_or_default()
    }

    /// Returns the value unchanged; checked to be JSON.
    pub fn checked(&self) -> Result<String> {
        let text = std::str::from_utf8(self.as_bytes()).map_err(|e| {
            self.error_at(self.from + e.valid_up_to(), "this is not UTF-8; save the file in UTF-8")
        })?;
        serde_json::from_str::<serde::de::IgnoredAny>(text).map_err(|e| {
            let lines = text.split_inclusive('\n').take(e.line().saturating_sub(1));
            let at = lines.map(str::len).sum::<usize>() + e.column().saturating_sub(1);
            self.error_at(self.from + at, foreign::json(&e))
        })?;
        Ok(text.to_owned())
    }

    /// Returns the value as [`Self::checked`] does, with null in place of the words NaN, Infinity and -Infinity, which
    /// Python writes; also the number of these.
    pub fn checked_without_nan(&self) -> Result<(String, u64)> {
        match self.checked() {
            Ok(text) => Ok((text, 0)),
            Err(error) => {
                let (bytes, count) = without_nan(self.as_bytes());
                let text = Text::new(&bytes, self.start).checked();
                text.ok().filter(|_| count > 0).map(|text| (text, count)).ok_or(error)
            }
        }
    }

    /// Returns the place in the file of a byte of the piece.
    fn place_at(&self, at: usize) -> Place {
        let before = self.bytes.get(..at).unwrap_or(self.bytes);
        let lines = before.iter().filter(|&&b| b == b'\n').count() as u64;
        let column = match before.iter().rposition(|&b| b == b'\n') {
            Some(end) => (before.len() - end) as u64,
            None => self.start.1 + before.len() as u64,
        };
        Place::Line(self.start.0 + lines, column)
    }

    /// Returns the place of the value in the file.
    pub fn place(&self) -> Place {
        self.place_at(self.from)
    }

    fn error_at(&self, at: usize, message: impl Into<String>) -> Error {
        Error::Decode { place: self.place_at(at), message: message.into() }
    }

    /// Returns an error where the value begins.
    pub fn error(&self, message: impl Into<String>) -> Error {
        self.error_at(self.from, message)
    }

    /// Returns a walk through the value.
    pub fn cursor(self) -> Cursor<'a> {
        Cursor { text: self, at: self.from }
    }

    /// Returns whether the value is the word `null`.
    pub fn is_null(&self) -> bool {
        self.as_bytes() == b"null"
    }

    /// Returns the members of an object.
    pub fn members(self) -> Result<Vec<RawMember<'a>>> {
        let mut cursor = self.cursor();
        let mut members = Vec::new();
        cursor.expect(b'{', "an object")?;
        if cursor.take(b'}') {
            return Ok(members);
        }
        loop {
            let name = cursor.value("a member's name")?;
            if name.as_bytes().first() != Some(&b'"') {
                return Err(name.error("the name of a member must be a string"));
            }
            cursor.expect(b':', "`:` after a member's name")?;
            members.push((name, cursor.value("a value")?));
            if cursor.take(b'}') {
                return Ok(members);
            }
            cursor.expect(b',', "`,` or `}` after a member")?;
        }
    }
}

/// Returns JSON with null in place of numbers that are not finite, and their number.
fn without_nan(json: &[u8]) -> (Vec<u8>, u64) {
    let (mut out, mut count) = (Vec::with_capacity(json.len()), 0);
    let (mut at, mut in_string) = (0, false);
    while let Some(&byte) = json.get(at) {
        let rest = json.get(at..).unwrap_or_default();
        let word = NAN.iter().find(|word| !in_string && rest.starts_with(word));
        if let Some(word) = word {
            out.extend(b"null");
            (at, count) = (at + word.len(), count + 1);
            continue;
        }
        out.push(byte);
        at += 1;
        match byte {
            b'"' => in_string = !in_string,
            b'\\' if in_string => {
                out.extend(json.get(at));
                at += 1;
            }
            _ => {}
        }
    }
    (out, count)
}

/// Numbers that are not finite as Python writes them.
const NAN: [&[u8]; 3] = [b"NaN", b"-Infinity", b"Infinity"];

/// A walk through a piece of JSON.
#[derive(Debug, Clone)]
pub struct Cursor<'a> {
    text: Text<'a>,
    at: usize,
}

impl<'a> Cursor<'a> {
    fn peek(&mut self) -> Option<u8> {
        while self.at < self.text.to {
            match self.text.bytes.get(self.at) {
                Some(b' ' | b'\t' | b'\r' | b'\n') => self.at += 1,
                other => return other.copied(),
            }
        }
        None
    }

    /// Steps over a byte if it comes next.
    pub fn take(&mut self, byte: u8) -> bool {
        let found = self.peek() == Some(byte);
        self.at += usize::from(found);
        found
    }

    /// Returns an error at the next byte.
    pub fn error(&mut self, message: impl Into<String>) -> Error {
        self.peek();
        self.text.error_at(self.at, message)
    }

    /// Returns the place of the next byte.
    pub fn place(&mut self) -> Place {
        self.peek();
        self.text.place_at(self.at)
    }

    /// Steps over a byte that must come next.
    pub fn expect(&mut self, byte: u8, what: &str) -> Result<()> {
        if self.take(byte) {
            return Ok(());
        }
        let found = self.found();
        Err(self.error(format!("{what} is expected, not {found}")))
    }

    /// Returns a description of the next token, for messages.
    pub fn found(&mut self) -> String {
        match self.peek() {
            None => "the end".to_owned(),
            Some(b'[') => "an array".to_owned(),
            Some(b'{') => "an object".to_owned(),
            Some(b'"') => "a string".to_owned(),
            Some(b'-' | b'0'..=b'9') => "a number".to_owned(),
            Some(byte @ 0x21..=0x7e) => format!("`{}`", char::from(byte)),
            Some(byte) => format!("byte {byte:#04x}"),
        }
    }

    /// Returns the next value, of any type.
    pub fn value(&mut self, what: &str) -> Result<Text<'a>> {
        self.peek();
        let from = self.at;
        let mut scan = Scan::default();
        while self.at < self.text.to {
            let byte = self.text.bytes.get(self.at).copied().unwrap_or_default();
            match scan.feed(byte) {
                Progress::More => self.at += 1,
                Progress::Last => {
                    self.at += 1;
                    break;
                }
                Progress::Over => break,
                Progress::TooDeep => return Err(self.error("this is nested too deep")),
            }
        }
        if self.at == from {
            let found = self.found();
            return Err(self.error(format!("{what} is expected, not {found}")));
        }
        Ok(Text { from, to: self.at, ..self.text })
    }

    /// Returns the next number.
    pub fn number(&mut self) -> Result<f64> {
        let first = self.peek();
        let rest = self.text.bytes.get(self.at..self.text.to).unwrap_or_default();
        let plain = matches!(first, Some(b'-' | b'0'..=b'9'));
        let Some((value, length)) = crate::number::float(rest).filter(|_| plain) else {
            let found = self.found();
            return Err(self.error(format!("a number is expected, not {found}")));
        };
        let ends = matches!(rest.get(length), Some(b',' | b']' | b' ' | b'\t' | b'\r' | b'\n'));
        if !ends || !is_number_of_json(&rest[..length]) {
            return Err(self.error("this is not a number of JSON"));
        }
        if !value.is_finite() {
            return Err(self.error("the number is too large; coordinates must be finite"));
        }
        self.at += length;
        Ok(value)
    }

    /// Reads an array; `item` reads each of its items.
    pub fn array(
        &mut self,
        what: &str,
        mut item: impl FnMut(&mut Self) -> Result<()>,
    ) -> Result<()> {
        self.expect(b'[', what)?;
        if self.take(b']') {
            return Ok(());
        }
        loop {
            item(self)?;
            if self.take(b']') {
                return Ok(());
            }
            self.expect(b',', "`,` or `]`")?;
        }
    }
}

/// Returns whether a number that other readers accept follows the stricter grammar of JSON (RFC 8259, 6): no
/// zeros in front, digits before and after the point.
fn is_number_of_json(text: &[u8]) -> bool {
    let text = text.strip_prefix(b"-").unwrap_or(text);
    let whole = text.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let fraction = match text.get(whole) {
        Some(b'.') => text.get(whole + 1).is_some_and(u8::is_ascii_digit),
        Some(byte) => matches!(byte, b'e' | b'E'),
        None => true,
    };
    fraction && whole > 0 && (whole == 1 || text[0] != b'0')
}

/// Returns the value of the member `type`, if it is a string.
pub fn kind(members: &[RawMember<'_>]) -> Option<String> {
    let (_, value) = members.iter().rfind(|(name, _)| name.as_bytes() == b"\"type\"")?;
    serde_json::from_slice(value.as_bytes()).ok()
}
