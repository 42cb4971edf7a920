//! Points of LAZ, decompressed by the crate `laz`.
//!
//! Source: M. Isenburg, *LASzip: lossless compression of LiDAR data*, Photogrammetric Engineering and
//! Remote Sensing 79 (2), 2013.

mod pointwise;
mod times;

use super::{Header, take};
use crate::foreign;
use crate::{Error, Place, Result};
use laz::{DecompressionSelection, LasZipDecompressor, LazItemType, LazVlr};
use pointwise::Pointwise;
use std::io::{self, Read, Seek, SeekFrom};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Bytes behind the fields of a format that points may have: each takes models of some 10 KB.
const EXTRA_BYTES: usize = 1024;
/// Bytes that a chunk of points takes at least.
const CHUNK: usize = 8;
/// Bytes of a variable length record before its data.
pub(super) const RECORD_HEADER: usize = 54;

/// Passes all points to `each`; returns how many could be decompressed.
///
/// # Errors
/// A description of the compression that is missing or broken.
pub(super) fn points(bytes: &[u8], header: &Header, mut each: impl FnMut(&[u8])) -> Result<u64> {
    let Some(record) = record(bytes, LazVlr::USER_ID, LazVlr::RECORD_ID) else {
        return Err(Error::whole("is compressed, but has no record `laszip encoded`"));
    };
    let mut read = 0;
    // On broken data the crate may panic.
    let all = catch_unwind(AssertUnwindSafe(|| {
        let vlr = LazVlr::from_buffer(record).map_err(|e| broken(foreign::laz(&e)))?;
        check(bytes, header, &vlr)?;
        let source = Guard::new(bytes, header.data, &vlr);
        let compressor = take(record, 0).map(u16::from_le_bytes).unwrap_or_default();
        let mut points =
            Points::new(source, vlr, compressor).map_err(|e| broken(foreign::laz(&e)))?;
        points.source().begin();
        let mut point = vec![0; header.length];
        while read < header.count && points.next(&mut point).is_ok() {
            each(&point);
            read += 1;
        }
        Ok(())
    }));
    match all {
        Ok(Err(why)) => Err(why),
        _ => Ok(read),
    }
}

/// A decompressor: points one by one, or in layers.
enum Points<'a> {
    Pointwise(Pointwise<'a, Guard<'a>>),
    Layered(LasZipDecompressor<'a, Guard<'a>>),
}

impl<'a> Points<'a> {
    fn new(source: Guard<'a>, vlr: LazVlr, compressor: u16) -> laz::Result<Self> {
        if source.layout.is_some() {
            LasZipDecompressor::selective(source, vlr, selection()).map(Self::Layered)
        } else {
            Pointwise::new(source, vlr, compressor).map(Self::Pointwise)
        }
    }

    fn source(&mut self) -> &mut Guard<'a> {
        match self {
            Self::Pointwise(points) => points.source(),
            Self::Layered(points) => points.get_mut(),
        }
    }

    fn next(&mut self, point: &mut [u8]) -> io::Result<()> {
        match self {
            Self::Pointwise(points) => points.next(point),
            Self::Layered(points) => points.decompress_one(point),
        }
    }
}

/// Returns the layers of points to decompress, without GPS times, whose decompression recurses as deep as a file says.
fn selection() -> DecompressionSelection {
    DecompressionSelection::xy_returns_channel()
        .decompress_z()
        .decompress_intensity()
        .decompress_rgb()
}

/// Returns the data of the variable length record that a program marked so.
fn record<'a>(bytes: &'a [u8], user: &str, number: u16) -> Option<&'a [u8]> {
    let mut at = usize::from(u16::from_le_bytes(take(bytes, 94)?));
    for _ in 0..u32::from_le_bytes(take(bytes, 100)?) {
        let head = bytes.get(at..at.checked_add(RECORD_HEADER)?)?;
        let length = usize::from(u16::from_le_bytes(take(head, 20)?));
        at += RECORD_HEADER;
        let name = head.get(2..18)?;
        if name.starts_with(user.as_bytes()) && take(head, 18) == Some(number.to_le_bytes()) {
            return bytes.get(at..at + length);
        }
        at += length;
    }
    None
}

fn broken(why: &str) -> Error {
    Error::whole(format!("broken LAZ data: {why}"))
}

/// Checks the sizes for which the crate would allocate memory.
fn check(bytes: &[u8], header: &Header, vlr: &LazVlr) -> Result<()> {
    let items = vlr.items();
    let size: usize = items.iter().map(|item| usize::from(item.size())).sum();
    if size != header.length || items.is_empty() {
        let length = header.length;
        return Err(broken(&format!("points have {length} bytes, compressed ones {size}")));
    }
    let extra = items.iter().filter_map(|item| match item.item_type() {
        LazItemType::Byte(size) | LazItemType::Byte14(size) => Some(usize::from(size)),
        _ => None,
    });
    if extra.sum::<usize>() > EXTRA_BYTES || items.len() > 8 {
        let what = format!("LAZ with more than {EXTRA_BYTES} extra bytes per point");
        return Err(Error::Unsupported { place: Place::Whole, what, hint: String::new() });
    }
    if chunks(bytes, header.data).is_some_and(|count| count > bytes.len() / CHUNK) {
        return Err(broken("the table of chunks is longer than the file"));
    }
    Ok(())
}

/// Returns the number of chunks in the table of chunks.
fn chunks(bytes: &[u8], data: usize) -> Option<usize> {
    let offset = |at| take(bytes, at).map(i64::from_le_bytes);
    let mut at = offset(data)?;
    if at <= data as i64 {
        // Files written in one pass have the offset at the end.
        at = offset(bytes.len().checked_sub(8)?)?;
    }
    let count = take(bytes, usize::try_from(at).ok()?.checked_add(4)?)?;
    Some(u32::from_le_bytes(count) as usize)
}

/// Next item to read of a chunk in layers.
#[derive(Debug, Clone, Copy)]
enum Next {
    /// Number of bytes of the first point.
    Point(usize),
    /// The number of points.
    Count,
    /// Sizes of this many layers, and bytes of the layers before them.
    Sizes(usize, usize),
    /// Number of bytes of layers.
    Layers(usize),
}

/// The bytes of the file, watched: a layer that is longer than the rest is refused before there is
/// memory for it.
struct Guard<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Offset of the data while the table of chunks is read: if there is no table, the crate continues there, so the
    /// reader must be at that place.
    start: Option<usize>,
    /// Bytes of a point and number of layers, where points are compressed in layers.
    layout: Option<(usize, usize)>,
    /// Next item, once points are read.
    next: Option<Next>,
}

impl<'a> Guard<'a> {
    fn new(bytes: &'a [u8], data: usize, vlr: &LazVlr) -> Self {
        let layered = vlr.items().first().is_some_and(|item| item.version() > 2);
        let layers = vlr.items().iter().map(|item| match item.item_type() {
            LazItemType::Point14 => 9,
            LazItemType::RGBNIR14 => 2,
            LazItemType::Byte14(count) => usize::from(count),
            _ => 1,
        });
        let layout = layered.then(|| (vlr.items_size() as usize, layers.sum()));
        Self { bytes, at: data, start: Some(data), layout, next: None }
    }

    /// Begins the first chunk here.
    fn begin(&mut self) {
        self.start = None;
        self.next = self.layout.map(|(point, _)| Next::Point(point));
    }

    /// Returns the item after these bytes; `None` if layers are longer than the file.
    fn after(&self, next: Next, read: &[u8]) -> Option<Next> {
        let (_, layers) = self.layout?;
        let left = self.bytes.len() - self.at;
        let next = match next {
            Next::Point(more) => Next::Point(more.checked_sub(read.len())?),
            Next::Count => Next::Sizes(layers, 0),
            Next::Sizes(more, sum) => {
                let size = u32::from_le_bytes(read.try_into().ok()?) as usize;
                Next::Sizes(more - 1, sum.checked_add(size).filter(|&sum| sum <= left)?)
            }
            Next::Layers(more) => Next::Layers(more.checked_sub(read.len())?),
        };
        match next {
            Next::Point(0) => Some(Next::Count),
            Next::Sizes(0, sum) | Next::Layers(sum) => self.after_layers(sum),
            other => Some(other),
        }
    }

    /// Returns the item that follows if this many bytes of layers are left.
    fn after_layers(&self, left: usize) -> Option<Next> {
        let (point, _) = self.layout?;
        Some(if left == 0 { Next::Point(point) } else { Next::Layers(left) })
    }
}

impl Read for Guard<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        if let Some(start) = self.start
            && rest.len() < buffer.len()
        {
            self.at = start;
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let read = rest.get(..buffer.len()).unwrap_or(rest);
        buffer[..read.len()].copy_from_slice(read);
        self.at += read.len();
        if let Some(next) = self.next
            && !read.is_empty()
        {
            let after = self.after(next, read);
            self.next = Some(after.ok_or(io::ErrorKind::InvalidData)?);
        }
        Ok(read.len())
    }
}

impl Seek for Guard<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        if let Some(start) = self.start
            && chunks(self.bytes, start).is_none()
        {
            return Err(io::ErrorKind::NotSeekable.into());
        }
        // A layer that is not decompressed is stepped over.
        if let (Some(Next::Layers(more)), SeekFrom::Current(by)) = (self.next, to) {
            let left = usize::try_from(by).ok().and_then(|by| more.checked_sub(by));
            self.next = self.after_layers(left.ok_or(io::ErrorKind::InvalidData)?);
        }
        let at = match to {
            SeekFrom::Start(at) => i64::try_from(at).ok(),
            SeekFrom::Current(by) => (self.at as i64).checked_add(by),
            SeekFrom::End(by) => (self.bytes.len() as i64).checked_add(by),
        };
        let at = at.and_then(|at| usize::try_from(at).ok());
        // Nothing is read beyond the end; a place there need not be kept.
        self.at = at.ok_or(io::ErrorKind::InvalidInput)?.min(self.bytes.len());
        Ok(self.at as u64)
    }
}
