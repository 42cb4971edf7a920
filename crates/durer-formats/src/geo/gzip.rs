//! Files compressed by gzip, as they are read.

use crate::gzip::MAGIC;
use flate2::bufread::MultiGzDecoder;
use std::io::{self, BufRead, BufReader};

/// Returns a stream of a source's bytes, decompressed if it is gzip.
///
/// # Errors
/// If the source cannot be read.
pub fn unzipped<'a>(
    mut source: Box<dyn BufRead + 'a>,
    capacity: usize,
) -> io::Result<Box<dyn BufRead + 'a>> {
    if source.fill_buf()?.starts_with(&MAGIC) {
        return Ok(Box::new(BufReader::with_capacity(capacity, MultiGzDecoder::new(source))));
    }
    Ok(source)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Read, Write};

    #[test]
    fn compressed_and_plain_bytes_are_read_alike() {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(b"POINT (1 2)").expect("memory");
        let packed = encoder.finish().expect("memory");
        let twice = [&packed[..], &packed].concat();
        let read = |bytes: &[u8]| {
            let mut text = String::new();
            let source = unzipped(Box::new(bytes), 1 << 10).expect("memory");
            source.take(1 << 20).read_to_string(&mut text).map(|_| text)
        };
        assert_eq!(read(b"POINT (1 2)").expect("read"), "POINT (1 2)");
        assert_eq!(read(&packed).expect("read"), "POINT (1 2)");
        assert_eq!(read(&twice).expect("read"), "POINT (1 2)POINT (1 2)");
        assert!(read(&packed[..packed.len() - 9]).is_err());
    }
}
