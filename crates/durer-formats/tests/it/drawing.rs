//! Drawings on paper and in files.

use durer::math::DVec2;
use durer::paper::{Hidden, LaidOut, Options, TitleBlock, Views, dashes, lay_out, third_angle};
use durer::target::drawing::{Anchor, Drawing, Label, Line, LineClass, Region, RegionKind};
use durer::target::sheet::Mark;
use durer_formats::drawing::{
    DrawingFormat, DxfStrokes, FileOptions, write, write_dxf, write_geojson, write_hpgl, write_svg,
};

fn rectangle(w: f64, h: f64) -> Vec<DVec2> {
    [(-w, -h), (w, -h), (w, h), (-w, h)].map(|(x, y)| DVec2::new(x, y)).to_vec()
}

fn line(class: LineClass, invisibility: u32, points: Vec<DVec2>, closed: bool) -> Line {
    Line { class, invisibility, points, closed }
}

/// A plate of 2w × 2h with a hole, an edge, and hidden lines behind one and two surfaces.
fn plate(w: f64, h: f64) -> Drawing {
    let hole: Vec<DVec2> = rectangle(5.0, 5.0).into_iter().rev().collect();
    let bend = [(-w, 0.0), (0.0, 0.0), (0.0, h)].map(|(x, y)| DVec2::new(x, y)).to_vec();
    let across = vec![DVec2::new(-w, -h / 2.0), DVec2::new(w, -h / 2.0)];
    Drawing {
        window: None,
        regions: vec![Region {
            kind: RegionKind::Surface,
            rings: vec![rectangle(w, h), hole.clone()],
            color: [200, 210, 230, 255],
            item: Some(7),
        }],
        lines: vec![
            line(LineClass::Silhouette, 0, rectangle(w, h), true),
            line(LineClass::Crease, 0, across, false),
            line(LineClass::Crease, 1, bend, false),
            line(LineClass::Border, 2, hole, true),
        ],
        labels: vec![Label {
            at: DVec2::ZERO,
            text: "Ø 10 < é & \"x\"".to_owned(),
            height: 3.0,
            anchor: Anchor::Middle,
        }],
        ..Drawing::default()
    }
}

fn laid(hidden: Hidden) -> LaidOut {
    let page = "A4".parse().unwrap();
    let options = Options { page, scale: "1:1".parse().unwrap(), hidden, ..Options::default() };
    lay_out(&plate(60.0, 20.0), "Plate <1>", &options).unwrap()
}

fn text_of(write: impl Fn(&mut Vec<u8>) -> durer_formats::Result<()>) -> String {
    let mut bytes = Vec::new();
    write(&mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

#[test]
fn layers_follow_what_becomes_of_hidden_lines() {
    let names =
        |hidden| -> Vec<String> { laid(hidden).sheet.layers.into_iter().map(|l| l.name).collect() };
    let visible = ["visible-crease", "visible-silhouette", "text"];
    assert_eq!(names(Hidden::Drop), [&["regions"][..], &visible].concat());
    let dashed = ["regions", "hidden-border", "hidden-crease"];
    assert_eq!(names(Hidden::Dashed), [&dashed[..], &visible].concat());
    let deep = ["regions", "hidden-2-border", "hidden-1-crease"];
    assert_eq!(names(Hidden::Layer), [&deep[..], &visible].concat());
}

#[test]
fn svg_has_millimetres_layers_and_all_strokes() {
    let sheet = laid(Hidden::Dashed).sheet;
    let text = text_of(|out| write_svg(out, &sheet));
    let document = roxmltree::Document::parse(&text).unwrap();
    let root = document.root_element();
    assert_eq!(root.attribute("width"), Some("297mm"));
    assert_eq!(root.attribute("viewBox"), Some("0 0 297 210"));
    assert_eq!(
        root.children().find(|n| n.has_tag_name("title")).unwrap().text(),
        Some("Plate <1>")
    );
    let inkscape = "http://www.inkscape.org/namespaces/inkscape";
    let groups: Vec<_> =
        root.children().filter(|n| n.attribute((inkscape, "groupmode")) == Some("layer")).collect();
    assert_eq!(groups.len(), sheet.layers.len());
    for (group, layer) in groups.iter().zip(&sheet.layers) {
        assert_eq!(group.attribute((inkscape, "label")), Some(layer.name.as_str()));
        let paths: Vec<_> = group.children().filter(|n| n.has_tag_name("path")).collect();
        assert_eq!(paths.len(), layer.marks.len(), "{}", layer.name);
        for (path, mark) in paths.iter().zip(&layer.marks) {
            if let Mark::Stroke { points, closed, .. } = mark {
                let d = path.attribute("d").unwrap();
                assert!(d.starts_with(&format!("M{}", points[0].x)), "{d}");
                assert_eq!(d.ends_with('z'), *closed);
            }
        }
    }
    let silhouette =
        groups.iter().find(|g| g.attribute("id") == Some("visible-silhouette")).unwrap();
    let path = silhouette.children().find(|n| n.has_tag_name("path")).unwrap();
    assert_eq!(path.attribute("d"), Some("M88.5 125h120v-40h-120z"));
    assert_eq!(silhouette.attribute("stroke-width"), Some(".5"));
    let label = document.descendants().find_map(|n| n.attribute("aria-label"));
    assert_eq!(label, Some("Ø 10 < é & \"x\""));
}

#[test]
fn dashes_begin_and_end_with_a_whole_dash_and_meet_at_corners() {
    let sheet = laid(Hidden::Dashed).sheet;
    let layer = sheet.layers.iter().find(|l| l.name == "hidden-crease").unwrap();
    assert_eq!(layer.marks.len(), 2, "divided at its corner");
    for mark in &layer.marks {
        let Mark::Stroke { points, closed, pen } = mark else { panic!("{mark:?}") };
        let nominal = &sheet.pens[*pen].dashes;
        let length = dashes::length(points, *closed);
        let fitted = dashes::fitted(nominal, length, *closed).unwrap();
        let parts = dashes::cut(points, *closed, nominal);
        assert!(parts[0][0].distance(points[0]) < 1e-9);
        assert!(parts.last().unwrap().last().unwrap().distance(*points.last().unwrap()) < 1e-9);
        for part in &parts {
            assert!((dashes::length(part, false) - fitted[0]).abs() < 1e-9);
        }
        assert!((fitted[0] / nominal[0] - 1.0).abs() < 0.2);
    }
}

#[test]
fn geojson_has_a_feature_a_piece() {
    let drawing = plate(60.0, 20.0);
    let text = text_of(|out| write_geojson(out, &drawing));
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let features = json["features"].as_array().unwrap();
    assert_eq!(features.len(), 6);
    let region = &features[0];
    assert_eq!(region["properties"]["class"], "surface");
    assert_eq!(region["properties"]["item"], 7);
    assert_eq!(region["geometry"]["type"], "Polygon");
    assert_eq!(region["geometry"]["coordinates"].as_array().unwrap().len(), 2);
    for (feature, line) in features[1..].iter().zip(&drawing.lines) {
        assert_eq!(feature["properties"]["class"], line.class.name());
        assert_eq!(feature["properties"]["visible"], line.is_visible());
        assert_eq!(feature["properties"]["invisibility"], line.invisibility);
        let points = feature["geometry"]["coordinates"].as_array().unwrap();
        assert_eq!(points.len(), line.points.len() + usize::from(line.closed));
        assert_eq!(points[0][0].as_f64(), Some(line.points[0].x));
    }
}

#[test]
fn dxf_has_pairs_unique_handles_and_declared_layers() {
    let sheet = laid(Hidden::Dashed).sheet;
    let text = text_of(|out| write_dxf(out, &sheet, DxfStrokes::Polylines));
    assert!(text.is_ascii());
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len() % 2, 0);
    let tags: Vec<(u16, &str)> =
        lines.chunks(2).map(|c| (c[0].trim().parse().unwrap(), c[1])).collect();
    assert_eq!(tags.last(), Some(&(0, "EOF")));
    let count = |kind: &str| tags.iter().filter(|t| **t == (0, kind)).count();
    assert_eq!(count("SECTION"), count("ENDSEC"));
    assert_eq!(count("TABLE"), count("ENDTAB"));
    assert_eq!(count("LAYER"), sheet.layers.len() + 1);
    assert_eq!((count("HATCH"), count("TEXT")), (1, 1));
    // The bend is two strokes, the hole four, outline and edge one each.
    assert_eq!(count("LWPOLYLINE"), 8);
    let mut handles: Vec<&str> = tags
        .iter()
        .skip_while(|t| **t != (2, "TABLES"))
        .filter(|t| t.0 == 5 || t.0 == 105)
        .map(|t| t.1)
        .collect();
    let all = handles.len();
    handles.sort_unstable();
    handles.dedup();
    assert_eq!(handles.len(), all);
    for layer in &sheet.layers {
        assert!(tags.contains(&(2, layer.name.as_str())), "{}", layer.name);
    }
    assert!(tags.contains(&(6, "HIDDEN")) && tags.contains(&(6, "CONTINUOUS")));
}

#[test]
fn hpgl_draws_each_pen_once_and_stays_on_the_paper() {
    let sheet = laid(Hidden::Dashed).sheet;
    let text = text_of(|out| write_hpgl(out, &sheet));
    assert!(text.starts_with("IN;") && text.ends_with("SP0;\n"));
    let pens: Vec<&str> = text.split(';').map(str::trim).filter(|c| c.starts_with("SP")).collect();
    let mut different = pens.clone();
    different.dedup();
    assert_eq!(pens, different);
    for command in
        text.split(';').map(str::trim).filter(|c| c.starts_with("PU") || c.starts_with("PD"))
    {
        let numbers: Vec<i64> = command[2..].split(',').map(|n| n.parse().unwrap()).collect();
        assert_eq!(numbers.len() % 2, 0, "{command}");
        for p in numbers.chunks(2) {
            assert!((0..=11880).contains(&p[0]) && (0..=8400).contains(&p[1]), "{command}");
        }
    }
}

#[test]
fn every_format_gives_the_same_bytes_again_and_takes_an_empty_sheet() {
    for &format in DrawingFormat::ALL {
        for drawing in [plate(60.0, 20.0), Drawing::default()] {
            let sheet = lay_out(&drawing, "", &Options::default()).unwrap().sheet;
            let bytes = || {
                let mut out = Vec::new();
                write(&mut out, format, &sheet, &drawing, &FileOptions::default()).unwrap();
                out
            };
            assert!(!bytes().is_empty() && bytes() == bytes(), "{format}");
        }
    }
}

#[test]
fn third_angle_views_are_aligned_and_on_the_paper() {
    let (front, top) = (plate(60.0, 20.0), plate(60.0, 35.0));
    let (right, iso) = (plate(35.0, 20.0), plate(62.0, 45.0));
    let views = Views { front: &front, top: &top, right: &right, iso: &iso };
    let options = Options { margin: 10.0, scale: "auto".parse().unwrap(), ..Options::default() };
    let title = TitleBlock { name: "Plate".to_owned(), unit: "mm".to_owned(), date: None };
    let laid = third_angle(&views, &title, &options).unwrap();
    assert_eq!((laid.scale, laid.sheet.size), (1.0, DVec2::new(297.0, 210.0)));
    let layer = laid.sheet.layers.iter().find(|l| l.name == "visible-silhouette").unwrap();
    let boxes: Vec<(DVec2, DVec2)> = layer
        .marks
        .iter()
        .map(|m| match m {
            Mark::Stroke { points, .. } => {
                points.iter().fold((points[0], points[0]), |(a, b), p| (a.min(*p), b.max(*p)))
            }
            other => panic!("{other:?}"),
        })
        .collect();
    let [front, top, right, iso] = boxes[..] else { panic!("{boxes:?}") };
    assert_eq!((front.0.x, front.1.x), (top.0.x, top.1.x));
    assert_eq!((front.0.y, front.1.y), (right.0.y, right.1.y));
    assert!(top.1.y < front.0.y && front.1.x < right.0.x);
    assert!(iso.0.x > top.1.x && iso.1.y < right.0.y);
    for (min, max) in boxes {
        assert!(min.min_element() > 10.0 && max.x < 287.0 && max.y < 184.0);
    }
}

#[test]
fn a_scale_that_does_not_fit_is_refused() {
    let page = "A5".parse().unwrap();
    let options = Options { page, scale: "10:1".parse().unwrap(), ..Options::default() };
    let error = lay_out(&plate(60.0, 20.0), "", &options).unwrap_err().to_string();
    assert!(error.contains("10:1") && error.contains("1.66:1") && error.contains("1:1"), "{error}");
}
