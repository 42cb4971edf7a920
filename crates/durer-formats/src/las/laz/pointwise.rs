//! Chunks of points that are compressed one by one: versions 1 and 2 of LAZ.

use super::times::Times;
use laz::LazVlr;
use laz::laszip::{ChunkTable, LazItemType};
use laz::record::{RecordDecompressor, SequentialPointRecordDecompressor};
use std::io::{self, Read, Seek};

/// The compressor whose points are one chunk, as the record says it.
const ONE_CHUNK: u16 = 1;

/// A decompressor of points.
pub(super) struct Pointwise<'a, R: Read> {
    points: SequentialPointRecordDecompressor<'a, R>,
    vlr: LazVlr,
    one_chunk: bool,
    table: Option<ChunkTable>,
    /// Number of this chunk, its points so far, and all of them; 1 before the first is read.
    chunk: usize,
    read: u64,
    count: u64,
}

impl<R: Read + Seek> Pointwise<'_, R> {
    /// Reads the table of chunks; `compressor` is the number in the record.
    ///
    /// # Errors
    /// Those of the source, of chunks of unequal size without a table, and of items that are unknown.
    pub(super) fn new(mut source: R, vlr: LazVlr, compressor: u16) -> laz::Result<Self> {
        let one_chunk = compressor == ONE_CHUNK;
        let mut table = None;
        if !one_chunk {
            match ChunkTable::read_from(&mut source, &vlr) {
                Ok(chunks) => table = Some(chunks),
                Err(e) if vlr.uses_variable_size_chunks() => return Err(e),
                // The source is at the start of the data, where the offset of the table is.
                Err(_) => source.read_exact(&mut [0; ChunkTable::OFFSET_SIZE])?,
            }
        }
        let points = SequentialPointRecordDecompressor::new(source);
        let mut new = Self { points, vlr, one_chunk, table, chunk: 0, read: 0, count: 1 };
        new.set_fields()?;
        Ok(new)
    }

    fn set_fields(&mut self) -> laz::Result<()> {
        for item in self.vlr.items() {
            if item.version() == 2 && item.item_type() == LazItemType::GpsTime {
                self.points.add_field_decompressor(Times::default());
            } else {
                self.points.set_fields_from(&vec![*item])?;
            }
        }
        Ok(())
    }

    /// Returns the source.
    pub(super) fn source(&mut self) -> &mut R {
        self.points.get_mut()
    }

    /// Decompresses the next point.
    ///
    /// # Errors
    /// Those of the source, and of broken data.
    pub(super) fn next(&mut self, point: &mut [u8]) -> io::Result<()> {
        if self.read == self.count {
            self.points.reset();
            self.set_fields().map_err(|_| io::ErrorKind::InvalidData)?;
            self.read = 0;
            self.chunk += 1;
        }
        self.points.decompress_next(point)?;
        self.read += 1;
        if self.read == 1 {
            self.count = self.size_of_chunk().ok_or(io::ErrorKind::InvalidData)?;
        }
        Ok(())
    }

    /// Returns the number of points of this chunk; `None` if the table does not have it.
    fn size_of_chunk(&self) -> Option<u64> {
        if self.one_chunk {
            return Some(u64::MAX);
        }
        if !self.vlr.uses_variable_size_chunks() {
            return Some(self.vlr.chunk_size().into());
        }
        let chunks = self.table.as_ref()?.as_ref();
        chunks.get(self.chunk).map(|chunk| chunk.point_count)
    }
}
