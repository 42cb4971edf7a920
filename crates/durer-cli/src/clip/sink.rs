//! Where a stream of bytes goes: it is in its place when it is whole, and not before.

use crate::failure::{Failure, in_words};
use crate::output::{create_beside, is_special};
use durer_formats::Error;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Takes bytes as they come.
pub struct Sink {
    out: BufWriter<Box<dyn Write>>,
    /// What messages call it.
    name: PathBuf,
    /// The file being written, and the one that it replaces in the end.
    files: Option<(PathBuf, PathBuf)>,
}

impl Sink {
    /// Standard output.
    pub fn stdout() -> Self {
        Self::new(Box::new(io::stdout()), Path::new("standard output"), None)
    }

    /// A file, replaced by [`Sink::commit`]; a device or pipe is written to directly.
    pub fn file(path: &Path) -> Result<Self, Failure> {
        let fail = |e: &io::Error| Failure::of_file(path, in_words(e));
        if is_special(path) {
            let file = OpenOptions::new().write(true).open(path).map_err(|e| fail(&e))?;
            return Ok(Self::new(Box::new(file), path, None));
        }
        let place = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        if fs::metadata(&place).is_ok_and(|m| m.permissions().readonly()) {
            return Err(Failure::of_file(path, "the file is read-only"));
        }
        let (beside, file) = create_beside(&place).map_err(|e| fail(&e))?;
        Ok(Self::new(Box::new(file), path, Some((beside, place))))
    }

    fn new(out: Box<dyn Write>, name: &Path, files: Option<(PathBuf, PathBuf)>) -> Self {
        Self { out: BufWriter::with_capacity(1 << 16, out), name: name.to_owned(), files }
    }

    /// Puts the file in its place.
    pub fn commit(mut self) -> Result<(), Failure> {
        let moved = self.out.flush().and_then(|()| match &self.files {
            Some((beside, place)) => {
                if let Ok(old) = fs::metadata(place) {
                    File::open(beside)?.set_permissions(old.permissions())?;
                }
                fs::rename(beside, place)
            }
            None => Ok(()),
        });
        moved.map_err(|e| failure(&self.name, &Error::Io(e)))?;
        self.files = None;
        Ok(())
    }
}

/// What went wrong with writing, in the command's words.
pub fn failure(name: &Path, error: &Error) -> Failure {
    match error {
        Error::Io(e) if e.kind() == io::ErrorKind::BrokenPipe => Failure::ClosedPipe,
        Error::Io(e) => Failure::of_file(name, in_words(e)),
        other => Failure::of_file(name, other),
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

impl Drop for Sink {
    fn drop(&mut self) {
        if let Some((beside, _)) = &self.files {
            // What was written of it is of no use; one that cannot be removed stays.
            let _ = fs::remove_file(beside);
        }
    }
}
