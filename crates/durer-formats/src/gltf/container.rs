//! The binary container: a header, a JSON chunk, a binary chunk (glTF 2.0, §4).

use crate::{Error, Place, Result, Warning};

/// The first bytes of a binary glTF file.
pub const MAGIC: &[u8; 4] = b"glTF";
/// Chunk type of the JSON, ASCII, little endian.
const JSON: u32 = 0x4E4F_534A;
/// Chunk type of the binary buffer.
const BIN: u32 = 0x004E_4942;
/// Size of the header and of a chunk's header, in bytes.
const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

/// The parts of a file.
#[derive(Debug, Clone, Copy)]
pub struct Container<'a> {
    /// The JSON text, without a byte order mark.
    pub json: &'a [u8],
    /// The binary chunk, if there is one.
    pub bin: Option<&'a [u8]>,
    /// Whether the file is binary.
    pub binary: bool,
}

/// Splits a file, text or binary, into its parts.
///
/// # Errors
/// A decode error at the byte where the container is broken.
pub fn split<'a>(bytes: &'a [u8], warnings: &mut Vec<Warning>) -> Result<Container<'a>> {
    let mut container = if bytes.starts_with(MAGIC) {
        split_binary(bytes, warnings)?
    } else {
        Container { json: bytes, bin: None, binary: false }
    };
    if let Some(rest) = container.json.strip_prefix(b"\xef\xbb\xbf") {
        container.json = rest;
        let message = "the JSON begins with a byte order mark; passed over".to_owned();
        warnings.push(Warning { place: Place::Whole, message });
    }
    Ok(container)
}

/// Little-endian 32-bit number at an offset.
fn u32_at(bytes: &[u8], at: usize) -> Result<u32> {
    let word = bytes.get(at..).and_then(|rest| rest.first_chunk::<4>());
    let message = || Error::byte(bytes.len() as u64, "the file ends in the middle of a header");
    word.map(|w| u32::from_le_bytes(*w)).ok_or_else(message)
}

fn split_binary<'a>(bytes: &'a [u8], warnings: &mut Vec<Warning>) -> Result<Container<'a>> {
    let version = u32_at(bytes, 4)?;
    if version != 2 {
        return Err(Error::Unsupported {
            place: Place::Byte(4),
            what: format!("version {version} of binary glTF"),
            hint: "only version 2 is read".to_owned(),
        });
    }
    let length = u32_at(bytes, 8)? as usize;
    if length > bytes.len() {
        let message = format!("the header says {length} bytes, the file has {}", bytes.len());
        return Err(Error::byte(8, message));
    }
    if length < HEADER + CHUNK_HEADER {
        return Err(Error::byte(8, format!("a length of {length} has no room for a chunk")));
    }
    let mut warn = |at: usize, message: String| {
        warnings.push(Warning { place: Place::Byte(at as u64), message });
    };
    if length < bytes.len() {
        warn(length, format!("{} bytes after the end are passed over", bytes.len() - length));
    }
    let file = &bytes[..length];
    let (json, end) = match chunk(file, HEADER)? {
        (JSON, data, end) => (data, end),
        (kind, ..) => {
            let message = format!("the first chunk must be JSON, this is of type 0x{kind:08x}");
            return Err(Error::byte(HEADER as u64, message));
        }
    };
    let (mut at, mut bin) = (end, None);
    while at < file.len() {
        let (kind, data, end) = chunk(file, at)?;
        match kind {
            BIN if bin.is_none() => bin = Some(data),
            BIN | JSON => {
                return Err(Error::byte(at as u64, "a second chunk of a type that may stand once"));
            }
            _ => warn(at, format!("a chunk of unknown type 0x{kind:08x} is passed over")),
        }
        at = end;
    }
    Ok(Container { json, bin, binary: true })
}

/// Type, bytes and end of the chunk at an offset.
fn chunk(file: &[u8], at: usize) -> Result<(u32, &[u8], usize)> {
    let length = u32_at(file, at)? as usize;
    let kind = u32_at(file, at + 4)?;
    let start = at + CHUNK_HEADER;
    let end = start.saturating_add(length);
    let data = file.get(start..end).ok_or_else(|| {
        let left = file.len() - start;
        Error::byte(at as u64, format!("a chunk of {length} bytes where {left} are left"))
    })?;
    Ok((kind, data, end))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A binary file of chunks, with a right header.
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
        // Every cut is noticed: in the header at the end, later by the length that the header tells.
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
