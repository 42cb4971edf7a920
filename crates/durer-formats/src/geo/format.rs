//! The formats of geodata, and how they are told apart.

use super::{wkb, wkt};

/// A format of geodata.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum GeoFormat {
    /// A GeoJSON document (RFC 7946); as input also any sequence of documents.
    GeoJson,
    /// GeoJSON, one feature per line.
    GeoJsonSeq,
    /// GeoJSON, each feature after a record separator (RFC 8142).
    GeoJsonRs,
    /// Well-known text, also EWKT.
    Wkt,
    /// Well-known binary, also EWKB.
    Wkb,
    /// Well-known binary in hexadecimal digits, one geometry per line.
    WkbHex,
    /// SVG.
    Svg,
}

impl GeoFormat {
    /// All formats, in the order in which messages list them.
    pub const ALL: [Self; 7] = [
        Self::GeoJson,
        Self::GeoJsonSeq,
        Self::GeoJsonRs,
        Self::Wkt,
        Self::Wkb,
        Self::WkbHex,
        Self::Svg,
    ];

    /// The name used on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::GeoJson => "geojson",
            Self::GeoJsonSeq => "geojsonl",
            Self::GeoJsonRs => "geojsons",
            Self::Wkt => "wkt",
            Self::Wkb => "wkb",
            Self::WkbHex => "wkb-hex",
            Self::Svg => "svg",
        }
    }

    /// The endings of its files' names, lower case, without a dot.
    pub fn suffixes(self) -> &'static [&'static str] {
        match self {
            Self::GeoJson => &["geojson", "json"],
            Self::GeoJsonSeq => &["geojsonl", "ndjson", "jsonl", "ndgeojson", "ldgeojson"],
            Self::GeoJsonRs => &["geojsons"],
            Self::Wkt => &["wkt", "ewkt"],
            Self::Wkb => &["wkb", "ewkb"],
            Self::WkbHex => &["hex", "wkbhex"],
            Self::Svg => &["svg"],
        }
    }

    /// Whether it is one of the layouts of GeoJSON.
    pub fn is_geojson(self) -> bool {
        matches!(self, Self::GeoJson | Self::GeoJsonSeq | Self::GeoJsonRs)
    }

    /// Whether features can be written one after the other, without holding them.
    pub fn streams(self) -> bool {
        self != Self::Svg
    }

    /// The format that the first bytes of a file speak for, if they do.
    pub fn of_content(bytes: &[u8]) -> Option<Self> {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
        match text.first() {
            Some(0x1e) => Some(Self::GeoJsonRs),
            Some(b'{') if has_another_object(text) => Some(Self::GeoJsonSeq),
            Some(b'{') => Some(Self::GeoJson),
            Some(b'<') => Some(Self::Svg),
            _ if wkb::sniff(bytes) => Some(Self::Wkb),
            _ if wkb::sniff_hex(text) => Some(Self::WkbHex),
            _ => wkt::sniff(text).then_some(Self::Wkt),
        }
    }

    /// The format that a file's name speaks for, if it does.
    pub fn of_name(name: &str) -> Option<Self> {
        let (_, suffix) = name.rsplit_once('.')?;
        let suffix = suffix.to_ascii_lowercase();
        Self::ALL.into_iter().find(|f| f.suffixes().contains(&suffix.as_str()))
    }
}

/// Whether a second JSON object begins where the first has ended.
fn has_another_object(text: &[u8]) -> bool {
    let (mut depth, mut in_string, mut escaped) = (0_u64, false, false);
    for (i, byte) in text.iter().enumerate() {
        match byte {
            _ if std::mem::take(&mut escaped) => {}
            b'\\' if in_string => escaped = true,
            b'"' => in_string = !in_string,
            b'{' if !in_string => depth += 1,
            b'}' if !in_string => {
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    return text[i + 1..].trim_ascii_start().first() == Some(&b'{');
                }
            }
            _ => {}
        }
    }
    false
}

impl std::fmt::Display for GeoFormat {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_told_apart() {
        for (content, expected) in [
            (&b"\xef\xbb\xbf {"[..], Some(GeoFormat::GeoJson)),
            (b"\x1e{", Some(GeoFormat::GeoJsonRs)),
            (b"{\"a\": {\"b\": \"}{\\\"\"}}\n{\"c\"", Some(GeoFormat::GeoJsonSeq)),
            (b"{\"a\": {\"b\": \"}{\"}}\n", Some(GeoFormat::GeoJson)),
            (b"<svg", Some(GeoFormat::Svg)),
            (b"\n point (", Some(GeoFormat::Wkt)),
            (b"SRID=4326;POINT(1 2)", Some(GeoFormat::Wkt)),
            (b"\x01\x01\0\0\0", Some(GeoFormat::Wkb)),
            (b"0101000000", Some(GeoFormat::WkbHex)),
            (b"pointless", None),
            (b"", None),
        ] {
            assert_eq!(GeoFormat::of_content(content), expected, "{content:?}");
        }
        assert_eq!(GeoFormat::of_name("a/b.NDJSON"), Some(GeoFormat::GeoJsonSeq));
        assert_eq!(GeoFormat::of_name("geojson"), None);
    }
}
