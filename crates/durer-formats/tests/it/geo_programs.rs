//! Map data as other programs write them: systems of GeoJSON, tables of Excel, fields of KML, tracks, broken features.

use crate::geo_formats::{error, read, wkt, write};
use durer_formats::geo::{GeoFormat, Reader};

#[test]
fn members_state_the_coordinate_systems_of_features() {
    let crs = |name: &str| format!(r#""crs":{{"type":"name","properties":{{"name":"{name}"}}}}"#);
    let feature =
        r#"{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[1,2]}}"#;
    let collection =
        |crs: &str| format!(r#"{{"type":"FeatureCollection",{crs}"features":[{feature}]}}"#);
    // As PostGIS writes a geometry.
    let geometry = |crs: &str| format!(r#"{{"type":"Point",{crs}"coordinates":[1,2]}}"#);
    let utm = crs("EPSG:25832") + ",";
    let system = |text: &str| {
        let mut reader = Reader::new(GeoFormat::GeoJson, text.as_bytes()).expect("a reader");
        let mut srids = Vec::new();
        while let Some(feature) = reader.next_feature().expect("a feature") {
            srids.push(feature.srid);
        }
        (srids, reader.system().code, reader.warnings().len())
    };
    assert_eq!(system(&collection("")), (vec![None], Some(4326), 0));
    assert_eq!(system(&collection(&utm)), (vec![Some(25832)], Some(25832), 0));
    assert_eq!(system(&geometry(&utm)), (vec![Some(25832)], Some(25832), 0));
    let lonlat = crs("urn:ogc:def:crs:OGC:1.3:CRS84") + ",";
    assert_eq!(system(&collection(&lonlat)), (vec![None], Some(4326), 0));
    // Null is no system, without a warning; a name that is not known has one, for all documents together.
    assert_eq!(system(&collection("\"crs\":null,")), (vec![None], None, 0));
    let mine = geometry(&(crs("mine") + ","));
    assert_eq!(system(&format!("{mine}\n{mine}\n")), (vec![None; 2], None, 1));
    let [own, plain] = [geometry(&utm), geometry("")];
    assert_eq!(system(&format!("{own}\n{plain}")), (vec![Some(25832), Some(4326)], None, 0));
    assert_eq!(system(&format!("{plain}\n{own}")), (vec![None, Some(25832)], None, 0));
    let (_, last, _) = system(&format!(
        r#"{{"type":"FeatureCollection","features":[{feature}],{}}}"#,
        crs("EPSG:3857")
    ));
    assert_eq!(last, Some(3857), "after the features");
}

#[test]
fn values_that_json_lacks_are_null_with_a_warning() {
    let text = r#"{"type":"Feature","properties":{"a":NaN,"b":[-Infinity,"NaN \" Infinity"],"c":1},"geometry":null}"#;
    let (features, warnings) = read(text.as_bytes(), "a.geojson");
    let properties = features[0].properties.as_deref();
    assert_eq!(properties, Some(r#"{"a":null,"b":[null,"NaN \" Infinity"],"c":1}"#));
    assert_eq!(
        warnings,
        [
            "line 1, column 32, feature 1: 2 values are NaN or Infinity, which JSON does not have; they are null"
        ]
    );
    let wrong = text.replace("\"c\":1", "\"c\":nan");
    assert!(error(wrong.as_bytes(), "a.geojson").contains("a value is expected"));
}

#[test]
fn heights_that_some_points_of_a_track_have_are_kept() {
    let point = |ele: &str| format!("<trkpt lat='1' lon='2'>{ele}</trkpt>");
    let (some, none) = (point("<ele>7</ele>"), point(""));
    for (points, line) in [
        (format!("{some}{none}"), "MULTILINESTRING Z ((2 1 7, 2 1 0))"),
        (format!("{none}{some}{some}"), "MULTILINESTRING Z ((2 1 0, 2 1 7, 2 1 7))"),
    ] {
        let text = format!("<gpx><trk><trkseg>{points}</trkseg></trk></gpx>");
        let (features, warnings) = read(text.as_bytes(), "a.gpx");
        assert!(wkt(&features).contains(line), "{}", wkt(&features));
        assert!(warnings[0].contains("1 position has a height where others"), "{warnings:?}");
    }
    let kml = "<kml><Placemark><LineString><coordinates>2,1 2,1,7</coordinates></LineString></Placemark></kml>";
    let (features, warnings) = read(kml.as_bytes(), "a.kml");
    assert!(wkt(&features).contains("LINESTRING Z (2 1 0, 2 1 7)"), "{}", wkt(&features));
    assert!(warnings[0].contains("1 position has a height where others"), "{warnings:?}");
}

#[test]
fn fields_of_kml_have_the_types_of_their_schema() {
    let fields = "<SimpleField name='pop' type='int'/><SimpleField name='big' type='bool'/>\
                  <SimpleField name='zip' type='string'/><SimpleField name='two' type='int'/>";
    let data = [("pop", "12"), ("big", "1"), ("zip", "07"), ("two", "3"), ("none", "4")];
    let data = data.map(|(key, value)| format!("<SimpleData name='{key}'>{value}</SimpleData>"));
    let kml = format!(
        "<kml><Document><Schema>{fields}</Schema><Schema><SimpleField name='two' type='string'/></Schema>\
         <Placemark><name>12</name><ExtendedData><SchemaData>{}</SchemaData></ExtendedData></Placemark>\
         <Placemark><ExtendedData><SchemaData><SimpleData name='pop'>many</SimpleData></SchemaData></ExtendedData>\
         </Placemark></Document></kml>",
        data.concat()
    );
    let (features, _) = read(kml.as_bytes(), "a.kml");
    assert_eq!(
        features[0].properties.as_deref(),
        Some(r#"{"name":"12","pop":12,"big":true,"zip":"07","two":"3","none":"4"}"#)
    );
    assert_eq!(features[1].properties.as_deref(), Some(r#"{"pop":"many"}"#));
}

#[test]
fn tables_of_excel_and_columns_with_units_are_read() {
    for text in [
        "sep=;\r\nname;lon;lat\r\na;1,5;2\r\n",
        "sep=\t\nname\tlon\tlat\na\t1.5\t2\n",
        "\u{feff}sep=,\nname,Longitude (deg),Latitude [deg]\na,1.5,2\n",
        "name;Länge;Breite\na;1,5;2\n",
    ] {
        let (features, warnings) = read(text.as_bytes(), "a.csv");
        assert_eq!(wkt(&features), "POINT (1.5 2)\n", "{text}");
        assert_eq!(features[0].properties.as_deref(), Some(r#"{"name":"a"}"#), "{text}");
        assert_eq!(warnings, Vec::<String>::new(), "{text}");
        assert_eq!(GeoFormat::of_content(text.as_bytes()), Some(GeoFormat::Csv), "{text}");
    }
    let wrong = error(b"sep=;\nname;lon\na;1\n", "a.csv");
    assert!(wrong.contains("among name, lon"), "{wrong}");
    let (_, warnings) = read(b"x,y\n1,2\n,\n", "a.csv");
    assert_eq!(
        warnings,
        ["line 3: 1 row has no numbers in the columns of its place; it has no geometry"]
    );
}

#[test]
fn numbers_beyond_64_bits_keep_their_digits() {
    let text = r#"{"type":"Feature","properties":{"cell":12345678901234567890,"far":1e400},"geometry":{"type":"Point","coordinates":[1,2]}}"#;
    let (features, _) = read(text.as_bytes(), "a.geojson");
    for format in [GeoFormat::GeoPackage, GeoFormat::FlatGeobuf, GeoFormat::Csv] {
        let (again, _) = read(&write(format, &features), "");
        let value = |key: &str| {
            let fields = again[0].fields();
            let found = fields.iter().find(|f| f.key() == key).expect("a field").value.clone();
            found.trim_matches('"').to_owned()
        };
        assert_eq!(value("cell"), "12345678901234567890", "{format}");
        assert_eq!(value("far"), "1e400", "{format}");
    }
}

#[test]
fn drawings_and_lists_of_numbers_are_named() {
    for (bytes, name) in [
        (&b"  0\r\nSECTION\r\n  2\r\nHEADER\r\n"[..], "this is a drawing of AutoCAD"),
        (b"AC1032\0\0", "this is a drawing of AutoCAD"),
        (b"AutoCAD Binary DXF\r\n", "this is a drawing of AutoCAD"),
        (b"1 2\n3 4\n", "this is a list of numbers without names; a first line such as x,y"),
        (b"13.4, 52.5\r\n", "this is a list of numbers without names"),
        (b"1\n", "not a known format"),
        (b"one two\n", "not a known format"),
    ] {
        assert!(GeoFormat::foreign(bytes).starts_with(name), "{bytes:?}");
        assert_eq!(GeoFormat::of_content(bytes), None);
    }
}

#[test]
fn other_formats_of_json_are_named() {
    for (text, name) in [
        (
            r#"{"error":{"code":400,"message":"Invalid URL"}}"#,
            "this is not a map but an error from a server: Invalid URL",
        ),
        (
            r#"{"version":0.6,"generator":"Overpass API","elements":[]}"#,
            "this is OpenStreetMap's JSON",
        ),
        (r#"{"a":1}"#, "a GeoJSON object needs the member \"type\""),
    ] {
        assert!(error(text.as_bytes(), "a.json").contains(name), "{text}");
    }
}

#[test]
fn features_that_cannot_be_read_are_left_out_on_request() {
    let good = |x: u32| {
        format!(
            r#"{{"type":"Feature","properties":{{}},"geometry":{{"type":"Point","coordinates":[{x},0]}}}}"#
        )
    };
    let [a, b] = [1, 2].map(good);
    let bad = a.replace("[1,0]", "[1,null]");
    let hex = |x: u8| format!("0101000000000000000000{x:02X}3F0000000000000000");
    let cases = [
        (
            GeoFormat::GeoJson,
            format!(r#"{{"type":"FeatureCollection","features":[{a},{bad},{bad},{b}]}}"#),
            "line 1, column 202, feature 2: 2 features cannot be read and are left out; the first: a number is expected",
        ),
        (
            GeoFormat::GeoJsonSeq,
            format!("{a}\n{bad}\n{{\"type\":\"Nothing\"}}\n{b}\n"),
            "line 2, column 79, feature 2: 2 features",
        ),
        (
            GeoFormat::Csv,
            "WKT\nPOINT (1 0)\nPOINT (1\nPOINT 3\nPOINT (2 0)\n".to_owned(),
            "line 3, feature 2: 2 features",
        ),
        (
            GeoFormat::Wkt,
            "POINT (1 0)\nPOINT (1\n\nPOINT (x 2)\nPOINT (2 0)\n".to_owned(),
            "line 4, column 1, feature 2: 2 features",
        ),
        (
            GeoFormat::WkbHex,
            format!("{}\n01010000\nzz\n{}\n", hex(0xf0), hex(0xf8)),
            "line 2, column 3, feature 2: 2 features",
        ),
    ];
    for (format, text, messages) in cases {
        let mut reader = Reader::new(format, text.as_bytes()).expect("a reader");
        reader.skip_failures();
        let mut count = 0;
        while reader.next_feature().expect("no error").is_some() {
            count += 1;
        }
        let warnings: Vec<String> = reader.warnings().iter().map(ToString::to_string).collect();
        assert_eq!((count, reader.skipped()), (2, 2), "{format}: {warnings:?}");
        assert!(warnings[0].starts_with(messages), "{format}: {warnings:?}");
        assert!(reader.next_feature().expect("the end").is_none());
        assert_eq!(reader.warnings().len(), warnings.len(), "{format}: reported once");
        let mut strict = Reader::new(format, text.as_bytes()).expect("a reader");
        assert!((0..3).any(|_| strict.next_feature().is_err()), "{format}: without the request");
    }
    // Text that is no longer JSON has no features that can be found.
    let cut = format!("{a}\n{}", &bad[..40]);
    let mut reader = Reader::new(GeoFormat::GeoJsonSeq, cut.as_bytes()).expect("a reader");
    reader.skip_failures();
    assert!(reader.next_feature().expect("the first").is_some() && reader.next_feature().is_err());
}

#[test]
fn rows_that_decimal_commas_split_are_refused() {
    let messages = error("name,lon,lat\nA,8.5,47\nB,8,5,47,2\n".as_bytes(), "a.csv");
    let start = "line 3, feature 2: the row has 5 values for 3 columns, as if its numbers had decimal commas";
    assert!(messages.starts_with(start), "{messages}");
    for text in [
        "lon;lat\n8,5;47,2\n",
        "lon,lat\n\"8,5\",\"47,2\"\n",
        "lon\tlat\n8,5\t47,2\n",
        "lon,lat\n8.5,47.2,\n",
    ] {
        let (features, _) = read(text.as_bytes(), "a.csv");
        let bounds = features[0].geometry.as_ref().and_then(|g| g.bounds()).expect("a point");
        assert_eq!(bounds.min().to_array(), [8.5, 47.2], "{text}");
    }
}

#[test]
fn feature_sets_of_arcgis_are_read() {
    let set = |head: &str, features: &str| format!(r#"{{{head}"features":[{features}]}}"#);
    let head = r#""displayFieldName":"n","geometryType":"esriGeometryPolygon","spatialReference":{"wkid":102100,"latestWkid":3857},"#;
    // Two outer rings run clockwise, the hole in the first the other way round.
    let rings = "[[0,0],[0,9],[9,9],[9,0],[0,0]],[[20,0],[20,5],[25,5],[25,0],[20,0]],[[1,1],[2,1],[2,2],[1,2],[1,1]]";
    let two = format!(
        r#"{{"attributes":{{"n":"A","OBJECTID":7}},"geometry":{{"rings":[{rings}]}}}},{{"attributes":{{"n":"B"}},"geometry":null}}"#
    );
    let (features, warnings) = read(set(head, &two).as_bytes(), "a.json");
    assert_eq!((features.len(), warnings), (2, vec![]));
    assert_eq!((features[0].srid, &features[1].geometry), (Some(3857), &None));
    assert_eq!(features[0].properties.as_deref(), Some(r#"{"n":"A","OBJECTID":7}"#));
    let text = wkt(&features[..1]);
    let first = "((0 0, 0 9, 9 9, 9 0, 0 0), (1 1, 2 1, 2 2, 1 2, 1 1))";
    let second = "((20 0, 20 5, 25 5, 25 0, 20 0))";
    assert!(text.contains(&format!("MULTIPOLYGON ({first}, {second})")), "{text}");
    let mut reader =
        Reader::new(GeoFormat::GeoJson, set(head, &two).leak().as_bytes()).expect("a reader");
    reader.next_feature().expect("a feature");
    assert_eq!(reader.system().code, Some(3857));

    for (geometry, expected) in [
        (r#"{"x":1,"y":2.5}"#, "POINT (1 2.5)"),
        (r#"{"x":1,"y":2,"z":3,"m":4}"#, "POINT ZM (1 2 3 4)"),
        (r#"{"x":"NaN","y":"NaN"}"#, "POINT EMPTY"),
        (r#"{"points":[[1,2],[3,4]]}"#, "MULTIPOINT (1 2, 3 4)"),
        (r#"{"paths":[[[1,2],[3,4]]]}"#, "LINESTRING (1 2, 3 4)"),
        (r#"{"hasM":true,"paths":[[[1,2,9],[3,4,8]]]}"#, "LINESTRING M (1 2 9, 3 4 8)"),
        (
            r#"{"hasZ":true,"hasM":true,"paths":[[[1,2,5,9],[3,4,5,8]]]}"#,
            "LINESTRING ZM (1 2 5 9, 3 4 5 8)",
        ),
        (r#"{"paths":[[[1,2],[3,4]],[[5,6],[7,8]]]}"#, "MULTILINESTRING ((1 2, 3 4), (5 6, 7 8))"),
        (
            r#"{"rings":[[[0,0],[0,1],[1,1],[0,0]]],"spatialReference":{"wkid":4326}}"#,
            "POLYGON ((0 0, 0 1, 1 1, 0 0))",
        ),
        (r#"{"xmin":0,"ymin":1,"xmax":2,"ymax":3}"#, "POLYGON ((0 1, 2 1, 2 3, 0 3, 0 1))"),
    ] {
        let (features, _) = read(geometry.as_bytes(), "a.json");
        assert!(wkt(&features).contains(expected), "{geometry}: {}", wkt(&features));
    }
    let points = r#"{"attributes":{"name":"Bern"},"geometry":{"x":1,"y":true}}"#;
    let messages = error(set(head, points).as_bytes(), "a.json");
    assert!(messages.contains("feature 1 (name Bern): a finite number is expected"), "{messages}");
    let curve = r#"{"geometry":{"curveRings":[]}}"#;
    assert!(error(set(head, curve).as_bytes(), "a.json").contains("returnTrueCurves=false"));
    let cut = set(head, "").replace("}", "").replace("]", "],\"exceededTransferLimit\":true}");
    let cut = cut.replace("3857,", "3857},");
    let (features, warnings) = read(cut.as_bytes(), "a.json");
    assert!(features.is_empty() && warnings[0].contains("resultOffset"), "{warnings:?}");
    // A set without a system has an unknown one, unlike GeoJSON.
    let bare = set(r#""geometryType":"esriGeometryPoint","#, r#"{"geometry":{"x":1,"y":2}}"#);
    let mut reader = Reader::new(GeoFormat::GeoJson, bare.as_bytes()).expect("a reader");
    reader.next_feature().expect("a feature");
    assert!(reader.system().is_unknown());
}
