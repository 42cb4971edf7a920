//! Files that are compressed by gzip as a whole.

use crate::{Error, Limits, Place, Result, foreign};
use flate2::bufread::MultiGzDecoder;
use std::borrow::Cow;
use std::io::Read;

/// First bytes of a gzip stream.
pub const MAGIC: [u8; 2] = [0x1f, 0x8b];

/// Returns the bytes of a file, decompressed if it is gzip.
///
/// # Errors
/// [`Error::Decode`] for broken gzip; [`Error::Limit`] if it is larger than `limits.decoded_bytes`; the error of the
/// budget.
pub fn unpacked<'b>(bytes: &'b [u8], limits: &Limits) -> Result<Cow<'b, [u8]>> {
    if !bytes.starts_with(&MAGIC) {
        return Ok(Cow::Borrowed(bytes));
    }
    let limit = limits.decoded_bytes;
    let mut source = MultiGzDecoder::new(bytes).take(limits.memory().saturating_add(1));
    let mut unpacked = Vec::new();
    source
        .read_to_end(&mut unpacked)
        .map_err(|e| Error::whole(format!("broken gzip: {}", foreign::inflating(&e))))?;
    let value = unpacked.len() as u64;
    if value > limit {
        let what = "size without compression";
        return Err(Error::Limit { place: Place::Whole, what, value, limit });
    }
    limits.work.keep("bytes of the file without compression", value)?;
    Ok(Cow::Owned(unpacked))
}

/// Returns a file's name without the ending of gzip.
pub fn stem(name: &str) -> &str {
    match name.rsplit_once('.') {
        Some((stem, suffix)) if suffix.eq_ignore_ascii_case("gz") => stem,
        _ => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer::work::Work;
    use std::io::Write;

    fn packed(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(bytes).expect("memory");
        encoder.finish().expect("memory")
    }

    #[test]
    fn bytes_come_out_whole_or_not_at_all() {
        let read = |bytes: &[u8], limits: &Limits| {
            unpacked(bytes, limits).map(Cow::into_owned).map_err(|e| e.to_string())
        };
        let (bytes, default) = (packed(&[7; 1000]), Limits::default());
        assert_eq!(read(b"plain", &default), Ok(b"plain".to_vec()));
        assert_eq!(read(&bytes, &default), Ok(vec![7; 1000]));
        assert_eq!(read(&[&bytes[..], &bytes].concat(), &default), Ok(vec![7; 2000]));
        let broken = read(&bytes[..bytes.len() - 9], &default);
        assert!(broken.as_ref().is_err_and(|e| e.contains("broken gzip")), "{broken:?}");
        let limited = Limits { decoded_bytes: 999, ..Limits::default() };
        assert_eq!(
            read(&bytes, &limited),
            Err("the size without compression is 1000, above the limit of 999".to_owned())
        );
        let work = Work::with_budget(999, "max_memory");
        let refused = read(&bytes, &Limits { work, ..Limits::default() });
        assert!(refused.as_ref().is_err_and(|e| e.contains("memory")), "{refused:?}");
    }

    #[test]
    fn names_lose_the_ending_of_gzip_alone() {
        assert_eq!([stem("a.obj.GZ"), stem("a.obj"), stem("gz")], ["a.obj", "a.obj", "gz"]);
    }
}
