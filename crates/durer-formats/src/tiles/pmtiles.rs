//! PMTiles, version 3: <https://github.com/protomaps/PMTiles/blob/main/spec/v3/spec.md>.
//!
//! Tiles are written as they come, behind room for the header and the root directory; metadata and the other
//! directories come at the end.

use super::archive::Metadata;
use super::gzip::gzip;
use super::protobuf::varint;
use crate::{Error, Place, Result};
use std::collections::BTreeMap;
use std::io::{Seek, SeekFrom, Write};

/// Header and root directory have to be in the first this many bytes.
const HEAD: u64 = 16_384;

const HEADER: u64 = 127;

/// Largest size in bytes of tiles that are compared with earlier ones: the sea, the inside of areas.
const SMALL: usize = 1024;

/// Number of tiles to remember.
const REMEMBERED: usize = 1 << 15;

/// Entries of a directory that the root refers to; more where the root would not fit.
const LEAF: usize = 4096;

/// Writer of tiles to a PMTiles file.
pub struct PmTiles<W> {
    out: W,
    /// Offset of the tiles in the target.
    start: u64,
    entries: Vec<Entry>,
    /// Bytes of tiles.
    length: u64,
    addressed: u64,
    contents: u64,
    small: BTreeMap<Vec<u8>, (u64, u32)>,
}

/// Tiles that follow each other and are alike, or (where `run` is 0) a directory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Entry {
    id: u64,
    offset: u64,
    length: u32,
    run: u32,
}

impl<W: Write + Seek> PmTiles<W> {
    /// Creates a file without a tile.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn new(mut out: W) -> Result<Self> {
        let start = out.stream_position()? + HEAD;
        out.write_all(&[0; HEAD as usize])?;
        let (entries, small) = Default::default();
        Ok(Self { out, start, entries, length: 0, addressed: 0, contents: 0, small })
    }

    /// Adds a tile, compressed by [`gzip`], by its [number](durer::clip::tiles::Tile::id); numbers ascend.
    ///
    /// # Errors
    /// [`Error::Io`]; [`Error::Limit`] for tiles of 4 GiB.
    pub fn add(&mut self, id: u64, tile: &[u8]) -> Result<()> {
        let length = u32::try_from(tile.len()).map_err(|_| {
            let (value, limit) = (tile.len() as u64, u32::MAX.into());
            Error::Limit { place: Place::Whole, what: "size of a tile in bytes", value, limit }
        })?;
        self.addressed += 1;
        let known = self.small.get(tile).copied();
        if let (Some((offset, _)), Some(last)) = (known, self.entries.last_mut())
            && last.offset == offset
            && last.id + u64::from(last.run) == id
        {
            last.run += 1;
            return Ok(());
        }
        let offset = match known {
            Some((offset, _)) => offset,
            None => {
                let offset = self.length;
                self.out.write_all(tile)?;
                self.length += tile.len() as u64;
                self.contents += 1;
                if tile.len() <= SMALL && self.small.len() < REMEMBERED {
                    self.small.insert(tile.to_vec(), (offset, length));
                }
                offset
            }
        };
        self.entries.push(Entry { id, offset, length, run: 1 });
        Ok(())
    }

    /// Writes the directories of the tiles, and returns the target.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn finish(mut self, metadata: &Metadata) -> Result<W> {
        let (root, leaves) = directories(&self.entries);
        let json = gzip(metadata.to_json().to_string().as_bytes());
        self.out.write_all(&json)?;
        self.out.write_all(&leaves)?;
        let header =
            self.header(metadata, [root.len(), json.len(), leaves.len()].map(|n| n as u64));
        let begin = self.start - HEAD;
        self.out.seek(SeekFrom::Start(begin))?;
        self.out.write_all(&header)?;
        self.out.write_all(&root)?;
        self.out.seek(SeekFrom::End(0))?;
        self.out.flush()?;
        Ok(self.out)
    }

    fn header(&self, metadata: &Metadata, [root, json, leaves]: [u64; 3]) -> Vec<u8> {
        let mut header = b"PMTiles\x03".to_vec();
        let after = HEAD + self.length;
        let places = [HEADER, root, after, json, after + json, leaves, HEAD, self.length];
        let counts = [self.addressed, self.entries.len() as u64, self.contents];
        places.into_iter().chain(counts).for_each(|n| header.extend(n.to_le_bytes()));
        let (first, last) = metadata.zooms;
        /// In Hilbert's order; directories and tiles by gzip; vector tiles.
        const KIND: [u8; 4] = [1, 2, 2, 1];
        header.extend(KIND.into_iter().chain([first, last]));
        metadata.bounds.iter().for_each(|&degrees| header.extend(e7(degrees)));
        header.push(first);
        metadata.center().iter().for_each(|&degrees| header.extend(e7(degrees)));
        header
    }
}

/// Encodes degrees in units of 10^-7.
fn e7(degrees: f64) -> [u8; 4] {
    ((degrees * 1e7).round() as i32).to_le_bytes()
}

/// Returns the root directory and the leaf directories, compressed.
fn directories(entries: &[Entry]) -> (Vec<u8>, Vec<u8>) {
    let fits = |directory: &[u8]| directory.len() as u64 <= HEAD - HEADER;
    let root = directory(entries);
    if fits(&root) {
        return (root, Vec::new());
    }
    let mut size = LEAF;
    loop {
        let (mut root, mut leaves) = (Vec::new(), Vec::new());
        for chunk in entries.chunks(size) {
            let leaf = directory(chunk);
            let (offset, length) = (leaves.len() as u64, leaf.len() as u32);
            root.push(Entry { id: chunk[0].id, offset, length, run: 0 });
            leaves.extend(leaf);
        }
        let root = directory(&root);
        if fits(&root) {
            return (root, leaves);
        }
        size *= 2;
    }
}

/// Returns a directory, column by column.
fn directory(entries: &[Entry]) -> Vec<u8> {
    let mut bytes = Vec::new();
    varint(&mut bytes, entries.len() as u64);
    let mut last = 0;
    for entry in entries {
        varint(&mut bytes, entry.id - last);
        last = entry.id;
    }
    entries.iter().for_each(|entry| varint(&mut bytes, entry.run.into()));
    entries.iter().for_each(|entry| varint(&mut bytes, entry.length.into()));
    // 0 where it follows the one before.
    let mut next = None;
    for entry in entries {
        let follows = next == Some(entry.offset);
        varint(&mut bytes, if follows { 0 } else { entry.offset + 1 });
        next = Some(entry.offset + u64::from(entry.length));
    }
    gzip(&bytes)
}
