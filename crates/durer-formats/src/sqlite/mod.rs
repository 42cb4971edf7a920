//! Databases of SQLite: <https://www.sqlite.org/fileformat2.html>. New ones are written page by page, and tables of
//! others are read row by row. Only the names of columns are read from their SQL.

mod columns;
mod read;
mod write;

pub use columns::{Column, columns};
pub use read::{Database, Rows, Table};
pub use write::{Database as NewDatabase, Table as NewTable, index, record};

use std::borrow::Cow;

/// First bytes of a file.
pub const MAGIC: &[u8; 16] = b"SQLite format 3\0";

/// Bytes of the file's header, on the first page.
const HEADER: usize = 100;

/// Kinds of pages.
const TABLE_INNER: u8 = 5;
const TABLE_LEAF: u8 = 13;
const INDEX_INNER: u8 = 2;
const INDEX_LEAF: u8 = 10;

/// A value of a row.
#[derive(Debug, Clone, PartialEq)]
pub enum Value<'a> {
    /// None.
    Null,
    /// A whole number.
    Integer(i64),
    /// A number.
    Real(f64),
    /// Text.
    Text(Cow<'a, str>),
    /// Bytes.
    Blob(&'a [u8]),
}

impl<'a> From<&'a str> for Value<'a> {
    fn from(text: &'a str) -> Self {
        Self::Text(Cow::Borrowed(text))
    }
}

impl Value<'_> {
    /// Returns the text, if it is one.
    pub fn text(&self) -> Option<&str> {
        match self {
            Self::Text(text) => Some(text),
            _ => None,
        }
    }

    /// Returns the whole number, if it is one.
    pub fn integer(&self) -> Option<i64> {
        match self {
            Self::Integer(value) => Some(*value),
            _ => None,
        }
    }
}
