//! Tables of databases, row by row, from untrusted bytes.

use super::{HEADER, MAGIC, TABLE_INNER, TABLE_LEAF, Value};
use crate::{Error, Result};
use std::borrow::Cow;

/// Largest height of a tree of pages, as in SQLite.
const MAX_DEPTH: usize = 20;

/// Encoding of texts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Encoding {
    Utf8,
    Utf16Le,
    Utf16Be,
}

/// A database that is held whole.
pub struct Database {
    bytes: Vec<u8>,
    /// Bytes of a page.
    page: usize,
    /// Bytes of it that hold data.
    usable: usize,
    encoding: Encoding,
}

/// A table, view or index of a database.
#[derive(Debug, Clone)]
pub struct Table {
    /// `table`, `view`, `index` or `trigger`.
    pub kind: String,
    /// Its name.
    pub name: String,
    /// Its first page; 0 if it has none.
    pub root: u32,
    /// Statement that created it.
    pub sql: String,
}

/// A row in its stored form.
pub struct Row<'a> {
    /// Its number.
    pub number: i64,
    /// Kinds of its values, and values.
    pub record: Cow<'a, [u8]>,
}

impl Database {
    /// Reads the header.
    ///
    /// # Errors
    /// If the header is missing or invalid.
    pub fn new(bytes: Vec<u8>) -> Result<Self> {
        let head: &[u8; HEADER] = bytes
            .first_chunk()
            .filter(|head| head.starts_with(MAGIC))
            .ok_or_else(|| Error::byte(0, "the header of an SQLite database is expected"))?;
        let page = match u16::from_be_bytes([head[16], head[17]]) {
            1 => 1 << 16,
            size => usize::from(size),
        };
        if !page.is_power_of_two() || page < 512 {
            let message = format!("pages of {page} bytes; it must be a power of two from 512 on");
            return Err(Error::byte(16, message));
        }
        let usable = page - usize::from(head[20]);
        if usable < 480 {
            return Err(Error::byte(20, "pages keep more for others than they may"));
        }
        let encoding = match head[59] {
            2 => Encoding::Utf16Le,
            3 => Encoding::Utf16Be,
            _ => Encoding::Utf8,
        };
        Ok(Self { page, usable, encoding, bytes })
    }

    /// Returns the number of the application that the file is for.
    pub fn application(&self) -> u32 {
        word(&self.bytes, 68).unwrap_or(0)
    }

    fn pages(&self) -> u64 {
        self.bytes.len().div_ceil(self.page) as u64
    }

    /// Returns a page.
    fn page(&self, number: u32) -> Result<&[u8]> {
        let start = (number as usize).checked_sub(1).and_then(|i| i.checked_mul(self.page));
        let found = start.and_then(|start| self.bytes.get(start..start.checked_add(self.page)?));
        found.ok_or_else(|| {
            let pages = self.bytes.len() / self.page;
            Error::whole(format!("page {number} is needed, but the file ends after {pages}"))
        })
    }

    fn wrong(&self, page: u32, message: &str) -> Error {
        Error::byte((u64::from(page).saturating_sub(1)) * self.page as u64, message)
    }

    /// Returns everything in the database, as its first table lists it.
    ///
    /// # Errors
    /// If that table cannot be read.
    pub fn tables(&self) -> Result<Vec<Table>> {
        let (mut rows, mut tables) = (self.rows(1), Vec::new());
        while let Some(row) = rows.next(self)? {
            let values = self.values(&row)?;
            let text = |i| values.get(i).and_then(Value::text).unwrap_or_default().to_owned();
            let root = values.get(3).and_then(Value::integer);
            let root = root.and_then(|root| u32::try_from(root).ok()).unwrap_or(0);
            tables.push(Table { kind: text(0), name: text(1), root, sql: text(4) });
        }
        Ok(tables)
    }

    /// Returns the rows of a table, by its first page.
    pub fn rows(&self, root: u32) -> Rows {
        Rows { stack: vec![(root, 0)], left: self.pages(), bytes_left: self.bytes.len() }
    }

    /// Returns the values of a row.
    ///
    /// # Errors
    /// If the row has no room for them.
    pub fn values<'a>(&self, row: &'a Row<'_>) -> Result<Vec<Value<'a>>> {
        let wrong = || Error::whole(format!("row {} of a table cannot be read", row.number));
        self.values_of(&row.record).ok_or_else(wrong)
    }

    fn values_of<'a>(&self, record: &'a [u8]) -> Option<Vec<Value<'a>>> {
        let (length, after) = varint(record)?;
        let start = record.len() - after.len();
        let (mut kinds, mut body) = record.split_at_checked(usize::try_from(length).ok()?)?;
        kinds = kinds.get(start..)?;
        let mut values = Vec::new();
        while !kinds.is_empty() {
            let (kind, rest) = varint(kinds)?;
            kinds = rest;
            let (own, rest) = body.split_at_checked(size(kind)?)?;
            body = rest;
            values.push(self.value(kind, own));
        }
        Some(values)
    }

    fn value<'a>(&self, kind: u64, bytes: &'a [u8]) -> Value<'a> {
        match kind {
            0 => Value::Null,
            7 => Value::Real(f64::from_be_bytes(bytes.try_into().unwrap_or_default())),
            8 | 9 => Value::Integer(kind as i64 - 8),
            1..=6 => {
                let sign = if bytes.first().is_some_and(|b| b & 0x80 != 0) { -1 } else { 0 };
                Value::Integer(bytes.iter().fold(sign, |n: i64, b| n << 8 | i64::from(*b)))
            }
            _ if kind.is_multiple_of(2) => Value::Blob(bytes),
            _ => Value::Text(self.text(bytes)),
        }
    }

    fn text<'a>(&self, bytes: &'a [u8]) -> Cow<'a, str> {
        let wide = |of: fn([u8; 2]) -> u16| {
            let units: Vec<u16> = bytes.as_chunks().0.iter().map(|pair| of(*pair)).collect();
            Cow::Owned(String::from_utf16_lossy(&units))
        };
        match self.encoding {
            Encoding::Utf8 => String::from_utf8_lossy(bytes),
            Encoding::Utf16Le => wide(u16::from_le_bytes),
            Encoding::Utf16Be => wide(u16::from_be_bytes),
        }
    }
}

/// Position of the reader in a table's rows.
pub struct Rows {
    /// Pages from the first one downwards, and the next entry of each.
    stack: Vec<(u32, usize)>,
    /// Pages that may yet be read: none is read twice, but where the file is wrong.
    left: u64,
    /// Bytes that rows may yet have: none belongs to two.
    bytes_left: usize,
}

impl Rows {
    /// Returns the next row; `None` at the end.
    ///
    /// # Errors
    /// If pages do not belong to a table.
    pub fn next<'a>(&mut self, database: &'a Database) -> Result<Option<Row<'a>>> {
        while let Some(&(number, index)) = self.stack.last() {
            let node = Node::new(database, number)?;
            if let Some(top) = self.stack.last_mut() {
                top.1 += 1;
            }
            if node.is_leaf && index < node.count {
                return self.row(database, &node, index).map(Some);
            }
            match node.child(index) {
                Some(child) if self.stack.len() < MAX_DEPTH => {
                    self.visit(database, number)?;
                    self.stack.push((child, 0));
                }
                Some(_) => return Err(database.wrong(number, "pages are nested too deep")),
                None if index >= node.count => drop(self.stack.pop()),
                None => {
                    return Err(database.wrong(number, "an entry of the page is beyond its end"));
                }
            }
        }
        Ok(None)
    }

    fn visit(&mut self, database: &Database, page: u32) -> Result<()> {
        let again = "pages of a table lead to each other without end";
        self.left = self.left.checked_sub(1).ok_or_else(|| database.wrong(page, again))?;
        Ok(())
    }

    fn row<'a>(
        &mut self,
        database: &'a Database,
        node: &Node<'a>,
        index: usize,
    ) -> Result<Row<'a>> {
        let cut = || database.wrong(node.number, "a row of the page is beyond its end");
        let cell = node.cell(index).ok_or_else(cut)?;
        let (length, cell) = varint(cell).ok_or_else(cut)?;
        let (number, cell) = varint(cell).ok_or_else(cut)?;
        let length = usize::try_from(length).ok().filter(|l| *l <= database.bytes.len());
        let length = length.ok_or_else(cut)?;
        let twice = || database.wrong(node.number, "rows of the table overlap");
        self.bytes_left = self.bytes_left.checked_sub(length + 2).ok_or_else(twice)?;
        let here = local(length, database.usable);
        let (own, rest) = cell.split_at_checked(here).ok_or_else(cut)?;
        let record = if here == length {
            Cow::Borrowed(own)
        } else {
            let next = word(rest, 0).ok_or_else(cut)?;
            Cow::Owned(self.follow(database, own, length, next)?)
        };
        Ok(Row { number: number as i64, record })
    }

    /// Returns the bytes of a row that continues on other pages.
    fn follow(
        &mut self,
        database: &Database,
        own: &[u8],
        length: usize,
        first: u32,
    ) -> Result<Vec<u8>> {
        let (mut record, mut next) = (own.to_vec(), first);
        while record.len() < length {
            self.visit(database, next)?;
            let page = database.page(next)?;
            let part = page.get(4..database.usable).unwrap_or_default();
            record.extend_from_slice(part.get(..length - record.len()).unwrap_or(part));
            next = word(page, 0).unwrap_or(0);
        }
        Ok(record)
    }
}

/// A page of a table's tree.
struct Node<'a> {
    number: u32,
    /// The whole page: cells are found from its start.
    page: &'a [u8],
    /// Offset of the list of cells.
    list: usize,
    is_leaf: bool,
    count: usize,
    last: Option<u32>,
}

impl<'a> Node<'a> {
    fn new(database: &'a Database, number: u32) -> Result<Self> {
        let page = database.page(number)?;
        let page = page.get(..database.usable).unwrap_or(page);
        let start = if number == 1 { HEADER } else { 0 };
        let head = page.get(start..).unwrap_or_default();
        let is_leaf = match head.first() {
            Some(&TABLE_LEAF) => true,
            Some(&TABLE_INNER) => false,
            _ => return Err(database.wrong(number, "a page of a table is expected")),
        };
        let count = head.get(3..5).map_or(0, |b| usize::from(b[0]) << 8 | usize::from(b[1]));
        let last = if is_leaf { None } else { word(head, 8) };
        Ok(Self { number, page, list: start + if is_leaf { 8 } else { 12 }, is_leaf, count, last })
    }

    fn cell(&self, index: usize) -> Option<&'a [u8]> {
        let at = self.list + 2 * index;
        let at = self.page.get(at..at + 2)?;
        self.page.get(usize::from(at[0]) << 8 | usize::from(at[1])..)
    }

    /// Returns a child page; there is one more after the cells'.
    fn child(&self, index: usize) -> Option<u32> {
        match index.cmp(&self.count) {
            _ if self.is_leaf => None,
            std::cmp::Ordering::Less => word(self.cell(index)?, 0),
            std::cmp::Ordering::Equal => self.last,
            std::cmp::Ordering::Greater => None,
        }
    }
}

/// Returns the bytes of a record that are on the page of its row.
fn local(length: usize, usable: usize) -> usize {
    let most = usable - 35;
    if length <= most {
        return length;
    }
    let least = (usable - 12) * 32 / 255 - 23;
    let part = least + (length - least) % (usable - 4);
    if part <= most { part } else { least }
}

/// Returns the bytes of a value of a kind.
fn size(kind: u64) -> Option<usize> {
    match kind {
        0 | 8 | 9 => Some(0),
        1..=4 => Some(kind as usize),
        5 => Some(6),
        6 | 7 => Some(8),
        10 | 11 => None,
        _ => usize::try_from((kind - 12) / 2).ok(),
    }
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_be_bytes(*bytes.get(at..)?.first_chunk()?))
}

/// Returns a number of up to nine bytes, and the rest after it.
fn varint(bytes: &[u8]) -> Option<(u64, &[u8])> {
    let mut value = 0;
    for (i, &byte) in bytes.iter().enumerate().take(9) {
        if i == 8 {
            return Some((value << 8 | u64::from(byte), bytes.get(9..)?));
        }
        value = value << 7 | u64::from(byte & 0x7f);
        if byte < 0x80 {
            return Some((value, bytes.get(i + 1..)?));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_from_their_highest_bits() {
        assert_eq!(varint(&[0x7f, 9]), Some((0x7f, &[9][..])));
        assert_eq!(varint(&[0x81, 0]), Some((0x80, &[][..])));
        assert_eq!(varint(&[255; 9]), Some((u64::MAX, &[][..])));
        assert_eq!((varint(&[]), varint(&[0x80]), varint(&[255; 8])), (None, None, None));
    }

    #[test]
    fn sizes_are_those_of_the_format() {
        assert_eq!([0, 1, 5, 6, 7, 9, 12, 13, 18].map(size), [0, 1, 6, 8, 8, 0, 0, 0, 3].map(Some));
        assert_eq!(size(10), None);
        assert_eq!((local(4061, 4096), local(4062, 4096), local(5000, 4096)), (4061, 489, 908));
    }
}
