//! `durer clip --cells`: a layer cut by the cells of another.

use crate::harness::Folder;
use serde_json::{Value, json};

/// Returns a polygon of many points, a neighbour of few, a line and two points.
fn layer() -> String {
    let jagged: Vec<String> = (0..80)
        .map(|i| format!("[{},{}]", -f64::from(i % 3) * 0.3, 9.9 - 0.123 * f64::from(i)))
        .collect();
    let many = format!("[[0,0],[10,0],[10,10],[0,10],{},[0,0]]", jagged.join(","));
    let feature = |kind: &str, coordinates: &str, name: &str| {
        format!(
            r#"{{"type":"Feature","properties":{{"name":"{name}"}},"geometry":{{"type":"{kind}","coordinates":{coordinates}}}}}"#
        )
    };
    [
        feature("Polygon", &format!("[{many}]"), "many"),
        feature("Polygon", "[[[10,0],[20,1],[20,9],[10,10],[10,0]]]", "few"),
        feature("LineString", "[[1,1],[19,8]]", "way"),
        feature("MultiPoint", "[[1,1],[100,100]]", "trees"),
    ]
    .join("\n")
}

/// Four cells around a point; the last one has no fields of its own.
const CELLS: &str = r#"{"type":"Feature","properties":{"name":"A","row":1},"geometry":{"type":"Polygon","coordinates":[[[-5,-5],[8,-6],[7.3,5.1],[-6,4.7],[-5,-5]]]}}
{"type":"Feature","properties":{"name":"B","row":1},"geometry":{"type":"Polygon","coordinates":[[[8,-6],[25,-4],[26,6.2],[7.3,5.1],[8,-6]]]}}
{"type":"Feature","properties":{"name":"C","row":2},"geometry":{"type":"Polygon","coordinates":[[[7.3,5.1],[26,6.2],[24,15],[6.9,16],[7.3,5.1]]]}}
{"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[-6,4.7],[7.3,5.1],[6.9,16],[-4,14],[-6,4.7]]]}}
"#;

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("in.geojsonl", layer());
    folder.write("cells.geojsonl", CELLS);
    folder
}

fn features(folder: &Folder, name: &str) -> Vec<Value> {
    let text = String::from_utf8(folder.read(name)).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn pieces_know_their_cells_and_are_a_coverage() {
    let folder = folder();
    let report =
        folder.must("clip in.geojsonl --cells cells.geojsonl -o out.geojsonl --json").json();
    let area = |side: &str| report[side]["area"].as_f64().unwrap();
    assert!((area("in") - area("out")).abs() < 1e-10, "{report}");
    assert_eq!((&report["snapped"], &report["repaired"]), (&json!(0), &json!(0)));
    let found = features(&folder, "out.geojsonl");
    let printed: Vec<&Value> = found.iter().map(|feature| &feature["properties"]).collect();
    let named =
        |name: &str, cell: &str, row: u64| json!({"name": name, "cell_name": cell, "row": row});
    let mut expected = vec![named("many", "A", 1), named("many", "B", 1), named("many", "C", 2)];
    expected.push(json!({"name": "many", "cell": 4}));
    expected.extend([named("few", "B", 1), named("few", "C", 2)]);
    expected.extend([named("way", "A", 1), named("way", "B", 1), named("way", "C", 2)]);
    expected.push(named("trees", "A", 1));
    assert_eq!(printed, expected.iter().collect::<Vec<_>>());
    folder.must("check out.geojsonl --coverage");
    // The square with many vertices is cut in the opposite direction from the one with few.
    let ring = |k: usize| found[k]["geometry"]["coordinates"][0].as_array().unwrap().clone();
    let shared: Vec<Value> =
        ring(1).into_iter().filter(|p| p[0] == 10.0 && ring(4).contains(p)).collect();
    assert_eq!(shared.len(), 2, "{:?} {:?}", ring(1), ring(4));
    // The result is the same as with the cell alone.
    folder.write("a.geojsonl", CELLS.lines().next().unwrap());
    folder.must("clip in.geojsonl --by a.geojsonl -o a.out.geojsonl");
    let alone = features(&folder, "a.out.geojsonl");
    let sorted = |feature: &Value| {
        let mut ring: Vec<String> = feature["geometry"]["coordinates"][0]
            .as_array()
            .unwrap()
            .iter()
            .map(ToString::to_string)
            .collect();
        ring.sort();
        ring.dedup();
        ring
    };
    assert_eq!(sorted(&found[0]), sorted(&alone[0]));
    // A second cut changes only the fields.
    folder.must("clip out.geojsonl --cells cells.geojsonl --select name -o again.geojsonl");
    let again = features(&folder, "again.geojsonl");
    assert_eq!(again.len(), found.len());
    assert!(found.iter().zip(&again).all(|(a, b)| sorted(a) == sorted(b)));
}

#[test]
fn cells_are_of_polygons_and_go_with_no_other_mask() {
    let folder = folder();
    let cells = "clip in.geojsonl --cells cells.geojsonl -o out.geojsonl";
    for other in ["--window 0,0,1,1", "--by a.geojsonl", "--tiles 3", "--outside", "--op union"] {
        folder.run(&format!("{cells} {other}")).fails(2, "--cells");
    }
    folder.write("way.wkt", "LINESTRING (0 0, 1 1)");
    folder
        .run("clip in.geojsonl --cells way.wkt -o out.geojsonl")
        .fails(1, "there is no polygon to cut with");
    folder.run("clip - --cells - -o out.geojsonl").fails(2, "`-` is given twice");
    folder.write("bow.wkt", "POLYGON ((0 0, 4 4, 4 0, 0 4, 0 0))\nPOINT (1 1)");
    let printed = folder.must("clip in.geojsonl --cells bow.wkt -o out.geojsonl").err;
    assert!(printed.contains("made valid by the even-odd rule"), "{printed}");
    assert!(printed.contains("1 feature encloses nothing and is no cell"), "{printed}");
}

#[test]
fn cells_in_another_system_are_reported() {
    let folder = Folder::new();
    folder.write("a.wkt", "SRID=4326;POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0))\n");
    folder.write("cells.wkt", "SRID=3857;POLYGON ((1 1, 3 1, 3 3, 1 3, 1 1))\n");
    let printed = folder.must("clip a.wkt --cells cells.wkt -o o.wkt").err;
    assert!(printed.contains("3857") && printed.contains("4326"), "{printed}");
}
