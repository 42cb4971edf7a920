//! Facts about a file from outside its bytes.

use crate::{NoResources, Resources};

/// Files that are held whole may have this many bytes.
pub(super) const MAX_BYTES: u64 = 4 << 30;

/// Name of a file, access to the files beside it, and the requested layer.
#[derive(Clone, Copy)]
pub struct Beside<'a> {
    /// The file's name, without a folder.
    pub name: &'a str,
    /// Access to the other files of a format that has several, by the file's name with another ending.
    pub resources: &'a dyn Resources,
    /// The layer that is read of a file with several; all, if none is named.
    pub layer: Option<&'a str>,
}

impl Beside<'_> {
    /// A file without a name and without other files, all of whose layers are read.
    pub const NOTHING: Beside<'static> = Beside { name: "", resources: &NoResources, layer: None };

    /// Returns the file of the same name with another suffix; `None` if there is none.
    pub(super) fn find(&self, suffix: &str) -> Option<Vec<u8>> {
        let stem = self.name.strip_suffix(".gz").unwrap_or(self.name);
        let stem = stem.rsplit_once('.').map_or(stem, |(stem, _)| stem);
        let found = self.resources.find(&format!("{stem}.{suffix}"), MAX_BYTES);
        found.ok().map(|found| found.bytes).filter(|_| !stem.is_empty())
    }
}
