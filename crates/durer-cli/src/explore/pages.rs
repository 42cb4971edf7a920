//! The files of the explorer: built into the command, or in a folder.

use crate::failure::Failure;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// Files by their paths, with `/` between folders.
#[derive(Debug, Clone)]
pub enum Pages {
    /// Files of a folder.
    Folder(Arc<Path>),
    /// Files that were there when the command was built.
    #[cfg(feature = "explorer")]
    Built,
}

#[cfg(feature = "explorer")]
static BUILT: include_dir::Dir<'_> = include_dir::include_dir!("$CARGO_MANIFEST_DIR/explorer");

impl Pages {
    /// Returns the pages of a folder, or without one those in the command.
    pub fn new(from: Option<&Path>) -> Result<Self, Failure> {
        let Some(from) = from else { return Self::built() };
        if from.join("index.html").is_file() {
            return Ok(Self::Folder(from.into()));
        }
        let shown = durer_formats::wording::shown_path(from);
        Err(Failure::Usage(format!(
            "--from {shown}: there is no index.html in it; .ci/explorer builds the pages into explorer/dist"
        )))
    }

    #[cfg(feature = "explorer")]
    fn built() -> Result<Self, Failure> {
        Ok(Self::Built)
    }

    #[cfg(not(feature = "explorer"))]
    fn built() -> Result<Self, Failure> {
        Err(Failure::Usage(
            "this command was built without the pages (the feature `explorer`); \
             --from DIR serves the pages that .ci/explorer builds into explorer/dist"
                .to_owned(),
        ))
    }

    /// Returns a file's bytes; `None` if there is no such file, or its path leads elsewhere.
    pub fn file(&self, path: &str) -> Option<Vec<u8>> {
        match self {
            Self::Folder(folder) => std::fs::read(within(folder, path)?).ok(),
            #[cfg(feature = "explorer")]
            Self::Built => BUILT.get_file(path).map(|file| file.contents().to_vec()),
        }
    }
}

/// Returns the path of a file in a folder, unless it leads out of it, by its parts or by links.
fn within(folder: &Path, path: &str) -> Option<PathBuf> {
    let relative = Path::new(path);
    let plain = relative.components().all(|part| matches!(part, Component::Normal(_)));
    let joined = folder.join(relative).canonicalize().ok()?;
    let inside = plain && joined.starts_with(folder.canonicalize().ok()?);
    inside.then_some(joined)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_stay_in_the_folder() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        assert!(within(&folder, "lib.rs").is_some() && within(&folder, "explore/mod.rs").is_some());
        for path in ["../Cargo.toml", "explore/../../Cargo.toml", "/etc/passwd", "none.rs"] {
            assert_eq!(within(&folder, path), None, "{path}");
        }
    }
}
