//! Finds what a model refers to: in its own folder, nowhere else.

use crate::failure::in_words;
use durer_formats::Resources;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

/// The folder of a model.
///
/// # Guarantees
/// Only regular files below the folder are read, also where links or `..` lead elsewhere; never a
/// network address.
#[derive(Debug)]
pub struct Folder {
    /// Without links and `..`.
    root: PathBuf,
}

impl Folder {
    /// The folder that holds the file; where the file is a link, what it leads to.
    pub fn of(model: &Path) -> std::io::Result<Self> {
        let model = fs::canonicalize(model)?;
        let root = model.parent().unwrap_or(Path::new("/")).to_owned();
        Ok(Self { root })
    }

    /// The file's true place, if that is below the folder.
    fn find(&self, path: &str) -> Result<PathBuf, String> {
        if has_scheme(path) {
            return Err(
                "network addresses are never fetched; keep the file beside the model".into()
            );
        }
        let full = fs::canonicalize(self.root.join(path)).map_err(|e| in_words(&e))?;
        if full.starts_with(&self.root) {
            Ok(full)
        } else {
            Err("it lies outside the model's folder, where nothing is read".to_owned())
        }
    }
}

/// Whether a reference begins like `http:` or `file:` (RFC 3986), with at least two letters, so that
/// it is no drive.
fn has_scheme(path: &str) -> bool {
    let Some((scheme, _)) = path.split_once(':') else { return false };
    let letter = |c: char| c.is_ascii_alphanumeric() || "+-.".contains(c);
    scheme.len() > 1
        && scheme.starts_with(|c: char| c.is_ascii_alphabetic())
        && scheme.chars().all(letter)
}

impl Resources for Folder {
    fn read(&self, path: &str, limit: u64) -> Result<Vec<u8>, String> {
        let full = self.find(path)?;
        let metadata = fs::metadata(&full).map_err(|e| in_words(&e))?;
        if !metadata.is_file() {
            return Err("it is not a file".to_owned());
        }
        let too_large =
            || format!("it is larger than the {limit} bytes that are left of the limit");
        if metadata.len() > limit {
            return Err(too_large());
        }
        let file = File::open(&full).map_err(|e| in_words(&e))?;
        let mut bytes = Vec::with_capacity(usize::try_from(metadata.len()).unwrap_or(0));
        file.take(limit.saturating_add(1)).read_to_end(&mut bytes).map_err(|e| in_words(&e))?;
        if bytes.len() as u64 > limit { Err(too_large()) } else { Ok(bytes) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn schemes_are_told_from_paths() {
        for url in ["http://a/b", "https:b", "file:///etc/passwd", "data:x", "s3+x:y"] {
            assert!(has_scheme(url), "{url}");
        }
        for path in ["a/b.bin", "C:/x", "a b:c", "", "ü:x", "./x:y"] {
            assert!(!has_scheme(path), "{path}");
        }
    }
}
