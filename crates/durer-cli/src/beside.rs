//! Files that are written beside the place where they shall be, so that at any moment there is the
//! old file or the whole new one.

mod stale;

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock, PoisonError};

/// The files that are being written now, for interruptions of the process.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// The folder for unfinished files, if they are to be separate from finished ones and flushed to the disk before they
/// are renamed.
static APART: OnceLock<PathBuf> = OnceLock::new();

/// Makes files be written in a folder of their own, on the disk that they are to be on, and safe there before they take
/// their place.
pub fn keep_apart(folder: PathBuf) {
    // The first one stays: it has files.
    let _ = APART.set(folder);
}

/// A new file in the folder of another one, which it replaces when it is whole. Dropped before that,
/// it is removed.
pub struct Beside {
    file: File,
    path: PathBuf,
    place: PathBuf,
    committed: bool,
}

/// Returns an error about a new file, which names its folder if that does not exist.
fn in_folder(error: io::Error, path: &Path) -> io::Error {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    match folder {
        Some(folder) if error.kind() == io::ErrorKind::NotFound && !folder.is_dir() => {
            io::Error::new(error.kind(), format!("there is no folder {}", folder.display()))
        }
        _ => error,
    }
}

/// Returns the place that a link to a missing file names, or the place itself.
fn linked(place: &Path) -> PathBuf {
    let folder = place.parent().unwrap_or(Path::new(""));
    fs::read_link(place).map_or_else(|_| place.to_owned(), |target| folder.join(target))
}

impl Beside {
    /// Returns a file that shall replace `place`, or be there first; a link stays a link.
    pub fn create(place: &Path) -> io::Result<Self> {
        let place = fs::canonicalize(place).unwrap_or_else(|_| linked(place));
        if fs::metadata(&place).is_ok_and(|m| m.permissions().readonly()) {
            return Err(io::Error::other("the file is read-only"));
        }
        let apart = APART.get().filter(|folder| on_one_disk(folder, &place));
        if apart.is_none() {
            stale::remove_beside(&place);
        }
        for attempt in 0u32.. {
            let name = format!(".durer-{}-{attempt}.tmp", std::process::id());
            let path = match apart {
                Some(folder) => folder.join(name),
                None => place.with_file_name(name),
            };
            let mut unfinished = unfinished();
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists && attempt < 1000 => {}
                Err(e) => return Err(in_folder(e, &path)),
                Ok(file) => {
                    unfinished.insert(path.clone());
                    return Ok(Self { file, path, place, committed: false });
                }
            }
        }
        Err(io::ErrorKind::AlreadyExists.into())
    }

    /// Returns another handle of the file, for a writer that keeps it; both share the position.
    pub fn file(&self) -> io::Result<File> {
        self.file.try_clone()
    }

    /// Puts the file in its place; permissions of the old one stay.
    pub fn commit(mut self) -> io::Result<()> {
        if let Ok(old) = fs::metadata(&self.place) {
            self.file.set_permissions(old.permissions())?;
        }
        if APART.get().is_some() {
            self.file.sync_all()?;
        }
        let mut unfinished = unfinished();
        fs::rename(&self.path, &self.place)?;
        unfinished.remove(&self.path);
        self.committed = true;
        Ok(())
    }
}

impl Write for Beside {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for Beside {
    fn seek(&mut self, to: io::SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

impl Drop for Beside {
    fn drop(&mut self) {
        if !self.committed {
            // The file is useless; if it cannot be removed, it stays.
            let _ = fs::remove_file(&self.path);
            unfinished().remove(&self.path);
        }
    }
}

/// Returns whether a file in a folder can be renamed to a place.
#[cfg(unix)]
fn on_one_disk(folder: &Path, place: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let disk = |path: Option<&Path>| fs::metadata(path?).ok().map(|metadata| metadata.dev());
    disk(Some(folder)) == disk(place.parent())
}

#[cfg(not(unix))]
fn on_one_disk(_: &Path, _: &Path) -> bool {
    true
}

fn unfinished() -> std::sync::MutexGuard<'static, BTreeSet<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes unfinished files and ends the process with the exit code that `last` returns; from then on, no file is
/// renamed to its final name.
pub fn end(last: impl FnOnce() -> i32) -> ! {
    let unfinished = unfinished();
    for path in unfinished.iter() {
        let _ = fs::remove_file(path);
    }
    std::process::exit(last())
}
