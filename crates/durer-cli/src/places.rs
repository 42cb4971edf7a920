//! The identity of files regardless of spelling: `a.png`, `./a.png`, links to it and its full path are one place.

use crate::failure::Failure;
use crate::sandbox::{self, Sandbox};
use clap::ArgMatches;
use std::ffi::OsStr;
use std::fs::{self, Metadata};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The argument that means standard input or output.
pub const STREAM: &str = "-";

/// Returns whether the argument means standard input or output.
pub fn is_stream(path: &Path) -> bool {
    path.as_os_str() == OsStr::new(STREAM)
}

/// Options that name outputs; all other options with paths name inputs.
const OUTPUTS: [&str; 4] = ["output", "item", "depth", "normal"];

/// The command that reads depths.
const WARP: &str = "warp";

/// The command whose rows are run by other processes.
const BATCH: &str = "batch";

/// Options that name inputs although their values are more than paths.
pub const OTHER_INPUTS: [&str; 2] = ["environment", "annotations"];

/// A place for a file, whether there is one or not.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// Standard output, if it is not a file.
    Stdout,
    /// A file that is there: the numbers of its device and its inode.
    There(u64, u64),
    /// The full path of a file that does not exist yet, or of any file where the system has no such numbers; without
    /// links and `..` where possible.
    At(PathBuf),
}

impl Place {
    /// Returns the place of a path.
    pub fn of(path: &Path) -> Self {
        fs::metadata(path).ok().and_then(|m| numbers(&m)).unwrap_or_else(|| Self::At(full(path)))
    }

    /// Returns the place that standard output leads to.
    pub fn of_stdout() -> Self {
        let metadata = fs::metadata("/dev/stdout").ok().filter(Metadata::is_file);
        metadata.and_then(|m| numbers(&m)).unwrap_or(Self::Stdout)
    }
}

#[cfg(unix)]
fn numbers(metadata: &Metadata) -> Option<Place> {
    use std::os::unix::fs::MetadataExt;
    Some(Place::There(metadata.dev(), metadata.ino()))
}

#[cfg(not(unix))]
fn numbers(_: &Metadata) -> Option<Place> {
    None
}

/// Returns a path without links and `..`, as far as its folder is there.
fn full(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::canonicalize(path)
        .or_else(|_| fs::canonicalize(folder).map(|f| f.join(path.file_name().unwrap_or_default())))
        .unwrap_or_else(|_| path.to_owned())
}

/// Confines the process to the folders of the files that a command names, if requested. Comes before any other thread.
pub fn settle(name: &str, given: &ArgMatches) -> Result<(), Failure> {
    match given.try_get_one::<Sandbox>("sandbox") {
        // Its workers are confined.
        Ok(Some(&how)) if name != BATCH => {
            let (inputs, outputs) = named(name, given);
            if let Some(warning) = sandbox::confine(how, &inputs, &outputs)? {
                // If standard error is closed, the warning is lost.
                let _ = writeln!(std::io::stderr().lock(), "durer: warning: {warning}");
            }
            Ok(())
        }
        _ => Ok(()),
    }
}

/// Returns the paths that a command reads and the paths that it writes.
pub fn named(command: &str, given: &ArgMatches) -> (Vec<PathBuf>, Vec<PathBuf>) {
    let (mut inputs, mut outputs) = (Vec::new(), Vec::new());
    for id in given.ids().map(clap::Id::as_str) {
        let list = match OUTPUTS.contains(&id) && (command, id) != (WARP, "depth") {
            true => &mut outputs,
            false => &mut inputs,
        };
        if let Ok(Some(paths)) = given.try_get_many::<PathBuf>(id) {
            list.extend(paths.filter(|path| !is_stream(path)).cloned());
        } else if OTHER_INPUTS.contains(&id) {
            list.extend(given.get_raw(id).into_iter().flatten().map(PathBuf::from));
        }
    }
    (inputs, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spelling_makes_no_other_place() {
        let here = std::env::current_dir().unwrap();
        for name in ["Cargo.toml", "no such file"] {
            let place = Place::of(Path::new(name));
            for other in [Path::new("./src/..").join(name), here.join(name)] {
                assert_eq!(Place::of(&other), place, "{}", other.display());
            }
        }
        assert_ne!(Place::of(Path::new("Cargo.toml")), Place::of(Path::new("no such file")));
    }
}
