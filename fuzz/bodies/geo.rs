//! What must hold for any bytes, read as map data: the bodies of the fuzz targets `geojson`, `wkt`,
//! `wkb` and `svg`, which the tests call as well.

use super::words::text;
use arbitrary::{Result, Unstructured};
use durer_formats::geo::{Feature, GeoFormat, Reader, Writer};

/// Whatever is read can be written, and reads back as the same.
fn round_trip(format: GeoFormat, bytes: &[u8]) {
    let Some(first) = read(format, bytes) else { return };
    // An SVG is written as a map, whose shapes need not be what was drawn.
    if format == GeoFormat::Svg {
        return drop(write(format, &first));
    }
    let text = write(format, &first);
    let second = read(format, &text)
        .unwrap_or_else(|| panic!("not read back: {}", String::from_utf8_lossy(&text)));
    assert_eq!(write(format, &second), text, "{}", String::from_utf8_lossy(&text));
}

/// All features, where there is no error.
fn read(format: GeoFormat, bytes: &[u8]) -> Option<Vec<Feature>> {
    let mut reader = Reader::new(format, bytes).ok()?;
    let mut features = Vec::new();
    while let Some(feature) = reader.next_feature().ok()? {
        features.push(feature);
    }
    Some(features)
}

fn write(format: GeoFormat, features: &[Feature]) -> Vec<u8> {
    let mut writer = Writer::new(format, Vec::new());
    features.iter().for_each(|feature| writer.write(feature).expect("memory"));
    writer.finish(&[]).expect("memory")
}

/// The bytes as they are, and as words.
fn both(format: GeoFormat, bytes: &[u8], words: &[&str]) {
    round_trip(format, bytes);
    if let Ok(text) = text(bytes, words) {
        round_trip(format, &text);
    }
}

const GEOJSON: &[&str] = &[
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    "\"type\":",
    "\"Feature\"",
    "\"FeatureCollection\"",
    "\"features\":[",
    "\"geometry\":",
    "\"properties\":{}",
    "\"coordinates\":",
    "\"Point\"",
    "\"MultiPoint\"",
    "\"LineString\"",
    "\"MultiLineString\"",
    "\"Polygon\"",
    "\"MultiPolygon\"",
    "\"GeometryCollection\"",
    "\"geometries\":[",
    "\"id\":7",
    "null",
    "[0,0]",
    "[[0,0],[1,0],[1,1],[0,0]]",
    "1e999",
    "\u{1e}",
    "\n",
    "{\"type\":\"Feature\",\"properties\":null,\"geometry\":{\"type\":",
];

/// GeoJSON, as a document, as lines, and as a sequence.
pub fn geojson(bytes: &[u8]) {
    both(GeoFormat::GeoJson, bytes, GEOJSON);
    both(GeoFormat::GeoJsonSeq, bytes, GEOJSON);
}

const WKT: &[&str] = &[
    "(",
    ")",
    ",",
    " ",
    "EMPTY",
    "POINT",
    "MULTIPOINT",
    "LINESTRING",
    "MULTILINESTRING",
    "POLYGON",
    "MULTIPOLYGON",
    "GEOMETRYCOLLECTION",
    " Z ",
    " M ",
    " ZM ",
    "SRID=4326;",
    "CIRCULARSTRING",
    "nan",
    "-",
    "1e400",
    "((0 0, 1 0, 1 1, 0 0))",
    "(0 0, 1 1)",
    "\n",
];

/// WKT.
pub fn wkt(bytes: &[u8]) {
    both(GeoFormat::Wkt, bytes, WKT);
}

/// WKB: bytes as they are, as digits, and records put together.
pub fn wkb(bytes: &[u8]) {
    round_trip(GeoFormat::Wkb, bytes);
    round_trip(GeoFormat::WkbHex, bytes);
    if let Ok(records) = records(bytes) {
        round_trip(GeoFormat::Wkb, &records);
    }
}

fn records(bytes: &[u8]) -> Result<Vec<u8>> {
    let mut u = Unstructured::new(bytes);
    let mut out = Vec::new();
    while !u.is_empty() && out.len() < 1 << 16 {
        let little: bool = u.arbitrary()?;
        let word = |v: u32| if little { v.to_le_bytes() } else { v.to_be_bytes() };
        let flags = *u.choose(&[0, 1000, 2000, 3000, 1 << 31, 1 << 30, 3 << 30, 1 << 29])?;
        out.push(u8::from(little));
        out.extend(word(u.int_in_range(0..=8)? + flags));
        if flags == 1 << 29 {
            out.extend(word(4326));
        }
        for _ in 0..u.int_in_range(0..=2)? {
            out.extend(word(u.int_in_range(0..=5)?));
        }
        for _ in 0..u.int_in_range(0..=12)? {
            let value = f64::from(u.int_in_range(-3i8..=3)?);
            out.extend(if little { value.to_le_bytes() } else { value.to_be_bytes() });
        }
    }
    Ok(out)
}

const SVG: &[&str] = &[
    "<svg>",
    "</svg>",
    "<g",
    "<path",
    "<polygon",
    "<rect",
    "<circle",
    "<ellipse",
    ">",
    "/>",
    "</g>",
    " d=\"",
    " points=\"",
    " transform=\"",
    " id=\"a\"",
    " r=\"",
    " rx=\"",
    " ry=\"",
    " width=\"3\"",
    " height=\"2\"",
    "\"",
    "M",
    "L",
    "H",
    "v",
    "C",
    "s",
    "Q",
    "t",
    "A",
    "Z",
    " 0 1 ",
    " ",
    "rotate(30)",
    "scale(0)",
    "matrix(1 2 3 4 5 6)",
    "translate(",
    ")",
    "<use href=\"#a\"",
    "<use href=\"#b\"",
    "<defs id=\"b\">",
    "</defs>",
    "<symbol id=\"b\">",
    "</symbol>",
    "<clipPath>",
    "</clipPath>",
    "<style>",
    "</style>",
    " x=\"3mm\"",
    " y=\"50%\"",
    " style=\"fill-rule:evenodd!important;/*",
    "*/",
    " display=\"none\"",
    " visibility=\"hidden\"",
    "!--",
    "--",
    "![CDATA[",
    "]]",
];

/// SVG.
pub fn svg(bytes: &[u8]) {
    both(GeoFormat::Svg, bytes, SVG);
}
