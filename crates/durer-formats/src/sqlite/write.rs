//! New databases of SQLite, written from the first page to the last: <https://www.sqlite.org/fileformat2.html>.
//!
//! Tables get their rows in the order of their numbers, and indices are built when all entries are known; only the
//! first page is ever changed.

use super::{HEADER, INDEX_INNER, INDEX_LEAF, MAGIC, TABLE_INNER, TABLE_LEAF, Value};
use crate::{Error, Place, Result};

/// Bytes of a page.
const PAGE: usize = 4096;

/// The page with the byte 2^30 is never used: locks are there.
const LOCKED: u32 = (1 << 30) / PAGE as u32 + 1;

/// A page may have this number, and no higher one.
const MOST_PAGES: u32 = u32::MAX - 4;

/// Length above which a record continues on other pages …
const MOST: usize = PAGE - 35;

/// … so that at least this stays.
const LEAST: usize = (PAGE - 12) * 32 / 255 - 23;

/// Largest record in SQLite's default build.
const LONGEST: usize = 1_000_000_000;

/// The pages of a database that is being written, except the first one, which depends on all others.
pub struct Database {
    /// Free pages.
    out: Vec<u8>,
    /// The number of the last page written.
    pages: u32,
    schema: Vec<Vec<u8>>,
}

impl Database {
    /// Creates a database without a table; the first allocation takes the place of the first page.
    pub fn new() -> Self {
        Self { out: vec![0; PAGE], pages: 1, schema: Vec::new() }
    }

    /// Returns the pages added since the last call.
    pub fn take(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.out)
    }

    /// Writes a page and returns its number.
    fn page(&mut self, bytes: &[u8]) -> Result<u32> {
        if self.pages >= MOST_PAGES {
            let (value, limit) = (u64::from(self.pages) + 1, MOST_PAGES.into());
            let (place, what) = (Place::Whole, "number of pages of a database");
            return Err(Error::Limit { place, what, value, limit });
        }
        if self.pages + 1 == LOCKED {
            self.out.extend([0; PAGE]);
        }
        self.pages = after(self.pages);
        let end = self.out.len() + PAGE;
        self.out.extend_from_slice(bytes);
        self.out.resize(end, 0);
        Ok(self.pages)
    }

    /// Registers a table or index whose first page is `root`; an index that SQLite makes automatically has no text.
    pub fn name(&mut self, kind: &str, name: &str, table: &str, root: u32, sql: &str) {
        let sql = if sql.is_empty() { Value::Null } else { Value::from(sql) };
        let [kind, name, table] = [kind, name, table].map(Value::from);
        self.schema.push(record(&[kind, name, table, Value::Integer(root.into()), sql]));
    }

    /// Returns the first page, and the remaining others; `application` is the number of the application, `version`
    /// which of its kind it is.
    pub fn finish(mut self, application: u32, version: u32) -> Result<(Vec<u8>, Vec<u8>)> {
        let mut first = Page::new(TABLE_LEAF, HEADER);
        let mut table = Vec::new();
        for (row, number) in std::mem::take(&mut self.schema).iter().zip(1..) {
            table.push(self.row(number, row)?);
        }
        if table.iter().any(|cell| !first.add(cell)) {
            let (what, hint) = ("a table of so many fields".to_owned(), String::new());
            return Err(Error::Unsupported { place: Place::Whole, what, hint });
        }
        let mut bytes = first.bytes(None);
        bytes[..HEADER].copy_from_slice(&header(self.pages, application, version));
        Ok((bytes, self.out))
    }

    /// Returns the cell of a row; the rest of a long record goes to overflow pages.
    fn row(&mut self, number: i64, record: &[u8]) -> Result<Vec<u8>> {
        if record.len() > LONGEST {
            let (value, limit) = (record.len() as u64, LONGEST as u64);
            return Err(Error::Limit {
                place: Place::Whole,
                what: "size of a row in bytes",
                value,
                limit,
            });
        }
        let mut cell = Vec::new();
        varint(&mut cell, record.len() as u64);
        varint(&mut cell, number as u64);
        if record.len() <= MOST {
            cell.extend_from_slice(record);
            return Ok(cell);
        }
        let part = LEAST + (record.len() - LEAST) % (PAGE - 4);
        let (here, there) = record.split_at(if part <= MOST { part } else { LEAST });
        cell.extend_from_slice(here);
        cell.extend(after(self.pages).to_be_bytes());
        let mut chunks = there.chunks(PAGE - 4).peekable();
        while let Some(chunk) = chunks.next() {
            let more = chunks.peek().is_some();
            let next = if more { after(after(self.pages)) } else { 0 };
            self.page(&[&next.to_be_bytes(), chunk].concat())?;
        }
        Ok(cell)
    }
}

/// Returns the number of the page after one.
fn after(page: u32) -> u32 {
    if page + 1 == LOCKED { page + 2 } else { page + 1 }
}

/// Returns the header of the file.
fn header(pages: u32, application: u32, version: u32) -> [u8; HEADER] {
    /// Version of the library whose format this is.
    const VERSION: u32 = 3_040_000;
    let mut header = [0; HEADER];
    let mut put = |at: usize, bytes: &[u8]| header[at..at + bytes.len()].copy_from_slice(bytes);
    put(0, MAGIC);
    put(16, &(PAGE as u16).to_be_bytes());
    // Versions, and shares of a page, that are always these.
    put(18, &[1, 1, 0, 64, 32, 32]);
    // Change counter, pages; schema: change counter, format; UTF-8.
    let counts = [(24, 1), (28, pages), (40, 1), (44, 4), (56, 1), (92, 1), (96, VERSION)];
    for (at, value) in counts.into_iter().chain([(60, version), (68, application)]) {
        put(at, &value.to_be_bytes());
    }
    header
}

/// A page of cells.
struct Page {
    kind: u8,
    /// Bytes before it, on the first page.
    before: usize,
    cells: Vec<u8>,
    ends: Vec<usize>,
}

impl Page {
    fn new(kind: u8, before: usize) -> Self {
        Self { kind, before, cells: Vec::new(), ends: Vec::new() }
    }

    fn head(&self) -> usize {
        self.before + if matches!(self.kind, TABLE_INNER | INDEX_INNER) { 12 } else { 8 }
    }

    fn fits(&self, cell: &[u8]) -> bool {
        self.head() + 2 * (self.ends.len() + 1) + self.cells.len() + cell.len() <= PAGE
    }

    /// Adds a cell if there is room for it.
    fn add(&mut self, cell: &[u8]) -> bool {
        let fits = self.fits(cell);
        if fits {
            self.push(cell);
        }
        fits
    }

    fn push(&mut self, cell: &[u8]) {
        self.cells.extend_from_slice(cell);
        self.ends.push(self.cells.len());
    }

    /// Returns the page, with a last child if it has children.
    fn bytes(&self, last: Option<u32>) -> Vec<u8> {
        let mut bytes = vec![0; self.before];
        let start = PAGE - self.cells.len();
        bytes.extend([self.kind, 0, 0]);
        bytes.extend((self.ends.len() as u16).to_be_bytes());
        bytes.extend((start as u16).to_be_bytes());
        bytes.push(0);
        bytes.extend(last.map(u32::to_be_bytes).into_iter().flatten());
        let starts = std::iter::once(0).chain(self.ends.iter().copied()).take(self.ends.len());
        starts.for_each(|from| bytes.extend(((start + from) as u16).to_be_bytes()));
        bytes.resize(start, 0);
        bytes.extend_from_slice(&self.cells);
        bytes
    }
}

/// A table that is written row by row.
pub struct Table {
    leaf: Page,
    /// The number of the last row.
    last: i64,
    /// Pages and the number of the last row of each.
    leaves: Vec<(u32, i64)>,
}

impl Table {
    /// Creates a table without a row.
    pub fn new() -> Self {
        Self { leaf: Page::new(TABLE_LEAF, 0), last: 0, leaves: Vec::new() }
    }

    /// Adds a row with the next number.
    pub fn add(&mut self, to: &mut Database, values: &[Value<'_>]) -> Result<()> {
        self.add_at(to, self.last + 1, values)
    }

    /// Adds a row with a number above all others.
    pub fn add_at(&mut self, to: &mut Database, number: i64, values: &[Value<'_>]) -> Result<()> {
        let cell = to.row(number, &record(values))?;
        if !self.leaf.fits(&cell) {
            self.end_leaf(to)?;
        }
        self.leaf.push(&cell);
        self.last = number;
        Ok(())
    }

    fn end_leaf(&mut self, to: &mut Database) -> Result<()> {
        let leaf = std::mem::replace(&mut self.leaf, Page::new(TABLE_LEAF, 0));
        self.leaves.push((to.page(&leaf.bytes(None))?, self.last));
        Ok(())
    }

    /// Writes the remaining rows, and the pages above; returns the number of the first page.
    pub fn finish(mut self, to: &mut Database) -> Result<u32> {
        self.end_leaf(to)?;
        let mut level = self.leaves;
        while level.len() > 1 {
            let mut above = Vec::new();
            for group in evenly(&level, CHILDREN) {
                let mut page = Page::new(TABLE_INNER, 0);
                let Some((&(last, row), others)) = group.split_last() else { continue };
                for &(child, row) in others {
                    let mut cell = child.to_be_bytes().to_vec();
                    varint(&mut cell, row as u64);
                    page.push(&cell);
                }
                above.push((to.page(&page.bytes(Some(last)))?, row));
            }
            level = above;
        }
        Ok(level.first().map_or(0, |(page, _)| *page))
    }
}

/// Number of children in a page: each takes 4 bytes, a number of 9, an offset of 2, and for indices
/// a record of at most …
const CHILDREN: usize = (PAGE - 12) / (15 + RECORD);

/// … this many bytes, its length included.
const RECORD: usize = 40;

/// Divides a list into parts of similar length, each with at most `most` items (2 at least).
fn evenly<T>(list: &[T], most: usize) -> impl Iterator<Item = &[T]> {
    let count = list.len().div_ceil(most);
    (0..count).map(move |i| &list[i * list.len() / count..(i + 1) * list.len() / count])
}

/// Writes an index: its records, each of at most 39 bytes, or fewer than four of at most 1000, in their order. Returns
/// the number of the first page.
pub fn index(to: &mut Database, records: &[Vec<u8>]) -> Result<u32> {
    let cell = |record: &[u8]| {
        let mut cell = Vec::new();
        varint(&mut cell, record.len() as u64);
        cell.extend_from_slice(record);
        cell
    };
    // There is one record between two leaves; it belongs to the leaf before it.
    let mut level: Vec<(u32, &[u8])> = Vec::new();
    let mut next = 0;
    let leaves = (records.len() + 1).div_ceil(CHILDREN).max(1);
    for leaf in 1..=leaves {
        let end = (leaf * (records.len() + 1) / leaves).saturating_sub(1);
        let mut page = Page::new(INDEX_LEAF, 0);
        records.get(next..end).unwrap_or_default().iter().for_each(|r| page.push(&cell(r)));
        let between = records.get(end).map_or(&[][..], Vec::as_slice);
        level.push((to.page(&page.bytes(None))?, between));
        next = end + 1;
    }
    while level.len() > 1 {
        let mut above = Vec::new();
        for group in evenly(&level, CHILDREN) {
            let mut page = Page::new(INDEX_INNER, 0);
            let Some((&(last, between), others)) = group.split_last() else { continue };
            for &(child, record) in others {
                page.push(&[&child.to_be_bytes()[..], &cell(record)].concat());
            }
            above.push((to.page(&page.bytes(Some(last)))?, between));
        }
        level = above;
    }
    Ok(level.first().map_or(0, |(page, _)| *page))
}

/// Returns a row in its stored form: the kinds of its values, then the values.
pub fn record(values: &[Value<'_>]) -> Vec<u8> {
    let (mut kinds, mut bodies) = (Vec::new(), Vec::new());
    for value in values {
        match value {
            Value::Null => kinds.push(0),
            Value::Integer(value) => {
                let (kind, length) = match value {
                    -0x80..=0x7f => (1, 1),
                    -0x8000..=0x7fff => (2, 2),
                    -0x8000_0000..=0x7fff_ffff => (4, 4),
                    _ => (6, 8),
                };
                varint(&mut kinds, kind);
                bodies.extend_from_slice(&value.to_be_bytes()[8 - length..]);
            }
            Value::Real(value) => {
                kinds.push(7);
                bodies.extend(value.to_be_bytes());
            }
            Value::Text(text) => {
                varint(&mut kinds, text.len() as u64 * 2 + 13);
                bodies.extend_from_slice(text.as_bytes());
            }
            Value::Blob(bytes) => {
                varint(&mut kinds, bytes.len() as u64 * 2 + 12);
                bodies.extend_from_slice(bytes);
            }
        }
    }
    let mut record = Vec::with_capacity(kinds.len() + bodies.len() + 2);
    // Its own length counts, of one byte for a few values.
    let length = (1..).find(|own| (kinds.len() + own) >> (7 * own) == 0).unwrap_or(1);
    varint(&mut record, (kinds.len() + length) as u64);
    record.extend(kinds);
    record.extend(bodies);
    record
}

/// Writes seven bits at a time, the highest first; the ninth byte has eight.
fn varint(out: &mut Vec<u8>, value: u64) {
    if value >> 56 != 0 {
        (1..9).for_each(|i| out.push((value >> (64 - 7 * i)) as u8 | 0x80));
        return out.push(value as u8);
    }
    let groups = (1..8).rev().find(|i| value >> (7 * i) != 0).unwrap_or(0);
    (1..=groups).rev().for_each(|i| out.push((value >> (7 * i)) as u8 | 0x80));
    out.push(value as u8 & 0x7f);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_their_highest_bits_first() {
        let bytes = |value| {
            let mut out = Vec::new();
            varint(&mut out, value);
            out
        };
        assert_eq!(bytes(0x7f), [0x7f]);
        assert_eq!(bytes(0x80), [0x81, 0]);
        assert_eq!(bytes(1 << 14), [0x81, 0x80, 0]);
        assert_eq!(bytes((1 << 56) - 1), [255, 255, 255, 255, 255, 255, 255, 127]);
        assert_eq!(bytes(u64::MAX), [255; 9]);
    }

    #[test]
    fn lists_are_divided_evenly() {
        for count in 0..500 {
            let list: Vec<usize> = (0..count).collect();
            let parts: Vec<&[usize]> = evenly(&list, 7).collect();
            assert_eq!(parts.concat(), list);
            assert!(parts.iter().all(|part| part.len() <= 7 && (count < 2 || part.len() > 1)));
        }
    }

    #[test]
    fn rows_and_entries_are_found_again() {
        for count in [0usize, 1, 73, 74, 75, 149, 3000] {
            let blob = |i: usize| vec![i as u8; i * 37 % 9001];
            let mut database = Database::new();
            let mut table = Table::new();
            let mut bytes = Vec::new();
            for i in 0..count {
                table
                    .add(&mut database, &[Value::Integer(i as i64), Value::Blob(&blob(i))])
                    .expect("room");
                bytes.extend(database.take());
            }
            let root = table.finish(&mut database).expect("room");
            let entries: Vec<Vec<u8>> =
                (0..count).map(|i| record(&[Value::Integer(i as i64 * 1000)])).collect();
            index(&mut database, &entries).expect("room");
            database.name("table", "t", "t", root, "CREATE TABLE t (a integer, b blob)");
            let (first, rest) = database.finish(7, 8).expect("room");
            bytes.extend(rest);
            bytes[..PAGE].copy_from_slice(&first);
            let database = super::super::Database::new(bytes).expect("a database");
            assert_eq!(database.application(), 7);
            let tables = database.tables().expect("tables");
            assert_eq!((tables.len(), tables[0].root), (1, root));
            let mut rows = database.rows(root);
            for i in 0..count {
                let row = rows.next(&database).expect("read").expect("size of a row in bytes");
                let expected = record(&[Value::Integer(i as i64), Value::Blob(&blob(i))]);
                assert_eq!((row.number, &row.record[..]), (i as i64 + 1, &expected[..]));
            }
            assert!(rows.next(&database).expect("read").is_none());
        }
    }

    #[test]
    fn records_of_many_values_have_a_longer_length() {
        for count in [126_usize, 127, 16_381, 16_382] {
            let bytes = record(&vec![Value::Null; count]);
            let length = count
                + if count < 127 {
                    1
                } else if count < 16_382 {
                    2
                } else {
                    3
                };
            let mut start = Vec::new();
            varint(&mut start, length as u64);
            assert!(bytes.starts_with(&start) && bytes.len() == length, "{count}");
        }
    }
}
