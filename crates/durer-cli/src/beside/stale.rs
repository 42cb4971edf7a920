//! Unfinished files of runs that were killed.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// No run takes as long; younger files may still be written.
const DAY: Duration = Duration::from_secs(24 * 60 * 60);

/// Folders that were looked through.
static DONE: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Removes the files from the folder of `place` that a killed run has left there, once in a run.
pub fn remove_beside(place: &Path) {
    let folder = place.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !DONE.lock().unwrap_or_else(PoisonError::into_inner).insert(folder.to_owned()) {
        return;
    }
    // A folder that cannot be read, or a file that cannot be removed, stays as it is.
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.file_name().to_str().is_some_and(is_own) && is_old(&entry) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Returns whether a name is an unfinished file's: `.durer-PROCESS-NUMBER.tmp`.
fn is_own(name: &str) -> bool {
    let inner = name.strip_prefix(".durer-").and_then(|name| name.strip_suffix(".tmp"));
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    inner.and_then(|inner| inner.split_once('-')).is_some_and(|(a, b)| digits(a) && digits(b))
}

/// Returns whether a file was last written more than a day ago.
fn is_old(entry: &fs::DirEntry) -> bool {
    // Of a link this speaks of the link.
    let Ok(metadata) = entry.metadata() else { return false };
    let age = metadata.modified().ok().and_then(|time| time.elapsed().ok());
    metadata.is_file() && age.is_some_and(|age| age > DAY)
}

#[cfg(test)]
mod tests {
    use super::is_own;

    #[test]
    fn only_own_names_are_known() {
        assert!(is_own(".durer-4711-0.tmp"));
        for other in [
            "durer-1-0.tmp",
            ".durer-1.tmp",
            ".durer-a-0.tmp",
            ".durer-1-0.png",
            ".durer--.tmp",
            ".durer-1-0.tmp.tmp",
        ] {
            assert!(!is_own(other), "{other}");
        }
    }
}
