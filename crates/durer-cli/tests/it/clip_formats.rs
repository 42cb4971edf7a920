//! `durer clip` as a converter: formats, fields, coordinate systems; and `durer info` of layers.

use crate::harness::Folder;
use std::io::Write;

const PLACES: &str = "name,lon,lat,people\nBern,7.44,46.95,134000\nBasel,7.59,47.56,178000\nOslo,10.75,59.91,709000\n";

const AREAS: &str = r#"{"type":"FeatureCollection","features":[
{"type":"Feature","id":1,"properties":{"use":"Forest","size":2.5},"geometry":{"type":"Polygon","coordinates":[[[8,47],[9,47],[9,48],[8,47]]]}},
{"type":"Feature","id":2,"properties":{"use":"field","size":10},"geometry":{"type":"Polygon","coordinates":[[[9,47],[10,47],[10,48],[9,47]]]}},
{"type":"Feature","id":3,"properties":{"use":null,"size":1},"geometry":{"type":"Polygon","coordinates":[[[8,47],[9,48],[9,47],[10,48],[8,47]]]}}]}"#;

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("places.csv", PLACES);
    folder.write("areas.geojson", AREAS);
    folder
}

/// Returns a command's standard output.
fn output_of(folder: &Folder, line: &str) -> String {
    String::from_utf8(folder.must(line).out).expect("text")
}

fn text(folder: &Folder, name: &str) -> String {
    String::from_utf8(folder.read(name)).expect("text")
}

#[test]
fn files_are_converted_without_a_mask() {
    let folder = folder();
    for name in ["o.fgb", "o.gpkg", "o.shp", "o.topojson", "o.csv", "o.geojsonl"] {
        assert_eq!(folder.must(&format!("clip areas.geojson -o {name}")).err, "", "{name}");
        folder.must(&format!("clip {name} -o back.wkt"));
        let back = text(&folder, "back.wkt").replace("SRID=4326;", "");
        assert_eq!(back.lines().count(), 3, "{name}");
        assert!(back.contains("POLYGON ((8 47, 9 "), "{name}: {back}");
    }
    // Shapefiles have outer rings clockwise, and GeoJSON counter-clockwise.
    folder.must("clip o.shp -o turned.wkt");
    assert!(text(&folder, "turned.wkt").contains("POLYGON ((8 47, 9 48, 9 47, 8 47))"));
    folder.must("clip o.shp -o back.geojson");
    assert!(text(&folder, "back.geojson").contains("[[[8,47],[9,47],[9,48],[8,47]]]"));
    assert_eq!(text(&folder, "o.cpg"), "UTF-8");
    assert!(text(&folder, "o.prj").starts_with("GEOGCS[\"GCS_WGS_1984\""));
    // An output of the same format without any operation means that the mask was forgotten.
    folder.run("clip areas.geojson -o a.geojson").fails(2, "nothing to clip with");
    folder.run("clip areas.geojson -o a.kml").fails(2, "kml is only read");
    folder.run("clip areas.geojson --to shapefile -o -").fails(2, "several files");
    folder.run("clip areas.geojson --outside -o a.wkt").fails(2, "nothing to clip with");
}

#[test]
fn compressed_files_are_read_as_they_are() {
    let folder = folder();
    let write = |name: &str, text: &str| {
        let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        packed.write_all(text.as_bytes()).expect("memory");
        folder.write(name, packed.finish().expect("memory"));
    };
    write("places.csv.gz", PLACES);
    folder.must("clip places.csv.gz --window 7,46,8,48 -o o.wkt");
    assert_eq!(text(&folder, "o.wkt"), "POINT (7.44 46.95)\nPOINT (7.59 47.56)\n");
    assert!(output_of(&folder, "info places.csv.gz").contains("3 Point"));
    folder.must("draw places.csv.gz --label name -o o.png");
    write("one.obj.gz", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert!(output_of(&folder, "info one.obj.gz").contains("triangles   1"));
    folder.must("render one.obj.gz -o o.png --size 16x16");
    write("long.obj.gz", &"v 0 0 0\n".repeat(1000));
    folder
        .run("render long.obj.gz -o o.png --max-bytes 7999")
        .fails(1, "the size without compression is 8000, above the limit of 7999");
    write("hill.asc.gz", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n");
    folder.must("plot hill.asc.gz -o o.svg");
    folder.run("clip one.obj.gz --window 0,0,1,1 -o o.wkt").fails(1, "this is OBJ, a model");
}

#[test]
fn features_with_a_property_of_gltf_are_map_data() {
    let folder = folder();
    folder.write(
        "pumps.geojson",
        r#"{"type":"Feature","properties":{"asset":"pump"},"geometry":{"type":"Point","coordinates":[1,2]}}"#,
    );
    assert!(output_of(&folder, "info pumps.geojson").contains("1 Point"));
    folder.must("draw pumps.geojson -o o.png");
}

#[test]
fn features_are_chosen_by_their_fields() {
    let folder = folder();
    for (options, count) in [
        ("--where use~FOR", 1),
        ("--where size>=2.5", 2),
        ("--where size>=2.5 --where use!=field", 1),
        ("--where use=null", 1),
        ("--where id<3", 2),
    ] {
        let ended = folder.must(&format!("clip areas.geojson {options} -o o.csv --json"));
        assert_eq!(ended.json()["out"]["features"], count, "{options}");
        assert_eq!(ended.json()["unchosen"].as_u64().unwrap_or(0), 3 - count, "{options}");
    }
    folder.must(
        "clip areas.geojson --where use=field --select size,use --rename use=kind -o o.geojsonl",
    );
    assert!(text(&folder, "o.geojsonl").contains(r#""properties":{"size":10,"kind":"field"}"#));
    let ended = folder.must("clip areas.geojson --where usage=field -o o.geojson");
    assert!(
        ended.err.contains("no feature has the field usage; there are size, use"),
        "{}",
        ended.err
    );
    folder.run("clip areas.geojson --where use -o o.geojson").fails(2, "FIELD=VALUE");
}

#[test]
fn coordinates_are_brought_to_another_system() {
    let folder = folder();
    folder.must(
        "clip places.csv --from-crs EPSG:4326 --to-crs EPSG:32632 --window 7,46,8,47 -o o.wkt",
    );
    let line = text(&folder, "o.wkt");
    let numbers = line.trim().strip_prefix("SRID=32632;POINT (").and_then(|l| l.strip_suffix(')'));
    let numbers: Vec<f64> =
        numbers.expect("a point").split(' ').map(|n| n.parse().expect("a number")).collect();
    // pyproj: 381216.6, 5200846.6
    let (x, y) = (numbers[0], numbers[1]);
    assert!((x - 381_287.0).abs() < 200.0 && (y - 5_200_800.0).abs() < 400.0, "{line}");
    folder.must("clip o.wkt --to-crs 4326 -o back.geojson");
    let back = text(&folder, "back.geojson");
    assert!(back.contains("[7.4") && back.contains(",46.9") && !back.contains("crs"), "{back}");
    // GeoJSON in another coordinate system records it, and a message says so.
    let ended = folder.must("clip areas.geojson --to-crs EPSG:3035 -o o.geojson");
    assert!(ended.err.contains("are marked by the older member crs"), "{}", ended.err);
    assert!(text(&folder, "o.geojson").contains("urn:ogc:def:crs:EPSG::3035"));
    // The reader honours it.
    folder.must("clip o.geojson --to-crs EPSG:4326 -o back.geojson");
    let back = text(&folder, "back.geojson");
    let first = back.split("coordinates\":[[[").nth(1).expect("an area").split(']').next();
    let numbers: Vec<f64> =
        first.expect("a position").split(',').map(|n| n.parse().expect("a number")).collect();
    let there = text(&folder, "areas.geojson");
    assert!(!back.contains("crs") && numbers[0].abs() <= 180.0, "{there} {back}");
    folder.must("clip areas.geojson --to-crs EPSG:3857 -o o.fgb");
    assert!(output_of(&folder, "info o.fgb").contains("EPSG:3857"));
    folder
        .run("clip places.csv --to-crs EPSG:3857 -o o.fgb")
        .fails(2, "--from-crs sets the system");
    folder.run("clip places.csv --to-crs mars -o o.fgb").fails(2, "`mars` is not known");
    folder.write("pole.wkt", "SRID=4326;POINT (0 90)\nSRID=4326;POINT (0 9)");
    let ended = folder.must("clip pole.wkt --from-crs 4326 --to-crs 3857 -o o.csv --json");
    assert_eq!(ended.json()["out"]["features"], 1);
    assert!(ended.err.contains("1 feature reaches beyond the area of EPSG:3857"), "{}", ended.err);
}

#[test]
fn info_tells_fields_extent_system_and_validity() {
    let folder = folder();
    let printed = folder.must("info areas.geojson --json").json();
    assert_eq!(printed["features"], 3);
    assert_eq!(printed["geometries"]["Polygon"], 3);
    assert_eq!(printed["extent"], serde_json::json!([8.0, 47.0, 10.0, 48.0]));
    assert_eq!(printed["crs"]["code"], "EPSG:4326");
    assert_eq!((&printed["invalid"], &printed["first_invalid"]), (&1.into(), &3.into()));
    assert_eq!(printed["fields"][0]["name"], "use");
    assert_eq!(
        (&printed["fields"][0]["kind"], &printed["fields"][0]["filled"]),
        (&"text".into(), &2.into())
    );
    assert_eq!(printed["fields"][1]["examples"], serde_json::json!([2.5, 10, 1]));
    let text = output_of(&folder, "info areas.geojson places.csv");
    assert!(text.contains("use [text, 2 filled] \"Forest\", \"field\""), "{text}");
    assert!(text.contains("people [integer] 134000, 178000, 709000"), "{text}");
    folder.write("cube.obj", crate::harness::CUBE);
    assert!(output_of(&folder, "info cube.obj").contains("triangles   12"));
    folder.write("cloud.csv", "x,y,z\n1,2,3\n");
    assert!(output_of(&folder, "info cloud.csv").contains("points"), "points of a model");
}

/// Two layers, a table without geometries, a view and tiles.
const LAYERS: &[u8] = include_bytes!("../../../../fuzz/seeds/geopackage/plain.gpkg");

#[test]
fn geopackages_are_read_by_layer_and_written_with_their_system() {
    let folder = folder();
    folder.write("map.gpkg", LAYERS);
    let printed = folder.must("info map.gpkg --json").json();
    let of = |i: usize, key: &str| printed[i][key].clone();
    assert_eq!((of(0, "name"), of(1, "name")), ("Städte".into(), "lines".into()));
    assert_eq!((of(0, "features"), of(1, "features")), (3.into(), 7.into()));
    assert_eq!(printed[0]["crs"]["code"], "EPSG:4326");
    assert_eq!(printed[1]["crs"]["code"], "EPSG:32632");
    assert_eq!(printed[0]["fields"][3]["kind"], "boolean");
    assert!(
        printed[0]["warnings"][0].as_str().is_some_and(|w| w.contains("it is a view")),
        "{printed}"
    );
    assert!(output_of(&folder, "info map.gpkg").contains("map.gpkg, layer lines\n"));
    folder
        .run("clip map.gpkg -o o.geojson")
        .fails(1, "different coordinate systems; --layer names one of Städte (EPSG:4326), lines");
    folder.run("clip map.gpkg --layer seas -o o.geojson").fails(1, "it has Städte, lines, notes");
    folder.must("clip map.gpkg --layer Städte -o o.geojson");
    assert!(text(&folder, "o.geojson").contains("\"id\":3,"), "{}", text(&folder, "o.geojson"));
    folder.write("map.gpkg-wal", b"x");
    folder
        .run("clip map.gpkg --layer lines -o o.wkt")
        .fails(1, "map.gpkg-wal beside it holds changes");
    folder.must("clip areas.geojson --to-crs EPSG:3857 -o new.gpkg");
    let printed = folder.must("info new.gpkg --json").json();
    assert_eq!((&printed["crs"]["code"], &printed["features"]), (&"EPSG:3857".into(), &3.into()));
    assert_eq!(printed["fields"][1]["examples"], serde_json::json!([2.5, 10, 1]));
    let piped = folder.must("clip areas.geojson --to geopackage -o -").out;
    assert!(piped.starts_with(b"SQLite format 3\0"));
    folder.write("piped.gpkg", piped);
    assert_eq!(folder.must("info piped.gpkg --json").json()["extent"][2], 10.0);
}

#[test]
fn older_datums_are_shifted_with_a_word_or_refused() {
    let folder = folder();
    folder.write("os.wkt", "POINT (366930.326448 400483.401903)");
    let ended = folder.must("clip os.wkt --from-crs EPSG:27700 --to-crs EPSG:4326 -o o.csv");
    assert!(ended.err.contains("with OSGB_1936 they may be off by 5 m"), "{}", ended.err);
    // −2.5, 53.5 after the way back, which is accurate to a centimetre.
    let printed = text(&folder, "o.csv");
    assert!(
        printed.contains("POINT (-2.49999998") && printed.contains(" 53.49999999"),
        "{printed}"
    );
    folder
        .run("clip os.wkt --from-crs EPSG:21781 --to-crs EPSG:4326 -o o.csv")
        .fails(2, "is on the datum CH1903, and its shift to WGS 84 is not known here");
}

#[test]
fn foreign_formats_are_named() {
    let folder = folder();
    folder.write("a.gpkg", b"SQLite format 3\0");
    let printed = "a.gpkg: this is an SQLite database that is not a GeoPackage, such as MBTiles or SpatiaLite; export it as GeoJSON";
    folder.run("clip a.gpkg --window 0,0,1,1 -o o.geojson").fails(1, printed);
    folder.run("draw a.gpkg -o o.png").fails(1, printed);
    folder.write("a.geojson", b"PK\x03\x04");
    folder.run("clip a.geojson --window 0,0,1,1 -o o.wkt").fails(1, "the ZIP archive is broken");
}

#[test]
fn one_layer_of_a_topology_is_read() {
    let folder = Folder::new();
    let object = r#"{"type":"Point","coordinates":[1,2]}"#;
    folder.write(
        "t.json",
        format!(r#"{{"type":"Topology","arcs":[],"objects":{{"a":{object},"b":{object}}}}}"#),
    );
    let ended = folder.must("clip t.json -o o.wkt");
    assert!(ended.err.contains("its 2 layers, a, b, become one"), "{}", ended.err);
    assert_eq!(folder.must("clip t.json --layer b -o o.wkt").err, "");
    assert_eq!(text(&folder, "o.wkt"), "POINT (1 2)\n");
    folder.run("clip t.json --layer c -o o.wkt").fails(1, "there is no layer c");
}

#[cfg(not(feature = "geoparquet"))]
#[test]
fn what_this_build_lacks_is_named_with_its_feature() {
    let folder = Folder::new();
    folder.write("a.wkt", "POINT (1 2)");
    folder.run("clip a.wkt -o a.parquet").fails(2, "one with --features geoparquet does");
    folder.write("b.parquet", "PAR1PAR1");
    folder.run("clip b.parquet -o b.geojson").fails(1, "geoparquet");
    assert_eq!(folder.names(), ["a.wkt", "b.parquet"]);
}

/// Point on the Brandenburg Gate in Web Mercator and in degrees, by pyproj.
const MERCATOR: (&str, f64, f64) = ("[1489000,6894000.5]", 13.375914580539675, 52.51617737674441);

#[test]
fn systems_that_geojson_states_are_converted_from() {
    let folder = Folder::new();
    let crs = |code: u32| {
        format!(r#""crs":{{"type":"name","properties":{{"name":"urn:ogc:def:crs:EPSG::{code}"}}}}"#)
    };
    let (place, x, y) = MERCATOR;
    let point = format!(r#"{{"type":"Point","coordinates":{place}}}"#);
    let feature = format!(r#"{{"type":"Feature","properties":{{}},"geometry":{point}}}"#);
    let own = point.replace("\"coordinates\"", &format!("{},\"coordinates\"", crs(3857)));
    let of_all =
        |crs: &str| format!(r#"{{"type":"FeatureCollection",{crs},"features":[{feature}]}}"#);
    folder.write("all.geojson", of_all(&crs(3857)));
    folder.write("own.geojson", &own);
    for name in ["all", "own"] {
        folder.must(&format!("clip {name}.geojson --to-crs EPSG:4326 -o o.geojsonl"));
        let printed = text(&folder, "o.geojsonl");
        let numbers = printed.split("coordinates\":[").nth(1).and_then(|t| t.split(']').next());
        let numbers: Vec<f64> =
            numbers.expect("a point").split(',').map(|n| n.parse().expect("a number")).collect();
        assert!((numbers[0] - x).abs() < 1e-9 && (numbers[1] - y).abs() < 1e-9, "{printed}");
        assert!(!printed.contains("crs"), "{printed}");
        folder.must(&format!("clip {name}.geojson -o o.wkt"));
        assert_eq!(text(&folder, "o.wkt"), "SRID=3857;POINT (1489000 6894000.5)\n");
    }
    // Tiles have their own coordinates.
    folder.must("clip all.geojson --tiles 3 -o o.geojsonl");
    assert!(text(&folder, "o.geojsonl").contains("\"tile\":\"3/4/2\""));
    // A system that comes after the features is too late, unless nothing depends on it.
    let late = format!(r#"{{"type":"FeatureCollection","features":[{feature}],{}}}"#, crs(3857));
    folder.write("late.geojson", &late);
    for line in ["--to-crs EPSG:4326 -o l.geojson", "-o l.shp", "--tiles 3 -o l.geojsonl"] {
        let ended = folder.run(&format!("clip late.geojson {line}"));
        ended.fails(1, "the member crs follows the features");
        assert!(ended.err.contains("--from-crs EPSG:3857"), "{}", ended.err);
    }
    let many = late.replace(&feature, &[&feature[..]; 300].join(","));
    folder.write("many.geojson", many);
    let printed = "durer clip --from-crs EPSG:3857 writes a file that states it";
    folder.run("fix many.geojson -o l.shp").fails(1, printed);
    for command in ["tiles late.geojson -o l.pmtiles", "draw late.geojson --to-crs 3035 -o l.png"] {
        folder.run(command).fails(1, "; --from-crs EPSG:3857 sets their system");
    }
    for name in ["l.shp", "l.geojson", "l.pmtiles", "l.png"] {
        assert!(!folder.path(name).exists(), "{name}");
    }
    folder.must("clip late.geojson --from-crs 3857 --to-crs EPSG:4326 -o l.geojson");
    folder.must("clip late.geojson --window 0,0,9e6,9e6 -o l.geojson");
    assert!(text(&folder, "l.geojson").contains("EPSG::3857"));
    // One that is not known is not guessed.
    folder.write("mine.geojson", of_all(r#""crs":{"type":"name","properties":{"name":"mine"}}"#));
    folder.run("clip mine.geojson --to-crs EPSG:4326 -o o.geojson").fails(2, "--from-crs sets");
    let ended = folder.must("clip mine.geojson -o o.wkt");
    assert!(ended.err.contains("names no known coordinate system"), "{}", ended.err);
    // The mask is not converted.
    folder.write("mask.geojson", r#"{"type":"Polygon","coordinates":[[[0,0],[9,0],[9,9],[0,0]]]}"#);
    let ended = folder.must("clip all.geojson --by mask.geojson -o o.geojson");
    assert!(ended.err.contains("SRID 4326 and not SRID 3857"), "{}", ended.err);
    let ended = folder.must("clip mask.geojson --by mask.geojson -o o.geojson");
    assert_eq!(ended.err, "", "both are longitudes and latitudes");
}

#[test]
fn metres_as_degrees_are_reported() {
    let folder = Folder::new();
    folder.write("far.csv", "x,y\n500000,5400000\n1,2\n");
    let ended = folder.must("clip far.csv -o o.geojson");
    assert!(ended.err.contains("1 feature has coordinates beyond 90 degrees"), "{}", ended.err);
    assert_eq!(folder.must("clip far.csv -o o.wkt").err, "");
    let ended = folder.must("clip far.csv --from-crs EPSG:25832 --where x=1 -o o.geojson");
    assert!(!ended.err.contains("beyond 90 degrees"), "{}", ended.err);
}

#[test]
fn json_of_arcgis_becomes_geojson() {
    let folder = Folder::new();
    folder.write(
        "a.json",
        r#"{"geometryType":"esriGeometryPoint","spatialReference":{"wkid":4326},"features":[{"attributes":{"n":1},"geometry":{"x":8.5,"y":47}}]}"#,
    );
    folder.must("clip a.json -o a.geojson");
    let made: serde_json::Value = serde_json::from_slice(&folder.read("a.geojson")).expect("JSON");
    let feature = &made["features"][0];
    assert_eq!(feature["geometry"]["coordinates"], serde_json::json!([8.5, 47]));
    assert_eq!(feature["properties"]["n"], 1);
    folder.run("clip a.geojson -o b.geojson").fails(2, "nothing to clip with");
}
