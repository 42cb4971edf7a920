//! The journal of a shard: a line for each row that was run. Only one process at a time writes it.

use super::entry::Entry;
use super::shard::Shard;
use crate::failure::{Failure, in_words};
use durer_formats::wording;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Folder of the journals in the folder of outputs.
pub const FOLDER: &str = ".durer";

/// A journal that this process alone writes, until it ends.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    /// Locked while it is open.
    _lock: File,
}

impl Journal {
    /// Opens the journal of a shard, and drops a last line that is not whole.
    ///
    /// # Errors
    /// Another process has it; or it cannot be read or written.
    pub fn open(out: &Path, shard: Shard) -> Result<Self, Failure> {
        let folder = out.join(FOLDER);
        let name = shard.file_name();
        let lock_path = folder.join(format!("{name}.lock"));
        let open = |path: &Path| {
            let file = OpenOptions::new().read(true).append(true).create(true).open(path);
            file.map_err(|e| Failure::of_file(path, in_words(&e)))
        };
        let lock = open(&lock_path)?;
        lock.try_lock().map_err(|e| match e {
            TryLockError::WouldBlock => {
                let what = format!("another process works on shard {shard}; it must end first");
                Failure::of_file(out, what)
            }
            TryLockError::Error(e) => {
                Failure::of_file(&lock_path, format!("it cannot be locked: {}", in_words(&e)))
            }
        })?;
        let path = folder.join(format!("{name}.jsonl"));
        let mut file = open(&path)?;
        let whole = whole_lines(&mut file).and_then(|length| {
            if length < file.metadata()?.len() { file.set_len(length) } else { Ok(()) }
        });
        whole.map_err(|e| Failure::of_file(&path, in_words(&e)))?;
        Ok(Self { path, file, _lock: lock })
    }

    /// Returns whether nothing was noted.
    pub fn is_empty(&self) -> bool {
        self.file.metadata().is_ok_and(|m| m.len() == 0)
    }

    /// Removes all entries.
    pub fn clear(&mut self) -> Result<(), Failure> {
        self.file.set_len(0).map_err(|e| Failure::of_file(&self.path, in_words(&e)))
    }

    /// Adds a line, by one write.
    pub fn append(&mut self, entry: &Entry) -> Result<(), Failure> {
        let fail = |e: &io::Error| Failure::of_file(&self.path, in_words(e));
        let text = serde_json::to_string(entry).map_err(|e| fail(&e.into()))?;
        let line = format!("{}\n", wording::json(&text));
        self.file.write_all(line.as_bytes()).map_err(|e| fail(&e))
    }
}

/// Returns the length of the lines that end.
fn whole_lines(file: &mut File) -> io::Result<u64> {
    const PIECE: u64 = 1 << 16;
    let mut end = file.metadata()?.len();
    while end > 0 {
        let start = end.saturating_sub(PIECE);
        file.seek(SeekFrom::Start(start))?;
        let mut piece = Vec::new();
        Read::by_ref(file).take(end - start).read_to_end(&mut piece)?;
        if let Some(at) = piece.iter().rposition(|&byte| byte == b'\n') {
            return Ok(start + at as u64 + 1);
        }
        end = start;
    }
    Ok(0)
}

/// Reads the entries of all journals in a folder, for any number of shards. Incomplete lines are left out: their rows
/// count as not run.
pub fn read_all(out: &Path, mut each: impl FnMut(Entry)) -> Result<(), Failure> {
    let folder = out.join(FOLDER);
    let fail = |path: &Path, e: io::Error| Failure::of_file(path, in_words(&e));
    let entries = fs::read_dir(&folder).map_err(|e| fail(&folder, e))?;
    let mut paths = Vec::new();
    for entry in entries {
        let path = entry.map_err(|e| fail(&folder, e))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.starts_with("shard-") && name.ends_with(".jsonl") {
            paths.push(path);
        }
    }
    paths.sort();
    for path in paths {
        let mut lines = BufReader::new(File::open(&path).map_err(|e| fail(&path, e))?);
        let mut line = Vec::new();
        while lines.read_until(b'\n', &mut line).map_err(|e| fail(&path, e))? > 0 {
            if let Ok(entry) = serde_json::from_slice(&line) {
                each(entry);
            }
            line.clear();
        }
    }
    Ok(())
}
