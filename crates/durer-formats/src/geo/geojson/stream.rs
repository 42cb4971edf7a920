//! A source of JSON, from which values are cut.

use super::object::Text;
use super::scan::{Progress, Scan};
use crate::{Error, Result};
use std::io::Read;

/// Bytes requested at a time.
const CHUNK: usize = 64 << 10;

/// A value cut out of the stream, with line and column of its first byte.
#[derive(Debug, Default)]
pub struct Piece {
    pub bytes: Vec<u8>,
    pub start: (u64, u64),
}

impl Piece {
    /// Returns the value with its place.
    pub fn text(&self) -> Text<'_> {
        Text::new(&self.bytes, self.start)
    }
}

/// The bytes of a source, with the place of the next one.
pub struct Stream<R> {
    source: R,
    chunk: Vec<u8>,
    at: usize,
    /// Line and column of the next byte, from 1.
    pub here: (u64, u64),
    /// True if values end with their line.
    pub by_lines: bool,
}

impl<R: Read> Stream<R> {
    /// Creates a stream at the beginning of a source.
    pub fn new(source: R) -> Self {
        Self { source, chunk: Vec::new(), at: 0, here: (1, 1), by_lines: false }
    }

    /// Returns the next byte; `None` at the end.
    pub fn peek(&mut self) -> Result<Option<u8>> {
        if self.at == self.chunk.len() {
            self.refill()?;
        }
        Ok(self.chunk.get(self.at).copied())
    }

    /// Returns the bytes that are in memory, without stepping over them; those of the beginning if nothing was read.
    pub fn ahead(&mut self) -> &[u8] {
        // An error comes again when the bytes are read.
        let _ = self.peek();
        self.chunk.get(self.at..).unwrap_or_default()
    }

    /// Reads the bytes that are available, so that a slow source is read as they arrive.
    fn refill(&mut self) -> Result<()> {
        self.at = 0;
        self.chunk.resize(CHUNK, 0);
        loop {
            match self.source.read(&mut self.chunk) {
                Err(e) if e.kind() == std::io::ErrorKind::Interrupted => {}
                read => {
                    self.chunk.truncate(*read.as_ref().unwrap_or(&0));
                    return read.map(drop).map_err(Error::from);
                }
            }
        }
    }

    fn bump(&mut self, byte: u8) {
        self.at += 1;
        self.here =
            if byte == b'\n' { (self.here.0 + 1, 1) } else { (self.here.0, self.here.1 + 1) };
    }

    fn error(&self, message: impl Into<String>) -> Error {
        Error::line(self.here.0, self.here.1, message)
    }

    /// Returns the next byte that is not a blank.
    pub fn next(&mut self) -> Result<Option<u8>> {
        while let Some(byte) = self.peek()? {
            if !matches!(byte, b' ' | b'\t' | b'\r' | b'\n') {
                return Ok(Some(byte));
            }
            self.bump(byte);
        }
        Ok(None)
    }

    /// Steps over a byte if it comes next.
    pub fn take(&mut self, byte: u8) -> Result<bool> {
        let found = self.next()? == Some(byte);
        if found {
            self.bump(byte);
        }
        Ok(found)
    }

    /// Steps over a byte that must come next.
    pub fn expect(&mut self, byte: u8, what: &str) -> Result<()> {
        if self.take(byte)? { Ok(()) } else { Err(self.unexpected(what)?) }
    }

    fn unexpected(&mut self, what: &str) -> Result<Error> {
        let found = match self.next()? {
            None => "the end of the file".to_owned(),
            Some(byte @ 0x21..=0x7e) => format!("`{}`", char::from(byte)),
            Some(byte) => format!("byte {byte:#04x}"),
        };
        Ok(self.error(format!("{what} is expected, not {found}")))
    }

    /// Cuts out the next value.
    pub fn value(&mut self, what: &str) -> Result<Piece> {
        self.next()?;
        let mut piece = Piece { bytes: Vec::new(), start: self.here };
        let mut scan = Scan::default();
        while let Some(byte) = self.peek()? {
            let progress = scan.feed(byte);
            match progress {
                Progress::Over => break,
                Progress::TooDeep => return Err(self.error("this is nested too deep")),
                Progress::More | Progress::Last => {}
            }
            if byte == b'\n' && self.by_lines {
                let message =
                    "the line ends within a value, but each feature before is on one line";
                return Err(self.error(message));
            }
            piece.bytes.push(byte);
            self.bump(byte);
            if progress == Progress::Last {
                return Ok(piece);
            }
        }
        if piece.bytes.is_empty() {
            return Err(self.unexpected(what)?);
        }
        let cut = matches!(piece.bytes.first(), Some(b'{' | b'[' | b'"'));
        if cut { Err(self.error("the file ends within a value")) } else { Ok(piece) }
    }
}
