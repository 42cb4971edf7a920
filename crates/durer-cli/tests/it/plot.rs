//! `durer plot`.

use crate::harness::{Folder, Picture};

const FORMULA: &str = "plot --formula sin(x)*cos(z) --samples 21x15";

#[test]
fn formulas_become_files_of_every_format() {
    let folder = Folder::new();
    for (name, start) in [
        ("a.svg", &b"<?xml"[..]),
        ("a.pdf", b"%PDF-"),
        ("a.dxf", b"  0\n"),
        ("a.geojson", b"{"),
        ("a.png", b"\x89PNG"),
    ] {
        folder.must(&format!("{FORMULA} --size 300x200 -o {name}"));
        let bytes = folder.read(name);
        let begins = bytes.starts_with(start) || (name == "a.svg" && bytes.starts_with(b"<svg"));
        assert!(begins && bytes.len() > 1000, "{name}: {} bytes", bytes.len());
    }
    folder.must(&format!("{FORMULA} -o a.hpgl"));
    assert!(folder.read("a.hpgl").len() > 1000);
    let picture = Picture::decode(&folder.read("a.png"));
    assert_eq!(picture.size(), (300, 200));
    assert!(picture.shows_something());
    // The same plot gives the same bytes.
    folder.must(&format!("{FORMULA} --threads 1 -o b.svg"));
    assert!(folder.read("a.svg") == folder.read("b.svg"));
}

#[test]
fn plots_tell_what_they_show() {
    let folder = Folder::new();
    folder.write("map.csv", "# heights\n1, 2, 3\n4, nan, 6\n7, 8, 12\n");
    let report = folder.must("plot map.csv -o a.svg --exaggeration 2 --json").json();
    assert_eq!(report["points"], serde_json::json!([3, 3]));
    assert_eq!(report["missing"], 1);
    assert_eq!(report["heights"], serde_json::json!([1.0, 12.0]));
    assert_eq!(report["exaggeration"], 2.0);
    let drawn = |arguments: &str| {
        let report = folder.must(&format!("{FORMULA} -o a.svg --json {arguments}")).json();
        (report["lines"].as_u64(), report["length"].as_f64(), report["cells"].as_u64())
    };
    let (both, x, z) = (drawn("").1, drawn("--lines x").1, drawn("--lines z").1);
    let sum = x.zip(z).map(|(x, z)| x + z);
    assert!(both.zip(sum).is_some_and(|(b, s)| (b - s).abs() < 1e-9), "{both:?} {sum:?}");
    assert_eq!((drawn("--lines none").0, drawn("--fill").2), (Some(0), Some(20 * 14)));
}

#[test]
fn options_of_plots_are_checked() {
    let folder = Folder::new();
    folder.write("map.csv", "1,2\n3,4\n");
    for (arguments, message) in [
        ("plot -o a.svg", "<IN>"),
        ("plot map.csv --formula x -o a.svg", "cannot be used with"),
        ("plot --formula x+ -o a.svg", "column 3"),
        ("plot --formula y -o a.svg", "the ground is x and z"),
        ("plot --formula sqrt(-1) -o a.svg", "no value"),
        ("plot --formula x -o a.bmp", "does not name a format"),
        ("plot --formula x -o a", "does not name a format"),
        ("plot --formula x --x 4,-4 -o a.svg", "the first the smaller"),
        ("plot --formula x --samples 0 -o a.svg", "whole pixels"),
        ("plot --formula x --exaggeration 0 -o a.svg", "above 0"),
        ("plot --formula x --page fit -o a.svg", "name a size"),
        ("plot --formula x --page 5x5 -o a.svg", "20 mm"),
        ("plot --formula x --labels a,b -o a.svg", "three names"),
        ("plot --formula x --fov 40 --ortho -o a.svg", "cannot be used with"),
        ("plot --formula x --eye 0,0,0 -o a.svg", "the whole surface in front of it"),
        ("plot --formula x --eye 9,9,9 --azimuth 3 -o a.svg", "cannot be used with"),
        ("plot --formula x --samples 1x9 -o a.svg", "2x2 points at least"),
        ("plot --formula x --aspect 0 -o a.svg", "or `auto`, `equal`"),
        ("plot --formula x --y-range 8,9 -o a.svg", "there is no height in it"),
    ] {
        let ended = folder.run(arguments);
        let code = if arguments.contains("5x5") { 1 } else { 2 };
        assert_eq!(ended.code, code, "{arguments}: {}", ended.err);
        assert!(ended.err.contains(message), "{arguments}: {}", ended.err);
    }
}

#[test]
fn points_become_a_surface_and_poles_are_left_out() {
    let folder = Folder::new();
    folder.write("p.csv", "x,y,z\n0,0,1\n1,0,2\n0,1,3\n1,1,4\n");
    let report = folder.must("plot p.csv -o a.svg --json").json();
    assert_eq!(report["points"], serde_json::json!([2, 2]));
    assert_eq!(report["heights"], serde_json::json!([1.0, 4.0]));
    let pole = "plot --formula 1/x --samples 9x5 -o a.svg --json --y-range -0.6,0.6";
    let heights = folder.must(pole).json()["heights"].clone();
    assert_eq!(heights, serde_json::json!([-0.6, 0.6]));
    // If the ground is long and narrow, both sides have the same scale, and the report says so.
    let long = "plot --formula x --x 0,60 --z 0,10 -o a.svg --json";
    assert_eq!(folder.must(long).json()["aspect"], 1.0);
    let equal = folder.must(&format!("{long} --aspect equal")).json();
    assert_eq!(equal.get("aspect"), None);
}

#[test]
fn broken_height_maps_are_reported_with_their_place() {
    let folder = Folder::new();
    folder.write(
        "short.asc",
        "ncols 3\nnrows 2\ncellsize 1\nxllcorner 0\nyllcorner 0\n10 20 30\n40 50\n",
    );
    folder.write("ragged.csv", "1,2,3\n1,2\n");
    folder.write("word.csv", "1,2,3\n1,two,3\n");
    folder.write("none.json", "{\"width\": 2}");
    folder.write("other.xyz", "hello");
    for (name, message) in [
        ("short.asc", "ends after 5 of 6"),
        ("ragged.csv", "line 2: 2 numbers"),
        ("word.csv", "line 2, column 3: `two`"),
        ("none.json", "no array of heights"),
        ("other.xyz", "height maps are read from"),
        ("missing.asc", "missing.asc"),
    ] {
        let ended = folder.run(&format!("plot {name} -o a.svg"));
        assert_eq!(ended.code, 1, "{name}: {}", ended.err);
        assert!(ended.err.contains(message), "{name}: {}", ended.err);
    }
}

#[test]
fn ranges_too_large_or_too_small_are_refused_with_the_limit() {
    let folder = Folder::new();
    for range in ["0,1e300", "-2e100,0", "0,1e-120"] {
        folder.run(&format!("plot --formula x --x={range} -o a.svg")).fails(
            2,
            "it must be two numbers within ±10¹⁰⁰, the first the smaller by 10⁻¹⁰⁰ or more",
        );
    }
    folder.must("plot --formula x --samples 4 --x 0,1e90 -o a.svg");
}

#[test]
fn options_without_effect_are_reported() {
    let folder = Folder::new();
    for (options, printed) in [
        ("a.svg --no-axes --labels a,b,c", "--labels: it has no effect: the plot has no axes"),
        ("a.svg --no-color-bar", "--no-color-bar: it has no effect: there is no --color-map"),
        ("a.svg --lines none --fill --every 2", "--every: it has no effect: the plot has no lines"),
        ("a.svg --size 80x60", "--size: it has no effect: a vector file has millimetres"),
        ("a.hpgl --ink red", "--ink: it has no effect: the file has no place for it"),
        ("a.dxf --background red", "--background: it has no effect: the file has no place"),
        ("a.png --size 40x30 --pen-order", "--pen-order: it has no effect: it is for plotters"),
    ] {
        let ended = folder.must(&format!("plot --formula x --samples 4 -o {options}"));
        assert!(
            ended.err.contains(&format!("durer: warning: {printed}")),
            "{options}: {}",
            ended.err
        );
    }
    let ended = folder.must(
        "plot --formula x --samples 4 -o a.svg --labels a,b,c --color-map viridis --no-color-bar --every 2 --ink red",
    );
    assert!(ended.err.is_empty(), "{}", ended.err);
}
