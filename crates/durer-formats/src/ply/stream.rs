//! Values of a binary PLY file that is not held.

use super::body::{Bytes, Values, number};
use super::header::{Element, Type};
use crate::{Error, Place, Result};
use std::io::{Read, Seek, SeekFrom};

/// Bytes that are read at a time.
const AT_ONCE: usize = 64 << 10;

/// Bytes of a file from some place on.
pub(super) struct Stream<R> {
    source: R,
    little: bool,
    /// End of the file.
    end: u64,
    buffer: Vec<u8>,
    /// Start of the buffer in the file.
    start: u64,
    /// The next byte of the buffer, and the first of the last value.
    at: usize,
    last: usize,
    ended: bool,
}

impl<R: Read + Seek> Stream<R> {
    /// Creates a file of this many bytes, from its start on.
    pub fn new(source: R, little: bool, end: u64) -> Self {
        // Nothing is in the buffer: the first value seeks.
        let (buffer, start) = (Vec::new(), u64::MAX);
        Self { source, little, end, buffer, start, at: 0, last: 0, ended: false }
    }

    /// Goes to a place of the file.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn seek(&mut self, place: u64) -> Result<()> {
        self.ended = false;
        match place.checked_sub(self.start) {
            Some(at) if at <= self.buffer.len() as u64 => self.at = at as usize,
            _ => {
                self.source.seek(SeekFrom::Start(place)).map_err(Error::Io)?;
                self.buffer.clear();
                (self.start, self.at) = (place, 0);
            }
        }
        self.last = self.at;
        Ok(())
    }

    /// Returns the position of the next value.
    pub fn position(&self) -> u64 {
        self.start.saturating_add(self.at as u64)
    }

    /// Moves the remaining bytes to the front and reads on.
    #[cold]
    fn refill(&mut self) -> Result<()> {
        self.buffer.drain(..self.at);
        self.start += self.at as u64;
        self.at = 0;
        let left = self.end.saturating_sub(self.start + self.buffer.len() as u64);
        let more = left.min(AT_ONCE as u64);
        let read = self.source.by_ref().take(more).read_to_end(&mut self.buffer);
        read.map(drop).map_err(Error::Io)
    }

    fn too_short(&mut self) -> Error {
        self.ended = true;
        Error::byte(self.end, "the file ends before all elements are there")
    }
}

impl<R: Read + Seek> Bytes for Stream<R> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N]> {
        if self.buffer.len() - self.at < N {
            self.refill()?;
        }
        self.last = self.at;
        let Some(bytes) = self.buffer.get(self.at..).and_then(|b| b.first_chunk::<N>()) else {
            return Err(self.too_short());
        };
        let mut bytes = *bytes;
        self.at += N;
        if !self.little {
            bytes.reverse();
        }
        Ok(bytes)
    }
}

impl<R: Read + Seek> Values for Stream<R> {
    fn next(&mut self, kind: Type) -> Result<f64> {
        number(self, kind)
    }

    fn skip(&mut self, kind: Type, count: u64) -> Result<()> {
        let size = kind.size().saturating_mul(count);
        if size > self.bytes_left() {
            return Err(self.too_short());
        }
        self.seek(self.position() + size)
    }

    fn least_size(&self, element: &Element) -> u64 {
        element.properties.iter().map(|p| p.list.unwrap_or(p.kind).size()).sum()
    }

    fn least_value(&self, kind: Type) -> u64 {
        kind.size()
    }

    fn bytes_left(&self) -> u64 {
        self.end.saturating_sub(self.position())
    }

    fn place(&self) -> Place {
        Place::Byte(self.start.saturating_add(self.last as u64))
    }

    fn end(&mut self) {
        self.ended = true;
    }

    fn ended(&self) -> bool {
        self.ended
    }

    fn left_over(&mut self) -> Option<(Place, String)> {
        super::body::left_over(self.bytes_left(), self.position())
    }
}
