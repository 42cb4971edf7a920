//! A stream of bytes into a file that appears in its place only when it is complete.

use crate::beside::Beside;
use crate::failure::{Failure, in_words};
use crate::output::is_special;
use crate::places::is_stream;
use durer_formats::Error;
use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Receiver of bytes as they come.
pub struct Sink {
    out: Out,
    /// Its name in messages.
    name: PathBuf,
}

enum Out {
    Stdout(BufWriter<io::Stdout>),
    Special(BufWriter<File>),
    Beside(BufWriter<Beside>),
}

const CAPACITY: usize = 1 << 16;

impl Sink {
    /// Creates a sink for standard output.
    pub fn stdout() -> Self {
        let out = Out::Stdout(BufWriter::with_capacity(CAPACITY, io::stdout()));
        Self { out, name: PathBuf::from("standard output") }
    }

    /// Returns a file, replaced by [`Sink::commit`]; a device or pipe is written to directly.
    pub fn file(path: &Path) -> Result<Self, Failure> {
        let out = if is_special(path) {
            let file = OpenOptions::new().write(true).open(path);
            file.map(|f| Out::Special(BufWriter::with_capacity(CAPACITY, f)))
        } else {
            Beside::create(path).map(|f| Out::Beside(BufWriter::with_capacity(CAPACITY, f)))
        };
        let out = out.map_err(|e| Failure::of_file(path, in_words(&e)))?;
        Ok(Self { out, name: path.to_owned() })
    }

    /// Returns whether the target can be rewound and overwritten.
    pub fn is_seekable(&self) -> bool {
        matches!(self.out, Out::Beside(_))
    }

    /// Puts the file in its place.
    pub fn commit(mut self) -> Result<(), Failure> {
        let flushed = self.flush();
        let moved = flushed.and_then(|()| match self.out {
            Out::Beside(out) => out.into_inner().map_err(io::IntoInnerError::into_error)?.commit(),
            _ => Ok(()),
        });
        moved.map_err(|e| failure(&self.name, &Error::Io(e)))
    }

    fn writer(&mut self) -> &mut dyn Write {
        match &mut self.out {
            Out::Stdout(out) => out,
            Out::Special(out) => out,
            Out::Beside(out) => out,
        }
    }
}

/// Returns a failure to write, with the file's name.
pub fn failure(name: &Path, error: &Error) -> Failure {
    let name = if is_stream(name) { Path::new("standard output") } else { name };
    match error {
        Error::Io(e) if e.kind() == io::ErrorKind::BrokenPipe => Failure::ClosedPipe,
        Error::Io(e) => Failure::of_file(name, in_words(e)),
        other => Failure::of_file(name, other),
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer().flush()
    }
}

impl Seek for Sink {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match &mut self.out {
            Out::Beside(out) => out.seek(to),
            _ => Err(io::ErrorKind::NotSeekable.into()),
        }
    }
}
