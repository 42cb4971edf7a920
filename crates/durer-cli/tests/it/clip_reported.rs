//! Messages of `durer clip` and the files that they name; properties of a file that are kept beside
//! geometry.

use crate::clip::{folder, piped, text};
use crate::harness::{Ended, Folder};
use serde_json::Value;

#[test]
fn what_is_wrong_with_the_mask_is_reported_of_the_mask() {
    let folder = folder();
    folder.write("dent.wkt", "POLYGON((0 0,3 0,1 1,0 3,0 0))");
    folder.write("two.wkt", "POLYGON((0 0,1 0,1 1,0 0))\nPOLYGON((2 2,3 2,3 3,2 2))");
    folder.write("bad.geojson", "{\"type\":\"Polygon\",\n\"coordinates\":[[[0,0],[3,oops]]]}");
    folder.write("right.wkt", "POLYGON((0 0,3 0,0 3,0 0))");
    let hodgman = "--algorithm sutherland-hodgman";
    for (mask, options, printed) in [
        ("dent.wkt", hodgman, "dent.wkt: polygon is a ring of 4 vertices; it must be convex"),
        ("two.wkt", hodgman, "two.wkt: a clip polygon that is not one ring"),
        ("bad.geojson", "", "bad.geojson: line 2, column 26: "),
        (
            "right.wkt",
            "--fill-rule negative",
            "right.wkt: by --fill-rule negative its polygons enclose nothing",
        ),
    ] {
        let line = format!("clip in.geojson --by {mask} {options} -o o.geojson");
        folder.run(&line).fails(1, printed);
    }
    folder.must(&format!("clip in.geojson --by right.wkt {hodgman} -o o.geojson"));
    let empty =
        folder.must("clip in.geojson --by right.wkt --outside --fill-rule negative -o o.wkt");
    assert!(empty.err.contains("enclose nothing in it; nothing is cut away"), "{}", empty.err);
}

#[test]
fn masks_that_are_made_valid_are_reported() {
    let folder = Folder::new();
    folder.write("in.wkt", "POLYGON((0 0,4 0,4 4,0 4,0 0))");
    folder.write("bow.wkt", "POLYGON((0 0,3 3,3 0,0 3,0 0))");
    folder.write("right.wkt", "POLYGON((0 0,3 0,0 3,0 0))");
    let printed = |mask: &str| folder.must(&format!("clip in.wkt --by {mask} -o o.wkt")).err;
    assert!(printed("bow.wkt").contains("bow.wkt: polygons crossed"), "{}", printed("bow.wkt"));
    assert_eq!(printed("right.wkt"), "");
    assert_eq!(printed("bow.wkt --fill-rule non-zero"), "");
}

#[test]
fn paths_of_an_svg_enclose_what_their_fill_rule_says() {
    let folder = Folder::new();
    let path = "d='M0 0h9v9h-9zM3 3h3v3h-3z'";
    folder.write("a.svg", format!("<svg><path {path}/><path fill-rule='evenodd' {path}/></svg>"));
    for (options, area) in [
        ("", 81.0 + 72.0),
        ("--fill-rule even-odd", 144.0),
        ("--fill-rule non-zero", 162.0),
        ("--algorithm greiner-hormann", 81.0 + 72.0),
        ("--op xor", 9.0),
    ] {
        let line = format!("clip a.svg --window=-9,-9,9,9 {options} -o o.wkt --json");
        let line =
            if options.contains("op") { line.replace("--window=-9,-9,9,9", "") } else { line };
        let ended = folder.must(&line);
        assert_eq!(
            (&ended.json()["out"]["area"], &ended.err[..]),
            (&Value::from(area), ""),
            "{options}"
        );
    }
}

#[test]
fn coordinate_systems_are_kept_or_named() {
    let folder = Folder::new();
    folder.write("a.wkt", "SRID=4326;POINT(1 2)\nPOINT(3 4)\nSRID=4326;POLYGON((0 0,1 0,1 1,0 0))");
    folder.write(
        "b.wkt",
        "SRID=4326;POLYGON((0 0,1 0,1 1,0 0))\nSRID=3857;POLYGON((4 0,5 0,5 1,4 0))",
    );
    folder.write("mask.wkt", "SRID=3857;POLYGON((0 0,9 0,9 9,0 9,0 0))");
    let window = "--window 0,0,9,9";
    let kept = folder.must(&format!("clip a.wkt {window} -o o.hex"));
    assert_eq!(kept.err, "");
    folder.must(&format!("clip o.hex {window} -o o.wkt"));
    let text = String::from_utf8(folder.read("o.wkt")).unwrap();
    assert!(text.starts_with("SRID=4326;POINT (1 2)\nPOINT (3 4)\nSRID=4326;POLYGON"), "{text}");
    folder.must("clip a.wkt --op union -o o.wkt");
    assert!(folder.read("o.wkt").starts_with(b"SRID=4326;POLYGON"));
    for (line, printed) in [
        (
            "clip b.wkt --window 0,0,9,9 -o o.geojson",
            "SRIDs 4326, 3857 are left out: geojson has no place for it",
        ),
        ("clip a.wkt --by mask.wkt -o o.wkt", "the mask has another SRID"),
        (
            "clip b.wkt --op union -o o.wkt",
            "features of several SRIDs are joined; the result has none",
        ),
    ] {
        let ended = folder.must(line);
        assert_eq!(ended.err.matches(printed).count(), 1, "{line}: {}", ended.err);
    }
}

#[test]
fn all_coordinate_systems_are_named() {
    let folder = Folder::new();
    let points = |srids: std::ops::Range<u32>| {
        srids.map(|s| format!("SRID={};POINT(1 1)\n", 3000 + s % 7)).collect::<String>()
    };
    folder.write("two.wkt", points(0..2));
    folder.write("many.wkt", points(0..70));
    for (name, printed) in [
        ("two", "SRIDs 3000, 3001 are left out: geojson"),
        ("many", "SRIDs 3000, 3001, 3002, 3003 and others are left out"),
    ] {
        let ended = folder.must(&format!("clip {name}.wkt --window 0,0,9,9 -o o.geojson"));
        assert!(ended.err.contains(printed), "{}", ended.err);
    }
    folder.write("mask.wkt", "SRID=4326;POLYGON((0 0,9 0,9 9,0 0))");
    let ended = folder.must("clip two.wkt --by mask.wkt -o o.wkt");
    assert!(ended.err.contains("SRID 4326 and not SRIDs 3000, 3001"), "{}", ended.err);
}

#[test]
fn a_full_standard_output_is_reported_by_its_name() {
    let Ok(full) = std::fs::OpenOptions::new().write(true).open("/dev/full") else { return };
    let folder = Folder::new();
    folder.write("a.wkt", "POINT(1 2)\n".repeat(20_000));
    let mut command = folder.command("clip a.wkt --window 0,0,9,9 -o -");
    let ended = Ended::of(command.stdout(full).output().unwrap());
    ended.fails(1, "durer: standard output: ");
}

#[test]
fn grids_too_fine_are_reported_what_would_do() {
    let folder = Folder::new();
    folder.write("a.wkt", "POLYGON((0 0,9 0,9 9,0 0))");
    for (grid, printed) in [
        ("1e-300", "grid is 1e-300, where 8e-12 would do; it must be coarse enough"),
        ("1e-310", "grid is 1e-310; it must be a finite size above zero, from 2.3e-308 on"),
    ] {
        let line = format!("clip a.wkt --window 0,0,5,5 -o o.wkt --grid {grid}");
        folder.run(&line).fails(1, printed);
    }
    folder.must("clip a.wkt --window 0,0,5,5 -o o.wkt --grid 8e-12");
}

#[test]
fn an_empty_file_of_any_format_has_no_features() {
    let folder = Folder::new();
    for suffix in ["geojson", "geojsonl", "geojsons", "wkt", "wkb", "hex"] {
        let name = format!("empty.{suffix}");
        folder.write(&name, "");
        let ended = folder.must(&format!("clip {name} --window 0,0,5,5 -o o.geojson"));
        let printed = format!("{name}: there is no feature in it");
        assert_eq!(ended.err.matches(&printed).count(), 1, "{}", ended.err);
        assert!(folder.read("o.geojson").starts_with(b"{\"type\":\"FeatureCollection\""));
    }
    folder.write("empty.svg", "");
    folder.run("clip empty.svg --window 0,0,5,5 -o o.wkt").fails(1, "there is no svg element");
}

#[test]
fn tiles_to_a_stream_are_geojson_whatever_comes_in() {
    let folder = Folder::new();
    let line = "clip - --tiles 0 -o -";
    let tile = text(piped(&folder, line, b"POINT(1 2)"));
    assert!(tile.contains("\"tile\":\"0/0/0\"") && tile.lines().count() == 1, "{tile}");
    folder.write("a.wkt", "POINT(1 2)");
    folder.run("clip a.wkt --tiles 0 -o b.wkt").fails(2, "tiles are written as GeoJSON");
}

#[test]
fn masks_too_small_for_the_grid_are_reported() {
    let folder = Folder::new();
    folder.write("a.wkt", "POLYGON((0 0,1 0,1 1,0 1,0 0))\nPOLYGON((0 0,1e6 0,1e6 1e6,0 1e6,0 0))");
    let small =
        |size: &str| format!("POLYGON((0.5 0.5,{size} 0.5,{size} {size},0.5 {size},0.5 0.5))");
    // 10⁻⁷ is less than 10⁶ · 2⁻⁴⁰, but not less than 2⁻⁴⁰.
    for (size, features) in [("0.5000001", 1), ("0.75", 0)] {
        folder.write("mask.wkt", small(size));
        let ended = folder.must("clip a.wkt --by mask.wkt -o o.wkt --json");
        let printed = "may be lost at 1 feature";
        assert_eq!(ended.err.contains(printed), features > 0, "{size}: {}", ended.err);
    }
    folder.write("mask.wkt", format!("{}\nPOLYGON((0 0,1e6 0,1e6 1e6,0 0))", small("0.5000001")));
    let ended = folder.must("clip a.wkt --by mask.wkt -o o.wkt");
    assert!(ended.err.contains("mask.wkt: polygons smaller than a cell"), "{}", ended.err);
}

#[test]
fn what_came_before_a_bad_line_is_put_out() {
    let folder = Folder::new();
    let line =
        r#"{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[1,2]}}"#;
    for good in [1, 300] {
        let input =
            format!("{}{{\"type\":\"Feature\",oops}}\n{line}\n", format!("{line}\n").repeat(good));
        for options in ["--window 0,0,5,5", "--tiles 0"] {
            let ended =
                piped(&folder, &format!("clip - {options} -o - --to geojsonl"), input.as_bytes());
            ended.fails(1, &format!("standard input: line {}, column 19: ", good + 1));
            assert_eq!(text(ended).lines().count(), good, "{options}");
        }
    }
}
