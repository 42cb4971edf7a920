//! `durer tiles`: how files are read.

use crate::harness::{Ended, Folder};
use serde_json::Value;

#[test]
fn files_in_other_systems_are_converted() {
    let folder = Folder::new();
    folder.write(
        "a.geojson",
        r#"{"type":"Polygon","coordinates":[[[9,48],[9.5,48],[9.5,48.5],[9,48.5],[9,48]]]}"#,
    );
    folder.must("tiles a.geojson -o a/{z}/{x}/{y}.geojson --zoom 6");
    let expected = folder.read("a/6/33/22.geojson");
    for (name, code) in [("utm.gpkg", 25832), ("web.fgb", 3857), ("ewkt.wkt", 25832)] {
        folder.must(&format!("clip a.geojson --to-crs EPSG:{code} -o {name}"));
        let ended =
            folder.must(&format!("tiles {name} -o b/{{z}}/{{x}}/{{y}}.geojson --zoom 6 --layer a"));
        assert!(!ended.err.contains("latitudes"), "{name}: {}", ended.err);
        let strip = |bytes: &[u8]| -> Value {
            let tile: Value = serde_json::from_slice(bytes).expect("JSON");
            tile["features"][0]["geometry"].clone()
        };
        assert_eq!(strip(&folder.read("b/6/33/22.geojson")), strip(&expected), "{name}");
    }
    // An option decides, if it is given.
    let ended = folder.must("tiles utm.gpkg -o c.pmtiles --zoom 6 --coordinates lonlat");
    assert!(ended.err.contains("latitudes beyond 90 degrees"), "{}", ended.err);
    folder.write("odd.wkt", "SRID=21781;POINT (600000 200000)");
    let refused = folder.run("tiles odd.wkt -o d.pmtiles");
    refused.fails(1, "odd.wkt: ");
    assert!(refused.err.contains("--from-crs says what"), "{}", refused.err);
    // So does the option for any system.
    let read = |name: &str| -> Value {
        let tile: Value = serde_json::from_slice(&folder.read(name)).expect("JSON");
        tile["features"][0]["geometry"].clone()
    };
    for code in [25832, 3857, 4326] {
        folder.must(&format!("clip a.geojson --to-crs EPSG:{code} -o stated.csv"));
        let stated = String::from_utf8(folder.read("stated.csv")).expect("text");
        folder.write("bare.csv", stated.replace(&format!("SRID={code};"), ""));
        folder.must(&format!(
            "tiles bare.csv -o e/{{z}}/{{x}}/{{y}}.geojson --zoom 6 --from-crs EPSG:{code}"
        ));
        assert_eq!(read("e/6/33/22.geojson"), read("a/6/33/22.geojson"), "{code}");
    }
    folder
        .run("tiles bare.csv -o f.pmtiles --from-crs 3857 --coordinates lonlat")
        .fails(2, "cannot be used with");
}

#[test]
fn layers_of_standard_input_become_one() {
    let folder = Folder::new();
    let point = |x: u32| format!(r#"{{"type":"Point","coordinates":[{x},2]}}"#);
    let objects = format!(r#""a":{},"b":{}"#, point(1), point(5));
    let text = format!(r#"{{"type":"Topology","arcs":[],"objects":{{{objects}}}}}"#);
    folder.write("t.json", &text);
    let input = std::fs::File::open(folder.path("t.json")).expect("a file");
    let mut command = folder.command("tiles - -o a.pmtiles --zoom 1");
    let ended = Ended::of(command.stdin(input).output().expect("a run"));
    assert!(ended.err.contains("its 2 layers become one; read from a file"), "{}", ended.err);
    assert!(!ended.err.contains("--layer names one"), "{}", ended.err);
    // Nothing is wrong with several layers.
    let ended = folder.must("check t.json --json");
    assert_eq!(ended.json()["valid"], true, "{}", ended.err);
}
