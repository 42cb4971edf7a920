//! E57, the format of terrestrial laser scanners (feature `e57`).

#[cfg(not(feature = "e57"))]
#[path = "e57/no_scan.rs"]
mod scan;
#[cfg(feature = "e57")]
mod scan;

pub use scan::read;

/// First bytes of a file.
pub(crate) const MAGIC: &[u8] = b"ASTM-E57";

/// Returns whether the content begins as E57 does.
pub(crate) fn sniff(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}
