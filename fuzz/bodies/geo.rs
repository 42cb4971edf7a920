//! The laws that hold for any bytes, read as map data: the bodies of the fuzz targets `geojson`,
//! `wkt`, `wkb`, `svg`, `shapefile`, `flatgeobuf`, `geopackage`, `geoparquet`, `topojson`, `csv`,
//! `kml` and `gpx`, which the tests call as well.

use super::words::text;
use arbitrary::{Result, Unstructured};
use durer::math::DVec2;
use durer_formats::Resources;
use durer_formats::geo::crs::{Crs, code_of_wkt};
use durer_formats::geo::{Beside, Feature, GeoFormat, Geometry, Points, Reader, Writer};

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

/// Returns all features, if there is no error.
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
    "CIRCULARSTRING (0 0, 1 1, 2 0)",
    "COMPOUNDCURVE",
    "CURVEPOLYGON",
    "MULTISURFACE",
    "TIN",
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
        out.extend(word(u.int_in_range(0..=18)? + flags));
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

/// Whatever is read can be written, as a file of the same bytes each time that it is read and written.
fn settles(format: GeoFormat, bytes: &[u8]) {
    let Some(first) = read(format, bytes) else { return };
    let text = write(format, &first);
    let again = |text: &[u8]| write(format, &read(format, text).expect("it is read back"));
    let second = again(&text);
    assert_eq!(again(&second), second);
}

/// One file for every other that is requested: a table, its encoding, and the coordinate system.
struct Others<'a>(&'a [u8]);

impl Resources for Others<'_> {
    fn read(&self, _: &str, _: u64) -> std::result::Result<Vec<u8>, String> {
        Ok(self.0.to_vec())
    }
}

/// Shapefiles: the bytes as a .shp, as what is beside one, and as a definition.
pub fn shapefile(bytes: &[u8]) {
    const EMPTY: &[u8] =
        b"\0\0\x27\x0a\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\xe8\x03\0\0";
    let nulls = [EMPTY, &[0; 68], &b"\0\0\0\x01\0\0\0\x02\0\0\0\0".repeat(3)].concat();
    for shp in [bytes, &nulls] {
        let beside = Beside { name: "a.shp", resources: &Others(bytes), layer: None };
        let Ok(mut reader) = Reader::with(GeoFormat::Shapefile, shp, &beside) else { continue };
        while let Ok(Some(_)) = reader.next_feature() {}
    }
    if let Some(features) = read(GeoFormat::Shapefile, bytes) {
        // A .shp may hold several kinds of shapes, against its rules; then it is not written.
        let mut writer = Writer::new(GeoFormat::Shapefile, Vec::new());
        features.iter().for_each(|feature| writer.write(feature).expect("memory"));
        let written = writer.finish(&[]).ok();
        written
            .into_iter()
            .for_each(|out| drop(read(GeoFormat::Shapefile, &out).expect("read back")));
    }
    let text = String::from_utf8_lossy(bytes);
    let _ = (code_of_wkt(&text), Crs::parse(&text));
}

/// FlatGeobuf.
pub fn flatgeobuf(bytes: &[u8]) {
    settles(GeoFormat::FlatGeobuf, bytes);
    settles(GeoFormat::FlatGeobuf, &[b"fgb\x03fgb\0", bytes].concat());
}

/// GeoPackages: the bytes as a file, and as a geometry in one.
pub fn geopackage(bytes: &[u8]) {
    settles(GeoFormat::GeoPackage, bytes);
    let point = Feature::of_geometry(Geometry::Point(Points::flat(vec![DVec2::ONE])));
    let mut file = write(GeoFormat::GeoPackage, &[point]);
    let geometry: &[u8] = b"GP\0\x01\xff\xff\xff\xff\x01\x01\0\0\0";
    let at = file.windows(geometry.len()).position(|w| w == geometry).expect("the point");
    file[at + 3..].iter_mut().zip(bytes.iter().take(26)).for_each(|(to, from)| *to = *from);
    settles(GeoFormat::GeoPackage, &file);
}

/// GeoParquet, which nothing is read of without the feature.
pub fn geoparquet(bytes: &[u8]) {
    settles(GeoFormat::GeoParquet, bytes);
}

const TOPOJSON: &[&str] = &[
    "{\"type\":\"Topology\",",
    "\"arcs\":",
    "\"objects\":{\"a\":",
    "\"geometries\":[",
    "\"transform\":{\"scale\":[1,2],\"translate\":[3,4]},",
    "\"type\":\"GeometryCollection\",",
    "{\"type\":\"Polygon\",\"arcs\":[[0]]}",
    "{\"type\":\"LineString\",\"arcs\":[-1]}",
    "{\"type\":\"Point\",\"coordinates\":[0,0]}",
    "[[[0,0],[1,0],[1,1],[0,0]]]",
    "[",
    "]",
    "{",
    "}",
    ",",
    "0",
    "-1",
];

/// TopoJSON.
pub fn topojson(bytes: &[u8]) {
    settles(GeoFormat::TopoJson, bytes);
    if let Ok(text) = text(bytes, TOPOJSON) {
        settles(GeoFormat::TopoJson, &text);
    }
}

const CSV: &[&str] = &[
    "wkt",
    "lon",
    "lat",
    ",",
    ";",
    "\n",
    "\"",
    "\"\"",
    "POINT (1 2)",
    "1",
    "01",
    "-0.5",
    "x",
    "\r",
];

/// Tables as text.
pub fn csv(bytes: &[u8]) {
    settles(GeoFormat::Csv, bytes);
    if let Ok(text) = text(bytes, CSV) {
        settles(GeoFormat::Csv, &text);
        settles(GeoFormat::Csv, &[b"a,wkt\n", &text[..]].concat());
    }
}

const MARKUP: &[&str] = &[
    "<kml>",
    "</kml>",
    "<gpx>",
    "</gpx>",
    "<Placemark>",
    "</Placemark>",
    "<MultiGeometry>",
    "</MultiGeometry>",
    "<Polygon><outerBoundaryIs><LinearRing><coordinates>0,0 1,0 1,1 0,0</coordinates></LinearRing></outerBoundaryIs></Polygon>",
    "<LineString>",
    "</LineString>",
    "<Point><coordinates>",
    "</coordinates></Point>",
    "<wpt lat='1' lon='2'/>",
    "<trk><trkseg>",
    "<trkpt lat='1' lon='2'><ele>3</ele></trkpt>",
    "</trkseg></trk>",
    "<name>a</name>",
    "1,2,3",
    " ",
];

fn only_read(format: GeoFormat, bytes: &[u8]) {
    read(format, bytes).into_iter().for_each(|features| drop(write(GeoFormat::GeoJson, &features)));
    if let Ok(text) = text(bytes, MARKUP) {
        read(format, &text)
            .into_iter()
            .for_each(|features| drop(write(GeoFormat::GeoJson, &features)));
    }
}

/// KML.
pub fn kml(bytes: &[u8]) {
    only_read(GeoFormat::Kml, bytes);
}

/// GPX.
pub fn gpx(bytes: &[u8]) {
    only_read(GeoFormat::Gpx, bytes);
}

/// SVG.
pub fn svg(bytes: &[u8]) {
    both(GeoFormat::Svg, bytes, SVG);
}
