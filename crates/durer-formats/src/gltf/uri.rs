//! References to other files: data URIs, relative paths, and what is refused.

use crate::{Error, Place, Resources, Result};

/// The bytes behind a URI, at most `limit` of them.
///
/// # Errors
/// [`Error::Resource`] where the URI leaves the model's folder, has a scheme, or cannot be read;
/// [`Error::Decode`] for a broken data URI.
pub fn load(uri: &str, at: &str, resources: &dyn Resources, limit: u64) -> Result<Vec<u8>> {
    if let Some(data) = strip_data_scheme(uri) {
        return decode_data(data, at);
    }
    let path = relative_path(uri).map_err(|message| refused(uri, at, message))?;
    resources.read(&path, limit).map_err(|message| refused(uri, at, &message))
}

/// Checks a URI without reading anything.
///
/// # Errors
/// As [`load`], where the URI itself is at fault.
pub fn check(uri: &str, at: &str) -> Result<()> {
    match strip_data_scheme(uri) {
        Some(data) => data_parts(data, at).map(|_| ()),
        None => relative_path(uri).map(|_| ()).map_err(|message| refused(uri, at, message)),
    }
}

/// The longest piece of a URI that a message quotes, in characters.
const QUOTED: usize = 80;

fn refused(uri: &str, at: &str, message: &str) -> Error {
    let place = Place::Path(at.to_owned());
    Error::Resource { place, uri: uri.chars().take(QUOTED).collect(), message: message.to_owned() }
}

/// Whether the data stand in the URI itself.
pub fn is_data(uri: &str) -> bool {
    strip_data_scheme(uri).is_some()
}

fn strip_data_scheme(uri: &str) -> Option<&str> {
    let (scheme, rest) = uri.split_at_checked(5)?;
    scheme.eq_ignore_ascii_case("data:").then_some(rest)
}

/// A percent-decoded path below the model's own folder, with `/` as separator.
pub(crate) fn relative_path(uri: &str) -> std::result::Result<String, &'static str> {
    if uri.is_empty() {
        return Err("it is empty");
    }
    // A scheme is letters, digits, +, - or . before a colon (RFC 3986); a colon in the first
    // segment of a relative path is not allowed, and on some systems it names a drive or a stream.
    let first = uri.split('/').next().unwrap_or_default();
    if first.contains(':') {
        return Err("only relative paths are followed, no schemes and no network addresses");
    }
    let bytes = percent_decode(uri).ok_or("a `%` must be followed by two hexadecimal digits")?;
    let path = String::from_utf8(bytes).map_err(|_| "it is not UTF-8 when percent-decoded")?;
    if path.contains(['\\', ':', '\0']) {
        return Err("a backslash, colon or zero byte has no place in a relative path");
    }
    if path.starts_with('/') {
        return Err("absolute paths are not followed");
    }
    if path.split('/').any(|part| part == "..") {
        return Err("paths out of the model's folder are not followed");
    }
    let parts: Vec<&str> = path.split('/').filter(|p| !p.is_empty() && *p != ".").collect();
    if parts.is_empty() { Err("it names no file") } else { Ok(parts.join("/")) }
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

/// Whether a data URI is base64, and its payload.
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

/// Base64 of RFC 4648, also its URL alphabet; padding may be missing.
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
        assert_eq!(relative_path("a%20b/./c.png").unwrap(), "a b/c.png");
        assert_eq!(relative_path("a..b/c%2e.png").unwrap(), "a..b/c..png");
        for bad in [
            "",
            ".",
            "../a",
            "a/../../b",
            "a/%2e%2E/b",
            "..%2fa",
            "..%5Ca",
            "a\\..\\b",
            "/etc/passwd",
            "%2fetc",
            "//host/a",
            "http://host/a",
            "HTTPS://host/a",
            "file:///a",
            "c:/a",
            "c%3a/a",
            "a%0",
            "a%zz",
            "a%ff",
            "a%00b",
        ] {
            assert!(relative_path(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn data_uris_are_decoded() {
        let load = |uri| load(uri, "here", &crate::NoResources, 100);
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
