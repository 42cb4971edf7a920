//! Mistakes of newcomers: each message tells what is right.

use crate::harness::Folder;

const AREA: &str = r#"{"type":"Feature","properties":{"n":1},"geometry":{"type":"Polygon",
    "coordinates":[[[1,1],[4,1],[4,3],[1,1]]]}}"#;

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("a.geojson", AREA);
    folder.write("a.wkt", "POINT (1 2)");
    for suffix in ["csv", "geojson", "png", "obj", "svg"] {
        folder.write(&format!("empty.{suffix}"), "");
    }
    folder
}

#[test]
fn empty_files_are_called_empty() {
    let folder = folder();
    folder.run("draw empty.csv -o o.png").fails(1, "empty.csv: the file is empty");
    folder.run("fill empty.png -o o.png --at 0,0 --color red").fails(1, "is empty");
    folder.run("draw empty.geojson -o o.png").fails(1, "there is nothing to draw");
    let told = folder.must("info empty.geojson");
    assert!(String::from_utf8_lossy(&told.out).contains("geometry    none\n"), "{told:?}");
    let ended = folder.must("tiles empty.geojson -o o.pmtiles --json");
    assert!(ended.err.contains("there is no feature in it"), "{}", ended.err);
    assert!(!ended.err.contains("chosen"), "{}", ended.err);
    assert_eq!(ended.json()["zoom_by"], "nothing");
}

#[test]
fn folders_that_are_missing_are_named() {
    let folder = folder();
    for command in [
        "draw a.geojson -o no/x.png",
        "clip a.geojson -o no/x.wkt",
        "tiles a.geojson -o no/x.pmtiles",
    ] {
        folder.run(command).fails(1, "there is no folder no");
    }
    folder
        .run("tiles a.geojson -o a.wkt")
        .fails(1, "a.wkt: it is a file, where a folder is needed");
    assert_eq!(folder.read("a.wkt"), b"POINT (1 2)");
}

#[test]
fn results_without_content_are_told() {
    let folder = folder();
    for (command, part) in [
        (
            "clip a.geojson --window 8,8,9,9 -o o.wkt",
            "a.geojson: nothing remains of its 1 features",
        ),
        ("clip a.geojson --where n=2 -o o.wkt", "a.geojson: none of its 1 features meets --where"),
        (
            "draw a.geojson a.wkt --window 8,8,9,9 -o o.png",
            "nothing of the map is within 8.0,8.0,9.0,9.0",
        ),
        ("draw a.geojson --window 8,8,9,9 -o o.svg", "nothing of the map is within"),
    ] {
        let ended = folder.must(command);
        assert!(ended.err.contains(part), "{command}: {}", ended.err);
    }
    for command in
        ["clip a.geojson --window 2,0,3,9 -o o.wkt", "draw a.geojson --window 2,1,3,2 -o o.png"]
    {
        assert_eq!(folder.must(command).err, "", "{command}");
    }
}

#[test]
fn formulas_given_as_files_are_recognized() {
    let folder = folder();
    for formula in ["sin(x)", "sin(x", "foo(x)", "x^2+z"] {
        folder.run(&format!("plot {formula} -o o.png")).fails(2, "use --formula for a formula");
    }
    folder.run("plot missing.asc -o o.png").fails(1, "missing.asc: No such file");
}
