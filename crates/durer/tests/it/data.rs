//! Real models: their folder, and how tests read them.

use durer_formats::{Model, Pose, ReadOptions, Resources};
use std::path::{Path, PathBuf};

/// Returns the folder of shared data: `DURER_DATA`, else `../shared/data` beside the workspace. Prints that a test is
/// skipped if there is none.
pub fn folder() -> Option<PathBuf> {
    let default = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("DURER_DATA").map_or(default, PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: there is no {}", folder.display());
    None
}

/// Finds referenced files in the model's folder.
struct Folder(PathBuf);

impl Resources for Folder {
    fn read(&self, path: &str, _limit: u64) -> Result<Vec<u8>, String> {
        std::fs::read(self.0.join(path)).map_err(|e| e.to_string())
    }
}

/// Reads a valid model in its rest pose.
pub fn read_model(path: &Path) -> Model {
    read_posed(path, None)
}

/// Reads a model in its rest pose; `None` if it is refused.
pub fn try_read_model(path: &Path) -> Option<Model> {
    let bytes = std::fs::read(path).expect("model");
    let resources = Folder(path.parent().expect("folder").to_owned());
    let name = path.to_string_lossy();
    durer_formats::read_model(&bytes, &name, &resources, &ReadOptions::default()).ok()
}

/// Reads a valid model, posed this many seconds into its first animation.
pub fn read_posed(path: &Path, time: Option<f64>) -> Model {
    let bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let resources = Folder(path.parent().expect("folder").to_owned());
    let pose = time.map(|time| Pose { animation: None, time });
    let options = ReadOptions { pose, ..ReadOptions::default() };
    durer_formats::read_model(&bytes, &path.to_string_lossy(), &resources, &options)
        .unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}
