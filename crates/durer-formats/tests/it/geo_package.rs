//! GeoPackages: from other programs, damaged, and written here.

use durer_formats::geo::{
    Beside, Feature, GeoFormat, Geometry, Member, Points, Reader, System, Writer, read_all,
};
use durer_formats::{NoResources, Resources};
use std::io::{Cursor, Seek};

/// UTF-16 text, pages of 512 bytes, rows on several pages, a column added later, two layers of points and lines, a
/// table without geometries, a view and tiles.
const WIDE: &[u8] = include_bytes!("../../../../fuzz/seeds/geopackage/wide.gpkg");

/// The same in UTF-8, with lines in another coordinate system.
const PLAIN: &[u8] = include_bytes!("../../../../fuzz/seeds/geopackage/plain.gpkg");

/// Returns all features of a layer, the warnings, and the number of the coordinate system.
fn layer(bytes: &[u8], layer: Option<&str>) -> (Vec<Feature>, Vec<String>, System) {
    let beside = Beside { name: "", resources: &NoResources, layer };
    let mut reader = Reader::with(GeoFormat::GeoPackage, bytes, &beside).expect("a reader");
    let mut features = Vec::new();
    while let Some(feature) = reader.next_feature().expect("a feature") {
        features.push(feature);
    }
    let system = reader.system();
    (features, reader.warnings().iter().map(ToString::to_string).collect(), system)
}

fn error(bytes: &[u8], layer: Option<&str>) -> String {
    let beside = Beside { name: "", resources: &NoResources, layer };
    let read = || {
        let mut reader = Reader::with(GeoFormat::GeoPackage, bytes, &beside)?;
        while reader.next_feature()?.is_some() {}
        Ok::<_, durer_formats::Error>(())
    };
    read().expect_err("wrong").to_string()
}

fn text(features: &[Feature], format: GeoFormat) -> String {
    let mut writer = Writer::new(format, Vec::new());
    features.iter().for_each(|feature| writer.write(feature).expect("memory"));
    String::from_utf8(writer.finish(&[]).expect("memory")).expect("text")
}

#[test]
fn a_layer_has_numbers_fields_and_its_system() {
    for bytes in [WIDE, PLAIN] {
        assert_eq!(GeoFormat::of_content(bytes), Some(GeoFormat::GeoPackage));
        let (features, warnings, system) = layer(bytes, Some("Städte"));
        assert_eq!(system.code, Some(4326));
        assert_eq!(
            features[0].properties.as_deref(),
            Some(
                r#"{"name":"Bérn \"B\"","pop":134000,"share":0.25,"capital":true,"since":"2024-02-29","extra":{"a":[1, 2]}}"#
            )
        );
        let ids: Vec<&str> = features.iter().filter_map(|f| f.id.as_deref()).collect();
        assert_eq!(ids, ["3", "5", "9"]);
        let long = features[1].fields()[0].text().expect("a text");
        assert_eq!(long, "x".repeat(3000));
        let values: Vec<String> =
            features[1].fields()[1..].iter().map(|f| f.value.clone()).collect();
        assert_eq!(values, ["-5", "3", "false", "null", "\"no json\""]);
        assert_eq!(features[2].fields()[1].value, "1099511627776");
        assert_eq!(
            text(&features, GeoFormat::Wkt),
            "SRID=4326;POINT (7.5 47)\nSRID=4326;POINT (8 47.5)\n"
        );
        assert_eq!(warnings, ["layer Städte, row 3: 1 binary value is left out"]);
    }
}

#[test]
fn geometries_of_all_kinds_are_read_and_bad_ones_reported() {
    let (features, warnings, system) = layer(PLAIN, Some("lines"));
    assert_eq!(system.code, Some(32632));
    let wkt = text(&features, GeoFormat::Wkt);
    let lines: Vec<&str> = wkt.lines().map(|l| l.trim_start_matches("SRID=32632;")).collect();
    assert_eq!(lines[0], "LINESTRING ZM (0 0 1 5, 1 1 2 6)");
    assert!(lines[1].starts_with("LINESTRING (0 0, ") && lines[1].ends_with("2 0)"));
    assert_eq!(
        lines[2..],
        [
            "GEOMETRYCOLLECTION (POINT (1 2), LINESTRING (0 0, 1 1))",
            "LINESTRING EMPTY",
            "POINT (3 4)"
        ]
    );
    // Rows older than the last column have its default.
    let last: Vec<String> = features.iter().map(|f| f.fields()[1].value.clone()).collect();
    assert_eq!(last, ["7", "7", "7", "7", "7", "7", "8"]);
    assert_eq!(
        warnings,
        [
            "layer lines, row 5: 2 geometries cannot be read and are left out; the first: byte 0: a geometry must begin with GP and a version of 0",
            "layer lines, row 2: 1 curve is flattened to lines of 32 edges per quarter turn"
        ]
    );
}

#[test]
fn all_layers_are_read_or_the_named_one() {
    let (features, warnings, _) = layer(WIDE, None);
    assert_eq!(features.len(), 10);
    assert!(features.iter().all(|feature| feature.id.is_none()));
    assert_eq!(
        warnings[..4],
        [
            "layer seen: left out: it is a view, which only a database can work out",
            "layer photo: left out: it holds pixels",
            "1 table without geometries is left out; --layer names one: notes",
            "its 2 layers, Städte, lines, become one; --layer names one"
        ]
    );
    let (features, warnings, _) = layer(WIDE, Some("notes"));
    assert_eq!(
        (features[0].properties.as_deref(), warnings.len()),
        (Some("{\"note\":\"hello\"}"), 0)
    );
    assert_eq!(
        error(PLAIN, None),
        "its layers are in different coordinate systems; --layer names one of Städte (EPSG:4326), lines (EPSG:32632)"
    );
    assert_eq!(error(WIDE, Some("seas")), "there is no layer seas; it has Städte, lines, notes");
    assert!(error(WIDE, Some("seen")).contains("layer seen cannot be read: it is a view"));
    let reader = Reader::new(GeoFormat::GeoPackage, PLAIN).expect("a reader");
    assert_eq!(reader.layers(), ["Städte", "lines"]);
}

#[test]
fn damaged_files_are_refused_with_a_place() {
    let with = |at: usize, bytes: &[u8]| {
        let mut file = WIDE.to_vec();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        file
    };
    assert!(error(&with(16, &[3, 0]), None).starts_with("byte 16: pages of 768 bytes"));
    assert!(error(&with(20, &[99]), None).starts_with("byte 20: pages keep more"));
    assert_eq!(error(&with(100, &[10]), None), "byte 0: a page of a table is expected");
    // The last child of the first page is the page itself.
    let messages = error(&with(108, &[0, 0, 0, 1]), None);
    let ways = ["nested too deep", "lead to each other without end", "lie over each other"];
    assert!(ways.iter().any(|way| messages.contains(way)), "{messages}");
    assert!(error(&WIDE[..1536], None).contains("is needed, but the file ends after 3"));
    assert!(error(b"SQLite", None).contains("the header of an SQLite database is expected"));
}

/// Files that another program may leave beside a database.
struct Left(&'static str);

impl Resources for Left {
    fn read(&self, uri: &str, _: u64) -> Result<Vec<u8>, String> {
        if uri == self.0 { Ok(vec![1]) } else { Err("none".to_owned()) }
    }
}

#[test]
fn changes_in_another_file_are_reported() {
    for name in ["a.gpkg-wal", "a.gpkg-journal"] {
        let beside = Beside { name: "a.gpkg", resources: &Left(name), layer: None };
        let messages = Reader::with(GeoFormat::GeoPackage, WIDE, &beside).err().expect("refused");
        assert!(messages.to_string().starts_with(name), "{messages}");
    }
    let beside = Beside { name: "a.gpkg", resources: &Left("b.gpkg-wal"), layer: Some("lines") };
    assert!(Reader::with(GeoFormat::GeoPackage, WIDE, &beside).is_ok());
}

#[test]
fn what_is_written_is_the_same_to_a_file_and_to_a_stream() {
    let features: Vec<Feature> = (0..12_000)
        .map(|i| {
            let point = Points::flat(vec![durer::math::DVec2::new(f64::from(i), 0.5)]);
            let late = if i > 11_000 { ",\"late\":true" } else { "" };
            let mixed = if i == 11_500 { "\"x\"".to_owned() } else { i.to_string() };
            let properties = format!("{{\"n\":{i},\"m\":{mixed}{late}}}");
            Feature { properties: Some(properties), ..Feature::of_geometry(Geometry::Point(point)) }
        })
        .collect();
    let mut stream = Writer::new(GeoFormat::GeoPackage, Vec::new());
    let mut file = Writer::seekable(GeoFormat::GeoPackage, Cursor::new(Vec::new()));
    stream.set_layer("gpkg_x");
    file.set_layer("gpkg_x");
    for feature in &features {
        stream.write(feature).expect("memory");
        file.write(feature).expect("memory");
    }
    let finished = stream.finish_all(&[]).expect("memory");
    let mut file = file.finish(&[]).expect("memory");
    assert_eq!(file.stream_position().expect("memory"), finished.out.len() as u64);
    assert!(file.into_inner() == finished.out);
    let messages: Vec<String> = finished.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        messages,
        ["1 fields are texts after being numbers; their first values stay numbers: m"]
    );
    let (again, ..) = layer(&finished.out, Some("layer_gpkg_x"));
    assert_eq!(again.len(), 12_000);
    assert_eq!(again[0].properties.as_deref(), Some("{\"n\":0,\"m\":0,\"late\":null}"));
    assert_eq!(
        again[11_500].properties.as_deref(),
        Some("{\"n\":11500,\"m\":\"x\",\"late\":true}")
    );
}

#[test]
fn names_and_numbers_that_meet_are_kept_apart() {
    let (mut features, _) = read_all(
        br#"{"type":"FeatureCollection","features":[
{"type":"Feature","id":7,"properties":{"fid":"a","GEOM":1,"Name":"x","name":"y","":2},"geometry":{"type":"Point","coordinates":[1,2]}},
{"type":"Feature","id":5,"properties":{"n":1e300},"geometry":null}]}"#,
        "a.geojson",
    )
    .expect("features");
    features[1].properties = Some("{\"n\":1e300}".to_owned());
    let mut writer = Writer::new(GeoFormat::GeoPackage, Vec::new());
    writer.set_system(System::of_code(2154));
    features.iter().for_each(|feature| writer.write(feature).expect("memory"));
    let finished = writer.finish_all(&[]).expect("memory");
    assert_eq!(finished.warnings.len(), 1, "{:?}", finished.warnings);
    let (again, warnings, system) = layer(&finished.out, None);
    assert_eq!((system.code, warnings.len()), (Some(2154), 0));
    let ids: Vec<&str> = again.iter().filter_map(|f| f.id.as_deref()).collect();
    assert_eq!(ids, ["7", "8"]);
    let keys: Vec<String> = again[0].fields().iter().map(Member::key).collect();
    assert_eq!(keys, ["fid", "GEOM", "Name", "name_2", "_2", "id", "n"]);
    assert_eq!(again[1].fields()[6].value, "1e300");
    assert_eq!(again[1].fields()[5].value, "5");
}

#[test]
fn more_fields_than_a_table_has_are_refused() {
    let fields: Vec<String> = (0..1999).map(|i| format!("\"f{i}\":{i}")).collect();
    let mut feature =
        Feature { properties: Some(format!("{{{}}}", fields.join(","))), ..Feature::default() };
    let mut writer = Writer::new(GeoFormat::GeoPackage, Vec::new());
    assert!(writer.write(&feature).expect_err("too many").to_string().contains("1998 fields"));
    feature.properties = Some(format!("{{{}}}", fields[..1998].join(",")));
    let mut writer = Writer::new(GeoFormat::GeoPackage, Vec::new());
    writer.write(&feature).expect("memory");
    let (again, ..) = layer(&writer.finish(&[]).expect("memory"), Some("layer"));
    assert_eq!(again[0].properties, feature.properties);
}

#[test]
fn other_databases_say_what_they_are() {
    // A database whose list of contents is another kind of table.
    let mut file = PLAIN.to_vec();
    for at in 0..file.len() - 13 {
        if file[at..].starts_with(b"gpkg_contents") {
            file[at..at + 13].copy_from_slice(b"gpkg_kontents");
        }
    }
    assert!(
        error(&file, None).contains("without the table gpkg_contents"),
        "{}",
        error(&file, None)
    );
    let mut tiles = file.clone();
    tiles[68..72].copy_from_slice(b"MPBX");
    assert!(error(&tiles, None).starts_with("this is MBTiles"));
    assert_eq!(GeoFormat::of_content(&tiles), None);
    assert!(GeoFormat::foreign(&tiles).contains("SQLite database that is not a GeoPackage"));
}
