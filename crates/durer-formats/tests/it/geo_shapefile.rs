//! Shapefiles: reading and writing of their files.

use durer_formats::geo::{Beside, Feature, GeoFormat, Reader, System, Writer, read_all};
use durer_formats::{Resources, Result};
use std::collections::BTreeMap;

/// Files by name.
#[derive(Default)]
struct Files(BTreeMap<String, Vec<u8>>);

impl Resources for Files {
    fn read(&self, path: &str, _: u64) -> std::result::Result<Vec<u8>, String> {
        self.0.get(path).cloned().ok_or_else(|| "there is none".to_owned())
    }
}

/// Returns the files of a Shapefile named `a`, and the messages.
fn written(features: &[Feature], system: System) -> Result<(Files, Vec<String>)> {
    let mut writer = Writer::new(GeoFormat::Shapefile, Vec::new());
    writer.set_system(system);
    features.iter().try_for_each(|feature| writer.write(feature))?;
    let done = writer.finish_all(&[])?;
    let mut files = Files::default();
    files.0.insert("a.shp".to_owned(), done.out);
    files.0.extend(done.beside.into_iter().map(|(suffix, bytes)| (format!("a.{suffix}"), bytes)));
    Ok((files, done.warnings.iter().map(ToString::to_string).collect()))
}

/// Features, their coordinate system, and warnings.
fn read(files: &Files) -> (Vec<Feature>, Option<i32>, Vec<String>) {
    let beside = Beside { name: "a.shp", resources: files, layer: None };
    let mut reader =
        Reader::with(GeoFormat::Shapefile, &files.0["a.shp"][..], &beside).expect("a reader");
    let mut features = Vec::new();
    while let Some(feature) = reader.next_feature().expect("a feature") {
        features.push(feature);
    }
    let warnings = reader.warnings().iter().map(ToString::to_string).collect();
    (features, reader.system().code, warnings)
}

fn parsed(text: &str) -> Vec<Feature> {
    read_all(text.as_bytes(), "a.wkt").expect("read").0
}

fn wkt(features: &[Feature]) -> String {
    let mut writer = Writer::new(GeoFormat::Wkt, Vec::new());
    for feature in features {
        writer.write(&Feature { srid: None, ..feature.clone() }).expect("memory");
    }
    String::from_utf8(writer.finish(&[]).expect("memory")).expect("text")
}

#[test]
fn geometries_of_one_kind_go_there_and_back() {
    for (text, kind) in [
        ("POINT (1 2)\nPOINT (3 4)\n", 1),
        ("POINT Z (1 2 5)\n", 11),
        ("POINT M (1 2 5)\n", 21),
        ("MULTIPOINT (1 2, 3 4)\n", 8),
        ("LINESTRING (0 0, 1 1, 2 0)\nMULTILINESTRING ((0 0, 1 1), (5 5, 6 6))\n", 3),
        ("LINESTRING ZM (0 0 1 2, 1 1 3 4)\n", 13),
        ("POLYGON ((0 0, 0 4, 4 4, 4 0, 0 0), (1 1, 2 1, 2 2, 1 1))\n", 5),
        (
            "MULTIPOLYGON (((0 0, 0 4, 4 4, 4 0, 0 0), (1 1, 3 1, 3 3, 1 3, 1 1)), ((2 2, 2 2.5, 2.5 2.5, 2 2)))\n",
            5,
        ),
    ] {
        let (files, warned) = written(&parsed(text), System::default()).expect("written");
        assert_eq!(warned, Vec::<String>::new());
        assert_eq!((files.0["a.shp"][32], files.0["a.shx"][32]), (kind, kind), "{text}");
        let (features, code, warnings) = read(&files);
        let again = wkt(&features);
        assert_eq!((again, code), (text.to_owned(), None));
        assert_eq!(warnings, Vec::<String>::new());
        let names: Vec<&String> = files.0.keys().collect();
        assert_eq!(names, ["a.cpg", "a.dbf", "a.shp", "a.shx"]);
    }
    let mixed = written(&parsed("POINT (1 2)\nLINESTRING (0 0, 1 1)"), System::default());
    let warned = mixed.err().expect("refused").to_string();
    assert!(
        warned.contains("1 features of points and 1 features of lines is not supported"),
        "{warned}"
    );
}

#[test]
fn fields_and_the_coordinate_system_go_there_and_back() {
    let text = r#"{"type":"FeatureCollection","features":[
{"type":"Feature","id":4,"properties":{"name":"Größe","long_name_of_a_field":1,"long_name_of_another":2,"x":-1.25e-3,"b":true,"d":"2024-02-29","j":[1]},"geometry":{"type":"Point","coordinates":[1,2]}},
{"type":"Feature","properties":{"name":null,"x":7,"b":false},"geometry":null}]}"#;
    let features = read_all(text.as_bytes(), "").expect("read").0;
    let (files, warned) = written(&features, System::of_code(32632)).expect("written");
    assert!(warned[0].contains("2 names of fields are cut"), "{warned:?}");
    assert!(files.0["a.prj"].starts_with(b"PROJCS[\"WGS_1984_UTM_Zone_32N\""));
    let (again, code, warnings) = read(&files);
    assert_eq!((code, warnings), (Some(32632), Vec::new()));
    assert_eq!(
        again[0].properties.as_deref(),
        Some(
            r#"{"id":4,"name":"Größe","long_name_":1,"long_nam_1":2,"x":-1.25e-3,"b":true,"d":"2024-02-29","j":"[1]"}"#
        )
    );
    assert_eq!(
        again[1].properties.as_deref(),
        Some(
            r#"{"id":null,"name":null,"long_name_":null,"long_nam_1":null,"x":7,"b":false,"d":null,"j":null}"#
        )
    );
    assert_eq!(again[1].geometry, None);
}

/// Returns a table with one text of six bytes.
fn table(driver: u8, text: &[u8; 6]) -> Vec<u8> {
    let mut bytes = vec![3, 95, 7, 26, 1, 0, 0, 0, 65, 0, 7, 0];
    bytes.resize(32, 0);
    bytes[29] = driver;
    bytes.extend(b"T\0\0\0\0\0\0\0\0\0\0C\0\0\0\0\x06");
    bytes.resize(64, 0);
    bytes.extend(b"\r ");
    bytes.extend(text);
    bytes
}

#[test]
fn texts_are_decoded_as_stated() {
    let (mut files, _) = written(&parsed("POINT (1 2)"), System::default()).expect("written");
    for (cpg, driver, text, decoded) in [
        (Some("UTF-8"), 0, b"\xc3\xa4    ", "ä"),
        (Some("ISO-8859-1"), 0, b"\xe4     ", "ä"),
        (Some("1251"), 0x57, b"\xcc     ", "М"),
        (None, 0x57, b"\xe4     ", "ä"),
        (None, 0x01, b"\x84     ", "ä"),
        (None, 0xc9, b"\xcc     ", "М"),
        (None, 0, b"\xc3\xa4    ", "ä"),
        (None, 0, b"\xe4     ", "ä"),
        (Some("UTF-8"), 0, b"aaaaa\xc3", "aaaaa"),
    ] {
        files.0.remove("a.cpg");
        files.0.extend(cpg.map(|name| ("a.cpg".to_owned(), name.as_bytes().to_vec())));
        files.0.insert("a.dbf".to_owned(), table(driver, text));
        let (features, _, warnings) = read(&files);
        let expected = format!("{{\"T\":\"{decoded}\"}}");
        assert_eq!(features[0].properties.as_ref(), Some(&expected), "{cpg:?} {driver}");
        assert_eq!(warnings, Vec::<String>::new());
    }
    files.0.insert("a.cpg".to_owned(), b"UTF-8".to_vec());
    files.0.insert("a.dbf".to_owned(), table(0, b"\xe4x    "));
    let (features, _, warnings) = read(&files);
    assert_eq!(features[0].properties.as_deref(), Some("{\"T\":\"äx\"}"));
    assert!(warnings[0].contains("1 text of the .dbf is not in its encoding"), "{warnings:?}");
}

#[test]
fn what_is_missing_or_broken_is_reported() {
    let (mut files, _) =
        written(&parsed("POINT (1 2)\nPOINT (3 4)"), System::default()).expect("written");
    let dbf = files.0.remove("a.dbf").expect("a table");
    let (features, _, warnings) = read(&files);
    assert_eq!(
        (features.len(), &warnings[..]),
        (2, &["there is no .dbf beside it; features have no fields".to_owned()][..])
    );
    // A deleted row removes its record.
    let mut deleted = dbf.clone();
    deleted[65] = b'*';
    files.0.insert("a.dbf".to_owned(), deleted);
    assert_eq!(wkt(&read(&files).0), "POINT (3 4)\n");
    // One row for two records.
    let mut short = dbf.clone();
    short[4] = 1;
    files.0.insert("a.dbf".to_owned(), short);
    let (_, _, warnings) = read(&files);
    assert!(warnings.iter().any(|w| w == "the .dbf has 1 row for 2 records"), "{warnings:?}");
    files.0.insert("a.dbf".to_owned(), dbf);
    let shp = files.0["a.shp"].clone();
    files.0.insert("a.shp".to_owned(), shp[..shp.len() - 1].to_vec());
    let (features, _, warnings) = read(&files);
    assert!(
        features.len() == 1 && warnings[0].starts_with("byte 128: the file ends within a record"),
        "{warnings:?}"
    );
    let mut odd = shp.clone();
    odd[108] = 77;
    files.0.insert("a.shp".to_owned(), odd);
    let beside = Beside { name: "a.shp", resources: &files, layer: None };
    let mut reader =
        Reader::with(GeoFormat::Shapefile, &files.0["a.shp"][..], &beside).expect("a reader");
    let warned = reader.next_feature().expect_err("a shape of no kind").to_string();
    assert!(warned.starts_with("byte 108, feature 1: a shape of the kinds"), "{warned}");
}

#[test]
fn rings_that_run_the_wrong_way_are_understood() {
    let hole = "POLYGON ((0 0, 0 4, 4 4, 4 0, 0 0), (1 1, 3 1, 3 3, 1 3, 1 1))";
    let (mut files, _) = written(&parsed(hole), System::default()).expect("written");
    // x and y of all positions are swapped, which reverses all rings.
    let shp = files.0.get_mut("a.shp").expect("a file");
    let positions = shp.len() - 10 * 16;
    shp[positions..].as_chunks_mut::<16>().0.iter_mut().for_each(|p| p.rotate_left(8));
    let (features, _, warnings) = read(&files);
    assert_eq!(wkt(&features), "POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0), (1 1, 1 3, 3 3, 3 1, 1 1))\n");
    assert_eq!(warnings, Vec::<String>::new());
}
