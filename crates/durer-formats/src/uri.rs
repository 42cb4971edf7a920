//! References to other files: data URIs, relative paths, and refused ones.

use crate::{Error, Found, Place, Resources, Result};

/// Returns the bytes behind a URI, at most `limit` of them.
///
/// # Errors
/// [`Error::Resource`] if the URI cannot be followed or read; [`Error::Decode`] for a broken data URI.
pub(crate) fn load(uri: &str, at: &str, resources: &dyn Resources, limit: u64) -> Result<Found> {
    if let Some(data) = strip_data_scheme(uri) {
        return decode_data(data, at).map(|bytes| Found { bytes, note: None });
    }
    let path = path(uri).map_err(|message| refused(uri, at, message))?;
    resources.find(&path, limit).map_err(|message| refused(uri, at, &message))
}

/// Returns the bytes in a data URI (RFC 2397): base64, or percent-encoded.
///
/// # Errors
/// [`Error::Decode`] if it is broken, or another URI.
///
/// ```
/// assert_eq!(durer_formats::data_uri("data:text/plain;base64,aGk=")?, b"hi");
/// assert!(durer_formats::data_uri("a.obj").is_err());
/// # Ok::<_, durer_formats::Error>(())
/// ```
pub fn data_uri(uri: &str) -> Result<Vec<u8>> {
    let at = "data URI";
    let data = strip_data_scheme(uri).ok_or_else(|| Error::path(at, "it begins with `data:`"))?;
    decode_data(data, at)
}

/// Checks a data URI without decoding it; others are for [`load`].
///
/// # Errors
/// As [`load`], where the URI is broken.
pub(crate) fn check(uri: &str, at: &str) -> Result<()> {
    strip_data_scheme(uri).map_or(Ok(()), |data| data_parts(data, at).map(|_| ()))
}

/// The longest piece of a URI that a message quotes, in characters.
const QUOTED: usize = 80;

fn refused(uri: &str, at: &str, message: &str) -> Error {
    let place = Place::Path(at.to_owned());
    Error::Resource { place, uri: uri.chars().take(QUOTED).collect(), message: message.to_owned() }
}

/// Returns whether the URI itself contains the data.
pub(crate) fn is_data(uri: &str) -> bool {
    strip_data_scheme(uri).is_some()
}

fn strip_data_scheme(uri: &str) -> Option<&str> {
    let (scheme, rest) = uri.split_at_checked(5)?;
    scheme.eq_ignore_ascii_case("data:").then_some(rest)
}

/// Returns a percent-decoded path with `/` as separator, as [`Resources::find`] takes it. A `%`
/// without two hexadecimal digits is taken literally, as programs that do not encode write it.
pub(crate) fn path(uri: &str) -> std::result::Result<String, &'static str> {
    let bytes = percent_decode(uri).unwrap_or_else(|| uri.as_bytes().to_vec());
    let path = String::from_utf8(bytes).map_err(|_| "it is not UTF-8 when percent-decoded")?;
    if path.contains('\0') {
        return Err("a zero byte has no place in a path");
    }
    // Windows programs write backslashes; no glTF file has one in a file's name.
    let path = path.replace('\\', "/");
    let absolute = if path.starts_with('/') { "/" } else { "" };
    let parts = steps(&path);
    match parts.as_slice() {
        [] => Err("it names no file"),
        // A network address keeps its two strokes.
        _ if path.contains("://") => Ok(path),
        _ => Ok(format!("{absolute}{}", parts.join("/"))),
    }
}

/// Returns the steps of a path with `/` as separator, without `.` and without folders that a `..` leaves
/// again (RFC 3986, §5.2.4): they need not exist. Remaining `..` are at the beginning.
pub(crate) fn steps(path: &str) -> Vec<&str> {
    let mut steps = Vec::new();
    for step in path.split('/').filter(|step| !matches!(*step, "" | ".")) {
        match steps.last() {
            Some(last) if step == ".." && *last != ".." => drop(steps.pop()),
            _ => steps.push(step),
        }
    }
    steps
}

pub(crate) fn percent_decode(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'%' => {
                let digit = |b: Option<u8>| (b? as char).to_digit(16);
                (digit(rest.next())? * 16 + digit(rest.next())?) as u8
            }
            byte => byte,
        });
    }
    Some(bytes)
}

/// Returns whether a data URI is base64, and its payload.
fn data_parts<'a>(data: &'a str, at: &str) -> Result<(bool, &'a str)> {
    let (media, payload) =
        data.split_once(',').ok_or_else(|| Error::path(at, "a data URI without a comma"))?;
    let base64 = media.rsplit(';').next().is_some_and(|last| last.eq_ignore_ascii_case("base64"));
    Ok((base64, payload))
}

fn decode_data(data: &str, at: &str) -> Result<Vec<u8>> {
    let (base64, payload) = data_parts(data, at)?;
    let bytes =
        percent_decode(payload).ok_or_else(|| Error::path(at, "a `%` without two digits"))?;
    if !base64 {
        return Ok(bytes);
    }
    decode_base64(&bytes).ok_or_else(|| Error::path(at, "the data URI is not valid base64"))
}

/// Decodes Base64 of RFC 4648, also with its URL alphabet; padding may be missing.
fn decode_base64(text: &[u8]) -> Option<Vec<u8>> {
    let end = text.iter().rposition(|&b| b != b'=').map_or(0, |last| last + 1);
    if text.len() - end > 2 || end % 4 == 1 {
        return None;
    }
    let mut bytes = Vec::with_capacity(end / 4 * 3 + 2);
    for group in text[..end].chunks(4) {
        let mut bits = 0u32;
        for &digit in group {
            bits = bits << 6 | base64_digit(digit)?;
        }
        bits <<= 6 * (4 - group.len());
        bytes.extend_from_slice(&bits.to_be_bytes()[1..group.len()]);
    }
    Some(bytes)
}

fn base64_digit(digit: u8) -> Option<u32> {
    Some(u32::from(match digit {
        b'A'..=b'Z' => digit - b'A',
        b'a'..=b'z' => digit - b'a' + 26,
        b'0'..=b'9' => digit - b'0' + 52,
        b'+' | b'-' => 62,
        b'/' | b'_' => 63,
        _ => return None,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_decoded_and_kept_inside() {
        for (uri, expected) in [
            ("a%20b/./c.png", "a b/c.png"),
            ("a..b/c%2e.png", "a..b/c..png"),
            ("a\\b%5Cc.png", "a/b/c.png"),
            ("100%.png", "100%.png"),
            ("a%zz%20.png", "a%zz%20.png"),
            ("//host//a", "/host/a"),
            ("..%2fa", "../a"),
            ("./tex/../a.png", "a.png"),
            ("a/b/../../../../c", "../../c"),
        ] {
            assert_eq!(path(uri).unwrap(), expected);
        }
        for bad in ["", ".", "//", "a%ff", "a%00b"] {
            assert!(path(bad).is_err(), "{bad}");
        }
        for outside in [
            "../a",
            "a/../../b",
            "../a/../b",
            "a/%2e%2E/%2e./b",
            "..%2fa",
            "..%5Ca",
            "a\\..\\..\\b",
            "/etc/passwd",
            "%2fetc",
            "//host/a",
            "\\\\host\\a",
            "http://host/a",
            "HTTPS://host/a",
            "file:///a",
            "c:/a",
            "c%3a/a",
            "a/b:c",
        ] {
            let error = load(outside, "here", &Everything, 100).unwrap_err();
            assert!(error.to_string().contains("here: cannot read"), "{outside}: {error}");
        }
        assert_eq!(load("a/b", "here", &Everything, 100).unwrap().bytes, b"a/b");
    }

    /// Resources that answer every request with its path.
    struct Everything;

    impl Resources for Everything {
        fn read(&self, path: &str, _: u64) -> std::result::Result<Vec<u8>, String> {
            Ok(path.as_bytes().to_vec())
        }
    }

    #[test]
    fn data_uris_are_decoded() {
        let load = |uri| load(uri, "here", &crate::NoResources, 100).map(|found| found.bytes);
        assert_eq!(load("data:application/octet-stream;base64,AQIDBA==").unwrap(), [1, 2, 3, 4]);
        assert_eq!(load("DATA:;base64,AQID").unwrap(), [1, 2, 3]);
        assert_eq!(load("data:;base64,AQIDBA").unwrap(), [1, 2, 3, 4]);
        assert_eq!(load("data:,a%00b").unwrap(), b"a\0b");
        for bad in ["data:", "data:;base64,A", "data:;base64,AQ=B", "data:;base64,A*==", "data:,%x"]
        {
            assert!(load(bad).unwrap_err().to_string().starts_with("here: "), "{bad}");
        }
    }

    #[test]
    fn every_length_of_base64_is_right() {
        let text = b"TWFueSBoYW5kcw";
        assert_eq!(decode_base64(&text[..4]).unwrap(), b"Man");
        assert_eq!(decode_base64(&text[..6]).unwrap(), b"Many");
        assert_eq!(decode_base64(&text[..7]).unwrap(), b"Many ");
        assert_eq!(decode_base64(text).unwrap(), b"Many hands");
    }
}
