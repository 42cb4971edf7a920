//! CSV, TopoJSON, FlatGeobuf, KML and GPX: reading, and writing where it is supported.

use durer::math::{DVec2, Rect};
use durer_formats::NoResources;
use durer_formats::geo::{
    Beside, Dimensions, Feature, FieldKind, GeoFormat, Geometry, Member, Reader, Schema, System,
    Writer, read_all,
};

/// Features, and warnings as texts.
pub fn read(bytes: &[u8], name: &str) -> (Vec<Feature>, Vec<String>) {
    let (features, warnings) = read_all(bytes, name).unwrap_or_else(|e| panic!("{name}: {e}"));
    (features, warnings.iter().map(ToString::to_string).collect())
}

pub fn error(bytes: &[u8], name: &str) -> String {
    read_all(bytes, name).expect_err("wrong").to_string()
}

pub fn write(format: GeoFormat, features: &[Feature]) -> Vec<u8> {
    let mut writer = Writer::new(format, Vec::new());
    features.iter().for_each(|feature| writer.write(feature).expect("memory"));
    writer.finish(&[]).expect("memory")
}

pub fn wkt(features: &[Feature]) -> String {
    String::from_utf8(write(GeoFormat::Wkt, features)).expect("text")
}

/// One feature of every kind, with heights here and there, and fields of every kind.
const ALL_KINDS: &str = r#"{"type":"FeatureCollection","features":[
{"type":"Feature","id":"p1","properties":{"n":1,"x":1.5,"t":"ä, \"b\"\nc","b":true,"d":"2024-02-29","j":{"k":[1, 2]},"e":null},"geometry":{"type":"Point","coordinates":[1.25,-2,7.5]}},
{"type":"Feature","properties":{"n":-9007199254740993,"x":2},"geometry":{"type":"LineString","coordinates":[[0,0],[1,1],[2,0]]}},
{"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[0,0],[4,0],[4,4],[0,4],[0,0]],[[1,1],[1,2],[2,2],[1,1]]]}},
{"type":"Feature","properties":{"t":"x"},"geometry":{"type":"MultiPoint","coordinates":[[1,2],[3,4]]}},
{"type":"Feature","properties":{"t":"y"},"geometry":{"type":"MultiLineString","coordinates":[[[0,0],[1,1]],[[5,5],[6,6],[7,5]]]}},
{"type":"Feature","properties":{"t":"z"},"geometry":{"type":"MultiPolygon","coordinates":[[[[10,0],[14,0],[14,4],[10,0]]],[[[4,0],[8,0],[4,4],[4,0]]]]}},
{"type":"Feature","properties":{"t":"c"},"geometry":{"type":"GeometryCollection","geometries":[{"type":"Point","coordinates":[1,2]},{"type":"LineString","coordinates":[[0,0],[1,1]]}]}},
{"type":"Feature","properties":{"t":"null"},"geometry":null}]}"#;

#[test]
fn features_of_every_kind_go_through_formats_with_fields() {
    let (features, _) = read(ALL_KINDS.as_bytes(), "a.geojson");
    let formats =
        [GeoFormat::Csv, GeoFormat::TopoJson, GeoFormat::FlatGeobuf, GeoFormat::GeoPackage];
    for format in formats {
        let bytes = write(format, &features);
        assert_eq!(GeoFormat::of_content(&bytes), Some(format));
        let (mut again, warnings) = read(&bytes, "");
        if format == GeoFormat::FlatGeobuf {
            // Its index has its own order.
            again.sort_by_key(|f| features.iter().position(|g| g.geometry == f.geometry));
        }
        assert_eq!((wkt(&again), warnings), (wkt(&features), Vec::new()), "{format}");
        assert_eq!(write(format, &again), bytes, "{format}: written again");
        let field = |i: usize, key: &str| {
            let fields = again[i].fields();
            fields.into_iter().find(|f| f.key() == key).map(|f| f.value)
        };
        assert_eq!(field(0, "n").as_deref(), Some("1"), "{format}");
        assert_eq!(field(0, "t").as_deref(), Some(r#""ä, \"b\"\nc""#), "{format}");
        assert_eq!(field(0, "d").as_deref(), Some("\"2024-02-29\""), "{format}");
        assert_eq!(field(1, "n").as_deref(), Some("-9007199254740993"), "{format}");
        if format == GeoFormat::TopoJson {
            assert_eq!(again[0].id.as_deref(), Some("\"p1\""));
        } else {
            assert_eq!(field(0, "id").as_deref(), Some("\"p1\""), "{format}");
        }
    }
}

#[test]
fn columns_of_csv_are_numbers_only_where_all_are() {
    let text =
        "name;lon;lat;zip;n;e\r\n\"a;\"\"b\"\"\";7,5;-2;01067;1.50;\r\n\nc;8;3;80331;2;\n;x;;1;3;";
    let (features, warnings) = read(text.as_bytes(), "a.csv");
    assert_eq!(wkt(&features), "POINT (7.5 -2)\nPOINT (8 3)\n");
    assert_eq!(
        features[0].properties.as_deref(),
        Some(r#"{"name":"a;\"b\"","zip":"01067","n":1.50,"e":null}"#)
    );
    assert_eq!(
        warnings,
        ["line 5: 1 row has no numbers in the columns of its place; it has no geometry"]
    );
    let (features, warnings) = read(
        b"WKT,a\n\"SRID=4326;POINT (1 2)\",1\n0101000000000000000000F03F0000000000000040,2\n,3\n",
        "",
    );
    assert_eq!(
        (wkt(&features), warnings.len()),
        ("SRID=4326;POINT (1 2)\nPOINT (1 2)\n".to_owned(), 0)
    );
    let (features, _) = read(b"x\ty\tz\tn\n1\t2\t3\tq\n", "");
    assert_eq!(wkt(&features), "POINT Z (1 2 3)\n");
    assert!(
        error(b"a,b\n1,2\n", "a.csv").contains("no column is known to hold geometries among a, b")
    );
    assert!(
        error(b"a,wkt\n\n1,POINT (1)\n", "a.csv").starts_with("line 3, feature 1: a position of 2")
    );
    // Latin-1, as spreadsheets write it.
    let (features, _) = read(b"lon,lat,n\n1,2,M\xfcnchen\n", "a.csv");
    assert_eq!(features[0].properties.as_deref(), Some("{\"n\":\"München\"}"));
}

const TOPOLOGY: &str = r#"{"type":"Topology","about":{"x":1},"transform":{"scale":[0.5,0.25],"translate":[10,20]},
"objects":{"b":{"type":"GeometryCollection","geometries":[
  {"type":"Polygon","id":7,"properties":{"n":1},"arcs":[[0,1]]},{"type":"Polygon","arcs":[[-1,-3]]},{"type":null,"properties":{"n":3}}]},
 "a":{"type":"Point","coordinates":[2,4]}},
"arcs":[[[0,0],[2,0],[0,2]],[[2,2],[-2,-2]],[[2,2],[2,0],[-4,-2]]]}"#;

#[test]
fn topologies_are_read_in_their_order() {
    let (features, warnings) = read(TOPOLOGY.as_bytes(), "");
    assert_eq!(
        wkt(&features),
        "POLYGON ((10 20, 11 20, 11 20.5, 10 20))
POLYGON ((11 20.5, 11 20, 10 20, 12 20.5, 11 20.5))\nPOINT (11 21)\n"
    );
    assert_eq!(
        (features[0].id.as_deref(), features[0].properties.as_deref()),
        (Some("7"), Some("{\"n\":1}"))
    );
    assert_eq!(warnings, ["its 2 layers, b, a, become one; --layer names one"]);
    let open = |layer| {
        let beside = Beside { name: "", resources: &NoResources, layer: Some(layer) };
        Reader::with(GeoFormat::TopoJson, TOPOLOGY.as_bytes(), &beside)
    };
    let mut reader = open("a").expect("a reader");
    assert_eq!(
        reader.members(),
        [Member { name: "\"about\"".to_owned(), value: "{\"x\":1}".to_owned() }]
    );
    assert!(
        reader.next_feature().expect("read").is_some()
            && reader.next_feature().expect("read").is_none()
    );
    assert!(open("c").err().expect("none").to_string().contains("no layer c; it has b, a"));
    for (from, to, messages) in [
        (
            "[[0,1]]",
            "[[0,9]]",
            "line 3, column 60, feature 1 (id 7): there is no arc of this number: there are 3",
        ),
        ("[[0,1]]", "[[0,0.5]]", "no arc of this number"),
        (
            "\"arcs\":[[[0,0]",
            "\"arcs\":[[[0]",
            "line 5, column 10: a position needs at least two numbers",
        ),
        ("\"scale\":", "\"skale\":", "needs scale and translate"),
    ] {
        let refusal = error(TOPOLOGY.replacen(from, to, 1).as_bytes(), "");
        assert!(refusal.contains(messages), "{refusal}");
    }
}

#[test]
fn written_topologies_share_arcs() {
    let (features, _) = read(
        b"POLYGON ((0 0, 1 0, 1 1, 0 1, 0 0))\nPOLYGON ((1 0, 2 0, 2 1, 1 1, 1 0))\nLINESTRING (1 0, 1 1)",
        "a.wkt",
    );
    let text = String::from_utf8(write(GeoFormat::TopoJson, &features)).expect("text");
    assert!(text.contains("{\"type\":\"Polygon\",\"arcs\":[[0,1]]}"), "{text}");
    assert!(text.contains("{\"type\":\"Polygon\",\"arcs\":[[2,-1]]}"), "{text}");
    assert!(text.contains("{\"type\":\"LineString\",\"arcs\":[0]}"), "{text}");
    assert!(text.contains("\"arcs\":[\n[[1,0],[1,1]],"), "{text}");
}

#[test]
fn an_arc_that_is_reported_very_often_is_refused() {
    let arc = vec!["[0,0]"; 12_000].join(",");
    let many = vec!["0"; 10_000].join(",");
    let lines = format!("{{\"type\":\"LineString\",\"arcs\":[{many}]}}");
    let text = format!(
        "{{\"type\":\"Topology\",\"arcs\":[[{arc}]],\"objects\":{{\"a\":{{\"type\":\"GeometryCollection\",\"geometries\":[{lines}]}}}}}}"
    );
    assert!(error(text.as_bytes(), "").contains(", above the limit of 100000000"));
}

#[test]
fn flatgeobuf_keeps_dimensions_and_the_coordinate_system() {
    let (features, _) =
        read(b"LINESTRING ZM (1 2 3 4, 5 6 7 8)\nPOINT M (1 2 9)\nPOINT EMPTY", "a.wkt");
    let mut writer = Writer::new(GeoFormat::FlatGeobuf, Vec::new());
    writer.set_system(System::of_code(2154));
    features.iter().for_each(|feature| writer.write(feature).expect("memory"));
    let bytes = writer.finish(&[]).expect("memory");
    let mut reader = Reader::new(GeoFormat::FlatGeobuf, &bytes[..]).expect("a reader");
    assert_eq!(reader.system().code, Some(2154));
    let first = reader.next_feature().expect("read").expect("a feature");
    assert_eq!((first.srid, &first.geometry), (Some(2154), &features[0].geometry));
    let dimensions = first.geometry.map(|g| g.dimensions());
    assert_eq!(dimensions, Some(Dimensions::Xyzm));
    let second = reader.next_feature().expect("read").expect("a feature");
    assert_eq!(second.geometry, features[1].geometry);
    // If the file is cut short, the features before the end are read, with a warning.
    let (features, warnings) = read(&bytes[..bytes.len() - 9], "");
    assert_eq!((features.len(), warnings.len()), (2, 1), "{warnings:?}");
    assert!(warnings[0].contains("ends within a feature"));
    assert!(error(&bytes[..60], "").contains("ends within its header"));
}

#[test]
fn flatgeobuf_is_indexed_and_read_by_it() {
    let points: String = (0..400).map(|i| format!("POINT ({} {})\n", i % 20, i / 20)).collect();
    let (mut features, _) = read(format!("{points}POINT EMPTY").as_bytes(), "a.wkt");
    features.push(Feature::default());
    let bytes = write(GeoFormat::FlatGeobuf, &features);
    let (all, warnings) = read(&bytes, "");
    assert_eq!((all.len(), warnings.len()), (402, 0));
    assert_eq!(write(GeoFormat::FlatGeobuf, &all), bytes);
    let window = Rect::around([DVec2::new(2.5, 3.0), DVec2::new(5.0, 4.5)]).expect("a window");
    let mut reader = Reader::new(GeoFormat::FlatGeobuf, &bytes[..]).expect("a reader");
    reader.choose(&window);
    let mut found = Vec::new();
    while let Some(feature) = reader.next_feature().expect("read") {
        found.push(feature);
    }
    let text = wkt(&found);
    let mut lines: Vec<&str> = text.lines().collect();
    lines.sort_unstable();
    assert_eq!(
        lines,
        ["POINT (3 3)", "POINT (3 4)", "POINT (4 3)", "POINT (4 4)", "POINT (5 3)", "POINT (5 4)"]
    );
    // No index without features; otherwise one with a root.
    assert_eq!(read(&write(GeoFormat::FlatGeobuf, &[]), "").0, []);
    let (one, _) = read(&write(GeoFormat::FlatGeobuf, &features[..1]), "");
    assert_eq!(one.len(), 1);
}

const KML: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<kml xmlns="http://www.opengis.net/kml/2.2" xmlns:gx="http://www.google.com/kml/ext/2.2"><Document><Folder>
<Placemark id="a"><name>A &amp; B</name><description><![CDATA[<b>x</b>]]></description>
 <ExtendedData><Data name="n"><value>5</value></Data><SchemaData><SimpleData name="s">t</SimpleData></SchemaData></ExtendedData>
 <Polygon><outerBoundaryIs><LinearRing><coordinates>0,0,1 4,0,1
   4,4,1 0,0,1</coordinates></LinearRing></outerBoundaryIs><innerBoundaryIs><LinearRing><coordinates>2,1,1 3,1,1 3,2,1 2,1,1</coordinates></LinearRing></innerBoundaryIs></Polygon></Placemark>
<Placemark><MultiGeometry><LineString><coordinates>0, 0 1, 1</coordinates></LineString><LineString><coordinates>2,2 3,3</coordinates></LineString></MultiGeometry></Placemark>
<Placemark><gx:Track><when>2020-01-01T00:00:00Z</when><when>2020-01-01T00:00:01Z</when><gx:coord>1 2 3</gx:coord><gx:coord>4 5 6</gx:coord></gx:Track></Placemark>
<Placemark><Point><coordinates>7,8</coordinates></Point></Placemark>
</Folder><GroundOverlay/><NetworkLink/></Document></kml>"#;

#[test]
fn placemarks_of_kml_are_features() {
    let (features, warnings) = read(KML.as_bytes(), "");
    assert_eq!(
        wkt(&features).replace("SRID=4326;", ""),
        "POLYGON Z ((0 0 1, 4 0 1, 4 4 1, 0 0 1), (2 1 1, 3 1 1, 3 2 1, 2 1 1))
MULTILINESTRING ((0 0, 1 1), (2 2, 3 3))\nLINESTRING Z (1 2 3, 4 5 6)\nPOINT (7 8)\n"
    );
    let first = &features[0];
    assert_eq!(first.id.as_deref(), Some("\"a\""));
    assert_eq!(
        first.properties.as_deref(),
        Some(r#"{"name":"A & B","description":"<b>x</b>","n":"5","s":"t"}"#)
    );
    assert_eq!(
        warnings,
        [
            "line 10, column 10: 2 overlays and links to other files are left out",
            "line 8, column 12, feature 3: 2 moments of tracks are left out; the places are kept"
        ]
    );
}

const GPX: &str = r#"<?xml version="1.0"?><gpx version="1.1" xmlns="http://www.topografix.com/GPX/1/1"><metadata/>
<wpt lat="48.5" lon="9"><ele>510.5</ele><name>Hut</name><sym>Lodge</sym></wpt>
<rte><name>R</name><rtept lat="1" lon="2"/><rtept lat="3" lon="4"/></rte>
<trk><name>T</name><number>3</number><trkseg><trkpt lat="1" lon="2"><ele>5</ele><time>2020</time></trkpt><trkpt lat="3" lon="4"><ele>6</ele></trkpt></trkseg>
<trkseg><trkpt lat="5" lon="6"/><trkpt lat="7" lon="x"/><trkpt lat="7" lon="8"/></trkseg></trk></gpx>"#;

#[test]
fn waypoints_routes_and_tracks_of_gpx_are_features() {
    let (features, warnings) = read(GPX.as_bytes(), "");
    assert_eq!(
        wkt(&features).replace("SRID=4326;", ""),
        "POINT Z (9 48.5 510.5)\nLINESTRING (2 1, 4 3)\nMULTILINESTRING Z ((2 1 5, 4 3 6), (6 5, 8 7))\n"
    );
    let properties: Vec<&str> = features.iter().filter_map(|f| f.properties.as_deref()).collect();
    assert_eq!(
        properties,
        [
            r#"{"gpx":"waypoint","name":"Hut","sym":"Lodge"}"#,
            r#"{"gpx":"route","name":"R"}"#,
            r#"{"gpx":"track","name":"T","number":3}"#
        ]
    );
    assert_eq!(warnings.len(), 2, "{warnings:?}");
    let messages =
        Writer::new(GeoFormat::Gpx, Vec::new()).write(&features[0]).expect_err("only read");
    assert!(messages.to_string().contains("only read"));
}

#[test]
fn members_of_geometries_are_kept() {
    let text = r#"{"type":"Feature","properties":null,"geometry":{"type":"Point","coordinates":[1,2],"accuracy":5,"bbox":[1,2,1,2]}}"#;
    let (features, _) = read(text.as_bytes(), "");
    let out = String::from_utf8(write(GeoFormat::GeoJsonSeq, &features)).expect("text");
    assert!(
        out.contains(r#""geometry":{"type":"Point","coordinates":[1,2],"accuracy":5}"#),
        "{out}"
    );
    let text = r#"{"type":"GeometryCollection","geometries":[{"type":"Point","coordinates":[1,2],"a":1}],"b":{"c":2}}"#;
    let (features, warnings) = read(text.as_bytes(), "");
    let out = String::from_utf8(write(GeoFormat::GeoJsonSeq, &features)).expect("text");
    assert!(out.contains(r#"[1,2]}],"b":{"c":2}}"#), "{out}");
    assert!(warnings[0].contains("1 member of a geometry within a collection"), "{warnings:?}");
}

#[test]
fn fields_have_kinds_and_examples() {
    let (features, _) = read(ALL_KINDS.as_bytes(), "");
    let schema = Schema::of(&features);
    let kinds: Vec<_> =
        schema.columns().iter().map(|f| (f.key.as_str(), f.kind, f.filled)).collect();
    assert_eq!(
        kinds,
        [
            ("n", FieldKind::Integer, 2),
            ("x", FieldKind::Number, 2),
            ("t", FieldKind::Text, 6),
            ("b", FieldKind::Boolean, 1),
            ("d", FieldKind::Date, 1),
            ("j", FieldKind::Json, 1),
            ("e", FieldKind::Null, 0)
        ]
    );
    assert_eq!(schema.columns()[2].examples, [r#""ä, \"b\"\nc""#, "\"x\"", "\"y\""]);
}

#[test]
fn foreign_formats_are_named() {
    for (bytes, messages) in [
        (&b"SQLite format 3\0rest"[..], "an SQLite database that is not a GeoPackage"),
        (b"PK\x03\x04", "a ZIP archive, such as a packed Shapefile"),
        (b"II*\0", "GeoTIFF"),
        (b"<osm version=\"0.6\">", "OpenStreetMap XML"),
        (b"<?xml version=\"1.0\"?><wfs:FeatureCollection>", "GML"),
        (b"", "the file is empty"),
        (b"what", "not a known format"),
    ] {
        let message = error(bytes, "a.bin");
        assert!(
            message.contains(messages) && message.contains("GeoPackage, Shapefile"),
            "{message}"
        );
    }
    // A file's name does not decide its format.
    assert!(error(b"PK\x03\x04", "").contains("ZIP"));
}

#[test]
fn empty_layers_can_be_written() {
    for format in GeoFormat::ALL.into_iter().filter(|f| f.is_written() && *f != GeoFormat::Svg) {
        let bytes = write(format, &[]);
        let mut reader =
            Reader::new(format, &bytes[..]).unwrap_or_else(|e| panic!("{format}: {e}"));
        assert_eq!(reader.next_feature().expect("read"), None, "{format}");
    }
}

#[test]
fn a_point_is_a_point_in_every_format() {
    let (features, _) = read(b"POINT (1.1 2.2)", "a.wkt");
    for format in GeoFormat::ALL.into_iter().filter(|f| f.is_written() && *f != GeoFormat::Svg) {
        let bytes = write(format, &features);
        let mut reader = Reader::new(format, &bytes[..]).expect("a reader");
        let point = reader.next_feature().expect("read").expect("a feature").geometry;
        assert!(matches!(&point, Some(Geometry::Point(p)) if p.len() == 1), "{format}");
        assert_eq!(point, features[0].geometry, "{format}");
    }
}
