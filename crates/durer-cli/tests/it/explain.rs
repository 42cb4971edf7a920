//! `durer explain`: algorithms step by step.

use crate::harness::{Folder, Picture};

const PLAN: &str = r#"{"type":"FeatureCollection","features":[
 {"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[1,0],[12,0],[12,3],[4,3],[4,6],[12,6],[12,9],[1,9],[1,0]]]}},
 {"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[[0,1],[13,8]]}}]}"#;

fn text(folder: &Folder, arguments: &str) -> String {
    String::from_utf8(folder.must(arguments).out).unwrap()
}

#[test]
fn algorithms_and_examples_are_listed() {
    let folder = Folder::new();
    let all = text(&folder, "explain");
    assert!(
        all.contains("cohen-sutherland  (Cohen–Sutherland: Danny Cohen, Ivan Sutherland, 1967)"),
        "{all}"
    );
    let one = text(&folder, "explain cohen-sutherland --list --lang de");
    assert!(
        one.contains("line-eh") && one.contains("der Vorlesung") && !one.contains("liang-barsky"),
        "{one}"
    );
    let german = text(&folder, "explain back-face-removal --list --lang de");
    assert!(german.contains("(Entfernen von Rückseiten: "), "{german}");
}

#[test]
fn captions_are_text_without_an_output() {
    let folder = Folder::new();
    let printed = text(&folder, "explain cohen-sutherland --example line-eh");
    let lines: Vec<&str> = printed.lines().collect();
    assert_eq!(lines.len(), 4, "{printed}");
    assert_eq!(
        lines[0],
        "   1  [ 1]  Codes 0001 of A (left) and 0010 of B (right): OR is 0011, AND is 0000."
    );
    let german = text(&folder, "explain cohen-sutherland --example line-eh --lang de");
    assert!(
        german.starts_with(
            "   1  [ 1]  Codes 0001 von A (links) und 0010 von B (rechts): ODER gibt 0011"
        ),
        "{german}"
    );
}

#[test]
fn a_sheet_a_step_data_and_a_page_are_written() {
    let folder = Folder::new();
    folder.must("explain liang-barsky -o a.svg --columns 3");
    let sheet = String::from_utf8(folder.read("a.svg")).unwrap();
    assert!(
        sheet.starts_with("<svg") && sheet.matches("<svg ").count() == 8,
        "seven steps in one sheet"
    );
    folder.must("explain liang-barsky -o one.svg --step 2");
    let one = String::from_utf8(folder.read("one.svg")).unwrap();
    assert_eq!(one.matches("<svg ").count(), 2);
    assert!(one.contains("t = q/p"), "the table");
    folder.must("explain liang-barsky -o a.png --step 2");
    assert!(Picture::decode(&folder.read("a.png")).shows_something());
    folder.must("explain liang-barsky -o a.json");
    let json: serde_json::Value = serde_json::from_slice(&folder.read("a.json")).unwrap();
    assert_eq!((&json["algorithm"], &json["year"]), (&"liang-barsky".into(), &1984.into()));
    assert_eq!(json["frames"].as_array().unwrap().len(), 7);
    let first = &json["frames"][0];
    assert_eq!((&first["kind"], &first["line"]), (&"border".into(), &4.into()));
    assert!(first["values"]["t"].is_number() && first["picture"]["marks"].is_array());
    folder.must("explain liang-barsky -o a.html --lang de");
    let page = String::from_utf8(folder.read("a.html")).unwrap();
    assert!(page.contains("<html lang=\"de\">") && page.contains("Zustand"));
    // The page loads nothing: its only address is the XML namespace of SVG.
    let rest = page.replace("http://www.w3.org/2000/svg", "");
    assert!(
        !rest.contains("http:")
            && !rest.contains("https:")
            && !rest.contains("{{")
            && !rest.contains("src=")
    );
}

#[test]
fn own_shapes_are_explained() {
    let folder = Folder::new();
    folder.write("plan.geojson", PLAN);
    folder.write("plan.wkt", "LINESTRING (-4 -2.5, 12.5 8.5)");
    let printed = text(&folder, "explain sutherland-hodgman plan.geojson --window 6,1,10,8");
    assert!(printed.contains("8 vertices are left"), "{printed}");
    let printed = text(&folder, "explain cohen-sutherland plan.wkt --window 0,0,10,6");
    assert!(printed.contains("accepted") && printed.lines().count() > 4, "{printed}");
    let printed =
        text(&folder, "explain cohen-sutherland plan.wkt --window 0,0,10,6 --max-steps 2");
    assert!(printed.contains("2 steps are shown; "), "{printed}");
}

#[test]
fn what_is_wrong_is_reported() {
    let folder = Folder::with_models();
    folder.write("plan.geojson", PLAN);
    folder.write("a.svg", "<svg xmlns='http://www.w3.org/2000/svg' width='8' height='5'><rect width='4' height='5'/></svg>");
    folder.must("draw a.svg -o a.png");
    folder.must("draw a.svg -o large.png --size 80x50");
    for (arguments, code, part) in [
        ("explain cohen-suterland", 2, "cohen-sutherland"),
        ("explain cohen-sutherland --example none", 2, "line-eh"),
        ("explain cohen-sutherland plan.geojson", 2, "a window and a line"),
        ("explain cohen-sutherland cube.obj", 2, "a window and a line"),
        ("explain cohen-sutherland a.png --at 7,4", 2, "a picture"),
        ("explain cohen-sutherland a.png --at 8,4", 2, "8x5"),
        ("explain cohen-sutherland large.png", 1, "limit of 2000"),
        ("explain cohen-sutherland none.geojson", 1, "none.geojson"),
        ("explain cohen-sutherland -o a.gif", 2, ".html"),
        ("explain cohen-sutherland --step 99", 2, "1 to "),
        ("explain cohen-sutherland --window 0,0,1,1", 2, "INPUT"),
        ("explain cohen-sutherland --lang fr", 2, "fr"),
    ] {
        folder.run(arguments).fails(code, part);
    }
}

#[test]
fn more_points_than_can_be_explained_are_an_error_of_the_file() {
    let folder = Folder::new();
    let on_circle = |i: i32| f64::from(i) * std::f64::consts::TAU / 2500.0;
    let points: Vec<String> =
        (0..2500).map(|i| format!("{:.6} {:.6}", on_circle(i).cos(), on_circle(i).sin())).collect();
    let ring = points.join(", ");
    folder.write("ring.wkt", format!("POLYGON (({ring}, {}))", points[0]));
    let run = folder.run("explain sutherland-hodgman ring.wkt -o steps.svg");
    run.fails(1, "ring.wkt: the number of points to be explained is 2500, above the limit of 2000; take a part of it");
    assert!(!folder.names().contains(&"steps.svg".to_owned()));
}

#[test]
fn names_of_algorithms_may_be_written_as_in_texts() {
    let folder = Folder::new();
    let steps = folder.must("explain cohen-sutherland").out;
    for name in ["Cohen-Sutherland", "cohen_sutherland", "Cohen–Sutherland"] {
        assert_eq!(folder.must(&format!("explain {name}")).out, steps, "{name}");
    }
    folder.run("explain cohen").fails(2, "the nearest are: cohen-sutherland");
}
