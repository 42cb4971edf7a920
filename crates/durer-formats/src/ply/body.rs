//! Values of a PLY file, one after another, from text or from bytes of either order.

use super::header::{Element, Type};
use crate::text::Cursor;
use crate::wording::{agreeing, counted};
use crate::{Error, Place, Result};

/// A source of values.
pub(super) trait Values {
    /// Returns the next value. Integers up to 53 bits are exact in a double.
    ///
    /// # Errors
    /// The end of the file, or a word that is not a number.
    fn next(&mut self, kind: Type) -> Result<f64>;

    /// Steps over `count` values.
    ///
    /// # Errors
    /// As [`Values::next`].
    fn skip(&mut self, kind: Type, count: u64) -> Result<()>;

    /// Returns the fewest bytes that a row of `element` takes.
    fn least_size(&self, element: &Element) -> u64;

    /// Returns the fewest bytes that a value takes.
    fn least_value(&self, kind: Type) -> u64;

    /// Returns the number of bytes not read yet.
    fn bytes_left(&self) -> u64;

    /// Returns the place of the last value.
    fn place(&self) -> Place;

    /// Notes that the file has no more values.
    fn end(&mut self);

    /// Checks that the file has room for a list.
    ///
    /// # Errors
    /// If it has no room.
    fn check_list(&mut self, kind: Type, length: u64) -> Result<()> {
        let (least, left) = (length.saturating_mul(self.least_value(kind)), self.bytes_left());
        // The last value of an ascii file needs no blank behind it.
        if least <= left + 1 {
            return Ok(());
        }
        self.end();
        let values = counted(length, "value", "values");
        let bytes = counted(left, "byte is", "bytes are");
        let message = format!("a list of {values}, but only {bytes} left");
        Err(Error::Decode { place: self.place(), message })
    }

    /// Returns whether a value beyond the end of the file was requested.
    fn ended(&self) -> bool;

    /// Returns the place and message for values beyond the last element.
    fn left_over(&mut self) -> Option<(Place, String)>;
}

/// Numbers in text. Line ends are blanks: some writers break rows.
pub(super) struct Ascii<'a> {
    cursor: Cursor<'a>,
    ended: bool,
}

impl<'a> Ascii<'a> {
    pub fn new(cursor: Cursor<'a>) -> Self {
        Self { cursor, ended: false }
    }

    /// Returns the numbers with decimal commas that have been read.
    pub fn commas(self) -> crate::text::Tally {
        self.cursor.commas
    }
}

impl Values for Ascii<'_> {
    fn next(&mut self, _kind: Type) -> Result<f64> {
        loop {
            if let Some(value) = self.cursor.float()? {
                return Ok(value);
            }
            if self.cursor.at_end() {
                self.ended = true;
                let line = self.cursor.line();
                return Err(Error::line(line, 0, "the file ends before all elements are there"));
            }
            self.cursor.next_line();
        }
    }

    fn skip(&mut self, kind: Type, count: u64) -> Result<()> {
        (0..count).try_for_each(|_| self.next(kind).map(drop))
    }

    fn least_size(&self, element: &Element) -> u64 {
        2 * element.properties.len() as u64
    }

    /// Returns a digit and a blank.
    fn least_value(&self, _kind: Type) -> u64 {
        2
    }

    fn bytes_left(&self) -> u64 {
        self.cursor.bytes_left() as u64
    }

    fn place(&self) -> Place {
        self.cursor.place()
    }

    fn end(&mut self) {
        self.ended = true;
    }

    fn ended(&self) -> bool {
        self.ended
    }

    fn left_over(&mut self) -> Option<(Place, String)> {
        while !self.cursor.at_end() {
            if self.cursor.word().is_some() {
                return Some((self.place(), "data after the last element were ignored".to_owned()));
            }
            self.cursor.next_line();
        }
        None
    }
}

/// Source of the bytes of binary values.
pub(super) trait Bytes {
    /// Returns the bytes of the next value, the lowest first.
    ///
    /// # Errors
    /// The end of the file.
    fn take<const N: usize>(&mut self) -> Result<[u8; N]>;
}

/// Returns the next binary value.
///
/// # Errors
/// Those of [`Bytes::take`].
pub(super) fn number(source: &mut impl Bytes, kind: Type) -> Result<f64> {
    Ok(match kind {
        Type::I8 => f64::from(i8::from_le_bytes(source.take()?)),
        Type::U8 => f64::from(u8::from_le_bytes(source.take()?)),
        Type::I16 => f64::from(i16::from_le_bytes(source.take()?)),
        Type::U16 => f64::from(u16::from_le_bytes(source.take()?)),
        Type::I32 => f64::from(i32::from_le_bytes(source.take()?)),
        Type::U32 => f64::from(u32::from_le_bytes(source.take()?)),
        Type::I64 => i64::from_le_bytes(source.take()?) as f64,
        Type::U64 => u64::from_le_bytes(source.take()?) as f64,
        Type::F32 => f64::from(f32::from_le_bytes(source.take()?)),
        Type::F64 => f64::from_le_bytes(source.take()?),
    })
}

/// Bytes in little-endian order, or big-endian.
pub(super) struct Binary<'a, const LITTLE: bool> {
    bytes: &'a [u8],
    at: usize,
    last: usize,
    /// Offset of `bytes` in the file.
    offset: u64,
    ended: bool,
}

impl<'a, const LITTLE: bool> Binary<'a, LITTLE> {
    pub fn new(bytes: &'a [u8], offset: u64) -> Self {
        Self { bytes, at: 0, last: 0, offset, ended: false }
    }

    fn too_short(&mut self) -> Error {
        self.ended = true;
        let end = self.offset + self.bytes.len() as u64;
        Error::byte(end, "the file ends before all elements are there")
    }
}

impl<const LITTLE: bool> Bytes for Binary<'_, LITTLE> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N]> {
        self.last = self.at;
        let Some(bytes) = self.bytes.get(self.at..).and_then(|b| b.first_chunk::<N>()) else {
            return Err(self.too_short());
        };
        self.at += N;
        let mut bytes = *bytes;
        if !LITTLE {
            bytes.reverse();
        }
        Ok(bytes)
    }
}

impl<const LITTLE: bool> Values for Binary<'_, LITTLE> {
    fn next(&mut self, kind: Type) -> Result<f64> {
        number(self, kind)
    }

    fn skip(&mut self, kind: Type, count: u64) -> Result<()> {
        let size = kind.size().saturating_mul(count);
        if size > self.bytes_left() {
            return Err(self.too_short());
        }
        self.at += size as usize;
        Ok(())
    }

    fn least_size(&self, element: &Element) -> u64 {
        element.properties.iter().map(|p| p.list.unwrap_or(p.kind).size()).sum()
    }

    fn least_value(&self, kind: Type) -> u64 {
        kind.size()
    }

    fn bytes_left(&self) -> u64 {
        (self.bytes.len() - self.at) as u64
    }

    fn place(&self) -> Place {
        Place::Byte(self.offset + self.last as u64)
    }

    fn end(&mut self) {
        self.ended = true;
    }

    fn ended(&self) -> bool {
        self.ended
    }

    fn left_over(&mut self) -> Option<(Place, String)> {
        left_over(self.bytes_left(), self.offset + self.at as u64)
    }
}

/// Returns the place and message for bytes beyond the last element.
pub(super) fn left_over(left: u64, place: u64) -> Option<(Place, String)> {
    let message = || {
        agreeing(
            left,
            "{byte after the last element was|bytes after the last element were} ignored",
        )
    };
    // Writers that end the data as they end a line leave one or two bytes.
    (left > 2).then(|| (Place::Byte(place), message()))
}
