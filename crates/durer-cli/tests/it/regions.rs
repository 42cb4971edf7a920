//! `durer buffer`, `dissolve`, `fix` and `check` on small files.

use crate::harness::Folder;
use serde_json::Value;

/// A layer with a bow tie, two neighbours with the same border, and one that overlaps the second.
const LAYER: &str = r#"{"type":"FeatureCollection","features":[
{"type":"Feature","properties":{"use":"farm","n":1},"geometry":{"type":"Polygon","coordinates":[[[20,0],[24,4],[24,0],[20,4],[20,0]]]}},
{"type":"Feature","properties":{"use":"farm","n":2},"geometry":{"type":"Polygon","coordinates":[[[0,0,7],[4,0,7],[4,4,7],[0,4,7],[0,0,7]]]}},
{"type":"Feature","properties":{"use":"wood","n":3},"geometry":{"type":"Polygon","coordinates":[[[4,0],[8,0],[8,4],[4,4],[4,0]]]}},
{"type":"Feature","properties":{"use":"farm","n":4},"geometry":{"type":"Polygon","coordinates":[[[7,1],[9,1],[9,3],[7,3],[7,1]]]}},
{"type":"Feature","properties":{"n":5},"geometry":{"type":"LineString","coordinates":[[0,0],[10,0]]}}]}"#;

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("in.geojson", LAYER);
    folder
}

fn features(folder: &Folder, name: &str) -> Vec<Value> {
    let whole: Value = serde_json::from_slice(&folder.read(name)).unwrap();
    whole["features"].as_array().unwrap().clone()
}

#[test]
fn buffers_have_the_area_that_they_should() {
    let folder = folder();
    let miter = "buffer in.geojson --where n=2 --distance 1 --join miter -o out.geojson --json";
    let report = folder.must(miter).json();
    assert_eq!(report["out"]["area"], 36.0);
    let shrunk = "buffer in.geojson --where n=2 --distance=-1 -o out.geojson --json";
    assert_eq!(folder.must(shrunk).json()["out"]["area"], 4.0);
    let gone = "buffer in.geojson --where n=2 --distance=-2 -o out.geojson --json";
    let gone = folder.must(gone);
    assert_eq!(gone.json()["out"]["features"], 0);
    assert!(gone.err.contains("1 feature has nothing left and is left out"), "{}", gone.err);
    let line = "buffer in.geojson --where n=5 --distance 2 --cap butt -o out.geojson --json";
    assert_eq!(folder.must(line).json()["out"]["area"], 40.0);
    assert_eq!(features(&folder, "out.geojson")[0]["properties"]["n"], 5);
    let all = "buffer in.geojson --where n>1 --distance 0 --dissolve -o out.geojson --json";
    let all = folder.must(all);
    assert_eq!(all.json()["out"]["area"], 34.0);
    assert!(all.err.contains("coordinates are degrees"), "{}", all.err);
}

#[test]
fn features_with_one_value_become_one() {
    let folder = folder();
    let printed = folder.must("dissolve in.geojson --by use -o out.geojson --json");
    let found = features(&folder, "out.geojson");
    let properties: Vec<String> = found.iter().map(|f| f["properties"].to_string()).collect();
    let expected =
        [r#"{"count":3,"use":"farm"}"#, r#"{"count":1,"use":"wood"}"#, r#"{"count":1,"use":null}"#];
    assert_eq!(properties, expected);
    assert_eq!(found[0]["geometry"]["coordinates"].as_array().map(Vec::len), Some(4));
    assert_eq!(found[2]["geometry"]["type"], "LineString");
    assert_eq!(printed.json()["out"]["area"], 8.0 + 16.0 + 4.0 + 16.0);
    assert!(printed.err.contains("1 feature is not valid"), "{}", printed.err);
    let printed = folder.must("dissolve in.geojson --by owner -o out.geojson --json");
    assert!(printed.err.contains("no feature has the field owner"), "{}", printed.err);
    assert!(printed.err.contains("some features have and others lack"), "{}", printed.err);
    assert_eq!(
        features(&folder, "out.geojson")[0]["geometry"]["geometries"][0]["coordinates"][0][0][0][2],
        7
    );
    // One feature of all polygons and the line; overlaps count once.
    assert_eq!(printed.json()["out"]["area"], 8.0 + 34.0);
}

#[test]
fn what_is_not_valid_is_made_so_and_the_rest_stays() {
    let folder = folder();
    let printed = folder.must("fix in.geojson -o out.geojson --json");
    assert_eq!(printed.json()["repaired"], 1);
    assert!(printed.err.contains("feature 1 is the first that was repaired"), "{}", printed.err);
    let (given, found) = (features(&folder, "in.geojson"), features(&folder, "out.geojson"));
    assert_eq!(found[1..], given[1..]);
    assert_eq!(found[0]["geometry"]["type"], "MultiPolygon");
    let positive = "fix in.geojson --rule positive --where n=1 -o out.geojson --json";
    assert_eq!(folder.must(positive).json()["out"]["area"], 4.0);
    let sound = folder.run("check out.geojson").out;
    assert!(String::from_utf8_lossy(&sound).contains("nothing is wrong"));
}

#[test]
fn faults_are_reported_with_their_places() {
    let folder = folder();
    let ended = folder.run("check in.geojson --coverage");
    assert_eq!(ended.code, 1);
    let out = String::from_utf8_lossy(&ended.out);
    let lines: Vec<&str> = out.lines().collect();
    let expected = [
        "feature 1: edges cross at 22 2",
        "features 3 and 4: two features overlap at 8 1",
        "features 3 and 4: two features overlap at 8 3",
    ];
    assert_eq!(lines, expected);
    let report = folder.run("check in.geojson --coverage --json --most 1").json();
    assert_eq!((&report["valid"], &report["invalid"]), (&Value::Bool(false), &1.into()));
    assert_eq!(report["counts"].to_string(), r#"{"crossing":1,"overlap":2}"#);
    assert_eq!(
        report["faults"].to_string(),
        r#"[{"at":[22.0,2.0],"fault":"crossing","feature":1}]"#
    );
    let good = r#"{"type":"Polygon","coordinates":[[[0,0],[4,0],[4,4],[0,0]]]}"#;
    folder.write("good.geojson", good);
    let ended = folder.must("check good.geojson --coverage --gap-width 1");
    assert_eq!(ended.out, b"good.geojson: 1 feature, nothing is wrong\n");
    assert_eq!(folder.run("check good.geojson --gap-width 1").code, 2);
    // Repairs while reading are reported as faults.
    let open =
        r#"{"type":"Polygon","coordinates":[[[0,0],[4,0],[4,4]],[[1,1],[2,1],[1,1],[1,1]]]}"#;
    folder.write("open.geojson", open);
    folder.run("check open.geojson").fails(1, "reading");
}

/// Three countries of Natural Earth's map 1:110 million where they meet: the first has a spike along the border of the
/// second, which ends some ulp beside that; the second has no point where the first and the third meet on its border.
const MEETING: &str = r#"{"type":"FeatureCollection","features":[
{"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[34.25745,10.63009],[33.96162,9.58358],[33.97498,8.68456],[33.963392794971185,9.464285229420625],[33.82496348090751,9.484060845715362],[33.84213085302815,9.981914637215993],[33.72195924818311,10.325262079630193],[33.2,12],[34.5,12],[34.25745,10.63009]]]}},
{"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[34.25745,10.63009,1],[33.96162,9.58358,2],[33.97498,8.68456,3],[33.8255,8.37916,4],[40,8,5],[40,10,6],[34.25745,10.63009,1]]]}},
{"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[33.72195924818311,10.325262079630193],[33.84213085302815,9.981914637215993],[33.82496348090751,9.484060845715362],[33.963392794971185,9.464285229420625],[33.97498,8.68456],[33.8255,8.37916],[32,8],[32,10],[33.72195924818311,10.325262079630193]]]}}]}"#;

#[test]
fn neighbours_get_the_points_that_they_lack_and_stay_a_coverage_when_cut() {
    let folder = Folder::new();
    folder.write("in.geojson", MEETING);
    folder.write("mask.wkt", "POLYGON ((33 8.2, 36 8.6, 35 11, 32.5 9.5, 33 8.2))");
    folder.run("check in.geojson --coverage").fails(1, "not valid");
    let printed = folder.must("fix in.geojson --coverage -o out.geojson --json");
    assert!(
        printed.err.contains("1 feature got points that their neighbours have"),
        "{}",
        printed.err
    );
    assert_eq!(printed.json()["repaired"], 1);
    // All three have the vertex now; the second has an interpolated height there.
    let out = String::from_utf8(folder.read("out.geojson")).unwrap();
    let parts: Vec<&str> = out.split("[33.963392794971185,9.464285229420625").collect();
    assert_eq!(parts.len(), 4, "{out}");
    assert!(
        parts[1].starts_with(']') && parts[2].starts_with(",2.13") && parts[3].starts_with(']')
    );
    folder.must("check out.geojson --coverage");
    for side in ["", " --outside"] {
        folder.must(&format!("clip out.geojson --by mask.wkt{side} -o cut.geojson"));
        folder.must("check cut.geojson --coverage");
    }
    // Valid geometry stays unchanged.
    let again = folder.must("fix out.geojson --coverage -o again.geojson");
    assert!(!again.err.contains("points that"), "{}", again.err);
    assert_eq!(folder.read("out.geojson"), folder.read("again.geojson"));
}

#[test]
fn broken_features_are_faults_or_left_out() {
    let folder = Folder::new();
    folder.write("a.csv", "id,WKT\n1,POINT (1 2)\n2,POINT (1\n3,POINT (3\n4,POINT (5 6)\n");
    folder.run("clip a.csv -o o.geojson").fails(1, "a.csv: line 3, feature 2: ");
    assert!(!folder.path("o.geojson").exists());
    let printed =
        "a.csv: line 3, feature 2: 2 features cannot be read and are left out; the first: ";
    for command in ["clip a.csv", "fix a.csv", "tiles a.csv --zoom 0"] {
        let out = if command.starts_with("tiles") { "o.pmtiles" } else { "o.geojson" };
        let ended = folder.run(&format!("{command} -o {out} --skip-failures"));
        ended.fails(3, printed);
        assert!(folder.path(out).exists(), "{command}");
    }
    let text = String::from_utf8(folder.read("o.geojson")).expect("text");
    assert_eq!(text.matches("\"Feature\"").count(), 2, "{text}");
    // Without another change, too.
    folder.run("clip a.csv -o o.csv --skip-failures").fails(3, printed);
    folder.run("clip a.csv -o o.csv").fails(2, "--skip-failures");
    let checked = folder.run("check a.csv --json");
    checked.fails(1, "2 reading");
    assert_eq!(checked.json()["counts"]["reading"], 2);
}

#[test]
fn features_that_meet_conditions_are_checked() {
    let folder = Folder::new();
    let ring = |kind: &str, x: u32| {
        format!(
            r#"{{"type":"Feature","properties":{{"k":"{kind}"}},"geometry":{{"type":"Polygon","coordinates":[[[0,0],[{x},9],[9,0],[0,9],[0,0]]]}}}}"#
        )
    };
    let whole = ring("a", 0).replace("[0,9],[9,0],[0,9],", "[9,0],[9,9],");
    folder.write("a.geojsonl", [whole, ring("b", 9), ring("b", 8)].join("\n"));
    let printed = folder.must("check a.geojsonl --where k=a --json").json();
    assert_eq!((&printed["features"], &printed["valid"]), (&1.into(), &true.into()));
    let ended = folder.run("check a.geojsonl --where k=b --json");
    assert_eq!(ended.json()["invalid"], 2, "{}", ended.err);
    assert_eq!(ended.json()["faults"][0]["feature"], 2, "numbers are those in the file");
    let ended = folder.must("check a.geojsonl --where k=c");
    assert!(ended.err.contains("3 features were read, and none meets --where"), "{}", ended.err);
}
