//! The binary container: a header, a JSON chunk, a binary chunk (glTF 2.0, §4).

use super::bytes::Bytes;
use super::old;
use crate::wording::agreeing;
use crate::{Error, Place, Result, Warning};
use std::borrow::Cow;

/// The first bytes of a binary glTF file.
pub const MAGIC: &[u8; 4] = b"glTF";
/// Chunk type of the JSON, ASCII, little endian.
const JSON: u32 = 0x4E4F_534A;
/// Chunk type of the binary buffer.
const BIN: u32 = 0x004E_4942;
/// Size of the header and of a chunk's header, in bytes.
const HEADER: usize = 12;
const CHUNK_HEADER: u64 = 8;
/// Offset of the first chunk.
const FIRST: u64 = HEADER as u64;

/// Byte-order mark that some editors write before a text; JSON does not allow it.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The parts of a file.
#[derive(Debug)]
pub struct Container<'a> {
    json: Cow<'a, [u8]>,
    /// The binary chunk, if there is one.
    pub bin: Option<Bytes<'a>>,
    /// True if the file is binary.
    pub binary: bool,
}

impl Container<'_> {
    /// Returns the JSON text, without a byte order mark.
    pub fn json(&self) -> &[u8] {
        self.json.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&self.json)
    }
}

/// Splits a file, text or binary, into its parts.
///
/// # Errors
/// A decode error at the byte where the container is broken; [`Error::Io`].
pub fn split<'a>(file: &Bytes<'a>, warnings: &mut Vec<Warning>) -> Result<Container<'a>> {
    let magic = file.part(0..MAGIC.len() as u64).map(|m| m.whole()).transpose()?;
    let container = if magic.is_some_and(|m| *m == *MAGIC) {
        split_binary(file, warnings)?
    } else {
        Container { json: file.whole()?, bin: None, binary: false }
    };
    if container.json.starts_with(BYTE_ORDER_MARK) {
        let message = "the JSON begins with a byte order mark, which is ignored".to_owned();
        warnings.push(Warning { place: Place::Whole, message });
    }
    Ok(container)
}

/// Returns the little-endian 32-bit number at an offset in a file that ends at `end`.
fn u32_at(file: &Bytes<'_>, end: u64, at: u64) -> Result<u32> {
    let message = || Error::byte(end, "the file ends in the middle of a header");
    let word = file.part(at..at.saturating_add(4)).filter(|_| at.saturating_add(4) <= end);
    let word = word.ok_or_else(message)?.whole()?;
    word.first_chunk().map(|w| u32::from_le_bytes(*w)).ok_or_else(message)
}

fn split_binary<'a>(file: &Bytes<'a>, warnings: &mut Vec<Warning>) -> Result<Container<'a>> {
    let version = u32_at(file, file.len(), 4)?;
    if version != 2 {
        return Err(old::unsupported(Place::Byte(4), &format!("{version}.0 (binary)")));
    }
    let length = u64::from(u32_at(file, file.len(), 8)?);
    if length > file.len() {
        let message = format!("the header says {length} bytes, the file has {}", file.len());
        return Err(Error::byte(8, message));
    }
    if length < FIRST + CHUNK_HEADER {
        return Err(Error::byte(8, format!("a length of {length} has no room for a chunk")));
    }
    let mut warn = |at: u64, message: String| {
        warnings.push(Warning { place: Place::Byte(at), message });
    };
    if length < file.len() {
        let words = "{byte after the end is|bytes after the end are} ignored";
        warn(length, agreeing(file.len() - length, words));
    }
    let (json, end) = match chunk(file, length, FIRST)? {
        (JSON, data, end) => (data.whole()?, end),
        (kind, ..) => {
            let message = format!("the first chunk must be JSON, this is of type 0x{kind:08x}");
            return Err(Error::byte(FIRST, message));
        }
    };
    let (mut at, mut bin) = (end, None);
    while at < length {
        let (kind, data, end) = chunk(file, length, at)?;
        match kind {
            BIN if bin.is_none() => bin = Some(data),
            BIN | JSON => {
                return Err(Error::byte(at, "a second chunk of a type that may occur once"));
            }
            _ => warn(at, format!("a chunk of unknown type 0x{kind:08x} is ignored")),
        }
        at = end;
    }
    Ok(Container { json, bin, binary: true })
}

/// Returns type, bytes and end of the chunk at an offset in a file that ends at `end`.
fn chunk<'a>(file: &Bytes<'a>, end: u64, at: u64) -> Result<(u32, Bytes<'a>, u64)> {
    let length = u64::from(u32_at(file, end, at)?);
    let kind = u32_at(file, end, at + 4)?;
    let start = at + CHUNK_HEADER;
    let next = start + length;
    let data = file.part(start..next).filter(|_| next <= end).ok_or_else(|| {
        let left = end - start;
        Error::byte(at, format!("a chunk of {length} bytes where {left} are left"))
    })?;
    Ok((kind, data, next))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Serves the parts of a file in memory as slices of it.
    struct Slices<'a> {
        json: &'a [u8],
        bin: Option<&'a [u8]>,
    }

    fn split<'a>(bytes: &'a [u8], warnings: &mut Vec<Warning>) -> Result<Slices<'a>> {
        let Container { json, bin, .. } = super::split(&Bytes::Held(bytes), warnings)?;
        let slice = |part| match part {
            Cow::Borrowed(slice) => slice,
            Cow::Owned(_) => unreachable!("nothing is copied of what is at hand"),
        };
        let bin = bin.map(|bin| bin.whole().map(slice)).transpose()?;
        Ok(Slices { json: slice(json), bin })
    }

    /// Returns a binary file of chunks, with a valid header.
    fn file(chunks: &[(u32, &[u8])]) -> Vec<u8> {
        let mut body = Vec::new();
        for (kind, data) in chunks {
            body.extend((data.len() as u32).to_le_bytes());
            body.extend(kind.to_le_bytes());
            body.extend(*data);
        }
        let length = (body.len() + HEADER) as u32;
        [MAGIC.as_slice(), &2u32.to_le_bytes(), &length.to_le_bytes(), &body].concat()
    }

    #[test]
    fn chunks_are_found() {
        let bytes = file(&[(JSON, b"{}  "), (7, b"what"), (BIN, b"data")]);
        let mut warnings = Vec::new();
        let container = split(&bytes, &mut warnings).unwrap();
        assert_eq!((container.json, container.bin), (b"{}  ".as_slice(), Some(b"data".as_slice())));
        assert_eq!(warnings.len(), 1);
    }

    #[test]
    fn broken_containers_are_refused_at_a_byte() {
        let place = |bytes: &[u8]| match split(bytes, &mut Vec::new()) {
            Err(Error::Decode { place: Place::Byte(at), .. }) => Some(at),
            Ok(_) | Err(_) => None,
        };
        let good = file(&[(JSON, b"{}  "), (BIN, b"data")]);
        assert_eq!(place(&good), None);
        // Every truncation is detected: in the header at its end, later by the length in the header.
        for cut in 4..good.len() {
            assert_eq!(place(&good[..cut]), Some(if cut < 12 { cut as u64 } else { 8 }), "{cut}");
        }
        assert_eq!(place(&file(&[(BIN, b"data")])), Some(12));
        assert_eq!(place(&file(&[(JSON, b"{}  "), (BIN, b"data"), (BIN, b"")])), Some(36));
        let mut long = good.clone();
        long[12] = 200;
        assert_eq!(place(&long), Some(12));
    }
}
