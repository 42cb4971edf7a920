//! Drawings made by the command: golden files, layers, errors, reports.

use crate::harness::{Folder, Picture};
use std::fs;
use std::path::Path;

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// Name, model, options.
const GOLDEN: &[(&str, &str, &str)] = &[
    ("cube", "cube.obj", "--hidden dashed"),
    ("cube_wireframe", "cube.obj", "--style wireframe --view front --page A6"),
    ("bracket", "bracket.stl", "--hidden dashed --page A4"),
    ("bracket_sheet", "bracket.stl", "--sheet third-angle --hidden dashed --page A4"),
    (
        "bracket_dimensions",
        "bracket.stl",
        "--sheet third-angle --hidden dashed --page A3 --center-lines --dimension size,holes",
    ),
    (
        "bracket_sections",
        "bracket.stl",
        "--sheet first-angle --section A:0,1,0,-10 --section B:-1,0,0,20 --detail C:5,0,5,6 --page A3",
    ),
    ("teapot", "teapot.obj", "--azimuth 25 --elevation 22"),
    ("crate", "crate.glb", "--style regions+lines --merge material --azimuth -25 --elevation 20"),
];

/// Returns a folder with the cube and the samples' models.
fn folder() -> Folder {
    let folder = Folder::with_models();
    for name in ["bracket.stl", "teapot.obj", "crate.glb"] {
        fs::copy(root().join("samples").join(name), folder.path(name)).unwrap();
    }
    folder
}

/// Compares with the golden files; `DURER_BLESS=1` rewrites them.
#[test]
fn drawings_are_the_golden_ones() {
    let (folder, golden) = (folder(), root().join("crates/durer-cli/tests/golden"));
    for (name, model, options) in GOLDEN {
        folder.must(&format!("render {model} -o {name}.svg {options}"));
        let (found, path) =
            (folder.read(&format!("{name}.svg")), golden.join(format!("{name}.svg")));
        if std::env::var_os("DURER_BLESS").is_some() {
            fs::create_dir_all(&golden).unwrap();
            fs::write(&path, &found).unwrap();
        }
        let same = fs::read(&path).is_ok_and(|expected| expected == found);
        assert!(same, "{name}.svg differs from {}; DURER_BLESS=1 rewrites it", path.display());
    }
}

#[test]
fn a_cube_has_nine_visible_edges_and_three_hidden() {
    let folder = Folder::with_models();
    let ended = folder.must("render cube.obj -o cube.svg --hidden dashed --scale 10:1 --json");
    let drawing = &ended.json()["models"][0]["pictures"][0]["drawing"];
    assert_eq!(drawing["scale_text"], "10:1");
    let total = |kind: &str| -> f64 {
        let lines = drawing["lines"].as_array().unwrap();
        lines.iter().map(|c| c[kind]["length"].as_f64().unwrap()).sum()
    };
    // Edges of length 2, all foreshortened by the same factor.
    let edge = 2.0 * (2.0f64 / 3.0).sqrt();
    assert!((total("visible") / edge - 9.0).abs() < 1e-3, "{}", total("visible") / edge);
    assert!((total("hidden") / edge - 3.0).abs() < 1e-3, "{}", total("hidden") / edge);
}

#[test]
fn every_format_is_written_by_suffix_and_by_name() {
    let folder = Folder::with_models();
    let starts: [(&str, &[u8]); 6] = [
        ("svg", b"<svg"),
        ("pdf", b"%PDF-1.5"),
        ("dxf", b"  0\nSECTION"),
        ("hpgl", b"IN;"),
        ("gcode", b"; cube\n; sheet "),
        ("geojson", b"{\"type\":\"FeatureCollection\""),
    ];
    for (format, start) in starts {
        folder.must(&format!("render cube.obj -o cube.{format}"));
        let file = folder.read(&format!("cube.{format}"));
        assert!(file.starts_with(start), "{format}");
        let piped = folder.must(&format!("render cube.obj -o - --format {format}")).out;
        assert_eq!(piped, file, "{format}");
    }
    folder.must("render cube.obj -o many/ --format svg --turntable 2");
    assert!(!folder.read("many/cube_0001.svg").is_empty());
    folder.must("render cube.obj -o cube.png --style regions+lines --size 80x60");
    let picture = Picture::decode(&folder.read("cube.png"));
    assert_eq!(picture.size(), (80, 60));
    assert!(picture.shows_something());
}

#[test]
fn options_that_do_not_fit_say_what_does() {
    let folder = Folder::with_models();
    let cases = [
        ("-o a.svg --aa 16", "--aa is not for a vector drawing"),
        ("-o a.pdf --size 100x100", "use --page"),
        ("-o a.dxf --algorithm warnock", "--style"),
        ("-o a.png --pen 0.3", "give --style"),
        ("-o a.svg --pen silhouette=wide", "WIDTH[,CLASS=WIDTH"),
        ("-o a.svg --page A4 --scale 500:1", "the page has room for"),
        ("-o a.svg --page B4711", "WIDTHxHEIGHT in millimetres"),
        ("-o a.svg --sheet third-angle --view top", "has its own views"),
        ("-o a.svg --sheet first-angle --views front,top,front", "front is given twice"),
        ("-o a.svg --sheet first-angle --views front,sideways", "iso, front, back"),
        ("-o a.svg --views front,top", "--sheet"),
        ("-o a.svg --section A:0,0,1,0", "a view of a --sheet"),
        ("-o a.png --section A:0,0,1,0", "a view of a --sheet"),
        ("-o a.svg --sheet third-angle --section A4711:0,0,1,0", "is not a letter"),
        ("-o a.svg --sheet third-angle --section A:0,0,0,1", "NX,NY,NZ,D"),
        (
            "-o a.svg --sheet third-angle --section A:0,0,1,0 --detail A:0,0,1,1",
            "the letter A is given twice",
        ),
        ("-o a.svg --sheet third-angle --detail B:0,0,1", "LETTER:X,Y,Z,RADIUS"),
        ("-o a.svg --sheet third-angle --detail B:0,0,1,0", "above 0"),
        ("-o a.svg --sheet third-angle --detail B:0,0,1,1,huge", "2:1"),
        ("-o a.svg --sheet third-angle --detail B:0,0,1,1,auto,left", "no view `left`"),
        ("-o a.svg --detail B:0,0,1,1", "--sheet"),
        ("-o a.geojson --callouts", "GeoJSON has no paper"),
        ("-o a.png --callouts", "give --style"),
        ("-o a.svg --explode w", "x, y, z or radial"),
        ("-o a.svg --explode x:0", "above 0"),
        ("-o a.geojson --sheet third-angle", "GeoJSON has no paper"),
        ("-o a.svg --lines edges", "silhouette"),
        ("-o a.svg --stubs 60", "below 50"),
        ("-o a.svg --fit -1", "--fit"),
        ("-o a.png --fit 0.1", "give --style"),
        ("-o a.geojson --fit 0.1", "GeoJSON has no curves"),
        ("-o a.svg --dxf-polylines", "it is for .dxf files"),
        ("-o a.png --stubs 1", "give --style"),
        ("-o a.png --fill disjoint", "give --style"),
        ("-o a.hpgl --style regions --fill trapped", "use --fill disjoint"),
        ("-o a.svg --style regions --hatch shade --fill trapped", "--hatch none"),
        ("-o a.svg --feed 100", "--feed: it is for G-code; write a .gcode"),
        ("-o a.hpgl --pen-up M5", "--pen-up: it is for G-code"),
        ("-o a.gcode --pen-up M5?", "without ! ? ~"),
        ("-o a.gcode --feed 0", "above 0"),
        ("-o a.pdf --pens 2", "--pens: it is for plotters"),
        ("-o a.geojson --pen-order", "GeoJSON has no pens"),
        ("-o a.png --pen-order", "give --style"),
        (
            "-o a.svg --style wireframe --hatch shade",
            "hidden-line, regions, regions+lines or shadows",
        ),
    ];
    for (options, part) in cases {
        folder.run(&format!("render cube.obj {options}")).fails(2, part);
    }
    assert_eq!(folder.names(), ["broken.obj", "cube.obj"]);
}

#[test]
fn what_a_sheet_cannot_show_is_reported() {
    let folder = Folder::with_models();
    let ended = folder.must(
        "render cube.obj -o a.svg --sheet third-angle --section A:1,1,1,0 --section B:0,0,1,-9 \
         --detail C:50,0,0,1 --json",
    );
    let warnings = ended.json()["models"][0]["warnings"].to_string();
    for part in ["section A: no view", "section B leaves nothing", "detail C: no view"] {
        assert!(warnings.contains(part), "{part}: {warnings}");
    }
}

#[test]
fn parts_are_numbered_and_listed_and_one_alone_is_not_moved() {
    let folder = Folder::with_models();
    folder.must("render cube.obj -o b.svg --callouts --page A5");
    let svg = String::from_utf8(folder.read("b.svg")).unwrap();
    assert!(svg.contains("parts-list") && svg.contains("callouts"));
    folder.run("render cube.obj -o d.svg --explode z").fails(1, "a model of 2 to 4000 objects");
}

#[test]
fn sections_have_lines_of_their_own() {
    let folder = Folder::with_models();
    // The lower half, from above.
    let ended = folder
        .must("render cube.obj -o cut.svg --section 0,-1,0,0 --view top --lines section --json");
    let drawing = ended.json()["models"][0]["pictures"][0]["drawing"].clone();
    let lines = drawing["lines"].as_array().unwrap();
    let of = |class: &str| lines.iter().find(|l| l["class"] == class).expect("a class");
    assert_eq!((lines.len(), &of("section")["visible"]["polylines"]), (2, &1.into()));
    let length = of("section")["visible"]["length"].as_f64().unwrap();
    assert!((length - 8.0).abs() < 1e-6, "{length}");
    // The cut face is hatched, or filled on request.
    assert!(of("hatch")["visible"]["length"].as_f64().unwrap() > 8.0);
    let ended =
        folder.must("render cube.obj -o cut.svg --section 0,-1,0,0 --view top --hatch none --json");
    let drawing = ended.json()["models"][0]["pictures"][0]["drawing"].clone();
    assert_eq!(drawing["regions"], 1);
    assert!(drawing["lines"].as_array().unwrap().iter().all(|l| l["class"] != "hatch"));
    // Formats for programs contain the visible caps as areas.
    folder.must("render cube.obj -o cut.geojson --section 0,-1,0,0 --view top");
    let drawing: serde_json::Value = serde_json::from_slice(&folder.read("cut.geojson")).unwrap();
    let features = drawing["features"].as_array().unwrap().iter();
    let caps: Vec<_> = features.filter(|f| f["properties"]["class"] == "cap").collect();
    let [cap] = caps[..] else { panic!("{} caps", caps.len()) };
    assert_eq!(
        (&cap["geometry"]["type"], &cap["properties"]["visible"]),
        (&"Polygon".into(), &true.into())
    );
    let ring: Vec<[f64; 2]> =
        serde_json::from_value(cap["geometry"]["coordinates"][0].clone()).unwrap();
    let doubled: f64 = ring.windows(2).map(|w| w[0][0] * w[1][1] - w[1][0] * w[0][1]).sum();
    assert!((doubled - 8.0).abs() < 1e-6, "{doubled}");
}

#[test]
fn hidden_line_drawings_are_hatched_where_that_is_requested() {
    let folder = Folder::with_models();
    let drawn = |options: &str| {
        let ended = folder.must(&format!("render cube.obj {options} --json"));
        ended.json()["models"][0]["pictures"][0]["drawing"].clone()
    };
    let length = |drawing: &serde_json::Value, class: &str| -> f64 {
        let lines = drawing["lines"].as_array().unwrap().iter().filter(|l| l["class"] == class);
        lines.map(|l| l["visible"]["length"].as_f64().unwrap()).sum()
    };
    let (plain, hatched) = (drawn("-o a.svg"), drawn("-o a.svg --hatch shade"));
    assert_eq!((&hatched["style"], &hatched["regions"]), (&"hidden-line".into(), &0.into()));
    assert_eq!(length(&plain, "hatch"), 0.0);
    assert!(length(&hatched, "hatch") > 10.0);
    for class in ["silhouette", "crease"] {
        assert_eq!(length(&hatched, class), length(&plain, class), "{class}");
    }
    let both = drawn("-o a.svg --style regions+lines --hatch shade");
    assert_eq!(hatched["lines"], both["lines"]);
    // Formats for plotters hatch areas by default, but a line drawing has no areas.
    assert_eq!(length(&drawn("-o a.hpgl"), "hatch"), 0.0);
}

#[test]
fn details_have_marks_at_the_distance_that_their_views_have() {
    let folder = Folder::with_models();
    let sheet =
        "render round.obj -o a.svg --sheet third-angle --views iso --page A5 --json --hatch";
    // A cylinder of 48 facets.
    let mut model = String::new();
    for i in 0..48 {
        let (y, x) = (f64::from(i) / 24.0 * std::f64::consts::PI).sin_cos();
        model += &format!("v {x} {y} -1\nv {x} {y} 1\n");
    }
    for i in 0..48 {
        let k = (i + 1) % 48;
        model += &format!("f {} {} {} {}\n", 2 * i + 1, 2 * k + 1, 2 * k + 2, 2 * i + 2);
    }
    fs::write(folder.path("round.obj"), model).unwrap();
    // Twice as large on paper, the lines are twice as long, measured in the model's units, and there are four times as
    // many dots.
    for (hatch, class, of, grows) in
        [("stipple", "stipple", "polylines", 4.0), ("contour", "hatch", "length", 2.0)]
    {
        let marks = |detail: &str| {
            let json = folder.must(&format!("{sheet} {hatch} {detail}")).json();
            let lines = json["models"][0]["pictures"][0]["drawing"]["lines"].clone();
            let lines = lines.as_array().unwrap().iter().filter(|l| l["class"] == class);
            lines.map(|l| l["visible"][of].as_f64().unwrap()).sum::<f64>()
        };
        let plain = marks("");
        let [same, twice] = ["20:1", "40:1"]
            .map(|scale| marks(&format!("--detail B:0.7,-0.7,0,0.4,{scale},iso")) - plain);
        let growth = twice / same;
        assert!(same > 0.0 && (0.7 * grows..1.4 * grows).contains(&growth), "{class} {growth}");
    }
}

#[test]
fn gcode_takes_its_commands_and_speeds_from_options() {
    let folder = Folder::with_models();
    let drawn = |options: &str| {
        folder.must(&format!("render cube.obj -o a.nc {options}"));
        String::from_utf8(folder.read("a.nc")).unwrap()
    };
    let text = drawn("--pen-down G1\\nG4 --pen-up G0 --feed 700 --travel 2000 --hidden dashed");
    // Outlines and edges have different pens, the hidden lines a third.
    assert_eq!(text.matches("\nM0\n").count(), 2, "{text}");
    assert!(text.contains(" F2000\nG1\nG4\nG1 X") && text.contains(" F700\n"), "{text}");
    let text = drawn("--pens 1 --hidden dashed");
    assert!(!text.contains("M0") && text.contains("\nM3 S1000\nG4 P0.2\nG1 X"), "{text}");
    assert_eq!(text.matches("; layer ").count(), 3, "{text}");
    // The same holds for plots.
    folder.must("plot --formula x*z -o plot.gcode --feed 10");
    assert!(String::from_utf8(folder.read("plot.gcode")).unwrap().contains(" F10\n"));
    folder.run("plot --formula x*z -o plot.svg --feed 10").fails(2, "it is for G-code");
}

#[test]
fn a_pen_goes_short_ways_where_that_is_requested() {
    let folder = folder();
    let travel = |options: &str| -> f64 {
        folder.must(&format!("render bracket.stl -o a.svg --hatch shade {options}"));
        let text = String::from_utf8(folder.read("a.svg")).unwrap();
        // Hatching consists of straight lines: M x y l dx dy, or h dx.
        let ends = text.lines().skip_while(|l| !l.contains("visible-hatch")).filter_map(ends);
        let ends: Vec<[f64; 4]> = ends.collect();
        assert!(ends.len() > 50, "{}", ends.len());
        ends.windows(2).map(|w| (w[1][0] - w[0][2]).hypot(w[1][1] - w[0][3])).sum()
    };
    assert!(travel("--pen-order") < 0.3 * travel(""));
}

/// Returns the ends of a straight stroke in an SVG.
fn ends(line: &str) -> Option<[f64; 4]> {
    let path = line.split_once(" d=\"M")?.1.split_once('"')?.0;
    let (start, step) = path.split_once('l')?;
    let pair = |text: &str| {
        let at = text.rfind([' ', '-']).filter(|at| *at > 0)?;
        Some([text[..at].parse::<f64>().ok()?, text[at..].trim().parse::<f64>().ok()?])
    };
    let ([x, y], [dx, dy]) = (pair(start)?, pair(step)?);
    Some([x, y, x + dx, y + dy])
}

#[test]
fn near_lines_have_wider_pens_where_that_is_requested() {
    let folder = folder();
    let layers = |options: &str| -> Vec<(String, f64)> {
        folder.must(&format!("render bracket.stl -o a.svg {options}"));
        let text = String::from_utf8(folder.read("a.svg")).unwrap();
        let of = |line: &str, name: &str| {
            let value = line.split_once(&format!("{name}=\""))?.1;
            Some(value.split_once('"')?.0.to_owned())
        };
        let layer = |l: &str| Some((of(l, " id")?, of(l, "stroke-width")?.parse().unwrap()));
        text.lines().filter(|l| l.starts_with("<g")).filter_map(layer).collect()
    };
    let plain: Vec<String> = layers("").into_iter().map(|l| l.0).collect();
    assert_eq!(plain, ["visible-crease", "visible-silhouette"]);
    let cued = layers("--depth-cue");
    let [.., far, _, _, near] = &cued[..] else { panic!("{cued:?}") };
    assert_eq!(far, &("visible-silhouette-near-4".to_owned(), 0.25));
    assert_eq!(near, &("visible-silhouette-near-1".to_owned(), 0.7));
    // The nearest outline precedes the part itself.
    let contoured: Vec<String> = layers("--contour").into_iter().map(|l| l.0).collect();
    assert_eq!(contoured, ["visible-crease", "visible-silhouette", "visible-contour"]);
    let both = layers("--contour --depth-cue --pen contour=1");
    let of_contour: Vec<(&str, f64)> = both
        .iter()
        .filter_map(|(name, width)| Some((name.strip_prefix("visible-contour-near-")?, *width)))
        .collect();
    assert_eq!(of_contour, [("4", 0.5), ("3", 0.7), ("2", 1.0)]);
    for (options, part) in [
        ("-o a.svg --style wireframe", "shows all lines alike"),
        ("-o a.svg --style regions", "areas have no lines"),
        ("-o a.geojson", "GeoJSON has no pens"),
    ] {
        folder.run(&format!("render bracket.stl {options} --depth-cue")).fails(2, part);
    }
}

#[test]
fn reports_of_drawings_tell_the_cameras() {
    let folder = Folder::with_models();
    let picture = |options: &str| {
        let ended = folder.must(&format!("render cube.obj -o cube.svg {options} --json"));
        ended.json()["models"][0]["pictures"][0].clone()
    };
    let one = picture("--view front");
    assert!(one.get("algorithm").is_none());
    assert_eq!(one["cameras"].as_array().unwrap().len(), 1);
    assert!(one["cameras"][0]["ortho"].as_f64().unwrap() > 2.0);
    assert_eq!(picture("--sheet third-angle")["cameras"].as_array().unwrap().len(), 4);
}

#[test]
fn stubs_are_cut_back_on_paper_and_kept_for_programs() {
    let folder = folder();
    let polylines = |options: &str| -> u64 {
        let ended =
            folder.must(&format!("render teapot.obj {options} --azimuth 30 --elevation 25 --json"));
        let drawing = &ended.json()["models"][0]["pictures"][0]["drawing"];
        drawing["lines"]
            .as_array()
            .unwrap()
            .iter()
            .map(|c| c["visible"]["polylines"].as_u64().unwrap())
            .sum()
    };
    let (paper, mesh) = (polylines("-o t.svg"), polylines("-o t.svg --stubs 0"));
    assert!(paper * 10 < mesh * 8, "{paper} of {mesh}");
    assert_eq!(polylines("-o t.geojson"), mesh);
}

#[test]
fn areas_are_disjoint_or_trapped_as_requested() {
    let folder = Folder::with_models();
    let area = |options: &str| -> f64 {
        folder.must(&format!("render cube.obj -o a.geojson --style regions {options}"));
        let drawing: serde_json::Value = serde_json::from_slice(&folder.read("a.geojson")).unwrap();
        let ring = |ring: &serde_json::Value| -> f64 {
            let points: Vec<[f64; 2]> = serde_json::from_value(ring.clone()).unwrap();
            points.windows(2).map(|w| w[0][0] * w[1][1] - w[0][1] * w[1][0]).sum::<f64>() / 2.0
        };
        let features = drawing["features"].as_array().unwrap().iter();
        let polygons = features.filter(|f| f["geometry"]["type"] == "Polygon");
        polygons
            .map(|f| f["geometry"]["coordinates"].as_array().unwrap().iter().map(ring).sum::<f64>())
            .sum()
    };
    // A cube of side 2 along its diagonal is a regular hexagon.
    let hexagon = 4.0 * 3.0f64.sqrt();
    assert!((area("") / hexagon - 1.0).abs() < 1e-6, "{}", area(""));
    assert_eq!(area("--fill disjoint"), area(""));
    assert!(area("--fill trapped") > hexagon * 1.0001);
    folder.must("render cube.obj -o a.svg --style regions");
    folder.must("render cube.obj -o b.svg --style regions --fill trapped");
    folder.must("render cube.obj -o c.svg --style regions --fill disjoint");
    assert_eq!(folder.read("a.svg"), folder.read("b.svg"));
    assert_ne!(folder.read("a.svg"), folder.read("c.svg"));
}

#[test]
fn outlines_are_smooth_and_bodies_searched_where_that_is_requested() {
    let folder = folder();
    // One surface that intersects itself.
    let crossing = "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 1 1 -2\nv 3 1 -2\nv 2 1 2\n\
                    f 1 2 3\nf 1 3 4\nf 3 5 4\nf 4 5 6\n";
    fs::write(folder.path("crossing.obj"), crossing).unwrap();
    let length = |model: &str, class: &str, options: &str| -> f64 {
        let ended =
            folder.must(&format!("render {model} -o a.svg {options} --hidden dashed --json"));
        let drawing = &ended.json()["models"][0]["pictures"][0]["drawing"];
        let lines = drawing["lines"].as_array().unwrap().iter().filter(|l| l["class"] == class);
        lines.map(|l| l["visible"]["length"].as_f64().unwrap()).sum()
    };
    assert_eq!(length("crossing.obj", "intersection", ""), 0.0);
    assert!(length("crossing.obj", "intersection", "--intersections all") > 0.1);
    let outlines = |options| length("teapot.obj", "silhouette", options);
    let (sharp, smooth) = (outlines("--smooth=off"), outlines("--smooth"));
    assert!(smooth > 0.5 * sharp && smooth != sharp, "{smooth} {sharp}");
    // Round parts are detected; drawings that have all lines of the mesh keep them.
    assert_eq!(outlines(""), outlines("--smooth=auto"));
    assert_ne!(outlines(""), sharp);
    assert_eq!(outlines("--stubs 0"), outlines("--stubs 0 --smooth=off"));
}

/// Returns a box as STL text; `moved` gives the displacement of each facet corner from its number.
fn box_of_facets(moved: impl Fn(usize) -> f64) -> String {
    let sides =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let facets = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let mut text = "solid box\n".to_owned();
    for (facet, i) in facets.zip(0..) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (corner, k) in facet.into_iter().zip(0..) {
            let [x, y, z] = [(1, 6.0), (2, 4.0), (4, 3.0)]
                .map(|(bit, size)| if corner & bit == 0 { 0.0 } else { size } + moved(3 * i + k));
            text += &format!("vertex {x:.3} {y:.3} {z:.3}\n");
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid box\n"
}

#[test]
fn faces_are_welded_as_far_as_their_digits_or_the_user_say() {
    let folder = Folder::new();
    folder.write("exact.stl", box_of_facets(|_| 0.0));
    folder.write("digit.stl", box_of_facets(|i| if i % 7 == 0 { 0.001 } else { 0.0 }));
    folder.write("apart.stl", box_of_facets(|i| (i % 5) as f64 * 0.02));
    let drawing = |name: &str, options: &str| {
        let ended = folder.must(&format!("render {name} -o o.geojson --json {options}"));
        let model = ended.json()["models"][0].clone();
        let count = |what: &str| model["pictures"][0]["drawing"][what].as_u64().unwrap();
        let printed = model["warnings"].to_string().contains("--weld LENGTH");
        (count("edges"), count("border_edges"), printed)
    };
    assert_eq!(drawing("exact.stl", ""), (18, 0, false));
    assert_eq!(drawing("digit.stl", ""), (18, 0, false));
    assert_eq!(drawing("digit.stl", "--weld 0.01"), (18, 0, false));
    let (edges, borders, _) = drawing("digit.stl", "--weld none");
    assert!(borders > 0 && edges > 18, "{edges} {borders}");
    assert_eq!(drawing("apart.stl", "--weld 0.3"), (18, 0, false));
    assert!(drawing("apart.stl", "").2);
    // An open tube of one row of faces: more than half of its edges are borders, but all faces meet.
    let (mut tube, ends) = (String::new(), 13);
    for i in 0..ends {
        let (y, x) = (f64::from(i) * std::f64::consts::PI / 12.0).sin_cos();
        tube += &format!("v {x:.6} {y:.6} 0\nv {x:.6} {y:.6} 1\n");
    }
    for i in 1..ends {
        let [a, b, c, d] = [2 * i - 1, 2 * i, 2 * i + 2, 2 * i + 1];
        tube += &format!("f {a} {b} {c}\nf {a} {c} {d}\n");
    }
    folder.write("tube.obj", tube);
    assert_eq!(drawing("tube.obj", ""), (49, 26, false));
    folder.run("render exact.stl -o o.svg --weld -1").fails(2, "--weld");
    folder.run("render exact.stl -o o.png --weld 1").fails(2, "it is for drawings");
}

#[test]
fn hidden_lines_beside_visible_ones_are_left_out_on_paper() {
    let folder = Folder::new();
    folder.write("box.stl", box_of_facets(|_| 0.0));
    let hidden = |options: &str| -> f64 {
        let ended = folder.must(&format!("render box.stl --elevation 89.95 --json {options}"));
        let lines = ended.json()["models"][0]["pictures"][0]["drawing"]["lines"].clone();
        let lines = lines.as_array().unwrap().iter();
        lines.map(|c| c["hidden"]["length"].as_f64().unwrap()).sum()
    };
    assert_eq!(hidden("-o o.svg --hidden dashed"), 0.0);
    assert!(hidden("-o o.svg --hidden dashed --stubs 0") > 5.0);
    assert!(hidden("-o o.geojson") > 5.0);
    assert_eq!(hidden("-o o.geojson --beneath 0.2"), 0.0);
}

#[test]
fn polygons_that_are_not_flat_have_their_outline_between_their_triangles() {
    let folder = Folder::new();
    // A sheet folded along its diagonal; one half faces the eye.
    folder.write("tent.obj", "v 0 0.5 0\nv 1 1 -1\nv 0 1.5 0\nv -1 1 -1\nf 1 2 3 4\n");
    let silhouettes = |azimuth: u32| {
        folder.must(&format!("render tent.obj -o tent.geojson --azimuth {azimuth} --elevation 0"));
        let drawing: serde_json::Value =
            serde_json::from_slice(&folder.read("tent.geojson")).unwrap();
        let features = drawing["features"].as_array().unwrap();
        features.iter().filter(|f| f["properties"]["class"] == "silhouette").count()
    };
    assert_eq!((silhouettes(0), silhouettes(60)), (0, 1));
}

/// Returns a plate with a round hole, each with this number of sides.
fn plate(sides: u32) -> String {
    let ring = |radius: f64, z: f64| {
        let angle = move |i: u32| f64::from(i) * std::f64::consts::TAU / f64::from(sides);
        (0..sides).map(move |i| {
            let (sin, cos) = angle(i).sin_cos();
            format!("v {:.6} {:.6} {z}\n", radius * cos, radius * sin)
        })
    };
    let rings = [(20.0, 0.0), (20.0, 4.0), (8.0, 0.0), (8.0, 4.0)];
    let mut text: String = rings.iter().flat_map(|(radius, z)| ring(*radius, *z)).collect();
    for i in 0..sides {
        let at = |ring: u32, i: u32| ring * sides + i % sides + 1;
        for [a, b] in [[0, 1], [1, 3], [3, 2], [2, 0]] {
            text += &format!("f {} {} {} {}\n", at(a, i), at(a, i + 1), at(b, i + 1), at(b, i));
        }
    }
    text
}

/// Returns the entities of a DXF file, and the values of a group code.
fn entities(file: &[u8], code: &str) -> (Vec<String>, Vec<f64>) {
    let text = String::from_utf8_lossy(file).into_owned();
    let (_, after) = text.split_once("ENTITIES\n").unwrap();
    let lines: Vec<&str> = after.lines().map(str::trim).collect();
    let tags = || lines.chunks_exact(2).take_while(|tag| tag[1] != "ENDSEC");
    let kinds = tags().filter(|tag| tag[0] == "0").map(|tag| tag[1].to_owned()).collect();
    (kinds, tags().filter(|tag| tag[0] == code).map(|tag| tag[1].parse().unwrap()).collect())
}

#[test]
fn holes_are_circles_as_large_as_they_are() {
    let folder = Folder::with_models();
    folder.write("plate.obj", plate(36).as_bytes());
    let ended = folder.must("render plate.obj -o a.dxf --view front");
    assert!(
        ended.err.contains("OBJ files have no unit; one unit of the model is drawn as 1 mm"),
        "{}",
        ended.err
    );
    let (kinds, radii) = entities(&folder.read("a.dxf"), "40");
    assert_eq!((kinds, radii), (vec!["CIRCLE".to_owned(); 2], vec![20.0, 8.0]));
    let ended = folder.must("render plate.obj -o a.dxf --view front --unit cm");
    assert!(!ended.err.contains("warning"), "{}", ended.err);
    let radii = entities(&folder.read("a.dxf"), "40").1;
    assert!((radii[0] - 200.0).abs() < 1e-5 && (radii[1] - 80.0).abs() < 1e-5, "{radii:?}");
    let ended = folder.must("render plate.obj -o a.dxf --view front --page A4");
    assert!(ended.err.contains("the drawing is 2:1"), "{}", ended.err);
    folder.must("render plate.obj -o a.dxf --view front --dxf-polylines");
    assert_eq!(entities(&folder.read("a.dxf"), "42").0, ["LWPOLYLINE"; 2]);
    folder.must("render plate.obj -o a.dxf --view front --fit 0");
    let (kinds, places) = entities(&folder.read("a.dxf"), "10");
    assert_eq!((kinds, places.len()), (vec!["LWPOLYLINE".to_owned(); 2], 72));
    // A drawing with a unit is as large as in SVG.
    let json = folder.must("render plate.obj -o a.svg --view front --unit mm --json").json();
    assert_eq!(json["models"][0]["pictures"][0]["drawing"]["scale_text"], "1:1");
}

#[test]
fn round_faces_are_few_hatches() {
    let folder = Folder::with_models();
    folder.write("plate.obj", plate(180).as_bytes());
    let count = |options: &str| {
        folder.must(&format!("render plate.obj -o a.dxf --style regions {options}"));
        entities(&folder.read("a.dxf"), "10").0.iter().filter(|k| *k == "HATCH").count()
    };
    let (bands, shades) = (count(""), count("--merge shade"));
    assert!(bands <= 20 && shades > 60, "{bands} bands, {shades} shades");
}

#[test]
fn borders_of_areas_are_arcs() {
    let folder = Folder::with_models();
    folder.write("plate.obj", plate(90).as_bytes());
    let read = |name: &str| String::from_utf8(folder.read(name)).unwrap();
    let shared = "render plate.obj --view front --style regions";
    folder.must(&format!("{shared} -o a.svg --fill disjoint"));
    let area = read("a.svg");
    // Three arcs per border, as half circles are not accurate enough.
    let path = area.lines().find(|l| l.contains(" d=")).unwrap();
    let data = path.split(" d=").nth(1).unwrap();
    assert!(data.matches('a').count() == 6 && data.len() < 400, "{path}");
    // Six arcs as corners with bulges, in place of 180 corners.
    folder.must(&format!("{shared} -o a.dxf"));
    let (kinds, bulges) = entities(&folder.read("a.dxf"), "42");
    assert_eq!(kinds, ["HATCH"]);
    assert_eq!(bulges.len(), 6);
    folder.must(&format!("{shared} -o a.dxf --fit 0"));
    assert!(entities(&folder.read("a.dxf"), "42").1.is_empty());
    folder.must(&format!("{shared} -o a.gcode --hatch none --unit mm"));
    assert_eq!(
        read("a.gcode").lines().filter(|l| l.starts_with("G2 ") || l.starts_with("G3 ")).count(),
        6
    );
    // Areas that extend under others keep their corners.
    folder.must(&format!("{shared} -o b.svg"));
    assert!(read("b.svg").len() > 1500);
}

#[test]
fn g_code_tells_its_scale() {
    let folder = folder();
    let printed = folder.must("render bracket.stl -o b.gcode").err;
    assert!(printed.contains(":1; --scale 1:1 makes it as large as the model"), "{printed}");
    let printed = folder.must("render bracket.stl -o b.gcode --scale 1:1 --unit mm").err;
    assert!(!printed.contains("the drawing is"), "{printed}");
    // A drawing with a unit keeps its size; a warning says that it may exceed the machine.
    let scale = |options: &str| {
        let ended = folder.must(&format!("render bracket.stl -o b.gcode --json {options}"));
        let drawing = &ended.json()["models"][0]["pictures"][0]["drawing"];
        (drawing["scale_text"].as_str().unwrap().to_owned(), ended.err)
    };
    let (text, printed) = scale("--unit mm");
    assert!(text == "1:1" && printed.is_empty(), "{text} {printed}");
    let (text, printed) = scale("--unit m");
    assert!(text == "1:1" && printed.contains("as large as the model"), "{text} {printed}");
    let (text, printed) = scale("--unit m --page 300x200");
    assert!(text.starts_with("1:") && printed.contains("the drawing is 1:"), "{text} {printed}");
}

#[test]
fn g_code_has_arcs_unless_the_machine_knows_none() {
    let folder = folder();
    folder.write("plate.obj", plate(90).as_bytes());
    let count = |options: &str| {
        folder.must(&format!("render plate.obj -o p.gcode --view front --hatch none {options}"));
        let text = String::from_utf8(folder.read("p.gcode")).unwrap();
        let with = |code: &str| text.lines().filter(|l| l.starts_with(code)).count();
        (with("G2 ") + with("G3 "), with("G1 "))
    };
    // Two circles, each of three arcs.
    assert_eq!(count(""), (6, 0));
    let (arcs, lines) = count("--gcode-lines");
    assert!(arcs == 0 && lines > 100, "{lines}");
    folder.run("render plate.obj -o p.svg --gcode-lines").fails(2, "it is for G-code");
}
