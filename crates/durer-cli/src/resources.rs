//! Finds the files that a model refers to: in its own folder, or below another given one, nowhere else.

use crate::failure::in_words;
use durer_formats::{Found, Resources};
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::{Component, Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Files that were searched, existing or not, if they are recorded.
static NOTED: Mutex<Option<BTreeSet<PathBuf>>> = Mutex::new(None);

/// Records the files searched from now on, and returns the ones recorded so far.
pub fn note() -> BTreeSet<PathBuf> {
    let mut noted = NOTED.lock().unwrap_or_else(PoisonError::into_inner);
    noted.replace(BTreeSet::new()).unwrap_or_default()
}

fn add_note(path: &Path) {
    if let Some(noted) = &mut *NOTED.lock().unwrap_or_else(PoisonError::into_inner) {
        noted.insert(path.to_owned());
    }
}

/// The names in a folder by their lower case; among several, the first by bytes.
type Names = BTreeMap<String, OsString>;

/// The folder of a model.
///
/// # Guarantees
/// Only regular files below the folder, or below the one added by [`Self::widen`], are read, even if links or `..` lead
/// elsewhere; network addresses are never used.
#[derive(Debug)]
pub struct Folder {
    /// Base folder of relative paths; without links and `..`.
    base: PathBuf,
    /// Folders that files must be below; without links and `..`.
    roots: Vec<PathBuf>,
    /// Advice for a file elsewhere, appended to the message.
    hint: &'static str,
    /// Folders in which names were searched ignoring case.
    names: Mutex<BTreeMap<PathBuf, Names>>,
}

impl Folder {
    /// Returns the folder that contains the file; if the file is a link, the folder of its target.
    pub fn of(model: &Path) -> io::Result<Self> {
        let model = fs::canonicalize(model)?;
        Ok(Self::at(model.parent().unwrap_or(Path::new("/")).to_owned()))
    }

    /// Returns a folder without a model in it, where paths start.
    pub fn itself(folder: &Path) -> io::Result<Self> {
        Ok(Self::at(directory(folder)?))
    }

    fn at(base: PathBuf) -> Self {
        Self { roots: vec![base.clone()], base, hint: "", names: Mutex::default() }
    }

    /// Allows references to any file below a further folder.
    pub fn widen(mut self, folder: &Path) -> io::Result<Self> {
        self.roots.push(directory(folder)?);
        Ok(self)
    }

    /// Sets the advice for files elsewhere.
    pub fn hint(self, hint: &'static str) -> Self {
        Self { hint, ..self }
    }

    /// Returns the file's true place, if files are allowed there, and a warning if its name is written
    /// otherwise.
    fn place(&self, path: &str) -> Result<(PathBuf, Option<String>), String> {
        if has_scheme(path) {
            return Err(
                "network addresses are never fetched; keep the file beside the model".into()
            );
        }
        let (full, note) = match fs::canonicalize(self.base.join(path)) {
            Ok(full) => (full, None),
            Err(error) => {
                let missing = error.kind() == ErrorKind::NotFound;
                let other = missing.then(|| self.other_case(path)).flatten();
                let spelled = other.ok_or_else(|| in_words(&error))?;
                let full = fs::canonicalize(&spelled).map_err(|e| in_words(&e))?;
                (full, Some(self.other_case_note(path, &spelled)))
            }
        };
        if self.allows(&full) {
            return Ok((full, note));
        }
        let roots = if self.roots.len() > 1 { " and the one of --root" } else { "" };
        Err(format!(
            "it is outside the model's folder{roots}, where files are not read{}",
            self.hint
        ))
    }

    fn allows(&self, full: &Path) -> bool {
        self.roots.iter().any(|root| full.starts_with(root))
    }

    fn other_case_note(&self, path: &str, spelled: &Path) -> String {
        let spelled = spelled.strip_prefix(&self.base).unwrap_or(spelled).display();
        format!("there is no `{path}`; `{spelled}` is taken, which differs in upper and lower case")
    }

    /// Returns the path with each name that does not exist in another case; `None` if one does not exist in
    /// any.
    fn other_case(&self, path: &str) -> Option<PathBuf> {
        let mut at = self.base.clone();
        for component in Path::new(path).components() {
            match component {
                Component::Normal(name) if !at.join(name).exists() => {
                    at.push(self.name(&at, name)?)
                }
                Component::ParentDir => at = fs::canonicalize(at.join("..")).ok()?,
                other => at.push(other),
            }
        }
        Some(at)
    }

    /// Returns a name of the folder that differs from `name` only in upper and lower case.
    fn name(&self, folder: &Path, name: &OsStr) -> Option<OsString> {
        let folder = fs::canonicalize(folder).ok().filter(|folder| self.allows(folder))?;
        let mut known = self.names.lock().unwrap_or_else(PoisonError::into_inner);
        let names = known.entry(folder).or_insert_with_key(|folder| names(folder));
        names.get(&name.to_str()?.to_lowercase()).cloned()
    }
}

/// Returns a folder's true place.
fn directory(folder: &Path) -> io::Result<PathBuf> {
    let full = fs::canonicalize(folder)?;
    if full.is_dir() { Ok(full) } else { Err(io::Error::other("it is not a folder")) }
}

/// Opens a file for reading, without waiting for the writer of a pipe.
fn open(path: &Path) -> io::Result<File> {
    let mut options = File::options();
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(
        &mut options,
        libc::O_NONBLOCK | libc::O_NOCTTY,
    );
    options.read(true).open(path)
}

/// Returns the path of an open file according to the system; otherwise the path that it was opened
/// by.
#[cfg(target_os = "linux")]
fn place_of(file: &File, path: &Path) -> PathBuf {
    use std::os::fd::AsRawFd;
    fs::read_link(format!("/proc/self/fd/{}", file.as_raw_fd())).unwrap_or_else(|_| path.to_owned())
}

#[cfg(not(target_os = "linux"))]
fn place_of(_: &File, path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// Returns the names in a folder, as far as it can be read.
fn names(folder: &Path) -> Names {
    let mut names = Names::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let Some(key) = name.to_str().map(str::to_lowercase) else { continue };
        let first = names.entry(key).or_insert_with(|| name.clone());
        if name < *first {
            *first = name;
        }
    }
    names
}

/// Returns whether a reference begins like `http:` or `file:` (RFC 3986), with at least two letters,
/// so that it is not a drive.
fn has_scheme(path: &str) -> bool {
    let Some((scheme, _)) = path.split_once(':') else { return false };
    let letter = |c: char| c.is_ascii_alphanumeric() || "+-.".contains(c);
    scheme.len() > 1
        && scheme.starts_with(|c: char| c.is_ascii_alphabetic())
        && scheme.chars().all(letter)
}

impl Resources for Folder {
    fn read(&self, path: &str, limit: u64) -> Result<Vec<u8>, String> {
        self.find(path, limit).map(|found| found.bytes)
    }

    fn find(&self, path: &str, limit: u64) -> Result<Found, String> {
        let (full, note) = self.place(path).inspect_err(|_| add_note(&self.base.join(path)))?;
        add_note(&full);
        // The opened file is checked, because its path may lead elsewhere a moment later.
        let file = open(&full).map_err(|e| in_words(&e))?;
        if !self.allows(&place_of(&file, &full)) {
            return Err("it was moved while it was opened".to_owned());
        }
        let metadata = file.metadata().map_err(|e| in_words(&e))?;
        if !metadata.is_file() {
            return Err("it is not a file".to_owned());
        }
        let too_large =
            || format!("it is larger than the {limit} bytes that are left of the limit");
        if metadata.len() > limit {
            return Err(too_large());
        }
        let mut bytes = Vec::with_capacity(usize::try_from(metadata.len()).unwrap_or(0));
        file.take(limit.saturating_add(1)).read_to_end(&mut bytes).map_err(|e| in_words(&e))?;
        if bytes.len() as u64 > limit { Err(too_large()) } else { Ok(Found { bytes, note }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn schemes_are_reported_from_paths() {
        for url in ["http://a/b", "https:b", "file:///etc/passwd", "data:x", "s3+x:y"] {
            assert!(has_scheme(url), "{url}");
        }
        for path in ["a/b.bin", "C:/x", "a b:c", "", "ü:x", "./x:y"] {
            assert!(!has_scheme(path), "{path}");
        }
    }
}
