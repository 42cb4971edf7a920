//! GeoPackage 1.0 to 1.4 of the OGC, <https://www.geopackage.org/spec140/>: a database of SQLite with tables of
//! features.
//!
//! Tables are read row by row; written files have one table without a spatial index, and are written page by page.

mod blob;
mod contents;
mod read;
mod write;

pub use read::Reader;
pub use write::Writer;

use crate::sqlite::MAGIC;

/// "GPKG", the application id in the file's header.
const APPLICATION: u32 = 0x4750_4b47;

/// Returns whether the bytes begin like a GeoPackage: a database that says so itself, or by its
/// tables.
pub fn sniff(bytes: &[u8]) -> bool {
    const TABLE: &[u8] = b"gpkg_contents";
    let says_so = bytes.get(68..72).is_some_and(|own| matches!(own, b"GPKG" | b"GP10" | b"GP11"));
    bytes.starts_with(MAGIC) && (says_so || bytes.windows(TABLE.len()).any(|w| w == TABLE))
}
