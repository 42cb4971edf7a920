//! Text encodings of tables.

use crate::Place;
use crate::geo::Warnings;
use crate::text::name;
use std::borrow::Cow;

/// Encoding of texts.
#[derive(Debug, Clone, Copy)]
pub enum Encoding {
    /// One of the encodings known to browsers.
    Known(&'static encoding_rs::Encoding),
    /// A code page of MS-DOS: its characters from 0x80 on.
    Page(&'static str),
}

/// The upper half of the code page 437.
const CP437: &str = "ÇüéâäàåçêëèïîìÄÅÉæÆôöòûùÿÖÜ¢£¥₧ƒáíóúñÑªº¿⌐¬½¼¡«»░▒▓│┤╡╢╖╕╣║╗╝╜╛┐\
└┴┬├─┼╞╟╚╔╩╦╠═╬╧╨╤╥╙╘╒╓╫╪┘┌█▄▌▐▀αßΓπΣσµτΦΘΩδ∞φε∩≡±≥≤⌠⌡÷≈°∙·√ⁿ²■\u{a0}";

/// The upper half of the code page 850.
const CP850: &str = "ÇüéâäàåçêëèïîìÄÅÉæÆôöòûùÿÖÜø£Ø×ƒáíóúñÑªº¿®¬½¼¡«»░▒▓│┤ÁÂÀ©╣║╗╝¢¥┐\
└┴┬├─┼ãÃ╚╔╩╦╠═╬¤ðÐÊËÈıÍÎÏ┘┌█▄¦Ì▀ÓßÔÒõÕµþÞÚÛÙýÝ¯´\u{ad}±‗¾¶§÷¸°¨·¹³²■\u{a0}";

/// The upper half of the code page 852.
const CP852: &str = "ÇüéâäůćçłëŐőîŹÄĆÉĹĺôöĽľŚśÖÜŤťŁ×čáíóúĄąŽžĘę¬źČş«»░▒▓│┤ÁÂĚŞ╣║╗╝Żż┐\
└┴┬├─┼Ăă╚╔╩╦╠═╬¤đĐĎËďŇÍÎě┘┌█▄ŢŮ▀ÓßÔŃńňŠšŔÚŕŰýÝţ´\u{ad}˝˛ˇ˘§÷¸°¨˙űŘř■\u{a0}";

impl Encoding {
    /// Returns the encoding that a .cpg names; `None`, with a warning, for an unknown one.
    pub fn of_name(text: &str, warnings: &mut Warnings) -> Option<Self> {
        let label = text.trim().to_ascii_lowercase();
        let digits = label.trim_start_matches(|c: char| !c.is_ascii_digit());
        let found = encoding_rs::Encoding::for_label(label.as_bytes()).map(Self::Known);
        let found = found.or_else(|| Self::of_page(digits.parse().ok()?));
        if found.is_none() && !label.is_empty() {
            let label = crate::text::quote(label.as_bytes());
            let message = format!("the .cpg names the encoding {label}, which is not known");
            warnings.push(Place::Whole, message);
        }
        found
    }

    /// Returns the encoding of a Windows or MS-DOS code page, or a part of ISO 8859 by `88591` and
    /// similar ones.
    fn of_page(page: u32) -> Option<Self> {
        let label = match page {
            437 => return Some(Self::Page(CP437)),
            850 | 858 => return Some(Self::Page(CP850)),
            852 => return Some(Self::Page(CP852)),
            65001 | 8 => "utf-8".to_owned(),
            932 => "shift_jis".to_owned(),
            936 => "gbk".to_owned(),
            949 => "euc-kr".to_owned(),
            950 => "big5".to_owned(),
            866 => "ibm866".to_owned(),
            874 | 1250..=1258 => format!("windows-{page}"),
            28591..=28606 => format!("iso-8859-{}", page - 28590),
            88591..=88599 => format!("iso-8859-{}", page - 88590),
            _ => return None,
        };
        encoding_rs::Encoding::for_label(label.as_bytes()).map(Self::Known)
    }

    /// Returns the encoding of the language driver of a table.
    pub fn of_driver(driver: u8) -> Option<Self> {
        Self::of_page(match driver {
            0x01 | 0x09 | 0x0b | 0x0d | 0x0f | 0x11 | 0x15 | 0x18 | 0x19 | 0x1b => 437,
            0x02 | 0x0a | 0x0e | 0x10 | 0x12 | 0x14 | 0x16 | 0x1a | 0x1d | 0x25 | 0x37 => 850,
            0x1f | 0x22 | 0x23 | 0x40 | 0x64 | 0x87 => 852,
            0x26 | 0x65 => 866,
            0x03 | 0x57..=0x59 => 1252,
            0x13 | 0x7b => 932,
            0x4d | 0x7a => 936,
            0x4e | 0x79 => 949,
            0x4f | 0x78 => 950,
            0x50 | 0x7c => 874,
            0xc8 => 1250,
            0xc9 => 1251,
            0xca => 1254,
            0xcb => 1253,
            0xcc => 1257,
            _ => return None,
        })
    }

    /// Decodes bytes to text; returns the text, and whether all bytes are valid.
    pub fn decode<'a>(self, bytes: &'a [u8]) -> (Cow<'a, str>, bool) {
        match self {
            Self::Known(encoding) => {
                // A letter that is cut off in its middle is left out.
                let whole =
                    if encoding == encoding_rs::UTF_8 { whole_letters(bytes) } else { bytes };
                match encoding.decode_without_bom_handling_and_without_replacement(whole) {
                    Some(text) => (text, true),
                    None => (name(bytes), false),
                }
            }
            Self::Page(upper) => {
                let upper = |b: u8| upper.chars().nth(usize::from(b & 0x7f)).unwrap_or('?');
                let letter = |&b: &u8| if b < 0x80 { char::from(b) } else { upper(b) };
                (Cow::Owned(bytes.iter().map(letter).collect()), true)
            }
        }
    }
}

/// Returns the bytes without the beginning of a letter of UTF-8 at their end.
pub fn whole_letters(bytes: &[u8]) -> &[u8] {
    match std::str::from_utf8(bytes) {
        Err(e) if e.error_len().is_none() => bytes.get(..e.valid_up_to()).unwrap_or(bytes),
        _ => bytes,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encodings_are_known_by_many_names() {
        let decoded = |label: &str, bytes: &'static [u8]| {
            let encoding = Encoding::of_name(label, &mut Warnings::default());
            encoding.map(|e| e.decode(bytes).0.into_owned())
        };
        for (label, bytes, text) in [
            ("UTF-8", &b"\xc3\xa4"[..], "ä"),
            ("65001", b"\xc3\xa4x\xc3", "äx"),
            ("ISO-8859-1\r\n", b"\xe4", "ä"),
            ("ISO 88592", b"\xb1", "ą"),
            ("1252", b"\x80", "€"),
            ("ANSI 1251", b"\xcc", "М"),
            ("CP437", b"\x81", "ü"),
            ("OEM 850", b"\x9d", "Ø"),
            ("cp852", b"\x86", "ć"),
            ("GBK", b"\xd6\xd0", "中"),
            ("932", b"\x93\xfa", "日"),
        ] {
            assert_eq!(decoded(label, bytes).as_deref(), Some(text), "{label}");
        }
        for page in [CP437, CP850, CP852] {
            assert_eq!(page.chars().count(), 128);
        }
        let mut warnings = Warnings::default();
        assert!(Encoding::of_name("klingon", &mut warnings).is_none());
        assert!(warnings.kept[0].message.contains("klingon"));
    }
}
