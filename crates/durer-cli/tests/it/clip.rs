//! `durer clip` on small files.

use crate::harness::{Ended, Folder};
use serde_json::Value;
use std::io::Write;
use std::process::Stdio;

const SQUARE: &str = r#"{"type":"FeatureCollection","name":"n","features":[
{"type":"Feature","id":3,"properties":{"a":"é"},"geometry":{"type":"Polygon","coordinates":[[[0,0,0],[4,0,8],[4,4,8],[0,4,0],[0,0,0]]]}},
{"type":"Feature","properties":{"b":1.50},"geometry":{"type":"LineString","coordinates":[[-1,1],[1,1],[1,9],[3,9],[3,1]]}},
{"type":"Feature","properties":null,"geometry":{"type":"MultiPoint","coordinates":[[0,0],[9,9],[2,2]]}},
{"type":"Feature","properties":null,"geometry":null}]}"#;

pub fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("in.geojson", SQUARE);
    folder
}

fn features(folder: &Folder, name: &str) -> Vec<Value> {
    let whole: Value = serde_json::from_slice(&folder.read(name)).unwrap();
    whole["features"].as_array().unwrap().clone()
}

pub fn piped(folder: &Folder, arguments: &str, input: &[u8]) -> Ended {
    let mut command = folder.command(arguments);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let input = input.to_owned();
    // The command may end before it has read everything.
    let feeder = std::thread::spawn(move || drop(stdin.write_all(&input)));
    let ended = Ended::of(child.wait_with_output().unwrap());
    feeder.join().unwrap();
    ended
}

#[test]
fn a_window_keeps_properties_order_and_heights() {
    let folder = folder();
    let report = folder.must("clip in.geojson --window -2,-1,3,2 -o out.geojson --json").json();
    let out = String::from_utf8(folder.read("out.geojson")).unwrap();
    assert!(
        out.starts_with("{\"type\":\"FeatureCollection\",\"name\":\"n\",\"features\":[\n"),
        "{out}"
    );
    let found = features(&folder, "out.geojson");
    assert_eq!(found.len(), 3);
    assert_eq!(
        (&found[0]["id"], &found[0]["properties"]["a"]),
        (&Value::from(3), &Value::from("é"))
    );
    let ring = found[0]["geometry"]["coordinates"][0].as_array().unwrap();
    assert!(ring.iter().any(|p| p == &serde_json::json!([3, 0, 6])), "{ring:?}");
    // The corner of the window in the square has the height between its neighbours on the border.
    assert!(ring.iter().any(|p| p[0] == 3 && p[1] == 2), "{ring:?}");
    assert!(out.contains("{\"b\":1.50}"), "{out}");
    assert_eq!(
        found[1]["geometry"],
        serde_json::json!({"type":"MultiLineString","coordinates":[[[-1,1],[1,1],[1,2]],[[3,2],[3,1]]]})
    );
    assert_eq!(found[2]["geometry"]["coordinates"], serde_json::json!([[0, 0], [2, 2]]));
    assert_eq!(
        (&report["in"]["area"], &report["out"]["area"]),
        (&Value::from(16.0), &Value::from(6.0))
    );
    assert_eq!(report["out"]["length"], 4.0);
    assert_eq!(report["in"]["features"], 4);
}

#[test]
fn masks_operations_and_the_outside() {
    let folder = folder();
    folder.write("mask.wkt", "POLYGON((2 -1,9 -1,9 3,2 3,2 -1))\nPOLYGON((1 2,9 2,9 3,1 3,1 2))");
    let area = |arguments: &str| {
        let report =
            folder.must(&format!("clip in.geojson {arguments} -o o.geojson --json")).json();
        report["out"]["area"].as_f64().unwrap()
    };
    assert_eq!(area("--by mask.wkt"), 7.0);
    assert_eq!(area("--by mask.wkt --outside"), 9.0);
    assert_eq!(area("--by mask.wkt --op difference"), 9.0);
    assert_eq!(area("--by mask.wkt --op union"), 38.0);
    assert_eq!(area("--by mask.wkt --op xor"), 31.0);
    assert_eq!(area("--window 0,0,1,1 --outside"), 15.0);
    assert_eq!(area("--op union"), 16.0);
    for algorithm in [
        "overlay",
        "vatti",
        "weiler-atherton",
        "greiner-hormann",
        "rectangle",
        "sutherland-hodgman",
        "liang-barsky",
    ] {
        assert_eq!(
            area(&format!("--window -1,-1,3,3 --algorithm {algorithm}")),
            9.0,
            "{algorithm}"
        );
    }
    // The window's borders are nearest to 0.5 and 3.
    assert_eq!(area("--window 0.3,0.3,3.2,3.2 --grid 0.5"), 6.25);
}

#[test]
fn every_algorithm_keeps_heights_or_refuses() {
    let folder = Folder::new();
    folder.write("z.wkt", "POLYGON Z ((0 0 1,4 0 1,4 4 9,0 4 9,0 0 1))");
    folder.write("bow.wkt", "POLYGON ((0 0,4 4,4 0,0 4,0 0))");
    for name in ["sutherland-hodgman", "weiler-atherton", "greiner-hormann", "rectangle", "vatti"] {
        let line = format!("--window -1,2,9,9 --algorithm {name} -o -");
        let cut = folder.must(&format!("clip z.wkt {line}"));
        let cut = String::from_utf8(cut.out).expect("text");
        assert!(
            cut.starts_with("POLYGON Z ((") && cut.matches(" 2 5").count() >= 2,
            "{name}: {cut}"
        );
        if name == "greiner-hormann" {
            let cut = folder.must(&format!("clip bow.wkt {line}"));
            let right = "MULTIPOLYGON (((0 2, 2 2, 0 4, 0 2)), ((2 2, 4 2, 4 4, 2 2)))\n";
            assert_eq!(String::from_utf8(cut.out).expect("text"), right);
        } else if name != "vatti" {
            folder.run(&format!("clip bow.wkt {line}")).fails(1, "cross");
        }
        if name != "vatti" {
            folder
                .run(&format!("clip bow.wkt --op union --algorithm {name} -o -"))
                .fails(2, "overlay and vatti");
        }
        folder
            .run(&format!("clip bow.wkt --tiles 1 --algorithm {name} -o tiles"))
            .fails(2, "--tiles");
    }
    folder.write("mask.wkt", "POLYGON ((2 0,6 0,6 4,2 4,2 0))");
    for op in ["union", "xor"] {
        let by = |name: &str| {
            let line = format!("clip z.wkt --by mask.wkt --op {op} --algorithm {name} -o -");
            folder.must(&line).out
        };
        assert_eq!(by("overlay"), by("vatti"));
    }
}

#[test]
fn fill_rules_decide_what_crossing_rings_enclose() {
    let folder = Folder::new();
    folder.write(
        "a.wkt",
        "POLYGON((0 0,4 0,4 4,0 4,0 0),(1 1,3 1,3 3,1 3,1 1))\nPOLYGON((0 0,4 4,4 0,0 4,0 0))",
    );
    let rules = [
        ("even-odd", 20.0),
        ("non-zero", 24.0),
        ("positive", 20.0),
        ("negative", 4.0),
        ("abs-geq-two", 4.0),
    ];
    for (rule, areas) in rules {
        let report = folder
            .must(&format!("clip a.wkt --window -9,-9,9,9 --fill-rule {rule} -o o.wkt -q --json"));
        assert_eq!(report.json()["out"]["area"], areas, "{rule}");
    }
    let warned = folder.must("clip a.wkt --window -9,-9,9,9 -o o.wkt");
    assert!(warned.err.contains("polygons of 1 feature crossed"), "{}", warned.err);
}

/// Runs `durer clip` on WKT and returns its output line by line.
fn clipped(wkt: &str, arguments: &str) -> Vec<String> {
    let folder = Folder::new();
    folder.write("a.wkt", wkt);
    folder.must(&format!("clip a.wkt {arguments} -o o.wkt"));
    String::from_utf8(folder.read("o.wkt")).unwrap().lines().map(str::to_owned).collect()
}

#[test]
fn points_and_lines_have_an_outside_too() {
    let wkt = "MULTIPOINT(0 0,2 2,9 9)\nPOINT(2 3)\nLINESTRING(-5 3,9 3)";
    let inside = ["MULTIPOINT (2 2)", "POINT (2 3)", "LINESTRING (1 3, 4 3)"];
    let outside = ["MULTIPOINT (0 0, 9 9)", "MULTILINESTRING ((-5 3, 1 3), (4 3, 9 3))"];
    assert_eq!(clipped(wkt, "--window 1,1,4,4"), inside);
    assert_eq!(clipped(wkt, "--window 1,1,4,4 --outside"), outside);
}

#[test]
fn lines_that_leave_at_a_vertex_end_there_once() {
    let wkt =
        "LINESTRING(0.5 0.5,1 1,3 1,1 1,0.5 0)\nLINESTRING(2 2,1 1,0 0,-1 0,0 0,0.5 0.5,0.5 0.5)";
    let expected = [
        "MULTILINESTRING ((0.5 0.5, 1 1), (1 1, 0.5 0))",
        "MULTILINESTRING ((1 1, 0 0), (0 0, 0.5 0.5, 0.5 0.5))",
    ];
    assert_eq!(clipped(wkt, "--window 0,0,1,1"), expected);
    for algorithm in ["cohen-sutherland", "liang-barsky", "nicholl-lee-nicholl"] {
        assert_eq!(clipped(wkt, &format!("--window 0,0,1,1 --algorithm {algorithm}")), expected);
    }
}

#[test]
fn lines_get_no_vertex_where_they_only_touch_the_mask() {
    assert_eq!(
        clipped("LINESTRING(0 2,2 0)", "--window 1,1,4,4 --outside"),
        ["LINESTRING (0 2, 2 0)"]
    );
}

#[test]
fn outer_rings_run_counter_clockwise_and_holes_clockwise() {
    // Clockwise, with a counter-clockwise hole that touches it; and a second polygon with opposite directions.
    let wkt =
        "MULTIPOLYGON(((0 0,0 9,9 9,9 0,0 0),(0 4,3 3,3 5,0 4)),((20 0,29 0,29 9,20 9,20 0)))";
    let expected = [
        "MULTIPOLYGON (((0 0, 9 0, 9 9, 0 9, 0 0), (0 4, 3 5, 3 3, 0 4)), ((20 0, 29 0, 29 9, 20 9, 20 0)))",
    ];
    let far = "POLYGON((50 0,51 0,51 1,50 0))";
    let folder = Folder::new();
    folder.write("a.wkt", wkt.replace("0 4", "1 4"));
    folder.write("far.wkt", far);
    for arguments in ["--window=-9,-9,99,99", "--by far.wkt --outside"] {
        folder.must(&format!("clip a.wkt {arguments} -o o.wkt"));
        let found = String::from_utf8(folder.read("o.wkt")).unwrap();
        assert_eq!(found.lines().collect::<Vec<_>>(), expected.map(|e| e.replace("0 4", "1 4")));
    }
    for algorithm in
        ["overlay", "vatti", "weiler-atherton", "greiner-hormann", "sutherland-hodgman"]
    {
        let found = clipped(wkt, &format!("--window=-9,-9,99,99 --algorithm {algorithm}"));
        let turns: Vec<f64> = found[0].split("), (").map(turn).collect();
        assert!(turns[0] > 0.0 && turns[1] < 0.0 && turns[2] > 0.0, "{algorithm}: {found:?}");
    }
}

/// Returns twice the signed area of a ring as WKT writes it.
fn turn(ring: &str) -> f64 {
    let ring = ring.trim_matches(|c: char| !c.is_ascii_digit());
    let points: Vec<Vec<f64>> = ring
        .split(", ")
        .map(|p| p.split(' ').map(|n| n.trim_matches(['(', ')']).parse().unwrap()).collect())
        .collect();
    points.windows(2).map(|w| w[0][0] * w[1][1] - w[0][1] * w[1][0]).sum()
}

#[test]
fn a_mask_without_polygons_takes_nothing_away() {
    let folder = folder();
    folder.write("empty.geojson", r#"{"type":"FeatureCollection","features":[]}"#);
    folder.write("line.wkt", "LINESTRING(0 0,9 9)");
    for mask in ["empty.geojson", "line.wkt"] {
        let ended =
            folder.must(&format!("clip in.geojson --by {mask} --outside -o o.geojson --json"));
        assert!(ended.err.contains("there is no polygon in it"), "{}", ended.err);
        let report = ended.json();
        for measure in ["area", "length", "points"] {
            assert_eq!(report["in"][measure], report["out"][measure], "{mask} {measure}");
        }
        folder
            .run(&format!("clip in.geojson --by {mask} -o p.geojson"))
            .fails(1, "no polygon to cut with");
    }
}

#[test]
fn repeated_positions_and_touching_rings_are_no_fault() {
    let folder = Folder::new();
    folder.write("twice.wkt", "POLYGON((0 0,9 0,9 0,9 9,0 9,0 0,0 0))");
    folder.write("touch.wkt", "POLYGON((0 0,9 0,9 9,0 9,0 0),(0 4,3 3,3 5,0 4))");
    for name in ["twice", "touch"] {
        for arguments in ["--window 1,1,5,5", "--window=-1,-1,99,99", "--window 1,1,5,5 --outside"]
        {
            let ended = folder.must(&format!("clip {name}.wkt {arguments} -o o.wkt"));
            assert_eq!(ended.err, "", "{name} {arguments}");
        }
    }
    folder.must("clip twice.wkt --window 1,1,5,5 --algorithm rectangle -o o.wkt");
    assert_eq!(folder.read("o.wkt"), b"POLYGON ((1 1, 5 1, 5 5, 1 5, 1 1))\n");
}

#[test]
fn textbook_algorithms_refuse_what_they_cannot_do() {
    let folder = Folder::new();
    folder.write("bow.wkt", "POLYGON((0 0,4 4,4 0,0 4,0 0))");
    // In the window the hole touches the outer ring and is cut open.
    folder.write("touch.wkt", "POLYGON((0 0,9 0,9 9,0 9,0 0),(4 9,3 3,5 3,4 9))");
    for algorithm in ["weiler-atherton", "greiner-hormann", "rectangle"] {
        let run = |window| format!("--window {window} --algorithm {algorithm} -o o.wkt");
        let wrong = folder.run(&format!("clip bow.wkt {}", run("1,1,5,5")));
        wrong.fails(1, "feature 1 (from 1): a polygon whose rings");
        let opened = folder.run(&format!("clip touch.wkt {}", run("1,5,8,10")));
        assert_eq!(opened.code == 0, algorithm != "rectangle", "{algorithm}: {}", opened.err);
        folder.must(&format!("clip touch.wkt {}", run("1,1,8,10")));
    }
}

#[test]
fn heights_go_on_along_lines_and_round_corners() {
    let cut = clipped("LINESTRING Z (-1 1 0,3 1 8)", "--window 0,0,8,8");
    assert_eq!(cut, ["LINESTRING Z (0 1 2, 3 1 8)"]);
    // A corner of the window lies on no edge: its height is that of its neighbours on the border.
    let flat = "POLYGON Z ((-5 -5 7,5 -5 7,5 5 7,-5 5 7,-5 -5 7))";
    let cut = clipped(flat, "--window 0,0,8,8");
    assert_eq!(cut[0].matches(" 7").count(), 5, "{cut:?}");
    assert!(cut[0].contains("0 0 7"), "{cut:?}");
}

#[test]
fn an_odd_number_of_layers_is_the_xor() {
    let folder = Folder::new();
    let square = |low: u32, high: u32| {
        format!("POLYGON(({low} {low},{high} {low},{high} {high},{low} {high},{low} {low}))\n")
    };
    folder.write("a.wkt", [square(0, 4), square(2, 6), square(3, 9)].concat());
    for (op, area) in [("xor", 16.0 + 16.0 + 36.0 - 2.0 * (4.0 + 9.0 + 1.0) + 4.0), ("union", 55.0)]
    {
        let report = folder.must(&format!("clip a.wkt --op {op} -o o.wkt --json")).json();
        assert_eq!(report["out"]["area"], area, "{op}");
    }
}

#[test]
fn a_mask_of_many_points_cuts_nothing_within_it() {
    let folder = Folder::new();
    let corner = |i: usize| {
        let (x, y) = (i as f64 / 100.0 * 90.0 - 45.0, i as f64 / 100.0);
        format!("{x} {}", 100.0 - y * y * 20.0)
    };
    let arc: Vec<String> = (0..=100).map(corner).collect();
    folder.write("mask.wkt", format!("POLYGON((-45 -99,{},45 -99,-45 -99))", arc.join(",")));
    folder.write("a.wkt", "POLYGON((0 0,1 0,1 1,0 1,0 0))\nLINESTRING(0 0,7 7)\nPOINT(3 3)");
    for (arguments, area, length) in [("", 1.0, 98f64.sqrt()), ("--outside", 0.0, 0.0)] {
        let line = format!("clip a.wkt --by mask.wkt {arguments} -o o.wkt --json");
        let report = folder.must(&line).json();
        let found = ["area", "length"].map(|what| report["out"][what].as_f64().unwrap());
        assert!((found[0] - area).abs() + (found[1] - length).abs() < 1e-12, "{found:?}");
    }
}

#[test]
fn a_feature_that_cannot_be_cut_is_named_by_its_number() {
    let folder = Folder::new();
    let mut wkt = "POINT(0 0)\n".repeat(600);
    wkt += "POLYGON((0 0,1e305 0,1e305 1e305,0 1e305,1e305 1,0 0))";
    folder.write("a.wkt", wkt);
    folder.run("clip a.wkt --window -1,-1,9,9 -o o.wkt").fails(1, "feature 601 (from 1): ");
    folder.run("clip a.wkt --op union -o o.wkt").fails(1, "feature 601 (from 1): ");
}

#[test]
fn what_joining_leaves_out_is_reported() {
    let folder = Folder::new();
    folder
        .write("a.wkt", "POLYGON((0 0,1 0,1 1,0 0))\nLINESTRING(0 0,1 1)\nPOINT(0 0)\nPOINT(1 0)");
    let printed = "left out: 1 line and 2 points";
    for (op, names) in [("union", true), ("xor", true), ("intersection", false)] {
        let line = format!("clip a.wkt --op {op} --window -9,-9,9,9 -o o.wkt");
        assert_eq!(folder.must(&line).err.contains(printed), names, "{op}");
        let report = folder.must(&format!("{line} --json -q")).json();
        assert_eq!(report["warnings"].as_array().map(Vec::len), Some(usize::from(names)), "{op}");
    }
}

#[test]
fn streams_and_formats() {
    let folder = folder();
    for (suffix, start) in [
        ("geojsonl", "{\"type\":\"Feature\",\"id\":3"),
        ("geojsons", "\u{1e}{\"type\":\"Feature\""),
        ("wkt", "POLYGON Z ((0 0 0, "),
        ("hex", "01EB030000"),
        ("svg", "<svg "),
    ] {
        folder.must(&format!("clip in.geojson --window 0,0,9,9 -o o.{suffix}"));
        let out = folder.read(&format!("o.{suffix}"));
        assert!(String::from_utf8_lossy(&out).starts_with(start), "{suffix}");
        let report = folder
            .must(&format!("clip o.{suffix} --window 0,0,9,9 -o again.geojson --json"))
            .json();
        assert_eq!(report["out"]["area"], 16.0, "{suffix}");
    }
    let wkb = piped(&folder, "clip - --window 0,0,3,3 -o - --to wkb", SQUARE.as_bytes());
    let wkt = piped(&folder, "clip - --window 0,0,3,3 -o - --format wkt", &wkb.out);
    assert!(String::from_utf8_lossy(&wkt.out).starts_with("POLYGON Z (("), "{wkt:?}");
    let names = folder.names();
    assert!(names.iter().all(|n| !n.contains("durer")), "{names:?}");
}

#[test]
fn long_sequences_take_no_memory() {
    let folder = Folder::new();
    let line = "{\"type\":\"Feature\",\"properties\":{\"n\":1},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[[0,0],[2,0],[2,2],[0,0]]]}}\n";
    let peak = |count: usize| {
        folder.write("long.geojsonl", line.repeat(count));
        let report = folder
            .must("clip long.geojsonl --window 0,0,1,1 -o o.geojsonl --json --threads 1")
            .json();
        assert_eq!(report["out"]["features"], count);
        report["peak_memory_bytes"].as_u64()
    };
    if let (Some(few), Some(many)) = (peak(2_000), peak(100_000)) {
        assert!(many < few + (2 << 20), "{few} bytes for 2,000 features, {many} for 100,000");
    }
}

#[test]
fn tiles_are_files_or_a_sequence() {
    let folder = Folder::new();
    folder.write("a.geojson", r#"{"type":"Feature","properties":{"k":1},"geometry":{"type":"Polygon","coordinates":[[[-10,-10],[10,-10],[10,10],[-10,10],[-10,-10]]]}}"#);
    let report = folder.must("clip a.geojson --tiles 1 -o tiles --json").json();
    assert_eq!((&report["tiles"], &report["out"]["area"]), (&Value::from(4), &Value::from(400.0)));
    for tile in ["1/0/0", "1/0/1", "1/1/0", "1/1/1"] {
        let found = features(&folder, &format!("tiles/{tile}.geojson"));
        assert_eq!(found[0]["properties"]["k"], 1, "{tile}");
    }
    folder.must("clip a.geojson --tiles 2 -o t.geojsonl");
    let text = String::from_utf8(folder.read("t.geojsonl")).unwrap();
    assert_eq!(text.lines().count(), 4);
    assert!(text.contains("\"tile\":\"2/1/2\""), "{text}");
    folder.must("clip a.geojson --tiles 3 --tile-coordinates mercator -o m.geojsonl");
    assert_eq!(String::from_utf8(folder.read("m.geojsonl")).unwrap().lines().count(), 4);
    folder.run("clip a.geojson --tiles 2 -o t.geojson").fails(2, "a file per tile");
    let again = folder.must("clip t.geojsonl --tiles 3 -o u.geojsonl");
    assert!(again.err.contains("the member \"tile\" of 4 features"), "{}", again.err);
}

#[test]
fn wrong_use_and_bad_data_are_reported() {
    let folder = folder();
    folder.write("bad.geojsonl", "{\"type\":\"Point\",\"coordinates\":[1,1]}\n{\"type\":\"Point\",\"coordinates\":[1,oops]}\n");
    folder.write("old.geojsonl", "old");
    folder.run("clip in.geojson -o a.geojson").fails(2, "nothing to clip with");
    folder.run("clip in.geojson --window 1,2,3 -o a.geojson").fails(2, "four numbers");
    folder.run("clip in.geojson --window 3,0,1,1 -o a.geojson").fails(2, "the window is empty");
    folder.run("clip in.geojson --window 0,0,1,1 -o a.png").fails(2, "--to");
    folder.run("clip in.geojson --window 0,0,1,1 -o - --json").fails(2, "--json");
    folder
        .run("clip in.geojson --by in.geojson --algorithm rectangle -o a.wkt")
        .fails(2, "--window");
    folder.run("clip in.geojson --window 0,0,1,1 --algorithm magic -o a.wkt").fails(2, "overlay");
    for rules in ["--grid 0.5", "--fill-rule non-zero"] {
        for name in ["rectangle", "sutherland-hodgman", "weiler-atherton", "greiner-hormann"] {
            let line = format!("clip in.geojson --window 0,0,1,1 --algorithm {name} {rules}");
            folder.run(&format!("{line} -o a.wkt")).fails(2, "go with overlay and vatti");
        }
    }
    folder.run("clip none.geojson --window 0,0,1,1 -o a.wkt").fails(1, "none.geojson: ");
    folder
        .run("clip bad.geojsonl --window 0,0,9,9 -o old.geojsonl")
        .fails(1, "bad.geojsonl: line 2, column 34, feature 2: ");
    assert_eq!(folder.read("old.geojsonl"), b"old");
    assert_eq!(folder.names(), ["bad.geojsonl", "in.geojson", "old.geojsonl"]);
    piped(&folder, "clip - --window 0,0,1,1 -o -", b"")
        .fails(1, "standard input: the file is empty");
}

#[test]
fn threads_change_nothing() {
    let folder = folder();
    folder.must("clip in.geojson --window 0,0,3,3 -o a.geojson --threads 1");
    folder.must("clip in.geojson --window 0,0,3,3 -o b.geojson --threads 3");
    assert_eq!(folder.read("a.geojson"), folder.read("b.geojson"));
}

pub fn text(ended: Ended) -> String {
    String::from_utf8(ended.out).unwrap()
}

#[test]
fn heights_are_right_where_the_mask_has_corners_on_an_edge() {
    let folder = Folder::new();
    // The plane z = 10 y.
    folder.write("z.wkt", "POLYGON Z((0 0 0,10 0 0,10 10 100,0 10 100,0 0 0))");
    folder.write("m.wkt", "POLYGON((0 4,5 4,5 6,0 6,0 4))");
    for (options, expected) in [
        ("--window=0,5,10,8", &["0 5 50", "10 5 50", "10 8 80", "0 8 80"][..]),
        ("--window=0,0,10,5", &["10 5 50", "0 5 50"]),
        ("--window=0,5,10,8 --algorithm vatti", &["0 5 50", "10 5 50", "10 8 80", "0 8 80"]),
        ("--by m.wkt", &["0 4 40", "0 6 60"]),
        ("--by m.wkt --outside", &["0 4 40", "0 6 60"]),
    ] {
        let out = text(folder.must(&format!("clip z.wkt {options} -o -")));
        assert!(expected.iter().all(|vertex| out.contains(vertex)), "{options}: {out}");
    }
}

#[test]
fn what_is_inside_and_what_is_outside_make_up_a_line_that_follows_the_border() {
    let folder = Folder::new();
    let line = "161.62928714421082 -81.69000050244662,162.4909916526778 -82.06227752067728,\
                163.70533613510452 -82.39543547966299";
    folder.write("l.wkt", format!("LINESTRING({line})"));
    let mask = "161.6292871442109 -81.69000050244665,162.49099165267776 -82.06227752067727,\
                163.70533613510455 -82.39543547966299,170 -80,161.6292871442109 -81.69000050244665";
    folder.write("m.wkt", format!("POLYGON(({mask}))"));
    let vertices = |op: &str| {
        text(folder.must(&format!("clip l.wkt --by m.wkt {op} -o -"))).matches(" -8").count()
    };
    // Three vertices, or four if the line is split at one of them.
    let all = vertices("") + vertices("--op difference");
    assert!(all == 3 || all == 4, "{all}");
}

#[test]
fn lines_of_json_come_as_such_from_a_pipe() {
    let folder = Folder::new();
    let feature =
        r#"{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[1,2]}}"#;
    let input = format!("{feature}\n{feature}\n");
    let out = text(piped(&folder, "clip - --window 0,0,5,5 -o -", input.as_bytes()));
    assert_eq!(out.lines().count(), 2, "{out}");
    assert!(out.lines().all(|line| line.starts_with(r#"{"type":"Feature""#)), "{out}");
}
