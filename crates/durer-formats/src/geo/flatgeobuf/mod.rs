//! FlatGeobuf 3: a header with fields and coordinate system, an index of places, and features one after the
//! other. <https://github.com/flatgeobuf/flatgeobuf>, files `header.fbs` and `feature.fbs`.
//!
//! Written files have an index, for which features are sorted along Hilbert's curve.

mod build;
mod index;
mod read;
mod table;
mod write;

pub use read::Reader;
pub use write::write;

/// First bytes of a file; the byte after them is the number of a patch.
const MAGIC: [u8; 7] = *b"fgb\x03fgb";

/// Bytes before the header.
const HEAD: usize = 8;

/// Returns whether the bytes begin like a file of this version.
pub fn sniff(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC)
}

/// Kinds of columns, by their numbers.
mod column {
    pub const BYTE: u8 = 0;
    pub const UBYTE: u8 = 1;
    pub const BOOL: u8 = 2;
    pub const SHORT: u8 = 3;
    pub const USHORT: u8 = 4;
    pub const INT: u8 = 5;
    pub const UINT: u8 = 6;
    pub const LONG: u8 = 7;
    pub const ULONG: u8 = 8;
    pub const FLOAT: u8 = 9;
    pub const DOUBLE: u8 = 10;
    pub const STRING: u8 = 11;
    pub const JSON: u8 = 12;
    pub const DATE_TIME: u8 = 13;
    pub const BINARY: u8 = 14;
}
