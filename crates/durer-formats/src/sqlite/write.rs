//! New databases of SQLite, written from the first page to the last: <https://www.sqlite.org/fileformat2.html>.
//!
//! Tables get their rows in the order of their numbers, and indices are built when all entries are there; nothing is
//! ever changed but the first page.

use crate::{Error, Place, Result};
use std::io::{Seek, SeekFrom, Write};

/// Bytes of a page.
const PAGE: usize = 4096;

/// The page with the byte 2^30 is never used: locks are there.
const LOCKED: u32 = (1 << 30) / PAGE as u32 + 1;

/// A page may have this number, and no higher one.
const MOST_PAGES: u32 = u32::MAX - 4;

/// Bytes of the file's header, on the first page.
const HEADER: usize = 100;

/// A record longer than this goes on on other pages …
const MOST: usize = PAGE - 35;

/// … so that at least this stays.
const LEAST: usize = (PAGE - 12) * 32 / 255 - 23;

const TABLE_INNER: u8 = 5;
const TABLE_LEAF: u8 = 13;
const INDEX_INNER: u8 = 2;
const INDEX_LEAF: u8 = 10;

/// A value of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cell<'a> {
    /// A whole number.
    Integer(i64),
    /// Text.
    Text(&'a str),
    /// Bytes.
    Blob(&'a [u8]),
}

/// The pages of a database that is being written.
pub struct Database<W> {
    out: W,
    /// The number of the last page written.
    pages: u32,
    schema: Vec<Vec<u8>>,
}

impl<W: Write + Seek> Database<W> {
    /// A database without a table.
    pub fn new(mut out: W) -> Result<Self> {
        // The first page is known when all others are.
        out.write_all(&[0; PAGE])?;
        Ok(Self { out, pages: 1, schema: Vec::new() })
    }

    /// Writes a page and gives its number.
    fn page(&mut self, bytes: &[u8]) -> Result<u32> {
        if self.pages >= MOST_PAGES {
            let (value, limit) = (u64::from(self.pages) + 1, MOST_PAGES.into());
            let (place, what) = (Place::Whole, "pages of a database");
            return Err(Error::Limit { place, what, value, limit });
        }
        if self.pages + 1 == LOCKED {
            self.out.write_all(&[0; PAGE])?;
        }
        self.pages = after(self.pages);
        self.out.write_all(bytes)?;
        self.out.write_all(&vec![0; PAGE.saturating_sub(bytes.len())])?;
        Ok(self.pages)
    }

    /// Takes note of a table or index whose first page is `root`.
    pub fn name(&mut self, kind: &str, name: &str, table: &str, root: u32, sql: &str) {
        let [kind, name, table, sql] = [kind, name, table, sql].map(Cell::Text);
        let row = record(&[kind, name, table, Cell::Integer(root.into()), sql]);
        self.schema.push(row);
    }

    /// Writes the first page; `application` tells what the file is for. Gives the target back.
    pub fn finish(mut self, application: u32) -> Result<W> {
        let mut first = Page::new(TABLE_LEAF, HEADER);
        let mut table = Vec::new();
        for (row, number) in std::mem::take(&mut self.schema).iter().zip(1..) {
            table.push(self.row(number, row)?);
        }
        table.iter().for_each(|cell| first.push(cell));
        let mut bytes = first.bytes(None);
        bytes[..HEADER].copy_from_slice(&header(self.pages, application));
        self.out.seek(SeekFrom::Start(0))?;
        self.out.write_all(&bytes)?;
        self.out.seek(SeekFrom::End(0))?;
        self.out.flush()?;
        Ok(self.out)
    }

    /// The cell of a row; what is too long goes to pages of its own.
    fn row(&mut self, number: i64, record: &[u8]) -> Result<Vec<u8>> {
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

/// The number of the page after one.
fn after(page: u32) -> u32 {
    if page + 1 == LOCKED { page + 2 } else { page + 1 }
}

/// The header of the file.
fn header(pages: u32, application: u32) -> [u8; HEADER] {
    /// Of the library whose format this is.
    const VERSION: u32 = 3_040_000;
    let mut header = [0; HEADER];
    let mut put = |at: usize, bytes: &[u8]| header[at..at + bytes.len()].copy_from_slice(bytes);
    put(0, b"SQLite format 3\0");
    put(16, &(PAGE as u16).to_be_bytes());
    // Versions, and shares of a page, that are always these.
    put(18, &[1, 1, 0, 64, 32, 32]);
    // How often it was changed, pages; schema: how often it was changed, its format; UTF-8.
    for (at, value) in
        [(24, 1), (28, pages), (40, 1), (44, 4), (56, 1), (68, application), (92, 1), (96, VERSION)]
    {
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

    fn push(&mut self, cell: &[u8]) {
        self.cells.extend_from_slice(cell);
        self.ends.push(self.cells.len());
    }

    /// The page, with a last child where it has children.
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

/// A table that gets one row after the other.
pub struct Table {
    leaf: Page,
    rows: i64,
    /// Pages and the number of the last row of each.
    leaves: Vec<(u32, i64)>,
}

impl Table {
    /// A table without a row.
    pub fn new() -> Self {
        Self { leaf: Page::new(TABLE_LEAF, 0), rows: 0, leaves: Vec::new() }
    }

    /// Adds a row and gives its number.
    pub fn add<W: Write + Seek>(
        &mut self,
        to: &mut Database<W>,
        values: &[Cell<'_>],
    ) -> Result<i64> {
        let cell = to.row(self.rows + 1, &record(values))?;
        if !self.leaf.fits(&cell) {
            self.end_leaf(to)?;
        }
        self.leaf.push(&cell);
        self.rows += 1;
        Ok(self.rows)
    }

    fn end_leaf<W: Write + Seek>(&mut self, to: &mut Database<W>) -> Result<()> {
        let leaf = std::mem::replace(&mut self.leaf, Page::new(TABLE_LEAF, 0));
        self.leaves.push((to.page(&leaf.bytes(None))?, self.rows));
        Ok(())
    }

    /// Writes what is left, and the pages above; gives the number of the first page.
    pub fn finish<W: Write + Seek>(mut self, to: &mut Database<W>) -> Result<u32> {
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

/// So many children has a page: each takes 4 bytes, a number of 9, an offset of 2, and for indices
/// a record of at most …
const CHILDREN: usize = (PAGE - 12) / (15 + RECORD);

/// … so many bytes, its length included.
const RECORD: usize = 40;

/// Parts of a list, none with more than `most` items (2 at least), nor with much fewer than another.
fn evenly<T>(list: &[T], most: usize) -> impl Iterator<Item = &[T]> {
    let count = list.len().div_ceil(most);
    (0..count).map(move |i| &list[i * list.len() / count..(i + 1) * list.len() / count])
}

/// Writes an index: its records, each of at most 39 bytes, in their order. Gives the number of the first page.
pub fn index<W: Write + Seek>(to: &mut Database<W>, records: &[Vec<u8>]) -> Result<u32> {
    let cell = |record: &[u8]| {
        let mut cell = Vec::new();
        varint(&mut cell, record.len() as u64);
        cell.extend_from_slice(record);
        cell
    };
    // Between two leaves is one record; counted to each but the last leaf.
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

/// A row as it is stored: the kinds of its values, then the values.
pub fn record(values: &[Cell<'_>]) -> Vec<u8> {
    let (mut kinds, mut bodies) = (Vec::new(), Vec::new());
    for value in values {
        match *value {
            Cell::Integer(value) => {
                let (kind, length) = match value {
                    -0x80..=0x7f => (1, 1),
                    -0x8000..=0x7fff => (2, 2),
                    -0x8000_0000..=0x7fff_ffff => (4, 4),
                    _ => (6, 8),
                };
                varint(&mut kinds, kind);
                bodies.extend_from_slice(&value.to_be_bytes()[8 - length..]);
            }
            Cell::Text(text) => {
                varint(&mut kinds, text.len() as u64 * 2 + 13);
                bodies.extend_from_slice(text.as_bytes());
            }
            Cell::Blob(bytes) => {
                varint(&mut kinds, bytes.len() as u64 * 2 + 12);
                bodies.extend_from_slice(bytes);
            }
        }
    }
    // Its own length counts; of rows of a few values it is one byte.
    let mut record = Vec::with_capacity(kinds.len() + bodies.len() + 2);
    varint(&mut record, kinds.len() as u64 + 1);
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

    /// A reader as small as can be.
    struct Pages(Vec<u8>);

    impl Pages {
        fn page(&self, number: u32) -> &[u8] {
            &self.0[(number as usize - 1) * PAGE..number as usize * PAGE]
        }

        /// The cells of a page, and its last child.
        fn cells(&self, number: u32) -> (u8, Vec<&[u8]>, u32) {
            let (page, at) = (self.page(number), if number == 1 { HEADER } else { 0 });
            let word = |at: usize| usize::from(u16::from_be_bytes([page[at], page[at + 1]]));
            let kind = page[at];
            let inner = kind == TABLE_INNER || kind == INDEX_INNER;
            let head = at + if inner { 12 } else { 8 };
            let cells = (0..word(at + 3)).map(|i| &page[word(head + 2 * i)..]).collect();
            (kind, cells, if inner { long(&page[at + 8..]) } else { 0 })
        }

        /// All records of a table with their numbers, or of an index with zeros, in order.
        fn records(&self, root: u32, found: &mut Vec<(u64, Vec<u8>)>) {
            let (kind, cells, last) = self.cells(root);
            for cell in cells {
                match kind {
                    TABLE_INNER => self.records(long(cell), found),
                    TABLE_LEAF => {
                        let (length, cell) = number(cell);
                        let (row, cell) = number(cell);
                        found.push((row, self.record(length as usize, cell)));
                    }
                    _ => {
                        let cell = if kind == INDEX_INNER {
                            self.records(long(cell), found);
                            &cell[4..]
                        } else {
                            cell
                        };
                        let (length, cell) = number(cell);
                        found.push((0, cell[..length as usize].to_vec()));
                    }
                }
            }
            if last > 0 {
                self.records(last, found);
            }
        }

        fn record(&self, length: usize, cell: &[u8]) -> Vec<u8> {
            if length <= PAGE - 35 {
                return cell[..length].to_vec();
            }
            let least = (PAGE - 12) * 32 / 255 - 23;
            let part = least + (length - least) % (PAGE - 4);
            let here = if part <= PAGE - 35 { part } else { least };
            let (mut record, mut next) = (cell[..here].to_vec(), long(&cell[here..]));
            while next > 0 {
                assert_ne!(next, LOCKED);
                let page = self.page(next);
                let rest = (length - record.len()).min(PAGE - 4);
                record.extend(&page[4..4 + rest]);
                next = long(page);
            }
            record
        }
    }

    fn long(bytes: &[u8]) -> u32 {
        u32::from_be_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
    }

    fn number(bytes: &[u8]) -> (u64, &[u8]) {
        let (mut value, mut at) = (0, 0);
        loop {
            value = value << 7 | u64::from(bytes[at] & 0x7f);
            at += 1;
            if bytes[at - 1] < 0x80 {
                return (value, &bytes[at..]);
            }
        }
    }

    #[test]
    fn rows_and_entries_are_found_again() {
        for count in [0usize, 1, 73, 74, 75, 149, 3000] {
            let blob = |i: usize| vec![i as u8; i * 37 % 9001];
            let mut database = Database::new(std::io::Cursor::new(Vec::new())).unwrap();
            let mut table = Table::new();
            for i in 0..count {
                table.add(&mut database, &[Cell::Integer(i as i64), Cell::Blob(&blob(i))]).unwrap();
            }
            let root = table.finish(&mut database).unwrap();
            let entries: Vec<Vec<u8>> =
                (0..count).map(|i| record(&[Cell::Integer(i as i64 * 1000)])).collect();
            let index = index(&mut database, &entries).unwrap();
            database.name("table", "t", "t", root, "CREATE TABLE t (a integer, b blob)");
            let pages = Pages(database.finish(7).unwrap().into_inner());
            assert_eq!(pages.0.len() % PAGE, 0);
            assert_eq!(long(&pages.0[28..]) as usize * PAGE, pages.0.len());
            let (mut rows, mut found, mut schema) = (Vec::new(), Vec::new(), Vec::new());
            pages.records(root, &mut rows);
            pages.records(index, &mut found);
            pages.records(1, &mut schema);
            let expected =
                |i: usize| (i as u64 + 1, record(&[Cell::Integer(i as i64), Cell::Blob(&blob(i))]));
            assert_eq!(rows, (0..count).map(expected).collect::<Vec<_>>());
            assert_eq!(found.into_iter().map(|(_, entry)| entry).collect::<Vec<_>>(), entries);
            assert_eq!(schema.len(), 1);
        }
    }
}
