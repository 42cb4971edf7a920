//! Formats that are not readable as map data, for messages.

/// Beginnings of formats that are not read, their names, and advice.
const MAGIC: [(&[u8], &str, &str); 17] = [
    (
        b"SQLite format 3\0",
        "an SQLite database that is not a GeoPackage, such as MBTiles or SpatiaLite",
        EXPORT,
    ),
    (b"PK\x03\x04", "a ZIP archive, such as a packed Shapefile, KMZ or XLSX", "unpack it first"),
    (b"II*\0", "a TIFF picture, such as GeoTIFF", PIXELS),
    (b"MM\0*", "a TIFF picture, such as GeoTIFF", PIXELS),
    (b"II+\0", "a TIFF picture, such as GeoTIFF", PIXELS),
    (b"MM\0+", "a TIFF picture, such as GeoTIFF", PIXELS),
    (b"\x89PNG", "a PNG picture", PIXELS),
    (b"\xff\xd8\xff", "a JPEG picture", PIXELS),
    (b"%PDF", "a PDF document", EXPORT),
    (b"\x89HDF", "HDF5, such as NetCDF", EXPORT),
    (b"CDF\x01", "NetCDF", EXPORT),
    (b"\xd0\xcf\x11\xe0", "an old Office document, such as XLS", "save it as CSV"),
    (b"PMTiles", "a PMTiles archive of tiles", "use the data that it was made from"),
    (b"BZh", "a file compressed by bzip2", "decompress it; gzip is read as it is"),
    (b"\x28\xb5\x2f\xfd", "a file compressed by Zstandard", "decompress it; gzip is read as it is"),
    (b"\xfd7zXZ", "a file compressed by XZ", "decompress it; gzip is read as it is"),
    (b"ARROW1", "an Arrow file, such as GeoArrow", EXPORT),
];

const EXPORT: &str = "export it as GeoJSON, GeoPackage or FlatGeobuf";
const PIXELS: &str = "it holds pixels and no features";

const NAMES: &str = "a first line such as x,y makes it a table (CSV)";

/// Roots of XML documents with other contents.
const ROOTS: [(&str, &str, &str); 4] = [
    ("osm", "OpenStreetMap XML", EXPORT),
    ("FeatureCollection", "GML", EXPORT),
    ("html", "a web page", "download the data that it shows"),
    ("HTML", "a web page", "download the data that it shows"),
];

/// Returns the name of a known format that is not read as map data, if the bytes begin like one,
/// and advice.
pub fn of_content(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    let magic = MAGIC.iter().find(|(magic, ..)| bytes.starts_with(magic));
    let root = || ROOTS.iter().find(|(name, ..)| Some(*name) == super::markup::root(bytes));
    magic
        .map(|(_, what, hint)| (*what, *hint))
        .or_else(|| root().map(|(_, what, hint)| (*what, *hint)))
        .or_else(|| is_pbf(bytes).then_some(("OpenStreetMap PBF", EXPORT)))
        .or_else(|| is_drawing(bytes).then_some(("a drawing of AutoCAD (DXF or DWG)", EXPORT)))
        .or_else(|| is_numbers(bytes).then_some(("a list of numbers without names", NAMES)))
        .or_else(|| is_utf16(bytes).then_some(("text in UTF-16", "save it in UTF-8")))
        .or_else(|| is_dbf(bytes).then_some(("a table of a Shapefile", "open the .shp beside it")))
}

/// Returns whether a DXF file begins, as text or as binary data, or a DWG file of any version since 14.
fn is_drawing(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut lines = text.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let is_text = matches!((lines.next(), lines.next()), (Some(b"0"), Some(b"SECTION")));
    let is_dwg = bytes.starts_with(b"AC10")
        && bytes.get(4..6).is_some_and(|v| v.iter().all(u8::is_ascii_digit));
    is_text || is_dwg || bytes.starts_with(b"AutoCAD Binary DXF")
}

/// Returns whether the first line has two to four numbers and nothing else.
fn is_numbers(bytes: &[u8]) -> bool {
    let line = bytes.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let Ok(line) = std::str::from_utf8(line) else { return false };
    let parts = line.split([',', ';', '\t', ' ', '\r']).filter(|part| !part.is_empty());
    let is_number = |part: &str| part.parse::<f64>().is_ok_and(f64::is_finite);
    let (numbers, others): (Vec<&str>, Vec<&str>) = parts.partition(|part| is_number(part));
    others.is_empty() && (2..=4).contains(&numbers.len())
}

/// Returns whether text in UTF-16 begins, other than XML, with a mark of the order of bytes.
fn is_utf16(bytes: &[u8]) -> bool {
    match bytes {
        [0xff, 0xfe, first, ..] => *first != b'<',
        [0xfe, 0xff, _, second, ..] => *second != b'<',
        _ => false,
    }
}

/// Returns whether a block of OpenStreetMap's format begins.
fn is_pbf(bytes: &[u8]) -> bool {
    bytes.get(4..15) == Some(b"\x0a\x09OSMHeader")
}

/// Returns whether it looks like the table beside a Shapefile: version, a date, and lengths that fit
/// each other.
fn is_dbf(bytes: &[u8]) -> bool {
    let fields = |low: u8, high: u8| u16::from_le_bytes([low, high]).checked_sub(33);
    match bytes {
        [3, _, 1..=12, 1..=31, _, _, _, _, low, high, ..] => {
            fields(*low, *high).is_some_and(|length| length % 32 == 0 && bytes.len() > 32)
        }
        _ => false,
    }
}
