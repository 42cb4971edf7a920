//! `durer draw`: drawings and maps to pictures.

use crate::harness::{Ended, Folder, Picture};
use std::io::Write;
use std::process::Stdio;

const RED_SQUARE: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 10">
<rect width="10" height="10" fill="#f00"/></svg>"##;

/// A square with a hole, a line and a point, in the range 0 … 100.
const MAP: &str = r#"{"type":"FeatureCollection","features":[
{"type":"Feature","properties":{"name":"Ring","n":7},"geometry":{"type":"Polygon","coordinates":[
 [[10,10],[90,10],[90,90],[10,90],[10,10]],[[40,40],[60,40],[60,60],[40,60],[40,40]]]}},
{"type":"Feature","properties":{"name":null},"geometry":{"type":"LineString","coordinates":[[0,5],[100,5]]}},
{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[50,50]}}]}"#;

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("a.svg", RED_SQUARE);
    folder.write("map.geojson", MAP);
    folder.write("point.wkt", "POINT (50 50)");
    folder
}

fn picture(folder: &Folder, name: &str) -> Picture {
    Picture::decode(&folder.read(name))
}

#[test]
fn a_drawing_has_its_own_size_and_a_transparent_ground() {
    let folder = folder();
    folder.must("draw a.svg -o a.png");
    let found = picture(&folder, "a.png");
    assert_eq!(found.size(), (20, 10));
    assert_eq!(found.pixel(9, 5), [255, 0, 0, 255]);
    assert_eq!(found.pixel(10, 5), [0, 0, 0, 0]);
}

#[test]
fn sizes_may_leave_one_side_open() {
    let folder = folder();
    for (size, expected) in [("100x", (100, 50)), ("x100", (200, 100)), ("30x30", (30, 30))] {
        folder.must(&format!("draw a.svg -o a.png --size {size} --background white"));
        assert_eq!(picture(&folder, "a.png").size(), expected);
    }
    // A picture of another shape has the drawing in its middle.
    let found = picture(&folder, "a.png");
    assert_eq!((found.pixel(5, 15), found.pixel(5, 5)), (&[255, 0, 0][..], &[255, 255, 255][..]));
}

#[test]
fn maps_beyond_all_measure_are_bad_data() {
    let folder = folder();
    for line in ["0 0, 1e308 0", "-1e308 0, 1e308 5", "1e300 1e300, 0 1"] {
        folder.write("far.wkt", format!("LINESTRING ({line})"));
        let ended = folder.run("draw map.geojson far.wkt -o a.png");
        assert_eq!(ended.code, 1, "{ended:?}");
        assert!(
            ended.err.contains("far.wkt: coordinates reach from (") && ended.err.len() < 250,
            "{ended:?}"
        );
        folder.must("draw far.wkt --window 0,-1,2,1 -o a.png");
    }
}

#[test]
fn drawings_beyond_all_measure_are_bad_data() {
    let folder = folder();
    let strokes = "<g transform='scale(-2 1)'><g transform='scale(1e20)'><g transform='rotate(30)'>
        <path d='M1 1L9 9h-5v-3q2 2 3 0t1 1s2 2 3 3A5 3 20 1 0 9 9' stroke='lime'/></g></g></g>";
    folder.write(
        "far.svg",
        format!("<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>{strokes}</svg>"),
    );
    let ended = folder.run("draw far.svg -o b.png");
    ended.fails(1, "far.svg: the drawing cannot be laid out");
    assert!(!ended.err.contains("panicked") && !folder.path("b.png").exists(), "{ended:?}");
}

#[test]
fn windows_and_viewports_choose_the_part_and_its_place() {
    let folder = folder();
    folder.must("draw a.svg -o a.png --size 40x40 --window 5,0,15,10 --viewport 20,20,20,20 --background white");
    let found = picture(&folder, "a.png");
    assert_eq!(found.pixel(29, 30), [255, 0, 0]);
    assert_eq!(found.pixel(31, 30), [255, 255, 255]);
    assert_eq!(found.pixel(10, 10), [255, 255, 255]);
    folder
        .run("draw a.svg -o b.png --size 40x40 --viewport 30,30,20,20")
        .fails(2, "--viewport reaches beyond the picture of 40x40");
}

#[test]
fn edges_are_smoothed_or_not() {
    let folder = folder();
    folder.write("slope.wkt", "POLYGON ((0 0, 100 0, 100 37))");
    let grey =
        |name: &str| picture(&folder, name).pixels().filter(|p| p[0] != 255 && p[0] != 0).count();
    let style = "draw --fill black --stroke none slope.wkt --size 99x";
    folder.must(&format!("{style} -o a.png"));
    folder.must(&format!("{style} -o b.png --aa none"));
    assert!(grey("a.png") > 20 && grey("b.png") == 0);
}

#[test]
fn neighbours_of_one_colour_leave_no_seam() {
    let folder = folder();
    // Two areas that each follow their irregular common border differently; one in a hole of the first; two that
    // overlap; and a self-intersecting one.
    let border: Vec<String> =
        (0..=300).map(|i| format!("{} {}", 50 + (i * 37) % 11, 5.0 + f64::from(i) * 0.3)).collect();
    let (up, down) = (border.join(","), border.iter().rev().cloned().collect::<Vec<_>>().join(","));
    let hole = "20 40, 23 61.5, 33 63, 34 41, 20 40";
    folder.write(
        "areas.wkt",
        format!(
            "POLYGON (({up}, 10 95, 10 5, 50 5), ({hole}))\nPOLYGON (({down}, 90 5, 90 95, {}))\n\
             POLYGON (({hole}))\nPOLYGON ((70 20, 88 21, 80 60, 70 20))\nPOLYGON ((70 30, 80 80, 60 70, 70 30))\n\
             POLYGON ((96 10, 99 10, 96 40, 99 40, 96 10))",
            border[300]
        ),
    );
    let draw = "draw areas.wkt --fill #204060 --size 333x333 --window 0,0,100,100";
    folder.must(&format!("{draw} --stroke none -o a.png"));
    let found = picture(&folder, "a.png");
    for (x, y) in (40..293).flat_map(|x| (20..313).map(move |y| (x, y))) {
        assert_eq!(found.pixel(x, y), [0x20, 0x40, 0x60], "{x},{y}");
    }
    assert_eq!(found.pixel(325, 215), [0x20, 0x40, 0x60], "the lower half of the eight");
    // Translucent areas are painted one by one: overlaps are darker.
    folder.must(&format!("{} --stroke none -o b.png", draw.replace("#204060", "#20406080")));
    let found = picture(&folder, "b.png");
    assert!(found.pixel(245, 240)[0] < found.pixel(100, 300)[0]);
}

#[test]
fn fills_without_borders_are_as_exact_as_others() {
    // Many corners that lie on no grid, in few pixels.
    let ring: Vec<String> = (0..=60)
        .map(|i| {
            let angle = f64::from(i % 60) * std::f64::consts::TAU / 60.0;
            let radius = if i % 2 == 0 { 3.03 } else { 2.41 };
            format!("[{:.6},{:.6}]", 4.0 + radius * angle.cos(), 4.0 + radius * angle.sin())
        })
        .collect();
    let ring = ring.join(",");
    let folder = Folder::new();
    folder.write("a.json", format!(r#"{{"type":"Polygon","coordinates":[[{ring}]]}}"#));
    let path = ring.replace("],[", " L").replace(['[', ']'], "");
    let svg = r##"<svg xmlns="http://www.w3.org/2000/svg" width="8" height="8">
<rect width="8" height="8" fill="#fff"/><path transform="matrix(1 0 0 -1 0 8)" d="M"##;
    folder.write("a.svg", format!("{svg}{path}Z\"/></svg>"));
    folder.must("draw a.json --fill black --stroke none -o a.png --window 0,0,8,8 --size 8x8");
    folder.must("draw a.svg -o b.png");
    let (map, drawing) = (picture(&folder, "a.png"), picture(&folder, "b.png"));
    for (x, y) in (0..64).map(|i| (i % 8, i / 8)) {
        let (a, b) = (map.pixel(x, y)[0], drawing.pixel(x, y)[0]);
        assert!(a.abs_diff(b) <= 1, "{a} and {b} at {x}, {y}");
    }
}

#[test]
fn a_map_has_holes_lines_and_markers() {
    let folder = folder();
    let colors = "--fill #00f --stroke #f00 --stroke-width 2 --marker square --marker-size 10";
    folder.must(&format!("draw {colors} map.geojson -o m.png --size 100x100 --window 0,0,100,100"));
    let found = picture(&folder, "m.png");
    let (blue, red, white) = ([0, 0, 255], [255, 0, 0], [255, 255, 255]);
    assert_eq!(found.pixel(20, 20), blue, "area");
    assert_eq!(found.pixel(42, 42), white, "hole");
    assert_eq!(found.pixel(50, 50), blue, "marker");
    assert_eq!(found.pixel(50, 44), red, "border of the marker");
    assert_eq!(found.pixel(3, 95), red, "line: y grows upwards");
    assert_eq!(found.pixel(3, 5), white);
}

#[test]
fn each_layer_has_the_style_that_follows_it() {
    let folder = folder();
    let at = "--size 100x100 --window 0,0,100,100 -o m.png";
    folder.must(&format!(
        "draw --stroke none map.geojson --fill #0a0 point.wkt --fill red --marker-size 30 {at}"
    ));
    let found = picture(&folder, "m.png");
    assert_eq!(found.pixel(20, 20), [0, 170, 0]);
    assert_eq!(found.pixel(50, 40), [255, 0, 0]);
    assert_eq!(found.pixel(10, 95), [255, 255, 255], "no stroke for both");
}

#[test]
fn labels_are_drawn_once_and_never_overlap() {
    let folder = folder();
    let points: Vec<String> = (0..40)
        .map(|i| format!(r#"{{"type":"Feature","properties":{{"name":"Place {i}"}},"geometry":{{"type":"Point","coordinates":[{},{}]}}}}"#, i % 7, i % 5))
        .collect();
    folder.write("many.geojsonl", points.join("\n"));
    let report = folder.must("draw many.geojsonl --label name -o m.png --size 200x --json").json();
    let map = &report["layers"][0]["map"];
    let count = |name: &str| map[name].as_u64().unwrap();
    assert_eq!((count("features"), count("points")), (40, 40));
    assert!(count("labels") > 3 && count("labels_left_out") > 3, "{map}");
    assert_eq!(count("labels") + count("labels_left_out"), 40);
    folder
        .run("draw map.geojson --label nom -o m.png")
        .fails(1, "no feature has this property; there are: n, name");
    let report = folder.must("draw map.geojson --label n --label-size 40 -o m.png --json").json();
    assert_eq!(report["layers"][0]["map"]["labels"], 1);
    let dark = picture(&folder, "m.png").pixels().filter(|p| p[0] < 0x40).count();
    assert!(dark > 5, "the label is to be seen");
}

#[test]
fn an_area_whose_best_place_is_taken_has_others() {
    let folder = folder();
    let area = |name: &str, [x0, y0, x1, y1]: [i32; 4]| {
        format!(
            r#"{{"type":"Feature","properties":{{"name":"{name}"}},"geometry":{{"type":"Polygon","coordinates":[[[{x0},{y0}],[{x1},{y0}],[{x1},{y1}],[{x0},{y1}],[{x0},{y0}]]]}}}}"#
        )
    };
    // Both names have the same best position.
    let both = ["one", "two"].map(|name| area(name, [0, 0, 100, 100]));
    folder.write("areas.geojsonl", both.join("\n"));
    let report = folder.must("draw areas.geojsonl --label name -o m.png --size 200x --json").json();
    let map = &report["layers"][0]["map"];
    assert_eq!((map["labels"].as_u64(), map["labels_left_out"].as_u64()), (Some(2), Some(0)));
}

#[test]
fn what_a_map_cannot_use_is_reported() {
    let folder = folder();
    folder.write("no.ttf", "no font");
    folder.run("draw map.geojson --font no.ttf -o m.png").fails(1, "it is not a TrueType");
    let printed = folder.must("draw map.geojson --dashes 0.0001 -o m.png").err;
    assert!(printed.contains("more than 100,000 dashes"), "{printed}");
    let printed = folder.must("draw map.geojson --dashes 4 --stroke hsl(0,100%,50%) -o m.png").err;
    assert!(!printed.contains("dashes"), "{printed}");
}

#[test]
fn threads_change_nothing() {
    let folder = folder();
    for threads in [1, 3] {
        folder.must(&format!("draw map.geojson --label name -o {threads}.png --threads {threads}"));
    }
    assert_eq!(folder.read("1.png"), folder.read("3.png"));
}

#[test]
fn streams_are_read_and_written() {
    let folder = folder();
    let mut command = folder.command("draw - -o - --size 20x");
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(RED_SQUARE.as_bytes()).unwrap();
    let ended = Ended::of(child.wait_with_output().unwrap());
    assert_eq!(ended.code, 0, "{}", ended.err);
    assert_eq!(Picture::decode(&ended.out).pixel(0, 0), [255, 0, 0, 255]);
    folder.run("draw - - -o a.png").fails(2, "given twice");
}

#[test]
fn text_is_set_in_the_font_that_is_there_and_a_missing_one_is_reported() {
    let folder = Folder::new();
    let text = |family: &str| {
        format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="20">
<text x="2" y="16" font-size="16" font-family="{family}">Ωbß</text></svg>"##
        )
    };
    folder.write("plain.svg", text("sans-serif"));
    folder.write("other.svg", text("Papyrus"));
    assert_eq!(folder.must("draw plain.svg -o a.png").err, "");
    let printed = folder.must("draw other.svg -o b.png").err;
    assert!(printed.contains("font `Papyrus` is missing; `DejaVu Sans` is used"), "{printed}");
    assert!(picture(&folder, "a.png").shows_something());
    assert_eq!(folder.read("a.png"), folder.read("b.png"));
    folder
        .run("draw plain.svg -o a.png --font plain.svg")
        .fails(1, "not a TrueType or OpenType font");
    folder.run("draw plain.svg -o a.png --font nowhere").fails(1, "nowhere");
}

#[test]
fn styles_and_letters_that_no_font_has_are_reported() {
    let folder = Folder::new();
    let printed = |style: &str, text: &str| {
        let svg = format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="20">
<text x="2" y="16" font-size="16" {style}>{text}</text></svg>"##
        );
        folder.write("a.svg", svg);
        folder.must("draw a.svg -o a.png").err
    };
    for (style, wanted) in [
        ("font-weight='bold'", "`DejaVu Sans` bold"),
        ("font-family='sans-serif' font-style='italic'", "`sans-serif` italic"),
        ("font-family='serif'", "`serif`"),
        ("font-family='monospace' font-weight='900'", "`monospace` of weight 900"),
        ("font-family='Papyrus' font-weight='bold'", "`Papyrus` bold"),
    ] {
        let message = format!("font {wanted} is missing; `DejaVu Sans` is used in its place");
        let printed = printed(style, "ab");
        assert!(printed.contains(&message), "{printed}");
    }
    assert_eq!(printed("font-family='sans-serif'", "ab"), "");
    let message = "there is no glyph for 中 (U+4E2D), 文 (U+6587)";
    let missing = printed("font-family='sans-serif'", "a 中文 b");
    assert!(missing.contains(message), "{missing}");

    folder.write(
        "a.json",
        r#"{"type": "Feature", "properties": {"name": "a中"},
            "geometry": {"type": "Point", "coordinates": [0, 0]}}"#,
    );
    let printed = folder.must("draw a.json -o a.png --label name --size 99").err;
    assert!(printed.contains("there is no glyph for 中 (U+4E2D)"), "{printed}");
}

#[test]
fn what_is_not_drawn_is_named_once() {
    let folder = Folder::new();
    folder.write(
        "a.svg",
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9">
<filter id="f"><feGaussianBlur stdDeviation="2"/></filter>
<rect width="5" height="5" filter="url(#f)"/><rect width="4" height="4" filter="url(#f)"/>
<script/>
<rect width="2" height="2"><animate attributeName="x" to="3"/></rect></svg>"##,
    );
    let report = folder.must("draw a.svg -o a.png --json").json();
    let printed = report["warnings"].as_array().unwrap();
    let named = |part: &str| printed.iter().filter(|w| w.as_str().unwrap().contains(part)).count();
    for part in ["filters are not drawn", "`script`", "line 5, column", "`animate`"] {
        assert_eq!(named(part), 1, "{part}: {printed:?}");
    }
    assert_eq!(printed.len(), 3);
}

#[test]
fn a_drawing_too_large_to_be_drawn_is_bad_data() {
    let folder = Folder::new();
    let text =
        |size: &str| format!("<!-- wide -->\n<svg xmlns='http://www.w3.org/2000/svg' {size}/>");
    folder.write("wide.svg", text("width='1e9' height='2'"));
    folder.write("long.svg", text("width='2' height='40000'"));
    let printed =
        "wide.svg: line 2, column 1: the size 1000000000x2: 2000000000 pixels are above the limit";
    folder.run("draw wide.svg -o a.png").fails(1, printed);
    folder.run("draw long.svg -o a.png").fails(1, "long.svg: line 2, column 1: the size 2x40000: ");
    // The other dimension follows from the drawing's shape.
    folder.run("draw long.svg -o a.png --size 9x").fails(1, "long.svg: line 2, column 1: the size");
    folder.must("draw wide.svg -o a.png --size 9x9");
}

#[test]
fn an_island_is_not_hidden_by_its_name_and_a_large_country_has_one() {
    let folder = Folder::new();
    let area = |name: &str, [x0, y0, x1, y1]: [i32; 4]| {
        format!(
            r#"{{"type":"Feature","properties":{{"name":"{name}"}},"geometry":{{"type":"Polygon","coordinates":[[[{x0},{y0}],[{x1},{y0}],[{x1},{y1}],[{x0},{y1}],[{x0},{y0}]]]}}}}"#
        )
    };
    // The middle area barely holds its name; the names of its two neighbours cross its border.
    let areas = [
        area("Isle", [30, 80, 38, 86]),
        area("Overlong Neighbour", [60, 20, 130, 60]),
        area("Landia", [130, 20, 190, 40]),
        area("Overlong Neighbour", [190, 20, 260, 60]),
    ];
    folder.write("areas.geojsonl", areas.join("\n"));
    let report = folder
        .must("draw areas.geojsonl --label name -o m.png --window 0,0,300,100 --size 300x100 --fill red --stroke none --json")
        .json();
    assert_eq!(report["layers"][0]["map"]["labels_left_out"], 0, "{report}");
    let found = picture(&folder, "m.png");
    for (x, y) in [(30, 14), (37, 14), (30, 19), (37, 19), (34, 17)] {
        assert_eq!(found.pixel(x, y), [255, 0, 0], "{x} {y}");
    }
    let dark = |x: std::ops::Range<u32>| {
        let pixels = x.flat_map(|x| (62..80).map(move |y| (x, y)));
        pixels.filter(|(x, y)| found.pixel(*x, *y).iter().all(|c| *c < 0x80)).count()
    };
    assert!(dark(135..185) > 20, "Landia is named");
}

#[test]
fn wrong_use_and_bad_data_are_reported() {
    let folder = folder();
    folder.write("no.svg", "<svg xmlns='http://www.w3.org/2000/svg'><rect></svg>");
    folder.write("empty.geojson", r#"{"type":"FeatureCollection","features":[]}"#);
    folder.write("what.txt", "hello");
    folder.write("model.gltf", r#"{"scenes":[],"asset":{"version":"2.0"}}"#);
    folder.write("model.dae", r#"<?xml version="1.0"?><COLLADA version="1.4.1"></COLLADA>"#);
    for (arguments, code, part) in [
        ("draw a.svg map.geojson -o a.png", 2, "an SVG is drawn alone"),
        ("draw a.svg --fill red -o a.png", 2, "an SVG has its own"),
        ("draw a.svg -o a.bmp", 2, "drawings and maps are written as PNG"),
        ("draw no.svg -o a.png", 1, "no.svg: line 1, column"),
        ("draw empty.geojson -o a.png", 1, "there is nothing to draw"),
        ("draw what.txt -o a.png", 1, "not a known format; durer draw reads maps and drawings"),
        ("draw model.gltf -o a.png", 1, "this is glTF, a model; durer render draws it"),
        ("draw model.dae -o a.png", 1, "this is COLLADA, a model; durer render draws it"),
        ("draw a.svg -o a.png --size 40000x1", 2, "32767"),
        ("draw a.svg -o a.png --size 30000x30000", 2, "--max-pixels raises it"),
        ("draw a.svg -o - --json", 2, "the report goes to standard output"),
        ("draw map.geojson -o a.png --window 1,1,1,1", 2, "the window is empty"),
    ] {
        folder.run(arguments).fails(code, part);
    }
    assert!(!folder.path("a.png").exists());
}

/// Returns a point feature.
fn point([x, y]: [u32; 2], properties: &str) -> String {
    let geometry = format!(r#"{{"type":"Point","coordinates":[{x},{y}]}}"#);
    format!(r#"{{"type":"Feature","properties":{properties},"geometry":{geometry}}}"#)
}

#[test]
fn labels_keep_off_markers_and_stand_in_the_middle_of_squares() {
    let folder = folder();
    let town = |x: u32| point([x, 0], &format!(r#"{{"n":"Town {x}"}}"#));
    let towns = [0, 46, 92].map(town).join("\n");
    folder.write("towns.geojsonl", towns);
    let dots = |labels: &str| {
        folder.must(&format!("draw towns.geojsonl -o t.png --size 160x40 --window -10,-12,110,12 --fill red --stroke none --marker-size 8{labels}"));
        let picture = picture(&folder, "t.png");
        let at = (0..160).flat_map(|x| (0..40).map(move |y| (x, y)));
        at.filter(|(x, y)| picture.pixel(*x, *y)[..] == [255, 0, 0]).count()
    };
    let all = dots("");
    assert!(all > 90, "{all}");
    assert_eq!(dots(" --label n"), all);

    let square = r#"{"type":"Feature","properties":{"n":"square"},"geometry":{"type":"Polygon","coordinates":[[[0,0],[10,0],[10,10],[0,10],[0,0]]]}}"#;
    folder.write("square.geojson", square);
    folder.must("draw square.geojson -o s.png --size 200 --label n --label-halo none");
    let dark = darkest_rows(&picture(&folder, "s.png"), 60..140, 10..190);
    let middle = (dark.0 + dark.1) / 2;
    assert!((95..=105).contains(&middle), "{dark:?}");
}

#[test]
fn labels_beside_holes_stand_in_the_middle_too() {
    let folder = folder();
    let plate = r#"{"type":"Feature","properties":{"n":"plate"},"geometry":{"type":"Polygon","coordinates":[[[0,0],[200,0],[200,60],[0,60],[0,0]],[[90,10],[110,10],[110,50],[90,50],[90,10]]]}}"#;
    folder.write("plate.geojson", plate);
    folder.must("draw plate.geojson -o p.png --size 200x60 --window 0,0,200,60 --label n --label-halo none --stroke none");
    let dark = darkest_rows(&picture(&folder, "p.png"), 0..200, 0..60);
    assert!((27..=33).contains(&((dark.0 + dark.1) / 2)), "{dark:?}");
}

/// Returns the first and the last row with dark pixels in a part of a picture.
fn darkest_rows(
    picture: &Picture,
    columns: std::ops::Range<u32>,
    rows: std::ops::Range<u32>,
) -> (u32, u32) {
    let dark = |y: &u32| columns.clone().any(|x| picture.pixel(x, *y)[0] < 80);
    let dark: Vec<u32> = rows.filter(dark).collect();
    (dark[0], dark[dark.len() - 1])
}

#[test]
fn shared_borders_are_dashed_once() {
    let folder = folder();
    let square = |x: u32| {
        let (a, b) = (x, x + 10);
        format!(
            r#"{{"type":"Feature","properties":{{}},"geometry":{{"type":"Polygon","coordinates":[[[{a},0],[{b},0],[{b},7],[{a},7],[{a},0]]]}}}}"#
        )
    };
    folder.write("two.geojsonl", [square(0), square(10)].join("\n"));
    folder.must("draw two.geojsonl -o d.png --size 420x150 --window -0.5,-0.25,20.5,7.25 --fill white --stroke red --stroke-width 4 --dashes 10,10");
    let found = picture(&folder, "d.png");
    let red = |x: u32| (10..140).filter(|y| found.pixel(x, *y)[1] < 128).count() as f64 / 130.0;
    for x in [10, 210, 410] {
        assert!((0.4..=0.6).contains(&red(x)), "{x}: {}", red(x));
    }
    // The same holds for translucent borders: they are as dark between two areas as around them.
    folder.must("draw two.geojsonl -o d.png --size 420x150 --window -0.5,-0.25,20.5,7.25 --fill white --stroke #f008 --stroke-width 4");
    let found = picture(&folder, "d.png");
    assert_eq!(found.pixel(210, 70), found.pixel(10, 70));
}

#[test]
fn labels_follow_lines_and_ranks_decide_who_comes_first() {
    let folder = folder();
    let up = r#"{"type":"Feature","properties":{"n":"Steep"},"geometry":{"type":"LineString","coordinates":[[10,0],[10,100]]}}"#;
    folder.write("up.geojson", up);
    folder.must("draw up.geojson -o u.png --size 100x100 --window 0,0,20,100 --label n --label-halo none --stroke none");
    let found = picture(&folder, "u.png");
    let dark = |x: u32, y: u32| found.pixel(x, y)[0] < 120;
    let columns = (0..100).filter(|x| (0..100).any(|y| dark(*x, y))).count();
    let rows = (0..100).filter(|y| (0..100).any(|x| dark(x, *y))).count();
    assert!(rows > 25 && columns < 16, "{rows} rows, {columns} columns");

    let town = |name: &str, rank: u32, people: u32| {
        let properties = format!(r#"{{"n":"{name}","LABELRANK":{rank},"people":{people}}}"#);
        point([50, 50], &properties)
    };
    folder.write("towns.geojsonl", [town("MMMMMM", 5, 9), town("i", 2, 1)].join("\n"));
    let width = |options: &str| {
        folder.must(&format!("draw towns.geojsonl -o r.png --size 120x20 --window 0,40,120,60 --marker-size 0 --stroke none --label n {options}"));
        let found = picture(&folder, "r.png");
        (0..120).filter(|x| (0..20).any(|y| found.pixel(*x, y)[0] < 120)).count()
    };
    let narrow = width("");
    assert!(narrow < 8, "{narrow}");
    assert_eq!(width("--label-priority LABELRANK"), narrow);
    assert!(width("--label-priority -people") > 20);
    let wrong = folder.run("draw towns.geojsonl -o r.png --label n --label-priority height");
    assert_eq!(wrong.code, 1, "{wrong:?}");
    assert!(
        wrong.err.contains("--label-priority height: no feature has this property"),
        "{wrong:?}"
    );
}

#[test]
fn names_without_room_are_written_in_two_lines_or_short() {
    let folder = Folder::new();
    let area = |name: &str| {
        format!(
            "{{\"type\":\"Feature\",\"properties\":{{{name}}},\"geometry\":{{\"type\":\"Polygon\",\"coordinates\":[[[20,5],[80,5],[80,45],[20,45],[20,5]]]}}}}"
        )
    };
    // Bounding box of all letters in a picture of one pixel per unit.
    let ink = |name: &str| {
        folder.write("a.geojson", area(name));
        folder.must("draw a.geojson -o a.png --size 100x50 --window 0,0,100,50 --stroke none --fill white --label NAME --label-halo none");
        let picture = picture(&folder, "a.png");
        let dark: Vec<(usize, usize)> = picture
            .pixels()
            .enumerate()
            .filter(|(_, p)| p[0] < 128)
            .map(|(i, _)| (i % 100, i / 100))
            .collect();
        let span = |all: Vec<usize>| all.iter().max().zip(all.iter().min()).map(|(a, b)| a - b);
        (span(dark.iter().map(|p| p.0).collect()), span(dark.iter().map(|p| p.1).collect()))
    };
    let (width, height) = ink("\"NAME\":\"Northern Isles\"");
    assert!(
        width.is_some_and(|w| (40..60).contains(&w)) && height.is_some_and(|h| h > 18),
        "{width:?} {height:?}"
    );
    let (width, height) = ink("\"NAME\":\"Isles\"");
    assert!(
        width.is_some_and(|w| w < 40) && height.is_some_and(|h| h < 12),
        "{width:?} {height:?}"
    );
    let long = "\"NAME\":\"Northernmostislandsofall\",\"ABBREV\":\"N.I.\"";
    let (width, _) = ink(long);
    assert!(width.is_some_and(|w| w < 30), "{width:?}");
}
