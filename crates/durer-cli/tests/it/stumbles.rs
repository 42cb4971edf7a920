//! Mistakes of newcomers: each message tells what is right.

use crate::clip::piped;
use crate::harness::{Ended, Folder, Picture};
use std::io::Write;
use std::process::Stdio;

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
    folder.run("draw empty.geojson -o o.png").fails(1, "empty.geojson: the file is empty");
    let printed = folder.must("info empty.geojson");
    assert!(String::from_utf8_lossy(&printed.out).contains("geometry    none\n"), "{printed:?}");
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
fn results_without_content_are_reported() {
    let folder = folder();
    for (command, part) in [
        (
            "clip a.geojson --window 8,8,9,9 -o o.wkt",
            "a.geojson: nothing remains of its 1 feature; durer info tells the extent",
        ),
        (
            "clip a.geojson --where n=2 -o o.wkt",
            "a.geojson: 1 feature was read, and does not meet --where",
        ),
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

#[test]
fn files_in_other_encodings_say_so() {
    let folder = Folder::new();
    let text = r#"{"type":"Feature","properties":{"n":"Köln"},"geometry":{"type":"Point","coordinates":[1,2]}}"#;
    let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
    folder.write("latin.geojson", &latin);
    let utf16 = |text: &str| -> Vec<u8> {
        std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect()
    };
    folder.write("wide.geojson", utf16(text));
    folder.write("wide.csv", utf16("lon,lat\n1,2\n"));
    let kml = r#"<kml xmlns="http://www.opengis.net/kml/2.2"><Placemark><Point><coordinates>1,2</coordinates></Point></Placemark></kml>"#;
    folder.write("wide.kml", utf16(kml));
    for command in [
        "clip % --window 0,0,5,5 -o o.geojson",
        "tiles % -o o.pmtiles",
        "draw % -o o.png",
        "check %",
    ] {
        let run = |name: &str| folder.run(&command.replace('%', name));
        run("latin.geojson").fails(1, "this is not UTF-8; save the file in UTF-8");
        run("wide.geojson").fails(1, "wide.geojson: this is text in UTF-16; save it in UTF-8");
        run("wide.csv").fails(1, "wide.csv: this is text in UTF-16; save it in UTF-8");
        assert_eq!(run("wide.kml").code, 0, "XML names its encoding: {command}");
    }
}

#[test]
fn maps_on_standard_input_are_described() {
    let folder = Folder::new();
    let piped = |text: &str| {
        let mut command = folder.command("info - --json");
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("run");
        child.stdin.take().expect("a pipe").write_all(text.as_bytes()).expect("written");
        Ended::of(child.wait_with_output().expect("ended"))
    };
    let printed = piped(r#"{"type":"Point","coordinates":[1,2]}"#).json();
    assert_eq!(
        (&printed["format"], &printed["features"]),
        (&"geojson".into(), &1.into()),
        "{printed}"
    );
    let layers =
        r#"{"a":{"type":"Point","coordinates":[1,2]},"b":{"type":"Point","coordinates":[3,4]}}"#;
    let printed = piped(&format!(r#"{{"type":"Topology","arcs":[],"objects":{layers}}}"#)).json();
    assert_eq!(printed["features"], 2, "{printed}");
    assert!(
        printed["warnings"][0].as_str().expect("a warning").contains("become one"),
        "{printed}"
    );
    let printed = piped("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").json();
    assert_eq!(printed["format"], "OBJ");
    let printed = piped("x,y,z\n1,2,3\n4,5,6\n").json();
    assert_eq!(printed["features"], 2, "{printed}");
}

#[test]
fn files_without_a_command_name_the_command() {
    let folder = Folder::new();
    folder.run("a.stl -o a.png").fails(2, "a command comes before the file: durer render a.stl");
    folder.run("a.geojson").fails(2, "a command comes before the file: durer draw a.geojson");
    folder.run("rendr a.stl").fails(2, "a similar subcommand exists: 'render'");
    folder.write("a.wkt", "POINT (1 2)");
    folder.run("tiles a.wkt -o -").fails(2, "name a .pmtiles or .mbtiles file, or a folder");
    folder.write("empty.svg", "");
    folder.run("draw empty.svg -o a.png").fails(1, "empty.svg: the file is empty");
}

#[test]
fn models_are_seen_at_any_place_and_in_any_size() {
    let folder = Folder::new();
    for (at, side) in [(1e9, 1.0), (-4e9, 0.5), (0.0, 1e-9), (0.0, 1e9)] {
        let end = at + side;
        folder.write(
            "a.obj",
            format!("v {at} 0 0\nv {end} 0 0\nv {at} {side} 0\nv {at} 0 {side}\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"),
        );
        let ended = folder.must("render a.obj -o a.png --size 32");
        assert_eq!(ended.err, "", "{at} {side}");
        assert!(Picture::decode(&folder.read("a.png")).shows_something(), "{at} {side}");
    }
}

#[test]
fn what_bounds_nothing_is_not_closed() {
    let folder = Folder::with_models();
    folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 3 2 1\n");
    folder.write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("line.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
    for (name, closed) in [
        ("flat.obj", false.into()),
        ("triangle.obj", false.into()),
        ("cube.obj", true.into()),
        ("line.obj", serde_json::Value::Null),
    ] {
        let info = folder.must(&format!("info {name} --json")).json();
        assert_eq!(info["closed"], closed, "{name}");
    }
}

#[test]
fn views_of_a_sheet_have_the_borders_of_one_model() {
    let folder = Folder::new();
    folder.write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let ended = folder.must("render triangle.obj -o o.svg --sheet third-angle --json");
    assert!(ended.err.is_empty(), "{}", ended.err);
    let drawing = &ended.json()["models"][0]["pictures"][0]["drawing"];
    assert_eq!((&drawing["edges"], &drawing["border_edges"]), (&3.into(), &3.into()));
}

#[test]
fn lines_of_numbers_are_points_under_any_name() {
    let folder = Folder::new();
    let points = "0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n";
    for name in ["points", "points.dat", "points.csv", "points.xyz"] {
        folder.write(name, points);
        let info = folder.must(&format!("info {name} --json")).json();
        assert_eq!((&info["points"], &info["format"]), (&3.into(), &"point cloud, text".into()));
    }
    let info = piped(&folder, "info - --json", points.as_bytes()).json();
    assert_eq!(info["points"], 3);
    let drawn = piped(&folder, "render - -o - --size 16x16", points.as_bytes());
    let red = Picture::decode(&drawn.out).pixels().filter(|p| p[0] > 200 && p[1] < 60).count();
    assert!(red >= 9, "{red}");
    folder.write("words", "1 2 3\nwords\n");
    folder.run("info words").fails(1, "not a known format");
    folder.write("a.gltf", r#"{"scene": 0}"#);
    folder.run("info a.gltf").fails(1, "`asset` is missing");
}
