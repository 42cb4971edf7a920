//! The folder of shared test data, and the files below a folder.

use durer_formats::Resources;
use std::path::{Path, PathBuf};

/// Returns the folder of shared data: `DURER_DATA`, or the one beside the workspace. Prints a note if there is none.
pub fn data() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("DURER_DATA").map_or(beside, PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: no shared data at {}", folder.display());
    None
}

/// Files below `folder` with one of the suffixes, in any case, sorted.
pub fn files(folder: &Path, suffixes: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("folder") {
        let path = entry.expect("entry").path();
        let suffix = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        if path.is_dir() {
            found.extend(files(&path, suffixes));
        } else if suffix.is_some_and(|s| suffixes.contains(&s.as_str())) {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Files of one folder.
pub struct Folder(pub PathBuf);

impl Resources for Folder {
    fn read(&self, path: &str, _limit: u64) -> Result<Vec<u8>, String> {
        if path.starts_with('/') || path.split('/').any(|p| p == "..") {
            return Err("it is outside the model's folder".to_owned());
        }
        std::fs::read(self.0.join(path)).map_err(|e| e.to_string())
    }
}
