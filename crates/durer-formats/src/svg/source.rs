//! The text of a drawing from its bytes, which may be compressed and in any encoding.

use crate::{Error, Limits, Result, gzip};
use encoding_rs::{Encoding, UTF_16BE, UTF_16LE};
use std::borrow::Cow;

/// Number of bytes at the start that are searched for the name of the encoding.
const DECLARATION: usize = 256;

/// Returns the text of a drawing: decompressed if it is gzip, then decoded by its mark or its XML declaration.
///
/// # Errors
/// [`Error::Decode`] for broken gzip, and for bytes that are not in the encoding that is said or an encoding that is
/// not known; [`Error::Limit`] if it is larger than `limits.decoded_bytes`.
pub(super) fn text<'a>(bytes: &'a [u8], limits: &Limits) -> Result<Cow<'a, str>> {
    match gzip::unpacked(bytes, limits)? {
        Cow::Borrowed(bytes) => decoded(bytes),
        Cow::Owned(bytes) => decoded(&bytes).map(|text| Cow::Owned(text.into_owned())),
    }
}

fn decoded(bytes: &[u8]) -> Result<Cow<'_, str>> {
    if let Some((encoding, mark)) = Encoding::for_bom(bytes) {
        let rest = bytes.get(mark..).unwrap_or_default();
        return in_encoding(rest, encoding, encoding.name());
    }
    // Without a mark: the first two characters are `<?` or `<s`.
    match bytes {
        [b'<', 0, second, 0, ..] if *second != 0 => {
            return in_encoding(bytes, UTF_16LE, "UTF-16LE");
        }
        [0, b'<', 0, second, ..] if *second != 0 => {
            return in_encoding(bytes, UTF_16BE, "UTF-16BE");
        }
        _ => {}
    }
    let Some(label) = label(bytes) else { return utf8(bytes) };
    let encoding = Encoding::for_label(&label).ok_or_else(|| {
        let label = crate::text::quote(&label);
        Error::line(1, 1, format!("the encoding `{label}` is not known; save the drawing in UTF-8"))
    })?;
    // Who says UTF-16 within a text of single bytes is wrong.
    if encoding == UTF_16LE || encoding == UTF_16BE {
        return utf8(bytes);
    }
    in_encoding(bytes, encoding, encoding.name())
}

fn utf8(bytes: &[u8]) -> Result<Cow<'_, str>> {
    std::str::from_utf8(bytes).map(Cow::Borrowed).map_err(|e| {
        let message =
            "an SVG must be text in UTF-8 or UTF-16, or in the encoding that its first line names";
        Error::byte(e.valid_up_to() as u64, message)
    })
}

fn in_encoding<'a>(
    bytes: &'a [u8],
    encoding: &'static Encoding,
    name: &str,
) -> Result<Cow<'a, str>> {
    if encoding == encoding_rs::UTF_8 {
        return utf8(bytes);
    }
    let (text, is_broken) = encoding.decode_without_bom_handling(bytes);
    match is_broken {
        true => Err(Error::whole(format!(
            "it declares the encoding {name}, but has bytes that are invalid in it"
        ))),
        false => Ok(text),
    }
}

/// Returns the encoding that an XML declaration names.
fn label(bytes: &[u8]) -> Option<Vec<u8>> {
    let start = bytes.get(..bytes.len().min(DECLARATION))?;
    let start = start.strip_prefix(b"<?xml")?;
    let end = start.windows(2).position(|pair| pair == b"?>").unwrap_or(start.len());
    let declaration = start.get(..end)?;
    let at = declaration.windows(8).position(|word| word == b"encoding")?;
    let rest = declaration.get(at + 8..)?.trim_ascii_start().strip_prefix(b"=")?.trim_ascii_start();
    let quote = *rest.first().filter(|c| **c == b'"' || **c == b'\'')?;
    let rest = rest.get(1..)?;
    rest.get(..rest.iter().position(|c| *c == quote)?).map(<[u8]>::to_vec)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn of(bytes: &[u8]) -> std::result::Result<String, String> {
        text(bytes, &Limits::default()).map(Cow::into_owned).map_err(|e| e.to_string())
    }

    fn declared(label: &str, content: &[u8]) -> Vec<u8> {
        [format!("<?xml version='1.0' encoding=\"{label}\"?>").as_bytes(), content].concat()
    }

    #[test]
    fn encodings_are_those_that_are_said() {
        for (label, content) in [
            ("ISO-8859-1", &b"Gr\xfc\xdfe \xd7"[..]),
            ("windows-1252", b"Gr\xfc\xdfe \xd7"),
            ("latin1", b"Gr\xfc\xdfe \xd7"),
            ("utf-8", "Grüße ×".as_bytes()),
            ("UTF-16", "Grüße ×".as_bytes()),
        ] {
            let text = of(&declared(label, content)).unwrap();
            assert!(text.ends_with("?>Grüße ×"), "{label}: {text}");
        }
        assert!(of(&declared("Shift_JIS", b"\x93\xfa\x96{")).unwrap().ends_with("日本"));
        assert!(of(&declared("windows-1251", b"\xcc\xe8\xf0")).unwrap().ends_with("Мир"));
        let utf16 = |to: fn(u16) -> [u8; 2], mark: &str| -> Vec<u8> {
            format!("{mark}<?xml?>ä").encode_utf16().flat_map(to).collect()
        };
        for mark in ["\u{feff}", ""] {
            assert_eq!(of(&utf16(u16::to_le_bytes, mark)).unwrap(), "<?xml?>ä");
            assert_eq!(of(&utf16(u16::to_be_bytes, mark)).unwrap(), "<?xml?>ä");
        }
        assert_eq!(of("\u{feff}<ä".as_bytes()).unwrap(), "<ä");
    }

    #[test]
    fn wrong_encodings_are_reported() {
        assert!(of(&declared("klingon", b"")).unwrap_err().contains("`klingon` is not known"));
        assert!(of(&declared("Shift_JIS", b"\xff")).unwrap_err().contains("Shift_JIS"));
        assert!(of(b"<svg>\xe4").unwrap_err().contains("UTF-8"));
    }

    #[test]
    fn gzip_is_unpacked_within_the_limit() {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(&declared("latin1", b"\xe4")).unwrap();
        let packed = encoder.finish().unwrap();
        assert!(of(&packed).unwrap().ends_with('ä'));
        assert!(of(&packed[..packed.len() - 9]).unwrap_err().contains("gzip"));
        let limits = Limits { decoded_bytes: 10, ..Limits::default() };
        assert!(matches!(text(&packed, &limits), Err(Error::Limit { .. })));
    }
}
