//! The code that readers of XML share: encodings, attributes, and the place of errors.

use crate::{Error, Place, Result, number, text};
use quick_xml::events::BytesStart;
use std::borrow::Cow;

/// Characters of Windows-1252 from 0x80 to 0x9f; elsewhere it is Latin-1.
const WINDOWS: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}',
    '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
];

/// Returns an XML text as UTF-8: from UTF-8 and UTF-16 with or without a mark, else from
/// Windows-1252, which includes Latin-1.
pub(crate) fn utf8(bytes: &[u8]) -> Cow<'_, [u8]> {
    match bytes {
        [b'<', 0, ..] => Cow::Owned(text::utf16_le(bytes)),
        [0, b'<', ..] => Cow::Owned(text::utf16_be(bytes)),
        _ => match text::utf8(bytes) {
            Cow::Borrowed(rest) if std::str::from_utf8(rest).is_err() => {
                Cow::Owned(rest.iter().map(|&b| windows(b)).collect::<String>().into_bytes())
            }
            text => text,
        },
    }
}

fn windows(byte: u8) -> char {
    let special = byte.checked_sub(0x80).and_then(|i| WINDOWS.get(usize::from(i)));
    special.copied().unwrap_or(char::from(byte))
}

/// Returns an attribute of an element by its local name, raw.
pub(crate) fn raw<'e>(e: &'e BytesStart<'_>, key: &str) -> Option<Cow<'e, str>> {
    let mut attributes = e.attributes();
    attributes.with_checks(false);
    attributes.flatten().find(|a| a.key.local_name().as_ref() == key).map(|a| a.value)
}

/// Returns an attribute of an element by its local name, with its entities resolved.
pub(crate) fn attribute(e: &BytesStart<'_>, key: &str) -> Option<String> {
    let value = raw(e, key)?;
    Some(quick_xml::escape::unescape(&value).map_or(value.to_string(), |t| t.into_owned()))
}

/// Position of a reader and its file, for messages.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Here<'a> {
    pub file: &'a str,
    pub byte: u64,
}

impl Here<'_> {
    /// Returns the place, for a warning.
    pub fn place(&self) -> Place {
        Place::Path(format!("{}, byte {}", self.file, self.byte))
    }

    /// Returns an error at this place.
    pub fn wrong(&self, message: impl Into<String>) -> Error {
        Error::Decode { place: self.place(), message: message.into() }
    }

    /// Reads an attribute that is a whole number from 0 on.
    ///
    /// # Errors
    /// If it is present, but something else.
    pub fn index(&self, e: &BytesStart<'_>, key: &str) -> Result<Option<u64>> {
        raw(e, key).map(|value| self.whole(key, value.trim_ascii())).transpose()
    }

    /// Reads the value of the attribute `key` as a whole number from 0 on.
    ///
    /// # Errors
    /// If it is something else.
    pub fn whole(&self, key: &str, value: &str) -> Result<u64> {
        match number::integer(value.as_bytes()) {
            Some((n, length)) if length == value.len() && n >= 0 => Ok(n as u64),
            _ => {
                Err(self.wrong(format!("`{key}` is `{value}`; a whole number from 0 on is needed")))
            }
        }
    }

    /// Reads an attribute that is a whole number and must be there.
    ///
    /// # Errors
    /// If it is missing, or something else.
    pub fn needed(&self, e: &BytesStart<'_>, key: &str) -> Result<u64> {
        self.index(e, key)?.ok_or_else(|| self.wrong(format!("the attribute `{key}` is missing")))
    }

    /// Reads an attribute that is a number.
    ///
    /// # Errors
    /// If it is present, but something else.
    pub fn float(&self, e: &BytesStart<'_>, key: &str) -> Result<Option<f64>> {
        let Some(value) = raw(e, key) else { return Ok(None) };
        let value = value.trim_ascii();
        match number::float(value.as_bytes()) {
            Some((n, length)) if length == value.len() => Ok(Some(n)),
            _ => Err(self.wrong(format!("`{key}` is `{value}`; a number is needed"))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encodings_become_utf8() {
        let text = "<a b=\"ä€\"/>";
        let le: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let be: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        for bytes in
            [&le, &be, &[&b"\xff\xfe"[..], &le].concat(), &[&b"\xfe\xff"[..], &be].concat()]
        {
            assert_eq!(utf8(bytes).as_ref(), text.as_bytes());
        }
        assert_eq!(utf8(text.as_bytes()).as_ref(), text.as_bytes());
        assert_eq!(utf8(b"<a b=\"\xe4\x80\"/>").as_ref(), text.as_bytes());
    }
}
