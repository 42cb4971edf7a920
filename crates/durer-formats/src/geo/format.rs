//! The formats of map data, and their detection.

use super::{
    csv, flatgeobuf, foreign, geopackage, geoparquet, markup, shapefile, topojson, wkb, wkt,
};
use crate::gzip;

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
    /// Shapefile: the .shp, with the files beside it.
    Shapefile,
    /// FlatGeobuf.
    FlatGeobuf,
    /// GeoPackage, a database of SQLite.
    GeoPackage,
    /// GeoParquet; by the feature `geoparquet`.
    GeoParquet,
    /// TopoJSON.
    TopoJson,
    /// A table as text, with geometries as WKT, or as longitude and latitude.
    Csv,
    /// KML; only read.
    Kml,
    /// GPX; only read.
    Gpx,
}

impl GeoFormat {
    /// All formats, in the order in which messages list them.
    pub const ALL: [Self; 15] = [
        Self::GeoJson,
        Self::GeoJsonSeq,
        Self::GeoJsonRs,
        Self::Wkt,
        Self::Wkb,
        Self::WkbHex,
        Self::Svg,
        Self::Shapefile,
        Self::FlatGeobuf,
        Self::GeoPackage,
        Self::GeoParquet,
        Self::TopoJson,
        Self::Csv,
        Self::Kml,
        Self::Gpx,
    ];

    /// List of formats that are read, for messages.
    pub const READ: &'static str = "GeoJSON, JSON of ArcGIS, TopoJSON, FlatGeobuf, GeoPackage, Shapefile, CSV, KML, GPX, WKT, WKB and SVG, also compressed by gzip";

    /// Returns the name used on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::GeoJson => "geojson",
            Self::GeoJsonSeq => "geojsonl",
            Self::GeoJsonRs => "geojsons",
            Self::Wkt => "wkt",
            Self::Wkb => "wkb",
            Self::WkbHex => "wkb-hex",
            Self::Svg => "svg",
            Self::Shapefile => "shapefile",
            Self::FlatGeobuf => "flatgeobuf",
            Self::GeoPackage => "geopackage",
            Self::GeoParquet => "geoparquet",
            Self::TopoJson => "topojson",
            Self::Csv => "csv",
            Self::Kml => "kml",
            Self::Gpx => "gpx",
        }
    }

    /// Returns the endings of its files' names, lower case, without a dot.
    pub fn suffixes(self) -> &'static [&'static str] {
        match self {
            Self::GeoJson => &["geojson", "json"],
            Self::GeoJsonSeq => &["geojsonl", "ndjson", "jsonl", "ndgeojson", "ldgeojson"],
            Self::GeoJsonRs => &["geojsons"],
            Self::Wkt => &["wkt", "ewkt"],
            Self::Wkb => &["wkb", "ewkb"],
            Self::WkbHex => &["hex", "wkbhex"],
            Self::Svg => &["svg"],
            Self::Shapefile => &["shp"],
            Self::FlatGeobuf => &["fgb"],
            Self::GeoPackage => &["gpkg"],
            Self::GeoParquet => &["parquet", "geoparquet"],
            Self::TopoJson => &["topojson"],
            Self::Csv => &["csv", "tsv"],
            Self::Kml => &["kml"],
            Self::Gpx => &["gpx"],
        }
    }

    /// Returns whether it is one of the layouts of GeoJSON.
    pub fn is_geojson(self) -> bool {
        matches!(self, Self::GeoJson | Self::GeoJsonSeq | Self::GeoJsonRs)
    }

    /// Returns whether features can be written one after the other, without holding them.
    pub fn streams(self) -> bool {
        self.is_geojson() || matches!(self, Self::Wkt | Self::Wkb | Self::WkbHex)
    }

    /// Returns whether its files may have several layers.
    pub fn has_layers(self) -> bool {
        matches!(self, Self::TopoJson | Self::GeoPackage)
    }

    /// Returns whether it is written by this build, and not only read.
    pub fn is_written(self) -> bool {
        !matches!(self, Self::Kml | Self::Gpx) && self.missing_feature().is_none()
    }

    /// Returns the feature without which this build neither reads nor writes it.
    pub fn missing_feature(self) -> Option<&'static str> {
        let is_missing = self == Self::GeoParquet && !cfg!(feature = "geoparquet");
        is_missing.then_some("geoparquet")
    }

    /// Returns whether features keep their properties in it.
    pub fn has_fields(self) -> bool {
        !matches!(self, Self::Wkt | Self::Wkb | Self::WkbHex | Self::Svg)
    }

    /// Returns whether its files are bytes that are not text.
    pub fn is_binary(self) -> bool {
        matches!(self, Self::Wkb | Self::Shapefile | Self::FlatGeobuf)
            || matches!(self, Self::GeoPackage | Self::GeoParquet)
    }

    /// Returns whether its coordinates are longitude and latitude on WGS 84 by default.
    pub fn is_lonlat(self) -> bool {
        self.is_geojson() || matches!(self, Self::TopoJson | Self::Kml | Self::Gpx)
    }

    /// Returns whether it has a place for the number of the coordinate system.
    pub fn states_system(self) -> bool {
        matches!(self, Self::Wkt | Self::Wkb | Self::WkbHex | Self::Csv)
            || matches!(self, Self::Shapefile | Self::FlatGeobuf)
            || matches!(self, Self::GeoPackage | Self::GeoParquet)
    }

    /// Returns the format that the first bytes of a file speak for, if they do.
    pub fn of_content(bytes: &[u8]) -> Option<Self> {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
        match text.first() {
            _ if geopackage::sniff(bytes) => Some(Self::GeoPackage),
            _ if geoparquet::sniff(bytes) => Some(Self::GeoParquet),
            _ if foreign::of_content(bytes).is_some() => None,
            _ if shapefile::sniff(bytes) => Some(Self::Shapefile),
            _ if flatgeobuf::sniff(bytes) => Some(Self::FlatGeobuf),
            Some(b'{') if topojson::sniff(text) => Some(Self::TopoJson),
            Some(0x1e) => Some(Self::GeoJsonRs),
            Some(b'{') if has_another_object(text) => Some(Self::GeoJsonSeq),
            Some(b'{') => Some(Self::GeoJson),
            Some(b'<') => Some(match markup::root(text) {
                Some("kml") => Self::Kml,
                Some("gpx") => Self::Gpx,
                _ => Self::Svg,
            }),
            _ if wkb::sniff(bytes) => Some(Self::Wkb),
            _ if wkb::sniff_hex(text) => Some(Self::WkbHex),
            _ if wkt::sniff(text) => Some(Self::Wkt),
            _ => csv::sniff(text).then_some(Self::Csv),
        }
    }

    /// Describes the format of the first bytes of a file that is of no readable format: a sentence for
    /// messages.
    pub fn foreign(bytes: &[u8]) -> String {
        match foreign::of_content(bytes) {
            Some((what, hint)) => format!("this is {what}; {hint}"),
            None if bytes.is_empty() => "the file is empty".to_owned(),
            None => "not a known format".to_owned(),
        }
    }

    /// Returns the format by a file's first bytes, or by its name unless the bytes are known to be another format.
    pub fn of_file(name: &str, head: &[u8]) -> Option<Self> {
        let by_name = || Self::of_name(name);
        Self::of_content(head)
            .or_else(|| by_name().filter(|_| !Self::foreign(head).starts_with("this is")))
    }

    /// Returns the format that a file's name speaks for, if it does.
    pub fn of_name(name: &str) -> Option<Self> {
        let (_, suffix) = gzip::stem(name).rsplit_once('.')?;
        let suffix = suffix.to_ascii_lowercase();
        Self::ALL.into_iter().find(|f| f.suffixes().contains(&suffix.as_str()))
    }
}

/// Returns whether a second JSON object begins where the first has ended.
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
    fn formats_are_reported_apart() {
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
            (
                b"\0\0\x27\x0a\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x32\xe8\x03\0\0\x05",
                Some(GeoFormat::Shapefile),
            ),
            (b"fgb\x03fgb\x01", Some(GeoFormat::FlatGeobuf)),
            (b"{ \"type\" : \"Topology\"", Some(GeoFormat::TopoJson)),
            (b"{\"a\":\"Topology\"", Some(GeoFormat::GeoJson)),
            (b"name;Lon;Lat\nx;1;2", Some(GeoFormat::Csv)),
            (b"WKT,name\n", Some(GeoFormat::Csv)),
            (b"name,place\n", None),
            (b"<?xml version='1.0'?>\n<!-- <svg> -->\n<kml:kml>", Some(GeoFormat::Kml)),
            (b"<gpx version='1.1'>", Some(GeoFormat::Gpx)),
            (b"<osm version='0.6'>", None),
            (b"SQLite format 3\0", None),
            (b"II*\0", None),
            (b"", None),
        ] {
            assert_eq!(GeoFormat::of_content(content), expected, "{content:?}");
        }
        assert_eq!(GeoFormat::of_name("a/b.NDJSON"), Some(GeoFormat::GeoJsonSeq));
        assert_eq!(GeoFormat::of_name("geojson"), None);
        assert_eq!(GeoFormat::of_name("a.csv.GZ"), Some(GeoFormat::Csv));
        assert_eq!(GeoFormat::of_content(b"PAR1"), Some(GeoFormat::GeoParquet));
    }
}
