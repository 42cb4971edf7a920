//! `durer clip`: common borders of neighbours stay common.

use crate::clip::text;
use crate::harness::{Ended, Folder};

/// Clips one layer by another with the given options; returns the lines of the result and the messages.
fn clip(input: &str, mask: &str, options: &str) -> (Vec<String>, String) {
    let folder = Folder::new();
    folder.write("in.wkt", input);
    folder.write("m.wkt", mask);
    let ended: Ended = folder.must(&format!("clip in.wkt {options} -o -"));
    let printed = ended.err.clone();
    (text(ended).lines().map(str::to_owned).collect(), printed)
}

const PARCELS: &str = "POLYGON((0 0,10 0,10 5,10 10,0 10,0 0))\n\
                       POLYGON((10 0,20 0,20 5,10 5,10 0))\n\
                       POLYGON((10 5,20 5,20 10,10 10,10 5))";

const ALL: &str = "POLYGON((-1 -1,25 -1,25 11,-1 11,-1 -1))";

#[test]
fn the_node_of_two_neighbours_stays_on_the_edge_of_the_third() {
    let whole = [
        "POLYGON ((0 0, 10 0, 10 5, 10 10, 0 10, 0 0))",
        "POLYGON ((10 0, 20 0, 20 5, 10 5, 10 0))",
        "POLYGON ((10 5, 20 5, 20 10, 10 10, 10 5))",
    ];
    assert_eq!(clip(PARCELS, ALL, "--by m.wkt").0, whole);
    let (cut, _) = clip(PARCELS, "POLYGON((-1 -1,15 -1,14 11,-1 11,-1 -1))", "--by m.wkt");
    assert_eq!(cut[0], whole[0]);
    assert_eq!(cut[1], "POLYGON ((10 0, 14.916666666666666 0, 14.5 5, 10 5, 10 0))");
    assert_eq!(cut[2], "POLYGON ((10 5, 14.5 5, 14.083333333333334 10, 10 10, 10 5))");
    // A mask around all parcels adds only their own outline.
    let (cut, _) = clip(PARCELS, "POLYGON((0 0,20 0,20 10,0 10,0 0))", "--by m.wkt");
    assert_eq!(cut, whole);
}

#[test]
fn heights_of_a_ridge_stay_and_those_of_cuts_are_the_same_from_both_sides() {
    let ridge = "POLYGON Z((0 0 0,5 0 100,10 0 0,10 10 0,0 10 0,0 0 0))";
    let (cut, _) = clip(ridge, ALL, "--by m.wkt");
    assert_eq!(cut, ["POLYGON Z ((0 0 0, 5 0 100, 10 0 0, 10 10 0, 0 10 0, 0 0 0))"]);
    let pair = "POLYGON Z((0 0 3,0.7 0 1.1,0.1 9 7.7,0 9 1,0 0 3))\n\
                POLYGON Z((0.7 0 1.1,3 0 1,3 9 2,0.1 9 7.7,0.7 0 1.1))";
    let mask = "POLYGON((-1 3,4 3.3,4 8,-1 7.1,-1 3))";
    let (cut, _) = clip(pair, mask, "--by m.wkt");
    let vertices = |line: &str| -> Vec<String> {
        let inner = line.trim_start_matches("POLYGON Z ((").trim_end_matches("))");
        inner.split(", ").map(str::to_owned).collect()
    };
    let (left, right) = (vertices(&cut[0]), vertices(&cut[1]));
    assert_eq!(left.iter().filter(|vertex| right.contains(vertex)).count(), 2, "{cut:?}");
}

#[test]
fn neighbours_of_any_size_get_the_same_points_on_their_common_edge() {
    let pair = "POLYGON((1 2,2 5,-300 5,-300 2,1 2))\nPOLYGON((2 5,1 2,4 2,4 5,2 5))";
    let mask = "POLYGON((-1 3,5 3.1,5 4.2,-1 4,-1 3))";
    for options in ["--by m.wkt", "--by m.wkt --outside"] {
        let (cut, _) = clip(pair, mask, options);
        for point in
            ["1.3463687150837989 3.0391061452513966", "1.696629213483146 4.089887640449438"]
        {
            assert!(cut.iter().all(|line| line.contains(point)), "{options}: {cut:?}");
        }
    }
    // A line ends at the common edge too.
    let (cut, _) = clip("LINESTRING(1 2,2 5)", mask, "--by m.wkt");
    assert_eq!(
        cut,
        ["LINESTRING (1.3463687150837989 3.0391061452513966, 1.696629213483146 4.089887640449438)"]
    );
}

#[test]
fn borders_of_windows_are_met_exactly_by_what_has_to_be_repaired_too() {
    let bows = "MULTIPOLYGON(((0 0,10 1,10 9,0.5 10,0 0)),((-170.3 60,-160.1 70,-160.2 60.3,-170 70.1,-170.3 60)))";
    let valid = "POLYGON((0 0,10 1,10 9,0.5 10,0 0))";
    let window = "--window 3.3333333,-5,7.7777777,20";
    let corners =
        ["3.3333333 0.33333333", "3.3333333 9.701754389473685", "7.7777777 9.233918136842105"];
    for input in [bows, valid] {
        for options in [window.to_owned(), format!("{window} --outside")] {
            let (cut, _) = clip(input, "", &options);
            assert!(corners.iter().all(|corner| cut[0].contains(corner)), "{options}: {cut:?}");
        }
    }
}

#[test]
fn collections_are_sets_of_points() {
    let both =
        "GEOMETRYCOLLECTION(POLYGON((0 0,6 0,6 6,0 6,0 0)),POLYGON((4 0,10 0,10 6,4 6,4 0)))";
    let (union, printed) = clip(both, "", "--op union");
    assert_eq!(union, ["POLYGON ((0 0, 4 0, 6 0, 10 0, 10 6, 6 6, 4 6, 0 6, 0 0))"]);
    assert_eq!(printed, "");
    // The same holds for a mask.
    let (cut, _) = clip("POINT(5 3)", both, "--by m.wkt");
    assert_eq!(cut, ["POINT (5 3)"]);
}

#[test]
fn repairs_and_lines_without_length_are_reported() {
    let (_, printed) = clip("POLYGON((0 0,10 10,10 0,0 10,0 0))", "", "--op union");
    assert!(printed.contains("made valid by the even-odd rule"), "{printed}");
    let lines = "LINESTRING(1 1,1 1)\nMULTILINESTRING((1 1,1 1),(0 0,1 0))\nLINESTRING(9 9,9 9)";
    let (cut, printed) = clip(lines, "", "--window 0,0,4,4");
    assert_eq!(cut, ["LINESTRING (0 0, 1 0)"]);
    assert!(printed.contains("left out: 2 lines without length"), "{printed}");
}

#[test]
fn positions_of_mixed_dimensions_keep_their_heights() {
    let folder = Folder::new();
    folder.write("in.geojson", r#"{"type":"LineString","coordinates":[[1,1],[2,2,5],[3,3,6]]}"#);
    let out = text(folder.must("clip in.geojson --window 0,0,2.5,2.5 --to wkt -o -"));
    assert_eq!(out.trim(), "LINESTRING Z (1 1 0, 2 2 5, 2.5 2.5 5.5)");
}

#[test]
fn windows_go_across_the_180th_meridian() {
    let over =
        "POLYGON((170 -10,190 -10,190 10,170 10,170 -10))\nPOINT(185 5)\nPOINT(-175 5)\nPOINT(0 0)";
    let (cut, printed) = clip(over, "", "--window 175,-10,-170,5");
    assert_eq!(cut[0], "POLYGON ((175 -10, 190 -10, 190 5, 175 5, 175 -10))");
    assert_eq!(cut[1..], ["POINT (185 5)", "POINT (-175 5)"]);
    assert_eq!(printed, "");
    let (cut, printed) = clip("LINESTRING(175 5,-175 5)", "", "--window 170,-10,-170,10");
    assert_eq!(cut, ["MULTILINESTRING ((175 5, 170 5), (-170 5, -175 5))"]);
    assert!(printed.contains("more than 180 degrees of longitude"), "{printed}");
}

#[test]
fn borders_that_only_touch_in_huge_coordinates_have_no_area_in_common() {
    let subject =
        "POLYGON((0 0,1e154 0,1e154 1e154,2e154 1e154,2e154 0,3e154 0,3e154 2e154,0 2e154,0 0))";
    let mask = "POLYGON((0 0,0 -1e154,2.5e154 -1e154,2.5e154 0,0 0))";
    for exponent in ["154", "200", "299"] {
        let huge = |text: &str| text.replace("e154", &format!("e{exponent}"));
        for algorithm in ["weiler-atherton", "greiner-hormann"] {
            let options = format!("--by m.wkt --algorithm {algorithm}");
            assert_eq!(clip(&huge(subject), &huge(mask), &options).0, Vec::<String>::new());
            let up = huge(mask).replace("-1e", "1e");
            let (cut, _) = clip(&huge(subject), &up, &options);
            assert_eq!(cut.len(), 1, "{algorithm} {exponent} {cut:?}");
        }
    }
}

#[test]
fn cutting_once_more_changes_nothing() {
    let star = "POLYGON((0.1 0.2,7.3 1.1,9.7 8.3,5.1 3.3,1.7 9.1,0.1 0.2))";
    let mask = "POLYGON((-1 1.3,11 2.7,10.1 7.9,-2.3 6.1,-1 1.3))";
    for options in ["--by m.wkt", "--by m.wkt --outside"] {
        let (once, _) = clip(star, mask, options);
        assert_eq!(clip(&once.join("\n"), mask, options).0, once, "{options}");
        let other =
            if options.ends_with("outside") { "--by m.wkt" } else { "--by m.wkt --outside" };
        assert_eq!(clip(&once.join("\n"), mask, other).0, Vec::<String>::new());
    }
}
